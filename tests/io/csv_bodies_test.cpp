// Bodies from CSV: what is read, to the bit, and what is refused, in which words.

#include "engine/given_orbit.hpp"
#include "engine/orbital_elements.hpp"
#include "io/bodies.hpp"
#include "io/digest.hpp"
#include "io/inspect.hpp"
#include "io/trajectory.hpp"
#include "numbers/random.hpp"
#include "tests/io/support.hpp"

using namespace noether;
using test::error_of;

namespace {

ParticleSystem<double> read_csv(const std::string& content, const char* units = "solar") {
  const test::ScratchFolder folder;
  test::write_text(folder / "b.csv", content);
  return io::read_bodies(folder / "b.csv", {.units = &unit_system(units)});
}

/// The message about "b.csv", its folder cut away.
std::string csv_refusal(const std::string& content, const char* units = "solar") {
  const test::ScratchFolder folder;
  test::write_text(folder / "b.csv", content);
  const std::string message = error_of([&] { io::read_bodies(folder / "b.csv", {.units = &unit_system(units)}); });
  const std::size_t name = message.find("b.csv");
  return name == std::string::npos ? message : message.substr(name);
}

/// The numbers of a particle in a column.
std::vector<double> row_of(const ParticleSystem<double>& s, const std::string& name, Index i) {
  std::vector<double> row;
  s.columns().find(name)->visit([&](const auto& values) {
    for (int k = 0; k < s.columns().find(name)->info.width; ++k)
      row.push_back(static_cast<double>(values.component(k)[i]));
  });
  return row;
}

const std::string head = "name,mass [Msun],x [au],y [au],z [au],vx [au/day],vy [au/day],vz [au/day]\n";
const std::string bare_head = "mass,x,y,z,vx,vy,vz\n";
const std::string by_elements = "name,mass [Msun],a [au],e,inc [deg],Omega [deg],omega [deg],M [deg]\n";

}  // namespace

TEST_CASE("a table of bodies gives the numbers it holds, in the units of the system", "[bodies]") {
  const auto s = read_csv(
      "# masses and states\r\n"
      "\r\n"
      " name , mass [kg], vx [km/s],y [au],z [km],x [m],vy [au/day],vz [m/s], id\r\n"
      "Sun,1.98841e30,1,2,3,4,5,6,7   # a star\r\n"
      "\"the \"\"far\"\", #1\",+0,1e-3,-2.5,0,.5,1.,0,3\r\n");
  using namespace units::solar;
  REQUIRE(s.size() == 2);
  CHECK(s.units().name == "solar");
  CHECK(s.name(0) == "Sun");
  CHECK(s.name(1) == "the \"far\", #1");
  CHECK(s.ids() == std::vector<std::int64_t>{7, 3});
  CHECK(s.masses()[0] == 1.98841e30 * kg);
  CHECK(s.masses()[1] == 0);
  CHECK(s.positions()[0] == Vec3<double>(4 * meter, 2 * au, 3 * km));
  CHECK(s.velocities()[0] == Vec3<double>(1 * km / second, 5 * au / day, 6 * meter / second));
  CHECK(s.positions()[1] == Vec3<double>(0.5 * meter, -2.5 * au, 0));
  CHECK(s.velocities()[1] == Vec3<double>(1e-3 * km / second, 1 * au / day, 0));
}

