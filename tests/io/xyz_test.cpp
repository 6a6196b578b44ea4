// Extended XYZ and .gro: what is read, and what is refused, in which words.

#include "engine/charge.hpp"
#include "io/structure.hpp"
#include "tests/io/support.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

using namespace noether;
using test::error_of;

namespace {

ParticleSystem<double> read_as(const std::string& name, const std::string& content,
                               const io::StructureOptions& options = {}) {
  const test::ScratchFolder folder;
  test::write_text(folder / name, content);
  return io::read_structure(folder / name, options);
}

std::string refusal_of(const std::string& name, const std::string& content, const io::StructureOptions& options = {}) {
  const std::string message = error_of([&] { read_as(name, content, options); });
  const std::size_t at = message.find(name);
  return at == std::string::npos ? message : message.substr(at);
}

std::string xyz_refusal(const std::string& content, const io::StructureOptions& options = {}) {
  return refusal_of("m.xyz", content, options);
}
std::string gro_refusal(const std::string& content, const io::StructureOptions& options = {}) {
  return refusal_of("m.gro", content, options);
}

const std::string cubic = "Lattice=\"20 0 0 0 30.0 0.0 0 0 40\" ";
const std::string water =
    "a title\n"
    "    4\n"
    "    1SOL     OW    1   0.126   1.624   1.679  0.1227 -0.0580  0.0434\n"
    "    1SOL    HW1    2   0.190   1.661   1.747  0.8085  0.3191 -0.7791\n"
    "    1SOL    HW2    3   0.177  -1.568   1.613 -0.9045 -2.6469  1.3180\n"
    "    2SOL     OW    4   1.275   0.053   0.622  0.2519  0.3140 -0.1734\n";
const std::string water_box = "   1.82060   1.82060   1.82060\n";
const io::StructureOptions water_masses = {.types = {{.type = "OW", .mass = 15.9994, .charge = -0.8476},
                                                     {.type = "HW1", .mass = 1.008},
                                                     {.type = "HW2", .mass = 1.008}}};

}  // namespace

TEST_CASE("extended XYZ gives particles in a box", "[structure]") {
  const auto s =
      read_as("m.xyz", "3\n" + cubic +
                           "time=1.5 Properties=species:S:1:pos:R:3:velo:R:3:tag:I:1:charge:R:1 pbc=\"T T T\"\n"
                           "O 1 2 3 1 0 0 7 -0.5\nH -1 2 3 0 2 0 8 0.25\nO 1.5 2 39 0 0 -3 9 0.25\n\n");
  CHECK(s.box() == Box::periodic({2, 3, 4}));
  CHECK(s.ids() == std::vector<std::int64_t>{1, 2, 3});
  CHECK(s.name(1) == "H_2");
  CHECK(s.topology()->type_names == std::vector<std::string>{"O", "H"});
  CHECK(s.topology()->types == std::vector<std::int64_t>{0, 1, 0});
  CHECK(s.masses()[0] == 15.999);
  CHECK(s.masses()[1] == 1.008);
  CHECK(std::abs(s.positions()[0][0] - 0.1) <= 0x1p-51);
  CHECK(s.images()[1] == Vec3<std::int32_t>(-1, 0, 0));
  CHECK(s.velocities()[1] == Vec3<double>(0, 200, 0));
  CHECK(s.column<Charge>()[0] == -0.5);
}

TEST_CASE("momenta of extended XYZ are in sqrt(eV u)", "[structure]") {
  const auto s = read_as("m.extxyz", "1\nProperties=species:S:1:pos:R:3:masses:R:1:momenta:R:3\nX 0 0 0 4 6 0 0\n");
  CHECK(s.masses()[0] == 4);
  CHECK(std::abs(s.velocities()[0][0] - 1.5 * std::sqrt(96.48533212331002)) < 1e-14 * 15);
  CHECK_FALSE(s.box().is_periodic());
}

