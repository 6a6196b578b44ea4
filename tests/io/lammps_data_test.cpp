// LAMMPS data files: what is read, and what is refused, in which words.

#include "engine/charge.hpp"
#include "io/structure.hpp"
#include "tests/io/support.hpp"

#include <cmath>
#include <numbers>

using namespace noether;
using test::error_of;

namespace {

const UnitSystem& reduced = unit_system("reduced");

ParticleSystem<double> read_data(const std::string& content, io::StructureOptions options = {.units = &reduced}) {
  const test::ScratchFolder folder;
  test::write_text(folder / "m.data", content);
  return io::read_structure(folder / "m.data", options);
}

std::string data_refusal(const std::string& content, const io::StructureOptions& options = {.units = &reduced}) {
  const std::string message = error_of([&] { read_data(content, options); });
  const std::size_t name = message.find("m.data");
  return name == std::string::npos ? message : message.substr(name);
}

const std::string box = "-1 4 xlo xhi\n0.5 6.5 ylo yhi\n0 7 zlo zhi\n";  // 5 x 6 x 7
const std::string masses = "\nMasses\n\n1 2.0 # one\n2 3.0\n";
const std::string two_atoms = "a comment\n\n2 atoms\n2 atom types\n" + box + masses;
const std::string pair_atoms = "\nAtoms # atomic\n\n1 1 0 1 0\n2 2 1 1 0\n";

/// Two atoms and one term of two, three or four of four atoms.
std::string with_coefficients(const std::string& header, const std::string& sections) {
  return "#\n4 atoms\n1 atom types\n" + header + box + "\nMasses\n\n1 1\n\nAtoms # molecular\n\n" +
         "1 1 1 0 1 0\n2 1 1 1 1 0\n3 1 1 1 2 0\n4 1 1 1 2 1\n\n" + sections;
}

}  // namespace

TEST_CASE("atoms stand in the order of their ids, with the corner of the box in the origin", "[structure]") {
  const auto s =
      read_data("first line\r\n\r\n 3 atoms\r\n2 atom types # two\r\n5 extra bond per atom\r\n" + box + masses +
                "\nAtoms # full\n\n"
                "30 7 2 -0.5 0.0 1.5 3.0 1 0 -2\n"
                "4 7 1 0.25 -1.5 6.0 7.5 0 0 0  # outside on two sides\n"
                "12 9 1 0.25 3.5 0.5 0.0 -1 0 0\n"
                "\nVelocities\n\n12 1 2 3\n30 4 5 6\n4 7 8 9\n");
  CHECK(s.ids() == std::vector<std::int64_t>{4, 12, 30});
  CHECK(s.name(2) == "atom_30");
  CHECK(s.box() == Box::periodic({5, 6, 7}));
  CHECK(s.positions()[0] == Vec3<double>(4.5, 5.5, 0.5));
  CHECK(s.unwrapped(0) == Vec3<double>(-0.5, 5.5, 7.5));
  CHECK(s.unwrapped(1) == Vec3<double>(-0.5, 0, 0));
  CHECK(s.unwrapped(2) == Vec3<double>(6, 1, -11));
  CHECK(s.velocities()[0] == Vec3<double>(7, 8, 9));
  CHECK(s.velocities()[1] == Vec3<double>(1, 2, 3));
  CHECK(s.masses()[0] == 2);
  CHECK(s.masses()[2] == 3);
  CHECK(s.column<Charge>()[2] == -0.5);
  CHECK(s.topology()->types == std::vector<std::int64_t>{0, 0, 1});
  CHECK(s.topology()->molecules == std::vector<std::int64_t>{7, 9, 7});
  CHECK(s.topology()->type_names == std::vector<std::string>{"1", "2"});
  CHECK(s.next_id() == 31);
}

