// Bodies from vector tables of JPL Horizons.

#include "io/bodies.hpp"
#include "tests/io/support.hpp"

using namespace noether;
using test::error_of;

namespace {

std::string table(const std::string& name) {
  return test::read_text(std::filesystem::path(NOETHER_SOURCE_DIR) / "tests/data/horizons" / name);
}

ParticleSystem<double> read_horizons(const std::string& content, const io::BodiesOptions& options = {}) {
  const test::ScratchFolder folder;
  test::write_text(folder / "h.txt", content);
  return io::read_bodies(folder / "h.txt", options);
}

std::string horizons_refusal(const std::string& content, const io::BodiesOptions& options = {}) {
  const std::string message = error_of([&] { read_horizons(content, options); });
  const std::size_t name = message.find("h.txt");
  return name == std::string::npos ? message : message.substr(name);
}

/// A table of one record as Horizons writes it; `further` stands behind the lines of target and center.
std::string vector_table(const std::string& target, const std::string& center, const std::string& state,
                         const std::string& further = "Reference frame : Ecliptic of J2000.0\n") {
  return "Target body name: " + target + "   {source: DE441}\nCenter body name: " + center +
         "   {source: DE441}\nCenter-site name: BODY CENTER\nOutput units    : AU-D\nOutput type     : GEOMETRIC "
         "cartesian states\n" +
         further +
         "JDTDB\n   X     Y     Z\n   VX    VY    VZ\n$$SOE\n2451545.0 = A.D. 2000-Jan-01 12:00:00.0000 TDB\n" + state +
         "\n$$EOE\n";
}

const std::string jupiter_state = " X = 5.2 Y = 0 Z = 0\n VX= 0 VY= 7.5E-03 VZ= 0";
const std::string saturn_state = " X = 0 Y = 9.5 Z = 0\n VX=-5.6E-03 VY= 0 VZ= 0";
const std::string ssb = "Solar System Barycenter (0)";

}  // namespace

TEST_CASE("Horizons tables give names, states of the first record, and masses from DE440", "[bodies][horizons]") {
  using namespace units::solar;
  const auto s = read_horizons(table("labels.txt") + table("commas.txt"));
  REQUIRE(s.size() == 3);
  CHECK(s.names() == std::vector<std::string>{"Sun", "Jupiter Barycenter", "Saturn Barycenter"});
  CHECK(s.positions()[0] == Vec3<double>(-7.1e-3, -2.8e-3, 2.1e-4));
  CHECK(s.velocities()[1] == Vec3<double>(-4.6e-3, 6.4e-3, 7.499999999999999e-05));
  CHECK(s.positions()[2] ==
        Vec3<double>(9.574263724800000e8 * km, 9.230188622189999e8 * km, -5.385523345199999e7 * km));
  CHECK(s.velocities()[2][0] == -7.445264398263888 * km / second);
  const double km3_per_s2 = km * km * km / (second * second);
  CHECK(std::abs(s.masses()[0] / (132712440041.27942 * km3_per_s2 / G) - 1) < 4 * 0x1p-53);
  CHECK(std::abs(s.masses()[1] / (126712764.1 * km3_per_s2 / G) - 1) < 4 * 0x1p-53);
  // The Sun's GM is Gauss's k^2 to nine digits, whoever measured it.
  CHECK(std::abs(s.masses()[0] - 1) < 1e-9);
}

TEST_CASE("Horizons tables without labels and in km/day are read, and G scales masses only", "[bodies][horizons]") {
  using namespace units::solar;
  const auto s = read_horizons(table("plain.txt"));
  const auto twice = read_horizons(table("plain.txt"), {.G = 2 * G});
  CHECK(s.positions()[0] == Vec3<double>(5.968955040929999e8 * km, 4.084021870110000e8 * km, -1.495978707e7 * km));
  CHECK(s.velocities()[0] ==
        Vec3<double>(-6.881502052199999e5 * km / day, 9.5742637248e5 * km / day, 1.12198403025e4 * km / day));
  CHECK(twice.masses()[0] == s.masses()[0] / 2);
  CHECK(twice.positions()[0] == s.positions()[0]);
  const auto si = read_horizons(table("plain.txt"), {.units = &unit_system("si")});
  CHECK(si.positions()[0][2] == -1.495978707e7 * units::si::km);
  CHECK(std::abs(si.masses()[0] / 1.8985e27 - 1) < 1e-4);
}

