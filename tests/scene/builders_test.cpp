// Builders: densities, distances, temperatures and bonds of what they build.

#include "scene/builders.hpp"
#include "engine/force_sink.hpp"
#include "forces/ewald.hpp"
#include "scene/ionic_crystal.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace noether::test {
namespace {

double distance(const ParticleSystem<double>& s, Index i, Index j) {
  return s.box().minimum_image(Vec3<double>(s.positions()[i] - s.positions()[j])).norm();
}

double least_distance(const ParticleSystem<double>& s) {
  double least = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < s.size(); ++i) {
    for (Index j = i + 1; j < s.size(); ++j) least = std::min(least, distance(s, i, j));
  }
  return least;
}

/// Pairs in one place of the shell of nearest neighbors of particle 0.
int neighbors_of_first(const ParticleSystem<double>& s, double nearest) {
  int count = 0;
  for (Index j = 1; j < s.size(); ++j) count += distance(s, 0, j) < nearest * 1.001 ? 1 : 0;
  return count;
}

double mass_density(const ParticleSystem<double>& s) { return s.masses().all().sum() / s.box().volume(); }

double temperature_of(const ParticleSystem<double>& s) {
  double twice = 0;
  for (Index i = 0; i < s.size(); ++i) twice += s.masses()[i] * Vec3<double>(s.velocities()[i]).squaredNorm();
  return twice / (3 * static_cast<double>(s.size()) - 3) / s.units().k_B;
}

template <class Builder> std::string refusal_to_build(const Builder& builder) {
  return test::refusal_of([&] { builder.build(); });
}

TEST_CASE("lattices have the density and the neighbors of their kind", "[builders]") {
  const std::map<LatticeKind, std::array<double, 3>> known = {// particles of a cell, neighbors, their distance
                                                              {LatticeKind::simple_cubic, {1, 6, 1}},
                                                              {LatticeKind::body_centered, {2, 8, std::sqrt(0.75)}},
                                                              {LatticeKind::face_centered, {4, 12, std::sqrt(0.5)}}};
  for (const auto& [kind, facts] : known) {
    const auto s = Lattice{.lattice = kind, .cells = {3, 4, 5}, .density = 0.8, .mass = 2}.build();
    CHECK(s.size() == 60 * static_cast<Index>(facts[0]));
    CHECK(std::abs(mass_density(s) - 0.8) < 1e-14);
    const double nearest = facts[2] * s.box().edges()[0] / 3;
    CHECK(std::abs(least_distance(s) - nearest) < 1e-14 * 10);
    CHECK(neighbors_of_first(s, nearest) == static_cast<int>(facts[1]));
  }
  const auto s = Lattice{.cells = {2, 2, 2}, .constant = 1.5, .mass = 1, .epsilon = 2, .sigma = 3}.build();
  CHECK(s.box().edges() == Vec3<double>(3, 3, 3));
  CHECK(s.topology()->pair_kind(0, 0) == PairKind{2, 3});
  CHECK(s.ids().front() == 1);
  CHECK(s.name(31) == "atom_32");
}