TEST_CASE("units real and metal become molecular ones", "[structure]") {
  const std::string content =
      "#\n1 atoms\n1 atom types\n0 50 xlo xhi\n0 50 ylo yhi\n0 50 zlo zhi\n\nMasses\n\n1 12\n"
      "\nPair Coeffs # lj/cut\n\n1 1 3\n\nAtoms # atomic\n\n1 1 20 30 40\n\nVelocities\n\n1 1 0 0\n";
  const auto real = read_data(content, {.file_units = "real"}), metal = read_data(content, {.file_units = "metal"});
  CHECK(real.box().edges()[0] == 5);
  CHECK(real.positions()[0] == Vec3<double>(2, 3, 4));
  CHECK(real.velocities()[0][0] == 100);
  CHECK(metal.velocities()[0][0] == 0.1);
  CHECK(real.masses()[0] == 12);
  CHECK(real.topology()->pair_kinds[0].epsilon == 4.184);
  CHECK(metal.topology()->pair_kinds[0].epsilon == 96.48533212331002);
  CHECK(real.topology()->pair_kinds[0].sigma == 3 * 0.1);
}

TEST_CASE("the style of atoms is deduced from the columns where only one fits", "[structure]") {
  const auto atoms = [](const std::string& rows) { return two_atoms + "\nAtoms\n\n" + rows; };
  CHECK(read_data(atoms("1 1 0 1 0\n2 2 1 1 0\n")).topology()->molecules.empty());
  CHECK(read_data(atoms("1 1 0 1 0 0 0 0\n2 2 1 1 0 0 0 1\n")).images()[1] == Vec3<std::int32_t>(0, 0, 1));
  CHECK(read_data(atoms("1 5 1 1 0 1 0\n2 6 2 -1 1 1 0\n")).column<Charge>()[1] == -1);
  CHECK(read_data(atoms("1 1 -1 0 1 0\n2 2 0.5 1 1 0\n")).column<Charge>()[1] == 0.5);
  CHECK(read_data(atoms("1 5 1 0 1 0\n2 5 2 1 1 0\n"), {.units = &reduced, .atom_style = "molecular"})
            .topology()
            ->molecules[1] == 5);
  CHECK(data_refusal(atoms("1 1 1 0 1 0\n2 1 2 1 1 0\n")) ==
        "m.data:14: rows of 6 words could be of several styles; write 'Atoms # molecular', or give atom_style = "
        "\"molecular\" or another one");
  CHECK(data_refusal(atoms("1 1 0\n2 1 2\n")).find("rows of 3 words could be of several styles") != std::string::npos);
}

TEST_CASE("coefficients of LAMMPS become parameters of noether's kinds", "[structure]") {
  const auto dihedral = [](const std::string& style, const std::string& numbers) {
    return read_data(
               with_coefficients("1 dihedrals\n1 dihedral types\n",
                                 "Dihedral Coeffs # " + style + "\n\n1 " + numbers + "\n\nDihedrals\n\n1 1 1 2 3 4\n"))
        .topology()
        ->dihedral_kinds.at(0);
  };
  using std::numbers::pi;
  CHECK(dihedral("charmm", "2.5 3 180 0.0") == TermKind{"periodic", {2.5, 3, 180 * (pi / 180)}});
  CHECK(dihedral("harmonic", "2.5 1 2") == TermKind{"periodic", {2.5, 2, 0}});
  CHECK(dihedral("harmonic", "2.5 -1 2") == TermKind{"periodic", {2.5, 2, pi}});
  CHECK(dihedral("multi/harmonic", "1 2 3 4 5") == TermKind{"ryckaert_bellemans", {1, -2, 3, -4, 5, -0.0}});
  CHECK(dihedral("opls", "2 0 0 0") == TermKind{"ryckaert_bellemans", {1, -1, 0, 0, 0, 0}});
  const auto bonds =
      read_data(with_coefficients("3 bonds\n3 bond types\n",
                                  "Bond Coeffs # hybrid\n\n2 morse 1 2 3\n1 harmonic 5 1.5\n3 fene 30 1.5 "
                                  "1 1\n\nBonds\n\n1 3 1 2\n2 1 2 3\n3 2 3 4\n"));
  const Topology& t = *bonds.topology();
  CHECK(t.bond_kinds ==
        std::vector<TermKind>{{"harmonic", {10, 1.5}}, {"morse", {1, 2, 3}}, {"fene", {30, 1.5, 1, 1}}});
  CHECK(t.bonds == std::vector<BondedTerm<2>>{{{0, 1}, 2}, {{1, 2}, 0}, {{2, 3}, 1}});
  CHECK(t.exclusions.size() == 6);
}

