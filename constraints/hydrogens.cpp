#include "constraints/hydrogens.hpp"

#include "engine/topology.hpp"
#include "numbers/error.hpp"
#include "numbers/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

namespace noether {

namespace {

/// Masses of hydrogens as they are end here, and those of repartitioned ones there, below helium's neighbors [u].
constexpr double surely_hydrogen = 1.6, surely_heavier = 4.1;

bool is_number(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// The name of a particle's type; empty where types have numbers, or no names.
std::string type_name(const ParticleSystem<double>& s, Index i) {
  const Topology* topology = s.topology();
  if (topology == nullptr) return "";
  const auto type = static_cast<std::size_t>(topology->type(i));
  if (type >= topology->type_names.size() || is_number(topology->type_names[type])) return "";
  return topology->type_names[type];
}

}  // namespace

bool is_hydrogen_name(std::string_view name) {
  constexpr std::array<std::string_view, 5> others = {"He", "Hf", "Hg", "Ho", "Hs"};
  name.remove_prefix(std::min(name.find_first_not_of("0123456789"), name.size()));
  if (name.empty() || (name.front() != 'H' && name.front() != 'h')) return false;
  return std::find(others.begin(), others.end(), name) == others.end();
}

bool is_hydrogen(const ParticleSystem<double>& s, Index i) {
  const UnitSystem& units = s.units();
  const std::string type = type_name(s, i);
  const bool named = is_hydrogen_name(type.empty() ? s.name(i) : type);
  if (units.is_reduced()) {
    if (named) return true;
    if (!type.empty()) return false;
    throw BadConstraints(fmt::format(
        "whether '{}' is a hydrogen cannot be told in reduced units, whose masses are in no known unit; give "
        "its type a name, such as H or C, or use bonds",
        s.name(i)));
  }
  const double mass = s.masses()[i] / unit_value("u", units);
  if (mass < surely_hydrogen) return true;
  if (mass >= surely_heavier) return false;
  if (named) return true;
  throw BadConstraints(
      fmt::format("whether '{}' of {:.6g} u is a hydrogen of repartitioned mass cannot be told by its name; give its "
                  "type a name that begins with H, or another mass, or use bonds",
                  s.name(i), mass));
}

}  // namespace noether
