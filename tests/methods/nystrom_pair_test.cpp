/// The Runge-Kutta-Nystroem pair 12(10): its orders on real motions, its tolerance. Its table: nystrom_trees_test.cpp.

#include "integrators/methods/nystrom_pair.hpp"
#include "tests/methods/motions.hpp"
#include "tests/methods/rooted_trees.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"

using namespace noether;

namespace {

/// One step of a table, written down again: positions and velocities by the given weights.
Vector<Quad> nystrom_step(const NystromTableau& t, const std::vector<Quad>& b_q, const std::vector<Quad>& b_v,
                          VectorField<Quad>& f, const Vector<Quad>& y, Quad h) {
  const Index half = y.size() / 2;
  std::vector<Vector<Quad>> k(t.stages(), Vector<Quad>(half));
  Vector<Quad> at = y;
  for (std::size_t s = 0; s < t.stages(); ++s) {
    for (Index i = 0; i < half; ++i) {
      Quad sum = 0;
      for (std::size_t j = 0; j < t.a[s].size(); ++j) sum += t.a[s][j] * k[j][i];
      at[i] = y[i] + t.c[s] * h * y[half + i] + h * h * sum;
    }
    f.acceleration(t.c[s] * h, at, k[s]);
  }
  Vector<Quad> end = y;
  for (Index i = 0; i < half; ++i) {
    end[i] += h * y[half + i];
    for (std::size_t j = 0; j < t.stages(); ++j) {
      end[i] += h * h * b_q[j] * k[j][i];
      end[half + i] += h * b_v[j] * k[j][i];
    }
  }
  return end;
}

Vector<Quad> truth_at(VectorField<Quad>& f, const Vector<Quad>& start, Quad end) {
  const auto exact = test::make<Quad>("gragg_bulirsch_stoer", {.rtol = 1e-32, .atol = 1e-32});
  return test::travel<Quad>(*exact, f, start, end);
}

/// Errors of positions and of velocities over a ladder of fixed steps, at t = 6.
void nystrom_ladder(VectorField<Quad>& f, const Vector<Quad>& start, const std::vector<long>& counts,
                    std::vector<test::ErrorPoint>& positions, std::vector<test::ErrorPoint>& velocities) {
  const Index half = start.size() / 2;
  const Vector<Quad> truth = truth_at(f, start, 6);
  for (const long steps : counts) {
    const auto method = test::make<Quad>("dprkn_12", {.adaptive = false});
    const double h = 6.0 / static_cast<double>(steps);
    const Vector<Quad> y = test::walk<Quad>(*method, f, start, h, steps);
    positions.push_back({h, test::distance<Quad>(y.head(half), truth.head(half))});
    velocities.push_back({h, test::distance<Quad>(y.tail(half), truth.tail(half))});
  }
}

}  // namespace

TEST_CASE("the Nystroem pair is of order 12 in positions and velocities, on Henon and Heiles and on Kepler",
          "[methods]") {
  std::vector<test::ErrorPoint> positions, velocities;
  auto f = test::henon_heiles<Quad>();
  nystrom_ladder(f, test::henon_heiles_start<Quad>(), {32, 48, 64}, positions, velocities);
  CAPTURE(test::to_text(positions), test::to_text(velocities));
  CHECK(std::abs(test::fitted_slope(positions) - 12) < 0.25);
  CHECK(std::abs(test::fitted_slope(velocities) - 12) < 0.25);

  std::vector<test::ErrorPoint> kepler_positions, kepler_velocities;
  auto kepler = test::kepler<Quad>();
  nystrom_ladder(kepler, test::kepler_start<Quad>(Quad(0.2)), {128, 192, 256}, kepler_positions, kepler_velocities);
  CAPTURE(test::to_text(kepler_positions), test::to_text(kepler_velocities));
  CHECK(std::abs(test::fitted_slope(kepler_positions) - 12) < 0.25);
  CHECK(std::abs(test::fitted_slope(kepler_velocities) - 12) < 0.25);
}

TEST_CASE("the embedded formula of the Nystroem pair is of order 10", "[methods]") {
  const NystromTableau& t = tableaus::dprkn_12();
  auto f = test::kepler<Quad>();
  const Vector<Quad> start = test::kepler_start<Quad>(Quad(0.2));
  std::vector<test::ErrorPoint> upper, lower;
  for (const double h : {0.125, 0.09375, 0.0625}) {
    const Vector<Quad> truth = truth_at(f, start, h);
    upper.push_back({h, test::distance(truth, nystrom_step(t, t.b_q, t.b_v, f, start, h))});
    lower.push_back({h, test::distance(truth, nystrom_step(t, test::without(t.b_q, t.e_q), test::without(t.b_v, t.e_v),
                                                           f, start, h))});
  }
  CAPTURE(test::to_text(upper), test::to_text(lower));
  CHECK(std::abs(test::fitted_slope(upper) - 13) < 0.4);
  CHECK(std::abs(test::fitted_slope(lower) - 11) < 0.4);
}

TEST_CASE("the error of the Nystroem pair follows its tolerance, 17 evaluations per step", "[methods]") {
  std::vector<test::ErrorPoint> points;
  std::int64_t rejected = 0;
  for (const double tolerance : {1e-8, 1e-12, 1e-16, 1e-20, 1e-24}) {
    const auto method = test::make<Quad>("dprkn_12", {.rtol = tolerance, .atol = tolerance});
    const test::Travelled now = test::once_around<Quad>(*method);
    points.push_back({tolerance, now.error});
    rejected += now.rejected;
    // Two evaluations find the first step, one ends the journey; a rejected trial keeps its first stage.
    CHECK((now.evaluations - 3 - 16 * now.rejected) % 17 == 0);
  }
  CAPTURE(test::to_text(points));
  CHECK(rejected > 0);
  // Steps as tolerance^(1/11), errors as their power 12: slope 12/11, more at the coarse end.
  CHECK(test::fitted_slope(points) > 1);
  CHECK(test::fitted_slope(points) < 1.4);
  auto f = test::kepler<double>();
  const auto fixed = test::make<double>("dprkn_12", {.adaptive = false});
  test::walk<double>(*fixed, f, test::kepler_start<double>(0.6), 0.01, 100);
  CHECK(f.evaluations().force == 1700);
}