TEST_CASE("tables of Horizons that a spreadsheet has saved with semicolons or tabs are read", "[bodies][horizons]") {
  const auto expected = read_horizons(table("commas.txt"));
  const auto with = [](char separator) {
    std::string text = table("commas.txt");
    const std::size_t end = text.find("$$EOE");
    for (std::size_t at = text.find("JDTDB"); at < end; ++at) text[at] = text[at] == ',' ? separator : text[at];
    return text;
  };
  for (const char separator : {';', '\t'}) {
    CAPTURE(separator);
    const auto s = read_horizons(with(separator));
    CHECK(s.names() == expected.names());
    CHECK(s.positions()[0] == expected.positions()[0]);
    CHECK(s.velocities()[0] == expected.velocities()[0]);
    CHECK(read_horizons(with(separator), {.epoch = 2451546}).positions()[0][0] == 6.4 * units::solar::km);
  }
  // A spreadsheet gives all lines as many fields as the longest has.
  std::string padded;
  for (const std::string& line : test::lines_of(with(';'))) {
    padded += line + std::string(line.find(';') != std::string::npos ? 0 : 9, ';') + "\n";
  }
  CHECK(read_horizons(padded).positions()[0] == expected.positions()[0]);
  CHECK(read_horizons(padded).names() == expected.names());
  CHECK(horizons_refusal(with(' ')) ==
        "h.txt:21: the fields of this table are separated by blanks, but its dates contain blanks too; separate them "
        "by commas, as Horizons does, or by semicolons or tabs");
  // A comma for the decimal point is no separator.
  std::string german = with(';');
  german.replace(german.find("9.574"), 5, "9,574");
  CHECK(horizons_refusal(german) ==
        "h.txt:24: X is '9,574263724800000E+08', which is not a number; use a decimal point");
}

TEST_CASE("a mass that a user puts into a Horizons table is taken", "[bodies][horizons]") {
  using namespace units::solar;
  const auto line = read_horizons(table("asteroid.txt"));
  CHECK(line.name(0) == "1 Ceres (A801 AA)");
  CHECK(line.masses()[0] == 9.3839e20 * kg);
  const std::string with_column = test::replaced(test::replaced(table("commas.txt"), "VZ,\n", "VZ, mass [Msun],\n"),
                                                 "1.818029678645833E-01,", "1.8E-01, 3e-4,");
  CHECK(read_horizons(with_column).masses()[0] == 3e-4);
}

TEST_CASE("Horizons tables that do not fit are refused with the line", "[bodies][horizons][messages]") {
  const std::string labels = table("labels.txt");
  CHECK(horizons_refusal(labels + table("later.txt")) ==
        "h.txt:155: the table of Saturn Barycenter begins at JD 2451546, that of Sun at JD 2451545; take one epoch for "
        "all");
  CHECK(horizons_refusal(table("positions.txt")) ==
        "h.txt:25: the table of Saturn Barycenter has no VX; ask Horizons for positions and velocities (vector table "
        "type "
        "2 or 3)");
  const std::string without_mass = test::replaced(table("asteroid.txt"), "mass [kg] = 9.3839e20\n", "");
  CHECK(horizons_refusal(without_mass).empty());
  CHECK(horizons_refusal(test::replaced(without_mass, "1 Ceres (A801 AA)", "5 Astraea (A845 XA)")) ==
        "h.txt:4: the mass of 5 Astraea (A845 XA) is not known, and Horizons does not give it; put a line 'mass [kg] = "
        "...' "
        "(0 for a tracer) before '$$SOE'");
  CHECK(horizons_refusal(test::replaced(table("asteroid.txt"), "9.3839e20", "-1")) ==
        "h.txt:20: the mass is -1; expected 0 or more");
  CHECK(horizons_refusal(test::replaced(table("asteroid.txt"), "[kg]", "[km]")) ==
        "h.txt:20: the mass is in 'km'; expected a unit of mass, such as 'mass [kg]'");
  CHECK(horizons_refusal(test::replaced(table("asteroid.txt"), "9.3839e20", "much")) ==
        "h.txt:20: the mass is 'much', which is not a number");
  CHECK(horizons_refusal(test::replaced(table("plain.txt"), "$$EOE\n", "")) ==
        "h.txt:25: the table that begins here has no end: '$$EOE' is missing");
  CHECK(horizons_refusal("$$SOE\n$$EOE\n") == "h.txt:1: the header of this table has no line 'Target body name'");
  CHECK(horizons_refusal(test::replaced(table("plain.txt"), "KM-D", "PC-D")) ==
        "h.txt:4: the output units of Jupiter Barycenter are 'PC-D'; expected AU-D, KM-S or KM-D");
  CHECK(horizons_refusal(labels + labels) == "h.txt:144: the name 'Sun' is already used; names must differ");
  CHECK(
      horizons_refusal(labels + test::replaced(table("commas.txt"), "Solar System Barycenter (0)", "Sun (10)")) ==
      "h.txt:132: the table of Saturn Barycenter is about 'Sun (10)', that of Sun about 'Solar System Barycenter (0)'; "
      "take one center for all");
  CHECK(horizons_refusal(labels + test::replaced(table("commas.txt"), "Ecliptic of J2000.0", "ICRF")) ==
        "h.txt:132: the table of Saturn Barycenter is in the frame 'ICRF', that of Sun in 'Ecliptic of J2000.0'; take "
        "one "
        "frame for all");
  CHECK(horizons_refusal(test::replaced(table("plain.txt"), "cartesian states", "osculating elements")) ==
        "h.txt:17: this is a table of elements; ask Horizons for vectors (EPHEM_TYPE = VECTORS)");
  CHECK(horizons_refusal(test::replaced(table("plain.txt"), "5.968955040929999E+08", "5.968955040929999F+08")) ==
        "h.txt:27: X is '5.968955040929999F+08', which is not a number");
  CHECK(horizons_refusal(table("plain.txt"), {.units = &unit_system("reduced")}) ==
        "h.txt: a Horizons table has units; expected the unit system solar, si or molecular, not reduced");
}

