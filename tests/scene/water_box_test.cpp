/// Boxes of water: geometry, density, charges, masses, temperature; and what scenes make of them.

#include "scene/water_box.hpp"

#include "constraints/structure_constraints.hpp"
#include "engine/charge.hpp"
#include "engine/topology.hpp"
#include "monitors/monitors.hpp"
#include "monitors/temperature.hpp"
#include "numbers/quantity.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace noether::test {
namespace {

using namespace units::molecular;

WaterBox box_of(WaterModel model, std::int64_t molecules = 64) {
  return {.model = model, .molecules = molecules, .density = 0.997 * g_per_cm3, .temperature = 300 * K, .seed = 7};
}

Vec3<double> apart(const ParticleSystem<double>& s, Index i, Index j) {
  return s.box().minimum_image(Vec3<double>(s.positions()[j] - s.positions()[i]));
}

/// Twice the kinetic energy [energy].
double twice_kinetic(const ParticleSystem<double>& s) {
  double twice = 0;
  for (Index i = 0; i < s.size(); ++i) twice += s.masses()[i] * Vec3<double>(s.velocities()[i]).squaredNorm();
  return twice;
}

Scene good(const std::string& name, const std::vector<std::string>& sets = {}) {
  return load_scene(std::filesystem::path(NOETHER_SOURCE_DIR) / "tests/scenes/good" / name, standard_parts(), sets);
}

TEST_CASE("molecules of water have the geometry of their model", "[builders][water]") {
  struct Facts {
    WaterModel model;
    double bond, angle;
  };
  for (const auto& [model, bond, angle] : {Facts{WaterModel::spce, 0.1, 109.47},
                                           {WaterModel::tip3p, 0.09572, 104.52},
                                           {WaterModel::spc_fw, 0.1012, 113.24}}) {
    const auto s = box_of(model).build();
    for (Index o = 0; o < s.size(); o += 3) {
      const Vec3<double> one = apart(s, o, o + 1), other = apart(s, o, o + 2);
      CHECK(std::abs(one.norm() - bond) < 1e-14);
      CHECK(std::abs(other.norm() - bond) < 1e-14);
      CHECK(std::abs(std::acos(one.dot(other) / one.norm() / other.norm()) * 180 / std::numbers::pi - angle) < 1e-10);
    }
  }
}

TEST_CASE("a box of water has its density, no charge, and types, molecules, bonds and exclusions",
          "[builders][water]") {
  const auto s = box_of(WaterModel::spce, 100).build();
  CHECK(s.size() == 300);
  CHECK(std::abs(s.masses().all().sum() / s.box().volume() - 0.997 * g_per_cm3) < 1e-12);
  double charge = 0;
  for (Index i = 0; i < s.size(); ++i) charge += s.column<Charge>()[i];
  CHECK(charge == 0);
  CHECK(s.column<Charge>()[1] == 0.4238);
  const Topology& topology = *s.topology();
  CHECK(topology.bonds.size() == 200);
  CHECK(topology.angles.size() == 100);
  CHECK(topology.exclusions.size() == 300);
  CHECK(topology.molecules.back() == 100);
  CHECK(topology.type_names == std::vector<std::string>{"O", "H"});
  CHECK(topology.pair_kind(0, 0) == PairKind{78.19743111 * k_B, 0.316555789});
  CHECK(topology.pair_kind(0, 1).epsilon == 0);
  CHECK(s.name(299) == "H2_100");
}

TEST_CASE("atoms of two molecules of water do not overlap, however many there are", "[builders][water]") {
  for (const std::int64_t molecules : {1, 2, 9, 17, 64, 100, 216}) {
    const auto s = box_of(WaterModel::spce, molecules).build();
    double oxygens = std::numeric_limits<double>::infinity(), any = oxygens;
    for (Index i = 0; i < s.size(); ++i) {
      for (Index j = i + 1; j < s.size(); ++j) {
        if (i / 3 == j / 3) continue;
        const double r = apart(s, i, j).norm();
        any = std::min(any, r);
        if (i % 3 == 0 && j % 3 == 0) oxygens = std::min(oxygens, r);
      }
    }
    CAPTURE(molecules);
    CHECK(oxygens > 0.27);
    CHECK(any > 0.07);
  }
}

TEST_CASE("mass is moved from oxygens to hydrogens, and stays", "[builders][water]") {
  WaterBox wanted = box_of(WaterModel::tip3p);
  wanted.hydrogen_mass = 4 * u;
  const auto s = wanted.build();
  CHECK(s.masses()[1] == 4);
  CHECK(std::abs(s.masses()[0] - (15.9994 + 2.016 - 8)) < 1e-14);
  CHECK(hydrogen_bonds(s).equations() == 2 * 64);
  wanted.hydrogen_mass = 10 * u;
  CHECK(refusal_of([&] { wanted.build(); }) ==
        "hydrogen_mass = 10 leaves the oxygen no mass; less than 9.0077 u, half of a molecule, is expected");
}

TEST_CASE("rigid water has the temperature asked for by its six degrees of freedom, and no velocity along a bond",
          "[builders][water]") {
  const auto s = box_of(WaterModel::spce).build();
  CHECK(std::abs(twice_kinetic(s) / ((6 * 64 - 3) * k_B) - 300) < 1e-11);
  Vec3<double> momentum = Vec3<double>::Zero();
  for (Index i = 0; i < s.size(); ++i) momentum += s.masses()[i] * Vec3<double>(s.velocities()[i]);
  CHECK(momentum.norm() < 1e-12);
  for (Index o = 0; o < s.size(); o += 3) {
    for (const auto& [i, j] : {std::pair(o, o + 1), std::pair(o, o + 2), std::pair(o + 1, o + 2)}) {
      CHECK(std::abs(apart(s, i, j).dot(Vec3<double>(s.velocities()[j] - s.velocities()[i]))) < 1e-14);
    }
  }
  const auto flexible = box_of(WaterModel::spc_fw).build();
  CHECK(std::abs(twice_kinetic(flexible) / ((9 * 64 - 3) * k_B) - 300) < 1e-11);
}

TEST_CASE("water is the same in other units, by its seed, and refused where lengths have none",
          "[builders][water][refusal]") {
  const WaterBox wanted = box_of(WaterModel::tip3p, 20);
  const auto s = wanted.build();
  CHECK(s.positions().all() == box_of(WaterModel::tip3p, 20).build().positions().all());
  WaterBox other = wanted;
  other.seed = 8;
  CHECK(!(s.positions().all() == other.build().positions().all()));
  other = wanted;
  other.density = unit_value("g/cm^3", unit_system("si")) * 0.997;
  const auto si = other.build(unit_system("si"));
  for (Index i = 0; i < s.size(); ++i) {
    CHECK((Vec3<double>(si.positions()[i]) * 1e9 - Vec3<double>(s.positions()[i])).norm() < 1e-12);
    CHECK((Vec3<double>(si.velocities()[i]) * 1e-3 - Vec3<double>(s.velocities()[i])).norm() < 1e-6);
  }
  CHECK(refusal_of([&] { wanted.build(unit_system("reduced")); }) ==
        "water has lengths and masses of its own, which reduced units do not have; use units = \"molecular\"");
  const auto refused = [&](auto change) {
    WaterBox bad = wanted;
    change(bad);
    return refusal_of([&] { bad.build(); });
  };
  CHECK(refused([](WaterBox& w) { w.molecules = 0; }) == "molecules = 0 is out of range; 1 to 33333333 is expected");
  CHECK(refused([](WaterBox& w) { w.density = -1; }) ==
        "density = -1 is not a valid density; a number above 0 is expected");
  CHECK(refused([](WaterBox& w) { w.hydrogen_mass = 0; }) ==
        "hydrogen_mass = 0 is not a valid mass; a number above 0 is expected");
}

TEST_CASE("a scene of rigid water has its temperature at the start, and half of its degrees of freedom less",
          "[scene][water]") {
  Scene scene = good("water_rigid.toml");
  CHECK(constraints_of(scene).equations() == 3 * 64);
  scene.minimize.reset();
  Simulation<double> sim(scene.particles, integrator_of(scene), scene.integrator.step);
  const auto& temperature = sim.every(1000, Temperature{});
  REQUIRE(sim.run(1).ok());
  CHECK(temperature.degrees_of_freedom() == 6 * 64 - 3);
  CHECK(std::abs(*temperature.report().first / 300 - 1) < 1e-12);
}

TEST_CASE("energies of scenes of water do not drift in a few hundred steps", "[scene][water]") {
  for (const char* name : {"water_rigid.toml", "water_flexible.toml"}) {
    const Scene scene =
        good(name, {"particles.temperature=100 K", "particles.molecules=27", "hamiltonian.force.0.cutoff=0.45 nm",
                    "hamiltonian.force.1.cutoff=0.45 nm", "integrator.step=0.25 fs"});
    Simulation<double> sim(scene.particles, integrator_of(scene), scene.integrator.step);
    const auto& energy = sim.every(10, Energy{});
    REQUIRE(sim.run(400).ok());
    CAPTURE(name);
    CHECK(std::abs(*energy.report().worst) < 0.02);
  }
}

}  // namespace
}  // namespace noether::test
