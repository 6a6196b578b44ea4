// Coefficients that a LAMMPS data file leaves to input scripts.

#include "engine/charge.hpp"
#include "io/structure.hpp"
#include "tests/io/support.hpp"

#include <numbers>

using namespace noether;
using test::error_of;

namespace {

const std::string bare =
    "no coefficients\n\n4 atoms\n3 bonds\n2 angles\n2 atom types\n2 bond types\n1 angle types\n0 9 xlo xhi\n0 9 ylo "
    "yhi\n"
    "0 9 zlo zhi\n\nAtoms # molecular\n\n1 1 1 1 1 1\n2 1 2 2 1 1\n3 1 2 2 2 1\n4 1 1 2 2 2\n\n"
    "Bonds\n\n1 1 1 2\n2 2 2 3\n3 1 3 4\n\nAngles\n\n1 1 1 2 3\n2 1 2 3 4\n";
const std::string init =
    "units lj\natom_style molecular\npair_style lj/cut 2.5\nbond_style hybrid harmonic morse\n"
    "angle_style harmonic/omp\nspecial_bonds lj/coul 0.0 0.0 0.5\npair_modify mix arithmetic\n"
    "kspace_style none\nneighbor 0.3 bin\nread_data \"m.data\"\n";
const std::string settings =
    "mass 1 2.0\nmass 2 3.0 # heavier\npair_coeff 1 1 1.0 1.0\npair_coeff 2 2 4.0 3.0\n"
    "bond_coeff 1 harmonic 30.0 1.0\nbond_coeff 2 morse/kk 1 &\n 2 3\nangle_coeff * 5.0 90\n";

ParticleSystem<double> read_scripts(const std::vector<std::string>& scripts, io::StructureOptions options = {},
                                    const std::string& data = bare) {
  const test::ScratchFolder folder;
  test::write_text(folder / "m.data", data);
  for (const std::string& script : scripts) {
    options.coefficients.push_back(folder / ("m.in." + std::to_string(options.coefficients.size())));
    test::write_text(options.coefficients.back(), script);
  }
  options.units = &unit_system("reduced");
  return io::read_structure(folder / "m.data", options);
}

std::string script_refusal(const std::string& line, const io::StructureOptions& options = {}) {
  const std::string message = error_of([&] { read_scripts({init + settings + line + "\n"}, options); });
  const std::size_t name = message.find("m.in.0:");
  return name == std::string::npos ? message : message.substr(name);
}

}  // namespace

TEST_CASE("scripts of LAMMPS give masses, styles and coefficients", "[structure]") {
  for (const auto& scripts : {std::vector{init + settings}, std::vector{init, settings}}) {
    const auto s = read_scripts(scripts);
    const Topology& t = *s.topology();
    CHECK(s.masses()[0] == 2);
    CHECK(s.masses()[1] == 3);
    CHECK(t.pair_kind(0, 1) == PairKind{2, 2});  // arithmetic
    CHECK(t.stated_cutoff == 2.5);
    CHECK(t.bond_kinds == std::vector<TermKind>{{"harmonic", {60, 1}}, {"morse", {1, 2, 3}}});
    CHECK(t.angle_kinds == std::vector<TermKind>{{"harmonic", {10, 90 * (std::numbers::pi / 180)}}});
    REQUIRE(t.scaled_pairs.size() == 1);
    CHECK(t.scaled_pairs[0] == Topology::ScaledPair{{0, 3}, 0.5});
    CHECK(t.exclusions.size() == 5);
  }
}

TEST_CASE("commands of scripts come behind the sections of the data file", "[structure]") {
  const auto s =
      read_scripts({init + settings + "mass 1*2 5\npair_coeff * * 1 2\npair_coeff 1 2 7 8\nangle_coeff 1 6 60\n"}, {},
                   bare + "\nMasses\n\n1 1\n2 1\n\nPair Coeffs # the scene's\n\n1 9 9\n2 9 9\n");
  CHECK(s.masses()[1] == 5);
  CHECK(s.topology()->pair_kind(0, 0) == PairKind{1, 2});
  CHECK(s.topology()->pair_kind(1, 0) == PairKind{7, 8});
  CHECK(s.topology()->angle_kinds[0].parameters[0] == 12);
  // A style that a section does not say is the script's.
  const auto styled = read_scripts({init + settings}, {}, bare + "\nAngle Coeffs # K theta0\n\n1 5 90\n");
  CHECK(styled.topology()->angle_kinds[0].potential == "harmonic");
  CHECK(error_of([] {
          read_scripts({init + settings}, {}, bare + "\nAngle Coeffs # cosine\n\n1 5\n");
        }).find("section 'Angle Coeffs' is of style 'cosine', but the script says angle_style harmonic") !=
        std::string::npos);
}

