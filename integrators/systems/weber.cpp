#include "integrators/systems/weber.hpp"

namespace noether {

std::vector<double> Weber::start() const {
  std::vector<double> state = positions;
  const std::size_t n = masses.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t d = 3 * i; d < 3 * i + 3; ++d) state.push_back(masses[i] * velocities[d]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3<double> x = of_charge(positions, i) - of_charge(positions, j),
                         v = of_charge(velocities, i) - of_charge(velocities, j);
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

template class LagrangianMotion<Weber, double>;
template class LagrangianMotion<Weber, Quad>;

}  // namespace noether
