/// Rotations turn in lanes as each alone, to the bit, at every SIMD level.

#include "integrators/lie/group_system.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/settings.hpp"

#include <random>

namespace noether {
namespace {

/// Rotations alone; only how its group acts is asked for.
struct ManyRotations {
  Index count;
  Index rotations() const { return count; }
  Index motions() const { return 0; }
  Index numbers() const { return 2; }
  Index size() const { return 4 * count + 2; }
  template <class Real> void velocity(const Real& /*t*/, const Vector<Real>& /*y*/, Vector<Real>& a) const {
    a.setZero();
  }
};

}  // namespace

TEST_CASE("rotations are moved in lanes as each alone", "[lie][lanes]") {
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    for (const Index n : {1, 8, 13, 64, 100}) {
      GroupSystemMotion<ManyRotations, double> field(ManyRotations{n});
      Vector<double> y(4 * n + 2), u(3 * n + 2), out;
      for (Index i = 0; i < n; ++i) {
        Quaternion<double> q(normal(generator), normal(generator), normal(generator), normal(generator));
        y.segment(4 * i, 4) = q / q.norm();
        // Every third block of eight has one that turns far, and some do not turn at all.
        const double size = i % 24 == 5 ? 4 : i % 7 == 3 ? 0 : 0.2;
        for (Index k = 0; k < 3; ++k) u[3 * i + k] = size * normal(generator);
      }
      y.tail(2) << 1, 2;
      u.tail(2) << 0.5, 0.25;
      field.act(u, y, out);
      for (Index i = 0; i < n; ++i) {
        CAPTURE(n, i);
        const Quaternion<double> by = rotation_by<double>(triple_at<double>(u, 3 * i));
        const Quaternion<double> alone =
            renormalized<double>(quaternion_product<double>(quaternion_at<double>(y, 4 * i), by));
        CHECK(quaternion_at<double>(out, 4 * i) == alone);
      }
      CHECK((out[4 * n] == 1.5 && out[4 * n + 1] == 2.25));
    }
  }
}

}  // namespace noether
