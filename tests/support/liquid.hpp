#pragma once
/// Atoms for tests of pair forces: lattices and liquids in boxes, the same every time.

#include "engine/particle_system.hpp"

#include <cmath>
#include <random>
#include <utility>

namespace noether::test {

/// A face-centred lattice of 4 cells^3 atoms of mass 1 at this density, each moved by up to `shake` in every direction,
/// with random velocities of this temperature (k_B = 1) and no momentum.
inline ParticleSystem<double> liquid(int cells, double density, double temperature, double shake = 0,
                                     unsigned seed = 1) {
  const double edge = std::cbrt(4 / density);
  ParticleSystem<double> s;
  s.set_box(Box::periodic(Vec3<double>::Constant(cells * edge)));
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1p-52 - 1; };
  const Vec3<double> basis[4] = {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}};
  Vec3<double> momentum = Vec3<double>::Zero();
  for (int cell = 0; cell < cells * cells * cells; ++cell) {
    const Vec3<double> corner(cell % cells, cell / cells % cells, cell / cells / cells);
    for (const Vec3<double>& b : basis) {
      const Vec3<double> x = edge * (corner + b) + shake * Vec3<double>(uniform(), uniform(), uniform());
      const Vec3<double> v(uniform(), uniform(), uniform());
      momentum += v;
      s.add("", 1, x, v);
    }
  }
  const auto n = static_cast<double>(s.size());
  double twice_kinetic = 0;
  for (Index i = 0; i < s.size(); ++i) {
    s.velocities().add(i, -momentum / n);
    twice_kinetic += norm2(std::as_const(s).velocities()[i]);
  }
  s.scale_velocities(std::sqrt(temperature * 3 * (n - 1) / twice_kinetic));
  return s;
}

}  // namespace noether::test