TEST_CASE("what ASE writes has the velocities that ASE has", "[structure]") {
  const auto folder = std::filesystem::path(NOETHER_SOURCE_DIR) / "tests" / "data" / "extended_xyz";
  const auto s = io::read_structure(folder / "ions.extxyz");
  REQUIRE(s.size() == 5);
  CHECK(s.box() == Box::periodic({6 * 0.1, 8 * 0.1, 10 * 0.1}));
  CHECK(s.column<Charge>()[4] == -1);
  CHECK(s.unwrapped(3)[0] < 0);
  std::ifstream expected(folder / "ions.velocities.txt");
  std::string heading;
  std::getline(expected, heading);
  for (Index i = 0; i < s.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      double v = 0;
      REQUIRE(expected >> v);
      // ASE writes eight decimals of the momenta.
      CHECK(std::abs(s.velocities()[i][k] - 100 * v) < 1e-6);
    }
  }
}

TEST_CASE("plain XYZ is read in open space, or in a box that is given", "[structure]") {
  const std::string content = "2\nno properties at all\nAr 0 0 0\nAr 3.4 0 0\n";
  CHECK(read_as("m.xyz", content).masses()[1] == 39.948);
  CHECK(read_as("m.xyz", content, {.box = Box::periodic({1, 1, 1})}).box().is_periodic());
  const auto bare = read_as("m.xyz", "1\n\nAr 1.25 0 0\n", {.units = &unit_system("reduced"), .file_units = "lj"});
  CHECK(bare.positions()[0][0] == 1.25);
}

TEST_CASE("extended XYZ that is wrong is refused with its line", "[structure][messages]") {
  CHECK(xyz_refusal("") == "m.xyz: the file is empty; XYZ begins with the number of atoms");
  CHECK(xyz_refusal("two\n") == "m.xyz:1: the number of atoms is 'two'; a whole number is expected, 1 to 1000000000");
  CHECK(xyz_refusal("3\n\nO 0 0 0\nO 1 0 0\n") == "m.xyz:1: 3 atoms are declared, but the file ends after 2 of them");
  CHECK(xyz_refusal("1\n\nO 0 0\n") ==
        "m.xyz:3: this atom has 3 columns; expected 4, as there are a species and x, y, z");
  CHECK(xyz_refusal("1\n\nO 0 0 zero\n") == "m.xyz:3: pos is 'zero', which is not a number");
  CHECK(xyz_refusal("1\n\nO 0 0 0\n1\n\nO 0 0 1\n") ==
        "m.xyz:4: there is more text after the 1 atoms of the first frame, but a structure is one frame: give frame = "
        "0, or "
        "frame = -1 for the last");
  CHECK(
      xyz_refusal("1\nLattice=\"1 0 0 0 1 0 0.5 0 1\"\nO 0 0 0\n") ==
      "m.xyz:2: Lattice=\"1 0 0 0 1 0 0.5 0 1\" is not orthogonal along the axes; only orthogonal boxes are supported");
  CHECK(xyz_refusal("1\nLattice=\"1 0 0\"\nO 0 0 0\n") == "m.xyz:2: Lattice has 3 numbers; 9 are expected");
  CHECK(xyz_refusal("1\nLattice=\"1 0 0 0 0 0 0 0 1\"\nO 0 0 0\n") ==
        "m.xyz:2: an edge of the box is 0; a length above 0 is expected");
  CHECK(xyz_refusal("1\nLattice=\"1 0 0\nO 0 0 0\n") == "m.xyz:2: a double quote after 'Lattice=' is not closed");
  CHECK(xyz_refusal("1\n" + cubic + "pbc=\"T T F\"\nO 0 0 0\n") ==
        "m.xyz:2: pbc=\"T T F\" is periodic in 2 of 3 directions; all or none are expected");
  CHECK(xyz_refusal("1\n" + cubic + "pbc=yes\nO 0 0 0\n") ==
        "m.xyz:2: pbc=\"yes\" is not understood; \"T T T\" or \"F F F\" is expected");
  CHECK(xyz_refusal("1\npbc=\"T T T\"\nO 0 0 0\n") == "m.xyz:2: pbc is true, but there is no Lattice");
  CHECK(xyz_refusal("1\nProperties=species:S:1:pos:R\nO 0 0 0\n") ==
        "m.xyz:2: Properties=species:S:1:pos:R is not of the form name:type:columns:...");
  CHECK(xyz_refusal("1\nProperties=tag:I:1:pos:R:3\n8 0 0 0\n") ==
        "m.xyz:2: there is no property 'species' in Properties=tag:I:1:pos:R:3");
  CHECK(xyz_refusal("1\nProperties=Z:I:1:pos:R:3\n119 0 0 0\n") ==
        "m.xyz:3: the atomic number is '119'; a whole number is expected, 1 to 118");
  CHECK(xyz_refusal("1\nProperties=species:S:1:pos:R:2\nO 0 0\n") ==
        "m.xyz:2: property 'pos' has 2 columns; expected 3");
  CHECK(xyz_refusal("1\nProperties=species:S:1:pos:R:3:pos:R:3\nO 0 0 0 0 0 0\n") ==
        "m.xyz:2: property 'pos' appears twice");
  CHECK(xyz_refusal("1\n\nCW 0 0 0\n") ==
        "m.xyz:3: particles of type 'CW' have no mass; give it in [[particles.type]]: name = \"CW\", mass = ...");
  CHECK(xyz_refusal("1\n\nO 0 0 0\n", {.units = &unit_system("reduced")}) ==
        "an extended XYZ file in angstrom needs units = \"molecular\", not \"reduced\"; or give file_units = \"lj\"");
  CHECK(xyz_refusal("1\n\nO 0 0 0\n", {.atom_style = "full"}) ==
        "atom_style = \"full\" is for LAMMPS data files; leave it out");
}