TEST_CASE("a table has columns that parts give to particles, in units of their own", "[bodies]") {
  using namespace units::solar;
  // Of one number, of three, and one that nobody uses; names of the three as `convert` writes them.
  const io::BodiesOptions options{.columns = {{.name = "radius", .dimension = "length"},
                                              {.name = "spin", .dimension = "1/time", .width = 3},
                                              {.name = "love_number", .dimension = "1"}},
                                  .left_out = {{.name = "tide_lag", .dimension = "time"}}};
  const auto read = [&](const std::string& content) {
    const test::ScratchFolder folder;
    test::write_text(folder / "b.csv", content);
    return io::read_body_table(folder / "b.csv", options);
  };
  const std::string start = "mass [Msun],x [au],y,z,vx [au/day],vy,vz,";
  const io::BodyTable table = read(start +
                                   "spin[0],radius [km],spin[1] [1/day],tide_lag [s],spin[2],love_number\n"
                                   "1,0,0,0,0,0,0,1,695700,2,60,3,0.02\n0,1,0,0,0,0,0,4,0,5,0,6,0\n");
  const auto& columns = table.particles.columns();
  REQUIRE(columns.size() == 3);
  const auto number = [&](std::string_view name, int k, Index i) {
    return columns.find(name)->visit([&](const auto& values) { return static_cast<double>(values.component(k)[i]); });
  };
  CHECK(number("radius", 0, 0) == 695700 * km);
  CHECK(number("radius", 0, 1) == 0);
  CHECK(number("love_number", 0, 0) == 0.02);
  for (int k = 0; k < 3; ++k) {
    CHECK(number("spin", k, 0) == (1 + k) / day);
    CHECK(number("spin", k, 1) == (4 + k) / day);
  }
  CHECK(table.left_out == std::vector<std::string>{"tide_lag"});

  const auto refused = [&](const std::string& columns_and_rows) {
    const std::string message = error_of([&] { read(start + columns_and_rows); });
    return message.substr(message.find("b.csv"));
  };
  CHECK(refused("radius\n") == "b.csv:1: column 'radius' has no unit; write 'radius [au]' or another unit of length");
  CHECK(refused("radius [kg]\n") ==
        "b.csv:1: column 'radius' is in 'kg', which has the dimension mass; expected length");
  CHECK(refused("radius [km],radius [km]\n") == "b.csv:1: column 'radius' appears twice");
  CHECK(refused("radius [km]\n1,0,0,0,0,0,0,big\n") == "b.csv:2: column 'radius' is 'big', which is not a number");
  CHECK(refused("radius [km]\n1,0,0,0,0,0,0,\n") == "b.csv:2: column 'radius' is empty; expected a number");
  CHECK(refused("radius [Mpc]\n1,0,0,0,0,0,0,1e300\n") == "b.csv:2: the radius of body_1 is not finite in these units");
  CHECK(refused("spin[0] [1/day],spin[2]\n") ==
        "b.csv:1: there is no column spin[1]; expected all of spin[0], spin[1], spin[2]");
  CHECK(refused("spin [1/day]\n") ==
        "b.csv:1: column 'spin' has 3 numbers; give a column for each: spin[0], spin[1], spin[2]");
  CHECK(csv_refusal("mass,x,y,z,vx,vy,vz,radius\n", "reduced").starts_with("b.csv:1: unknown column 'radius'"));
}

#if NOETHER_HDF5
TEST_CASE("columns of parts are written as they are read, to the bit, in every system of units", "[bodies][inspect]") {
  const std::vector<ColumnInfo> infos = {
      {.name = "charge", .dimension = "charge"},
      {.name = "phase", .dimension = "angle"},
      {.name = "radius", .dimension = "length"},
      {.name = "share", .dimension = "1"},
      {.name = "spin", .dimension = "mass length^2/time", .role = ColumnRole::momentum, .width = 3},
      {.name = "turn", .dimension = "1", .role = ColumnRole::configuration, .width = 4},
      {.name = "warmth", .dimension = "mass length^2/time^2/temperature", .width = 9}};
  for (const char* units : {"solar", "molecular", "si", "reduced"}) {
    INFO(units);
    ParticleSystem<double> s(unit_system(units));
    Philox random(7, 1);
    for (int i = 0; i < 5; ++i)
      s.add(fmt::format("{}", i), random.uniform(), {random.uniform(), 0, 1}, {0, 0, random.uniform()});
    for (const ColumnInfo& info : infos) {
      s.add_column(info);
      for (Index i = 0; i < s.size(); ++i) {
        std::vector<double> row;
        for (int k = 0; k < info.width; ++k)
          row.push_back((random.uniform() - 0.5) * std::pow(10, 60 * random.uniform() - 30));
        s.set_row(info.name, i, row);
      }
    }
    const test::ScratchFolder folder;
    io::write_one_frame(folder / "one.h5", s, 0, 0);
    io::convert(folder / "one.h5", folder / "one.csv", {.bodies = true});
    const auto back =
        io::read_body_table(folder / "one.csv", {.units = &unit_system(units), .columns = infos}).particles;
    CHECK(back.columns().infos() == s.columns().infos());
    for (const ColumnInfo& info : infos) {
      for (Index i = 0; i < s.size(); ++i) CHECK(row_of(back, info.name, i) == row_of(s, info.name, i));
    }
    CHECK(io::digest(back) == io::digest(s));
    io::write_one_frame(folder / "two.h5", back, 0, 0);
    io::convert(folder / "two.h5", folder / "two.csv", {.bodies = true});
    CHECK(test::read_text(folder / "two.csv") == test::read_text(folder / "one.csv"));
  }
}

