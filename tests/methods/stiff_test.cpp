/// Stiff problems: damping, stability far from the origin and on the imaginary axis, kinetics, order reduction, heat.

#include "tests/methods/stiff_problems.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/process.hpp"
#include "tests/support/settings.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

using namespace noether;
using namespace noether::test;

namespace {

Vector<double> vector_of(std::initializer_list<double> list) {
  Vector<double> y(static_cast<Index>(list.size()));
  std::copy(list.begin(), list.end(), y.data());
  return y;
}

/// y1 / y0 of one step on y' = lambda y, h = 1.
double gain_of_step(const std::string& name, double lambda) {
  return march<double>(Linear{.lambda = lambda}, with_fixed_steps(name), vector_of({1}), 1, 1).y[0];
}

/// y' = lambda y with lambda = z (-cos(angle) + i sin(angle)).
struct Spiral {
  double z = 1, angle = 0;
  static std::string_view name() { return "spiral"; }
  static Index size() { return 2; }
  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const {
    const Real re = Real(-z * std::cos(angle)), im = Real(z * std::sin(angle));
    dy[0] = re * y[0] - im * y[1];
    dy[1] = im * y[0] + re * y[1];
  }
};

/// Whether BDF of fixed step decays, or at least does not grow, for every length of h lambda at an angle [degree] from
/// the negative real axis.
bool stable_at(const std::string& name, double angle) {
  for (double z = 0.05; z < 40; z *= 1.25) {
    const Spiral spiral{.z = z, .angle = angle * std::acos(-1.0) / 180};
    const auto early = march<double>(spiral, with_fixed_steps(name), vector_of({1, 0}), 1, 60);
    const auto late = march<double>(spiral, with_fixed_steps(name), vector_of({1, 0}), 1, 600);
    const double before = early.y.lpNorm<Eigen::Infinity>(), after = late.y.lpNorm<Eigen::Infinity>();
    if (!(after < 2 * before)) return false;
  }
  return true;
}

/// Steps of a method on the heat equation to t = 0.1.
Reached<double> heat_by(const std::string& name, Index n) {
  const Heat heat{.n = n};
  const auto reached = march_to<double>(heat, method(name, {.rtol = 1e-6, .atol = 1e-9}), heat.start(), 0.1);
  REQUIRE_FALSE(reached.failure);
  return reached;
}

/// The longest step with which an explicit method does not blow up, by bisection to a thousandth.
double largest_step(const std::string& name, Index n) {
  const Heat heat{.n = n};
  Vector<double> y = heat.start();
  for (Index i = 0; i < n; ++i) y[i] += i % 2 == 0 ? 1e-3 : -1e-3;
  const double dx = 1 / static_cast<double>(n + 1);
  double stable = 0.1 * dx * dx, unstable = 2 * dx * dx;
  while (unstable - stable > 1e-3 * stable) {
    const double h = (stable + unstable) / 2;
    const auto reached = march<double>(heat, method(name), y, h, 6000);
    (reached.y.lpNorm<Eigen::Infinity>() < 10 ? stable : unstable) = h;
  }
  return stable;
}

}  // namespace

TEST_CASE("backward Euler damps an oscillation by (1 + z^2)^(-1/2) a step, in any length of step") {
  for (const double z : {0.01, 0.1, 1.0, 10.0, 1e4}) {
    const auto reached = march<double>(Rotation{.omega = z}, method("backward_euler"), vector_of({1, 0}), 1, 3);
    const double amplitude = std::sqrt(reached.y[0] * reached.y[0] + reached.y[1] * reached.y[1]);
    CHECK(std::abs(amplitude * std::pow(1 + z * z, 1.5) - 1) < 1e-13);
  }
}

TEST_CASE("what has decayed to nothing goes on decaying: no solution is asked for below the normal numbers") {
  for (const char* name : {"backward_euler", "sdirk_2", "sdirk_3", "sdirk_4"}) {
    CAPTURE(name);
    const auto end = march<double>(Spiral{.z = 2, .angle = 1.2}, with_fixed_steps(name), vector_of({1, 0.5}), 1, 30000);
    CHECK_FALSE(end.failure);
    CHECK(end.y.cwiseAbs().maxCoeff() < 1e-300);
  }
}

TEST_CASE("the trapezoidal rule keeps an oscillation, whatever its step") {
  for (const double z : {0.1, 1.0, 10.0, 1e4}) {
    const auto reached = march<double>(Rotation{.omega = z}, method("trapezoidal"), vector_of({1, 0}), 1, 100);
    CHECK(std::abs(reached.y[0] * reached.y[0] + reached.y[1] * reached.y[1] - 1) < 1e-11);
  }
}

TEST_CASE("far from the origin R is -1 for the trapezoidal rule, 0 for every L-stable method, as 1/z") {
  CHECK(std::abs(gain_of_step("trapezoidal", -1e12) + 1) < 1e-11);
  for (const std::string name : {"backward_euler", "sdirk_2", "sdirk_3", "sdirk_4", "rodas_4", "rodas_5p"}) {
    INFO(name);
    const double far = std::abs(gain_of_step(name, -1e6)), farther = std::abs(gain_of_step(name, -1e8));
    CHECK(far < 1e-4);
    CHECK(farther < 0.02 * far + 1e-9);
  }
  CHECK(std::abs(gain_of_step("backward_euler", -1e6) * (1 + 1e6) - 1) < 1e-9);
}

