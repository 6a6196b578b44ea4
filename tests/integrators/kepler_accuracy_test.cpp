#include "tests/integrators/kepler_orbits.hpp"

#include <array>
#include <chrono>
#include <cstdio>
#include <utility>
#include <vector>

using namespace noether;
using namespace noether::kepler_test;

namespace {

struct Sweep {
  double worst = 0;
  int iterations = 0;
};
Sweep sweep(int cases) {
  Random random(11);
  Sweep result;
  for (int n = 0; n < cases; ++n) {
    const Case c = random_case(random);
    const double error = error_by_condition(c.state, c.mu, c.h, &result.iterations);
    if (error > few) UNSCOPED_INFO("case " << n << ", e = " << c.e << ", error " << error);
    result.worst = std::max(result.worst, error);
  }
  return result;
}

/// Largest error of planetary arcs up to h = fraction of a period, in units of 2^-53 of the larger |x| and |v|.
std::pair<double, double> planetary_error(double e, double fraction, int cases) {
  Random random(3);
  double worst = 0, sum = 0;
  for (int n = 0; n < cases; ++n) {
    const Doubles s = narrow(on_ellipse(Turn(random), Quad(1), Quad(random(1, 2)), Quad(e), Quad(random(0, 6.3))));
    const double alpha = 2 / length(s.x) - norm2(s.v);
    const double h = static_cast<double>(two_pi) / (alpha * std::sqrt(alpha)) * fraction;
    const KeplerArc<double> arc = kepler_arc(s.x, s.v, 1.0, h);
    const Quads w = widen(s);
    const KeplerArc<Quad> truth = kepler_arc(w.x, w.v, Quad(1), Quad(h));
    const double size = std::max(length(s.x), static_cast<double>(length<Quad>(w.x + truth.dx)));
    const double error = static_cast<double>(length<Quad>(arc.dx.cast<Quad>() - truth.dx)) / size / unit;
    worst = std::max(worst, error);
    sum += error;
  }
  return {worst, sum / cases};
}

Quad energy(const Doubles& s) {
  const Quads w = widen(s);
  return norm2(w.v) / Quad(2) - Quad(1) / length(w.x);
}

/// dE/E after n steps from `orbits` places: mean and root mean square, in units of 2^-53 sqrt n.
std::pair<double, double> energy_walk(double e, double steps_per_period, int orbits, int n) {
  Random random(5);
  double sum = 0, squares = 0;
  for (int k = 0; k < orbits; ++k) {
    const Quad a(random(1, 2));
    Doubles s = narrow(on_ellipse(Turn(random), Quad(1), a, Quad(e), Quad(random(0, 6.3))));
    const double h = static_cast<double>(two_pi * sqrt(a * a * a)) / steps_per_period;
    const Quad start = energy(s);
    for (int i = 0; i < n; ++i) {
      const KeplerArc<double> arc = kepler_arc(s.x, s.v, 1.0, h);
      s.x += arc.dx;
      s.v += arc.dv;
    }
    const double error = static_cast<double>((energy(s) - start) / start) / unit / std::sqrt(n);
    sum += error;
    squares += error * error;
  }
  return {sum / orbits, std::sqrt(squares / orbits)};
}

/// Time of one arc, the best of a hundred runs.
double nanoseconds(double e, double fraction) {
  Random random(14);
  std::vector<Doubles> states;
  for (int n = 0; n < 200; ++n) {
    states.push_back(narrow(on_ellipse(Turn(random), Quad(1), Quad(1), Quad(e), Quad(random(0, 6.3)))));
  }
  double best = 1e30, sum = 0;
  for (int run = 0; run < 100; ++run) {
    const auto start = std::chrono::steady_clock::now();
    for (const Doubles& s : states) sum += kepler_arc(s.x, s.v, 1.0, static_cast<double>(two_pi) * fraction).s;
    const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
    best = std::min(best, spent.count() / 200);
  }
  return std::isfinite(sum) ? best : 0;
}

}  // namespace

TEST_CASE("any conic and any time: the error is what rounding the inputs would do", "[kepler][slow]") {
  const Sweep result = sweep(10000);
  CHECK(result.worst < few);
  CHECK(result.iterations < 100);
}

TEST_CASE("any conic and any time, a hundred thousand arcs", "[.][nightly][kepler]") {
  const Sweep result = sweep(100000);
  CHECK(result.worst < few);
  CHECK(result.iterations < 100);
}

TEST_CASE("planetary arcs are right to a few roundings", "[kepler]") {
  CHECK(planetary_error(0.05, 1.0 / 20, 500).first < 2);
  CHECK(planetary_error(0.2, 1.0 / 20, 500).first < 2);
  CHECK(planetary_error(0.2, 1.0 / 3, 500).first < 24);
  CHECK(planetary_error(0.8, 1.0 / 3, 500).second < 6);
}

TEST_CASE("energy walks at random and does not drift", "[kepler][slow]") {
  const int n = 1000000;
  for (const double e : {0.0, 0.05, 0.2}) {
    CAPTURE(e);
    const auto [mean, rms] = energy_walk(e, 17.3, 4, n);
    CHECK(std::abs(mean) < 2);
    CHECK(rms < 8);
  }
  // Long steps, where rounded coefficients and a last step lost to rounding show: 7 with either.
  CHECK(std::abs(energy_walk(0.2, 6.0990131, 16, n).first) < 3);
}

