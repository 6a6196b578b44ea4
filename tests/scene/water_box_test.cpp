/// Boxes of water: geometry, density, charges, masses, temperature; and what scenes make of them.

#include "scene/water_box.hpp"

#include "constraints/structure_constraints.hpp"
#include "engine/charge.hpp"
#include "engine/topology.hpp"
#include "forces/bonded.hpp"
#include "monitors/monitors.hpp"
#include "monitors/temperature.hpp"
#include "numbers/dual.hpp"
#include "numbers/quantity.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/refusal.hpp"

#include <Eigen/Eigenvalues>

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
                                           {WaterModel::spc_fw, 0.1012, 113.24},
                                           {WaterModel::tip3p_flexible, 0.09572, 104.52}}) {
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
  for (const WaterModel model : {WaterModel::spc_fw, WaterModel::tip3p_flexible}) {
    const auto flexible = box_of(model).build();
    CHECK(std::abs(twice_kinetic(flexible) / ((9 * 64 - 3) * k_B) - 300) < 1e-11);
  }
}

/// Squares of the frequencies of a molecule at rest, from the least: eigenvalues of its Hessian over its masses, by
/// duals of the forces of bonds and angles.
std::vector<double> squared_frequencies(const ParticleSystem<double>& s) {
  using Number = Dual<Quad, 1>;
  auto moved = s.as<Quad>().as<Number>();
  const Index n = 3 * s.size();
  Eigen::MatrixXd hessian(n, n);
  for (Index column = 0; column < n; ++column) {
    moved.positions().component(static_cast<int>(column % 3))[column / 3].slope[0] = Quad(1);
    VectorColumn<Number> a(s.size());
    ForceSink<Number> sink(a, moved, {});
    Bonded{}.add_to(sink, moved);
    moved.positions().component(static_cast<int>(column % 3))[column / 3].slope[0] = Quad(0);
    for (Index row = 0; row < n; ++row) {
      const double slope = static_cast<double>(std::as_const(a).component(static_cast<int>(row % 3))[row / 3].slope[0]);
      hessian(row, column) = -slope * std::sqrt(s.masses()[row / 3] / s.masses()[column / 3]);
    }
  }
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(hessian).eigenvalues();
  return {values.begin(), values.end()};
}

TEST_CASE("a free molecule of flexible water swings with the frequencies of its springs", "[builders][water]") {
  // Wilson's F and G of a bent molecule by hand, in rad/ps (1737, 3323, 3370 and 1371, 3587, 3671 /cm): the stretch of
  // opposite signs alone, (k, 1/m_H + (1 - cos angle)/m_O); of the same sign with the bend by the roots of a square,
  // with k and k_angle in kJ/mol of the sources' 450 kcal/mol/A^2 and 55 kcal/mol, without a factor 1/2, for tip3p.
  struct Facts {
    WaterModel model;
    std::array<double, 3> frequencies;
  };
  for (const auto& [model, frequencies] :
       {Facts{WaterModel::tip3p_flexible, {327.15819320709676, 625.8544641968359, 634.8292519056203}},
        {WaterModel::spc_fw, {258.25687610393106, 675.7497995866784, 691.5660766015393}}}) {
    const std::vector<double> squares = squared_frequencies(box_of(model, 1).build());
    REQUIRE(squares.size() == 9);
    for (std::size_t k = 0; k < 6; ++k) CHECK(std::abs(squares[k]) < 1e-6);  // moves and turns of the whole
    for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(std::sqrt(squares[6 + k]) / frequencies[k] - 1) < 1e-10);
  }
}

TEST_CASE("a bent molecule of flexible TIP3P has the energy of CHARMM's springs", "[builders][water]") {
  WaterBox wanted = box_of(WaterModel::tip3p_flexible, 1);
  wanted.density /= 1000;
  auto s = wanted.build();
  const double angle = 110 * std::numbers::pi / 180;
  const Vec3<double> oxygen = s.positions()[0];
  s.positions().set(1, Vec3<double>(oxygen + 0.1 * Vec3<double>(1, 0, 0)));
  s.positions().set(2, Vec3<double>(oxygen + 0.093 * Vec3<double>(std::cos(angle), std::sin(angle), 0)));
  VectorColumn<double> a(3);
  ForceSink<double> sink(a, s, {.energy = true});
  Bonded{}.add_to(sink, s);
  // As MacKerell et al. write it: K (r - r0)^2 and K (theta - theta0)^2 in kcal/mol, Angstrom and radians.
  const double turned = (110 - 104.52) * std::numbers::pi / 180;
  const double kcal = 450 * (0.0428 * 0.0428 + 0.0272 * 0.0272) + 55 * turned * turned;
  CHECK(std::abs(sink.potential() / (4.184 * kcal) - 1) < 1e-12);
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
  CHECK(
      refusal_of([] { good("water_flexible.toml", {"particles.model=tip3p_fs"}); }) ==
      "--set particles.model=tip3p_fs: unknown model 'tip3p_fs' in builder 'water_box'; expected one of: spce, tip3p, "
      "spc_fw, tip3p_flexible");
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
  for (const auto& [name, model] : {std::pair("water_rigid.toml", "spce"),
                                    {"water_flexible.toml", "spc_fw"},
                                    {"water_flexible.toml", "tip3p_flexible"}}) {
    const Scene scene = good(
        name, {"particles.model=" + std::string(model), "particles.temperature=100 K", "particles.molecules=27",
               "hamiltonian.force.0.cutoff=0.45 nm", "hamiltonian.force.1.cutoff=0.45 nm", "integrator.step=0.25 fs"});
    Simulation<double> sim(scene.particles, integrator_of(scene), scene.integrator.step);
    const auto& energy = sim.every(10, Energy{});
    REQUIRE(sim.run(400).ok());
    CAPTURE(model);
    CHECK(std::abs(*energy.report().worst) < 0.02);
  }
}

}  // namespace
}  // namespace noether::test