TEST_CASE("crystals of ions have the neighbors and the density of their kind, and Madelung's constants", "[builders]") {
  // Neighbors of the other kind and their distance in edges; constants by that distance, as "Lattice Sums" of Borwein,
  // Glasser, McPhedran, Wan and Zucker has them.
  const std::map<IonicLattice, std::array<double, 4>> known = {
      {IonicLattice::rock_salt, {8, 6, 0.5, 1.7475645946331822}},
      {IonicLattice::cesium_chloride, {2, 8, std::sqrt(0.75), 1.7626747730709884}},
      {IonicLattice::zinc_blende, {8, 4, std::sqrt(3.0) / 4, 1.6380550533887894}}};
  for (const auto& [lattice, facts] : known) {
    const IonicCrystal crystal{.lattice = lattice,
                               .cells = {2, 3, 2},
                               .ions = {"Na", "Cl"},
                               .masses = {22.99, 35.45},
                               .charge = 2,
                               .constant = 0.5,
                               .epsilon = {1, 2},
                               .sigma = {0.2, 0.4}};
    const auto s = crystal.build();
    CAPTURE(facts[0]);
    REQUIRE(s.size() == 12 * static_cast<Index>(facts[0]));
    const double nearest = facts[2] * 0.5;
    CHECK(std::abs(least_distance(s) - nearest) < 1e-14);
    CHECK(neighbors_of_first(s, nearest) == static_cast<int>(facts[1]));
    CHECK(s.name(2) == "Na_2");
    CHECK(s.name(3) == "Cl_2");
    CHECK(s.column<Charge>()[4] == 2);
    CHECK(s.column<Charge>()[5] == -2);
    CHECK(s.topology()->pair_kind(1, 1) == PairKind{2, 0.4});
    VectorColumn<double> a(s.size());
    ForceSink<double> sink(a, s, {.energy = true});
    Ewald{.cutoff = 0.9, .relative_error = 1e-14}.add_to(sink, s);
    const double by_pair = -s.units().coulomb_constant * 4 * facts[3] / nearest;
    CHECK(std::abs(sink.potential() / (by_pair * static_cast<double>(s.size()) / 2) - 1) < 1e-10);
    IonicCrystal by_density = crystal;
    by_density.constant.reset();
    by_density.density = mass_density(s);
    CHECK(std::abs(by_density.build().box().edges()[1] - 1.5) < 1e-14);
  }
}

TEST_CASE("crystals of ions that make no sense are refused", "[builders][messages]") {
  const auto refusal = [](auto change) {
    IonicCrystal salt{.cells = {1, 1, 1}, .ions = {"Na", "Cl"}, .masses = {23, 35}, .constant = 0.56};
    change(salt);
    return refusal_to_build(salt);
  };
  CHECK(refusal([](IonicCrystal&) {}).empty());
  CHECK(refusal([](IonicCrystal& s) { s.masses = {23}; }) ==
        "masses = [23] is not a list of two numbers; one for each type is expected");
  CHECK(refusal([](IonicCrystal& s) {
          s.masses = {23, -1};
        }).find("two numbers above 0 are expected") != std::string::npos);
  CHECK(refusal([](IonicCrystal& s) {
          s.ions = {"Na", "Na"};
        }).find("is not a list of two names") != std::string::npos);
  CHECK(refusal([](IonicCrystal& s) { s.charge = 0; }).find("a number other than 0 is expected") != std::string::npos);
  CHECK(refusal([](IonicCrystal& s) { s.epsilon = {1, 1}; }).find("is given without sigma") != std::string::npos);
  CHECK(refusal([](IonicCrystal& s) { s.sigma = {1, 1}; }).find("is given without epsilon") != std::string::npos);
  CHECK(refusal([](IonicCrystal& s) { s.density = 2; }).find("give only one of them") != std::string::npos);
}

TEST_CASE("velocities have the temperature asked for, and no momentum", "[builders]") {
  const auto s = Lattice{.cells = {5, 5, 5}, .constant = 0.54, .mass = 39.948, .temperature = 94.4, .seed = 7}.build(
      unit_system("molecular"));
  CHECK(std::abs(temperature_of(s) - 94.4) < 1e-12 * 94.4);
  Vec3<double> momentum = Vec3<double>::Zero();
  for (Index i = 0; i < s.size(); ++i) momentum += s.masses()[i] * Vec3<double>(s.velocities()[i]);
  CHECK(momentum.norm() < 1e-15 * static_cast<double>(s.size()) * 39.948);
}

