// What varies: grids and draws, as they are written and as members have them.

#include "study/variation.hpp"

#include "scene/toml.hpp"
#include "tests/ensemble/support.hpp"
#include "tests/support/refusal.hpp"

#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace noether::test {
namespace {

TEST_CASE("grids are products whose last key goes fastest, with both ends exact", "[ensemble]") {
  const EnsemblePlan plan = plan_of({"a=0.1:0.7:3", "b=-1:1:2"});
  CHECK(plan.members() == 6);
  CHECK(plan.shape() == std::vector<Index>{3, 2});
  CHECK(plan.values(0) == std::vector<double>{0.1, -1});
  CHECK(plan.values(1) == std::vector<double>{0.1, 1});
  CHECK(plan.values(5) == std::vector<double>{0.7, 1});
  CHECK(std::abs(plan.values(2)[0] - 0.4) <= 1e-16);
}

TEST_CASE("draws stand beside grids, and each is a function of seed, key and member alone", "[ensemble]") {
  const EnsemblePlan plan = plan_of({"a=0:1:3", "b=uniform(2,3)", "c=normal(5,0.5)"}, 4, 7);
  CHECK(plan.members() == 12);
  CHECK(plan.shape() == std::vector<Index>{3, 4});
  std::set<double> b, c;
  for (std::int64_t k = 0; k < 12; ++k) {
    const std::vector<double> values = plan.values(k);
    CHECK(values[0] == 0.5 * static_cast<double>(k / 4));
    CHECK((values[1] > 2 && values[1] < 3));
    b.insert(values[1]);
    c.insert(values[2]);
    CHECK(plan.values(k) == values);
  }
  CHECK(b.size() == 12);  // also at different points of the grid
  CHECK(c.size() == 12);
  const EnsemblePlan more = plan_of({"b=uniform(2,3)"}, 100, 7), other = plan_of({"b=uniform(2,3)"}, 100, 8);
  CHECK(more.values(11)[0] == plan.values(11)[1]);
  CHECK(more.values(11) != other.values(11));
}

TEST_CASE("draws have the moments of their distributions", "[ensemble]") {
  constexpr std::int64_t n = 100'000;
  const EnsemblePlan plan = plan_of({"u=uniform(-1,3)", "z=normal(10,2)"}, n, 2026);
  double u1 = 0, u2 = 0, z1 = 0, z2 = 0, z3 = 0, both = 0;
  for (std::int64_t k = 0; k < n; ++k) {
    const std::vector<double> values = plan.values(k);
    const double u = (values[0] - 1) / 4, z = (values[1] - 10) / 2;  // uniform in (-1/2, 1/2), and normal
    u1 += u, u2 += u * u, z1 += z, z2 += z * z, z3 += z * z * z, both += u * z;
  }
  // Five standard deviations of each mean: of u and its square 1/12 and 1/180, of z and its powers 1, 2 and 15, of
  // u z 1/12.
  const double m = n;
  CHECK(std::abs(u1 / m) < 5 * std::sqrt(1 / (12 * m)));
  CHECK(std::abs(u2 / m - 1.0 / 12) < 5 * std::sqrt(1 / (180 * m)));
  CHECK(std::abs(z1 / m) < 5 * std::sqrt(1 / m));
  CHECK(std::abs(z2 / m - 1) < 5 * std::sqrt(2 / m));
  CHECK(std::abs(z3 / m) < 5 * std::sqrt(15 / m));
  CHECK(std::abs(both / m) < 5 * std::sqrt(1 / (12 * m)));
}

TEST_CASE("values go into a scene as it has them: quantities in its units, whole numbers as such", "[ensemble]") {
  const SceneValue scene =
      parse_toml("seed = 3\nx = 1.5\n[t]\na = \"1.5 au\"\n[[body]]\nname = \"b.1\"\ne = 0\n", "scene");
  const auto sets = [&](const std::string& variation, double value) {
    return VariedKeys(scene, {Variation::parse(variation)}).sets({value})[0];
  };
  CHECK(sets("seed=1:4:4", 4) == "seed=4");
  CHECK(sets("x=1:4:4", 0.1) == "x=0.1");
  CHECK(sets("t.a=1:4:4", 0.1) == "t.a=\"0.1 au\"");
  CHECK(sets("t.a=1:4:4 km", 2.5) == "t.a=\"2.5 km\"");
  CHECK(sets("t.b=normal(1,2) deg", 2.5) == "t.b=\"2.5 deg\"");  // a key that the scene leaves to its default
  CHECK(sets("body.\"b.1\".e=0:1:3", 0.5) == "body.\"b.1\".e=0.5");
  CHECK(refusal_of([&] { sets("t=1:4:4", 1); }) ==
        "--vary t=1:4:4: t = {a = \"1.5 au\"} is a table, which cannot vary; a number is expected");
}

TEST_CASE("what cannot vary is refused in a line", "[ensemble]") {
  const auto refusal = [](const std::string& text) { return refusal_of([&] { Variation::parse(text); }); };
  CHECK(refusal("a") ==
        "--vary a: expected KEY=a:b:n, KEY=uniform(a,b) or KEY=normal(m,s), such as particles.body.b.e=0:0.4:64");
  CHECK(refusal("a=3") ==
        "--vary a=3: '3' is neither a grid a:b:n nor uniform(a,b) or normal(m,s); for one value use --set");
  CHECK(refusal("a=1:2") == "--vary a=1:2: a grid has a number of points; give 1:2:64, say, for 64 of them");
  CHECK(refusal("a=1:2:0") == "--vary a=1:2:0: a grid of 0 points has no ends; give at least 2, or one value by --set");
  CHECK(refusal("a=1:2:1") == "--vary a=1:2:1: a grid of 1 point has no ends; give at least 2, or one value by --set");
  CHECK(refusal("a=1:2:x") ==
        "--vary a=1:2:x: 'x' is not a number of points; a whole number of at least 2 is expected");
  CHECK(refusal("a=1:inf:3") == "--vary a=1:inf:3: 'inf' is not a number; a finite one is expected");
  CHECK(refusal("a=1:2:99999999999999999999") ==
        "--vary a=1:2:99999999999999999999: 99999999999999999999 points are too many; at most 1000000000 members are "
        "possible");
  CHECK(refusal("a=unifrom(1,2)") ==
        "--vary a=unifrom(1,2): there is no distribution 'unifrom'; did you mean 'uniform'?");
  CHECK(refusal("a=uniform(1)") == "--vary a=uniform(1): uniform has two numbers: uniform(a,b), from a to b");
  CHECK(refusal("a=uniform(2,2)") ==
        "--vary a=uniform(2,2): the range from 2 to 2 is empty; the first number must be below the second");
  CHECK(refusal("a=normal(1,-2)") ==
        "--vary a=normal(1,-2): -2 is not a valid standard deviation; a number above 0 is expected");
  const auto plan = [](const std::vector<std::string>& texts, std::optional<std::int64_t> draws, std::int64_t seed) {
    return refusal_of([&] { plan_of(texts, draws, seed); });
  };
  CHECK(plan({}, {}, 0) == "nothing varies; give --vary KEY=a:b:n at least once");
  CHECK(plan({"a=1:2:3", "a=normal(1,2)"}, 3, 0) == "'a' varies twice; give --vary a once");
  CHECK(plan({"a=normal(1,2)"}, {}, 0) ==
        "values are drawn at random, and nothing says for how many members; give --members N");
  CHECK(plan({"a=normal(1,2)"}, 0, 0) == "--members 0 is not a valid number of members; 1 or more are expected");
  CHECK(plan({"a=1:2:3"}, 4, 0) ==
        "--members 4 is the number of draws, but nothing is drawn: the grids have 3 members; take it out");
  CHECK(plan({"a=1:2:1000000", "b=1:2:1000000"}, {}, 0) ==
        "the ensemble has more than 1000000000 members, which are the most that are possible; take fewer");
  CHECK(plan({"a=normal(1,2)"}, 3, -1) == "--seed -1 is not valid; a whole number of 0 or more is expected");
}

}  // namespace
}  // namespace noether::test
