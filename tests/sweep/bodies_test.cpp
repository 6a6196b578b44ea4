// Bodies as spreadsheets, catalogs of small bodies, Horizons and users of REBOUND write them.

#include "scene/warnings.hpp"
#include "tests/sweep/support.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace noether::test {
namespace {

// ---- tables ----

const std::string sun_and_earth =
    "name,mass [Msun],x [au],y,z,vx [au/day],vy,vz\nSun,1,0,0,0,0,0,0\nEarth,3e-6,1,0,0,0,0.017202098,0\n";

std::string with_each_line(const std::string& table, const std::string& ending) {
  std::string result;
  for (const std::string& line : lines_of(table)) result += line + ending + "\n";
  return result;
}

TEST_CASE("tables of spreadsheets and of Fortran have the energy of Sun and Earth", "[sweep][bodies]") {
  std::string semicolons = sun_and_earth;
  for (char& c : semicolons) c = c == ',' ? ';' : c;
  std::string dos = "\xEF\xBB\xBFsep=;\n" + semicolons;
  for (std::size_t at = 0; (at = dos.find('\n', at)) != std::string::npos; at += 2) dos.insert(at, "\r");
  const std::vector<std::pair<std::string, std::string>> tables = {
      {"empty columns at the end of every line", with_each_line(sun_and_earth, ",,")},
      {"a separator at the end of the rows", replaced(with_each_line(sun_and_earth, ","), "vz,\n", "vz\n")},
      {"empty rows below the table", sun_and_earth + ",,,,,,,\n,,,,,,,\n"},
      {"empty rows above the table", ",,,,,,,\n,,,,\n" + sun_and_earth},
      {"Fortran's exponents", replaced(replaced(sun_and_earth, "3e-6", "3.0D-06"), "0.017202098", "1.7202098d-2")},
      {"semicolons, DOS ends and a byte order mark of Excel", dos}};
  for (const auto& [what, table] : tables) {
    CAPTURE(what);
    const Seen it = seen(gravity_scene("bodies = 'b.csv'\n"), "b.csv", table);
    CHECK(it.refusal == "");
    // m v^2/2 and -k^2 m by hand: 3e-6 0.017202098^2/2, 0.01720209895^2 3e-6.
    CHECK(near(it.energy.kinetic, 4.4386826340240597e-10, 1e-12));
    CHECK(near(it.energy.potential, -8.877366248567735e-10, 1e-12));
  }
}

TEST_CASE("what a table of bodies has wrong is told with what is meant", "[sweep][bodies][messages]") {
  const auto refusal = [](const std::string& table) {
    return seen(gravity_scene("bodies = 'b.csv'\n"), "b.csv", table).refusal;
  };
  CHECK(refusal("# " + sun_and_earth) == "b.csv:1: the column names are in a comment; take out the '#' before them");
  CHECK(refusal(",name,mass [Msun],x [au],y,z,vx [au/day],vy,vz\n0,Sun,1,0,0,0,0,0,0\n") ==
        "b.csv:1: column 1 has no name; if it is the row numbers of pandas, write the table with index=False");
  CHECK(refusal(replaced(sun_and_earth, "mass [Msun]", "m [Msun]")) ==
        "b.csv:1: unknown column 'm'; did you mean 'mass'?");
  CHECK(refusal(replaced(sun_and_earth, "0.017",
                         "\xE2\x88\x92"
                         "0.017")) ==
        "b.csv:3: column 'vy' is '\xE2\x88\x92"
        "0.017202098', which is not a number; write a minus as '-'");
  CHECK(refusal(replaced(sun_and_earth, "vz\nSun,1,0,0,0,0,0,0\n", "vz,\nSun,1,0,0,0,0,0,0,7\n")) ==
        "b.csv:2: this row has 9 fields; expected 8, as line 1 names");
  // What JPL, the Minor Planet Center and textbooks call elements, which nearness of letters would take for others.
  for (const auto& [other, told] : std::vector<std::pair<std::string, std::string>>{
           {"i", "; did you mean 'inc'?"},
           {"Incl.", "; did you mean 'inc'?"},
           {"om", "; did you mean 'Omega'?"},
           {"Node", "; did you mean 'Omega'?"},
           {"LAN", "; did you mean 'Omega'?"},
           {"w", "; did you mean 'omega'?"},
           {"Peri.", "; did you mean 'omega'?"},
           {"ma", "; did you mean 'M'?"},
           {"nu", "; did you mean 'f'?"},
           {"L", "; did you mean 'l'?"},
           {"per", "; did you mean 'P'?"},
           {"tp", "; did you mean 'T'?"},
           {"n", "; a mean motion n is not supported: give the period P = 360 deg / n, or a"},
           {"E", "; an eccentric anomaly E is not supported: give M = E - e sin E, or f"}}) {
    CAPTURE(other);
    CHECK(refusal("name,mass [Msun],a [au],e," + other + "\nSun,1,,,\n") ==
          "b.csv:1: unknown column '" + other + "'" + told);
    const std::string body = "[[particles.body]]\nname = 'c'\nmass = '0 kg'\n'" + other + "' = '1 deg'\n";
    CHECK(seen(gravity_scene("[[particles.body]]\nname = 'Sun'\nmass = '1 Msun'\n" + body), "", "").refusal ==
          "scene.toml:9: unknown key '" + other + "' in body 'c'" + told);
  }
}

// ---- orbits ----

/// A body of 1e-6 Msun about one of 1 Msun, G = k^2: its state by REBOUND 5.2.2, sim.add(m=1e-6, ...) [au, au/day].
struct OrbitRow {
  std::string elements;
  std::array<double, 6> state;
};

const std::vector<OrbitRow> orbit_rows = {
    {"a = '1.3 au'\ne = 0.2\ninc = '180 deg'\nOmega = '10 deg'\nomega = '20 deg'\nM = '30 deg'\n",
     {0.6353311338125903, -0.8881767657032033, 1.2062862312023082e-16, -0.01305880417981658, -0.011991577088351513,
      1.1685286502461001e-18}},
    {"a = '17.8 au'\ne = 0.967\ninc = '162.26 deg'\nOmega = '58.42 deg'\nomega = '111.33 deg'\nM = '38.38 deg'\n",
     {-13.918660800902957, 11.443483462423172, -5.7104803185734125, -0.0021171306265505814, 0.0030059425550377824,
      -0.0010805866528265855}},
    {"a = '-1.2 au'\ne = 3.36\ninc = '122.7 deg'\nOmega = '24.6 deg'\nomega = '241.8 deg'\nM = '-51 deg'\n",
     {-2.7269976759831396, -0.21188718248381647, -1.4681589208706787, 0.013023443075597232, 0.012986870218657949,
      -0.009948342140444388}},
    {"a = '-1.2 au'\ne = 3.36\ninc = '122.7 deg'\nOmega = '24.6 deg'\nomega = '241.8 deg'\nf = '-80 deg'\n",
     {-6.187627895976503, -4.280035692904366, 2.04952607800894, 0.00899639072465709, 0.011500455239101624,
      -0.010454398440632185}},
    {"a = '1.524 au'\ne = 0.0934\ninc = '1.85 deg'\nOmega = '49.6 deg'\npomega = '336.04 deg'\nl = '355.45 deg'\n",
     {1.3909446781878176, -0.013210047198200002, -0.0344903692930637, 0.0006710563481633302, 0.015186336933574058,
      0.00030140677556424834}},
    // Passages of the pericenter as Julian days: T - epoch = -5074.5 and -79.63 days.
    {"a = '17.8 au'\ne = 0.967\ninc = '162.26 deg'\nOmega = '58.42 deg'\nomega = '111.33 deg'\nT = 'JD 2446470.5'\n",
     {-17.369808745038508, 16.94537865814622, -7.572787904263889, -0.0011950917437358723, 0.002179795309346332,
      -0.0006908920408687136}},
    {"a = '2.77 au'\ne = 0.0785\ninc = '10.6 deg'\nOmega = '80.3 deg'\nomega = '73.6 deg'\nT = 'JD 2451465.37 TDB'\n",
     {-2.5058248018631253, 0.2682891054508171, 0.47070764647164187, -0.0014796340242506118, -0.011037340144587677,
      -7.508145417630867e-05}},
};

const std::string sun_and_body = "[[particles.body]]\nname = 'Sun'\nmass = '1 Msun'\n[[particles.body]]\nname = 'c'\n";

TEST_CASE("orbits are where REBOUND has them, passages by Julian days too", "[sweep][bodies]") {
  const std::string epoch = "epoch = 'JD 2451545 TDB'\n";
  for (const OrbitRow& row : orbit_rows) {
    CAPTURE(row.elements);
    const Seen it = seen(gravity_scene(epoch + sun_and_body + "mass = '1e-6 Msun'\n" + row.elements), "", "");
    CHECK(it.refusal == "");
    REQUIRE(it.particles.size() == 2);
    CHECK(is_at(it.particles, 1, row.state, 1e-12));
    CHECK(has(it.effective, "epoch = \"JD 2451545 TDB\"\n"));
  }
}

TEST_CASE("a column of passages in Julian days is beside the epoch", "[sweep][bodies]") {
  const std::string table =
      "name,mass [Msun],a [au],e,inc [deg],Omega,omega,T [JD]\nSun,1,,,,,,\n"
      "Halley,1e-6,17.8,0.967,162.26,58.42,111.33,2446470.5\nCeres,1e-6,2.77,0.0785,10.6,80.3,73.6,2451465.37\n";
  const Seen it = seen(gravity_scene("bodies = 'b.csv'\nepoch = 'JD 2451545'\n"), "b.csv", table);
  CHECK(it.refusal == "");
  REQUIRE(it.particles.size() == 3);
  CHECK(is_at(it.particles, 1, orbit_rows[5].state, 1e-12));
  CHECK(is_at(it.particles, 2, orbit_rows[6].state, 1e-12));
  CHECK(seen(gravity_scene("bodies = 'b.csv'\n"), "b.csv", table).refusal ==
        "b.csv:1: column 'T' is in Julian days, but the epoch of the start is not given; give epoch = \"JD ...\" in "
        "[particles]");
  CHECK(
      seen(gravity_scene("bodies = 'b.csv'\nepoch = 'JD 2451545'\n"), "b.csv", replaced(table, "2446470.5", "46470.5"))
          .refusal ==
      "b.csv:3: column 'T' is JD 46470.5, 2405074.5 days from the epoch, JD 2451545: one of them looks like a modified "
      "Julian day; add 2400000.5 to it");
  CHECK(seen(gravity_scene("bodies = 'b.csv'\n"), "b.csv", replaced(table, "T [JD]", "T [day]")).refusal ==
        "b.csv:3: column 'T' is 2446470.5, counted from the start, which looks like a Julian day; name the column 'T "
        "[JD]' and give the epoch in [particles], or give the time in yr if it is a time");
}

TEST_CASE("a Julian day in the place of a time is told", "[sweep][bodies][messages]") {
  const auto refusal = [](const std::string& keys, const std::string& T) {
    return seen(gravity_scene(keys + sun_and_body + "mass = '0 kg'\nq = '0.58 au'\ne = 1\nT = '" + T + "'\n"), "", "")
        .refusal;
  };
  CHECK(refusal("", "2446470.5 day") ==
        "scene.toml:11: T = \"2446470.5 day\" is counted from the start, but looks like a Julian day; give T = \"JD "
        "...\" and the epoch in [particles], or give the time in yr if it is a time");
  for (const std::string day :
       {"2446470.5d", "2446470.5 d", "2446470.5 day ", " +2.4464705e6 days", "2446470.5*day", "2446470.5/day^-1"}) {
    CAPTURE(day);
    CHECK(has(refusal("", day), "looks like a Julian day; give T = \"JD"));
  }
  for (const std::string day : {"2446470.5 s", "2e6 day", "-2446470.5 day", "30d"}) {
    CAPTURE(day);
    CHECK(refusal("", day) == "");
  }
  CHECK(refusal("", "6698 yr") == "");
  // A modified Julian day, JD - 2400000.5, under the name of the Julian day, here or in the epoch.
  CHECK(refusal("epoch = 'JD 2451545 TDB'\n", "JD 46470.5") ==
        "scene.toml:12: T = \"JD 46470.5\" is 2405074.5 days from the epoch, JD 2451545 TDB: one of them looks like a "
        "modified Julian day; add 2400000.5 to it");
  CHECK(has(refusal("epoch = 'JD 51544.5'\n", "JD 2446470.5"), "is 2394926 days from the epoch, JD 51544.5: one of"));
  CHECK(
      refusal("", "JD 2446470.5") ==
      "scene.toml:11: T = \"JD 2446470.5\" is a Julian day, but the epoch of the start is not given; give epoch = \"JD "
      "...\" in [particles]");
  CHECK(refusal("epoch = 'JD 2451545 TDB'\n", "JD 2446470.5 UT") ==
        "scene.toml:12: T = \"JD 2446470.5 UT\" is not in the time scale of the epoch, TDB");
}

TEST_CASE("a constant of gravitation of other units is warned of", "[sweep][bodies][warnings]") {
  const auto warned = [](const std::string& G, const std::string& units = "solar") {
    const std::string scene = gravity_scene(sun_and_body + "mass = '1e-6 Msun'\na = '1 au'\n", units);
    const std::string type = "type = 'kinetic_potential'\n";
    return warnings_of(read_scene(replaced(scene, type, type + "G = " + G + "\n"), "scene.toml"));
  };
  // One constant in the units that people have it in, by CODATA 2018 and the IAU's parsec: 4.30091727e-3 pc km^2/s^2
  // per Msun, 4 pi^2 au^3/yr^2 per Msun.
  const std::string here = " times the gravitational constant in these units, 0.000295912 au^3/Msun/day^2",
                    that = here + ", and is that of ";
  CHECK(warned("6.6743e-11") == std::vector<std::string>{"G = 6.6743e-11 is 2.26e-07" + that +
                                                         "m^3/kg/s^2: give it as \"6.6743e-11 m^3/kg/s^2\""});
  CHECK(warned("39.47841760435743") ==
        std::vector<std::string>{"G = 39.4784 is 1.33e+05" + that +
                                 "au^3/Msun/yr^2: give it as \"39.4784176044 au^3/Msun/yr^2\""});
  CHECK(warned("4.30091727e-3") ==
        std::vector<std::string>{"G = 0.00430092 is 14.5" + that +
                                 "pc km^2/s^2/Msun: give it as \"0.00430091727 pc km^2/s^2/Msun\""});
  CHECK(warned("1.0") == std::vector<std::string>{"G = 1 is 3.38e+03" + here});
  CHECK(warned("2.95912208286e-4").empty());
  CHECK(warned("'6.6743e-11 m^3/kg/s^2'").empty());
  CHECK(warned("6.6743e-11", "si").empty());
}

// ---- Horizons ----

struct TableOfHorizons {
  std::string target, center, x = "1.0E+00", vy = "1.7202098E-02", units = "AU-D";