TEST_CASE("a column that a table cannot have is refused by its name", "[bodies][inspect][messages]") {
  for (const char* name : {"e", "vx", "about", "a,b", "c#"}) {
    ParticleSystem<double> s(unit_system("si"));
    s.add("one", 1, {0, 0, 0}, {0, 0, 0});
    s.add_column(ColumnInfo{.name = name, .dimension = "1"});
    const test::ScratchFolder folder;
    io::write_one_frame(folder / "one.h5", s, 0, 0);
    CHECK(error_of([&] { io::convert(folder / "one.h5", folder / "one.csv", {.bodies = true}); }) ==
          fmt::format("cannot write bodies to '{}': a table cannot store a column '{}', a name that tables have for "
                      "something else or cannot write; give a name that ends in .h5",
                      (folder / "one.csv").string(), name));
    CHECK_FALSE(std::filesystem::exists(folder / "one.csv"));
  }
}
#endif

TEST_CASE("a table without names numbers its bodies, and one in reduced units takes bare numbers", "[bodies]") {
  const auto s = read_csv("\xEF\xBB\xBFmass,x,y,z,vx,vy,vz [1]\n1,0,0,0,0,0,0.1\n2,1,0,0,0,0,0", "reduced");
  REQUIRE(s.size() == 2);
  CHECK(s.name(0) == "body_1");
  CHECK(s.name(1) == "body_2");
  CHECK(s.ids() == std::vector<std::int64_t>{0, 1});
  CHECK(s.velocities()[0] == Vec3<double>(0, 0, 0.1));
}

TEST_CASE("elements are about the first body, with the sum of both masses", "[bodies]") {
  const double degree = units::solar::degree;
  const test::ScratchFolder folder;
  test::write_text(folder / "b.csv",
                   by_elements + "Sun,1,,,,,,\nEarth,3e-6,1,0.0167,0.1,20,30,40\ncomet,0,-5,1.5,100,0,0,-9\n");
  const auto s = io::read_bodies(folder / "b.csv", {.G = 3e-4});
  REQUIRE(s.size() == 3);
  CHECK(s.positions()[0] == Vec3<double>::Zero());
  CHECK(s.velocities()[0] == Vec3<double>::Zero());
  const auto earth =
      state_from_elements<double>({1, 0.0167, 0.1 * degree, 20 * degree, 30 * degree, 40 * degree}, 3e-4 * (1 + 3e-6));
  CHECK(s.positions()[1] == earth.first);
  CHECK(s.velocities()[1] == earth.second);
  const auto comet = state_from_elements<double>({-5, 1.5, 100 * degree, 0, 0, -9 * degree}, 3e-4);
  CHECK(s.positions()[2] == comet.first);
  CHECK(s.velocities()[2] == comet.second);
}

