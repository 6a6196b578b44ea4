#include "numbers/units.hpp"

#include "numbers/error.hpp"
#include "numbers/suggest.hpp"

#include <string>
#include <vector>

namespace noether {

namespace {

constexpr std::array<UnitSystem, 4> systems{{
    {"solar", "au", "Msun", "day", "e", "K", "Msun au^2/day^2", units::solar::G, units::solar::k_B,
     units::solar::coulomb_constant, units::solar_scale},
    {"molecular", "nm", "u", "ps", "e", "K", "kJ/mol", units::molecular::G, units::molecular::k_B,
     units::molecular::coulomb_constant, units::molecular_scale},
    {"si", "m", "kg", "s", "C", "K", "J", units::si::G, units::si::k_B, units::si::coulomb_constant, units::si_scale},
    {"reduced", "1", "1", "1", "1", "1", "1", 1.0, 1.0, 1.0, std::nullopt},
}};

}  // namespace

const std::array<UnitSystem, 4>& unit_systems() noexcept { return systems; }

const UnitSystem& unit_system(std::string_view name) {
  std::vector<std::string> known;
  for (const UnitSystem& system : systems) {
    if (system.name == name) return system;
    known.emplace_back(system.name);
  }
  const std::string word(name);
  throw Error("unknown unit system '" + word + "'" + did_you_mean(word, known), {.value = word});
}

}  // namespace noether
