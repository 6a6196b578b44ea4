#include "numbers/suggest.hpp"

#include "tests/support/catch.hpp"

#include <string>
#include <vector>

namespace noether {
namespace {

TEST_CASE("the edit distance counts insertions, deletions, replacements and exchanges of neighbors", "[suggest]") {
  CHECK(edit_distance("", "") == 0);
  CHECK(edit_distance("", "abc") == 3);
  CHECK(edit_distance("day", "day") == 0);
  CHECK(edit_distance("cuttoff", "cutoff") == 1);
  CHECK(edit_distance("cutof", "cutoff") == 1);
  CHECK(edit_distance("cutaff", "cutoff") == 1);
  CHECK(edit_distance("dya", "day") == 1);
  CHECK(edit_distance("kitten", "sitting") == 3);
  CHECK(edit_distance("ca", "abc") == 3);  // restricted: no letter is edited twice
  CHECK(edit_distance("abc", "ca") == 3);
}

TEST_CASE("the nearest known word is proposed", "[suggest]") {
  const std::vector<std::string> keys = {"softening", "cutoff", "cutoff_style", "charge"};
  CHECK(suggest("cuttoff", keys) == "cutoff");
  CHECK(suggest("cutofstyle", keys) == "cutoff_style");
  CHECK(suggest("CHARGE", keys) == "charge");
  CHECK(suggest("temperature", keys) == "");
  CHECK(suggest("cutoff", {}) == "");
}

TEST_CASE("short words need a letter in common, long ones may differ by a third", "[suggest]") {
  CHECK(suggest("q", {"s", "m"}) == "");
  CHECK(suggest("zz", {"ns"}) == "");
  CHECK(suggest("nz", {"ns"}) == "ns");
  CHECK(suggest("pme", {"am1"}) == "");  // one letter in common of three
  CHECK(suggest("Mj", {"Mjup", "Msun"}) == "Mjup");
  CHECK(suggest("M", {"Mjup", "Msun"}) == "");
  CHECK(suggest("yoshda_66", {"yoshida_6"}) == "yoshida_6");
  CHECK(suggest("wisdomholm", {"wisdom_holman"}) == "wisdom_holman");  // 3 edits in 10 letters
  CHECK(suggest("wisdomhol", {"wisdom_holman"}) == "");                // 4 edits in 9 letters
}

TEST_CASE("among equally near words the case decides, then the number at the end, then the order", "[suggest]") {
  CHECK(suggest("rk5", {"rk2", "rk4", "rk45"}) == "rk4");
  CHECK(suggest("gauss_9", {"gauss_1", "gauss_2", "gauss_8"}) == "gauss_8");
  CHECK(suggest("stormer_11", {"stormer_14", "stormer_12"}) == "stormer_12");
  CHECK(suggest("rk99999999999999999999", {"rk99999999999999999998"}) == "rk99999999999999999998");
  CHECK(suggest("MYR", {"kyr", "myr", "Myr"}) == "Myr");
  CHECK(suggest("xyr", {"kyr", "myr"}) == "kyr");
}

TEST_CASE("a word that differs in its joints or its plural alone is the nearest", "[suggest]") {
  CHECK(squeezed("Aba-10_6 4") == "aba1064");
  CHECK(squeezed("ABA(10,6,4)") == "aba1064");
  CHECK(squeezed("energies") == "energy");
  CHECK(squeezed("masses") == "masse");
  CHECK(squeezed("gauss") == "gauss");
  CHECK(squeezed("us") == "us");
  CHECK(suggest("aba_1064", {"aba_10_4", "aba_10_6_4"}) == "aba_10_6_4");
  CHECK(suggest("energies", {"elements", "energy"}) == "energy");
  CHECK(suggest("hamilton", {"title", "hamiltonian"}) == "hamiltonian");  // the rest is missing
  CHECK(suggest("hami", {"title", "hamiltonian"}) == "");
  CHECK(suggest("velocityverlet", {"velocity_verlet"}) == "velocity_verlet");
}

TEST_CASE("a message ends with a proposal, or with what is known", "[suggest]") {
  CHECK(did_you_mean("cuttoff", {"cutoff", "charge"}) == "; did you mean 'cutoff'?");
  CHECK(did_you_mean("pressure", {"a", "b", "c"}) == "; expected one of: a, b, c");
  CHECK(did_you_mean("pressure", {}) == "");
}

}  // namespace
}  // namespace noether
