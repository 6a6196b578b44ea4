#include "integrators/systems/weber.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace noether {

namespace {
Vec3<double> vector_of(const std::vector<double>& all, std::size_t i) {
  return {all[3 * i], all[3 * i + 1], all[3 * i + 2]};
}
}  // namespace

void Weber::check() const {
  const std::size_t n = masses.size();
  const auto long_enough = [&](std::string_view key, std::size_t found, std::size_t expected) {
    if (found == expected) return;
    refuse_field(key, fmt::format("a list of {}", found),
                 fmt::format("does not fit {} masses; {} numbers are expected", n, expected));
  };
  if (n < 2) refuse_field("masses", fmt::format("a list of {}", n), "is too short; two charges or more are expected");
  long_enough("charges", charges.size(), n);
  long_enough("positions", positions.size(), 3 * n);
  long_enough("velocities", velocities.size(), 3 * n);
  for (const double m : masses) {
    if (!(m > 0 && std::isfinite(m))) refuse_field("masses", m, "is not a valid mass; a mass above 0 is expected");
  }
  if (!(c > 0 && std::isfinite(c))) refuse_field("c", c, "is not a valid speed of light; one above 0 is expected");
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!std::equal(&positions[3 * i], &positions[3 * i] + 3, &positions[3 * j])) continue;
      refuse_field("positions", fmt::format("that of charge {}", i + 1),
                   fmt::format("is that of charge {} too; put them at two places", j + 1));
    }
  }
}

std::vector<double> Weber::start() const {
  std::vector<double> state = positions;
  const std::size_t n = masses.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t d = 3 * i; d < 3 * i + 3; ++d) state.push_back(masses[i] * velocities[d]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3<double> x = vector_of(positions, i) - vector_of(positions, j),
                         v = vector_of(velocities, i) - vector_of(velocities, j);
      const double r = std::sqrt(norm2(x));
      // p = m v - (k e e' r'/(c^2 r)) times the direction
      const double factor = k * charges[i] * charges[j] * dot(x, v) / (c * c * r * r * r);
      for (std::size_t d = 0; d < 3; ++d) {
        state[3 * n + 3 * i + d] -= factor * x[static_cast<int>(d)];
        state[3 * n + 3 * j + d] += factor * x[static_cast<int>(d)];
      }
    }
  }
  return state;
}

std::vector<std::string> Weber::names() const {
  std::vector<std::string> all;
  for (const char* kind : {"", "p_"}) {
    for (std::size_t i = 1; i <= masses.size(); ++i) {
      for (const char* axis : {"x", "y", "z"}) all.push_back(fmt::format("{}{}_{}", kind, axis, i));
    }
  }
  return all;
}

template class LagrangianMotion<Weber, double>;
template class LagrangianMotion<Weber, Quad>;

}  // namespace noether
