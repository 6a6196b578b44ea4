// Names and ids of bodies in tables: only what every file and terminal can show is taken.

#include "io/bodies.hpp"
#include "tests/io/support.hpp"

using namespace noether;

namespace {

std::string name_refusal(const std::string& content, const std::string& units = "reduced") {
  const test::ScratchFolder folder;
  test::write_text(folder / "b.txt", content);
  const std::string message =
      test::error_of([&] { io::read_bodies(folder / "b.txt", {.units = &unit_system(units)}); });
  const std::size_t name = message.find("b.txt");
  return name == std::string::npos ? message : message.substr(name);
}

const std::string columns = "id,name,mass,x,y,z,vx,vy,vz\n";

}  // namespace

TEST_CASE("names with control characters or foreign bytes are refused at their line", "[bodies][messages]") {
  CHECK(
      name_refusal(columns + "0,Sun,1,0,0,0,0,0,0\n1,a\x1B[2J,1,1,0,0,0,0,0\n") ==
      "b.txt:3: the name 'a\\u001b[2J' contains the control character \\u001b; only printable characters are allowed");
  CHECK(name_refusal(columns + "0,\"tab\there\",1,0,0,0,0,0,0\n") ==
        "b.txt:2: the name 'tab\\there' contains the control character \\t; only printable characters are allowed");
  CHECK(name_refusal(columns + "0,S\xF6l,1,0,0,0,0,0,0\n") ==
        "b.txt:2: the name 'S\\xf6l' contains the byte \\xf6, which is not UTF-8; save the text as UTF-8");
  CHECK(name_refusal(columns + "0,S\xC3\xB6l,1,0,0,0,0,0,0\n").empty());

  std::string horizons =
      test::read_text(std::filesystem::path(NOETHER_SOURCE_DIR) / "tests/data/horizons" / "asteroid.txt");
  REQUIRE(name_refusal(horizons, "solar").empty());
  horizons.replace(horizons.find("Ceres"), 5, "C\xE9r\x07s");
  CHECK(name_refusal(horizons, "solar") ==
        "b.txt:4: the name '1 C\\xe9r\\u0007s (A801 AA)' contains the byte \\xe9, which is not UTF-8; save the text as "
        "UTF-8");
}

TEST_CASE("ids in a table run from 0 to 2^53", "[bodies][messages]") {
  CHECK(name_refusal(columns + "9007199254740992,Sun,1,0,0,0,0,0,0\n").empty());
  for (const std::string id : {"9007199254740993", "9223372036854775807", "99999999999999999999", "-1", "1.0"}) {
    CHECK(name_refusal(columns + id + ",Sun,1,0,0,0,0,0,0\n") ==
          "b.txt:2: column 'id' is '" + id + "'; expected a whole number from 0 to 9007199254740992");
  }
}
