#include "cli/run_gravity.hpp"

#include "cli/run_caption.hpp"
#include "engine/sums.hpp"
#include "numbers/error.hpp"

#include <algorithm>
#include <string>

namespace noether {

namespace {

/// Whether pairs move on Kepler orbits under a Hamiltonian alone, as far as its defaults make one.
bool is_keplerian(const Parts::HamiltonianKind& kind) {
  try {
    return kind.claims().kepler;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

bool has_gravity(const SceneValue& scene, const Parts& parts) {
  for (const Parts::HamiltonianKind& kind : parts.hamiltonians()) {
    if (kind.info.name == text_at(scene, {"hamiltonian", "type"}) && is_keplerian(kind)) return true;
  }
  const auto attracts = [&](const SceneValue* force) {
    return std::any_of(parts.forces().begin(), parts.forces().end(), [&](const Parts::ForceKind& kind) {
      return kind.info.name == text_at(*force, {"type"}) && kind.claims.kepler;
    });
  };
  const auto forces = tables_at(scene, {"hamiltonian", "force"});
  return std::any_of(forces.begin(), forces.end(), attracts);
}

bool may_have_gravity(const SceneValue& scene, const Parts& parts) {
  const bool told = value_at(scene, {"hamiltonian"}) != nullptr || value_at(scene, {"system"}) != nullptr;
  return !told || has_gravity(scene, parts);
}

double constant_of_gravity(const SceneValue& scene, double of_units) {
  std::vector<const SceneValue*> tables = tables_at(scene, {"hamiltonian", "force"});
  if (const SceneValue* hamiltonian = scene.find("hamiltonian")) tables.push_back(hamiltonian);
  for (const SceneValue* table : tables) {
    const SceneValue* G = table->find("G");
    if (G == nullptr) continue;
    if (const double* number = G->get<double>()) return *number;
    if (const std::int64_t* whole = G->get<std::int64_t>()) return static_cast<double>(*whole);
  }
  return of_units;
}

std::optional<std::size_t> primary_of(const std::vector<double>& masses) {
  if (masses.size() < 2) return {};
  const auto heaviest = std::max_element(masses.begin(), masses.end());
  const double total =
      sum_over<double>(static_cast<Index>(masses.size()), [&](Index i) { return masses[static_cast<std::size_t>(i)]; });
  if (!(*heaviest > 10 * (total - *heaviest))) return {};
  return static_cast<std::size_t>(heaviest - masses.begin());
}

}  // namespace noether
