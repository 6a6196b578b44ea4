/// Schemes over turns of rigid bodies are held to their orders, and to docs/methods.md.

#include "study/turning_traits.hpp"
#include "integrators/all_methods.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

using namespace noether;

TEST_CASE("schemes over turns have their orders, and what docs/methods.md says", "[methods][bodies][slow]") {
  const std::vector<MeasuredTurns> measured = measured_turns();
  for (const MeasuredTurns& one : measured) {
    INFO(one.method << ", " << one.turns() << ": order " << one.order);
    CHECK(one.order > one.claimed_order - 0.35);
    CHECK(one.error < 1);
  }
  const auto has = [&](const char* name, std::optional<Rotor> rotor) {
    return std::any_of(measured.begin(), measured.end(),
                       [&](const MeasuredTurns& one) { return one.method == name && one.rotor == rotor; });
  };
  CHECK((has("verlet", Rotor::axes) && has("yoshida_4", Rotor::axes) && has("srkn14a", Rotor::exact)));
  for (const MethodInfo* info : methods::all()) {
    INFO(info->name);
    if (info->on_groups && info->fixed) CHECK(has(std::string(info->name).c_str(), {}));
  }
  CHECK_FALSE((has("srkn14a", Rotor::axes) || has("blanes_moan_s6", Rotor::axes)));
  INFO("docs/methods.md is written by ./noether list methods --measured > docs/methods.md");
  CHECK(test::read_text(NOETHER_SOURCE_DIR "/docs/methods.md").ends_with(turning_section(measured)));
}
