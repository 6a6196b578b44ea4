/// What steps on groups cost: 64 heavy tops by RK4 of Munthe-Kaas, of rotations, over RK4 on the nine numbers of their
/// matrices, which drift from rotations.
///
/// Protocol: slices of 2000 steps of both in turn, 50 of each; the median of the ratios of processor times.

#include "bench/planets.hpp"

#include "integrators/lie/group_system.hpp"

using namespace noether;

namespace {

constexpr Index tops = 64;

/// The centre of mass, and m g = 1.
template <class Real> Vec3<Real> center() { return Vec3<Real>(Real(0.2), Real(0.3), Real(0.5)); }
template <class Real> Vec3<Real> rate_of(const Vec3<Real>& pi) {
  return Vec3<Real>(pi[0] / Real(2), pi[1], pi[2] * Real(1.5));
}
double spin_of(Index i, Index k) { return (k == 0 ? 0.6 : k == 1 ? -0.4 : 0.9) + 0.001 * static_cast<double>(i); }

/// R' = R hat(Pi/I), Pi' = Pi x Pi/I + R^T g x c, on SO(3)^64 x R^192.
struct TopsOnGroup {
  Index rotations() const { return tops; }
  Index motions() const { return 0; }
  Index numbers() const { return 3 * tops; }
  Index size() const { return 7 * tops; }
  std::vector<double> start() const {
    std::vector<double> y(static_cast<std::size_t>(size()), 0.0);
    for (Index i = 0; i < tops; ++i) {
      y[static_cast<std::size_t>(4 * i)] = 1;
      for (Index k = 0; k < 3; ++k) y[static_cast<std::size_t>(4 * tops + 3 * i + k)] = spin_of(i, k);
    }
    return y;
  }
  template <class Real> void velocity(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& a) const {
    for (Index i = 0; i < tops; ++i) {
      const Vec3<Real> pi = triple_at<Real>(y, 4 * tops + 3 * i), rate = rate_of<Real>(pi);
      const Vec3<Real> down =
          to_body<Real>(rotation_matrix<Real>(quaternion_at<Real>(y, 4 * i)), Vec3<Real>(Real(0), Real(0), Real(-1)));
      const Vec3<Real> twist = cross<Real>(pi, rate) + cross<Real>(center<Real>(), down);
      for (Index k = 0; k < 3; ++k) {
        a[3 * i + k] = rate[k];
        a[3 * tops + 3 * i + k] = twist[k];
      }
    }
  }
};

/// The same with the rows of R as nine numbers.
struct TopsAsMatrices {
  Index size() const { return 12 * tops; }
  std::vector<double> start() const {
    std::vector<double> y(static_cast<std::size_t>(size()), 0.0);
    for (Index i = 0; i < tops; ++i) {
      for (Index k = 0; k < 3; ++k) {
        y[static_cast<std::size_t>(12 * i + 4 * k)] = 1;
        y[static_cast<std::size_t>(12 * i + 9 + k)] = spin_of(i, k);
      }
    }
    return y;
  }
  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const {
    for (Index i = 0; i < tops; ++i) {
      const Vec3<Real> pi = triple_at<Real>(y, 12 * i + 9), rate = rate_of<Real>(pi);
      for (Index row = 0; row < 3; ++row) {
        const Vec3<Real> moved = cross<Real>(triple_at<Real>(y, 12 * i + 3 * row), rate);
        for (Index k = 0; k < 3; ++k) dy[12 * i + 3 * row + k] = moved[k];
      }
      const Vec3<Real> down = -triple_at<Real>(y, 12 * i + 6);
      const Vec3<Real> twist = cross<Real>(pi, rate) + cross<Real>(center<Real>(), down);
      for (Index k = 0; k < 3; ++k) dy[12 * i + 9 + k] = twist[k];
    }
  }
};

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("lie", count, arguments);
  set_thread_count(1);
  Simulation<double> matrices(initial_state(TopsAsMatrices{}), classical(TopsAsMatrices{}, method("rk4")), 0.01);
  Simulation<double> group(initial_state(TopsOnGroup{}), lie(TopsOnGroup{}, method("rkmk_rk4")), 0.01);
  const bench::Turns turns = bench::take_turns(matrices, group, 2000);
  rows.add("64 tops, rk4", "group_over_matrices", bench::Measured(turns.as_long), "1", 6);
  rows.add("64 tops, rk4 on matrices", "step_ns", bench::Measured(turns.first), "ns", 6);
}
