#include "scene/builders.hpp"

#include "numbers/random.hpp"
#include "scene/builder_pieces.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numeric>

namespace noether {

namespace {

using detail::all_sites, detail::check_above_zero, detail::check_count, detail::check_temperature, detail::cube;
using detail::direction, detail::leave_vacancies, detail::most_built, detail::Site, detail::sites_of_cell;
using detail::take_off_drift, detail::displacement_stream, detail::velocity_stream, detail::walk_stream;

void check_lennard_jones(const std::optional<double>& epsilon, const std::optional<double>& sigma) {
  if (epsilon.has_value() != sigma.has_value()) {
    const char *given = epsilon ? "epsilon" : "sigma", *missing = epsilon ? "sigma" : "epsilon";
    refuse_field(given, epsilon ? *epsilon : *sigma, fmt::format("is given without {}; give both or neither", missing));
  }
  if (epsilon && !(*epsilon >= 0)) refuse_field("epsilon", *epsilon, "is negative; 0 or more is expected");
  if (sigma && !(*sigma >= 0)) refuse_field("sigma", *sigma, "is negative; 0 or more is expected");
}

/// Particles at rest; ids and names count from 1, as in files of structures.
ParticleSystem<double> particles_at(const std::vector<Site>& positions, double mass, const Box& box,
                                    const UnitSystem& units) {
  ParticleSystem<double> s(units);
  std::vector<std::int64_t> ids(positions.size());
  std::iota(ids.begin(), ids.end(), 1);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    s.add(fmt::format("atom_{}", ids[i]), mass, positions[i], Vec3<double>::Zero());
  }
  s.trim();
  s.restore_ids(ids);
  s.set_box(box);
  return s;
}

Topology one_type(Index n, const std::optional<double>& epsilon, const std::optional<double>& sigma) {
  Topology topology;
  topology.type_names = {"1"};
  topology.types.assign(static_cast<std::size_t>(n), 0);
  if (epsilon) topology.pair_kinds = {{*epsilon, *sigma}};
  return topology;
}

void warm(ParticleSystem<double>& s, const std::optional<double>& temperature, std::int64_t seed) {
  if (temperature) set_temperature(s, *temperature, static_cast<std::uint64_t>(seed));
}

}  // namespace

void set_temperature(ParticleSystem<double>& s, double temperature, std::uint64_t seed) {
  check_temperature(temperature);
  const Philox random(seed, velocity_stream);
  const auto& masses = std::as_const(s).masses();
  Index massive = 0;
  for (Index i = 0; i < s.size(); ++i) {
    const auto place = 2 * static_cast<std::uint64_t>(i);
    const auto [a, b] = normal_pair(random.at(place));
    const double c = normal_pair(random.at(place + 1))[0];
    const bool heavy = masses[i] > 0;
    massive += heavy ? 1 : 0;
    s.velocities().set(
        i, heavy ? Vec3<double>(Vec3<double>(a, b, c) / std::sqrt(masses[i])) : Vec3<double>(Vec3<double>::Zero()));
  }
  if (massive < 2) {
    if (temperature > 0) refuse_field("temperature", temperature, "needs two or more particles with mass");
    s.velocities().set_zero();
    return;
  }
  const double twice = take_off_drift(s);
  s.scale_velocities(std::sqrt(static_cast<double>(3 * massive - 3) * s.units().k_B * temperature / twice));
  take_off_drift(s);  // what scaling has left by rounding
}

void Lattice::check() const {
  const std::string shown = fmt::format("[{}]", fmt::join(cells, ", "));
  if (cells.size() != 3)
    refuse_field("cells", shown, "is not a list of three numbers; the cells along x, y and z are expected");
  double count = static_cast<double>(sites_of_cell(lattice));
  for (const std::int64_t n : cells) {
    if (n < 1) refuse_field("cells", shown, "contains a number below 1; whole numbers from 1 are expected");
    count *= static_cast<double>(n);
  }
  if (count > static_cast<double>(most_built)) {
    refuse_field("cells", shown, fmt::format("give {:.3g} particles; at most {} are expected", count, most_built));
  }
  if (density && constant)
    refuse_field("constant", *constant, "is given together with a density; give only one of them");
  if (!density && !constant) {
    throw Error("neither a density nor a constant is given; give one of them", {.key = "density"});
  }
  if (density) check_above_zero("density", *density, "density");
  if (constant) check_above_zero("constant", *constant, "length");
  check_above_zero("mass", mass, "mass");
  check_lennard_jones(epsilon, sigma);
  check_temperature(temperature);
}

