/// Orders of the implicit methods, measured on nonlinear problems; restarts; the two faces of a mechanical system.

#include "engine/simulation.hpp"
#include "integrators/classical.hpp"
#include "tests/methods/restarts.hpp"
#include "tests/methods/stiff_problems.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/problems.hpp"

#include <string>
#include <vector>

using namespace noether;
using namespace noether::test;

namespace {

struct ImplicitMethod {
  std::string name;
  int order;
};
const std::vector<ImplicitMethod> implicit_methods = {
    {"backward_euler", 1}, {"trapezoidal", 2}, {"sdirk_2", 2}, {"sdirk_3", 3}, {"sdirk_4", 4}, {"rodas_4", 4},
    {"rodas_5p", 5},       {"bdf_2", 2},       {"bdf_3", 3},   {"bdf_4", 4},   {"bdf_5", 5},   {"bdf_6", 6}};

/// Henon and Heiles as a system of first order, y = (x, v) in the plane.
struct HenonHeilesSystem {
  static std::string_view name() { return "henon_heiles_system"; }
  static Index size() { return 4; }
  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const {
    dy[0] = y[2];
    dy[1] = y[3];
    dy[2] = -y[0] - Real(2) * y[0] * y[1];
    dy[3] = -y[1] - y[0] * y[0] + y[1] * y[1];
  }
};

/// y' = y^2 + 1: y1 = 1 + h (y1^2 + 1) has no real solution for h = 1.
struct Tangent {
  static std::string_view name() { return "tangent"; }
  static Index size() { return 1; }
  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const {
    dy[0] = y[0] * y[0] + Real(1);
  }
};

double slope_on_smooth(const MethodChoice& choice, long first) {
  std::vector<ErrorPoint> points;
  const Vector<double> start = Smooth::solution<double>(0), end = Smooth::solution<double>(2);
  for (const long n : {first, 2 * first, 4 * first}) {
    const double h = 2.0 / static_cast<double>(n);
    const auto reached = march<double>(Smooth{}, choice, start, h, n);
    REQUIRE_FALSE(reached.failure);
    points.push_back({h, apart(reached.y, end)});
  }
  INFO(choice.info->name << "\n" << to_text(points));
  return fitted_slope(points);
}

double slope_on_henon_heiles(const MethodChoice& choice, long first) {
  std::vector<ErrorPoint> points;
  const auto start = particle_in_plane(0.18, 0.18, 0.18, 0.18);
  const auto end = henon_heiles_flow(motion_of(start), 4.0);
  for (const long n : {first, 2 * first, 4 * first}) {
    auto integrator = classical_over(HenonHeilesField{}, choice);
    const double h = 4.0 / static_cast<double>(n);
    points.push_back({h, distance(motion_of(run(integrator, start, h, n)), end)});
  }
  return fitted_slope(points);
}

}  // namespace

TEST_CASE("implicit methods have their orders on a nonlinear system of first order that knows the time") {
  for (const auto& [name, order] : implicit_methods) {
    INFO(name);
    CHECK(methods::find(name)->order == order);
    // Multistep methods and Rodas4 come to their slope late.
    const double slope = slope_on_smooth(with_fixed_steps(name), 96);
    CHECK(std::abs(slope - order) < (name == "rodas_4" || name == "bdf_3" ? 0.55 : 0.25));
  }
}

TEST_CASE("implicit methods have their orders on the nonlinear motion of a particle") {
  for (const auto& [name, order] : implicit_methods) {
    INFO(name);
    CHECK(std::abs(slope_on_henon_heiles(with_fixed_steps(name), order > 4 ? 48 : 96) - order) < 0.15);
  }
}

TEST_CASE("orders hold in extended precision, where double has none left to show") {
  const Vector<Quad> start = Smooth::solution<Quad>(0), end = Smooth::solution<Quad>(1);
  for (const auto& [name, order] : std::vector<ImplicitMethod>{{"sdirk_4", 4}, {"bdf_6", 6}, {"trapezoidal", 2}}) {
    std::vector<ErrorPoint> points;
    for (const long n : {128, 256}) {
      const double h = 1.0 / static_cast<double>(n);
      points.push_back({h, apart(march<Quad>(Smooth{}, with_fixed_steps(name), start, h, n).y, end)});
    }
    INFO(name << "\n" << to_text(points));
    CHECK(std::abs(fitted_slope(points) - order) < 0.12);
  }
}