TEST_CASE("BDF 1 and 2 are A-stable; 3 to 6 grow near the imaginary axis and are stable in the angles of the books") {
  struct Wedge {
    std::string name;
    double degrees;
  };
  CHECK(stable_at("bdf_1", 90));
  CHECK(stable_at("bdf_2", 90));
  for (const auto& [name, degrees] :
       std::vector<Wedge>{{"bdf_3", 86.03}, {"bdf_4", 73.35}, {"bdf_5", 51.84}, {"bdf_6", 17.84}}) {
    INFO(name);
    CHECK_FALSE(stable_at(name, 90));
    CHECK(stable_at(name, degrees - 1.5));
    CHECK_FALSE(stable_at(name, degrees + 1.5));
  }
}

// Values at 1e11 from the test set of Mazzia and Magherini (2008).
TEST_CASE("Robertson's kinetics go to t = 1e11 and end at the published values") {
  const Vector<double> published = vector_of({0.2083340149701255e-7, 0.8333360770334713e-13, 0.9999999791665050});
  struct Run {
    std::string name;
    double relative;
    std::int64_t most_steps;
  };
  for (const auto& [name, relative, most_steps] :
       std::vector<Run>{{"rodas_4", 3e-7, 1500}, {"rodas_5p", 3e-7, 1000}, {"bdf", 1e-4, 1500}}) {
    INFO(name);
    const auto choice = method(name, {.rtol = 1e-7, .atol = 1e-14});
    const auto reached = march_to<double>(Kinetics{}, choice, vector_of({1, 0, 0}), 1e11);
    REQUIRE_FALSE(reached.failure);
    for (Index i = 0; i < 3; ++i) CHECK(std::abs(reached.y[i] / published[i] - 1) < relative);
    CHECK(std::abs(reached.y[0] + reached.y[1] + reached.y[2] - 1) < 1e-10);  // the mass is a linear invariant
    CHECK(reached.steps < most_steps);
    CHECK(reached.rejected < reached.steps / 20);
  }
  // BDF keeps its Jacobian and its factors.
  const auto bdf =
      march_to<double>(Kinetics{}, method("bdf", {.rtol = 1e-7, .atol = 1e-14}), vector_of({1, 0, 0}), 1e11);
  CHECK(bdf.evaluations.jacobian < bdf.steps / 20);
  CHECK(bdf.evaluations.force < 4 * bdf.steps);
}

TEST_CASE("Newton's iteration finds the branch of Robertson's kinetics that is chemistry, from a start far off") {
  // At y = (1, 0, 0) the matrix knows nothing of the fast reaction: the first update is off by a factor of 70.
  for (const std::string name : {"backward_euler", "sdirk_2", "sdirk_3"}) {
    INFO(name);
    const auto reached = march<double>(Kinetics{}, with_fixed_steps(name), vector_of({1, 0, 0}), 0.0625, 100);
    REQUIRE_FALSE(reached.failure);
    for (Index i = 0; i < 3; ++i) CHECK(reached.y[i] > 0);
    CHECK(std::abs(reached.y[0] + reached.y[1] + reached.y[2] - 1) < 1e-14);
  }
}

TEST_CASE("errors on Robertson's kinetics fall with the tolerance, down to eleven digits") {
  const double published = 0.2083340149701255e-7;
  for (const std::string name : {"rodas_4", "rodas_5p", "bdf"}) {
    std::vector<ErrorPoint> points;
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      const auto choice = method(name, {.rtol = tolerance, .atol = 1e-6 * tolerance});
      const auto reached = march_to<double>(Kinetics{}, choice, vector_of({1, 0, 0}), 1e11);
      points.push_back({tolerance, std::abs(reached.y[0] / published - 1)});
    }
    INFO(name << "\n" << to_text(points));
    CHECK(fitted_slope(points) > 0.7);
  }
}

TEST_CASE("two methods in extended precision agree on Robertson's kinetics at t = 0.4 and t = 4e10") {
  Vector<Quad> start(3);
  start << Quad(1), Quad(0), Quad(0);
  const auto by = [&](const std::string& name, double end) {
    return march_to<Quad>(Kinetics{}, method(name, {.rtol = 1e-12, .atol = 1e-22}), start, end).y;
  };
  for (const double end : {0.4, 4e10}) {
    const Vector<Quad> a = by("rodas_5p", end), b = by("bdf", end);
    for (Index i = 0; i < 3; ++i) CHECK(std::abs(static_cast<double>(a[i] / b[i] - Quad(1))) < 1e-8);
    const auto c =
        march_to<double>(Kinetics{}, method("rodas_5p", {.rtol = 1e-10, .atol = 1e-20}), vector_of({1, 0, 0}), end);
    for (Index i = 0; i < 3; ++i) CHECK(std::abs(c.y[i] / static_cast<double>(a[i]) - 1) < 1e-8);
  }
}

