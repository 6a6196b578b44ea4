#include "numbers/dual.hpp"
#include "tests/support/catch.hpp"

#include <functional>
#include <string>
#include <vector>

namespace noether {
namespace {

using One = Dual<Quad, 1>;

struct Function {
  std::string name;
  std::function<Quad(Quad)> of_number;
  std::function<One(One)> of_dual;
};

#define NOETHER_FUNCTION(expression)                                                 \
  Function {                                                                         \
#expression, [](Quad x) { return expression; }, [](One x) { return expression; } \
  }

TEST_CASE("dual numbers carry the derivative of every function", "[dual]") {
  const std::vector<Function> functions = {
      NOETHER_FUNCTION(x + x * x - Quad(2)),
      NOETHER_FUNCTION((Quad(1) - x) / (Quad(2) + x)),
      NOETHER_FUNCTION(-x * (+x)),
      NOETHER_FUNCTION(sqrt(x)),
      NOETHER_FUNCTION(sin(x)),
      NOETHER_FUNCTION(cos(x * x)),
      NOETHER_FUNCTION(tan(x)),
      NOETHER_FUNCTION(acos(x / Quad(2))),
      NOETHER_FUNCTION(atan2(x, Quad(1) + x * x)),
      NOETHER_FUNCTION(exp(-x)),
      NOETHER_FUNCTION(log(x)),
      NOETHER_FUNCTION(sinh(x)),
      NOETHER_FUNCTION(cosh(x)),
      NOETHER_FUNCTION(pow(x, Quad(1.5))),
      NOETHER_FUNCTION(abs(-x) * abs(x)),
  };
  for (const Function& f : functions) {
    for (const double at : {0.3, 0.7, 1.1}) {
      INFO(f.name << " at " << at);
      const Quad x(at), h(1e-9);
      const One y = f.of_dual(One::variable(x, 0));
      CHECK(y.value == f.of_number(x));
      const Quad slope = (f.of_number(x + h) - f.of_number(x - h)) / (Quad(2) * h);
      CHECK(std::fabs(static_cast<double>(slope - y.slope[0])) < 1e-15);
    }
  }
}

TEST_CASE("dual numbers compare by value, take constants and steps in place, and nest for second derivatives",
          "[dual]") {
  using Two = Dual<double, 2>;
  Two x = Two::variable(3, 0);
  const Two y = Two::variable(2, 1);
  CHECK(x > y);
  CHECK(y <= x);
  CHECK(x == Two(3));
  CHECK(x >= 1);
  CHECK(y < 2.5);
  x += y;
  x *= 2;
  x -= 1;
  x /= y;  // (2 (x + y) - 1) / y
  CHECK(x.value == 4.5);
  CHECK(x.slope[0] == 1);
  CHECK(x.slope[1] == -1.25);
  CHECK(isfinite(x));
  using Nested = Dual<Dual<double, 1>, 1>;
  Nested z(Dual<double, 1>::variable(0.5, 0));
  z.slope[0] = 1.0;
  const Nested w = sin(z) * exp(z);
  CHECK(std::fabs(w.slope[0].slope[0] - 2 * std::cos(0.5) * std::exp(0.5)) < 1e-15);
}

}  // namespace
}  // namespace noether
