// BodyScene of files and of tables: together, about one another, and as of an epoch.

#include "engine/charge.hpp"
#include "engine/given_orbit.hpp"
#include "engine/sphere_columns.hpp"
#include "numbers/quantity.hpp"
#include "scene/read_particles.hpp"
#include "scene/scene.hpp"
#include "scene/warnings.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace noether::test {
namespace {

const std::string gravity_alone =
    "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'gravity'\n[integrator]\nmethod = "
    "'verlet'\nstep = '1 day'\nuntil = '10 day'\n";

/// BodyScene of a scene whose `[particles]` and what follows is given, with a file beside it.
struct BodyScene {
  explicit BodyScene(const std::string& particles, const std::string& file = "", const char* units = "solar",
                     const std::string& rest = gravity_alone)
      : text("units = '" + std::string(units) + "'\n[particles]\n" + particles + rest) {
    if (!file.empty()) write_text(folder / "bodies.txt", file);
  }
  Scene scene() const { return read_scene(text, folder / "scene.toml"); }
  ParticleSystem<double> particles() const { return scene().particles; }
  /// What reading it is refused with, the folder cut away.
  std::string refusal() const {
    try {
      scene();
    } catch (const Error& error) {
      const std::string message = error.what(), path = (folder / "").string();
      return message.starts_with(path) ? message.substr(path.size()) : message;
    }
    return "";
  }

