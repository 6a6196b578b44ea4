/// Orders of constrained compositions against an oracle without constraints: the same chains in angles.

#include "tests/support/catch.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/order_fit.hpp"

#include <Eigen/LU>

namespace noether {
namespace {

using namespace noether::test;

using Vector = Eigen::Matrix<Quad, Eigen::Dynamic, 1>;
using Matrix = Eigen::Matrix<Quad, Eigen::Dynamic, Eigen::Dynamic>;

/// A chain of rods in a vertical plane, by its angles from the downward vertical.
///
///     sum_j l_i l_j w_max(i,j) (cos(t_i - t_j) t_j'' + sin(t_i - t_j) t_j'^2) = - g l_i w_i sin t_i,   w_k = sum_{j >=
///     k} m_j
struct Angles {
  Vector l, w;

  Vector rate(const Vector& y) const {
    const Index n = l.size();
    Matrix inertia(n, n);
    Vector force(n);
    for (Index i = 0; i < n; ++i) {
      force[i] = -Quad(g_earth) * l[i] * w[i] * sin(y[i]);
      for (Index j = 0; j < n; ++j) {
        const Quad k = l[i] * l[j] * w[std::max(i, j)], difference = y[i] - y[j];
        inertia(i, j) = k * cos(difference);
        force[i] -= k * sin(difference) * y[n + j] * y[n + j];
      }
    }
    Vector result(2 * n);
    result.head(n) = y.tail(n);
    result.tail(n) = inertia.partialPivLu().solve(force);
    return result;
  }

  /// One step of Gragg, Bulirsch and Stoer of order 16: the modified midpoint rule in 2, 4, ..., 16 parts,
  /// extrapolated.
  Vector step(const Vector& y, const Quad& h) const {
    std::vector<Vector> row;
    for (int k = 1; k <= 8; ++k) {
      const int parts = 2 * k;
      const Quad part = h / Quad(parts);
      Vector before = y, now = y + part * rate(y);
      for (int i = 1; i < parts; ++i) {
        const Vector next = before + Quad(2) * part * rate(now);
        before = now;
        now = next;
      }
      Vector better = (now + before + part * rate(now)) / Quad(2);
      for (int j = k - 1; j >= 1; --j) {
        const Quad ratio = Quad(k) / Quad(j);
        const Vector last = row[static_cast<std::size_t>(k - j - 1)];
        row[static_cast<std::size_t>(k - j - 1)] = better;
        better = better + (better - last) / (ratio * ratio - Quad(1));
      }
      row.push_back(better);
    }
    return row.back();
  }
};

/// A chain of a mechanism in the plane through its first particle and the vertical.
struct PlanarChain {
  Angles angles;
  Vec3<Quad> along;  ///< the horizontal direction of the plane
  Vector start;

  explicit PlanarChain(const ParticleSystem<Quad>& s) {
    const Index n = s.size();
    const Vec3<Quad> first = s.positions()[0];
    along = Vec3<Quad>(first[0], first[1], Quad(0));
    along /= sqrt(norm2(along));
    angles.l.resize(n);
    angles.w = Vector::Zero(n);
    start.resize(2 * n);
    for (Index i = 0; i < n; ++i) {
      const Vec3<Quad> rod = i == 0 ? first : Vec3<Quad>(s.positions()[i] - s.positions()[i - 1]);
      const Vec3<Quad> v =
          i == 0 ? Vec3<Quad>(s.velocities()[0]) : Vec3<Quad>(s.velocities()[i] - s.velocities()[i - 1]);
      const Quad r = dot(rod, along), l2 = norm2(rod);
      angles.l[i] = sqrt(l2);
      start[i] = atan2(r, -rod[2]);
      start[n + i] = (v[2] * r - dot(v, along) * rod[2]) / l2;
      for (Index k = 0; k <= i; ++k) angles.w[k] += s.masses()[i];
    }
  }

