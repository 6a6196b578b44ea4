// Units as people and programs write them, in scenes and in the headings of tables.

#include "tests/sweep/support.hpp"

#include <fmt/format.h>

#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace noether::test {
namespace {

const std::string two_argon = "2\n\nAr 0 0 0\nAr 0 0 4.0\n";

/// 4 epsilon ((sigma/r)^12 - (sigma/r)^6) at 0.4 nm, worked out by Python with the units of CODATA 2018 [kJ/mol].
struct DepthRow {
  std::string epsilon, sigma;
  double potential;
};
const std::vector<DepthRow> depth_rows = {
    {"0.238 kcal/mol", "0.34 nm", -0.9356770665644275},  // x 4.184
    {"0.238 kcal mol^-1", "3.4 angstrom", -0.9356770665644275},
    {"0.238 Kcal/mole", "3.4 \xC3\x85", -0.9356770665644275},
    {"0.0103 eV", "3.4 Angstrom", -0.9338043075608382},  // x 96.48533212331
    {"10.3 meV", "340 pm", -0.9338043075608382},
    {"3.8e-4 hartree", "0.34 nm", -0.9374603575396159},   // x 4.3597447222071e-18 J
    {"0.996 kJ/mol", "6.425 bohr", -0.9358487806454243},  // x 0.0529177210903 nm
    {"0.996 kJ mol-1", "0.34 nm", -0.9358725098194902},
};

TEST_CASE("energies and lengths of molecules in the units of their papers", "[sweep][units]") {
  for (const DepthRow& row : depth_rows) {
    CAPTURE(row.epsilon, row.sigma);
    const std::string parameters = "epsilon = '" + row.epsilon + "'\nsigma = '" + row.sigma + "'\n";
    const Seen it = seen(structure_scene("a.xyz", "", parameters), "a.xyz", two_argon);
    CHECK(it.refusal == "");
    CHECK(near(it.energy.potential, row.potential, 1e-9));
  }
}

TEST_CASE("headings with the units of astropy, VizieR and the IAU are read", "[sweep][units]") {
  // m v^2 / 2 and -k^2 m, k = 0.01720209895, worked out by hand in au, day and Msun = 1.98841e30 kg; 1 Mearth is
  // 3.986004e14/1.3271244e20 Msun and 1 Mjup is 1.2668653e17/1.3271244e20 Msun (IAU 2015 B3), 1 au/yr is 1/365.25
  // au/day, 1 km/s is 86400/149597870.7 au/day.
  const double k2 = 0.01720209895 * 0.01720209895, earth = 3.986004e14 / 1.3271244e20,
               jupiter = 1.2668653e17 / 1.3271244e20;
  const double km_s = 86400 / 149597870.7;
  for (const auto& [mass, velocity, sun, planet, speed, m, v] :
       std::vector<std::tuple<std::string, std::string, double, double, double, double, double>>{
           {"solMass", "km s-1", 1, 3e-6, 29.78, 3e-6, 29.78 * km_s},
           {"M_sun", "km s**-1", 1, 3e-6, 29.78, 3e-6, 29.78 * km_s},
           {"M\xE2\x98\x89", "km/sec", 1, 3e-6, 29.78, 3e-6, 29.78 * km_s},
           {"Msol", "au/d", 1, 3e-6, 0.0172, 3e-6, 0.0172},
           {"earthMass", "AU/d", 1 / earth, 1, 0.0172, earth, 0.0172},
           {"M_earth", "AU yr-1", 1 / earth, 1, 6.28, earth, 6.28 / 365.25},
           {"jupiterMass", "m s-1", 1 / jupiter, 1, 29780, jupiter, 29.78 * km_s},
           {"M_Jup", "cm/sec", 1 / jupiter, 1, 2978000, jupiter, 29.78 * km_s},
           {"kg", "km/h", 1.98841e30, 5.96523e24, 107208, 3e-6, 29.78 * km_s}}) {
    CAPTURE(mass, velocity);
    const Seen it =
        seen(gravity_scene("bodies = 'b.csv'\n"), "b.csv",
             fmt::format("name,mass [{}],x [au],y,z,vx [{}],vy,vz\nSun,{:.17g},0,0,0,0,0,0\nplanet,{},1,0,0,0,"
                         "{},0\n",
                         mass, velocity, sun, planet, speed));
    CHECK(it.refusal == "");
    CHECK(near(it.energy.kinetic, m * v * v / 2, 1e-12));
    CHECK(near(it.energy.potential, -k2 * m, 1e-12));
  }
}

TEST_CASE("exponents of Fortran in quantities are told, and are no days", "[sweep][units][messages]") {
  const auto refusal = [](const std::string& mass) {
    return seen(gravity_scene("[[particles.body]]\nname = 'Sun'\nmass = '" + mass + "'\n"), "", "").refusal;
  };
  CHECK(refusal("1.989D30 kg") ==
        "scene.toml:5: mass: '1.989D30 kg' has a Fortran-style exponent; write '1.989e30 kg'");
  CHECK(refusal("1.989d+30 kg") ==
        "scene.toml:5: mass: '1.989d+30 kg' has a Fortran-style exponent; write '1.989e+30 kg'");
  CHECK(refusal("3 d") == "scene.toml:5: mass: '3 d' is a time; a mass is expected, such as '3 Msun'");
}

TEST_CASE("a number behind a number is no power and no factor", "[sweep][units][messages]") {
  const auto refusal = [](const std::string& a, const std::string& e) {
    return seen(gravity_scene("[[particles.body]]\nname = 'Sun'\nmass = '1 Msun'\n[[particles.body]]\nname = 'c'\n"
                              "mass = '0 kg'\na = '" +
                              a + "'\n" + e),
                "", "")
        .refusal;
  };
  const auto unexpected = [](const std::string& what, const std::string& in) {
    return "unexpected '" + what + "' in '" + in + "'; units are joined by '*', '/' or a space, as in 'kg m/s^2'";
  };
  REQUIRE(refusal("2 au", "e = 0.1\n") == "");
  for (const auto& [a, what] : std::vector<std::pair<std::string, std::string>>{{"2/10 au", "0"},
                                                                                {"5*10 au", "0"},
                                                                                {"5 * 1000 au", "0"},
                                                                                {"1 100 au", "0"},
                                                                                {"2 12 au", "2"},
                                                                                {"2 1-2 au", "-"}}) {
    CAPTURE(a);
    CHECK(refusal(a, "") == "scene.toml:9: a: " + unexpected(what, a));
  }
  CHECK(has(refusal("2 au", "e = '1/10'\n"), unexpected("0", "1/10")));
  CHECK(has(refusal("2 au",
                    "inc = '5\xC2\xB0"
                    "3'\n"),
            unexpected("3",
                       "5\xC2\xB0"
                       "3")));
  CHECK(has(
      seen(replaced(gravity_scene("[[particles.body]]\nname = 'Sun'\nmass = '1 Msun'\n"), "1 day", "1/12 yr"), "", "")
          .refusal,
      unexpected("2", "1/12 yr")));
  CHECK(has(
      seen(structure_scene("a.xyz", "", "epsilon = '1/12 kJ/mol'\nsigma = '0.34 nm'\n"), "a.xyz", two_argon).refusal,
      unexpected("2", "1/12 kJ/mol")));
  for (const auto& [mass, x, vx, wrong] : std::vector<std::tuple<std::string, std::string, std::string, std::string>>{
           {"1000 kg", "km", "km/s", "1000 kg"},
           {"kg", "100 km", "km/s", "100 km"},
           {"kg", "km", "10 km/s", "10 km/s"}}) {
    CAPTURE(wrong);
    const std::string told =
        seen(gravity_scene("bodies = 'b.csv'\n"), "b.csv",
             "name,mass [" + mass + "],x [" + x + "],y,z,vx [" + vx + "],vy,vz\nSun,1,0,0,0,0,0,0\n")
            .refusal;
    CHECK(has(told, unexpected("0", wrong)));
    CHECK(told.starts_with("b.csv:1: "));
  }
}

TEST_CASE("angles in degrees, minutes and seconds of arc", "[sweep][units]") {
  // z/r of a body 90 degrees past its node is the sine of the inclination, worked out by Python.
  for (const auto& [angle, sine] : std::vector<std::pair<std::string, double>>{{"5\xC2\xB0", 0.08715574274765817},
                                                                               {"5 \xC2\xB0", 0.08715574274765817},
                                                                               {"300 arcmin", 0.08715574274765817},
                                                                               {"18000 arcsec", 0.08715574274765817},
                                                                               {"1.8e7 mas", 0.08715574274765817}}) {
    CAPTURE(angle);
    const Seen it =
        seen(gravity_scene("[[particles.body]]\nname = 'Sun'\nmass = '1 Msun'\n[[particles.body]]\nname = 'a'\n"
                           "mass = '0 kg'\na = '1 au'\nM = '90 deg'\ninc = '" +
                           angle + "'\n"),
             "", "");
    CHECK(it.refusal == "");
    REQUIRE(it.particles.size() == 2);
    CHECK(near(it.particles.positions()[1][2], sine, 1e-14));
  }
}

}  // namespace
}  // namespace noether::test