TEST_CASE("pairs are mixed as LAMMPS does, unless they are given", "[structure]") {
  const std::string coefficients = "\nPair Coeffs # lj/cut\n\n2 4 9\n1 1 4\n";
  const auto s = read_data(two_atoms + pair_atoms + coefficients);
  CHECK(s.topology()->pair_kind(0, 1) == PairKind{2, 6});
  const auto other =
      read_data(two_atoms + pair_atoms + coefficients, {.units = &reduced, .mixing = Mixing::lorentz_berthelot});
  CHECK(other.topology()->pair_kind(0, 1) == PairKind{2, 6.5});
  const auto given =
      read_data(two_atoms + pair_atoms + "\nPairIJ Coeffs # lj/cut\n\n1 1 1 1 2.5\n1 2 3 2 2.5\n2 2 5 3 2.5\n");
  CHECK(given.topology()->pair_kind(1, 0) == PairKind{3, 2});
  CHECK(given.topology()->pair_kind(1, 1) == PairKind{5, 3});
  CHECK(data_refusal(two_atoms + pair_atoms + "\nPair Coeffs\n\n1 1 1 2.5\n2 1 1 3\n") ==
        "m.data:22: the cutoffs of pairs differ: 3 here, 2.5 at line 21; a force has one cutoff; give it in the scene, "
        "and take these out");
}

TEST_CASE("parameters of types add to those of the file, or replace them", "[structure]") {
  const auto s =
      read_data(two_atoms + pair_atoms, {.units = &reduced,
                                         .types = {{.type = "2", .mass = 5, .charge = -1, .epsilon = 1, .sigma = 3},
                                                   {.type = "1", .epsilon = 4, .sigma = 1}},
                                         .pairs = {{"2", "1", 7, 8}}});
  CHECK(s.masses()[1] == 5);
  CHECK(s.column<Charge>()[0] == 0);
  CHECK(s.column<Charge>()[1] == -1);
  CHECK(s.topology()->pair_kind(1, 1) == PairKind{1, 3});
  CHECK(s.topology()->pair_kind(0, 1) == PairKind{7, 8});
  const auto refusal = [](const io::StructureOptions& options) {
    return data_refusal(two_atoms + pair_atoms, options);
  };
  CHECK(refusal({.units = &reduced, .types = {{.type = "3"}}}) == "there is no type '3'; expected one of: 1, 2");
  CHECK(refusal({.units = &reduced, .types = {{.type = "1", .mass = -1}}}) ==
        "the mass of type '1' is -1; 0 or more is expected");
  CHECK(refusal({.units = &reduced, .types = {{.type = "1", .epsilon = 1}}}) ==
        "type '1' has epsilon but no sigma; give both or neither");
  CHECK(refusal({.units = &reduced, .types = {{.type = "1", .epsilon = 1, .sigma = 1}}}) ==
        "type '2' has no epsilon and sigma, but others do; give epsilon = 0 where there is no Lennard-Jones force");
  CHECK(refusal({.units = &reduced, .pairs = {{"1", "2", 1, -2}}}) == "sigma is -2; 0 or more is expected");
}

TEST_CASE("the box of a file can be taken away, and images are honored", "[structure]") {
  const auto s = read_data(two_atoms + "\nAtoms # atomic\n\n1 1 0 1 0 0 0 0\n2 2 1 1 0 1 0 0\n",
                           {.units = &reduced, .box = Box::open()});
  CHECK_FALSE(s.box().is_periodic());
  CHECK(s.positions()[1] == Vec3<double>(7, 0.5, 0));
  CHECK(data_refusal(two_atoms + pair_atoms, {.units = &reduced, .box = Box::periodic({1, 1, 1})}) ==
        "the file has its own box, 5 x 6 x 7; leave box out, or give box = \"open\" to remove it");
}