TEST_CASE("the center of Horizons tables joins them first, at rest in the origin, with its own mass",
          "[bodies][horizons]") {
  using namespace units::solar;
  const double km3_per_s2 = km * km * km / (second * second);
  const auto s = read_horizons(vector_table("Jupiter Barycenter (5)", "Sun (10)", jupiter_state) +
                               vector_table("Saturn Barycenter (6)", "Sun (10)", saturn_state));
  REQUIRE(s.names() == std::vector<std::string>{"Sun", "Jupiter Barycenter", "Saturn Barycenter"});
  CHECK(s.positions()[0] == Vec3<double>::Zero());
  CHECK(s.velocities()[0] == Vec3<double>::Zero());
  CHECK(std::abs(s.masses()[0] / (132712440041.27942 * km3_per_s2 / G) - 1) < 4 * 0x1p-53);
  CHECK(s.positions()[1] == Vec3<double>(5.2, 0, 0));
  CHECK(s.velocities()[2] == Vec3<double>(-5.6e-3, 0, 0));

  // Moons about their planet, and a body about Mars with its moons.
  const auto moons =
      read_horizons(vector_table("Moon (301)", "Earth (399)", " X = 2.5E-3 Y = 0 Z = 0\n VX= 0 VY= 6E-4 VZ= 0"));
  CHECK(moons.names() == std::vector<std::string>{"Earth", "Moon"});
  CHECK(std::abs(moons.masses()[0] / moons.masses()[1] - 398600.435507 / 4902.800118) < 1e-13);
  const auto mars =
      read_horizons(vector_table("Sun (10)", "Mars Barycenter (4)", " X =-1.5 Y = 0 Z = 0\n VX= 0 VY=-0.014 VZ= 0"));
  CHECK(mars.names() == std::vector<std::string>{"Mars Barycenter", "Sun"});
}

TEST_CASE("a barycenter that tables are about is a place, and no body", "[bodies][horizons]") {
  const auto both = read_horizons(
      vector_table("Earth (399)", "Earth-Moon Barycenter (3)", " X =-3E-5 Y = 0 Z = 0\n VX= 0 VY=-7E-6 VZ= 0") +
      vector_table("Moon (301)", "Earth-Moon Barycenter (3)", " X = 2.5E-3 Y = 0 Z = 0\n VX= 0 VY= 6E-4 VZ= 0"));
  CHECK(both.names() == std::vector<std::string>{"Earth", "Moon"});
  CHECK(horizons_refusal(vector_table("Moon (301)", "Earth-Moon Barycenter (3)", jupiter_state)) ==
        "h.txt:1: the states are about 'Earth-Moon Barycenter (3)', but its planet (399) is not among the bodies; add "
        "its "
        "table");
  CHECK(read_horizons(vector_table("Venus (299)", "Venus Barycenter (2)", jupiter_state)).size() == 1);
  CHECK(read_horizons(vector_table("Sun (10)", ssb, jupiter_state)).size() == 1);
}

