// Extended XYZ and .gro: what is read, and what is refused, in which words.

#include "engine/charge.hpp"
#include "io/structure.hpp"
#include "tests/io/support.hpp"

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
  CHECK(xyz_refusal("3\n\nO 0 0 0\nO 1 0 0\n") == "m.xyz:1: 3 atoms are announced, but the file ends after 2 of them");
  CHECK(xyz_refusal("1\n\nO 0 0\n") == "m.xyz:3: this atom has 3 columns; expected 4, as Properties say");
  CHECK(xyz_refusal("1\n\nO 0 0 zero\n") == "m.xyz:3: pos is 'zero', which is no number");
  CHECK(xyz_refusal("1\n\nO 0 0 0\n1\n\nO 0 0 1\n") ==
        "m.xyz:4: there is more behind the 1 atoms of the first frame; a structure is one frame");
  CHECK(xyz_refusal("1\nLattice=\"1 0 0 0 1 0 0.5 0 1\"\nO 0 0 0\n") ==
        "m.xyz:2: Lattice=\"1 0 0 0 1 0 0.5 0 1\" is not orthogonal along the axes; boxes are");
  CHECK(xyz_refusal("1\nLattice=\"1 0 0\"\nO 0 0 0\n") == "m.xyz:2: Lattice has 3 numbers; 9 are expected");
  CHECK(xyz_refusal("1\nLattice=\"1 0 0 0 0 0 0 0 1\"\nO 0 0 0\n") ==
        "m.xyz:2: an edge of the box is 0; a length above 0 is expected");
  CHECK(xyz_refusal("1\nLattice=\"1 0 0\nO 0 0 0\n") == "m.xyz:2: a double quote behind 'Lattice=' is not closed");
  CHECK(xyz_refusal("1\n" + cubic + "pbc=\"T T F\"\nO 0 0 0\n") ==
        "m.xyz:2: pbc=\"T T F\" is periodic in 2 of 3 directions; all or none are expected");
  CHECK(xyz_refusal("1\n" + cubic + "pbc=yes\nO 0 0 0\n") ==
        "m.xyz:2: pbc=\"yes\" is not understood; \"T T T\" or \"F F F\" is expected");
  CHECK(xyz_refusal("1\npbc=\"T T T\"\nO 0 0 0\n") == "m.xyz:2: pbc is true, but there is no Lattice");
  CHECK(xyz_refusal("1\nProperties=species:S:1:pos:R\nO 0 0 0\n") ==
        "m.xyz:2: Properties=species:S:1:pos:R is not of the form name:type:columns:...");
  CHECK(xyz_refusal("1\nProperties=Z:I:1:pos:R:3\n8 0 0 0\n") ==
        "m.xyz:2: there is no property 'species' in Properties=Z:I:1:pos:R:3");
  CHECK(xyz_refusal("1\nProperties=species:S:1:pos:R:2\nO 0 0\n") ==
        "m.xyz:2: property 'pos' has 2 columns; expected 3");
  CHECK(xyz_refusal("1\nProperties=species:S:1:pos:R:3:pos:R:3\nO 0 0 0 0 0 0\n") ==
        "m.xyz:2: property 'pos' stands twice");
  CHECK(xyz_refusal("1\n\nCW 0 0 0\n") ==
        "m.xyz: particles of type 'CW' have no mass; give it in [[particles.type]]: name = \"CW\", mass = ...");
  CHECK(xyz_refusal("1\n\nO 0 0 0\n", {.units = &unit_system("reduced")}) ==
        "an extended XYZ file in angstrom needs units = \"molecular\", not \"reduced\"; or give file_units = \"lj\"");
  CHECK(xyz_refusal("1\n\nO 0 0 0\n", {.file_units = "real"}) ==
        "file_units = \"real\" is not for an extended XYZ file, which has units of its own; leave it out");
  CHECK(xyz_refusal("1\n\nO 0 0 0\n", {.atom_style = "full"}) ==
        "atom_style = \"full\" is for LAMMPS data files; leave it out");
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
  CHECK(gro_refusal("") == "m.gro: the file has no second line; .gro has a title, then the number of atoms");
  CHECK(gro_refusal(water) == "m.gro:2: 4 atoms are announced, but the file ends after 6 lines; expected 7");
  CHECK(gro_refusal(water + water_box) ==
        "m.gro: particles of type 'OW' have no mass; give it in [[particles.type]]: name = \"OW\", mass = ...");
  CHECK(gro_refusal(water + "   1.82060   1.82060\n", water_masses) ==
        "m.gro:7: the box has 2 numbers; 3 are expected, or 9");
  CHECK(gro_refusal(water + "1 1 1 0 0 0.5 0 0 0\n", water_masses) ==
        "m.gro:7: the box is triclinic: its 9 numbers are 1 1 1 0 0 0.5 0 0 0; boxes are orthogonal");
  CHECK(gro_refusal(water + water_box + water, water_masses) ==
        "m.gro:8: there is more behind the 4 atoms of the first frame; a structure is one frame");
  const std::string atom = "\n1\n    1SOL     OW    1   0.126   1.624";
  CHECK(gro_refusal(atom + "   1.6\n0 0 0\n") ==
        "m.gro:3: this atom ends at column 42; expected 44, as its numbers have 8 columns each");
  CHECK(gro_refusal(atom + "   1x679\n0 0 0\n") == "m.gro:3: z is '1x679', which is no number");
  CHECK(gro_refusal("\n1\n    1SOL     OW    1\n0 0 0\n") ==
        "m.gro:3: there are no two numbers with decimal points behind column 20, where positions stand");
  CHECK(gro_refusal(atom + "   1.679\n0 0 0\n", {.units = &unit_system("reduced")}) ==
        "a .gro file in nm and ps needs units = \"molecular\", not \"reduced\"");
}

TEST_CASE("a structure that is not there is an error of files", "[structure]") {
  try {
    io::read_structure("/there/is/none.gro");
    FAIL("it was read");
  } catch (const Error& error) {
    CHECK(error.exit_code() == 3);
  }
}