TEST_CASE("special and mixing of the scene agree with the script, or one of them goes", "[structure]") {
  CHECK(read_scripts({init + settings}, {.special = {{0, 0, 0.5}}, .mixing = Mixing::lorentz_berthelot}).size() == 4);
  CHECK(script_refusal("", {.special = {{0, 0, 0}}}) ==
        "m.in.0:6: special_bonds keeps [0, 0, 0.5], but special says [0, 0, 0]; take one of them out");
  CHECK(script_refusal("", {.mixing = Mixing::geometric}) ==
        "m.in.0:7: pair_modify and mixing give different mixing rules; take one of them out");
  CHECK(script_refusal("", {.file_units = "real"}) ==
        "m.in.0:1: units lj is given here, but the file's units is 'real' elsewhere; take one of them out");
  for (const auto& [line, factor] : {std::pair("fene", 1.0), std::pair("dreiding", 1.0), std::pair("charmm", 0.0),
                                     std::pair("lj 0 0 0.25 coul 0 0 0.25 angle no", 0.25)}) {
    const auto s = read_scripts({init + settings + "special_bonds " + line + "\n"});
    CHECK(s.topology()->pair_factor(0, 3) == factor);
  }
}

TEST_CASE("what says more than coefficients is refused by name", "[structure][messages]") {
  CHECK(script_refusal("fix 1 all nve") ==
        "m.in.0:19: 'fix' does more than give coefficients, which is not supported; keep mass, *_coeff, *_style, "
        "special_bonds and pair_modify in a file of their own");
  CHECK(script_refusal("bond_coef 1 1 1") ==
        "m.in.0:19: 'bond_coef' does more than give coefficients, which is not supported; did you mean 'bond_coeff'?");
  CHECK(script_refusal("mass 1 ${m}") == "m.in.0:19: 'mass 1 ${m}' uses a variable; write its value instead");
  CHECK(script_refusal("include other.in") ==
        "m.in.0:19: 'include other.in' is not followed to the other file; list both files: coefficients = [\"a\", "
        "\"b\"]");
  CHECK(script_refusal("boundary p p f").starts_with("m.in.0:19: 'boundary' does more than give coefficients"));
  CHECK(script_refusal("pair_style hybrid/overlay lj/cut 2.5 coul/long 2.5")
            .starts_with("m.in.0:19: pair style 'hybrid/overlay' is not supported; expected one of: lj/cut, "));
  CHECK(script_refusal("pair_coeff 1 1 buck 1 1 1")
            .starts_with("m.in.0:19: pair style 'buck' is not supported; expected one of: "));
  CHECK(script_refusal("mass 2*3 1") == "m.in.0:19: the type is '3'; a whole number is expected, 1 to 2");
  CHECK(script_refusal("pair_coeff 1 3 1 1") == "m.in.0:19: the type is '3'; a whole number is expected, 1 to 2");
  CHECK(script_refusal("pair_coeff 1 2 1 1 3.5") ==
        "m.in.0:19: the cutoffs of pairs differ: 3.5 here, 2.5 at line 14; a force has one cutoff; give it in the "
        "scene, and take these out");
  CHECK(script_refusal("bond_coeff 1 30.0 1.0") ==
        "m.in.0:19: the style of these coefficients is not given; give a line bond_style too; expected one of: "
        "harmonic, morse, "
        "fene");
  CHECK(script_refusal("pair_modify mix sixthpower") ==
        "m.in.0:19: pair_modify mix sixthpower is not supported; expected geometric or arithmetic");
  CHECK(script_refusal("pair_modify compute no") ==
        "m.in.0:19: 'compute no' of pair_modify is not supported; only mix, shift and tail are");
  CHECK(script_refusal("pair_style lj/cut/coul/cut 2.5\nspecial_bonds coul 0 0.5 1 lj 0 0 1") ==
        "m.in.0:20: special_bonds keeps [0, 0, 1] of Lennard-Jones forces and [0, 0.5, 1] of forces of charges; only "
        "the third factor may differ");
  CHECK(script_refusal("special_bonds lj/coul 0 0 0.5 angle yes")
            .starts_with("m.in.0:19: 'angle yes' of special_bonds is not supported"));
  CHECK(error_of([] {
          read_scripts({init + "mass * 1\nbond_coeff 1 harmonic 1 1\n"});
        }).find("m.in.0:12: bond type 2 of 2 has no coefficients; give them as well") != std::string::npos);
  std::vector<std::string> notes;
  CHECK(script_refusal("pair_modify shift yes tail yes", {.notes = &notes}).empty());
  CHECK(notes == std::vector<std::string>{
                     "pair_modify shift yes has no effect here; give it in the scene: cutoff_style = \"shifted\"",
                     "pair_modify tail yes has no effect here; give it in the scene: tail = true"});
}

