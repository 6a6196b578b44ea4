#include "tests/support/problems.hpp"

namespace noether {

template struct detail::ForceModel<test::HenonHeilesField, double>;
template struct detail::ForceModel<test::HenonHeilesField, Quad>;

namespace test {
template PhasePoint<Quad> henon_heiles_flow(PhasePoint<Quad>, double);
template PhasePoint<double> kepler_motion(const ParticleSystem<double>&, const double&);
template PhasePoint<Quad> kepler_motion(const ParticleSystem<Quad>&, const Quad&);
template PhasePoint<Quad> driven_motion(const PhasePoint<Quad>&, const HarmonicField&, const OscillatingField&,
                                        const Quad&);
}  // namespace test

}  // namespace noether