  /// Positions after a time.
  std::vector<Vec3<Quad>> positions(double time, int steps) const {
    Vector y = start;
    for (int k = 0; k < steps; ++k) y = angles.step(y, Quad(time) / Quad(steps));
    std::vector<Vec3<Quad>> places;
    Vec3<Quad> x = Vec3<Quad>::Zero();
    for (Index i = 0; i < angles.l.size(); ++i) {
      x += angles.l[i] * (sin(y[i]) * along - cos(y[i]) * Vec3<Quad>(Quad(0), Quad(0), Quad(1)));
      places.push_back(x);
    }
    return places;
  }
};

double error(const ParticleSystem<Quad>& s, const std::vector<Vec3<Quad>>& places) {
  double worst = 0;
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<Quad> difference = s.positions()[i] - places[static_cast<std::size_t>(i)];
    worst = std::max(worst, static_cast<double>(sqrt(norm2(difference))));
  }
  return worst;
}

/// A chain of four links of different lengths and masses in one plane.
Mechanism four_links() {
  Mechanism m;
  Vec3<double> x = Vec3<double>::Zero();
  const std::array<double, 4> angle = {0.7, 1.6, 0.2, -0.5}, length = {1, 0.7, 1.2, 0.8}, mass = {1, 2, 0.5, 1.5};
  for (std::size_t i = 0; i < 4; ++i) {
    x += length[i] * Vec3<double>(std::sin(angle[i]), 0, -std::cos(angle[i]));
    m.particles.add(std::to_string(i), mass[i], x, {0, 0, 0});
  }
  m.constraints.add(m.particles, OnSphere{}, {0});
  for (Index i = 0; i < 3; ++i) m.constraints.add(m.particles, Distance{}, {i, i + 1});
  return m;
}

void check_order(const Mechanism& mechanism, const Scheme& scheme, const std::vector<Vec3<Quad>>& truth, double time,
                 const std::vector<int>& counts) {
  std::vector<ErrorPoint> points;
  for (const int count : counts) {
    points.push_back({time / count, error(run<Quad>(mechanism, scheme, time / count, count), truth)});
  }
  INFO(scheme.name << "\n" << to_text(points));
  CHECK(std::fabs(fitted_slope(points) - scheme.order.classical) < 0.15);
}

TEST_CASE("constrained compositions have orders 2, 4 and 6 against the same chains in angles", "[order][constraints]") {
  for (const Mechanism& mechanism : {double_pendulum(), four_links()}) {
    const double time = 0.5;
    const PlanarChain chain(
        Simulation<Quad>(mechanism.particles.as<Quad>(), compose(hamiltonian_of<Quad>(mechanism), schemes::verlet), 1)
            .particles());
    const auto truth = chain.positions(time, 64);
    const auto coarser = chain.positions(time, 48);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double apart = static_cast<double>(sqrt(norm2(Vec3<Quad>(truth[i] - coarser[i]))));
      REQUIRE(std::log10(apart) < -18);
    }
    check_order(mechanism, schemes::verlet, truth, time, {64, 96, 128});
    check_order(mechanism, schemes::suzuki_4, truth, time, {48, 64, 96});
    check_order(mechanism, schemes::kahan_li_6_s9, truth, time, {48, 64, 96});
  }
}

TEST_CASE("a scheme for exact drifts would lose its order under constraints", "[order][constraints]") {
  const Mechanism mechanism = double_pendulum();
  const double time = 0.5;
  const PlanarChain chain(
      Simulation<Quad>(mechanism.particles.as<Quad>(), compose(hamiltonian_of<Quad>(mechanism), schemes::verlet), 1)
          .particles());
  const auto truth = chain.positions(time, 64);
  Scheme posing = schemes::blanes_moan_s6;  // order 4, with drifts that are no whole steps
  posing.exact = "";
  std::vector<ErrorPoint> points;
  for (const int count : {32, 64, 128}) {
    points.push_back({time / count, error(run<Quad>(mechanism, posing, time / count, count), truth)});
  }
  INFO(to_text(points));
  CHECK(fitted_slope(points) < 2.5);
}

}  // namespace
}  // namespace noether