TEST_CASE("special_bonds may leave of charges another part than of Lennard-Jones forces", "[structure]") {
  // amber: a half, and five sixths; a style without charges knows only the first.
  const auto plain = read_scripts({init + settings + "special_bonds amber\n"});
  CHECK(plain.topology()->pair_factor(0, 3) == 0.5);
  CHECK(plain.topology()->dihedrals.empty());
  std::string charged = bare;
  charged.replace(charged.find("# molecular"), 11, "# full");
  for (const auto& [row, with] :
       {std::pair("1 1 1 1 1 1\n", "1 1 1 0.5 1 1 1\n"), std::pair("2 1 2 2 1 1\n", "2 1 2 0 2 1 1\n"),
        std::pair("3 1 2 2 2 1\n", "3 1 2 0 2 2 1\n"), std::pair("4 1 1 2 2 2\n", "4 1 1 -2 2 2 2\n")}) {
    charged.replace(charged.find(row), std::string(row).size(), with);
  }
  const std::string scripts =
      "units lj\natom_style full\npair_style lj/cut/coul/cut 2.5\nbond_style hybrid harmonic "
      "morse\nangle_style harmonic\nspecial_bonds amber\n" +
      settings;
  const auto s = read_scripts({scripts}, {}, charged);
  CHECK(s.topology()->pair_factor(0, 3) == 0);
  CHECK(s.topology()->scaled_pairs.empty());
  CHECK(s.topology()->dihedrals == std::vector<BondedTerm<4>>{{{0, 1, 2, 3}, 0}});
  CHECK(s.topology()->dihedral_kinds == std::vector<TermKind>{{"one_four", {0.5, 1, -(5.0 / 6)}}});
}

TEST_CASE("ends of dihedrals have the pair force that weights leave them", "[structure]") {
  const std::string chain =
      "#\n4 atoms\n3 bonds\n1 dihedrals\n2 atom types\n1 bond types\n1 dihedral types\n0 9 xlo xhi\n0 9 ylo yhi\n0 9 "
      "zlo zhi\n"
      "\nMasses\n\n1 1\n2 1\n\nPair Coeffs # lj/charmm/coul/charmm\n\n1 1 2 @\n2 4 3 @\n\nBond Coeffs # harmonic\n\n1 "
      "1 1\n\n"
      "Dihedral Coeffs # charmm\n\n1 2.5 3 60 0.5\n\nAtoms # full\n\n1 1 1 0.5 1 1 1\n2 1 2 0 2 1 1\n3 1 2 0 2 2 1\n"
      "4 1 2 -0.25 2 2 2\n\nBonds\n\n1 1 1 2\n2 1 2 3\n3 1 3 4\n\nDihedrals\n\n1 1 1 2 3 4\n";
  const auto with = [&](const std::string& one, const std::string& two, const io::StructureOptions& options = {}) {
    std::string content = chain;
    content.replace(content.find('@'), 1, one);
    content.replace(content.find('@'), 1, two);
    return read_scripts({}, options, content);
  };
  const TermKind barrier{"periodic", {2.5, 3, 60 * (std::numbers::pi / 180)}};
  // lj/charmm mixes arithmetically: sqrt(1 4) and (2 + 3)/2; half of it is left, and of q q' = -1/8.
  const auto two = with("", "");
  CHECK(two.topology()->dihedral_kinds == std::vector<TermKind>{barrier, {"one_four", {0.5 * 2, 2.5, 0.5 * -0.125}}});
  CHECK(two.topology()->dihedrals == std::vector<BondedTerm<4>>{{{0, 1, 2, 3}, 0}, {{0, 1, 2, 3}, 1}});
  CHECK(two.topology()->pair_factor(0, 3) == 0);
  const auto four = with("9 1", "1 0.5");
  CHECK(four.topology()->dihedral_kinds[1] == TermKind{"one_four", {0.5 * 3, 0.75, 0.5 * -0.125}});
  CHECK(four.topology()->pair_kind(0, 1) == PairKind{2, 2.5});
  // What the scene says of types counts where the file has no other numbers for the ends.
  const auto given = with("", "", {.types = {{.type = "1", .charge = 1, .epsilon = 4, .sigma = 1}}});
  CHECK(given.topology()->dihedral_kinds[1] == TermKind{"one_four", {0.5 * 4, 2, 0.5 * -0.25}});
  CHECK(error_of([&] {
          with("", "", {.special = {{0, 0, 0.5}}});
        }) ==
        "special keeps 0.5 of the force between particles three bonds apart, but the weights of dihedrals in this file "
        "already give that force; 0 is expected there");
}
