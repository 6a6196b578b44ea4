// What is proposed for names of other programs is itself accepted.

#include "scene/foreign_names.hpp"
#include "scene/parts.hpp"
#include "scene/read_builder.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

namespace noether::test {
namespace {

std::vector<std::string> accepted_at(NamePlace place, const Parts& parts) {
  switch (place) {
    case NamePlace::method:
      return parts.method_names();
    case NamePlace::hamiltonian:
      return names_of(parts.hamiltonians());
    case NamePlace::force:
      return names_of(parts.forces());
    case NamePlace::thermostat:
      return names_of(parts.thermostats());
    case NamePlace::constraint:
      return names_of(parts.constraints());
    case NamePlace::builder:
      return names_of(builders());
    case NamePlace::monitor: {
      std::vector<std::string> all = names_of(parts.monitors());
      all.insert(all.end(), {"trajectory", "checkpoint"});
      return all;
    }
    case NamePlace::key:
    case NamePlace::none:
      break;
  }
  return {};
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

TEST_CASE("every name that is proposed for one of another program is a name of its list", "[proposals]") {
  const Parts parts = standard_parts();
  for (const ForeignName& row : foreign_names()) {
    INFO(row.words << ": " << row.here);
    CHECK((row.words.starts_with(' ') && row.words.ends_with(' ')));
    CHECK(std::none_of(row.words.begin(), row.words.end(), [](unsigned char c) { return std::isupper(c) != 0; }));
    if (row.place == NamePlace::key) CHECK_FALSE(row.here.empty());
    if (row.place == NamePlace::none) CHECK_FALSE(row.how.empty());
    if (row.place == NamePlace::key || row.place == NamePlace::none) continue;
    CHECK(contains(accepted_at(row.place, parts), std::string(row.here)));
  }
}

TEST_CASE("parts and methods that a proposal names beside it are there", "[proposals]") {
  const Parts parts = standard_parts();
  std::vector<std::string> all;
  for (const NamePlace place : {NamePlace::method, NamePlace::hamiltonian, NamePlace::force, NamePlace::thermostat,
                                NamePlace::constraint, NamePlace::monitor, NamePlace::builder}) {
    const std::vector<std::string> some = accepted_at(place, parts);
    all.insert(all.end(), some.begin(), some.end());
  }
  for (const ForeignName& row : foreign_names()) {
    const std::string how(row.how);
    for (std::size_t open = how.find('\''); open != std::string::npos;) {
      const std::size_t close = how.find('\'', open + 1);
      REQUIRE(close != std::string::npos);
      INFO(row.words << ": " << how);
      CHECK(contains(all, how.substr(open + 1, close - open - 1)));
      open = how.find('\'', close + 1);
    }
  }
}

TEST_CASE("names of other programs get what there is here", "[proposals]") {
  const Parts parts = standard_parts();
  const auto method = [&](const char* word) { return proposal(word, parts.method_names(), "; see the list"); };
  CHECK(method("aba_1064") == "; did you mean 'aba_10_6_4'?");
  CHECK(method("Velocity-Verlet") == "; did you mean 'verlet'?");
  CHECK(method("Bulirsch Stoer") == "; did you mean 'bulirsch_stoer'?");  // another name of gragg_bulirsch_stoer
  CHECK(method("saba") == "; did you mean 'saba_4'? (on the Hamiltonian 'wisdom_holman')");
  CHECK(method("mercurius").starts_with("; in its place there is 'gauss_radau_15' ("));
  CHECK(method("whfast").starts_with(
      "; in its place there is type = \"wisdom_holman\" in [hamiltonian] (with method = "));
  CHECK(method("nose_hoover").starts_with("; in its place there is type = \"langevin\" in [hamiltonian.thermostat]"));
  CHECK(method("npt").starts_with("; there is no barostat here"));
  CHECK(method("verlett") == "; did you mean 'verlet'?");
  CHECK(method("VERLET") == "; did you mean 'verlet'?");
  CHECK(method("ABA(10,6,4)") == "; did you mean 'aba_10_6_4'?");  // as README has it
  CHECK(method("Blanes-Moan") == "; did you mean 'blanes_moan_s6'?");
  CHECK(method("yoshida_4_integrator") == "; did you mean 'yoshida_4'?");
  CHECK(
      method("PPPM").starts_with("; in its place there is type = \"particle_mesh_ewald\" in [[hamiltonian.force]] ("));
  CHECK(method("shake").starts_with("; in its place there is type = \"distance\" in [[hamiltonian.constraint]] ("));
  CHECK(method("qqqqqqqq") == "; see the list");

  const auto force = [&](const char* word) { return proposal(word, names_of(parts.forces())); };
  CHECK(force("lj/cut") == "; did you mean 'lennard_jones'?");
  CHECK(force("rf") == "; did you mean 'reaction_field'?");
  CHECK(force("coul/cut").starts_with("; in its place there is 'reaction_field' ("));
  CHECK(force("pme") == "; did you mean 'particle_mesh_ewald'?");
  CHECK(force("pppm").starts_with("; in its place there is 'particle_mesh_ewald' ("));
  CHECK(force("Ewald Sum") == "; did you mean 'ewald'?");
  CHECK(force("morse_bond").starts_with("; in its place there is 'bonded' ("));
  CHECK(force("gravitty") == "; did you mean 'gravity'?");
  CHECK(force("morse_potential") == "; did you mean 'morse'?");  // not gr_potential
  CHECK(force("gravity_force") == "; did you mean 'gravity'?");
  CHECK(force("Coulomb Force") == "; did you mean 'coulomb'?");
  CHECK(proposal("energies", names_of(parts.monitors())) == "; did you mean 'energy'?");
  CHECK(proposal("shake", names_of(parts.constraints())).starts_with("; in its place there is 'distance' ("));
  CHECK(proposal("h-bonds", names_of(parts.constraints())) == "; did you mean 'hydrogen_bonds'?");
  CHECK(proposal("settle", names_of(parts.constraints())) == "; did you mean 'rigid_molecules'?");
  CHECK(proposal("zzzz", {"a", "b"}) == "; expected one of: a, b");
}

TEST_CASE("a name of another program is proposed only where it may be meant", "[proposals]") {
  const Parts parts = standard_parts();
  const auto force = [&](const char* word) { return proposal(word, names_of(parts.forces()), "; see the list"); };
  CHECK(force("random") == "; see the list");            // no particles at random
  CHECK(force("steepest_descent") == "; see the list");  // no minimizer
  CHECK(force("shake").starts_with("; in its place there is type = \"distance\" in [[hamiltonian.constraint]]"));
  CHECK(proposal("random", names_of(builders())) == "; did you mean 'liquid'?");
  CHECK(proposal("steep", parts.method_names(), "").find("[minimize]") != std::string::npos);  // "integrator = steep"
  CHECK(proposal("npt", accepted_at(NamePlace::monitor, parts), "; see the list") == "; see the list");
  std::vector<std::string> all = names_of(parts.forces());  // a list of several places has room for all
  for (const std::string& name : parts.method_names()) all.push_back(name);
  CHECK(proposal("cg", all, "").find("[minimize]") != std::string::npos);
}

TEST_CASE("a proposal by name alone is none for a misspelt word", "[proposals]") {
  const Parts parts = standard_parts();
  CHECK(proposal_by_name("SABA", parts.method_names()).starts_with("; did you mean 'saba_4'?"));
  CHECK(proposal_by_name("verlett", parts.method_names()).empty());
  CHECK(proposal_by_name("BABAB", parts.method_names()).empty());
  CHECK(proposal_by_name("BAOAB", parts.method_names()).empty());
}

TEST_CASE("a key of another program gets the one of the table it stands in", "[proposals]") {
  CHECK(key_proposal("dt", {"method", "step", "until"}) == "; did you mean 'step'?");
  CHECK(key_proposal("eps", {"softening", "G"}) == "; did you mean 'softening'?");
  CHECK(key_proposal("eps", {"epsilon", "sigma"}) == "; did you mean 'epsilon'?");
  CHECK(key_proposal("m", {"name", "mass", "x"}) == "; did you mean 'mass'?");
  CHECK(key_proposal("dt", {"cutoff"}) == "; expected one of: cutoff");
}

}  // namespace
}  // namespace noether::test