TEST_CASE("velocities are normal deviates by mass, and depend on the seed alone", "[builders]") {
  const auto built = [](std::int64_t seed) {
    return Liquid{.particles = 20000, .density = 0.8, .mass = 4, .temperature = 1.5, .seed = seed}.build();
  };
  const auto s = built(3), again = built(3), other = built(4);
  CHECK(s.velocities().all() == again.velocities().all());
  CHECK(s.positions().all() == again.positions().all());
  CHECK(s.velocities().all() != other.velocities().all());
  // Five standard deviations of the means of v^2 and v^4 along each axis: of variances 2 and 96.
  const double variance = 1.5 / 4, n = static_cast<double>(s.size());
  for (int k = 0; k < 3; ++k) {
    double second = 0, fourth = 0;
    for (Index i = 0; i < s.size(); ++i) {
      const double z2 = std::pow(s.velocities().component(k)[i], 2) / variance;
      second += z2;
      fourth += z2 * z2;
    }
    CHECK(std::abs(second / n - 1) < 5 * std::sqrt(2 / n));
    CHECK(std::abs(fourth / n - 3) < 5 * std::sqrt(96 / n));
  }
}

TEST_CASE("a tracer has no temperature", "[builders]") {
  ParticleSystem<double> s;
  for (const double mass : {1.0, 0.0, 2.0}) s.add("a" + std::to_string(s.size()), mass, {mass, 0, 0}, {9, 9, 9});
  set_temperature(s, 2, 1);
  CHECK(s.velocities()[1] == Vec3<double>(0, 0, 0));
  CHECK(std::abs(Vec3<double>(s.velocities()[0] + 2 * s.velocities()[2]).norm()) < 1e-15);
  CHECK(std::abs(Vec3<double>(s.velocities()[0]).squaredNorm() + 2 * Vec3<double>(s.velocities()[2]).squaredNorm() -
                 6) < 1e-14);
  ParticleSystem<double> one;
  one.add("one", 1, {0, 0, 0}, {1, 0, 0});
  set_temperature(one, 0, 1);
  CHECK(one.velocities()[0] == Vec3<double>(0, 0, 0));
  CHECK_THROWS_WITH(set_temperature(one, 1, 1), "temperature = 1 needs two or more particles with mass");
}

TEST_CASE("a liquid has any number of particles, none too near", "[builders]") {
  for (const std::int64_t n : {1, 31, 32, 33, 500}) {
    const Liquid liquid{.particles = n, .density = 0.8442, .mass = 1, .displacement = 0.2};
    const auto s = liquid.build();
    CHECK(s.size() == n);
    CHECK(std::abs(mass_density(s) - 0.8442) < 1e-14);
    if (n < 2) continue;
    const double cells = std::ceil(std::cbrt(static_cast<double>(n) / 4) - 1e-9);
    const double site = s.box().edges()[0] / cells / std::sqrt(2.0);
    CHECK(least_distance(s) >= 0.6 * site);
    CHECK(least_distance(s) < 0.9 * site);
  }
}

TEST_CASE("chains have the bonds of Kremer and Grest, and do not fold back", "[builders]") {
  const auto s = PolymerChains{.chains = 20, .beads = 30, .density = 0.85, .mass = 1, .bending = 1.5}.build();
  const Topology& t = *s.topology();
  CHECK(s.size() == 600);
  CHECK(std::abs(mass_density(s) - 0.85) < 1e-14);
  CHECK(t.bonds.size() == 20 * 29);
  CHECK(t.angles.size() == 20 * 28);
  CHECK(t.exclusions.size() == t.bonds.size());
  CHECK(t.scaled_pairs.empty());
  CHECK(t.bond_kinds == std::vector<TermKind>{{"fene", {30, 1.5, 1, 1}}});
  CHECK(t.angle_kinds == std::vector<TermKind>{{"cosine", {1.5}}});
  for (const auto& bond : t.bonds) {
    CHECK(t.molecules[static_cast<std::size_t>(bond.particles[0])] ==
          t.molecules[static_cast<std::size_t>(bond.particles[1])]);
    CHECK(std::abs(Vec3<double>(s.unwrapped(bond.particles[0]) - s.unwrapped(bond.particles[1])).norm() - 0.97) <
          1e-13);
  }
  double nearest = 9, mean_cosine = 0;
  for (const auto& angle : t.angles) {
    const Vec3<double> a = s.unwrapped(angle.particles[1]) - s.unwrapped(angle.particles[0]);
    const Vec3<double> b = s.unwrapped(angle.particles[2]) - s.unwrapped(angle.particles[1]);
    nearest = std::min(nearest, Vec3<double>(a + b).norm());
    mean_cosine += a.dot(b) / (0.97 * 0.97) / static_cast<double>(t.angles.size());
  }
  CHECK(nearest >= 1.02 - 1e-12);
  // Cosines are even from least = 1.02^2/(2 0.97^2) - 1 to 1: five standard deviations of the mean.
  const double least = 1.02 * 1.02 / (2 * 0.97 * 0.97) - 1, width = 1 - least;
  CHECK(std::abs(mean_cosine - (1 + least) / 2) < 5 * width / std::sqrt(12.0 * static_cast<double>(t.angles.size())));
}