TEST_CASE("elements of the reduced system are in radians, unless they say degrees", "[bodies]") {
  const auto s =
      read_csv("mass,a,e,inc [rad],Omega [deg],omega [rad],M [1]\n1,,,,,,\n0,1,0.1,0.5,90,0.25,0.75\n", "reduced");
  const auto expected = state_from_elements<double>({1, 0.1, 0.5, 90 * units::solar::degree, 0.25, 0.75}, 1.0);
  CHECK(s.positions()[1] == expected.first);
  CHECK(s.velocities()[1] == expected.second);
}

TEST_CASE("a unit stands once for positions, velocities and angles", "[bodies]") {
  using namespace units::solar;
  const auto s = read_csv("mass [kg],x [km],y,z,vx,vy,vz [km/s]\n1,1,2,3,4,5,6\n");
  CHECK(s.positions()[0] == Vec3<double>(1 * km, 2 * km, 3 * km));
  CHECK(s.velocities()[0] == Vec3<double>(4 * km / second, 5 * km / second, 6 * km / second));
  CHECK(read_csv("mass (kg),x (km),y,z,vx (km/s),vy,vz\n1,1,2,3,4,5,6\n").velocities()[0] == s.velocities()[0]);
  CHECK(read_csv("mass (kg) x (km) y z vx (km / s) vy vz\n1 1 2 3 4 5 6\n").velocities()[0] == s.velocities()[0]);
  const auto angles = read_csv("mass [Msun],a [au],e,inc,Omega [deg],omega,M\n1,,,,,,\n0,1,0.1,10,20,30,40\n");
  const auto expected = state_from_elements<double>({1, 0.1, 10 * degree, 20 * degree, 30 * degree, 40 * degree}, G);
  CHECK(angles.positions()[1] == expected.first);
  CHECK(csv_refusal("mass [kg],x [km],y [au],z,vx [km/s],vy,vz\n") ==
        "b.csv:1: column 'z' has no unit beside 'au' and 'km'; write 'z [au]' or another unit of length");
  // Bare angles of the reduced system are radians; beside one in degrees it would be a guess.
  CHECK(csv_refusal("mass,a,e,inc [deg],Omega,omega,M\n", "reduced") ==
        "b.csv:1: column 'Omega' has no unit beside 'deg'; write 'Omega [deg]' or another unit of angle");
}

TEST_CASE("fields are parted by commas, semicolons, tabs or blanks", "[bodies]") {
  using namespace units::solar;
  const std::string columns = "name,mass [kg],x [au],y [au],z [au],vx [kg m/kg/s],vy,vz\n";
  const std::string rows = "\"a b\",1,2,3,4,5,6,7   # a comment, with a comma\n\"c;d\",0,-1e-3,+2,.5,1,0,0\n";
  const auto with = [](std::string text, const std::string& separator) {
    for (std::size_t at = text.find(','); at != std::string::npos; at = text.find(',', at + separator.size())) {
      text.replace(at, 1, separator);
    }
    return text;
  };
  const auto plain = read_csv(columns + rows);
  for (const std::string separator : {";", "\t", " ; ", "  ", " \t "}) {
    CAPTURE(separator);
    const auto s = read_csv(with(columns + rows, separator));
    REQUIRE(s.size() == 2);
    CHECK(s.name(0) == "a b");
    CHECK(s.name(1) == "c;d");
    for (Index i = 0; i < 2; ++i) {
      CHECK(s.positions()[i] == plain.positions()[i]);
      CHECK(s.velocities()[i] == plain.velocities()[i]);
    }
  }
  CHECK(plain.velocities()[0] ==
        Vec3<double>(5 * kg * meter / kg / second, 6 * kg * meter / kg / second, 7 * kg * meter / kg / second));
  // As spreadsheets write it, and with the line ends of every system.
  CHECK(read_csv("sep=;\r\nmass [kg];x [m];y;z;vx [m/s];vy;vz\r\n1;1;2;3;4;5;6\r\n", "si").positions()[0][2] == 3);
  CHECK(read_csv("mass x y z vx vy vz\r1 1 2 3 4 5 6\r2 2 2 3 4 5 6\r", "reduced").size() == 2);
  CHECK(csv_refusal("mass;x;y;z;vx;vy;vz\n\"1\" 2;0;0;0;0;0;0\n", "reduced") ==
        "b.csv:2: '2' follows the double quote that ends a field; expected a semicolon");
}

