/// Compositions over dual numbers carry the tangent map, over packs eight systems at once.

#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/henon_heiles.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "numbers/dual.hpp"
#include "numbers/pack.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

using namespace noether;

namespace {

ParticleSystem<double> one_body(double x, double y, double vx, double vy) {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("body", 1, {x, y, 0.01}, {vx, vy, 0});
  return s;
}

/// A spring to the origin in kicks C.
struct SlowSpring {
  static ForceClaims claims() { return {.kicks = "C"}; }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    HarmonicField{.k = 0.3}.add_to(out, s);
  }
};

/// The state after `steps` steps; `set(s)` may change the start in the working number type.
template <class Real, class F, class Set>
ParticleSystem<Real> after(const F& force, const Scheme& scheme, const ParticleSystem<double>& start, int steps,
                           const Set& set, const CompositionOptions& options = {}) {
  ParticleSystem<Real> s = start.as<Real>();
  s.clock() = Clock<Real>::fixed(0, 0.05);
  set(s);
  Composition<KineticPotential<F, Real>> integrator(KineticPotential<F, Real>(force), scheme, options);
  integrator.bind(s);
  ParticleSystem<Real> settled = s;
  integrator.advance(s, {.steps = steps});
  integrator.settle(s, settled, {}, {}, true);
  return settled;
}

template <class F> void check_lanes(const F& force, const Scheme& scheme, const CompositionOptions& options = {}) {
  const auto lane_start = [](std::size_t k) { return one_body(0.3 + 0.02 * static_cast<double>(k), 0.1, 0, 0.2); };
  const auto set = [&](ParticleSystem<Pack>& s) {
    for (std::size_t k = 0; k < Pack::lanes; ++k) s.positions().component(0)->lane[k] = lane_start(k).positions()[0][0];
  };
  const auto eight = after<Pack>(force, scheme, lane_start(0), 40, set, options);
  for (std::size_t k = 0; k < Pack::lanes; ++k) {
    const auto alone = after<double>(
        force, scheme, lane_start(k), 40, [](ParticleSystem<double>&) {}, options);
    for (int c = 0; c < 3; ++c) {
      CHECK(eight.positions().component(c)->lane[k] == alone.positions()[0][c]);
      CHECK(eight.velocities().component(c)->lane[k] == alone.velocities()[0][c]);
    }
  }
}

template <class Number> void check_tangent(const Scheme& scheme, double tolerance) {
  using Tangent = Dual<Number, 1>;
  const auto start = one_body(0.3, 0.1, 0.05, 0.2);
  const auto at = [&](const Quad& moved) {
    const auto end = after<Quad>(HenonHeiles{}, scheme, start, 40,
                                 [&](ParticleSystem<Quad>& s) { *s.positions().component(0) += moved; });
    return std::pair(end.positions()[0], end.velocities()[0]);
  };
  const auto end = after<Tangent>(HenonHeiles{}, scheme, start, 40,
                                  [](ParticleSystem<Tangent>& s) { s.positions().component(0)->slope[0] = Number(1); });
  const Quad h(1e-12);
  const auto [x1, v1] = at(h);
  const auto [x0, v0] = at(-h);
  for (int c = 0; c < 2; ++c) {
    const Quad dx = (x1[c] - x0[c]) / (h + h), dv = (v1[c] - v0[c]) / (h + h);
    CHECK(std::abs(static_cast<double>(Quad(end.positions()[0][c].slope[0]) - dx)) < tolerance);
    CHECK(std::abs(static_cast<double>(Quad(end.velocities()[0][c].slope[0]) - dv)) < tolerance);
  }
}

}  // namespace

TEST_CASE("eight systems in the lanes of a composition have the bits of each run alone", "[numbers]") {
  for (const Scheme* scheme : {&schemes::verlet, &schemes::yoshida_4, &schemes::blanes_moan_s6, &schemes::aba_10_6_4}) {
    CAPTURE(std::string(scheme->name));
    check_lanes(HenonHeiles{}, *scheme);
    check_lanes(HarmonicField{.k = 0.7}, *scheme);
  }
}

TEST_CASE("eight systems in the lanes of multiple time steps have the bits of each run alone", "[numbers][respa]") {
  check_lanes(Sum(HenonHeiles{}, SlowSpring{}), schemes::respa, {.inner_steps = {3}});
}

TEST_CASE("a composition over dual numbers carries the derivative of its map", "[numbers]") {
  for (const Scheme* scheme : {&schemes::verlet, &schemes::yoshida_4, &schemes::blanes_moan_s6, &schemes::aba_10_6_4}) {
    CAPTURE(std::string(scheme->name));
    check_tangent<double>(*scheme, 1e-13);
    check_tangent<Quad>(*scheme, 1e-20);
  }
}

TEST_CASE("the weights of dual numbers and packs are those of double", "[numbers]") {
  for (const Scheme* scheme : schemes::all()) {
    const auto plain = rounded_weights<double>(scheme->word);
    const auto lanes = rounded_weights<Pack>(scheme->word);
    const auto duals = rounded_weights<Dual<double, 1>>(scheme->word);
    for (std::size_t k = 0; k < plain.size(); ++k) {
      CHECK(all(lanes[k] == Pack(plain[k])));
      CHECK(duals[k].value == plain[k]);
    }
  }
}