TEST_CASE("a builder refuses what cannot be built", "[builders]") {
  CHECK(refusal_to_build(Lattice{.cells = {2, 2}, .density = 1, .mass = 1}) ==
        "cells = [2, 2] is not a list of three numbers; the cells along x, y and z are expected");
  CHECK(refusal_to_build(Lattice{.cells = {2, 0, 2}, .density = 1, .mass = 1}) ==
        "cells = [2, 0, 2] contains a number below 1; whole numbers from 1 are expected");
  CHECK(refusal_to_build(Lattice{.cells = {1000, 1000, 1000}, .density = 1, .mass = 1}) ==
        "cells = [1000, 1000, 1000] give 4e+09 particles; at most 100000000 are expected");
  CHECK(refusal_to_build(Lattice{.cells = {2, 2, 2}, .mass = 1}) ==
        "neither a density nor a constant is given; give one of them");
  CHECK(refusal_to_build(Lattice{.cells = {2, 2, 2}, .density = 1, .constant = 2, .mass = 1}) ==
        "constant = 2 is given together with a density; give only one of them");
  CHECK(refusal_to_build(Lattice{.cells = {2, 2, 2}, .density = -1, .mass = 1}) ==
        "density = -1 is not a valid density; a number above 0 is expected");
  CHECK(refusal_to_build(Lattice{.cells = {2, 2, 2}, .density = 1}) ==
        "mass = 0 is not a valid mass; a number above 0 is expected");
  CHECK(refusal_to_build(Lattice{.cells = {2, 2, 2}, .density = 1, .mass = 1, .epsilon = 1}) ==
        "epsilon = 1 is given without sigma; give both or neither");
  CHECK(refusal_to_build(Lattice{.cells = {2, 2, 2}, .density = 1, .mass = 1, .temperature = -3}) ==
        "temperature = -3 is not a valid temperature; 0 or more is expected");
  CHECK(refusal_to_build(Liquid{.density = 1, .mass = 1}) ==
        "particles = 0 is out of range; 1 to 100000000 is expected");
  CHECK(refusal_to_build(Liquid{.particles = 9, .density = 1, .mass = 1, .displacement = 0.5}) ==
        "displacement = 0.5 is out of range; 0 to below 0.5 is expected, so that particles cannot meet");
  CHECK(refusal_to_build(PolymerChains{.chains = 2, .beads = 3, .density = 1, .mass = 1, .bond_length = 0.5}) ==
        "bond_length = 0.5 is out of range; 0.6 to below 1.5 is expected, where a FENE bond breaks");
  CHECK(refusal_to_build(PolymerChains{.chains = 20000, .beads = 30000, .density = 1, .mass = 1}) ==
        "chains = 20000 of 30000 beads each are more than 100000000 particles");
}

}  // namespace
}  // namespace noether::test
