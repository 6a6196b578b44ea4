/// A number that is not finite is found wherever it stands, at every SIMD level.

#include "engine/finite_simd.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/settings.hpp"

#include <limits>
#include <utility>
#include <vector>

namespace noether::test {
namespace {

TEST_CASE("a number that is not finite is found in every place", "[finite]") {
  const double infinity = std::numeric_limits<double>::infinity();
  const double largest = std::numeric_limits<double>::max();
  for (const SimdLevel level : all_levels()) {
    const AtLevel at(level);
    CAPTURE(name(level));
    CHECK(finite_kernels().all(nullptr, nullptr, 0));
    for (const std::size_t count : {8U, 24U, 48U}) {
      std::vector<double> numbers(count, largest);
      for (std::size_t k = 0; k < count; k += 2) numbers[k] = -largest;
      const std::vector<double> others = numbers;
      const auto all = [&] {
        const auto size = static_cast<std::ptrdiff_t>(count);
        const bool first = finite_kernels().all(numbers.data(), others.data(), size);
        CHECK(finite_kernels().all(others.data(), numbers.data(), size) == first);
        return first;
      };
      CHECK(all());
      for (std::size_t k = 0; k < count; ++k) {
        for (const double bad : {infinity, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
          const double good = std::exchange(numbers[k], bad);
          CHECK_FALSE(all());
          numbers[k] = good;
        }
      }
    }
  }
}

}  // namespace
}  // namespace noether::test
