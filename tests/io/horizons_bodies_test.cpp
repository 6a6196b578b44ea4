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
  CHECK(horizons_refusal(test::replaced(table("asteroid.txt"), "mass [kg] = 9.3839e20\n", "")) ==
        "h.txt:4: the mass of 1 Ceres (A801 AA) is not built in, and Horizons gives none; put a line 'mass [kg] = ...' "
        "(0 "
        "for a tracer) before '$$SOE'");
  CHECK(horizons_refusal(test::replaced(table("asteroid.txt"), "9.3839e20", "-1")) ==
        "h.txt:20: the mass is -1; expected 0 or more");
  CHECK(horizons_refusal(test::replaced(table("asteroid.txt"), "[kg]", "[km]")) ==
        "h.txt:20: the mass is in 'km'; expected a unit of mass, such as 'mass [kg]'");
  CHECK(horizons_refusal(test::replaced(table("asteroid.txt"), "9.3839e20", "much")) ==
        "h.txt:20: the mass is 'much', which is no number");
  CHECK(horizons_refusal(test::replaced(table("plain.txt"), "$$EOE\n", "")) ==
        "h.txt:25: the table that begins here has no end: '$$EOE' is missing");
  CHECK(horizons_refusal("$$SOE\n$$EOE\n") == "h.txt:1: the head of this table has no line 'Target body name'");
  CHECK(horizons_refusal(test::replaced(table("plain.txt"), "KM-D", "PC-D")) ==
        "h.txt:4: the output units of Jupiter Barycenter are 'PC-D'; expected AU-D, KM-S or KM-D");
  CHECK(horizons_refusal(labels + labels) == "h.txt:144: the name 'Sun' is taken; names must differ");
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
        "h.txt:27: X is '5.968955040929999F+08', which is no number");
  CHECK(horizons_refusal(table("plain.txt"), {.units = &unit_system("reduced")}) ==
        "h.txt: a Horizons table has units; expected the unit system solar, si or molecular, not reduced");
}