  ScratchFolder folder;
  std::string text;
};

/// Two records of Jupiter about the Sun, as Horizons writes them.
const std::string jupiter_table =
    "Target body name: Jupiter Barycenter (5)        {source: DE441}\nCenter body name: Sun (10)\nCenter-site name: "
    "BODY "
    "CENTER\nOutput units    : AU-D\nOutput type     : GEOMETRIC cartesian states\nReference frame : Ecliptic of "
    "J2000.0\nJDTDB\n$$SOE\n2451545.000000000 = A.D. 2000-Jan-01 12:00:00.0000 TDB\n X = 5.2 Y = 0 Z = 0\n VX= 0 VY= "
    "7.543619416505264E-03 VZ= 0\n2451546.500000000 = A.D. 2000-Jan-03 00:00:00.0000 TDB\n X = 5.1 Y = 0.5 Z = 0\n VX= "
    "0 "
    "VY= 7E-03 VZ= 0\n$$EOE\n";

const std::string two_planets =
    "name,id,mass [Msun],x [au],y,z,vx [au/day],vy,vz\nSun,7,1,1,0,0,0,0,0\nEarth,3,3e-6,2,0,0,0,0.0172,0\n";

std::string body_table(const std::string& name, const std::string& keys) {
  return "[[particles.body]]\nname = '" + name + "'\n" + keys;
}

TEST_CASE("tables of Horizons about the Sun move as a planet and its star do", "[scene][bodies]") {
  const BodyScene bodies(
      "bodies = 'bodies.txt'\n", jupiter_table, "solar",
      "[hamiltonian]\ntype = 'wisdom_holman'\n[integrator]\nmethod = 'aba_10_6_4'\nstep = '10 day'\nuntil "
      "= '1000 day'\n");
  const Scene scene = bodies.scene();
  CHECK(scene.particles.names() == std::vector<std::string>{"Sun", "Jupiter Barycenter"});
  Simulation<double> sim = assemble(scene);
  REQUIRE(sim.run(100).ok());
  const auto& s = sim.particles();
  const Vec3<double> x = s.positions()[1] - s.positions()[0], v = s.velocities()[1] - s.velocities()[0];
  // Kepler's equation in 50 digits with the GM of DE440 for both.
  CHECK(std::abs(x[0] - 0.6179829302130653) < 2e-13);
  CHECK(std::abs(x[1] - 5.158746061217055) < 2e-13);
  CHECK(std::abs(v[0] + 0.007497219492929394) < 2e-16);
  CHECK(std::abs(v[1] - 0.0008909136639232234) < 2e-16);
}

TEST_CASE("the epoch of Horizons tables stands in the effective scene, and is a key", "[scene][bodies]") {
  const Scene first = BodyScene("bodies = 'bodies.txt'\n", jupiter_table).scene();
  CHECK(epoch_of(first.effective) == "JD 2451545 TDB");
  CHECK(has(first.effective_toml, "epoch = \"JD 2451545 TDB\"\n"));
  for (const std::string epoch : {"JD 2451546.5", "JD 2451546.5 TDB"}) {
    const BodyScene later("bodies = 'bodies.txt'\nepoch = '" + epoch + "'\n", jupiter_table);
    CHECK(later.particles().positions()[1] == Vec3<double>(5.1, 0.5, 0));
    const Scene scene = later.scene();
    CHECK(epoch_of(scene.effective) == "JD 2451546.5 TDB");
    CHECK(read_scene(scene.effective_toml, later.folder / "scene.toml").effective_toml == scene.effective_toml);
  }
  CHECK(BodyScene("bodies = 'bodies.txt'\nepoch = 'JD 2451546.5 UT'\n", jupiter_table).refusal() ==
        "scene.toml:4: epoch = \"JD 2451546.5 UT\" is not in the time scale of the tables, TDB");
  CHECK(BodyScene("bodies = 'bodies.txt'\nepoch = 2451545\n", jupiter_table).refusal() ==
        "scene.toml:4: epoch = 2451545 is not a Julian day; one is expected, such as \"JD 2451545\" or \"JD 2451545 "
        "TDB\"");
  CHECK(BodyScene("bodies = 'bodies.txt'\nepoch = 'JD 2451547'\n", jupiter_table).refusal() ==
        "bodies.txt:8: the table of Jupiter Barycenter has no record of JD 2451547; it has 2, from JD 2451545 to JD "
        "2451546.5");
  CHECK(epoch_of(BodyScene("bodies = 'bodies.txt'\nepoch = 'JD 2451545 TDB'\n", two_planets).scene().effective) ==
        "JD 2451545 TDB");
  CHECK(epoch_of(BodyScene("bodies = 'bodies.txt'\n", two_planets).scene().effective).empty());
}

TEST_CASE("states about the Solar System Barycenter without the Sun are warned of", "[scene][bodies][warnings]") {
  const std::string about_all = replaced(jupiter_table, "Sun (10)", "Solar System Barycenter (0)");
  CHECK(warnings_of(BodyScene("bodies = 'bodies.txt'\n", about_all).scene()) ==
        std::vector<std::string>{
            "the states in bodies.txt are about the Solar System Barycenter, but the Sun is not among them"});
  CHECK(warnings_of(BodyScene("bodies = 'bodies.txt'\n", jupiter_table).scene()).empty());
  const std::string sun =
      "[[particles.body]]\nname = 'Sun'\nmass = '1 Msun'\nx = ['0 au', '0 au', '0 au']\nv = ['0 km/s', '0 km/s', '0 "
      "km/s']\n";
  CHECK(warnings_of(BodyScene("bodies = 'bodies.txt'\n" + sun, about_all).scene()).empty());
}

TEST_CASE("bodies of a file and of tables stand together, the file's first", "[scene][bodies]") {
  const auto s =
      BodyScene("bodies = 'bodies.txt'\n" + body_table("comet", "mass = '0 kg'\nq = '0.5 au'\ne = 1\nT = '-20 day'\n") +
                    body_table("Moon", "mass = '7.3e22 kg'\nabout = 'Earth'\na = '384400 km'\n"),
                two_planets)
          .particles();
  CHECK(s.names() == std::vector<std::string>{"Sun", "Earth", "comet", "Moon"});
  CHECK(s.ids() == std::vector<std::int64_t>{7, 3, 8, 9});
  const double G = units::solar::G, day = 1;
  const auto comet = state_of_orbit({.q = 0.5, .e = 1, .T = -20 * day}, G);
  CHECK(s.positions()[2] == Vec3<double>(comet.first + Vec3<double>(1, 0, 0)));
  CHECK(s.velocities()[2] == comet.second);
  const auto moon = state_of_orbit({.a = 384400 * units::solar::km}, G * (3e-6 + 7.3e22 * units::solar::kg));
  CHECK(s.positions()[3] == Vec3<double>(moon.first + Vec3<double>(2, 0, 0)));
  CHECK(s.velocities()[3] == Vec3<double>(moon.second + Vec3<double>(0, 0.0172, 0)));
  // The effective scene is the same scene, and a change reaches the tables.
  const std::string table = "bodies = 'bodies.txt'\n[[particles.body]]\nname = 'c'\nmass = '0 kg'\na = '3 au'\n";
  const BodyScene one(table, two_planets);
  const Scene scene = one.scene();
  CHECK(read_scene(scene.effective_toml, one.folder / "scene.toml").effective_toml == scene.effective_toml);
  CHECK(read_scene(one.text, one.folder / "scene.toml", standard_parts(), {"particles.body.c.a=4 au"})
            .particles.positions()[2][0] == 5);
  CHECK(BodyScene(replaced(table, "'c'", "'Sun'"), two_planets).refusal() ==
        "scene.toml:5: two bodies are named 'Sun'; names must differ");
}

TEST_CASE("orbits by their periods have the sizes that are published, to the last digit", "[scene][bodies]") {
  // Periods, masses and semi-major axes as printed: Brozovic et al. 2015 (Charon), Agol et al. 2021 (TRAPPIST-1 b),
  // Torres et al. 2008 (HD 209458 b), Suarez Mascareno et al. 2020 (Proxima b); a geostationary orbit about the nominal
  // Earth.
  struct Published {
    const char *center, *mass, *period;
    double a, digit;
    const char* unit;
  };
  for (const Published& one : {Published{"1.30291e22 kg", "1.5866e21 kg", "6.3872273 days", 19596, 1, "km"},
                               Published{"0.0898 Msun", "1.374 Mearth", "1.510826 days", 0.01154, 1e-5, "AU"},
                               Published{"1.119 Msun", "0.685 Mjup", "3.52474859 days", 0.04707, 1e-5, "AU"},
                               Published{"0.1221 Msun", "0 Mearth", "11.1868 days", 0.04856, 1e-5, "AU"},
                               Published{"1 Mearth", "0 kg", "86164.0905 seconds", 42164, 1, "km"}}) {
    CAPTURE(one.period);
    const auto s = BodyScene(body_table("center", "mass = '" + std::string(one.center) + "'\n") +
                                 body_table("b", "mass = '" + std::string(one.mass) + "'\nP = '" + one.period + "'\n"),
                             "", "si", replaced(gravity_alone, "'1 day'", "'1 s'"))
                       .particles();
    CHECK(std::abs(s.positions()[1][0] / unit_value(one.unit, unit_system("si")) - one.a) < 0.6 * one.digit);
  }
  // Speeds at one astronomical unit, on a circle and on a parabola.
  const auto s =
      BodyScene(body_table("Sun", "mass = '1 Msun'\n") + body_table("circle", "mass = '0 kg'\na = '1 AU'\n") +
                body_table("parabola", "mass = '0 kg'\nq = '1 AU'\ne = 1\n"))
          .particles();
  const double km_per_s = units::solar::km / units::solar::second;
  CHECK(std::abs(s.velocities()[1][1] / km_per_s - 29.7847) < 0.5e-4);
  CHECK(std::abs(s.velocities()[2][1] / km_per_s - 42.1219) < 0.5e-4);
}

TEST_CASE("the scene and the table of docs/bodies.md can be run", "[scene][bodies]") {
  std::vector<std::string> blocks(1);  // lines that begin with four blanks
  for (const std::string& line : lines_of(read_text(std::filesystem::path(NOETHER_SOURCE_DIR) / "docs/bodies.md"))) {
    if (line.starts_with("    ")) {
      blocks.back() += line.substr(4) + "\n";
    } else if (!line.empty() && !blocks.back().empty()) {
      blocks.emplace_back();
    }
  }
  REQUIRE(blocks.size() >= 2);
  const BodyScene page(replaced(blocks[0], "[particles]\n", ""), blocks[1]);
  const std::string scene = replaced(page.text, "planets.csv", "bodies.txt");
  const Scene read = read_scene(scene, page.folder / "scene.toml");
  CHECK(read.particles.names() == std::vector<std::string>{"Sun", "Earth", "comet"});
  CHECK(assemble(read).run(10).ok());
}

const std::string reduced_gravity_alone =
    "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'gravity'\n[integrator]\nmethod = "
    "'verlet'\nstep = 0.1\nsteps = 1\n";

BodyScene reduced_scene(const std::string& particles, const std::string& file = "") {
  return BodyScene(particles, file, "reduced", reduced_gravity_alone);
}

TEST_CASE("elements are about the first body, another, a barycenter, or all before", "[scene][bodies]") {
  const std::string pair = body_table("A", "mass = 1\n") + body_table("B", "mass = 0.5\na = 2\n");
  // Circles seen from the x axis: distance a, speed sqrt(mu/a).
  const double v1 = std::sqrt(1.5 / 2), v2 = std::sqrt(0.75 / 0.25), v3 = std::sqrt(1.5 / 9);
  const auto s =
      reduced_scene(pair + body_table("C", "mass = 0.25\na = 0.25\nabout = 'B'\n") +
                    body_table("D", "mass = 0\na = 9\nabout = ['A', 'B']\n") + body_table("E", "mass = 0\na = 4\n") +
                    body_table("F", "mass = 0\nabout = 'B'\nx = [0, 0.5, 0]\nv = [1, 0, 0]\n"))
          .particles();
  CHECK(s.positions()[2] == Vec3<double>(2.25, 0, 0));
  CHECK(std::abs(s.velocities()[2][1] - (v1 + v2)) < 2e-15);
  CHECK(std::abs(s.positions()[3][0] - (2.0 / 3 + 9)) < 2e-15);
  CHECK(std::abs(s.velocities()[3][1] - (v1 / 3 + v3)) < 2e-16);
  CHECK(s.positions()[4] == Vec3<double>(4, 0, 0));
  CHECK(s.velocities()[4] == Vec3<double>(0, 0.5, 0));
  CHECK(s.positions()[5] == Vec3<double>(2, 0.5, 0));
  CHECK(s.velocities()[5] == Vec3<double>(1, s.velocities()[1][1], 0));

  const auto jacobi = reduced_scene("elements = 'jacobi'\n" + pair + body_table("C", "mass = 0.25\na = 9\n") +
                                    body_table("D", "mass = 0\na = 20\n"))
                          .particles();
  const double x3 = (0.25 * (2.0 / 3 + 9) + 1) / 1.75, v4 = (0.25 * (v1 / 3 + std::sqrt(1.75 / 9)) + 0.5 * v1) / 1.75;
  CHECK(std::abs(jacobi.positions()[2][0] - (2.0 / 3 + 9)) < 2e-15);
  CHECK(std::abs(jacobi.velocities()[2][1] - (v1 / 3 + std::sqrt(1.75 / 9))) < 4e-16);
  CHECK(std::abs(jacobi.positions()[3][0] - (x3 + 20)) < 4e-15);
  CHECK(std::abs(jacobi.velocities()[3][1] - (v4 + std::sqrt(1.75 / 20))) < 4e-16);

  // The same from a file.
  const BodyScene file =
      reduced_scene("elements = 'jacobi'\nbodies = 'bodies.txt'\n" + body_table("D", "mass = 0\na = 20\n"),
                    "name,mass,a,e,inc,Omega,omega,M\nA,1,,,,,,\nB,0.5,2,0,0,0,0,0\nC,0.25,9,0,0,0,0,0\n");
  for (Index i = 0; i < 4; ++i) CHECK(file.particles().positions()[i] == jacobi.positions()[i]);
  CHECK(has(file.scene().effective_toml, "elements = \"jacobi\"\n"));
}

TEST_CASE("what elements cannot be about is refused", "[scene][bodies][messages]") {
  const std::string a = body_table("A", "mass = 1\n"), b = body_table("B", "mass = 0\na = 2\n");
  CHECK(reduced_scene(a + body_table("C", "mass = 0\na = 1\nabout = 'a'\n")).refusal() ==
        "scene.toml:10: about = \"a\": there is no body 'a' above body 'C'; did you mean 'A'?");
  CHECK(reduced_scene(a + body_table("C", "mass = 0\na = 1\nabout = 'C'\n")).refusal() ==
        "scene.toml:10: about = \"C\": there is no body 'C' above body 'C'; expected one of: A");
  const std::string rigid = "[[particles.rigid_body]]\nname = 'R'\nmass = 1\ninertia = [1, 1, 1]\nabout = 'A'\na = 2\n";
  CHECK(reduced_scene(rigid + a).refusal() ==
        "scene.toml:7: about = \"A\": there is no body 'A' above body 'R'; put a [[particles.body]] first in the file, "
        "and all tables of that kind come first");
  CHECK(reduced_scene(a + b + body_table("C", "mass = 0\na = 1\nabout = ['A', 'A']\n")).refusal() ==
        "scene.toml:14: about = [\"A\", \"A\"] is not a valid barycenter; different bodies are expected");
  CHECK(reduced_scene(a + b + body_table("C", "mass = 0\na = 1\nabout = 3\n")).refusal() ==
        "scene.toml:14: about = 3 is a whole number; the name of a body, or a list of names, is expected");
  CHECK(reduced_scene(a + b + body_table("C", "mass = 0\na = 2\n") +
                      body_table("D", "mass = 0\na = 1\nabout = ['B', 'C']\n"))
            .refusal() ==
        "scene.toml:18: about = [\"B\", \"C\"]: these bodies have no mass, so they have no barycenter");
  CHECK(reduced_scene(a + b + body_table("C", "mass = 0\na = 1\nabout = 'B'\n")).refusal() ==
        "scene.toml:14: about = \"B\" has no mass; a body with a mass is expected");
  CHECK(reduced_scene(a + body_table("C", "mass = 0\na = 1\nP = 3\n")).refusal() ==
        "scene.toml:10: P = 3 is given together with a; give only one of a, P or q");
  CHECK(reduced_scene(a + body_table("C", "mass = 0\ne = 0.5\n")).refusal() ==
        "scene.toml:6: the elements of body 'C' do not give a size; give the semi-major axis a, the period P or the "
        "pericenter distance q");
  CHECK(reduced_scene("elements = 'jacoby'\n" + a).refusal() ==
        "scene.toml:3: unknown elements 'jacoby'; did you mean 'jacobi'?");
}

TEST_CASE("a site has the charge that it is given, 0 too, else that of its type", "[scene][bodies]") {
  const std::string head =
      "[[particles.type]]\nname = 'Q'\nmass = 1\ncharge = -1\nepsilon = 1\nsigma = 1\n"
      "[[particles.rigid_body]]\nname = 'pair'\nlinear = true\nx = [0, 0, 0]\nv = [0, 0, 0]\n";
  const auto charges = [&](const std::string& sites, const std::string& file = "") {
    const std::string pairs =
        "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = "
        "'lennard_jones'\ncutoff = 2.5\n[integrator]\nmethod = 'verlet'\nstep = 0.01\nsteps = 1\n";
    const Scene scene = BodyScene(head + sites, file, "reduced", pairs).scene();
    const std::vector<BodySite>& found = scene.particles.bodies()->kinds.at(0).sites;
    // The scene as it is stored has the same.
    const ScratchFolder folder;
    const Scene again = read_scene(scene.effective_toml, folder / "scene.toml");
    CHECK(again.particles.bodies()->kinds.at(0).sites == found);
    return std::vector<double>{found.at(0).charge, found.at(1).charge};
  };
  CHECK(charges("site = [{place = [1, 0, 0], mass = 1, charge = 0}, {place = [-1, 0, 0], mass = 1}]\n") ==
        std::vector<double>{0, -1});
  CHECK(charges("sites = 'bodies.txt'\n", "x,y,z,mass,charge\n1,0,0,1,0\n-1,0,0,1,0.5\n") ==
        std::vector<double>{0, 0.5});
  CHECK(charges("sites = 'bodies.txt'\n", "x,y,z,mass\n1,0,0,1\n-1,0,0,1\n") == std::vector<double>{-1, -1});
}

TEST_CASE("columns of a table are what parts of the scene give to particles", "[scene][bodies]") {
  const std::string file =
      "name,mass,x,y,z,vx,vy,vz,radius,charge\none,1,1,1,0,0,-1,0,0.5,2\nother,2,1,2.5,0.25,0,-2,0,0.75,-1\n";
  const std::string spheres =
      "[hamiltonian]\ntype = 'shearing_sheet'\nOmega = 1\n[[hamiltonian.force]]\ntype = 'hard_spheres'\n"
      "restitution = 0.5\n[integrator]\nmethod = 'verlet'\nstep = 0.05\nsteps = 100\n";
  const std::string one = "x = [1, 1, 0]\nv = [0, -1, 0]\nradius = 0.5\nmass = 1\ncharge = 2\n",
                    other = "x = [1, 2.5, 0.25]\nv = [0, -2, 0]\nradius = 0.75\nmass = 2\ncharge = -1\n";
  // From the table, from tables of the scene, and half from each: the same spheres, which touch.
  const auto run = [](const BodyScene& bodies) {
    Simulation<double> sim = assemble(bodies.scene());
    REQUIRE(sim.run(100).ok());
    return sim.particles();
  };
  const std::string box = "box = [10, 8, 20]\n";
  const auto expected =
      run(BodyScene(box + body_table("one", one) + body_table("other", other), "", "reduced", spheres));
  CHECK(expected.column<ContactCount>()[0] > 0);
  const std::string first = file.substr(0, file.find("other"));
  for (const BodyScene& bodies :
       {BodyScene(box + "bodies = 'bodies.txt'\n", file, "reduced", spheres),
        BodyScene(box + "bodies = 'bodies.txt'\n" + body_table("other", other), first, "reduced", spheres)}) {
    const auto found = run(bodies);
    CHECK((found.positions().all() == expected.positions().all()));
    CHECK((found.column<BodyRadius>().all() == expected.column<BodyRadius>().all()));
    CHECK((found.column<ContactHeat>().all() == expected.column<ContactHeat>().all()));
    CHECK(found.column<Charge>()[0] == 2);
    CHECK(found.column<Charge>()[1] == -1);
  }
  // A scene without spheres has no use for radii, and says so; a name that no part has is refused.
  const BodyScene without("bodies = 'bodies.txt'\n", file, "reduced",
                          replaced(replaced(gravity_alone, "1 day", "1"), "10 day", "10"));
  CHECK_FALSE(without.scene().particles.has<BodyRadius>());
  CHECK(warnings_of(without.scene()) ==
        std::vector<std::string>{"no part of this scene uses the column 'radius' of bodies.txt: it is left out",
                                 "the particles have charges that no force uses"});
  CHECK(BodyScene("bodies = 'bodies.txt'\n", replaced(file, "radius", "radios"), "reduced", spheres).refusal() ==
        "bodies.txt:1: unknown column 'radios'; did you mean 'radius'?");
  CHECK(BodyScene(box + "bodies = 'bodies.txt'\n", replaced(file, "0.75", "-1"), "reduced", spheres)
            .refusal()
            .find("the radius of 'other' is -1; 0 or more is expected") != std::string::npos);
}

TEST_CASE("what a splitting has in itself pulls at the centres of bodies, under methods on groups too",
          "[scene][bodies]") {
  const std::string rock =
      "[[particles.body]]\nname = 'sun'\nmass = 1\nx = [0, 0, 0]\nv = [0, 0, 0]\n"
      "[[particles.rigid_body]]\nname = 'rock'\nlinear = true\nx = [1, 0, 0]\nv = [0, 1, 0]\n"
      "site = [{place = [0.3, 0, 0], mass = 1e-4}, {place = [-0.3, 0, 0], mass = 1e-4}]\n";
  const Scene scene =
      BodyScene(rock, "", "reduced",
                "[hamiltonian]\ntype = 'wisdom_holman'\nG = 1\n[integrator]\nmethod = 'rkmk_rk4'\nstep = 0.01\n"
                "steps = 1\n")
          .scene();
  const auto field = field_of(scene);
  field->bind(scene.particles);
  VectorColumn<double> a(2);
  field->accelerations(scene.particles, a);
  CHECK(std::abs(std::as_const(a)[1][0] + 1) < 1e-14);  // on its sites it would be 1.3 times that
}

}  // namespace
}  // namespace noether::test