TEST_CASE("elements of a table may be other ones, row by row", "[bodies]") {
  using namespace units::solar;
  const auto s = read_csv(
      "name,mass [Msun],a [au],q [au],P [yr],e,inc [deg],Omega,pomega,l,f,T "
      "[day]\nSun,1,,,,,,,,,,\nEarth,3e-6,1,,,0.0167,0.1,"
      "20,50,90,,\ncomet,0,,0.5,,1,100,0,10,,,-20\nfar,0,,,8,0.5,1,2,3,,90,\n");
  REQUIRE(s.size() == 4);
  const auto earth = state_of_orbit(
      {.a = 1, .e = 0.0167, .inc = 0.1 * degree, .Omega = 20 * degree, .pomega = 50 * degree, .l = 90 * degree},
      G * (1 + 3e-6));
  const auto comet =
      state_of_orbit({.q = 0.5, .e = 1, .inc = 100 * degree, .Omega = 0, .pomega = 10 * degree, .T = -20}, G);
  const auto far = state_of_orbit(
      {.P = 8 * year, .e = 0.5, .inc = 1 * degree, .Omega = 2 * degree, .pomega = 3 * degree, .f = 90 * degree}, G);
  CHECK(s.positions()[1] == earth.first);
  CHECK(s.velocities()[1] == earth.second);
  CHECK(s.positions()[2] == comet.first);
  CHECK(s.velocities()[3] == far.second);
}

TEST_CASE("elements and vectors may be about another body, a barycenter, or all before it", "[bodies]") {
  const std::string heads = "name,mass,about,a,e,inc,Omega,omega,M\nA,1,,,,,,,\nB,0.5,,2,0,0,0,0,0\n";
  const auto s = read_csv(heads + "C,0.25,B,0.25,0,0,0,0,0\nD,0,A + B,9,0,0,0,0,0\n", "reduced");
  // Circles seen from the x axis: distance a, speed sqrt(mu/a).
  const double v1 = std::sqrt(1.5 / 2), v2 = std::sqrt(0.75 / 0.25), v3 = std::sqrt(1.5 / 9);
  CHECK(s.positions()[2] == Vec3<double>(2.25, 0, 0));
  CHECK(std::abs(s.velocities()[2][1] - (v1 + v2)) < 2e-15);
  CHECK(std::abs(s.positions()[3][0] - (2.0 / 3 + 9)) < 2e-15);
  CHECK(std::abs(s.velocities()[3][1] - (v1 / 3 + v3)) < 2e-16);

  const test::ScratchFolder folder;
  test::write_text(folder / "b.csv", heads + "C,0.25,,9,0,0,0,0,0\nD,0,,20,0,0,0,0,0\n");
  const auto jacobi = io::read_bodies(folder / "b.csv",
                                      {.units = &unit_system("reduced"), .elements = io::ElementsAbout::all_before_it});
  const double x3 = (0.25 * (2.0 / 3 + 9) + 1) / 1.75, v4 = (0.25 * (v1 / 3 + std::sqrt(1.75 / 9)) + 0.5 * v1) / 1.75;
  CHECK(std::abs(jacobi.positions()[2][0] - (2.0 / 3 + 9)) < 2e-15);
  CHECK(std::abs(jacobi.velocities()[2][1] - (v1 / 3 + std::sqrt(1.75 / 9))) < 4e-16);
  CHECK(std::abs(jacobi.positions()[3][0] - (x3 + 20)) < 4e-15);
  CHECK(std::abs(jacobi.velocities()[3][1] - (v4 + std::sqrt(1.75 / 20))) < 4e-16);

  const auto vectors =
      read_csv("name,mass,about,x,y,z,vx,vy,vz\nA + B,1,,1,2,3,4,5,6\nmoon,0,A + B,0.5,0,0,0,0.25,0\n", "reduced");
  CHECK(vectors.positions()[1] == Vec3<double>(1.5, 2, 3));
  CHECK(vectors.velocities()[1] == Vec3<double>(4, 5.25, 6));
  CHECK(csv_refusal(heads + "C,0,BB,1,0,0,0,0,0\n", "reduced") ==
        "b.csv:4: there is no body 'BB' above this one; did you mean 'B'?");
  CHECK(csv_refusal(heads + "C,0,,1,0,0,0,0,0\nD,0,C,1,0,0,0,0,0\n", "reduced") ==
        "b.csv:5: column 'about' is 'C', which has no mass, so nothing can orbit it");
  CHECK(csv_refusal("name,mass,about,x,y,z,vx,vy,vz\nA,1,B,0,0,0,0,0,0\n", "reduced") ==
        "b.csv:2: column 'about' of the first body must be empty, because no body is above it");
}

