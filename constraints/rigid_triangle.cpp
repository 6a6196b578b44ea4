#include "constraints/rigid_triangle.hpp"

#include <cmath>

namespace noether {

RigidTriangle rigid_triangle(const std::array<double, 3>& inverse_masses, const std::array<double, 3>& lengths2) {
  const auto [w0, w1, w2] = inverse_masses;
  RigidTriangle t{};
  for (int k = 0; k < 3; ++k) t.inverse_mass[k] = inverse_masses[static_cast<std::size_t>(k)];
  t.c11 = lengths2[0], t.c22 = lengths2[1], t.c12 = (lengths2[0] + lengths2[1] - lengths2[2]) / 2;
  // Bonds r1 = x1 - x0, r2 = x2 - x0, r3 = x2 - x1 = r2 - r1.
  const double a11 = (w0 + w1) * t.c11, a22 = (w0 + w2) * t.c22, a33 = (w1 + w2) * lengths2[2], a12 = w0 * t.c12;
  const double a13 = w1 * (t.c11 - t.c12), a23 = w2 * (t.c22 - t.c12);
  const double det = a11 * (a22 * a33 - a23 * a23) - a12 * (a12 * a33 - a23 * a13) + a13 * (a12 * a23 - a22 * a13);
  const double inverse[] = {a22 * a33 - a23 * a23, a13 * a23 - a12 * a33, a12 * a23 - a13 * a22,
                            a11 * a33 - a13 * a13, a12 * a13 - a11 * a23, a11 * a22 - a12 * a12};
  for (int k = 0; k < 6; ++k) t.inverse[k] = inverse[k] / det;
  const double m1 = 1 / w1, m2 = 1 / w2, all = 1 / w0 + m1 + m2, height = std::sqrt(t.c11 - lengths2[2] / 4);
  t.part1 = m1 / all, t.part2 = m2 / all;
  t.apex = 2 * m1 / all * height;
  t.base = height - t.apex;
  t.half_base = std::sqrt(lengths2[2]) / 2;
  t.isosceles = w1 == w2 && lengths2[0] == lengths2[1];
  return t;
}

}  // namespace noether
