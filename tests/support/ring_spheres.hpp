#pragma once
/// Patches of rings of hard spheres, for tests.

#include "engine/particle_system.hpp"
#include "engine/sphere_columns.hpp"
#include "integrators/shearing_sheet.hpp"
#include "numbers/random.hpp"
#include "tests/support/sheets.hpp"

#include <cmath>
#include <cstdint>

namespace noether::test {

/// A sheet of hard spheres.
template <class... Fs>
AnyHamiltonian<double> sheet_of_spheres(const ShearingSheetOptions& options, const HardSpheres& law, Fs... forces) {
  return with_letter(law, sheet<double>(options, std::move(forces)...));
}

struct Patch {
  int count = 40;
  Vec3<double> edges = Vec3<double>(10, 8, 40);
  double smallest = 0.3, largest = 0.8;  ///< radii
  double thickness = 3, speed = 0.5;
  double Omega = 1;
  std::uint64_t seed = 1;
  /// Particles with x below it stand in the next cell along x, and below half of it in the next along y.
  double cut = 0;
};

/// Spheres at random places without overlaps at t = 0, on the shear with random velocities; all numbers have few
/// digits, so that w is exact wherever they stand.
inline ParticleSystem<double> patch(const Patch& wanted) {
  ParticleSystem<double> s(unit_system("reduced"));
  s.set_box(Box::periodic(wanted.edges));
  auto& radii = s.add_column<BodyRadius>();
  Philox random(wanted.seed, 1);
  const auto grid = [](double x) { return std::nearbyint(x * 4096) / 4096; };
  const auto three = [&] {  // drawn in this order by every compiler
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    return Vec3<double>(x, y, z);
  };
  std::vector<Vec3<double>> places;
  while (s.size() < wanted.count) {
    const double r = grid(wanted.smallest + (wanted.largest - wanted.smallest) * random.uniform());
    const Vec3<double> at_random = three();
    const Vec3<double> x(grid(wanted.edges[0] * at_random[0]), grid(wanted.edges[1] * at_random[1]),
                         grid(wanted.thickness * (at_random[2] - 0.5)));
    bool free = x[0] < wanted.edges[0] && x[1] < wanted.edges[1];
    for (std::size_t k = 0; k < places.size() && free; ++k) {
      const double touch = r + std::as_const(radii)[static_cast<Index>(k)];
      free = s.box().minimum_image(Vec3<double>(x - places[k])).norm() > touch;
    }
    const Vec3<double> c = (wanted.speed * (three() - Vec3<double>::Constant(0.5))).unaryExpr(grid);
    if (!free) continue;
    places.push_back(x);
    Vec3<double> at = x;
    if (at[0] < wanted.cut) at[0] += wanted.edges[0];
    if (at[1] < wanted.cut / 2) at[1] += wanted.edges[1];
    s.add("", r * r * r, at, Vec3<double>(c[0], c[1] - 1.5 * wanted.Omega * at[0], c[2]));
    radii[s.size() - 1] = r;
  }
  return s;
}

}  // namespace noether::test