  std::string text() const {
    return fmt::format(
        "*******\nTarget body name: {}       {{source: DE441}}\nCenter body name: {}    {{source: DE441}}\n"
        "Center-site name: BODY CENTER\nOutput units    : {}\nOutput type     : GEOMETRIC cartesian states\n"
        "Reference frame : Ecliptic of J2000.0\nJDTDB\n   X     Y     Z\n   VX    VY    VZ\n   LT    RG    RR\n$$SOE\n"
        "2451545.000000000 = A.D. 2000-Jan-01 12:00:00.0000 TDB [del_T=     64.183889 s]\n"
        " X = {} Y = 0.0E+00 Z = 0.0E+00\n VX= 0.0E+00 VY= {} VZ= 0.0E+00\n LT= 5.7E-03 RG= 1.0E+00 RR= "
        "1.0E-05\n$$EOE\n",
        target, center, units, x, vy);
  }
};

/// -GM GM'/(k^2 r) with GM of gm_de440.tpc, worked out by Python in au, day and Msun.
struct HorizonsRow {
  TableOfHorizons table;
  double potential;
};
const std::vector<HorizonsRow> horizons_rows = {
    {{"Earth (399)", "Sun (10)"}, -8.887692446662397e-10},
    {{"Earth (399)", "Sun (10)", "1.0D+00", "1.7202098D-02"}, -8.887692446662397e-10},
    {{"Earth (399)", "Sun (10)", "1.495978707000000E+08", "2.978E+01", "KM-S"}, -8.887692446662397e-10},
    {{"Earth (399)", "Sun (10)", "1.495978707000000E+08", "2.572992E+06", "KM-D"}, -8.887692446662397e-10},
    {{"Phobos (401)", "Mars (499)", "6.3E-05"}, -8.09518060830553e-21},
    {{"Io (501)", "Jupiter (599)", "2.8E-03"}, -4.530562547325785e-12},
    {{"Titan (606)", "Saturn (699)", "8.2E-03"}, -6.977641442954709e-13},
    {{"Miranda (705)", "Uranus (799)", "8.7E-04"}, -4.833151143556691e-16},
    {{"Triton (801)", "Neptune (899)", "2.4E-03"}, -6.835217065688808e-14},
    {{"Charon (901)", "Pluto (999)", "1.31E-04"}, -1.1808878053784574e-17},
    {{"Nix (902)", "Pluto (999)", "3.3E-04"}, -1.3495596838274101e-22},
    {{"1 Ceres (A801 AA)", "Sun (10)", "2.77E+00"}, -5.041342282675674e-14},
    {{"4 Vesta (A807 FA)", "Sun (10)", "2.36E+00"}, -1.6333898400451774e-14},
};

TEST_CASE("moons, minor planets and planets of Horizons have JPL's masses", "[sweep][horizons]") {
  for (const HorizonsRow& row : horizons_rows) {
    CAPTURE(row.table.target, row.table.units, row.table.x);
    const Seen it = seen(gravity_scene("bodies = 'h.txt'\n"), "h.txt", row.table.text());
    CHECK(it.refusal == "");
    CHECK(near(it.energy.potential, row.potential, 1e-11));
  }
  // A center that is a moon or a minor planet: 5959.915466180539 and 62.62888864440993 km^3/s^2 over k^2.
  for (const auto& [center, mass] : std::vector<std::pair<std::string, double>>{
           {"Io (501)", 4.490849135391605e-08}, {"1 Ceres (A801 AA)", 4.719142276686204e-10}}) {
    CAPTURE(center);
    const TableOfHorizons probe{"Probe (spacecraft) (-77)", center, "1.0E-04"};
    const std::string text = replaced(probe.text(), "$$SOE", "mass [kg] = 0\n$$SOE");
    const Seen it = seen(gravity_scene("bodies = 'h.txt'\n"), "h.txt", text);
    CHECK(it.refusal == "");
    REQUIRE(it.particles.size() == 2);
    CHECK(near(it.particles.masses()[0], mass, 1e-12));
  }
  CHECK(seen(gravity_scene("bodies = 'h.txt'\n"), "h.txt",
             "Target body name: Mars (499)\n Date__(UT)__HR:MN     R.A._____(ICRF)_____DEC\n$$SOE\n 2000-Jan-01 00:00  "
             " 22 "
             "00 00.0 -13 00 00.0\n$$EOE\n")
            .refusal == "h.txt:2: this is a table of observations; ask Horizons for vectors (EPHEM_TYPE = VECTORS)");
  const std::string barycenter = TableOfHorizons{"Jupiter Barycenter (5)", "Sun (10)", "5.2E+00"}.text(),
                    moon = TableOfHorizons{"Io (501)", "Sun (10)", "5.2028E+00"}.text();
  CHECK(
      seen(gravity_scene("bodies = 'h.txt'\n"), "h.txt", barycenter + moon).refusal ==
      "h.txt:19: the mass of Io (501) would count twice, because Jupiter Barycenter (5) includes it; take one of them "
      "out");
  CHECK(seen(gravity_scene("bodies = 'h.txt'\n"), "h.txt", TableOfHorizons{"5 Astraea (A845 XA)", "Sun (10)"}.text())
            .refusal ==
        "h.txt:2: the mass of 5 Astraea (A845 XA) is not known, and Horizons does not give it; put a line 'mass [kg] = "
        "...' "
        "(0 for a tracer) before '$$SOE'");
}

}  // namespace
}  // namespace noether::test