TEST_CASE("velocities of XYZ are in the units that file_units says", "[structure]") {
  // What LAMMPS writes of two atoms at 100 K in units metal, as its dump style extxyz does.
  const std::string dump =
      "2\nTimestep=0 Time=0.000000 pbc=\"T T T\" Lattice=\"20 0 0 0 20 0 0 0 20\" Temperature=99.99999999999997 "
      "Properties=species:S:1:pos:R:3:vel:R:3:forces:R:3\n"
      "Ar 1 1 1 -0.696798 -0.0146085 1.62365 0.000872083 0 0\n"
      "Ar 17.2 1 1 0.696798 0.0146085 -1.62365 -0.000872083 0 0\n";
  CHECK(xyz_refusal(dump) ==
        "m.xyz:2: Temperature=99.99999999999997, but the velocities make 1e+08; give file_units = "
        "\"metal\"");
  std::vector<std::string> notes;
  const auto s = read_as("m.xyz", dump, {.file_units = "metal", .notes = &notes});
  CHECK(notes.empty());  // forces are what a run computes anew
  CHECK(s.velocities()[0] == Vec3<double>(-0.696798, -0.0146085, 1.62365) * 0.1);
  // 3 k_B T / 2 of three degrees of freedom, which LAMMPS takes where the momentum is none.
  double kinetic = 0;
  for (const Index i : {0, 1}) kinetic += s.masses()[i] * Vec3<double>(s.velocities()[i]).squaredNorm() / 2;
  CHECK(std::abs(kinetic / (1.5 * 8.31446261815324e-3 * 100) - 1) < 2e-6);
  CHECK(xyz_refusal(dump, {.file_units = "real"}).find("give file_units = \"metal\"") != std::string::npos);
  const auto without = [&](std::string what, const std::string& with = "") {
    return std::string(dump).replace(dump.find(what), what.size(), with);
  };
  CHECK(xyz_refusal(without(" Temperature=99.99999999999997")) ==
        "m.xyz:2: velocities that LAMMPS writes are in the units of its run, but the file does not say which they are; "
        "give file_units = \"real\" (angstrom/fs) or \"metal\" (angstrom/ps)");
  CHECK(xyz_refusal(without(":vel:", ":velocities:")) ==
        "m.xyz:2: 'velocities' may be in any units; give file_units = \"real\" (angstrom/fs) or \"metal\" "
        "(angstrom/ps)");
  CHECK(read_as("m.xyz", without(":vel:", ":velocities:"), {.file_units = "metal"}).velocities()[0] ==
        s.velocities()[0]);
  // A degree of freedom more or less, or molecules that are rigid, are no other units.
  CHECK(read_as("m.xyz", without("99.99999999999997", "55"), {.file_units = "metal"}).size() == 2);
  CHECK(xyz_refusal(without("99.99999999999997", "20000"), {.file_units = "metal"}) ==
        "m.xyz:2: Temperature=20000, but the velocities make 100; give the file_units of the program that wrote the "
        "file");
  const std::string momenta =
      "2\nTemperature=3 Properties=species:S:1:pos:R:3:momenta:R:3\nAr 0 0 0 1 0 0\n"
      "Ar 4 0 0 -1 0 0\n";
  CHECK(xyz_refusal(momenta, {.file_units = "metal"}) ==
        "m.xyz:2: momenta are in sqrt(eV u), as ASE writes them, whatever file_units = \"metal\" says; take file_units "
        "out");
  CHECK(xyz_refusal(momenta) ==
        "m.xyz:2: Temperature=3, but the momenta make 193.7; momenta are expected in sqrt(eV u), "
        "as ASE writes them");
}

