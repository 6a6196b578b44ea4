/// Sums and products of two doubles against 113 bits, which hold every product of two doubles exactly.

#include "numbers/double_double.hpp"

#include "tests/support/catch.hpp"

#include <cmath>

namespace noether::test {
namespace {

/// Numbers of all sizes from 2^-30 to 2^30 and both signs.
class Numbers {
 public:
  double next() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    const double part = static_cast<double>(static_cast<std::int64_t>(state_) >> 11) * 0x1p-52;
    return std::ldexp(part, static_cast<int>((state_ >> 5U) % 61) - 30);
  }

 private:
  std::uint64_t state_ = 1;
};

TEST_CASE("a product of doubles loses nothing", "[double_double]") {
  Numbers numbers;
  for (int n = 0; n < 10000; ++n) {
    const double a = numbers.next(), b = numbers.next();
    const DoubleDouble p = DoubleDouble::product(a, b);
    REQUIRE(p.high == a * b);
    REQUIRE(Quad(p) == Quad(a) * Quad(b));
    const DoubleDouble large = DoubleDouble::product(a * 0x1p960, b);
    REQUIRE(Quad(large) == Quad(a * 0x1p960) * Quad(b));
  }
}

TEST_CASE("sums of two doubles are right to 2^-104 of the larger one, products with a double to 2^-104",
          "[double_double]") {
  Numbers numbers;
  const auto one = [&] {
    const double high = numbers.next();
    return DoubleDouble::ordered_sum(high, high * numbers.next() * 0x1p-84);
  };
  for (int n = 0; n < 10000; ++n) {
    const DoubleDouble a = one(), b = one();
    const double c = numbers.next();
    const Quad bound = Quad(0x1p-104);
    REQUIRE(abs(Quad(a + b) - (Quad(a) + Quad(b))) <= bound * (abs(Quad(a)) + abs(Quad(b))));
    REQUIRE(abs(Quad(a - b) - (Quad(a) - Quad(b))) <= bound * (abs(Quad(a)) + abs(Quad(b))));
    REQUIRE(abs(Quad(c * a) - Quad(c) * Quad(a)) <= bound * abs(Quad(c) * Quad(a)));
    REQUIRE(std::abs((a + b).low) <= 0x1p-53 * std::abs((a + b).high));
  }
}

TEST_CASE("products, quotients and roots are right to 2^-101 of themselves", "[double_double]") {
  Numbers numbers;
  const auto one = [&] {
    const double high = numbers.next();
    return DoubleDouble::ordered_sum(high, high * numbers.next() * 0x1p-84);
  };
  const Quad bound = Quad(0x1p-101);
  for (int n = 0; n < 10000; ++n) {
    const DoubleDouble a = one(), b = one();
    REQUIRE(abs(Quad(a * b) - Quad(a) * Quad(b)) <= bound * abs(Quad(a) * Quad(b)));
    REQUIRE(abs(Quad(a / b) - Quad(a) / Quad(b)) <= bound * abs(Quad(a) / Quad(b)));
    const Quad root = sqrt(Quad(abs(a)));
    REQUIRE(abs(Quad(sqrt(abs(a))) - root) <= bound * root);
    REQUIRE(std::abs((a / b).low) <= 0x1p-53 * std::abs((a / b).high));
    REQUIRE(Quad(floor(1e20 * a)) == floor(Quad(1e20 * a)));
    REQUIRE(Quad(floor(a)) == floor(Quad(a)));
  }
}

TEST_CASE("of what is no ordinary number, double-doubles make what doubles do", "[double_double]") {
  const double infinite = std::numeric_limits<double>::infinity();
  CHECK(sqrt(DoubleDouble(0.0)) == DoubleDouble(0.0));
  CHECK(sqrt(DoubleDouble(infinite)).high == infinite);
  CHECK(std::isnan(sqrt(DoubleDouble(-1.0)).high));
  CHECK((DoubleDouble(1.0) / DoubleDouble(0.0)).high == infinite);
  CHECK((DoubleDouble(1.0) / DoubleDouble(infinite)) == DoubleDouble(0.0));
  CHECK(std::isnan((DoubleDouble(0.0) / DoubleDouble(0.0)).high));
  CHECK_FALSE(isfinite(DoubleDouble(infinite)));
}

TEST_CASE("double-doubles are ordered by both words", "[double_double]") {
  const DoubleDouble below(1, -0x1p-80), one(1.0), above(1, 0x1p-80);
  CHECK((below < one && one < above && above > below));
  CHECK((one <= one && one >= one && !(one < one)));
  CHECK((below != one && one == DoubleDouble(1, 0)));
  CHECK(abs(DoubleDouble(-1, 0x1p-80)) == DoubleDouble(1, -0x1p-80));
}

TEST_CASE("what two numbers have in common cancels to the last bit", "[double_double]") {
  const DoubleDouble a(1, 0x1p-80), b(1, -0x1p-70);
  CHECK(static_cast<double>(a - b) == 0x1p-80 + 0x1p-70);
  CHECK(static_cast<double>(DoubleDouble(Quad(1) / Quad(3)) - DoubleDouble(1.0 / 3)) ==
        static_cast<double>(Quad(1) / Quad(3) - Quad(1.0 / 3)));
}

}  // namespace
}  // namespace noether::test