TEST_CASE("a center without a known mass is refused, unless a line gives it", "[bodies][horizons][messages]") {
  const std::string moon = vector_table("Dactyl (120000243)", "243 Ida (A884 SB)", jupiter_state, "mass [kg] = 0\n");
  CHECK(horizons_refusal(moon) ==
        "h.txt:1: the states are about '243 Ida (A884 SB)', whose mass is not known; put a line 'center mass [kg] = "
        "...' before '$$SOE', or ask Horizons for states about the Solar System Barycenter (CENTER = '500@0')");
  const auto s = read_horizons(test::replaced(moon, "mass [kg] = 0\n", "mass [kg] = 0\ncenter mass [kg] = 4.2e16\n"));
  CHECK(s.names() == std::vector<std::string>{"243 Ida (A884 SB)", "Dactyl"});
  CHECK(s.masses()[0] == 4.2e16 * units::solar::kg);
  // A table of the center itself may be there; then it must be at rest.
  const std::string at_rest = " X = 0 Y = 0 Z = 0\n VX= 0 VY= 0 VZ= 0";
  const std::string planet = vector_table("Jupiter Barycenter (5)", "Sun (10)", jupiter_state);
  CHECK(read_horizons(planet + vector_table("Sun (10)", "Sun (10)", at_rest)).size() == 2);
  CHECK(horizons_refusal(vector_table("Sun (10)", "Sun (10)", jupiter_state)) ==
        "h.txt:1: Sun (10) is not at rest at the origin, but all states are relative to it; take this table out");
}

TEST_CASE("states that are not geometric, or about a site on a body, are refused", "[bodies][horizons][messages]") {
  const std::string good = vector_table("Jupiter Barycenter (5)", "Sun (10)", jupiter_state);
  for (const std::string type : {"LT+S cartesian states", "LT CORRECTED cartesian states", "LT cartesian states"}) {
    CHECK(horizons_refusal(test::replaced(good, "GEOMETRIC cartesian states", type)) ==
          "h.txt:5: the states of Jupiter Barycenter are '" + type +
              "', not geometric; ask Horizons for states without corrections for light time and aberration (VEC_CORR = "
              "NONE)");
  }
  CHECK(horizons_refusal(
            test::replaced(vector_table("Moon (301)", "Earth (399)", jupiter_state), "BODY CENTER", "Greenwich")) ==
        "h.txt:3: the states of Moon are about the site 'Greenwich', which rotates with its body; ask Horizons for the "
        "center of the body (CENTER = '500@399')");
}

TEST_CASE("no mass counts twice", "[bodies][horizons][messages]") {
  const auto two = [&](const std::string& a, const std::string& b,
                       const std::string& further = "Reference frame : ICRF\n") {
    return vector_table(a, ssb, jupiter_state, further) +
           vector_table(b, ssb, saturn_state, "Reference frame : ICRF\n");
  };
  CHECK(horizons_refusal(two("Earth-Moon Barycenter (3)", "Moon (301)")) ==
        "h.txt:15: the mass of Moon (301) would count twice, because Earth-Moon Barycenter (3) includes it; take one "
        "of them out");
  CHECK(test::has(
      horizons_refusal(two("Ganymede (503)", "Jupiter Barycenter (5)", "mass [kg] = 1.5e23\nReference frame : ICRF\n")),
      "h.txt:1: the mass of Ganymede (503) would count twice, because Jupiter Barycenter (5) includes it"));
  CHECK(test::has(horizons_refusal(two("Mars (499)", "Mars Barycenter (4)")), "would count twice"));
  CHECK(test::has(horizons_refusal(vector_table("Earth-Moon Barycenter (3)", "Moon (301)", jupiter_state)),
                  "would count twice"));
  // A tracer has nothing to count, and what a user says of a barycenter is taken.
  CHECK(read_horizons(two("Ganymede (503)", "Jupiter Barycenter (5)", "mass [kg] = 0\nReference frame : ICRF\n"))
            .size() == 2);
  CHECK(read_horizons(two("Earth-Moon Barycenter (3)", "Moon (301)", "mass [kg] = 6e24\nReference frame : ICRF\n"))
            .size() == 2);
  CHECK(read_horizons(two("Jupiter Barycenter (5)", "Moon (301)")).size() == 2);
  CHECK(horizons_refusal(two("Jupiter Barycenter (5)", "Solar System Barycenter (0)")) ==
        "h.txt:15: Solar System Barycenter is a place, not a body; take its table out");
}

