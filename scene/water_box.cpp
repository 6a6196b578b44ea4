#include "scene/water_box.hpp"

#include "engine/charge.hpp"
#include "engine/topology.hpp"
#include "numbers/quantity.hpp"
#include "scene/builder_pieces.hpp"
#include "scene/builders.hpp"

#include <fmt/format.h>
#include <Eigen/LU>

#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

namespace noether {

namespace {

/// A model in nm, degrees, kJ/mol and e; masses in u.
struct WaterConstants {
  double bond, angle, hydrogen_charge, sigma, epsilon, stretching, bending;
  bool rigid;
  double oxygen_mass = 15.9994, hydrogen_mass = 1.008;
};

WaterConstants constants_of(WaterModel model) {
  constexpr double kcal = 4.184;
  if (model == WaterModel::tip3p) return {0.09572, 104.52, 0.417, 0.315061, 0.636386, 502416, 628.02, true};
  if (model == WaterModel::tip3p_flexible) {
    return {0.09572, 104.52, 0.417, 0.315061, 0.636386, 2 * 450 * 100 * kcal, 2 * 55 * kcal, false};
  }
  if (model == WaterModel::spc_fw) {
    return {0.1012, 113.24, 0.41, 0.3165492, 0.1554253 * kcal, 1059.162 * 100 * kcal, 75.90 * kcal, false};
  }
  return {0.1, 109.47, 0.4238, 0.316555789, 78.19743111 * units::molecular::k_B, 345000, 383, true};
}

/// The same in a system of units.
WaterConstants in_units(WaterConstants water, const UnitSystem& units) {
  const auto in = [&](const char* unit) { return unit_value(unit, units); };
  for (double* length : {&water.bond, &water.sigma}) *length *= in("nm");
  for (double* mass : {&water.oxygen_mass, &water.hydrogen_mass}) *mass *= in("u");
  for (double* energy : {&water.epsilon, &water.bending}) *energy *= in("kJ/mol");
  water.stretching *= in("kJ/mol") / (in("nm") * in("nm"));
  water.angle *= units::molecular::degree;
  water.hydrogen_charge *= in("e");
  return water;
}

/// Sites for so many molecules in a cube of edge 1: of the cubic lattice that keeps them farthest apart.
std::vector<detail::Site> places_of(std::int64_t molecules, std::int64_t seed) {
  struct Choice {
    LatticeKind kind;
    double nearest;  // neighbor, in edges of a cell
  };
  std::vector<detail::Site> best;
  double apart = 0;
  for (const auto& [kind, nearest] :
       {Choice{LatticeKind::simple_cubic, 1}, Choice{LatticeKind::body_centered, std::sqrt(0.75)},
        Choice{LatticeKind::face_centered, std::sqrt(0.5)}}) {
    const auto each = static_cast<std::int64_t>(detail::sites_of_cell(kind));
    std::int64_t cells = 1;
    while (each * cells * cells * cells < molecules) ++cells;
    if (nearest / static_cast<double>(cells) <= apart) continue;
    apart = nearest / static_cast<double>(cells);
    best = detail::all_sites(kind, {cells, cells, cells});
    for (detail::Site& site : best) site /= static_cast<double>(cells);
  }
  detail::leave_vacancies(best, static_cast<std::size_t>(molecules), seed);
  return best;
}

/// Vectors from the oxygen of a molecule to its hydrogens, in any direction.
std::array<Vec3<double>, 2> turned(const WaterConstants& water, Philox& random) {
  const Vec3<double> axis = detail::direction(random);
  const Vec3<double> other = detail::direction(random);
  const Vec3<double> across = cross(axis, other).normalized();
  const double along = water.bond * std::cos(water.angle / 2), aside = water.bond * std::sin(water.angle / 2);
  return {Vec3<double>(along * axis + aside * across), Vec3<double>(along * axis - aside * across)};
}

Topology topology_of(const WaterConstants& water, Index molecules) {
  Topology topology;
  topology.type_names = {"O", "H"};
  topology.pair_kinds = {{water.epsilon, water.sigma}, {0, 0}};
  topology.bond_kinds = {{"harmonic", {water.stretching, water.bond}}};
  topology.angle_kinds = {{"harmonic", {water.bending, water.angle}}};
  for (Index m = 0; m < molecules; ++m) {
    const Index o = 3 * m;
    topology.types.insert(topology.types.end(), {0, 1, 1});
    topology.molecules.insert(topology.molecules.end(), 3, m + 1);
    topology.bonds.push_back({{o, o + 1}, 0});
    topology.bonds.push_back({{o, o + 2}, 0});
    topology.angles.push_back({{o + 1, o, o + 2}, 0});
  }
  topology.scale_by_bonds(3 * molecules, {0, 0, 1});
  return topology;
}

/// What is left of the velocities of three particles that form a rigid body: their linear and angular momenta stay.
void move_as_body(ParticleSystem<double>& s, Index first) {
  const auto& masses = std::as_const(s).masses();
  const auto& v = std::as_const(s).velocities();
  std::array<Vec3<double>, 3> arm;
  Vec3<double> center = Vec3<double>::Zero(), drift = Vec3<double>::Zero();
  double mass = 0;
  for (Index k = 0; k < 3; ++k) {
    const Index i = first + k;
    arm[static_cast<std::size_t>(k)] =
        s.box().minimum_image(Vec3<double>(std::as_const(s).positions()[i] - std::as_const(s).positions()[first]));
    mass += masses[i];
    center += masses[i] * arm[static_cast<std::size_t>(k)];
    drift += masses[i] * v[i];
  }
  center /= mass;
  drift /= mass;
  Mat3<double> inertia = Mat3<double>::Zero();
  Vec3<double> spin = Vec3<double>::Zero();
  for (Index k = 0; k < 3; ++k) {
    Vec3<double>& r = arm[static_cast<std::size_t>(k)];
    r -= center;
    inertia += masses[first + k] * (r.squaredNorm() * Mat3<double>::Identity() - r * r.transpose());
    spin += masses[first + k] * cross(r, Vec3<double>(v[first + k] - drift));
  }
  const Vec3<double> rate = inertia.inverse() * spin;
  for (Index k = 0; k < 3; ++k) {
    s.velocities().set(first + k, Vec3<double>(drift + cross(rate, arm[static_cast<std::size_t>(k)])));
  }
}

/// Velocities of rigid molecules of a temperature.
void warm_bodies(ParticleSystem<double>& s, double temperature, std::int64_t seed) {
  set_temperature(s, temperature, static_cast<std::uint64_t>(seed));
  const Index molecules = s.size() / 3;
  for (Index m = 0; m < molecules; ++m) move_as_body(s, 3 * m);
  const double twice = detail::take_off_drift(s);
  if (!(twice > 0)) return;
  s.scale_velocities(std::sqrt(static_cast<double>(6 * molecules - 3) * s.units().k_B * temperature / twice));
  detail::take_off_drift(s);  // what scaling has left by rounding
}

}  // namespace

void WaterBox::check() const {
  detail::check_count("molecules", molecules, 1, detail::most_built / 3);
  detail::check_above_zero("density", density, "density");
  if (hydrogen_mass) detail::check_above_zero("hydrogen_mass", *hydrogen_mass, "mass");
  detail::check_temperature(temperature);
}

ParticleSystem<double> WaterBox::build(const UnitSystem& units) const {
  check();
  if (units.is_reduced()) {
    throw Error("water has lengths and masses of its own, which reduced units do not have; use units = \"molecular\"",
                {.key = "type"});
  }
  const WaterConstants water = in_units(constants_of(model), units);
  const double mass = water.oxygen_mass + 2 * water.hydrogen_mass;
  const double hydrogen = hydrogen_mass.value_or(water.hydrogen_mass), oxygen = mass - 2 * hydrogen;
  if (!(oxygen > 0)) {
    refuse_field("hydrogen_mass", hydrogen,
                 fmt::format("leaves the oxygen no mass; less than {:.6g} u, half of a molecule, is expected",
                             mass / 2 / unit_value("u", units)));
  }
  const double edge = std::cbrt(static_cast<double>(molecules) * mass / density);
  ParticleSystem<double> s(units);
  Philox turns(static_cast<std::uint64_t>(seed), detail::turn_stream);
  Index number = 0;
  for (const detail::Site& place : places_of(molecules, seed)) {
    turns.set_place(4 * static_cast<std::uint64_t>(number++));  // a molecule does not depend on those before
    const Vec3<double> at = edge * place;
    const auto [one, other] = turned(water, turns);
    s.add(fmt::format("O_{}", number), oxygen, at, Vec3<double>::Zero());
    s.add(fmt::format("H1_{}", number), hydrogen, Vec3<double>(at + one), Vec3<double>::Zero());
    s.add(fmt::format("H2_{}", number), hydrogen, Vec3<double>(at + other), Vec3<double>::Zero());
  }
  s.trim();
  std::vector<std::int64_t> ids(static_cast<std::size_t>(s.size()));
  std::iota(ids.begin(), ids.end(), 1);
  s.restore_ids(ids);
  s.set_box(detail::cube(edge));
  auto& charges = s.add_column<Charge>();
  for (Index i = 0; i < s.size(); ++i) charges[i] = (i % 3 == 0 ? -2 : 1) * water.hydrogen_charge;
  s.set_topology(std::make_shared<const Topology>(topology_of(water, number)));
  if (temperature && water.rigid) warm_bodies(s, *temperature, seed);
  if (temperature && !water.rigid) set_temperature(s, *temperature, static_cast<std::uint64_t>(seed));
  return s;
}

}  // namespace noether