TEST_CASE("order reduction on Prothero and Robinson's problem, lambda = -1e6: a table") {
  struct Row {
    std::string name;
    double slope;
  };
  // Stage order 1 leaves one power of h, over lambda; Rodas5P was made to keep three; BDF keeps its order; Gauss's with
  // s stages keep s, s + 1 if s is odd.
  const std::vector<Row> table = {{"backward_euler", 1}, {"trapezoidal", 2}, {"sdirk_2", 1},  {"sdirk_3", 1},
                                  {"sdirk_4", 1},        {"rodas_4", 1},     {"rodas_5p", 3}, {"gauss_2", 2},
                                  {"gauss_3", 4},        {"bdf_2", 2},       {"bdf_3", 3},    {"bdf_4", 4},
                                  {"bdf_5", 5}};
  const std::string page = test::read_text(std::filesystem::path(NOETHER_SOURCE_DIR) / "docs" / "theory" / "stiff.md");
  std::string printed;
  for (const auto& [name, slope] : table) {
    std::vector<ErrorPoint> points;
    for (const long n : {16, 32, 64, 128}) {
      const double h = 2.0 / static_cast<double>(n);
      const auto reached = march<Quad>(
          StiffPull{}, with_fixed_steps(name),
          [] {
            Vector<Quad> y(1);
            y[0] = sin(Quad(0.25));
            return y;
          }(),
          h, n);
      points.push_back({h, std::abs(static_cast<double>(reached.y[0] - sin(Quad(2.25))))});
    }
    const double measured = fitted_slope({points.end() - 2, points.end()});
    const std::string row = fmt::format("| `{}` | {} | {:.1f} | {:.1e} |\n", name, methods::find(name)->order, measured,
                                        points.back().error);
    printed += row;
    INFO(name << "\n" << to_text(points));
    CHECK(std::abs(measured - slope) < 0.2);
    CHECK(page.find(row) != std::string::npos);
  }
  INFO("docs/theory/stiff.md should have\n" << printed);
  CHECK(page.find(printed) != std::string::npos);
}

TEST_CASE("heat on a line: what an explicit method costs grows as the stiffness ratio") {
  std::vector<ErrorPoint> points;  // evaluations by S
  for (const Index n : {20, 40, 80}) {
    const double dx = 1 / static_cast<double>(n + 1), half = std::acos(-1.0) * dx / 2;
    const double ratio = std::pow(std::cos(half) / std::sin(half), 2);  // of the fastest and the slowest rate
    points.push_back({ratio, static_cast<double>(heat_by("dormand_prince_5", n).evaluations.force)});
  }
  INFO(to_text(points));
  CHECK(std::abs(fitted_slope({points.end() - 2, points.end()}) - 1) < 0.05);
  CHECK(points.back().error / static_cast<double>(heat_by("rodas_4", 80).evaluations.force) > 10);
}

TEST_CASE("heat on a line: the limit of explicit methods falls as dx^2") {
  for (const auto& [name, real_limit] : {std::pair("euler", 2.0), std::pair("rk4", 2.78529)}) {
    std::vector<ErrorPoint> points;
    for (const Index n : {9, 19, 39}) {
      const double dx = 1 / static_cast<double>(n + 1), limit = largest_step(name, n);
      points.push_back({dx, limit});
      // The fastest mode decays as -4 cos^2(pi dx / 2) / dx^2.
      const double c = std::cos(std::acos(-1.0) * dx / 2);
      CHECK(std::abs(limit * 4 * c * c / (dx * dx) / real_limit - 1) < 5e-3);
    }
    INFO(name << "\n" << to_text(points));
    CHECK(std::abs(fitted_slope(points) - 2) < 0.02);
  }
}

TEST_CASE("heat on a line: the steps of L-stable methods do not depend on dx") {
  for (const std::string name : {"rodas_4", "rodas_5p", "bdf"}) {
    INFO(name);
    const auto coarse = heat_by(name, 50), fine = heat_by(name, 100), finest = heat_by(name, 1000);
    CHECK(std::abs(static_cast<double>(finest.steps) / static_cast<double>(coarse.steps) - 1) < 0.05);
    CHECK(std::abs(static_cast<double>(fine.steps) / static_cast<double>(coarse.steps) - 1) < 0.05);
    CHECK(finest.evaluations.force < coarse.evaluations.force + 20);
    // The modes of the start are eigenvectors: the solution is known.
    const Heat heat{.n = 50};
    const double pi = std::acos(-1.0), dx = 1.0 / 51;
    double worst = 0;
    for (Index i = 0; i < heat.n; ++i) {
      const double x = static_cast<double>(i + 1) * dx;
      const auto mode = [&](double k, double size) {
        const double s = std::sin(k * pi * dx / 2);
        return size * std::exp(-4 * s * s / (dx * dx) * 0.1) * std::sin(k * pi * x);
      };
      worst = std::max(worst, std::abs(coarse.y[i] - mode(1, 1) - mode(3, 0.5)));
    }
    CHECK(worst < 1e-5);
  }
}
