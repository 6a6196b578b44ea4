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
  const bool nobody_asks = std::all_of(forces.begin(), forces.end(), [](const SceneForce& force) {
    return std::find(without_charges.begin(), without_charges.end(), force.name) != without_charges.end();
  });
  if (!forces.empty() && nobody_asks && has_charges(scene.particles)) {
    warnings.emplace_back("the particles have charges that no force looks at");
  }
  return warnings;
}

}  // namespace noether