TEST_CASE("a wrong heading is refused with what is wrong and what to write", "[bodies][messages]") {
  CHECK(csv_refusal("") ==
        "b.csv: the table is empty; expected a line of column names, such as 'name,mass [Msun],x [au],...'");
  CHECK(csv_refusal("# nothing\n\n") ==
        "b.csv: the table is empty; expected a line of column names, such as 'name,mass [Msun],x [au],...'");
  CHECK(csv_refusal("#\n" + head) == "b.csv:2: the table has column names, but no bodies");
  // An unknown column comes before missing ones.
  CHECK(csv_refusal("name,mas [Msun],x [au]\nSun,1,0\n") == "b.csv:1: unknown column 'mas'; did you mean 'mass'?");
  CHECK(csv_refusal("name,mass [Msun],position [au]\n") ==
        "b.csv:1: unknown column 'position'; expected one of: name, id, mass, x, y, z, vx, vy, vz, about, a, P, q, e, "
        "inc, "
        "Omega, omega, pomega, M, f, l, T");
  CHECK(csv_refusal("name,,mass [Msun]\n") == "b.csv:1: column 2 has no name");
  CHECK(csv_refusal("mass [Msun],x [au],x [au]\n") == "b.csv:1: column 'x' appears twice");
  CHECK(csv_refusal("mass [Msun],x,y\n") ==
        "b.csv:1: column 'x' has no unit; write 'x [au]' or another unit of length");
  CHECK(csv_refusal("mass [Msun],vx\n") ==
        "b.csv:1: column 'vx' has no unit; write 'vx [au/day]' or another unit of velocity");
  CHECK(csv_refusal("mass [Msun],a [au],e,inc\n") ==
        "b.csv:1: column 'inc' has no unit; write 'inc [deg]' or another unit of angle");
  CHECK(csv_refusal("mass [Msun],x [day]\n") ==
        "b.csv:1: column 'x' is in 'day', which has the dimension time; expected length");
  CHECK(csv_refusal("name [au]\n") == "b.csv:1: column 'name' has no unit; take 'au' out");
  CHECK(csv_refusal("mass [Msun],x [au],y [au],z [au],vx [au/day]\n") ==
        "b.csv:1: there is no column vy, vz; expected mass and x, y, z, vx, vy, vz, or the elements a, e, inc, Omega, "
        "omega, M");
  CHECK(
      csv_refusal("a [au],e,inc [deg],Omega [deg],omega [deg]\n") ==
      "b.csv:1: there is no column mass, M; expected mass and a (or P, q), e, inc, Omega, omega (or pomega), M (or f, "
      "l, T)");
  CHECK(csv_refusal("mass [Msun],x [au],a [au]\n") ==
        "b.csv:1: columns 'x' and 'a' do not go together; give either positions and velocities, or elements");
  CHECK(csv_refusal("M [Msun],x [au]\n") ==
        "b.csv:1: column 'M' is in 'Msun', which has the dimension mass; expected angle; did you mean 'mass'?");
  CHECK(csv_refusal("GM [Msun],x [au]\n") ==
        "b.csv:1: unknown column 'GM'; a gravitational parameter G m is not supported: give the mass");
  CHECK(csv_refusal("weight [Msun],x [au]\n") == "b.csv:1: unknown column 'weight'; did you mean 'mass'?");
  CHECK(csv_refusal("mass [Msun],semi-major axis [au]\n") ==
        "b.csv:1: unknown column 'semi-major axis'; did you mean 'a'?");
  CHECK(csv_refusal("mass [Mo],x [au]\n") ==
        "b.csv:1: column 'mass': unknown unit 'Mo'; expected one of: kg, g, Msun, u, Mearth, Mjup");  // not m
  CHECK(csv_refusal("mass [Msun],x [furlong]\n").starts_with("b.csv:1: column 'x': unknown unit 'furlong'"));
}

