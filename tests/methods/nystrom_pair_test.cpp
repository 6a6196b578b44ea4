/// The Runge-Kutta-Nystroem pair 12(10): its table, its orders, its tolerance.

#include "integrators/methods/nystrom_pair.hpp"
#include "tests/methods/motions.hpp"
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

std::vector<Quad> minus(std::vector<Quad> a, const std::vector<Quad>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
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

TEST_CASE("the table of the Nystroem pair satisfies the conditions one can write down, to all its digits",
          "[methods]") {
  const NystromTableau& t = tableaus::dprkn_12();
  REQUIRE(t.stages() == 17);
  const auto near = [](Quad x, Quad y) { return static_cast<double>(abs(x - y)) < 1e-30; };
  // q at the stages is right to order 2, and beyond the fourth to order 3: sum a_ij = c^2 / 2, sum a_ij c_j = c^3 / 6.
  for (std::size_t i = 0; i < 17; ++i) {
    Quad sum = 0, moment = 0;
    for (std::size_t j = 0; j < t.a[i].size(); ++j) {
      sum += t.a[i][j];
      moment += t.a[i][j] * t.c[j];
    }
    CAPTURE(i);
    CHECK(near(sum, t.c[i] * t.c[i] / Quad(2)));
    if (i > 1) CHECK(near(moment, t.c[i] * t.c[i] * t.c[i] / Quad(6)));
  }
  // Quadrature: sum b_v c^k = 1 / (k + 1), sum b_q c^k = 1 / ((k + 1) (k + 2)), to order 12, embedded to order 10.
  const auto moments = [&](const std::vector<Quad>& w, int k) {
    Quad sum = 0;
    for (std::size_t i = 0; i < 17; ++i) {
      Quad power = w[i];
      for (int n = 0; n < k; ++n) power *= t.c[i];
      sum += power;
    }
    return sum;
  };
  const auto lower_v = minus(t.b_v, t.e_v), lower_q = minus(t.b_q, t.e_q);
  for (int k = 0; k <= 12; ++k) {
    CAPTURE(k);
    CHECK(near(moments(t.b_v, k), Quad(1) / Quad(k + 1)) == (k < 12));
    CHECK(near(moments(t.b_q, k), Quad(1) / Quad((k + 1) * (k + 2))) == (k < 11));
    CHECK(near(moments(lower_v, k), Quad(1) / Quad(k + 1)) == (k < 10));
    CHECK(near(moments(lower_q, k), Quad(1) / Quad((k + 1) * (k + 2))) == (k < 9));
  }
}

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
    lower.push_back({h, test::distance(truth, nystrom_step(t, minus(t.b_q, t.e_q), minus(t.b_v, t.e_v), f, start, h))});
  }
  CAPTURE(test::to_text(upper), test::to_text(lower));
  CHECK(std::abs(test::fitted_slope(upper) - 13) < 0.4);
  CHECK(std::abs(test::fitted_slope(lower) - 11) < 0.4);
}

TEST_CASE("one digit changed in any coefficient of the Nystroem pair shows in its rows or in one step", "[methods]") {
  const NystromTableau& t = tableaus::dprkn_12();
  auto f = test::kepler<Quad>();
  Vector<Quad> start(4);
  start << 0.7, 0.4, -0.5, 0.9;
  const Quad h(0.0625);
  const Vector<Quad> truth = truth_at(f, start, h);
  const double error = test::distance(truth, nystrom_step(t, t.b_q, t.b_v, f, start, h));
  CAPTURE(error);
  CHECK(error < 1e-22);
  const auto slip = [](Quad x) {
    return x + Quad(std::pow(10.0, std::floor(std::log10(std::abs(static_cast<double>(x)))) - 9));
  };
  // Stages 2 to 5 hardly matter by themselves, but the sums of their rows tell.
  const auto found = [&](const NystromTableau& changed) {
    for (std::size_t i = 0; i < 17; ++i) {
      Quad sum = 0;
      for (const Quad& x : changed.a[i]) sum += x;
      if (static_cast<double>(abs(sum - changed.c[i] * changed.c[i] / Quad(2))) > 1e-30) return true;
    }
    return test::distance(truth, nystrom_step(changed, changed.b_q, changed.b_v, f, start, h)) > 1e6 * error;
  };
  CHECK(!found(t));
  for (std::size_t i = 0; i < 17; ++i) {
    for (std::size_t j = 0; j < t.a[i].size(); ++j) {
      if (t.a[i][j] == Quad(0)) continue;
      NystromTableau changed = t;
      changed.a[i][j] = slip(changed.a[i][j]);
      CAPTURE(i, j);
      CHECK(found(changed));
    }
    NystromTableau nodes = t, velocities = t, positions = t;
    CAPTURE(i);
    if (t.c[i] != Quad(0)) {
      nodes.c[i] = slip(nodes.c[i]);
      CHECK(found(nodes));
    }
    if (t.b_v[i] == Quad(0)) continue;
    velocities.b_v[i] = slip(velocities.b_v[i]);
    CHECK(found(velocities));
    if (t.b_q[i] == Quad(0)) continue;
    positions.b_q[i] = slip(positions.b_q[i]);
    CHECK(found(positions));
  }
}

TEST_CASE("the error of the Nystroem pair follows its tolerance, 17 evaluations a step", "[methods]") {
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