TEST_CASE("the plane of old tables is compared, by whatever words it is called", "[bodies][horizons][messages]") {
  const std::string ecliptic =
      "Reference frame : ICRF/J2000.0\nCoordinate systm: Ecliptic and Mean Equinox of Reference Epoch\n";
  const std::string equator =
      "Reference frame : ICRF/J2000.0\nCoordinate systm: Earth Mean Equator and Equinox of Reference Epoch\n";
  const auto two = [&](const std::string& first, const std::string& second) {
    return vector_table("Jupiter Barycenter (5)", ssb, jupiter_state, first) +
           vector_table("Saturn Barycenter (6)", ssb, saturn_state, second);
  };
  CHECK(horizons_refusal(two(ecliptic, equator)) ==
        "h.txt:16: the table of Saturn Barycenter is in the frame 'ICRF', that of Jupiter Barycenter in 'Ecliptic of "
        "J2000.0'; take one frame for all");
  CHECK(read_horizons(two(ecliptic, "Reference frame : Ecliptic of J2000.0\n")).size() == 2);
  CHECK(read_horizons(two(equator, "Reference frame : ICRF\n")).size() == 2);
  CHECK(test::has(
      horizons_refusal(two("Coordinate systm: Body Mean Equator and Node of Date\n", ecliptic)),
      "in the frame 'Ecliptic of J2000.0', that of Jupiter Barycenter in 'Body Mean Equator and Node of Date'"));
}

TEST_CASE("tables in several scales of time are refused; CT is TDB", "[bodies][horizons][messages]") {
  const std::string jupiter = vector_table("Jupiter Barycenter (5)", ssb, jupiter_state),
                    saturn = vector_table("Saturn Barycenter (6)", ssb, saturn_state);
  CHECK(horizons_refusal(jupiter + test::replaced(saturn, "JDTDB", "JDUT")) ==
        "h.txt:15: the table of Saturn Barycenter is in the time scale 'UT', that of Jupiter Barycenter in 'TDB'; take "
        "one "
        "time scale for all");
  CHECK(read_horizons(jupiter + test::replaced(saturn, "JDTDB", "JDCT")).size() == 2);
}

TEST_CASE("the epoch of the states is told, and another one can be asked for", "[bodies][horizons]") {
  const test::ScratchFolder folder;
  test::write_text(folder / "h.txt", table("labels.txt") + table("commas.txt"));
  const io::BodyTable first = io::read_body_table(folder / "h.txt");
  REQUIRE(first.epoch);
  CHECK(first.epoch->julian_day == 2451545);
  CHECK(first.epoch->scale == "TDB");
  const io::BodyTable second = io::read_body_table(folder / "h.txt", {.epoch = 2451546});
  CHECK(second.epoch->julian_day == 2451546);
  CHECK(second.particles.size() == 3);
  CHECK(second.particles.positions()[2][0] == 6.4 * units::solar::km);
  CHECK(horizons_refusal(table("labels.txt"), {.epoch = 2451545.5}) ==
        "h.txt:38: the table of Sun has no record of JD 2451545.5; it has 2, from JD 2451545 to JD 2451546");
}

TEST_CASE("planets about the Solar System Barycenter without a Sun are told as such", "[bodies][horizons]") {
  const test::ScratchFolder folder;
  const auto without_sun = [&](const std::string& text) {
    test::write_text(folder / "h.txt", text);
    return io::read_body_table(folder / "h.txt").without_sun;
  };
  const std::string jupiter = vector_table("Jupiter Barycenter (5)", ssb, jupiter_state);
  CHECK(without_sun(jupiter));
  CHECK_FALSE(without_sun(jupiter + vector_table("Sun (10)", ssb, saturn_state)));
  CHECK_FALSE(without_sun(vector_table("Jupiter Barycenter (5)", "Sun (10)", jupiter_state)));
}

namespace {

/// The text of an answer as a JSON string.
std::string json_text(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '\n') {
      quoted += "\\n";
    } else if (c == '/') {
      quoted += "\\/";
    } else {
      if (c == '"') quoted += '\\';
      quoted += c;
    }
  }
  return quoted + '"';
}

}  // namespace

