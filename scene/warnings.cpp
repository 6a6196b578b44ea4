#include "scene/warnings.hpp"

#include "engine/charge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace noether {

namespace {

/// Forces of short range that are known to ask for no charges; what others ask for nobody knows.
constexpr std::array<std::string_view, 7> without_charges = {"lennard_jones", "wca",    "morse",        "buckingham",
                                                             "bonded",        "tether", "harmonic_bond"};

/// Forces between pairs that leave excluded ones out.
constexpr std::array<std::string_view, 5> with_exclusions = {"lennard_jones", "wca", "morse", "buckingham",
                                                             "reaction_field"};
/// Forces that are known to act on excluded pairs too, or on no pairs.
constexpr std::array<std::string_view, 10> without_exclusions = {
    "gravity",        "oblateness",   "uniform_field",    "oscillating_field",
    "harmonic_field", "henon_heiles", "fermi_pasta_ulam", "harmonic_bond",
    "tether",         "bonded"};

bool has_charges(const ParticleSystem<double>& s) {
  if (!s.has<Charge>()) return false;
  const auto& q = s.column<Charge>();
  for (Index i = 0; i < s.size(); ++i) {
    if (q[i] != 0) return true;
  }
  return false;
}

}  // namespace

std::vector<std::string> warnings_of(const Scene& scene) {
  std::vector<std::string> warnings;
  const std::vector<SceneForce>& forces = scene.hamiltonian.forces;
  const auto is_bonded = [](const SceneForce& force) { return force.name == "bonded"; };
  // Constraints may stand in the place of bonds.
  if (const Topology* t = scene.particles.topology();
      t != nullptr && scene.hamiltonian.constraints.empty() && std::none_of(forces.begin(), forces.end(), is_bonded)) {
    const std::size_t terms = t->bonds.size() + t->angles.size() + t->dihedrals.size() + t->impropers.size();
    if (terms > 0) {
      warnings.push_back(fmt::format("the structure has {} bonded {} that nothing acts on: there is no force 'bonded'",
                                     terms, terms == 1 ? "term" : "terms"));
    }
  }
  const auto all_among = [&](const auto& names) {
    return std::all_of(forces.begin(), forces.end(), [&](const SceneForce& force) {
      return std::find(names.begin(), names.end(), force.name) != names.end();
    });
  };
  if (!forces.empty() && all_among(without_charges) && has_charges(scene.particles)) {
    warnings.emplace_back("the particles have charges that no force looks at");
  }
  const SceneValue* particles = scene.effective.find("particles");
  if (all_among(without_exclusions) && particles != nullptr && particles->find("exclusions") != nullptr) {
    warnings.push_back(fmt::format("exclusions change nothing: no force leaves pairs out; those that do are {}",
                                   fmt::join(with_exclusions, ", ")));
  }
  return warnings;
}

}  // namespace noether