TEST_CASE("units that do not fit are refused", "[structure][messages]") {
  const std::string content = two_atoms + pair_atoms;
  CHECK(data_refusal(content, {}) ==
        "this LAMMPS data file does not say its units; give file_units = \"real\" or \"metal\"");
  CHECK(data_refusal(content, {.file_units = "lj"}) == "numbers in lj need units = \"reduced\", not \"molecular\"");
  CHECK(data_refusal(content, {.units = &reduced, .file_units = "real"}) ==
        "a LAMMPS data file in real needs units = \"molecular\", not \"reduced\"");
  CHECK(data_refusal(content, {.file_units = "metals"}) == "unknown file_units 'metals'; did you mean 'metal'?");
  CHECK(data_refusal(content, {.units = &unit_system("solar"), .file_units = "real"}) ==
        "a structure needs units = \"molecular\" or \"reduced\", not \"solar\"");
  CHECK(data_refusal(content, {.units = &reduced, .special = {{0, 0, 2}}}) ==
        "special contains 2; factors from 0 to 1 are expected");
  CHECK(error_of([] { io::read_structure("m.pdb"); }) ==
        "'m.pdb' has no supported format; a structure is a .data or .lmp file or data.NAME (LAMMPS), .xyz or .extxyz, "
        ".gro, or .msh (Gmsh)");
}

TEST_CASE("the units that LAMMPS writes into its first line are taken", "[structure]") {
  const auto said = [](const std::string& units) {
    return "LAMMPS data file via write_data, version 22 Jul 2025, timestep = 0, units = " + units +
           two_atoms.substr(9) + pair_atoms;
  };
  CHECK(read_data(said("metal"), {}).box().edges()[0] == 0.5);
  CHECK(read_data(said("lj")).box().edges()[0] == 5);
  CHECK(data_refusal(said("real")) == "a LAMMPS data file in real needs units = \"molecular\", not \"reduced\"");
  CHECK(data_refusal(said("real"), {.file_units = "metal"}) ==
        "m.data:1: the file says units = real, but file_units says 'metal'; take file_units out");
  CHECK(data_refusal(said("electron"), {}) ==
        "m.data:1: the file is in units electron; only lj, real and metal are supported");
}

TEST_CASE("a header that is wrong is refused with its line", "[structure][messages]") {
  CHECK(data_refusal("") == "m.data: the file is empty; a LAMMPS data file is expected");
  CHECK(data_refusal("comment\n") ==
        "m.data: there is no line 'N atoms'; a LAMMPS data file is expected: a comment, then the header");
  CHECK(data_refusal("#\n2 atoms\n") ==
        "m.data: there is no line 'xlo xhi'; the header gives the box by xlo xhi, ylo yhi and zlo zhi");
  CHECK(data_refusal("#\n2 atom\n" + box) ==
        "m.data:2: '2 atom' is not a supported line of the header; did you mean 'atoms'?");
  CHECK(data_refusal("#\n2.5 atoms\n" + box) ==
        "m.data:2: atoms is '2.5'; a whole number is expected, 0 to 1000000000");
  CHECK(data_refusal("#\n2 atoms\n3 atoms\n" + box) == "m.data:3: 'atoms' appears twice, also at line 2");
  CHECK(data_refusal("#\n2 atoms\n1 1 xlo xhi\n") == "m.data:3: xhi = 1 is not above xlo = 1");
  CHECK(data_refusal("#\n2 atoms\n" + box + "0 0 0 xy xz yz\n0.5 0 0 xy xz yz\n") ==
        "m.data:7: the box is triclinic, with tilt factors xy xz yz = 0.5 0 0; only orthogonal boxes are supported");
  CHECK(data_refusal("#\n0 atoms\n" + box) == "m.data: the file has 0 atoms; 1 or more are expected");
  CHECK(data_refusal("#\n2 atoms\n3 ellipsoids\n" + box)
            .starts_with("m.data:3: '3 ellipsoids' is not a supported line of the header"));
}

