#pragma once
/// The heavy top A and the free body against references of 28 digits.

#include "tests/support/rigid_bodies.hpp"

#include <algorithm>
#include <cmath>

namespace noether::test {

/// The larger of the largest errors of R and of Pi, relative to the largest Pi at the start, of the heavy top A at
/// t = 10. References by extrapolation in 28 to 40 digits.
inline double heavy_top_error(const ParticleSystem<double>& s) {
  Mat3<double> r;
  r << 0.63061869068486407790, 0.41148720346445770423, -0.6580261000476407484, 0.13793808901625566150,
      0.77494456231452710831, 0.61679332757228295161, 0.76373630957121009037, -0.4797282634201845721,
      0.43193476673961167427;
  const Vec3<double> pi(0.22808129162272360413, -0.5258554584300771690, 1.09631904314062503078);
  return std::max((matrix_of(s) - r).cwiseAbs().maxCoeff(), (in_body_of(s) - pi).cwiseAbs().maxCoeff() / 0.9);
}

/// The same after a run by an integrator with steps of one length.
template <class I> double heavy_top_error(I integrator, double h) {
  Simulation sim(heavy_top(), std::move(integrator), h);
  return sim.run(std::lround(10 / h)).ok() ? heavy_top_error(sim.particles()) : INFINITY;
}

/// A free body of moments 2, 1 and 2/3 with Pi = (cos 1.1, 0, sin 1.1).
inline ParticleSystem<double> free_body() {
  ParticleSystem<double> s(unit_system("reduced"));
  add_body(s, body_of_inertia("body", 1, {2, 1, 2. / 3}), {.spin = Vec3<double>(std::cos(1.1), 0, std::sin(1.1))});
  return s;
}
/// How far its Pi is from that of Jacobi's functions at t = 10, by its largest component.
inline double free_body_error(const ParticleSystem<double>& s) {
  const Vec3<double> pi(0.40706613658804081085, 0.28300742681284407600, 0.86844916766156164371);
  return (in_body_of(s) - pi).cwiseAbs().maxCoeff();
}
/// The same by the length of the difference.
inline double free_body_distance(const ParticleSystem<double>& s) {
  const Vec3<double> pi(0.40706613658804081085, 0.28300742681284407600, 0.86844916766156164371);
  return (in_body_of(s) - pi).norm();
}

}  // namespace noether::test
