// Structures as ASE, QUIP, OVITO, cp2k, Open Babel, Jmol, GROMACS, LAMMPS, VMD and moltemplate write them.

#include "engine/charge.hpp"
#include "tests/sweep/support.hpp"

#include <vector>

namespace noether::test {
namespace {

/// 4 epsilon ((sigma/r)^12 - (sigma/r)^6) of two atoms of argon 0.4 nm apart, epsilon = 0.996 kJ/mol, sigma = 0.34 nm,
/// worked out by Python [kJ/mol].
constexpr double pair_of_argon = -0.9358725098194902;

struct Row {
  std::string what, file, content, keys;
  double kinetic, potential;  ///< [kJ/mol]
};

std::string with_dos_ends(std::string text) {
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, "\r");
  return text;
}

const std::string argon_mass = "[[particles.type]]\nname = 'AR'\nmass = '39.948 u'\n";
const std::string gro_atoms =
    "two\n    2\n    1AR      AR    1   0.000   0.000   0.000\n    2AR      AR    2   0.000   0.000   0.400\n";

const std::vector<Row> argon_rows = {
    {"Fortran's exponents", "a.xyz", "2\n\nAr 0.0D+00 0.0d0 0.0D+00\nAr 0.0D0 0 4.0D+00\n", "", 0, pair_of_argon},
    {"a column of charges, as Molden and Open Babel write it", "a.xyz",
     "2\nenergy: 1.0\nAr 0 0 0 0.25\nAr 0 0 4.0 -0.25\n", "", 0, pair_of_argon},
    {"charges and vibrations, as Jmol writes them", "a.xyz", "2\nfreq\nAr 0 0 0 0.1 1 2 3\nAr 0 0 4.0 -0.1 1 2 3\n", "",
     0, pair_of_argon},
    {"a key alone, as ASE reads it", "a.xyz",
     "2\nLattice=\"20 0 0 0 20 0 0 0 20\" Properties=species:S:1:pos:R:3 relaxed pbc=\"T T T\"\nAr 0 0 0\nAr 0 0 4.0\n",
     "", 0, pair_of_argon},
    {"the comment of cp2k", "a.xyz",
     "2\n i =        0, time =        0.000, E =       -17.1643447508\n Ar 0 0 0\n Ar 0 0 4.0\n", "", 0, pair_of_argon},
    {"a byte order mark, DOS ends, tabs, and no end of the last line", "a.xyz",
     "\xEF\xBB\xBF"
     "2\r\n\r\nAr\t0\t0\t0\r\nAr\t0\t0\t4.0",
     "", 0, pair_of_argon},
    {"more than 99999 atoms, which VMD numbers by stars", "a.gro",
     "two\n    2\n    1AR      AR*****   0.000   0.000   0.000\n    2AR      AR*****   0.000   0.000   0.400\n"
     "   2.00000   2.00000   2.00000\n",
     argon_mass, 0, pair_of_argon},
    {"nine numbers of a box, zeros of both signs", "a.gro",
     gro_atoms + "   2.00000   2.00000   2.00000   0.00000   0.00000  -0.00000   0.00000   0.00000   0.00000\n",
     argon_mass, 0, pair_of_argon},
    {"a name in capitals, as DOS gave it", "A.XYZ", "2\n\nAr 0 0 0\nAr 0 0 4.0\n", "", 0, pair_of_argon},
    // m v^2 of both, v = 0.1 nm/ps.
    {"velocities of GROMACS", "a.gro",
     "two\n    2\n    1AR      AR    1   0.000   0.000   0.000  0.1000  0.0000  0.0000\n"
     "    2AR      AR    2   0.000   0.000   0.400 -0.1000  0.0000  0.0000\n   2.00000   2.00000   2.00000\n",
     argon_mass, 0.39948, pair_of_argon},
    // ASE 3.29: get_kinetic_energy() = 0.028161610093121056 eV, times e N_A.
    {"atomic numbers of QUIP in the place of species", "a.xyz",
     "2\nLattice=\"20 0 0 0 20 0 0 0 20\" Properties=Z:I:1:pos:R:3:momenta:R:3 pbc=\"T T T\"\n18 0 0 0 1 0 0.5\n"
     "18 0 0 4.0 -1 0 0\n",
     "", 2.717182302961944, pair_of_argon},
    {"atomic numbers of ASE", "a.xyz",
     "2\nProperties=numbers:I:1:pos:R:3:momenta:R:3\n18 0 0 0 1 0 0.5\n18 0 0 4.0 -1 0 0\n", "", 2.717182302961944,
     pair_of_argon},
    // QUIP's unit of mass is eV fs^2/angstrom^2: 39.948 u = 4140.318440852808 of it, by CODATA 2018.
    {"masses of QUIP", "a.xyz",
     "2\nProperties=species:S:1:pos:R:3:mass:R:1:velo:R:3\nAr 0 0 0 4140.318440852808 0.001 0 0\n"
     "Ar 0 0 4.0 4140.318440852808 -0.001 0 0\n",
     "", 0.39948, pair_of_argon},
    // ASE's kinetic energy of the same momenta, as above: masses of QUIP are the same masses.
    {"masses of QUIP beside momenta", "a.xyz",
     "2\nProperties=species:S:1:pos:R:3:mass:R:1:momenta:R:3\nAr 0 0 0 4140.318440852808 1 0 0.5\n"
     "Ar 0 0 4.0 4140.318440852808 -1 0 0\n",
     "", 2.717182302961944, pair_of_argon},
    // Of four columns `q` and `charges` are no charges; atomic numbers beside species say nothing new.
    {"quaternions", "a.xyz", "2\nProperties=species:S:1:pos:R:3:q:R:4\nAr 0 0 0 1 0 0 0\nAr 0 0 4.0 1 0 0 0\n", "", 0,
     pair_of_argon},
    {"charges of several populations", "a.xyz",
     "2\nProperties=species:S:1:pos:R:3:charges:R:2\nAr 0 0 0 1 0\nAr 0 0 4.0 1 0\n", "", 0, pair_of_argon},
    {"atomic numbers beside species", "a.xyz",
     "2\nProperties=species:S:1:pos:R:3:Z:I:1:numbers:I:1:atomic_numbers:I:2\nAr 0 0 0 18 18 18 18\n"
     "Ar 0 0 4.0 18 18 18 18\n",
     "", 0, pair_of_argon},
    {"masses of ASE", "a.xyz",
     "2\nProperties=species:S:1:pos:R:3:masses:R:1:velo:R:3\nAr 0 0 0 39.948 0.001 0 0\nAr 0 0 4.0 39.948 -0.001 0 0\n",
     "", 0.39948, pair_of_argon},
};

/// A chain across two faces of the box, with remarks, images, and velocities in another order than atoms.
const std::string wrapped_chain =
    "LAMMPS data file\n\n3 atoms\n2 bonds\n1 angles\n2 atom types\n1 bond types\n1 angle types\n\n-10.0 10.0 xlo xhi\n"
    "-10.0 10.0 ylo yhi\n-5.0 15.0 zlo zhi\n\nMasses\n\n1 15.035D+00 # CH3\n2 14.027 # CH2\n\nPair Coeffs # lj/cut\n\n"
    "1 0.1947 3.75\n2 0.0914 3.95\n\nBond Coeffs # harmonic\n\n1 450.0 1.54\n\nAngle Coeffs # harmonic\n\n1 62.1 "
    "114.0\n"
    "\nAtoms # full\n\n3 1 1 0.0 -8.90 1.20 14.40 1 0 0\n1 1 1 0.0 9.30 0.10 14.90 0 0 0\n"
    "2 1 2 0.0 -9.60 0.20 -4.30 1 0 1\n\nVelocities\n\n2 0.001 -0.002 0.0005\n3 0.0 0.001 0.0\n1 -0.001 0.0 0.002\n\n"
    "Bonds\n\n1 1 1 2\n2 1 2 3\n\nAngles\n\n1 1 1 2 3\n";

/// Butane as moltemplate and TopoTools write it, types by their labels.
const std::string butane =
    "butane, units = real\n\n4 atoms\n3 bonds\n2 angles\n1 dihedrals\n1 atom types\n1 bond types\n1 angle types\n"
    "1 dihedral types\n\n0 24 xlo xhi\n0 24 ylo yhi\n0 24 zlo zhi\n0 0 0 xy xz yz\n\nAtom Type Labels\n\n1 CT\n\n"
    "Bond Type Labels\n\n1 CT-CT\n\nAngle Type Labels\n\n1 CT-CT-CT\n\nDihedral Type Labels\n\n1 "
    "CT-CT-CT-CT\n\nMasses\n\n"
    "CT 14.027\n\nPair Coeffs # lj/cut\n\nCT 0.118 3.905\n\nBond Coeffs # harmonic\n\nCT-CT 260.0 1.526\n\n"
    "Angle Coeffs # harmonic\n\nCT-CT-CT 63.0 112.4\n\nDihedral Coeffs # opls\n\nCT-CT-CT-CT 1.411 -0.271 3.145 0.0\n\n"
    "Atoms # molecular\n\n1 1 CT 5.0 5.0 5.0\n2 1 CT 6.4 5.5 5.1\n4 1 CT 8.6 5.4 7.2\n3 1 CT 7.3 4.6 6.1\n\nBonds\n\n"
    "1 CT-CT 1 2\n2 CT-CT 2 3\n3 CT-CT 3 4\n\nAngles\n\n1 CT-CT-CT 1 2 3\n2 CT-CT-CT 2 3 4\n\nDihedrals\n\n"
    "1 CT-CT-CT-CT 1 2 3 4\n";

const std::string metal_pairs =
    "two types\n\n3 atoms\n2 atom types\n\n0 30 xlo xhi\n0 30 ylo yhi\n0 30 zlo zhi\n\nMasses\n\n1 39.948\n2 83.798\n\n"
    "Pair Coeffs # lj/cut\n\n1 0.0103 3.4\n2 0.0140 3.65\n\nAtoms # charge\n\n1 1 0.0 1 1 1\n2 2 0.0 4.8 1 1\n"
    "3 1 0.0 1 5.1 29.5\n";

/// LAMMPS 22 Jul 2025, run 0 of the same file (Fortran's exponent and labels taken out, which it does not read): its pe
/// times 4.184 or times 96.48533212331, its ke times 4.184.
const std::vector<Row> molecule_rows = {
    {"a molecule across the faces", "a.data", with_dos_ends(wrapped_chain), "file_units = 'real'\n", 0.819258750054,
     231.941878542},
    {"the same without a box, by its images", "a.data", wrapped_chain, "file_units = 'real'\nbox = 'open'\n",
     0.819258750054, 231.941878542},
    {"labels of all types, and atoms out of order", "a.data", butane, "special = [0, 0, 0.5]\n", 0, 162.405107543},
    {"two types in metal units, mixed geometrically", "a.data", metal_pairs, "file_units = 'metal'\n", 0,
     -1.98709608665},
    {"the same, mixed arithmetically", "a.data", metal_pairs, "file_units = 'metal'\nmixing = 'lorentz_berthelot'\n", 0,
     -1.98487087644},
    {"PairIJ Coeffs of write_data", "a.data",
     replaced(metal_pairs, "Pair Coeffs # lj/cut\n\n1 0.0103 3.4\n2 0.0140 3.65",
              "PairIJ Coeffs # lj/cut\n\n1 1 0.0103 3.4\n1 2 0.0125 3.5\n2 2 0.0140 3.65"),
     "file_units = 'metal'\n", 0, -2.06049553513},
};

void check_rows(const std::vector<Row>& rows, const std::string& parameters, const std::string& forces, double error) {
  for (const Row& row : rows) {
    CAPTURE(row.what);
    const std::string own = has(row.content, "Bonds") ? forces : "";
    const Seen it = seen(structure_scene(row.file, row.keys, parameters, own), row.file, row.content);
    CHECK(it.refusal == "");
    CHECK(near(it.energy.potential, row.potential, error));
    CHECK(near(it.energy.kinetic, row.kinetic, error));
  }
}

TEST_CASE("pairs of atoms as other programs write them have their energy", "[sweep][structure]") {
  check_rows(argon_rows, argon_parameters, "", 1e-10);
}

TEST_CASE("molecules as LAMMPS, moltemplate and TopoTools write them have LAMMPS's energy", "[sweep][structure]") {
  check_rows(molecule_rows, "", "[[hamiltonian.force]]\ntype = 'bonded'\n", 1e-10);
}

TEST_CASE("charges of XYZ are read by each of their names", "[sweep][structure]") {
  // ASE keeps these columns as arrays or results of the same numbers.
  for (const std::string name : {"charges", "q", "charge", "initial_charges"}) {
    CAPTURE(name);
    const Seen it = seen(structure_scene("a.xyz"), "a.xyz",
                         "2\nProperties=species:S:1:pos:R:3:" + name + ":R:1\nNa 0 0 0 1\nCl 0 0 4.0 -1\n");
    REQUIRE(it.refusal.empty());
    CHECK(it.particles.column<Charge>()[0] == 1);
    CHECK(it.particles.column<Charge>()[1] == -1);
  }
}

TEST_CASE("a column before x of plain XYZ is told, whatever it has", "[sweep][structure][messages]") {
  for (const auto& [atoms, what] : std::vector<std::pair<std::string, std::string>>{
           {"Ar 18 0 0 0\nAr 18 0 0 4.0\n", "has the atomic number of each atom"},
           {"Ar1 18.0 0 0 0\nAr2 18.0 0 0 4.0\n", "has the atomic number of each atom"},
           {"AR 18 0 0 0\nAR 18 0 0 4.0\n", "has the atomic number of each atom"},
           {"CA 6 0 0 0\nHB2 1 0 0 1.1\n", "has the atomic number of each atom"},
           {"Ar 18.0 0 0 0\nX 0.0 0 0 4.0\n", "has the atomic number of each atom"},
           {"Ar 39.948 0 0 0\nAr 39.948 0 0 4.0\n", "has the mass of each atom"},
           {"Ar 39.95 0 0 0\nXX 0.0 0 0 4.0\n", "has the mass of each atom"},
           {"Ar 1 0 0 0\nAr 2 4.0 0 0\n", "numbers the atoms"},
           {"Ar 0 0 0 0\nAr 1 4.0 0 0\n", "numbers the atoms"},
           {"Ar 7 0.0 0.0 0.0\nAr 7 4.0 0.0 0.0\n", "has whole numbers before three numbers with a point"},
           {"Ar 4 0.0 0.0 0.0 0.5\nAr -2 4.0 0.0 0.0 0.5\n", "has whole numbers before three numbers with a point"}}) {
    CAPTURE(atoms);
    CHECK(seen(structure_scene("a.xyz"), "a.xyz", "2\n\n" + atoms).refusal ==
          "a.xyz:3: the second column " + what + ", where XYZ has x; take that column out");
  }
  CHECK(seen(structure_scene("a.xyz"), "a.xyz", "2\n\nAr 0 0 0 1\nAr 0 0 4\n").refusal ==
        "a.xyz:4: this atom has 4 columns; expected 5, as the first atom has");
  // One atom elsewhere is enough for a position.
  for (const std::string atoms : {"Ar 18 0 0 0\nAr 18.5 0 0 4.0\n", "Ar 39.948 0 0 0\nAr 39 0 0 4.0\n",
                                  "Ar 1 0 0 0\nAr 3 4.0 0 0\n", "Ar 7 0.0 0.0 0.0\nAr 7.0 4.0 0.0 0.0\n"}) {
    CAPTURE(atoms);
    CHECK(seen(structure_scene("a.xyz"), "a.xyz", "2\n\n" + atoms).refusal == "");
  }
}

TEST_CASE("what passes for something else in a structure is told", "[sweep][structure][messages]") {
  const auto xyz = [](const std::string& content) { return seen(structure_scene("a.xyz"), "a.xyz", content); };
  CHECK(xyz("2\nenergy: 1.0\nAr 0 0 0 0.25\nAr 0 0 4.0 -0.25\n").warnings ==
        std::vector<std::string>{"x, y, z of the structure are taken from columns 2 to 4; column 5 is ignored"});
  CHECK(xyz(argon_rows[2].content).warnings ==
        std::vector<std::string>{"x, y, z of the structure are taken from columns 2 to 4; columns 5 to 8 are ignored"});
  CHECK(
      xyz(argon_rows[12].content).warnings ==
      std::vector<std::string>{"the masses of the structure are 103.64 times the atomic weights: they are taken as eV "
                               "fs^2/angstrom^2, as QUIP writes them"});
  // As GAMESS and Molden order their columns.
  CHECK(xyz("2\n\nAr 18 0 0 0\nAr 18 0 0 4.0\n").refusal ==
        "a.xyz:3: the second column has the atomic number of each atom, where XYZ has x; take that column out");
  CHECK(xyz("2\n\nAr1 0 0 0\nAr1 0 0 4.0\n").refusal ==
        "a.xyz:3: particles of type 'Ar1' have no mass; give it in [[particles.type]]: name = \"Ar1\", mass = \"39.948 "
        "u\" "
        "if it is Ar");
  CHECK(xyz("2\n\nFE 0 0 0\nFE 0 0 4.0\n").refusal ==
        "a.xyz:3: particles of type 'FE' have no mass; give it in [[particles.type]]: name = \"FE\", mass = \"55.845 "
        "u\" if "
        "it is Fe");
  CHECK(xyz("2\n\n18 0 0 0\n18 0 0 4.0\n").refusal ==
        "a.xyz:3: particles of type '18' have no mass; give it in [[particles.type]]: name = \"18\", mass = \"39.948 "
        "u\" if "
        "it is Ar");
  const auto lammps = [](const std::string& content) {
    return seen(structure_scene("a.data", "file_units = 'metal'\n", ""), "a.data", content);
  };
  CHECK(lammps(replaced(metal_pairs, " # lj/cut", "")).warnings ==
        std::vector<std::string>{
            "the style of the structure's pair coefficients is not given: they are taken as epsilon and sigma of "
            "lj/cut; if that is right, write it after the section, 'Pair Coeffs # lj/cut'"});
  // Rows of a hybrid section that name no style have none either.
  CHECK(lammps(replaced(metal_pairs, "# lj/cut", "# hybrid")).warnings ==
        lammps(replaced(metal_pairs, " # lj/cut", "")).warnings);
  CHECK(
      lammps(replaced(replaced(metal_pairs, "# lj/cut\n\n1 ", "# hybrid\n\n1 lj/cut "), "2 0.0140", "2 lj/cut 0.0140"))
          .warnings.empty());
  CHECK(lammps(metal_pairs).warnings.empty());
  CHECK(lammps(replaced(metal_pairs, "0 30 xlo xhi\n", "30 0 0 avec\n")).refusal ==
        "a.data:6: '30 0 0 avec' belongs to a general triclinic box; only orthogonal boxes are supported, given by xlo "
        "xhi, ylo yhi, zlo zhi");
  // Directions whose quotes are lost are no keys of their own.
  CHECK(
      xyz("1\nLattice=\"20 0 0 0 20 0 0 0 20\" pbc=T F T\nAr 0 0 0\n").refusal ==
      "a.xyz:2: 'F' is not understood: a comment with '=' is read as key=value; put quotes around values with spaces, "
      "or "
      "take the '=' out of a comment that is only a text");
  CHECK(seen(structure_scene("a.gro", argon_mass), "a.gro",
             gro_atoms + "   2.00000   2.00000   2.00000   0.00000   0.00000   0.50000   0.00000   0.00000   0.00000\n")
            .refusal ==
        "a.gro:5: the box is triclinic, with the 9 numbers 2.00000 2.00000 2.00000 0.00000 0.00000 0.50000 0.00000 "
        "0.00000 0.00000; only orthogonal boxes are supported");
}

}  // namespace
}  // namespace noether::test