TEST_CASE("columns of XYZ that nobody reads are named, and velocities that are hardly meant so", "[structure]") {
  std::vector<std::string> notes;
  const std::string fast = "2\nProperties=species:S:1:pos:R:3:vel:R:3\nAr 0 0 0 0.7 0 1.6\nAr 9 0 0 -0.7 0 -1.6\n";
  read_as("m.xyz", fast, {.file_units = "metal", .notes = &notes});
  CHECK(notes.empty());
  read_as("m.xyz", fast, {.notes = &notes});
  REQUIRE(notes.size() == 1);
  // 2 m v^2 / (3 k_B) with m = 39.948 u and v = sqrt(3.05) angstrom/fs
  CHECK(notes[0] ==
        "the structure's velocities, taken as angstrom/fs, give a temperature of 9.77e+07 K; give file_units if they "
        "are in other units");
  notes.clear();
  read_as("m.xyz", "1\nProperties=species:S:1:pos:R:3:magmom:R:3:forces:R:3:move_mask:L:1\nO 0 0 0 1 2 3 4 5 6 T\n",
          {.notes = &notes});
  CHECK(notes == std::vector<std::string>{"the columns 'magmom' of the structure are ignored",
                                          "the columns 'move_mask' of the structure are ignored"});
}

TEST_CASE("a comment of XYZ is read however it is written", "[structure]") {
  const auto edges = [](const std::string& comment) {
    return read_as("m.xyz", "1\n" + comment + "\nO 1 2 3\n").box().edges();
  };
  const Vec3<double> box(2, 3, 4);
  CHECK(edges("Lattice = \"20 0 0 0 30 0 0 0 40\"") == box);
  CHECK(edges("Lattice='20 0 0 0 30 0 0 0 40'  pbc = T") == box);
  CHECK(edges("  Lattice={20 0 0 0 30 0 0 0 40} pbc=[T, T, T] note=\"a \\\"b\\\" = c\"") == box);
  CHECK(edges("energy= -1.5 Lattice=[[20, 0, 0], [0, 30, 0], [0, 0, 40]], pbc=TTT") == box);
  CHECK(edges("LATTICE=\"20,0,0,0,30,0,0,0,40\" PBC=\"true true true\"") == box);
  CHECK(edges("pbc='F F F' Lattice='20 0 0 0 30 0 0 0 40'") == Vec3<double>(0, 0, 0));
  CHECK(edges(" i = 0, time = 0.000, E = -17.1643447508") == Vec3<double>(0, 0, 0));
  CHECK(edges("no mark of a key at all, Lattice 1 2 3") == Vec3<double>(0, 0, 0));
  const auto refused = [](const std::string& comment) { return xyz_refusal("1\n" + comment + "\nO 1 2 3\n"); };
  CHECK(refused("Lattice \"20 0 0 0 30 0 0 0 40\" pbc=T") ==
        "m.xyz:2: 'Lattice' is not understood: a comment with '=' is read as key=value; put quotes around values with "
        "spaces, or take the '=' out of a comment that is only a text");
  CHECK(refused("a = 5.26 angstrom").starts_with("m.xyz:2: 'angstrom' is not understood"));
  CHECK(refused("energy= pbc=T") ==
        "m.xyz:2: after 'energy=' comes 'pbc=T'; a value is expected, in quotes if it has spaces or '='");
  CHECK(refused("pbc=") ==
        "m.xyz:2: after 'pbc=' comes nothing; a value is expected, in quotes if it has spaces or '='");
  CHECK(refused("Lattice='1 0 0 0 1 0 0 0 1'pbc=F") ==
        "m.xyz:2: after the value of 'Lattice=' comes 'pbc=F'; a space is expected");
  CHECK(refused("Lattice={1 0 0 0 1 0 0 0 1") == "m.xyz:2: a brace after 'Lattice=' is not closed");
  CHECK(refused("step=1 step=2") == "m.xyz:2: 'step' appears twice in the comment");
  CHECK(refused("Latice=\"20 0 0 0 30 0 0 0 40\"") ==
        "m.xyz:2: 'Latice=' is not supported; the box is given as Lattice=\"ax 0 0 0 by 0 0 0 cz\"");
  CHECK(refused("cell=\"20 30 40\"").starts_with("m.xyz:2: 'cell=' is not supported; the box is given as Lattice="));
  CHECK(refused("# CELL(abcABC): 35.2 35.2 35.2 90.0 90.0 90.0 Traj: positions{atomic_unit} Step: 0")
            .starts_with("m.xyz:2: the cell of i-PI in this comment is not supported; give Lattice="));
  CHECK(refused("units=bohr") == "m.xyz:2: the file is in units bohr; only lj, real and metal are supported");
  CHECK(read_as("m.xyz", "1\nunits=reduced\nO 1 2 3\n", {.units = &unit_system("reduced")}).positions()[0][2] == 3);
}