TEST_CASE("sections that are unknown, missing, cut or twice there are refused", "[structure][messages]") {
  CHECK(
      data_refusal(two_atoms + "\nAtom\n\n").starts_with("m.data:14: 'Atom' is not a supported section; did you mean"));
  CHECK(data_refusal(two_atoms) ==
        "m.data:3: 2 atoms are declared, but there is no section 'Atoms'; the file may be cut short");
  CHECK(data_refusal(two_atoms + "\nAtoms # atomic\n\n1 1 0 1 0\n") ==
        "m.data:14: section 'Atoms' has 1 row, but line 3 says 2 atoms");
  CHECK(data_refusal(two_atoms + pair_atoms + pair_atoms) ==
        "m.data:19: section 'Atoms' appears twice, also at line 14");
  CHECK(data_refusal(two_atoms + pair_atoms + "\nBonds\n\n1 1 1 2\n") ==
        "m.data:19: section 'Bonds' has 1 row, but the header has no line 'bonds'");
  CHECK(data_refusal("#\n2 atoms\n1 bonds\n2 atom types\n" + box + masses + pair_atoms) ==
        "m.data:3: 1 bonds are declared, but there is no section 'Bonds'; the file may be cut short");
  CHECK(data_refusal("#\n2 atoms\n2 atom types\n" + box + pair_atoms) ==
        "m.data: particles of type '1' have no mass; give it in [[particles.type]]: name = \"1\", mass = ...");
  CHECK(data_refusal(two_atoms + "\n\x01\xff\xfe garbage\n").starts_with("m.data:14: "));
  CHECK(data_refusal(std::string("#\0\n", 3)) ==
        "m.data: this is not a text file: byte 1 is zero; expected a LAMMPS data file");
}

TEST_CASE("rows that are wrong are refused with their line", "[structure][messages]") {
  const auto atoms = [](const std::string& row, const std::string& style = "atomic") {
    return data_refusal(two_atoms + "\nAtoms # " + style + "\n\n1 1 0 1 0\n" + row + "\n");
  };
  CHECK(atoms("1 2 0 0 0") == "m.data:17: atom 1 appears twice, also at line 16");
  CHECK(atoms("2 3 0 0 0") == "m.data:17: the type of an atom is '3'; a whole number is expected, 1 to 2");
  CHECK(atoms("2 1 0 0 zero") == "m.data:17: z is 'zero', which is not a number");
  CHECK(atoms("2 1 0 nan 0") == "m.data:17: y is nan; expected a finite number");
  CHECK(atoms("2 1 0 0") ==
        "m.data:17: this row of section 'Atoms' has 4 words; style 'atomic' has 5, or 8 with images, in every row");
  CHECK(atoms("0 1 0 0 0") == "m.data:17: the id of an atom is '0'; a whole number is expected, 1 to 9007199254740992");
  CHECK(
      atoms("2 1 0 0 0", "sphere") ==
      "m.data:14: atom style 'sphere' is not supported; expected one of: atomic, charge, bond, angle, molecular, full");
  CHECK(atoms("2 1 0 0 0", "hybrid atomic sphere")
            .starts_with("m.data:14: atom style 'hybrid' is not supported; expected one of: "));
  CHECK(data_refusal(two_atoms + "\nAtoms # atomic\n\n1 1 0 1 0 0 0 0\n2 1 0 1 0 0 0.5 0\n") ==
        "m.data:17: an image is '0.5'; a whole number is expected, -536870912 to 536870912");
  CHECK(data_refusal(two_atoms + pair_atoms + "\nVelocities\n\n1 0 0 0\n3 0 0 0\n") ==
        "m.data:22: a velocity is given for atom 3, which does not exist");
  CHECK(data_refusal(two_atoms + pair_atoms + "\nVelocities\n\n1 0 0 0\n1 0 0 0\n") ==
        "m.data:22: the velocity of atom 1 appears twice");
  CHECK(data_refusal(two_atoms + "\nAtoms # atomic\n\n1 1 0 1 0\n2 1 0 1e300 0\n") ==
        "m.data: 'atom_2' is more than 2^29 boxes away from the origin");
  CHECK(data_refusal("#\n2 atoms\n2 atom types\n" + box + "\nMasses\n\n1 1\n1 2\n" + pair_atoms) ==
        "m.data:11: the mass of type 1 appears twice");
  CHECK(data_refusal("#\n2 atoms\n2 atom types\n" + box + "\nMasses\n\n1 1\n2 -2\n" + pair_atoms) ==
        "m.data:11: the mass is -2; expected 0 or more");
}

