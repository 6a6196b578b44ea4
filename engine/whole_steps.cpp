#include "engine/whole_steps.hpp"

#include "numbers/error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace noether::detail {

std::int64_t whole_steps(double duration, double dt) {
  const double exact = duration / dt;
  const double whole = std::round(exact);
  if (!std::isfinite(exact) || std::abs(exact) > 9e15) {
    throw Error(fmt::format("a duration of {} is no number of steps of {}", duration, dt));
  }
  if (exact < 0) throw Error(fmt::format("a duration of {} lies behind; steps of {} lead the other way", duration, dt));
  // Beside 1e-9 of a step, the rounding of a long duration.
  if (std::abs(exact - whole) > 1e-9 + 16 * std::numeric_limits<double>::epsilon() * exact) {
    throw Error(fmt::format("a duration of {} is {} steps of {}; the nearest whole numbers are {} ({}) and {} ({})",
                            duration, exact, dt, std::floor(exact) * dt, std::floor(exact), std::ceil(exact) * dt,
                            std::ceil(exact)));
  }
  return static_cast<std::int64_t>(whole);
}

}  // namespace noether::detail