TEST_CASE("what rounding leaves of an angle of 90 degrees is none", "[structure]") {
  // The lattice of a cubic cell whose vectors were turned: 4 x 4 x 4 cells of argon, fcc, 5.26 angstrom.
  std::string content =
      "256\nLattice=\"21.04 0.0 1.2883284327030156e-15 3.3834900549196428e-15 21.04 1.2883284327030156e-15 0.0 0.0 "
      "21.04\" pbc=\"T T T\"\n";
  for (int cell = 0; cell < 64; ++cell) {
    for (const Vec3<double>& site : {Vec3<double>(0, 0, 0), Vec3<double>(0, 2.63, 2.63), Vec3<double>(2.63, 0, 2.63),
                                     Vec3<double>(2.63, 2.63, 0)}) {
      const Vec3<double> x = site + 5.26 * Vec3<double>(cell % 4, cell / 4 % 4, cell / 16);
      content += fmt::format("Ar {:.8f} {:.8f} {:.8f}\n", x[0], x[1], x[2]);
    }
  }
  const auto s = read_as("m.xyz", content);
  CHECK(s.box() == Box::periodic(Vec3<double>(21.04, 21.04, 21.04) * 0.1));
  // Lennard-Jones below 0.9 nm, summed here: kJ/mol.
  double energy = 0;
  for (Index i = 0; i < s.size(); ++i) {
    for (Index j = i + 1; j < s.size(); ++j) {
      const double r2 = s.box().minimum_image(Vec3<double>(s.positions()[i] - s.positions()[j])).squaredNorm();
      const double six = std::pow(0.34 * 0.34 / r2, 3);
      if (r2 < 0.81) energy += 4 * 0.996 * (six * six - six);
    }
  }
  CHECK(std::abs(energy + 2065.0061130040617) < 1e-9);
  CHECK(xyz_refusal("1\nLattice=\"20 0 0 1e-8 30 0 0 0 40\"\nO 0 0 0\n").find("is not orthogonal along the axes") !=
        std::string::npos);
  CHECK(read_as("m.gro", water + "2.0 2.0 2.0 0 0 1e-12 0 -1e-12 0\n", water_masses).box() == Box::periodic({2, 2, 2}));
}

