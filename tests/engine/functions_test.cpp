/// The functions that code over the number type may use are there in every number type.

#include "numbers/dual.hpp"
#include "numbers/pack.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace noether {
namespace {

using One = Dual<double, 1>;
using Lanes = Dual<Pack, 1>;

struct Function {
  std::string name;
  std::function<double(double)> of_double;
  std::function<Quad(Quad)> of_quad;
  std::function<Pack(Pack)> of_pack;
  std::function<One(One)> of_dual;
  std::function<Lanes(Lanes)> of_lanes;
};

using std::sqrt, std::cbrt, std::sin, std::cos, std::tan, std::asin, std::acos, std::atan, std::atan2, std::sinh,
    std::cosh, std::tanh, std::asinh, std::acosh, std::atanh, std::exp, std::expm1, std::log, std::log1p, std::erf,
    std::erfc, std::pow, std::hypot, std::fmod, std::abs, std::fabs, std::min, std::max, std::floor, std::ceil,
    std::round;

#define NOETHER_OF(Type, expression) \
  [](Type x) {                       \
    using R [[maybe_unused]] = Type; \
    return Type(expression);         \
  }
#define NOETHER_IN_EVERY_TYPE(...)                                                                                     \
  Function {                                                                                                           \
#__VA_ARGS__, NOETHER_OF(double, (__VA_ARGS__)), NOETHER_OF(Quad, (__VA_ARGS__)), NOETHER_OF(Pack, (__VA_ARGS__)), \
        NOETHER_OF(One, (__VA_ARGS__)), NOETHER_OF(Lanes, (__VA_ARGS__))                                               \
  }

const std::vector<Function>& functions() {
  static const std::vector<Function> all = {
      NOETHER_IN_EVERY_TYPE(sqrt(x)),
      NOETHER_IN_EVERY_TYPE(cbrt(x)),
      NOETHER_IN_EVERY_TYPE(sin(x)),
      NOETHER_IN_EVERY_TYPE(cos(x)),
      NOETHER_IN_EVERY_TYPE(tan(x)),
      NOETHER_IN_EVERY_TYPE(asin(x)),
      NOETHER_IN_EVERY_TYPE(acos(x)),
      NOETHER_IN_EVERY_TYPE(atan(x)),
      NOETHER_IN_EVERY_TYPE(atan2(x, R(2) + x)),
      NOETHER_IN_EVERY_TYPE(sinh(x)),
      NOETHER_IN_EVERY_TYPE(cosh(x)),
      NOETHER_IN_EVERY_TYPE(tanh(x)),
      NOETHER_IN_EVERY_TYPE(asinh(x)),
      NOETHER_IN_EVERY_TYPE(acosh(R(1) + x)),
      NOETHER_IN_EVERY_TYPE(atanh(x)),
      NOETHER_IN_EVERY_TYPE(exp(x)),
      NOETHER_IN_EVERY_TYPE(expm1(x)),
      NOETHER_IN_EVERY_TYPE(log(x)),
      NOETHER_IN_EVERY_TYPE(log1p(x)),
      NOETHER_IN_EVERY_TYPE(erf(x)),
      NOETHER_IN_EVERY_TYPE(erfc(x)),
      NOETHER_IN_EVERY_TYPE(pow(x, 1.5)),
      NOETHER_IN_EVERY_TYPE(pow(x, 3)),
      NOETHER_IN_EVERY_TYPE(pow(x, R(2) * x)),
      NOETHER_IN_EVERY_TYPE(hypot(x, R(2) * x + R(1))),
      NOETHER_IN_EVERY_TYPE(fmod(R(7) * x, R(2))),
      NOETHER_IN_EVERY_TYPE(abs(R(0.5) - x)),
      NOETHER_IN_EVERY_TYPE(fabs(R(0.5) - x)),
      NOETHER_IN_EVERY_TYPE(min(x, R(0.5))),
      NOETHER_IN_EVERY_TYPE(max(x, R(0.5))),
      NOETHER_IN_EVERY_TYPE(floor(R(7) * x)),
      NOETHER_IN_EVERY_TYPE(ceil(R(7) * x)),
      NOETHER_IN_EVERY_TYPE(round(R(7) * x)),
      NOETHER_IN_EVERY_TYPE(noether::select(x < R(0.5), x * x, R(1) - x)),
      NOETHER_IN_EVERY_TYPE(noether::select(!(x < R(0.4)) && x < R(0.6), x, -x)),
  };
  return all;
}

constexpr double places[Pack::lanes] = {0.05, 0.13, 0.31, 0.45, 0.55, 0.62, 0.77, 0.93};

TEST_CASE("every function gives in lanes the bits of double, and in 113 bits the same number", "[numbers]") {
  for (const Function& f : functions()) {
    INFO(f.name);
    const Pack packed = f.of_pack(Pack::load(places));
    for (std::size_t k = 0; k < Pack::lanes; ++k) {
      const double value = f.of_double(places[k]);
      CHECK(packed.lane[k] == value);
      const auto exact = static_cast<double>(f.of_quad(Quad(places[k])));
      CHECK(std::abs(value - exact) <= 4e-15 * std::abs(exact));
    }
  }
}

TEST_CASE("every function has its derivative as a dual number, in lanes too", "[numbers][dual]") {
  for (const Function& f : functions()) {
    INFO(f.name);
    const Lanes slopes = f.of_lanes(Lanes::variable(Pack::load(places), 0));
    for (std::size_t k = 0; k < Pack::lanes; ++k) {
      const One at = f.of_dual(One::variable(places[k], 0));
      CHECK(slopes.value.lane[k] == at.value);
      CHECK(slopes.slope[0].lane[k] == at.slope[0]);
      const Quad x(places[k]), h(1e-10);
      const auto difference = static_cast<double>((f.of_quad(x + h) - f.of_quad(x - h)) / (h + h));
      CHECK(std::abs(at.slope[0] - difference) <= 1e-12 * std::abs(difference) + 1e-13);
    }
  }
}

TEST_CASE("a condition in lanes is a bool where all lanes agree, and no guess where they differ", "[numbers]") {
  const Pack x = Pack::load(places);
  CHECK(bool(x > 0));
  CHECK_FALSE(bool(x > 1));
  CHECK_THROWS_AS(bool(x > 0.5), LanesDiffer);
  CHECK_THROWS_AS(bool(!(x > 0.5)), LanesDiffer);
  CHECK(any(x > 0.5));
  CHECK_FALSE(all(x > 0.5));
  CHECK(bool(x > 0.5 || x <= 0.5));
  CHECK_FALSE(bool(x > 0.5 && x <= 0.5));
  CHECK(bool(x == x));
  CHECK_FALSE(bool(x != x));
  CHECK(all(isfinite(x)));
  CHECK_THROWS_AS(bool(isnan(sqrt(x - Pack(0.5)))), LanesDiffer);
  CHECK(any(isnan(sqrt(x - Pack(0.5)))));
}

}  // namespace
}  // namespace noether