TEST_CASE("a broken row is refused with its line", "[bodies][messages]") {
  const std::string sun = "Sun,1,0,0,0,0,0,0\n";
  CHECK(csv_refusal("#\n" + head + sun + "\nEarth,1,2\n") ==
        "b.csv:5: this row has 3 fields; expected 8, as line 2 names");
  CHECK(csv_refusal(head + "Sun,1,0,0,O,0,0,0\n") == "b.csv:2: column 'z' is 'O', which is not a number");
  CHECK(csv_refusal(head + "Sun,1,0,0,1 2,0,0,0\n") == "b.csv:2: column 'z' is '1 2', which is not a number");
  CHECK(csv_refusal("mass [kg];x [m];y;z;vx [m/s];vy;vz\n1;0;0;0,5;0;0;0\n") ==
        "b.csv:2: column 'z' is '0,5', which is not a number; use a decimal point");
  CHECK(
      csv_refusal("Sun,1,0,0,0,0,0,0\n").starts_with("b.csv:1: unknown column 'Sun'; expected one of: name, id, mass"));
  CHECK(csv_refusal("1,0,0,0,0,0,0\n") ==
        "b.csv:1: '1' is a number where a column name is expected; the first line names the columns, such as "
        "'name,mass [Msun],x [au],...', and must not be a comment");
  CHECK(csv_refusal(head + "Sun,1,0,0,,0,0,0\n") == "b.csv:2: column 'z' is empty; expected a number");
  CHECK(csv_refusal(head + "Sun,1,nan,0,0,0,0,0\n") == "b.csv:2: column 'x' is nan; expected a finite number");
  CHECK(csv_refusal(head + "Sun,inf,0,0,0,0,0,0\n") == "b.csv:2: column 'mass' is inf; expected a finite number");
  CHECK(csv_refusal(head + "Sun,1e999,0,0,0,0,0,0\n") ==
        "b.csv:2: column 'mass' is 1e999, which is outside the range of doubles");
  CHECK(csv_refusal(head + "Sun,-1,0,0,0,0,0,0\n") == "b.csv:2: column 'mass' is -1; expected 0 or more");
  CHECK(csv_refusal(head + "Sun,++1,0,0,0,0,0,0\n") == "b.csv:2: column 'mass' is '++1', which is not a number");
  CHECK(csv_refusal(head + sun + sun) == "b.csv:3: the name 'Sun' is already used; names must differ");
  CHECK(csv_refusal(head + ",1,0,0,0,0,0,0\n") == "b.csv:2: the name is empty");
  CHECK(csv_refusal("id," + bare_head + "1,1,0,0,0,0,0,0\n1,1,1,0,0,0,0,0\n", "reduced") ==
        "b.csv:3: the id 1 is already used; ids must differ");
  CHECK(csv_refusal("id," + bare_head + "-1,1,0,0,0,0,0,0\n", "reduced") ==
        "b.csv:2: column 'id' is '-1'; expected a whole number from 0 to 9007199254740992");
  CHECK(csv_refusal(head + "\"Sun,1,0,0,0,0,0,0\n") == "b.csv:2: a double quote is not closed on this line");
  CHECK(csv_refusal(head + "\"Sun\"s,1,0,0,0,0,0,0\n") ==
        "b.csv:2: 's' follows the double quote that ends a field; expected a comma");
  CHECK(csv_refusal(head + "the \"Sun\",1,0,0,0,0,0,0\n") ==
        "b.csv:2: a double quote is inside a field; quote the whole field, and write \"\" for a quote in it");
  CHECK(csv_refusal("name,mass [Msun],x [Gyr]\n").starts_with("b.csv:1: column 'x' is in 'Gyr'"));
  CHECK(csv_refusal("mass [kg],x [au],y [au],z [au],vx [au/fs],vy [au/day],vz [au/day]\n1,0,0,0,1e300,0,0\n") ==
        "b.csv:2: the state of body_1 is not finite in these units");
}

