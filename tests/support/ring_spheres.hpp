#pragma once
/// Patches of rings of hard spheres, for tests.

#include "engine/particle_system.hpp"
#include "engine/sphere_columns.hpp"
#include "integrators/shearing_sheet.hpp"
#include "numbers/random.hpp"
#include "tests/support/sheets.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

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

inline double total_contacts(const ParticleSystem<double>& s) { return s.column<ContactCount>().all().sum() / 2; }

/// The deepest overlap of two spheres through all images, as a share of the distance of their centres at contact, by
/// pairs.
inline double deepest_overlap(const ParticleSystem<double>& s, double Omega) {
  double deepest = 0;
  const bool boxed = s.box().is_periodic();
  const Vec3<double> edges = boxed ? s.box().edges() : Vec3<double>::Ones();
  const double slide = 1.5 * Omega * s.time() * edges[0];
  for (Index i = 0; i < s.size(); ++i) {
    for (Index j = i + 1; j < s.size(); ++j) {
      const Vec3<double> d = std::as_const(s).positions()[j] - std::as_const(s).positions()[i];
      const double touch = s.column<BodyRadius>()[i] + s.column<BodyRadius>()[j];
      for (int a = -1; a <= 1; ++a) {
        if (!boxed && a != 0) continue;
        const double x = d[0] + a * edges[0];
        double y = d[1] - a * slide, z = d[2];
        if (boxed) y -= edges[1] * std::nearbyint(y / edges[1]), z -= edges[2] * std::nearbyint(z / edges[2]);
        deepest = std::max(deepest, 1 - std::sqrt(x * x + y * y + z * z) / touch);
      }
    }
  }
  return deepest;
}

/// Sums of m (v_x, w, v_z) and of m z, with w the speed along y about the shear: they turn as those of one free
/// particle, whatever spheres do to each other.
struct SheetMomentum {
  Vec3<double> sum = Vec3<double>::Zero();
  double height = 0, size = 0;  ///< size: sum of m |(v_x, w, v_z)|

  SheetMomentum(const ParticleSystem<double>& s, double Omega) {
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<double> v = s.velocities()[i], x = s.unwrapped(i);
      const Vec3<double> u(v[0], v[1] + 1.5 * Omega * x[0], v[2]);
      sum += s.masses()[i] * u;
      size += s.masses()[i] * u.norm();
      height += s.masses()[i] * x[2];
    }
  }
  /// After a time, with Omega_z = Omega.
  Vec3<double> turned(double time, double Omega) const {
    const double c = std::cos(Omega * time), sine = std::sin(Omega * time);
    return {sum[0] * c + 2 * sum[1] * sine, sum[1] * c - sum[0] / 2 * sine, sum[2] * c - Omega * height * sine};
  }
};

}  // namespace noether::test
