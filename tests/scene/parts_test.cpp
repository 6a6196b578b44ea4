// What parts say of themselves, and what they refuse.

#include "scene/parts.hpp"
#include "forces/check_gradient.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/linear_drag.hpp"
#include "forces/oblateness.hpp"
#include "scene/references.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/refusal.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace noether::test {
namespace {

template <class Part> std::string part_refusal(const Part& part) {
  return refusal_of([&] { check_part(part); });
}

TEST_CASE("a part refuses fields that make no sense", "[parts]") {
  CHECK(part_refusal(Gravity{}).empty());
  CHECK(part_refusal(Gravity{.softening = -1}) ==
        "softening = -1 is not a valid length; 0 (point masses) or more is expected");
  CHECK(part_refusal(Gravity{.G = 0.0}) == "G = 0 is not a valid gravitational constant; a number above 0 is expected");
  CHECK(part_refusal(LinearDrag{.rate = -0.5}) ==
        "rate = -0.5 would drive the motion instead of damping it; 0 or more is expected");
  CHECK(part_refusal(Oblateness{.J2 = 0.1, .radius = 1}).empty());
  CHECK(part_refusal(Oblateness{.radius = 1}) == "oblateness has neither J2 nor J4, so it would do nothing; give one");
  CHECK(part_refusal(Oblateness{.J4 = 0.1}) == "radius = 0 is not a valid radius; a length above 0 is expected");
  CHECK(part_refusal(Oblateness{.J4 = 0.1, .radius = 1, .axis = {0, 0, 0}}) ==
        "axis = [0, 0, 0] has no direction; expected one such as [0, 0, 1]");
  CHECK(part_refusal(UniformField{}).empty());  // it has no check of its own
}

TEST_CASE("check_gradient asks the force for its fields first", "[parts]") {
  ParticleSystem<double> s;
  s.add("one", 1, {0, 0, 0}, {0, 0, 0});
  s.add("other", 1, {1, 0, 0}, {0, 0, 0});
  check_gradient(Gravity{.softening = 0.1}, s);
  CHECK_THROWS_WITH(check_gradient(Gravity{.softening = -0.1}, s),
                    "softening = -0.1 is not a valid length; 0 (point masses) or more is expected");
}

TEST_CASE("fields that a scene must give have an example instead of a default", "[parts]") {
  const PartInfo info = part_info<Oblateness>();
  const auto radius = std::find_if(info.fields.begin(), info.fields.end(),
                                   [](const FieldInfo& field) { return field.name == "radius"; });
  REQUIRE(radius != info.fields.end());
  CHECK(radius->example == "\"60330 km\"");
  CHECK(radius->default_value.empty());
  CHECK(radius->help == "equatorial radius of the primary");
  CHECK(info.fields[0].example.empty());
  CHECK(info.fields[0].default_value == "0.0");
}

TEST_CASE("whatever watches or ends a run tells its formula or its quantities", "[parts]") {
  std::vector<PartInfo> infos = writer_parts();
  const Parts parts = standard_parts();
  for (const auto& kind : parts.monitors()) infos.push_back(kind.info);
  for (const auto& kind : parts.stops()) infos.push_back(kind.info);
  REQUIRE(infos.size() >= 10);
  for (const PartInfo& info : infos) {
    INFO(info.name);
    CHECK_FALSE(info.help.empty());
    CHECK_FALSE(info.quantities.empty());
  }
}

TEST_CASE("each entry of the literature begins with its type and its key", "[parts]") {
  const std::string all = references_bib();
  std::size_t entries = 0;
  for (std::size_t at = all.find("\n@"); at != std::string::npos; at = all.find("\n@", at + 1)) {
    const std::size_t open = all.find('{', at), comma = all.find(',', open);
    const std::string head = all.substr(at + 1, comma + 1 - at - 1), key = all.substr(open + 1, comma - open - 1);
    INFO(key);
    const std::string entry = bibtex(key);
    CHECK(entry.starts_with(head));
    CHECK(entry.ends_with("}"));
    CHECK(entry.find("\n@") == std::string::npos);
    ++entries;
  }
  CHECK(entries >= 30);
  CHECK(bibtex("KEY").empty());
  CHECK(bibtex("").empty());
}

}  // namespace
}  // namespace noether::test