TEST_CASE("terms that are wrong are refused with their line", "[structure][messages]") {
  const auto bond = [](const std::string& row, const std::string& coefficients = "") {
    return data_refusal(with_coefficients("1 bonds\n1 bond types\n", "Bonds\n\n" + row + "\n\n" + coefficients));
  };
  CHECK(bond("1 1 1 9") == "m.data:23: bond 1 joins atom 9, which does not exist");
  CHECK(bond("1 1 2 2") == "m.data:23: bond 1 joins an atom to itself");
  CHECK(bond("1 2 1 2") == "m.data:23: the type of this bond is '2'; a whole number is expected, 1 to 1");
  CHECK(bond("1 1 1") == "m.data:23: this row of section 'Bonds' has 3 words; expected 4");
  const std::string good = "1 1 1 2";
  CHECK(bond(good, "Bond Coeffs\n\n1 10 1\n") ==
        "m.data:27: the style of these coefficients is not given; write it after the name of the section, 'Bond "
        "Coeffs # "
        "STYLE'; expected one of: harmonic, morse, fene");
  CHECK(bond(good, "Bond Coeffs # class2\n\n1 1 1 1 1\n") ==
        "m.data:27: style 'class2' of section 'Bond Coeffs' is not supported; expected one of: harmonic, morse, fene");
  CHECK(bond(good, "Bond Coeffs # harmonic\n\n1 1\n") ==
        "m.data:27: style 'harmonic' of section 'Bond Coeffs' has 2 coefficients; this row has 1");
  CHECK(bond(good, "Bond Coeffs # harmonic\n\n1 1 one\n") ==
        "m.data:27: coefficient 2 of style 'harmonic' is 'one', which is not a number");
  const auto dihedral = [](const std::string& style, const std::string& numbers) {
    return data_refusal(
        with_coefficients("1 dihedrals\n1 dihedral types\n",
                          "Dihedral Coeffs # " + style + "\n\n1 " + numbers + "\n\nDihedrals\n\n1 1 1 2 3 4\n"));
  };
  CHECK(dihedral("charmm", "1 1 0 1.5") == "m.data:23: the weight of a charmm dihedral is 1.5; 0 to 1 is expected");
  CHECK(dihedral("charmm", "1 1 0 0.5") ==
        "m.data: the ends of dihedrals interact as pairs, but types have no epsilon and sigma for them; give both in "
        "section 'Pair Coeffs' or [[particles.type]]");
  CHECK(dihedral("fourier", "2 1 1 0") ==
        "m.data:23: the number of terms of style 'fourier' is '2'; a whole number is expected, 1 to 1");
  CHECK(dihedral("fourier", "2 1 1 0 1 1 0 5") ==
        "m.data:23: style 'fourier' of section 'Dihedral Coeffs' has 7 coefficients for 2 terms; this row has 8");
  CHECK(dihedral("harmonic", "1 0.5 1") == "m.data:23: coefficient 2 of style 'harmonic' is 0.5; 1 or -1 is expected");
  CHECK(dihedral("charmm", "1 1.5 0 0") ==
        "m.data:23: coefficient 2 of style 'charmm' is 1.5; a whole number is expected, 0 to 100");
  CHECK(data_refusal(two_atoms + pair_atoms + "\nPair Coeffs # buck\n\n1 1 1 1\n2 1 1 1\n")
            .starts_with("m.data:21: pair style 'buck' is not supported; expected one of: lj/cut"));
}

