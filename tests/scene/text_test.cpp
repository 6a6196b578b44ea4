// TOML in and out, JSON out.

#include "numbers/error.hpp"
#include "scene/json.hpp"
#include "scene/references.hpp"
#include "scene/toml.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>
#include <string>

namespace noether::test {
namespace {

TEST_CASE("TOML that is printed reads back to the same values and the same text", "[scene][toml]") {
  const std::string text =
      "a = 1\nb = 0.1\nc = 1e+300\nd = \"quotes \\\" and \\\\ and \\n\"\ne = [1, 2.5, \"x\", true]\nf = false\n"
      "\"odd key\" = -0.0\n\n[t]\nx = 5e-324\n\n[t.u]\ny = 100.0\n\n[[t.list]]\nn = 1\n\n[[t.list]]\nn = 2\n";
  const SceneValue value = parse_toml(text, "x.toml");
  CHECK(print_toml(value) == text);
  CHECK(print_toml(parse_toml(print_toml(value), "x.toml")) == text);
  CHECK(std::signbit(*value.find("odd key")->get<double>()));
}

TEST_CASE("values know their lines", "[scene][toml]") {
  const SceneValue value = parse_toml("a = 1\n\n[t]\n# a comment\nb = [1,\n  2]\n[[l]]\nc = 3\n", "x.toml");
  CHECK(value.find("a")->line == 1);
  CHECK(value.find("t")->find("b")->line == 5);
  CHECK(std::get<SceneValue::Array>(value.find("l")->data)[0].line == 7);
}

TEST_CASE("what is no TOML is refused with file and line", "[scene][toml]") {
  const auto refusal = [](const std::string& text) {
    try {
      parse_toml(text, "x.toml");
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refusal("a = 1\na = 2\n") ==
        "x.toml:2: this is not TOML: cannot redefine existing integer 'a' (in a key-value pair)");
  CHECK(refusal("a = \"\xff\"\n").find("x.toml:1: this is not TOML: ") == 0);
  CHECK(refusal(std::string("a = 1\n\0b", 8)).find("x.toml:2: this is not TOML: ") == 0);
  CHECK(refusal("a = 99999999999999999999\n").find("x.toml:1: ") == 0);
}

TEST_CASE("JSON numbers are the shortest that read back, and null where there is none", "[scene][json]") {
  CHECK(Json(0.1).text() == "0.1");
  CHECK(Json(100.0).text() == "100");
  CHECK(Json(1e300).text() == "1e+300");
  CHECK(Json(std::numeric_limits<double>::quiet_NaN()).text() == "null");
  CHECK(Json(-std::numeric_limits<double>::infinity()).text() == "null");
  CHECK(Json(std::optional<double>()).text() == "null");
  CHECK(Json(true).text() == "true");
  CHECK(Json("a \"b\" \\ \n \x01").text() == "\"a \\\"b\\\" \\\\ \\u000a \\u0001\"");
  CHECK(Json::object({{"a", 1}, {"b", Json::list({1.5, "x", Json()})}, {"c", Json::object({})}}).text() ==
        "{\"a\":1,\"b\":[1.5,\"x\",null],\"c\":{}}");
}

TEST_CASE("the literature is built in", "[scene]") {
  CHECK(bibtex("Newton1687").starts_with("@book{Newton1687,"));
  CHECK(bibtex("Newton1687").ends_with("}"));
  CHECK(bibtex("Nobody"
               "1900")
            .empty());
}

}  // namespace
}  // namespace noether::test
