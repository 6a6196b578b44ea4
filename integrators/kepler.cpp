#include "integrators/kepler_impl.hpp"

namespace noether {

template KeplerArc<double> kepler_arc(const Vec3<double>&, const Vec3<double>&, double, double);
template KeplerArc<Quad> kepler_arc(const Vec3<Quad>&, const Vec3<Quad>&, Quad, Quad);

}  // namespace noether