namespace {

using Vec6 = std::array<Quad, 6>;
Vec6 flat(const Quads& s) { return {s.x[0], s.x[1], s.x[2], s.v[0], s.v[1], s.v[2]}; }

/// Columns of the derivative of the arc by central differences with step delta.
std::array<Vec6, 6> derivative(const Quads& s, Quad mu, Quad h, Quad delta) {
  std::array<Vec6, 6> columns;
  for (int k = 0; k < 6; ++k) {
    Quads up = s, down = s;
    (k < 3 ? up.x[k] : up.v[k - 3]) += delta;
    (k < 3 ? down.x[k] : down.v[k - 3]) -= delta;
    const Vec6 a = flat(advanced(up, mu, h)), b = flat(advanced(down, mu, h));
    for (std::size_t i = 0; i < 6; ++i) columns[static_cast<std::size_t>(k)][i] = (a[i] - b[i]) / (Quad(2) * delta);
  }
  return columns;
}

/// Three kinds of orbit, each through its pericenter.
std::vector<Quads> three_orbits() {
  Random random(12);
  const Turn turn(random);
  return {on_ellipse(turn, Quad(1), Quad(1), Quad(0.6), Quad(-1.2)),
          on_hyperbola(turn, Quad(1), Quad(1), Quad(1.4), Quad(-1.7)),
          on_parabola(turn, Quad(1), Quad(0.5), Quad(-1.1))};
}

}  // namespace

TEST_CASE("the arc is symplectic", "[kepler]") {
  const Quad delta(0x1p-36);
  for (const Quads& s : three_orbits()) {
    for (const double h : {0.3, 3.0, -2.0, 40.0}) {
      const auto m = derivative(s, Quad(1), Quad(h), delta);
      Quad worst(0), size(0);
      for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t j = 0; j < 6; ++j) {
          Quad sum(0), terms(0);
          for (std::size_t k = 0; k < 3; ++k) {
            sum += m[i][k] * m[j][k + 3] - m[i][k + 3] * m[j][k];
            terms += abs(m[i][k] * m[j][k + 3]) + abs(m[i][k + 3] * m[j][k]);
          }
          const Quad expected = j == i + 3 ? Quad(1) : i == j + 3 ? Quad(-1) : Quad(0);
          worst = std::max(worst, abs(sum - expected));
          size = std::max(size, terms);
        }
      }
      CAPTURE(h);
      // Central differences leave delta^2 times third derivatives.
      CHECK(static_cast<double>(worst / size) < 1e-17);
    }
  }
}

TEST_CASE("the action of an arc is h E + 2 mu s: dS = p1 dq1 - p0 dq0", "[kepler]") {
  const Quad delta(0x1p-36), mu(1.5);
  for (const Quads& s : three_orbits()) {
    for (const double h : {0.3, 3.0, -2.0, 40.0}) {
      const auto action = [&](const Quads& z) {
        const Quad e = norm2(z.v) / Quad(2) - mu / length(z.x);
        return Quad(h) * e + Quad(2) * mu * kepler_arc(z.x, z.v, mu, Quad(h)).s;
      };
      const Quads end = advanced(s, mu, Quad(h));
      const auto m = derivative(s, mu, Quad(h), delta);
      for (int k = 0; k < 6; ++k) {
        Quads up = s, down = s;
        (k < 3 ? up.x[k] : up.v[k - 3]) += delta;
        (k < 3 ? down.x[k] : down.v[k - 3]) -= delta;
        const Quad change = (action(up) - action(down)) / (Quad(2) * delta);
        const auto column = static_cast<std::size_t>(k);
        Quad expected = k < 3 ? -s.v[k] : Quad(0);
        for (std::size_t i = 0; i < 3; ++i) expected += end.v[static_cast<Index>(i)] * m[column][i];
        CAPTURE(h, k);
        CHECK(static_cast<double>(abs(change - expected)) < 1e-15 * (1 + std::abs(static_cast<double>(change))));
      }
    }
  }
}

TEST_CASE("figures of the Kepler solver", "[.][figures]") {
  std::printf("error of dx in 2^-53 of |x|: worst and mean\n    e   h = P/20        h = P/10        h = P/3\n");
  for (const double e : {0.0, 0.05, 0.2, 0.5, 0.9, 0.99}) {
    std::printf("%5.2f", e);
    for (const double part : {20.0, 10.0, 3.0}) {
      const auto [worst, mean] = planetary_error(e, 1 / part, 2000);
      std::printf("%9.1f %6.2f", worst, mean);
    }
    std::printf("\n");
  }
  std::printf("dE/E after 1e6 steps in 2^-53 sqrt(n), 16 orbits: mean and rms\n");
  for (const double steps : {17.3, 17.2972013, 6.0990131}) {
    for (const double e : {0.0, 0.05, 0.2, 0.5}) {
      const auto [mean, rms] = energy_walk(e, steps, 16, 1000000);
      std::printf("P/%-10.7g e = %.2f  %7.2f %7.2f\n", steps, e, mean, rms);
    }
  }
  for (const double part : {20.0, 3.0, 1.9}) {
    std::printf("e = 0.2, h = P/%-4g %6.0f ns an arc\n", part, nanoseconds(0.2, 1 / part));
  }
  const Sweep any = sweep(100000);
  std::printf("100000 arcs: worst error %.1f roundings of the inputs, most evaluations %d\n", any.worst,
              any.iterations);
}
