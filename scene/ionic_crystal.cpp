#include "scene/ionic_crystal.hpp"

#include "engine/charge.hpp"
#include "engine/topology.hpp"
#include "scene/builder_pieces.hpp"
#include "scene/builders.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numeric>

namespace noether {

namespace {

LatticeKind sites_of_ions(IonicLattice lattice) {
  return lattice == IonicLattice::cesium_chloride ? LatticeKind::simple_cubic : LatticeKind::face_centered;
}

/// @throws Error  for what is not two numbers above 0, or of `zero_too` 0 or more
void check_two(std::string_view key, const std::vector<double>& values, bool zero_too) {
  const std::string shown = fmt::format("[{}]", fmt::join(values, ", "));
  if (values.size() != 2) refuse_field(key, shown, "is not a list of two numbers; one for each type is expected");
  for (const double value : values) {
    if (value > 0 && std::isfinite(value)) continue;
    if (zero_too && value == 0) continue;
    refuse_field(key, shown,
                 zero_too ? "contains a number below 0; 0 or more is expected"
                          : "contains a number that is not above 0; two numbers above 0 are expected");
  }
}

}  // namespace

void IonicCrystal::check() const {
  check_two("masses", masses, false);
  if (ions.size() != 2 || ions[0] == ions[1] || ions[0].empty() || ions[1].empty()) {
    refuse_field("ions", fmt::format("[{}]", fmt::join(ions, ", ")),
                 "is not a list of two names; such as [\"Na\", \"Cl\"] is expected");
  }
  if (!(std::isfinite(charge) && charge != 0))
    refuse_field("charge", charge, "is not a valid charge; a number other than 0 is expected");
  if (epsilon.empty() != sigma.empty()) {
    const bool given = !epsilon.empty();
    refuse_field(given ? "epsilon" : "sigma", fmt::format("[{}]", fmt::join(given ? epsilon : sigma, ", ")),
                 fmt::format("is given without {}; give both or neither", given ? "sigma" : "epsilon"));
  }
  if (!epsilon.empty()) check_two("epsilon", epsilon, true);
  if (!sigma.empty()) check_two("sigma", sigma, true);
  Lattice{.lattice = sites_of_ions(lattice),
          .cells = cells,
          .density = density,
          .constant = constant,
          .mass = masses[0] + masses[1],
          .temperature = temperature}
      .check();
}

ParticleSystem<double> IonicCrystal::build(const UnitSystem& units) const {
  check();
  const LatticeKind kind = sites_of_ions(lattice);
  const double pairs = static_cast<double>(detail::sites_of_cell(kind));
  const double edge = constant ? *constant : std::cbrt(pairs * (masses[0] + masses[1]) / *density);
  const double shift = lattice == IonicLattice::zinc_blende ? 0.25 : 0.5;
  ParticleSystem<double> s(units);
  int number = 0;
  for (const detail::Site& site : detail::all_sites(kind, cells)) {
    ++number;
    s.add(fmt::format("{}_{}", ions[0], number), masses[0], edge * site, Vec3<double>::Zero());
    s.add(fmt::format("{}_{}", ions[1], number), masses[1], edge * Vec3<double>(site.array() + shift),
          Vec3<double>::Zero());
  }
  s.trim();
  std::vector<std::int64_t> ids(static_cast<std::size_t>(s.size()));
  std::iota(ids.begin(), ids.end(), 1);
  s.restore_ids(ids);
  s.set_box(Box::periodic(edge * Vec3<double>(static_cast<double>(cells[0]), static_cast<double>(cells[1]),
                                              static_cast<double>(cells[2]))));
  auto& charges = s.add_column<Charge>();
  Topology topology;
  topology.type_names = ions;
  for (Index i = 0; i < s.size(); ++i) {
    charges[i] = i % 2 == 0 ? charge : -charge;
    topology.types.push_back(i % 2 == 0 ? 0 : 1);
  }
  if (!epsilon.empty()) topology.pair_kinds = {{epsilon[0], sigma[0]}, {epsilon[1], sigma[1]}};
  s.set_topology(std::make_shared<const Topology>(std::move(topology)));
  if (temperature) set_temperature(s, *temperature, static_cast<std::uint64_t>(seed));
  return s;
}

}  // namespace noether