TEST_CASE("four numbers of a pair need a style that has them", "[structure][messages]") {
  CHECK(data_refusal(two_atoms + pair_atoms + "\nPair Coeffs\n\n1 1 1 1 1\n2 1 1 1 1\n") ==
        "m.data:21: this pair has 4 coefficients; epsilon and sigma are expected, and optionally a cutoff, or the "
        "style after the name of the section: 'Pair Coeffs # lj/charmm/coul/long'");
}

TEST_CASE("no other potential is proposed in the place of one that is not read", "[structure][messages]") {
  CHECK(data_refusal(two_atoms + pair_atoms + "\nPair Coeffs # lj/cuts\n\n1 1 1\n2 1 1\n") ==
        "m.data:21: pair style 'lj/cuts' is not supported; expected one of: lj/cut, lj, lj/cut/coul/cut, "
        "lj/cut/coul/long, "
        "lj/cut/coul/dsf, lj/cut/coul/debye, lj/cut/coul/msm, lj/charmm/coul/charmm, lj/charmm/coul/long, "
        "lj/charmm/coul/msm");
  const auto angle = [](const std::string& style) {
    return data_refusal(with_coefficients("1 angles\n1 angle types\n",
                                          "Angle Coeffs # " + style + "\n\n1 1 1 1\n\nAngles\n\n1 1 1 2 3\n"));
  };
  CHECK(angle("cosine/delta") ==
        "m.data:23: style 'cosine/delta' of section 'Angle Coeffs' is not supported; expected one of: "
        "harmonic, cosine, cosine/squared, charmm");
  CHECK(data_refusal(with_coefficients("1 bonds\n1 bond types\n", "BondBond Coeffs\n\n1 1 1 1\n")) ==
        "m.data:21: section 'BondBond Coeffs' is not supported: no force here uses it");
}

TEST_CASE("styles are those of LAMMPS whatever package computes them", "[structure]") {
  const std::string file =
      "LAMMPS data file via write_data, version 22 Jul 2025, timestep = 0, units = lj\n\n2 atoms\n1 atom types\n1 "
      "bonds\n1 bond types\n\n0 10 xlo xhi\n0 10 ylo yhi\n0 10 zlo zhi\n\nMasses\n\n1 1\n\nPair Coeffs # "
      "lj/cut/@\n\n1 1 1\n\nBond Coeffs # harmonic/@\n\n1 30 1\n\nAtoms # bond/@\n\n1 1 1 1 1 1 0 0 0\n2 1 1 "
      "2.1 1 1 0 0 0\n\nBonds\n\n1 1 1 2\n";
  for (const std::string suffix : {"omp", "opt", "gpu", "intel", "kk", "kk/host", "kk/device"}) {
    std::string content = file;
    for (auto at = content.find('@'); at != std::string::npos; at = content.find('@')) content.replace(at, 1, suffix);
    const auto s = read_data(content, {.units = &reduced, .special = {{1, 1, 1}}});
    const double r = s.positions()[1][0] - s.positions()[0][0], six = std::pow(r, -6);
    const TermKind& bond = s.topology()->bond_kinds.at(0);
    CHECK(bond == TermKind{"harmonic", {60, 1}});
    CHECK(s.topology()->pair_kind(0, 0) == PairKind{1, 1});
    CHECK(std::abs(4 * (six * six - six) + 30 * (r - 1) * (r - 1) + 0.6833724493737485) < 1e-13);
  }
}

