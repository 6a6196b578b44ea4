#pragma once
/// The images of a pair of particles in a periodic box.

#include "engine/particle_system.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace noether::detail {

/// Calls `act(d, nearest)` for the images of a pair that can be in range, with whether it is the nearest one; of a
/// particle with itself for those of its copies.
template <class Real, class Act>
void for_images(const ParticleSystem<Real>& s, Index i, Index j, double range, const Act& act) {
  const Box& box = s.box();
  const Vec3<Real> near = box.minimum_image(Vec3<Real>(s.positions()[i] - s.positions()[j]));
  std::array<int, 3> most{};  // beyond the nearest image
  for (int k = 0; k < 3 && box.is_periodic(); ++k) {
    most[static_cast<std::size_t>(k)] = static_cast<int>(std::max(0.0, std::ceil(range / box.edges()[k] - 0.5)));
  }
  for (int c = -most[2]; c <= most[2]; ++c) {
    for (int b = -most[1]; b <= most[1]; ++b) {
      for (int a = -most[0]; a <= most[0]; ++a) {
        if (i == j && a == 0 && b == 0 && c == 0) continue;
        Vec3<Real> d = near;
        if (a != 0) d[0] += Real(a * box.edges()[0]);
        if (b != 0) d[1] += Real(b * box.edges()[1]);
        if (c != 0) d[2] += Real(c * box.edges()[2]);
        act(d, a == 0 && b == 0 && c == 0);
      }
    }
  }
}

/// Whether particles can feel each other's images beyond the nearest one.
inline bool feels_far_images(const Box& box, double range) {
  if (!box.is_periodic()) return false;
  return std::any_of(box.edges().data(), box.edges().data() + 3, [&](double edge) { return edge < 2 * range; });
}

}  // namespace noether::detail
