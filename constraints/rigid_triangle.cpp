#include "constraints/rigid_triangle.hpp"

#include <cmath>

namespace noether {

void put_triangle(RigidTriangles& all, int lane, const std::array<double, 3>& inverse_masses,
                  const std::array<double, 3>& lengths2) {
  const auto [w0, w1, w2] = inverse_masses;
  const double c11 = lengths2[0], c22 = lengths2[1], c12 = (lengths2[0] + lengths2[1] - lengths2[2]) / 2;
  for (int k = 0; k < 3; ++k) all.inverse_mass[k] = inverse_masses[static_cast<std::size_t>(k)];
  all.c11[lane] = c11, all.c12[lane] = c12, all.c22[lane] = c22, all.inverse_c11[lane] = 1 / c11;
  // Bonds r1 = x1 - x0, r2 = x2 - x0, r3 = x2 - x1 = r2 - r1.
  const double a11 = (w0 + w1) * c11, a22 = (w0 + w2) * c22, a33 = (w1 + w2) * lengths2[2], a12 = w0 * c12;
  const double a13 = w1 * (c11 - c12), a23 = w2 * (c22 - c12);
  const double det = a11 * (a22 * a33 - a23 * a23) - a12 * (a12 * a33 - a23 * a13) + a13 * (a12 * a23 - a22 * a13);
  const double inverse[] = {a22 * a33 - a23 * a23, a13 * a23 - a12 * a33, a12 * a23 - a13 * a22,
                            a11 * a33 - a13 * a13, a12 * a13 - a11 * a23, a11 * a22 - a12 * a12};
  for (int k = 0; k < 6; ++k) all.inverse[k][lane] = inverse[k] / det;
  const double m1 = 1 / w1, m2 = 1 / w2, mass = 1 / w0 + m1 + m2, height = std::sqrt(c11 - lengths2[2] / 4);
  const double apex = 2 * m1 / mass * height;
  all.part1 = m1 / mass, all.part2 = m2 / mass;
  all.apex[lane] = apex, all.inverse_apex[lane] = 1 / apex, all.base[lane] = height - apex;
  all.half_base[lane] = std::sqrt(lengths2[2]) / 2;
}

}  // namespace noether