ParticleSystem<double> Lattice::build(const UnitSystem& units) const {
  check();
  const double edge = constant ? *constant : std::cbrt(static_cast<double>(sites_of_cell(lattice)) * mass / *density);
  std::vector<Site> sites = all_sites(lattice, cells);
  for (Site& site : sites) site *= edge;
  const Vec3<double> counts(static_cast<double>(cells[0]), static_cast<double>(cells[1]),
                            static_cast<double>(cells[2]));
  ParticleSystem<double> s = particles_at(sites, mass, Box::periodic(counts * edge), units);
  s.set_topology(std::make_shared<const Topology>(one_type(s.size(), epsilon, sigma)));
  warm(s, temperature, seed);
  return s;
}

void Liquid::check() const {
  check_count("particles", particles, 1);
  check_above_zero("density", density, "density");
  check_above_zero("mass", mass, "mass");
  if (!(displacement >= 0 && displacement < 0.5)) {
    refuse_field("displacement", displacement,
                 "is out of range; 0 to below 0.5 is expected, so that particles cannot meet");
  }
  check_lennard_jones(epsilon, sigma);
  check_temperature(temperature);
}

ParticleSystem<double> Liquid::build(const UnitSystem& units) const {
  check();
  const auto wanted = static_cast<std::size_t>(particles);
  std::int64_t cells = 1;
  while (4 * cells * cells * cells < particles) ++cells;
  std::vector<Site> sites = all_sites(LatticeKind::face_centered, {cells, cells, cells});
  leave_vacancies(sites, wanted, seed);
  const double edge = std::cbrt(static_cast<double>(particles) * mass / density);
  const double cell = edge / static_cast<double>(cells), radius = displacement * cell / std::sqrt(2.0);
  Philox displacements(static_cast<std::uint64_t>(seed), displacement_stream);
  for (Site& site : sites) {
    const double distance = radius * std::cbrt(displacements.uniform());
    site = site * cell + distance * direction(displacements);
  }
  ParticleSystem<double> s = particles_at(sites, mass, cube(edge), units);
  s.set_topology(std::make_shared<const Topology>(one_type(s.size(), epsilon, sigma)));
  warm(s, temperature, seed);
  return s;
}

void PolymerChains::check() const {
  check_count("chains", chains, 1);
  check_count("beads", beads, 1);
  if (chains > most_built / beads) {
    refuse_field("chains", fmt::format("{}", chains),
                 fmt::format("of {} beads each are more than {} particles", beads, most_built));
  }
  check_above_zero("density", density, "density");
  check_above_zero("mass", mass, "mass");
  if (!(bond_length >= 0.6 && bond_length < 1.5)) {
    refuse_field("bond_length", bond_length, "is out of range; 0.6 to below 1.5 is expected, where a FENE bond breaks");
  }
  check_above_zero("epsilon", epsilon, "energy");
  check_above_zero("sigma", sigma, "length");
  if (!(bending >= 0)) refuse_field("bending", bending, "is negative; 0 or more is expected");
  check_temperature(temperature);
}

ParticleSystem<double> PolymerChains::build(const UnitSystem& units) const {
  check();
  constexpr double least = 1.02;  // of a bead and the next but one [sigma]
  const double edge = std::cbrt(static_cast<double>(chains * beads) * mass / density);
  std::vector<Site> positions;
  Topology topology = one_type(static_cast<Index>(chains * beads), epsilon, sigma);
  Philox random(static_cast<std::uint64_t>(seed), walk_stream);
  for (std::int64_t chain = 0; chain < chains; ++chain) {
    random.set_place(static_cast<std::uint64_t>(chain) << 32U);  // a chain does not depend on those before
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    Site at = edge * Site(x, y, z);
    Vec3<double> before = Vec3<double>::Zero();
    for (std::int64_t bead = 0; bead < beads; ++bead) {
      const auto index = static_cast<Index>(positions.size());
      if (bead > 0) {
        Vec3<double> bond = bond_length * direction(random);
        while (bead > 1 && (before + bond).squaredNorm() < least * least) bond = bond_length * direction(random);
        at += sigma * bond;
        before = bond;
        topology.bonds.push_back({{index - 1, index}, 0});
      }
      if (bead > 1 && bending > 0) topology.angles.push_back({{index - 2, index - 1, index}, 0});
      positions.push_back(at);
      topology.molecules.push_back(chain + 1);
    }
  }
  topology.bond_kinds = {{"fene", {30 * epsilon / (sigma * sigma), 1.5 * sigma, epsilon, sigma}}};
  if (bending > 0) topology.angle_kinds = {{"cosine", {bending}}};
  topology.scale_by_bonds(static_cast<Index>(positions.size()), {0, 1, 1});
  ParticleSystem<double> s = particles_at(positions, mass, cube(edge), units);
  s.set_topology(std::make_shared<const Topology>(std::move(topology)));
  warm(s, temperature, seed);
  return s;
}

}  // namespace noether
