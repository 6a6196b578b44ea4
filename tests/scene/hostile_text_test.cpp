// Text that would break a parser, a report or a terminal.

#include "engine/error.hpp"
#include "engine/text.hpp"
#include "scene/json.hpp"
#include "scene/scene.hpp"
#include "scene/toml.hpp"
#include "tests/support/catch.hpp"

#include <string>

namespace noether::test {
namespace {

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int k = 0; k < times; ++k) all += text;
  return all;
}

std::string toml_refusal(const std::string& text) {
  try {
    parse_toml(text, "x.toml");
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

const std::string too_deep = "tables and lists stand more than 64 deep in one another; a scene needs far fewer";

TEST_CASE("TOML that is nested too deeply is refused before it is parsed", "[scene][toml]") {
  CHECK(toml_refusal("x = 1\n" + repeated("a.", 20000) + "b = 1\n") == "x.toml:2: " + too_deep);
  CHECK(toml_refusal("[" + repeated("a.", 20000) + "b]\n") == "x.toml:1: " + too_deep);
  CHECK(toml_refusal("a = " + repeated("[", 20000) + repeated("]", 20000) + "\n") == "x.toml:1: " + too_deep);
  CHECK(toml_refusal("a = " + repeated("{b = ", 20000) + "1" + repeated("}", 20000) + "\n") == "x.toml:1: " + too_deep);
  CHECK(toml_refusal("a = " + repeated("{b.c.d = ", 30) + "1" + repeated("}", 30) + "\n") == "x.toml:1: " + too_deep);
  CHECK(toml_refusal(repeated("a.", 64) + "b = 1\n").empty());
  CHECK(toml_refusal(repeated("a.", 65) + "b = 1\n") == "x.toml:1: " + too_deep);
  CHECK_FALSE(parse_toml_value(repeated("[", 20000), -1));
}

TEST_CASE("characters beyond ASCII are refused outside strings and comments", "[scene][toml]") {
  CHECK(toml_refusal("x = 1\naé = 1\n") == "x.toml:2: this is not TOML: expected '=', saw 'é' (in a key-value pair)");
  CHECK(toml_refusal("a = é\n") == "x.toml:1: this is not TOML: could not determine value type (in a value)");
  CHECK(toml_refusal("[aé]\n") == "x.toml:1: this is not TOML: expected ']', saw 'é' (in a table header)");
  CHECK(toml_refusal("a = 1 # é\nb = \"é\"\n\"é\" = 'é'\nc = \"\"\"\\\n é\"\"\"\n").empty());
}

TEST_CASE("brackets that hold nothing are refused", "[scene][toml]") {
  for (const char* text : {"[.", "[#", "[[,]]", "a = [}", "a = {]", "[[", "a = [", "="}) {
    CAPTURE(text);
    CHECK(toml_refusal(text).starts_with("x.toml:1: this is not TOML: "));
  }
}

TEST_CASE("dots and brackets in strings, comments and lists of numbers are not depth", "[scene][toml]") {
  const std::string dots = repeated(".", 100), brackets = repeated("[{", 100), numbers = repeated("1.5, ", 200);
  CHECK(toml_refusal("a = \"" + dots + brackets + "\\\"" + dots + "\"\n").empty());
  CHECK(toml_refusal("a = '" + dots + brackets + "\\'\n").empty());
  CHECK(toml_refusal("a = \"\"\"\n" + dots + "\"\" \n" + brackets + "\"\"\"\nb = '''" + dots + "'''\n").empty());
  CHECK(toml_refusal("# " + dots + brackets + "\na = [" + numbers + "]\n# " + dots).empty());
  CHECK(toml_refusal("a = [" + repeated("[1.5, 2.5],\n", 200) + "]\n").empty());
  CHECK(toml_refusal("a = \"\"\"\n\n\"\"\"\n" + repeated("a.", 70) + "b = 1").starts_with("x.toml:4: "));
}

TEST_CASE("JSON is always UTF-8", "[scene][json]") {
  CHECK(Json("a\xFF"
             "b")
            .text() ==
        "\"a\xEF\xBF\xBD"
        "b\"");
  CHECK(is_utf8(Json::object({{"\xC3", Json::list({"\xED\xA0\x80", std::string("\xF0\x9F")})}}).text()));
  CHECK(Json("\xC3\xB6").text() == "\"\xC3\xB6\"");
}

TEST_CASE("what is typed on the command line is no file", "[scene][set]") {
  try {
    read_scene("title = \"x\"\n", "scene.toml", standard_parts(), {"titel.x=1"});
    FAIL("the scene was taken");
  } catch (const SceneError& error) {
    CHECK(error.file().empty());
    CHECK(std::string(error.what()).starts_with("--set titel.x=1: there is no 'titel' in the scene"));
  }
  try {
    read_scene("title = \"x\"\n", "scene.toml", standard_parts(), {"title=\xFF"});
    FAIL("the scene was taken");
  } catch (const SceneError& error) {
    CHECK(escaped(error.what()) == "--set title=\\xff: this is not UTF-8; give text in that encoding");
  }
  try {
    read_scene("title = \"x\"\n", "scene.toml", standard_parts(), {repeated("a.", 20000) + "b=1"});
    FAIL("the scene was taken");
  } catch (const SceneError& error) {
    CHECK(std::string(error.what()).size() < 400);
    CHECK(std::string(error.what()).ends_with("...: the key has 20001 parts; at most 64 are expected"));
  }
}

}  // namespace
}  // namespace noether::test