TEST_CASE("a word behind Atoms that is no style is a remark where the columns tell the style", "[structure]") {
  const auto s = read_data(
      "LAMMPS description\n\n2 atoms\n1 atom types\n0 ellipsoids\n0 crossterms\n\n0 10 xlo xhi\n0 10 ylo yhi\n0 10 zlo "
      "zhi\n0 -2e-16 0 xy xz yz\n\nMasses\n\n1 1.0\n\nAtoms # I like comments\n\n1 1 1.0 1.0 1.0\n2 1 9.0 1.5 1.0\n");
  const double r2 = s.box().minimum_image(Vec3<double>(s.positions()[1] - s.positions()[0])).squaredNorm();
  const double six = 1 / (r2 * r2 * r2);
  CHECK(std::abs(4 * (six * six - six) + 0.05142787991644582) < 1e-12);
  const std::string rows = "\n\n1 1 1 0 1 0\n2 1 2 1 1 0\n";
  CHECK(data_refusal(two_atoms + "\nAtoms # my atoms" + rows) ==
        "m.data:14: rows of 6 words could be of several styles, but 'my' is not one of them; write 'Atoms # "
        "molecular', or give "
        "atom_style = \"molecular\" or another one");
  CHECK(read_data(two_atoms + "\nAtoms # my atoms" + rows, {.units = &reduced, .atom_style = "molecular"}).size() == 2);
}

TEST_CASE("files are named as LAMMPS users name them", "[structure]") {
  const test::ScratchFolder folder;
  for (const char* name : {"data.water", "water.lmp", "water.lammps", "water.lmpdat"}) {
    test::write_text(folder / name, two_atoms + pair_atoms);
    CHECK(io::read_structure(folder / name, {.units = &reduced}).size() == 2);
  }
  // The extension counts more.
  test::write_text(folder / "data.xyz", "1\n\nO 0 0 0\n");
  CHECK(io::read_structure(folder / "data.xyz").size() == 1);
}

TEST_CASE("labels stand for types", "[structure]") {
  const std::string labelled =
      "#\n3 atoms\n2 atom types\n1 bonds\n1 bond types\n" + box +
      "\nAtom Type Labels\n\n2 OH\n1 CT  # carbon\n\nBond Type Labels\n\n1 CT-OH\n\nMasses\n\nOH 16\n1 12\n"
      "\nPair Coeffs # lj/cut\n\nOH 1 2\nCT 3 4\n\nBond Coeffs # harmonic\n\nCT-OH 5 1\n";
  const auto s =
      read_data(labelled + "\nAtoms # bond\n\n1 1 CT 0 1 0\n2 1 OH 1 1 0\n3 2 2 2 2 2\n\nBonds\n\n1 CT-OH 1 2\n");
  CHECK(s.topology()->type_names == std::vector<std::string>{"CT", "OH"});
  CHECK(s.topology()->types == std::vector<std::int64_t>{0, 1, 1});
  CHECK(s.masses()[0] == 12);
  CHECK(s.masses()[2] == 16);
  CHECK(s.topology()->pair_kind(1, 1) == PairKind{1, 2});
  CHECK(s.topology()->bond_kinds == std::vector<TermKind>{{"harmonic", {10, 1}}});
  CHECK(s.topology()->bonds == std::vector<BondedTerm<2>>{{{0, 1}, 0}});
  const auto typed =
      read_data(labelled + "\nAtoms # bond\n\n1 1 CT 0 1 0\n2 1 OH 1 1 0\n3 2 2 2 2 2\n\nBonds\n\n1 1 1 2\n",
                {.units = &reduced, .types = {{.type = "OH", .mass = 17}}});
  CHECK(typed.masses()[1] == 17);
  CHECK(data_refusal(labelled + "\nAtoms # bond\n\n1 1 CH 0 1 0\n2 1 OH 1 1 0\n3 2 2 2 2 2\n\nBonds\n\n1 1 1 2\n") ==
        "m.data:35: the type of an atom is 'CH', which is not a label of atom types; did you mean 'CT'?");
  CHECK(data_refusal("#\n1 atoms\n2 atom types\n" + box + "\nAtom Type Labels\n\n1 A\n2 A\n") ==
        "m.data:11: 'A' of atom types appears twice");
  CHECK(data_refusal("#\n1 atoms\n1 atom types\n" + box + "\nAtom Type Labels\n\n1 1A\n") ==
        "m.data:10: the label '1A' begins with a digit, so it could be the number of a type");
}
