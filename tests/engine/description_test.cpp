/// A part describes itself once, and everything else is read from that.

#include "engine/description.hpp"

#include "engine/erasure.hpp"
#include "tests/support/catch.hpp"

#include <string>
#include <vector>

namespace noether {
namespace {

struct Spring {
  double k = 2;
  double length = 0;
  std::int64_t stretches = 0;
  std::optional<double> last = {};

  static constexpr auto describe() {
    return part<Spring>("spring", "a spring", field<&Spring::k>("k", "mass/time^2", "stiffness"),
                        state<&Spring::stretches>("stretches"), formula("U = k r^2/2"), source("Hooke1678"),
                        field<&Spring::length>("length", "length"), state<&Spring::last>("last"));
  }
};

struct Plain {};

std::vector<std::string> field_names() {
  std::vector<std::string> names;
  for_each_field<Spring>([&](const auto& f) { names.push_back(std::string(f.name) + ":" + std::string(f.dimension)); });
  return names;
}

}  // namespace

TEST_CASE("fields and states are visited in the order of the description", "[description]") {
  CHECK(field_names() == std::vector<std::string>{"k:mass/time^2", "length:length"});
  std::vector<std::string> states;
  for_each_state<Spring>([&](const auto& s) { states.emplace_back(s.name); });
  CHECK(states == std::vector<std::string>{"stretches", "last"});
}

TEST_CASE("a field leads to the member it stands for", "[description]") {
  Spring spring;
  for_each_field<Spring>([&](const auto& f) { spring.*(f.member) += 1; });
  CHECK(spring.k == 3);
  CHECK(spring.length == 1);
  for_each_field<Spring>(
      [](const auto& f) { static_assert(std::is_same_v<typename std::decay_t<decltype(f)>::value_type, double>); });
}

TEST_CASE("formula and source are found; what is not given is empty", "[description]") {
  static_assert(entry_text<Spring, Formula>() == "U = k r^2/2");
  static_assert(entry_text<Spring, Source>() == "Hooke1678");
  static_assert(part_name<Spring>() == "spring");
  static_assert(part_name<Plain>().empty());
  static_assert(Described<Spring> && !Described<Plain>);
  CHECK(detail::name_of(Spring{}) == "spring");
  CHECK(detail::name_of(Plain{}).empty());
}

TEST_CASE("the declared state is saved and comes back, parameters are not", "[description]") {
  Spring spring{.k = 5, .length = 1, .stretches = 7, .last = 0.25};
  SavedState saved;
  save_part(saved, "springs/0", spring);
  CHECK(saved.count("springs/0/stretches") == 1);
  CHECK(saved.count("springs/0/last/value") == 1);
  CHECK(saved.count("springs/0/k") == 0);
  Spring again;
  load_part(saved, "springs/0", again);
  CHECK(again.stretches == 7);
  CHECK(again.last == 0.25);
  CHECK(again.k == 2);

  SavedState bare;
  save_part(bare, "", spring);
  CHECK(bare.count("stretches") == 1);
  CHECK_THROWS_WITH(load_part(bare, "elsewhere", again),
                    "the saved state has no array 'elsewhere/stretches' of the expected type");
}

TEST_CASE("a part without a description has no state", "[description]") {
  SavedState saved;
  Plain plain;
  detail::save_any(saved, "plain", plain);
  detail::load_any(saved, "plain", plain);
  CHECK(saved.empty());
}

}  // namespace noether