TEST_CASE("one frame of several is taken by its number", "[structure]") {
  const std::string frames =
      "1\nstep=0\nO 1 0 0\n2\nstep=1 Lattice='9 0 0 0 9 0 0 0 9'\nO 2 0 0\nH 3 0 0\n\n1\nstep=2\nN 4 0 0\n\n";
  CHECK(read_as("m.xyz", frames, {.frame = 0}).positions()[0][0] == 1 * 0.1);
  CHECK(read_as("m.xyz", frames, {.frame = 1}).size() == 2);
  CHECK(read_as("m.xyz", frames, {.frame = 1}).box().is_periodic());
  CHECK(read_as("m.xyz", frames, {.frame = -1}).masses()[0] == 14.007);
  CHECK(xyz_refusal(frames, {.frame = 3}) == "frame = 3, but the file has 3 frames: 0 to 2, or -1 for the last");
  CHECK(xyz_refusal(frames, {.frame = -4}) == "frame = -4, but the file has 3 frames: 0 to 2, or -1 for the last");
  CHECK(xyz_refusal(frames + "5\n", {.frame = 0}) ==
        "m.xyz:13: 5 atoms are declared, but the file ends after 0 of them");
  CHECK(xyz_refusal("1\nstep=1\nO 0 0 0\n1\nstep 1 =\nO 0 0\n", {.frame = 1}).starts_with("m.xyz:5: 'step' is not"));
  const std::string two = water + water_box + "\n    1\n    1SOL     OW    1   0.500   1.624   1.679\n   3.0 3.0 3.0\n";
  CHECK(read_as("m.gro", two, {.types = water_masses.types, .frame = 0}).size() == 4);
  const io::StructureOptions oxygen = {.types = {{.type = "OW", .mass = 16}}, .frame = -1};
  CHECK(read_as("m.gro", two, oxygen).positions()[0][0] == 0.5);
  CHECK(read_as("m.gro", two, oxygen).box() == Box::periodic({3, 3, 3}));
  CHECK(gro_refusal(two, {.frame = 2}) == "frame = 2, but the file has 2 frames: 0 to 1, or -1 for the last");
}

TEST_CASE("a .gro file gives particles, residues and a box", "[structure]") {
  const auto s = read_as("m.gro", water + water_box, water_masses);
  CHECK(s.size() == 4);
  CHECK(s.name(1) == "HW1_2");
  CHECK(s.box() == Box::periodic({1.8206, 1.8206, 1.8206}));
  CHECK(std::abs(s.positions()[0][1] - 1.624) <= 0x1p-52);
  CHECK(std::abs(s.unwrapped(2)[1] + 1.568) <= 0x1p-52);
  CHECK(s.images()[2][1] == -1);
  CHECK(s.velocities()[1] == Vec3<double>(0.8085, 0.3191, -0.7791));
  CHECK(s.masses()[3] == 15.9994);
  CHECK(s.column<Charge>()[3] == -0.8476);
  CHECK(s.column<Charge>()[1] == 0);
  CHECK(s.topology()->molecules == std::vector<std::int64_t>{1, 1, 1, 2});
  const auto precise =
      read_as("m.gro",
              "high precision, no velocities\n1\n    1LJ      Ar    1   1.234567  -1.000001   0.000001\n"
              "0 0 0\n",
              {.types = {{.type = "Ar", .mass = 39.948}}});
  CHECK(precise.positions()[0] == Vec3<double>(1.234567, -1.000001, 0.000001));
  CHECK_FALSE(precise.box().is_periodic());
}