TEST_CASE("a particle and the same system of first order go the same way") {
  const auto start = particle_in_plane(0.18, 0.18, 0.18, 0.18);
  Vector<double> y(4);
  y << 0.18, 0.18, 0.18, 0.18;
  for (const auto& [name, order] : implicit_methods) {
    INFO(name);
    auto integrator = classical_over(HenonHeilesField{}, with_fixed_steps(name));
    const auto motion = motion_of(run(integrator, start, 0.125, 40));
    const auto reached = march<double>(HenonHeilesSystem{}, with_fixed_steps(name), y, 0.125, 40);
    Vector<double> same(4);
    same << motion.x[0], motion.x[1], motion.v[0], motion.v[1];
    CHECK(apart(same, reached.y) < 2e-14);
  }
}

TEST_CASE("errors of the adaptive stiff methods fall with the tolerance") {
  const Vector<double> start = Smooth::solution<double>(0), end = Smooth::solution<double>(5);
  for (const std::string name : {"rodas_4", "rodas_5p", "bdf"}) {
    std::vector<ErrorPoint> points;
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      const auto reached = march_to<double>(Smooth{}, method(name, {.rtol = tolerance, .atol = tolerance}), start, 5);
      points.push_back({tolerance, apart(reached.y, end)});
      CHECK(points.back().error < 100 * tolerance);
    }
    INFO(name << "\n" << to_text(points));
    CHECK(fitted_slope(points) > 0.75);
  }
}

TEST_CASE("BDF climbs to its fifth order where the solution is smooth") {
  // Of order q the number of steps grows as tolerance^(-1 / (q + 1)).
  const Vector<double> start = Smooth::solution<double>(0);
  std::vector<ErrorPoint> points;
  for (const double tolerance : {1e-9, 1e-10, 1e-11, 1e-12}) {
    const auto choice = method("bdf", {.rtol = tolerance, .atol = tolerance});
    points.push_back({tolerance, static_cast<double>(march_to<double>(Smooth{}, choice, start, 20).steps)});
  }
  INFO(to_text(points));
  CHECK(fitted_slope(points) < 0);
  CHECK(fitted_slope(points) > -1.0 / 5);
}

TEST_CASE("dense output is as good as the methods: order 3, 4 and that of the polynomial itself") {
  const auto error_inside = [](const std::string& name, double h) {
    const auto field = field_of(Smooth{}, Smooth::solution<double>(0));
    const auto choice = with_fixed_steps(name);
    const auto made = make_method<double>(*choice.info, choice.options);
    made->bind(*field);
    Vector<double> y = Smooth::solution<double>(0.5), inside(2);
    made->step(*field, 0.5, y, h);
    double worst = 0;
    for (const double theta : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      made->interpolate(*field, theta, inside);
      worst = std::max(worst, apart(inside, Smooth::solution<double>(0.5 + theta * h)));
    }
    return worst;
  };
  for (const auto& [name, order] : std::vector<ImplicitMethod>{{"rodas_4", 3}, {"rodas_5p", 4}}) {
    std::vector<ErrorPoint> points;
    for (const double h : {0.1, 0.05, 0.025}) points.push_back({h, error_inside(name, h)});
    INFO(name << "\n" << to_text(points));
    CHECK(std::abs(fitted_slope(points) - (order + 1)) < 0.35);  // of one step
  }
  // BDF: its polynomial goes through the ends of the last steps, and is as far off in between as there.
  const auto field = field_of(Smooth{}, Smooth::solution<double>(0));
  const auto choice = method("bdf", {.rtol = 1e-8, .atol = 1e-8});
  const auto made = make_method<double>(*choice.info, choice.options);
  made->bind(*field);
  Vector<double> y = Smooth::solution<double>(0), inside(2);
  double t = 0, worst = 0;
  for (int step = 0; step < 300; ++step) {
    const Vector<double> before = y;
    const double h = made->step(*field, t, y, 1.0).h;
    made->interpolate(*field, 0, inside);
    CHECK(apart(inside, before) < 1e-14);
    made->interpolate(*field, 1, inside);
    CHECK(inside == y);
    made->interpolate(*field, 0.5, inside);
    worst = std::max(worst, apart(inside, Smooth::solution<double>(t + h / 2)));
    t += h;
  }
  CHECK(worst < 1e-6);
  CHECK(t > 5);
}

