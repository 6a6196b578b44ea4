/// The 113-bit number type: literals, functions, text, and its exact form as doubles.

#include "numbers/real.hpp"

#include "numbers/types.hpp"
#include "tests/support/catch.hpp"

#include <stdexcept>

namespace noether {
namespace {

constexpr Quad pi = 3.14159265358979323846264338327950288419716939937510_q;
const Quad ulp = std::numeric_limits<Quad>::epsilon();

bool within(const Quad& x, const Quad& expected, int ulps) {
  return abs(x - expected) <= Quad(ulps) * ulp * abs(expected);
}

}  // namespace

TEST_CASE("a literal keeps all its digits, at compile time", "[real]") {
  static_assert(0.1_q != Quad(0.1));
  static_assert(0.5_q == Quad(0.5));
  static_assert(1'000.25_q == Quad(1000.25));
  CHECK(abs(0.1_q * Quad(10) - Quad(1)) <= ulp);
  CHECK(0.1_q == parse_quad("0.1"));
  CHECK(within(pi, parse_quad("3.14159265358979323846264338327950288419716939937510"), 1));
  CHECK(within(0.0380944974224121954569753223086375653406_q, parse_quad("0.0380944974224121954569753223086375653406"),
               1));
}

TEST_CASE("arithmetic has 113 bits", "[real]") {
  CHECK(Quad(1) + ulp != Quad(1));
  CHECK(Quad(1) + ulp / Quad(2) == Quad(1));
  CHECK(Quad(1) / Quad(3) * Quad(3) == Quad(1));
  CHECK(std::numeric_limits<Quad>::digits == 113);
  CHECK(std::numeric_limits<Quad>::max() < std::numeric_limits<Quad>::infinity());
  CHECK(std::numeric_limits<Quad>::min() > Quad(0));
  CHECK(std::numeric_limits<Quad>::denorm_min() > Quad(0));
  CHECK(std::numeric_limits<Quad>::denorm_min() / Quad(2) == Quad(0));
}

TEST_CASE("functions are right to a few units in the last place of a Quad", "[real]") {
  const Quad third = Quad(1) / Quad(3);
  CHECK(within(sqrt(Quad(2)) * sqrt(Quad(2)), Quad(2), 2));
  CHECK(within(cbrt(Quad(27)), Quad(3), 1));
  CHECK(within(sin(pi / Quad(6)), Quad(1) / Quad(2), 4));
  CHECK(within(cos(pi / Quad(3)), Quad(1) / Quad(2), 4));
  CHECK(within(tan(pi / Quad(4)), Quad(1), 4));
  CHECK(within(atan2(Quad(1), Quad(-1)), Quad(3) * pi / Quad(4), 2));
  CHECK(within(acos(Quad(-1)), pi, 1));
  CHECK(within(exp(log(Quad(7))), Quad(7), 4));
  CHECK(within(expm1(third), exp(third) - Quad(1), 8));
  CHECK(within(log1p(third), log(Quad(4) / Quad(3)), 8));
  CHECK(within(sinh(asinh(third)), third, 4));
  CHECK(within(cosh(acosh(Quad(2))), Quad(2), 4));
  CHECK(within(pow(Quad(2), Quad(0.5)), sqrt(Quad(2)), 2));
  CHECK(floor(Quad(-1.5)) == Quad(-2));
  CHECK(round(Quad(2.5)) == Quad(3));
  CHECK(abs(Quad(-2)) == Quad(2));
}

TEST_CASE("what is not a number or not finite is known", "[real]") {
  const Quad infinity = std::numeric_limits<Quad>::infinity(), nan = std::numeric_limits<Quad>::quiet_NaN();
  CHECK(isfinite(Quad(1e300)));
  CHECK_FALSE(isfinite(infinity));
  CHECK_FALSE(isfinite(-infinity));
  CHECK_FALSE(isfinite(nan));
  CHECK(isnan(nan));
  CHECK_FALSE(isnan(infinity));
  CHECK(nan != nan);
}

TEST_CASE("text reads back to the same number", "[real]") {
  for (const Quad& x : {pi, -pi / Quad(1e30), Quad(1) / Quad(3), Quad(0), std::numeric_limits<Quad>::max(),
                        std::numeric_limits<Quad>::min()}) {
    CHECK(parse_quad(to_string(x)) == x);
  }
  CHECK(to_string(Quad(1) / Quad(3)) == "3.33333333333333333333333333333333317e-01");
  CHECK_THROWS_AS(parse_quad("1.5x"), std::invalid_argument);
  CHECK_THROWS_WITH(parse_quad(""), "'' is not a number");
}

TEST_CASE("three doubles hold a Quad exactly", "[real]") {
  for (const Quad& x :
       {pi, -pi, Quad(1) / Quad(3), Quad(1) + ulp, Quad(0), Quad(1e-200), sqrt(Quad(2)) * Quad(1e200)}) {
    CHECK(from_doubles(to_doubles(x)) == x);
  }
  CHECK(to_doubles(pi)[1] != 0);
}

TEST_CASE("vectors of Quad add, multiply and cross in full precision", "[real]") {
  const Vec3<Quad> a(Quad(1), ulp, Quad(0)), b(Quad(1), Quad(0), Quad(1));
  CHECK(dot(a, b) == Quad(1));
  CHECK(dot(a + b, b) == Quad(3));
  CHECK(norm2(a) == Quad(1) + ulp * ulp);
  CHECK((cross(a, b) == Vec3<Quad>(ulp, Quad(-1), -ulp)));
}

TEST_CASE("doubles widen exactly and round once on the way back", "[real]") {
  CHECK(static_cast<double>(Quad(0.1)) == 0.1);
  CHECK(static_cast<double>(Quad(1) + ulp) == 1.0);
  CHECK(static_cast<double>(pi) == 3.141592653589793);
  CHECK(Quad(2) * 0.5 == Quad(1));
}

}  // namespace noether