TEST_CASE("elements that are no orbit are refused", "[bodies][messages]") {
  const std::string sun = "Sun,1,,,,,,\n";
  CHECK(csv_refusal(by_elements + "Sun,1,5,,,,,\n") ==
        "b.csv:2: column 'a' of the first body is '5', but elements are relative to this body; leave them empty");
  CHECK(csv_refusal(by_elements + "Sun,0,,,,,,\n") ==
        "b.csv:2: Sun has no mass, but elements are relative to this body; give it a mass");
  CHECK(csv_refusal(by_elements + sun + "Earth,0,1,1,0,0,0,0\n") ==
        "b.csv:3: a = 1 and e = 1 do not describe an orbit; expected a > 0 and 0 <= e < 1, or a < 0 and e > 1");
  CHECK(csv_refusal(by_elements + sun + "Earth,0,-1,0.5,0,0,0,0\n") ==
        "b.csv:3: a = -1 and e = 0.5 do not describe an orbit; expected a > 0 and 0 <= e < 1, or a < 0 and e > 1");
  CHECK(csv_refusal("name,mass [Msun],q [au],e,inc [deg],Omega,omega,M\n" + sun + "c,0,2,1,0,0,0,3\n") ==
        "b.csv:3: M = 3 has no meaning on a parabola, e = 1; give f or T");
  CHECK(csv_refusal("mass [Msun],a [au],P [yr],e,inc [deg],Omega,omega,M\n1,,,,,,,\n0,,,0,0,0,0,0\n") ==
        "b.csv:3: the orbit has no size; give a, P or q");
  CHECK(csv_refusal("mass [Msun],a [au],P [yr],e,inc [deg],Omega,omega,M\n1,,,,,,,\n0,1,1.5,0,0,0,0,0\n") ==
        "b.csv:3: P = 1.5 is given together with a; give only one of a, P or q");
  CHECK(csv_refusal(by_elements + sun + "Earth,0,,0.5,0,0,0,0\n") == "b.csv:3: column 'a' is empty; expected a number");
  CHECK(csv_refusal(by_elements + "Sun,1,0,0,0,0,0,0\n").empty());
}

TEST_CASE("what is no table is a file error, in one line", "[bodies][messages]") {
  CHECK(csv_refusal(std::string("\x7f"
                                "ELF\0\0\1",
                                7)) ==
        "b.csv: this is not a text file: byte 4 is zero; expected CSV or a vector table of Horizons");
  const test::ScratchFolder folder;
  CHECK_THROWS_AS(io::read_bodies(folder / "missing.csv"), FileError);
  CHECK(error_of([&] { io::read_bodies(folder / "missing.csv"); }) ==
        (folder / "missing.csv").string() + ": cannot be read: No such file or directory");
  CHECK(error_of([&] { io::read_bodies(folder.path()); }) ==
        folder.path().string() + ": cannot be read: Is a directory");
  for (const std::string& garbage : {std::string("\x01\x02\x03,\xff\n"), std::string("\x89PNG\r\n\x1a\n")}) {
    const std::string message = csv_refusal(garbage);
    CHECK(message.starts_with("b.csv:1: "));
    CHECK(message.find('\n') == std::string::npos);
  }
  CHECK(csv_refusal(",").starts_with("b.csv: the table is empty; expected a line of column names"));
}