TEST_CASE("a .gro file that is wrong is refused with its line", "[structure][messages]") {
  CHECK(gro_refusal("") ==
        "m.gro: the file has no second line; a .gro file begins with a title, then the number of atoms");
  CHECK(gro_refusal(water) == "m.gro:2: 4 atoms are declared, but the file ends after 6 lines; expected 7");
  CHECK(gro_refusal(water + water_box) ==
        "m.gro:3: particles of type 'OW' have no mass; give it in [[particles.type]]: name = \"OW\", mass = ...");
  CHECK(gro_refusal(water + "   1.82060   1.82060\n", water_masses) ==
        "m.gro:7: the box has 2 numbers; 3 are expected, or 9");
  CHECK(gro_refusal(water + "1 1 1 0 0 0.5 0 0 0\n", water_masses) ==
        "m.gro:7: the box is triclinic, with the 9 numbers 1 1 1 0 0 0.5 0 0 0; only orthogonal boxes are supported");
  CHECK(gro_refusal(water + water_box + water, water_masses) ==
        "m.gro:8: there is more text after the 4 atoms of the first frame, but a structure is one frame: give frame = "
        "0, or "
        "frame = -1 for the last");
  const std::string atom = "\n1\n    1SOL     OW    1   0.126   1.624";
  CHECK(gro_refusal(atom + "   1.6\n0 0 0\n") ==
        "m.gro:3: this atom ends at column 42; expected 44, as its numbers have 8 columns each");
  CHECK(gro_refusal(atom + "   1x679\n0 0 0\n") == "m.gro:3: z is '1x679', which is not a number");
  CHECK(gro_refusal("\n1\n    1SOL     OW    1\n0 0 0\n") ==
        "m.gro:3: there are not two numbers with decimal points after column 20, where positions are expected");
  CHECK(gro_refusal(atom + "   1.679\n0 0 0\n", {.units = &unit_system("reduced")}) ==
        "a .gro file in nm and ps needs units = \"molecular\", not \"reduced\"");
}

TEST_CASE("numbers of a .gro box that have grown together are read", "[structure]") {
  const auto edges = [](const std::string& box) {
    return read_as("m.gro", water + box + "\n", water_masses).box().edges();
  };
  CHECK(edges("1234.500001234.600001234.70000") == Vec3<double>(1234.5, 1234.6, 1234.7));
  CHECK(edges("  10.000001234.50000   3.00000") == Vec3<double>(10, 1234.5, 3));
  CHECK(edges("1000.000001000.000001000.00000-0.00000   0.00000-0.00000   0.00000   0.00000   0.00000") ==
        Vec3<double>(1000, 1000, 1000));
  CHECK(gro_refusal(water + "1234.500001234.60000\n", water_masses) ==
        "m.gro:7: the box has 2 numbers; 3 are expected, or 9");
}

TEST_CASE("a wrong number of atoms in a .gro file, and velocities that are missing, are said as such",
          "[structure][messages]") {
  const auto counted = [](int atoms) {
    return "title\n" + std::to_string(atoms) + water.substr(water.find("\n    1SOL"));
  };
  CHECK(gro_refusal(counted(3) + water_box, water_masses) ==
        "m.gro:6: line 2 says 3 atoms, but the file has 4; check the number");
  CHECK(gro_refusal(counted(2) + water_box, water_masses) ==
        "m.gro:5: line 2 says 2 atoms, but the file has 4; check the number");
  CHECK(gro_refusal(counted(5) + water_box + "\n", water_masses) ==
        "m.gro:7: line 2 says 5 atoms, but the box follows after 4; check the number");
  const std::string still = "    1SOL    HW1    2   0.190   1.661   1.747\n",
                    moved = "    1SOL     OW    1   0.126   1.624   1.679  0.1227 -0.0580  0.0434\n";
  CHECK(gro_refusal("title\n2\n" + moved + still + water_box) ==
        "m.gro:4: this atom has no velocity, but the first one has one; give velocities for all atoms or for none");
  CHECK(gro_refusal("title\n2\n" + still + moved + water_box) ==
        "m.gro:4: this atom has a velocity, but the first one has none; give velocities for all atoms or for none");
}

TEST_CASE("a structure that is not there is an error of files", "[structure]") {
  try {
    io::read_structure("/there/is/none.gro");
    FAIL("it was read");
  } catch (const Error& error) {
    CHECK(error.exit_code() == 3);
  }
}