TEST_CASE("implicit methods go on from a saved run with the same bits") {
  const auto check = [](const Classical<double>& used, const ParticleSystem<double>& start) {
    for (const std::int64_t n : {1, 4, 23}) check_goes_on(used, start, n, 0.03125);
  };
  ParticleSystem<double> kinetics, line;
  kinetics.variables() = {0.9851721, 3.3863953e-5, 0.0147940};  // at t = 0.4
  const Heat heat{.n = 20};
  const Vector<double> warm = heat.start();
  line.variables().assign(warm.data(), warm.data() + warm.size());
  for (const std::string name : {"rodas_4", "rodas_5p", "bdf"}) {
    INFO(name);
    const MethodChoice choice = method(name, {.rtol = 1e-5, .atol = 1e-10});
    check(classical(Kinetics{}, choice), kinetics);
    check(classical(heat, choice), line);
    check(classical_over(Gravity{.G = 1}, choice), four_bodies());
  }
  for (const auto& [name, order] : implicit_methods) {
    INFO(name);
    check(classical(Kinetics{}, with_fixed_steps(name)), kinetics);
    check(classical(heat, with_fixed_steps(name)), line);
    check(classical_over(Gravity{.G = 1}, with_fixed_steps(name)), four_bodies());
  }
}

TEST_CASE("monitors and ends in time do not change a run of BDF") {
  const auto choice = method("bdf", {.rtol = 1e-8, .atol = 1e-10});
  Simulation<double> watched(four_bodies(), classical_over(Gravity{.G = 1}, choice), Clock<double>::free(0));
  Simulation<double> alone(four_bodies(), classical_over(Gravity{.G = 1}, choice), Clock<double>::free(0));
  REQUIRE(watched.run_until(0.3).ok());
  REQUIRE(watched.run_until(0.7).ok());
  REQUIRE(watched.run(10).ok());
  REQUIRE(alone.run(watched.step()).ok());
  CHECK(same_bits(watched.particles(), alone.particles()));
}

TEST_CASE("an implicit step without solution is a named outcome that says what to do") {
  const auto failure = [](Classical<double> integrator) {
    ParticleSystem<double> s;
    s.variables() = {1};
    s.clock() = Clock<double>::fixed(0, 1);
    integrator.bind(s);
    const Advance done = integrator.advance(s, {.steps = 10});
    REQUIRE(done.failure != nullptr);
    CHECK(done.failure->kind == Outcome::Kind::solver_failure);
    CHECK(done.failure->message.find("smaller step") != std::string::npos);
    return done.failure->message;
  };
  for (const std::string name : {"backward_euler", "bdf_2"}) {
    CHECK(failure(classical(Tangent{}, method(name))).find("Newton's iteration") == 0);
  }
  // y' = y and h = 1: the matrix 1 - h is 0.
  CHECK(failure(classical(Linear{.lambda = 1}, method("backward_euler"))).find("singular") != std::string::npos);
}

TEST_CASE("the trapezoidal rule is reversible, backward Euler is not") {
  const auto start = particle_in_plane(0.18, 0.18, 0.18, 0.18);
  const auto there_and_back = [&](const std::string& name) {
    auto integrator = classical_over(HenonHeilesField{}, method(name));
    CHECK(integrator.claims().reversible == (name == "trapezoidal"));
    const auto there = run(integrator, start, 0.25, 20);
    return distance(run(integrator, there, -0.25, 20), start);
  };
  CHECK(there_and_back("trapezoidal") < 1e-14);
  CHECK(there_and_back("backward_euler") > 1e-2);
  CHECK(there_and_back("sdirk_3") > 1e-6);
}
