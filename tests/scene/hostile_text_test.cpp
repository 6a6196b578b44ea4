// Text that would break a parser, a report or a terminal.

#include "numbers/error.hpp"
#include "numbers/text.hpp"
#include "scene/json.hpp"
#include "scene/scene.hpp"
#include "scene/toml.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/process.hpp"

#include <cstdint>
#include <filesystem>
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

const std::string too_deep = "tables and lists are nested more than 64 levels deep; a scene needs far fewer";

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
  CHECK(toml_refusal("x = 1\na\xC3\xA9 = 1\n") ==
        "x.toml:2: this is not TOML: expected '=', saw '\xC3\xA9' (in a key-value pair)");
  CHECK(toml_refusal("a = \xC3\xA9\n") == "x.toml:1: this is not TOML: could not determine value type (in a value)");
  CHECK(toml_refusal("[a\xC3\xA9]\n") ==
        "x.toml:1: this is not TOML: expected ']', saw '\xC3\xA9' (in a table header)");
  CHECK(toml_refusal("a = 1 # \xC3\xA9\nb = \"\xC3\xA9\"\n\"\xC3\xA9\" = '\xC3\xA9'\nc = \"\"\"\\\n \xC3\xA9\"\"\"\n")
            .empty());
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

/// What loading a file says, without the name of its folder.
std::string load_refusal(const std::filesystem::path& file) {
  try {
    load_scene(file);
  } catch (const Error& error) {
    const std::string text = error.what(), folder = file.parent_path().string() + "/";
    return text.starts_with(folder) ? text.substr(folder.size()) : text;
  }
  return "";
}

TEST_CASE("a scene of a gigabyte is refused before it is read", "[scene][hostile]") {
  const ScratchFolder folder;
  const std::filesystem::path file = folder / "large.toml";
  write_text(file, "units = \"reduced\"\n");
  std::filesystem::resize_file(file, std::uintmax_t{1} << 30U);
  CHECK(load_refusal(file) ==
        "large.toml: the file is too large for a scene; at most 64 MB are expected: put the bodies into a table, "
        "bodies = \"FILE.csv\"");
}

TEST_CASE("bytes that are no text are refused as a scene", "[scene][hostile]") {
  const ScratchFolder folder;
  for (const std::string& bytes :
       {std::string(1000, '\0'),
        std::string("\x7f"
                    "ELF\x02\x01\x01"),
        std::string("\xff\xfe[\0]\0", 6), repeated("\x80", 5000)}) {
    write_text(folder / "x.toml", bytes);
    CHECK(load_refusal(folder / "x.toml").starts_with("x.toml:1: this is not TOML: "));
  }
  write_text(folder / "x.toml", "\x89HDF\r\n\x1a\n");
  CHECK(load_refusal(folder / "x.toml").find("this is an HDF5 file, and a scene is expected") != std::string::npos);
  std::uint32_t state = 1;
  for (int repeat = 0; repeat < 200; ++repeat) {
    std::string bytes;
    for (int k = 0; k < 300; ++k) bytes += static_cast<char>((state = state * 1664525U + 1013904223U) >> 24U);
    write_text(folder / "x.toml", bytes);
    const std::string said = load_refusal(folder / "x.toml");
    CHECK(said.starts_with("x.toml:"));
    CHECK(said.find('\n') == std::string::npos);
  }
}

TEST_CASE("a device is no scene, and no table of bodies", "[scene][hostile]") {
  CHECK(load_refusal("/dev/zero").ends_with("zero: is a device, not a file"));
  const ScratchFolder folder;
  write_text(folder / "x.toml",
             "units = \"reduced\"\nhamiltonian.type = \"wisdom_holman\"\nparticles.bodies = \"/dev/zero\"\n");
  CHECK(load_refusal(folder / "x.toml").ends_with("zero: is a device, not a file"));
}

}  // namespace
}  // namespace noether::test