TEST_CASE("the JSON answer of Horizons' API is read as the text in it", "[bodies][horizons]") {
  const std::string text = table("labels.txt") + table("commas.txt"), name = "\"result\": ";
  const auto plain = read_horizons(text);
  const std::string signature =
      R"("signature": {"source": "NASA/JPL Horizons API", "version": "1.2", "more": [1, {"a": null}]})";
  for (const std::string& json : {"{" + signature + ", " + name + json_text(text) + "}",
                                  "{\n  " + name + json_text(text) + ",\n  " + signature + "\n}\n",
                                  "{\"number\": -1.5e3, \"flag\": true, " + name + json_text(text) + "}"}) {
    const auto read = read_horizons(json);
    REQUIRE(read.size() == plain.size());
    for (Index i = 0; i < read.size(); ++i) {
      CHECK(read.name(i) == plain.name(i));
      CHECK(read.positions()[i] == plain.positions()[i]);
      CHECK(read.velocities()[i] == plain.velocities()[i]);
    }
  }
  const auto answer = [&](const char* file) { return "{\"result\": " + json_text(table(file)) + "}\n"; };
  CHECK(read_horizons(answer("labels.txt") + answer("commas.txt")).names() == plain.names());
  const auto named = read_horizons(
      "{\"result\": " +
      test::replaced(json_text(table("asteroid.txt")), "1 Ceres", "\\u0043\\u00e9r\\u20ac\\ud83d\\ude00") + "}");
  CHECK(named.name(0) == "C\xC3\xA9r\xE2\x82\xAC\xF0\x9F\x98\x80 (A801 AA)");
}

TEST_CASE("an answer of Horizons without a table, or broken JSON, is named", "[bodies][horizons][messages]") {
  CHECK(horizons_refusal("{\n\"result\": " +
                         json_text("API VERSION: 1.2\nAPI SOURCE: NASA/JPL Horizons API\n\n***\nNo matches found.\n") +
                         "}") ==
        "h.txt:2: this answer of Horizons has no table: '$$SOE' is missing; it says 'No matches found.'");
  CHECK(horizons_refusal("{\"signature\": {}, \"error\": \"Cannot find central body\"}") ==
        "h.txt:1: this answer of Horizons has no table: '$$SOE' is missing; it says 'Cannot find central body'");
  CHECK(horizons_refusal("API VERSION: 1.2\nAPI SOURCE: NASA/JPL Horizons API\n\nNo ephemeris for target\n") ==
        "h.txt:1: this answer of Horizons has no table: '$$SOE' is missing; it says 'No ephemeris for target'");
  CHECK(
      horizons_refusal("{\"a\": 1}") ==
      "h.txt:1: this JSON has no \"result\", as answers of Horizons have; expected CSV or a vector table of Horizons");
  CHECK(horizons_refusal("{\"result\": " + json_text(test::replaced(table("plain.txt"), "KM-D", "PC-D")) + "}") ==
        "h.txt:1: line 4 of its text: the output units of Jupiter Barycenter are 'PC-D'; expected AU-D, KM-S or "
        "KM-D");
  CHECK(horizons_refusal("[{\"result\": 1}]") ==
        "h.txt:1: this is a list in JSON; expected answers of Horizons, {...}, one after the other");
  CHECK(horizons_refusal("{\"result\": " + json_text(table("plain.txt")) + "} x") ==
        "h.txt:1: this is not JSON: '{' is expected");
  CHECK(horizons_refusal("{\"result\": \"abc") == "h.txt:1: this is not JSON: its end is missing");
  CHECK(horizons_refusal("{\"result\" \"abc\"}") == "h.txt:1: this is not JSON: ':' is expected");
  CHECK(horizons_refusal("{\"a\": 1]}") == "h.txt:1: this is not JSON: ']' has no opening bracket");
  CHECK(horizons_refusal("{\"a\": \"\\q\"}") == "h.txt:1: this is not JSON: '\\q' is not a valid escape in a text");
  CHECK(horizons_refusal("{\"a\": \"\\u12g4\"}") ==
        "h.txt:1: this is not JSON: '\\u' is not followed by four hexadecimal digits");
  CHECK(horizons_refusal("\xFF\xFE{") == "h.txt: this is text in UTF-16; save it as UTF-8");
}
