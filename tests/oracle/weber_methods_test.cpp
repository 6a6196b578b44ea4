// Three ways with r'' in Weber's force: from the acceleration itself, from earlier steps, and by parts (weak).

#include "integrators/systems/pendulum.hpp"
#include "integrators/systems/weber.hpp"
#include "monitors/momentum_map.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

using namespace noether;

namespace {

constexpr const char* three_ways[] = {"weber_implicit", "weber_extrapolated", "weber_weak"};

/// Where one of a pair of equal masses is from the other, and how it moves: p = mu v - k r' n/(c^2 r), solved by hand.
struct Relative {
  Vec3<double> x, v;
};
Relative relative(const Weber& pair, const std::vector<double>& y) {
  const Vec3<double> x = of_charge(y, 0) - of_charge(y, 1), p = (of_charge(y, 2) - of_charge(y, 3)) / 2;
  const double r = std::sqrt(norm2(x)), mu = pair.masses[0] / 2, k = pair.k * pair.charges[0] * pair.charges[1];
  const Vec3<double> n = x / r;
  const double along = dot(p, n), rate = along / (mu - k / (pair.c * pair.c * r));
  return {x, Vec3<double>((p - along * n) / mu + rate * n)};
}
double energy_of(const Weber& pair, const Relative& at) {
  const double r = std::sqrt(norm2(at.x)), rate = dot(at.x, at.v) / r, k = pair.k * pair.charges[0] * pair.charges[1];
  return pair.masses[0] / 4 * norm2(at.v) + k / r * (1 - rate * rate / (2 * pair.c * pair.c));
}

MethodChoice fixed(const std::string& name) {
  MethodChoice choice = method(name);
  if (choice.info->adaptive) choice.options.adaptive = false;
  return choice;
}

/// The largest errors of a pair's energy in the first and the last tenth of a run, and that of its angular momentum.
struct Errors {
  double first = 0, last = 0, turning = 0;
};
template <class Seen> Errors errors_of(Simulation<double>& run, int steps, const Seen& seen) {
  const double start = energy_of(Weber{}, seen(run.particles().variables()));
  Errors errors;
  for (int n = 0; n < steps; ++n) {
    REQUIRE(run.run(1).ok());
    const Relative at = seen(run.particles().variables());
    const double off = std::abs(energy_of(Weber{}, at) - start);
    if (n < steps / 10) errors.first = std::max(errors.first, off);
    if (n >= steps - steps / 10) errors.last = std::max(errors.last, off);
    errors.turning = std::max(errors.turning, std::abs(cross(at.x, at.v)[2] - 0.8));
  }
  return errors;
}
Errors errors_of(const char* name, double h, int steps) {
  Simulation run(initial_state(Weber{}), classical(Weber{}, fixed(name)), h);
  return errors_of(run, steps, [](const std::vector<double>& y) { return relative(Weber{}, y); });
}

/// The relative motion of that pair as y = (x, v), with r'' solved for by hand: r'' (1 - k/(mu c^2 r)) = what is left.
struct SolvedPair {
  Index size() const { return 4; }
  std::vector<double> start() const { return {1, 0, 0, 0.8}; }
  void rates(const double& /*t*/, const Vector<double>& y, Vector<double>& dy) const {
    const double k = -1, c2 = 25, r = std::hypot(y[0], y[1]), rate = (y[0] * y[2] + y[1] * y[3]) / r;
    const double still = k / (r * r) * (1 - rate * rate / (2 * c2));
    const double along = (still + (y[2] * y[2] + y[3] * y[3] - rate * rate) / r) / (1 - k / (c2 * r));
    const double force = still + k / (c2 * r) * along;
    dy << y[2], y[3], force * y[0] / r, force * y[1] / r;
  }
};

/// So many charges of both signs, none near another, that move enough for r'' to matter.
Weber cloud(int n) {
  Weber all{.masses = {}, .charges = {}, .positions = {}, .velocities = {}, .k = 0.1, .c = 1.5};
  for (int i = 0; i < n; ++i) {
    all.masses.push_back(1 + 0.1 * (i % 4));
    all.charges.push_back(i % 2 == 0 ? 1 : -1);
    for (const int cell : {i % 3, i / 3 % 3, i / 9})
      all.positions.push_back(1.5 * cell + 0.2 * std::sin(7.0 * i + cell));
    for (int d = 0; d < 3; ++d) all.velocities.push_back(0.3 * std::cos(3.0 * i + d));
  }
  return all;
}

Vector<double> vector_of(const std::vector<double>& all, std::size_t begin, std::size_t count) {
  Vector<double> part(static_cast<Index>(count));
  for (std::size_t i = 0; i < count; ++i) part[static_cast<Index>(i)] = all[begin + i];
  return part;
}

}  // namespace

TEST_CASE("Weber's force with r'' in it is that of his Lagrangian", "[weber]") {
  const Weber system = cloud(5);
  LagrangianMotion<Weber, double> motion(system);
  const std::vector<double> start = system.start();
  const Vector<double> q = vector_of(start, 0, 15), p = vector_of(start, 15, 15);
  Vector<double> v, a, w, again;
  REQUIRE(!motion.velocity(0, q, p, v));
  for (Index d = 0; d < 15; ++d) CHECK(std::abs(v[d] - system.velocities[static_cast<std::size_t>(d)]) < 1e-15);
  REQUIRE(!motion.solve_acceleration(0, q, v, true, a));
  motion.find_second_rates(q, v, a, w);
  REQUIRE(w.size() == 10);
  motion.acceleration_with(0, q, v, w, again);
  CHECK((again - a).cwiseAbs().maxCoeff() < 1e-15);
  CHECK(a.cwiseAbs().maxCoeff() > 0.01);
  // r'' is what r' changes by, along x + v s + a s^2/2.
  const double s = 1e-4;
  const auto apart = [&](double at) {
    const Vector<double> x = q + at * v + at * at / 2 * a;
    return std::sqrt(norm2(Vec3<double>(of_charge(x, 3) - of_charge(x, 1))));
  };
  CHECK(std::abs((apart(s) - 2 * apart(0) + apart(-s)) / (s * s) - w[4]) < 1e-6);
}

// Of prototypes in C++, 50000 steps of 0.02 (C29): r'' by the acceleration 2.350e-4 in both tenths,
// extrapolated 4.337e-4 and 1.953e-3, RK4 on solved accelerations 2.060e-6 and 2.067e-5 with 5.53e-6 of angular
// momentum lost.
TEST_CASE("over 250 orbits r'' of the acceleration keeps the energy, extrapolated r'' loses it, and both keep L",
          "[weber][slow]") {
  const Errors implicit = errors_of("weber_implicit", 0.02, 50000);
  CAPTURE(implicit.first, implicit.last, implicit.turning);
  CHECK(std::abs(implicit.first - 2.350e-4) < 0.005e-4);
  CHECK(std::abs(implicit.last - 2.350e-4) < 0.005e-4);
  CHECK(implicit.turning < 1e-12);
  const Errors extrapolated = errors_of("weber_extrapolated", 0.02, 50000);
  CAPTURE(extrapolated.first, extrapolated.last, extrapolated.turning);
  CHECK(std::abs(extrapolated.first - 4.34e-4) < 0.05e-4);
  CHECK(std::abs(extrapolated.last - 1.95e-3) < 0.02e-3);
  CHECK(extrapolated.turning < 1e-12);
  const Errors weak = errors_of("weber_weak", 0.02, 50000);
  CAPTURE(weak.first, weak.last, weak.turning);
  CHECK(std::abs(weak.last / weak.first - 1) < 0.01);
  CHECK(weak.turning < 1e-12);
  Simulation run(initial_state(SolvedPair{}), classical(SolvedPair{}, method("rk4")), 0.02);
  const Errors rk4 = errors_of(run, 50000, [](const std::vector<double>& y) {
    return Relative{{y[0], y[1], 0}, {y[2], y[3], 0}};
  });
  CAPTURE(rk4.first, rk4.last, rk4.turning);
  CHECK(std::abs(rk4.first - 2.060e-6) < 0.002e-6);
  CHECK(std::abs(rk4.last - 2.067e-5) < 0.002e-5);
  CHECK(std::abs(rk4.turning - 5.53e-6) < 0.01e-6);
}

TEST_CASE("all three ways with r'' are of order 2", "[weber][order]") {
  for (const char* name : three_ways) {
    std::array<double, 2> off{};
    for (std::size_t fine = 0; fine < 2; ++fine) {
      const Weber pair{};
      Simulation run(initial_state(pair), classical(pair, method(name)), fine == 0 ? 0.01 : 0.005);
      REQUIRE(run.run(fine == 0 ? 2000 : 4000).ok());
      const Relative at = relative(pair, run.particles().variables());
      // where elliptic integrals and 40 digits have it (geometry/nonseparable.json)
      off[fine] = std::hypot(at.x[0] - 0.75529965197821358317, at.x[1] - 0.62456010047866138655);
    }
    CAPTURE(name, off[0], off[1]);
    CHECK(off[0] < 0.02);
    CHECK(std::abs(std::log2(off[0] / off[1]) - 2) < 0.1);
  }
}

// m (v+ - v-)/h = (g+ + g-)/2 + (P+ - P-)/h with g = dL/dq less what r'' gives, and P = k e e' r' n/(c^2 r), which is
// the r'' of the force integrated by parts over hats in time; v and the places are those between three positions.
TEST_CASE("the weak form of Weber's force is variational_midpoint", "[weber]") {
  CHECK(method("weber_weak").info == method("variational_midpoint").info);
  const Weber pair{};
  const double h = 0.05, c2 = pair.c * pair.c, coupling = pair.k * pair.charges[0] * pair.charges[1];
  Simulation run(initial_state(pair), classical(pair, method("weber_weak")), h);
  std::array<Vec3<double>, 3> x{};
  for (std::size_t n = 0; n < 40; ++n) {
    const auto& y = run.particles().variables();
    x = {x[1], x[2], Vec3<double>(of_charge(y, 0) - of_charge(y, 1))};
    REQUIRE(run.run(1).ok());
    if (n < 2) continue;
    Vec3<double> left(0, 0, 0);
    for (std::size_t side = 0; side < 2; ++side) {
      const Vec3<double> u = (x[side + 1] - x[side]) / h, at = (x[side + 1] + x[side]) / 2;
      const double r = std::sqrt(norm2(at));
      const Vec3<double> normal = at / r;
      const double rate = dot(normal, u);
      // d/dq of -(k/r)(1 + r'^2/(2 c^2)), where r' = n . u turns with n
      const Vec3<double> slope = coupling / (r * r) * (1 + rate * rate / (2 * c2)) * normal -
                                 coupling * rate / (c2 * r * r) * (u - rate * normal);
      const Vec3<double> momentum = u - coupling * rate / (c2 * r) * normal;  // a reduced mass of 1
      left += (side == 0 ? 1.0 : -1.0) / h * momentum + slope / 2;
    }
    CHECK(left.cwiseAbs().maxCoeff() < 1e-11);
  }
}

TEST_CASE("all three ways with r'' keep energy, momentum and angular momentum of 2, 3 and 20 charges",
          "[weber][slow]") {
  for (const char* name : three_ways) {
    for (const int n : {2, 3, 20}) {
      CAPTURE(name, n);
      const Weber system = cloud(n);
      Simulation run(initial_state(system), classical(system, method(name)), 0.02);
      Energy& energy = run.every(1, Energy());
      std::vector<MomentumMap*> maps;
      for (const Symmetry& one : system.symmetries()) maps.push_back(&run.every(1, MomentumMap(system, one.name)));
      REQUIRE(run.run(n == 20 ? 2 : 100).ok());
      CHECK(energy.worst() < 2e-4);
      CHECK(energy.worst() > 1e-9);
      for (const MomentumMap* map : maps) CHECK(map->worst() < 2e-13);
    }
  }
}

TEST_CASE("like charges turn at k/E, or end by name before their mass vanishes, whatever is done with r''",
          "[weber][extremes]") {
  const auto head_on = [](double c) {
    return Weber{
        .charges = {1, 1}, .positions = {2.5, 0, 0, -2.5, 0, 0}, .velocities = {-0.5, 0, 0, 0.5, 0, 0}, .c = c};
  };
  for (const char* name : three_ways) {
    CAPTURE(name);
    Simulation run(initial_state(head_on(2)), classical(head_on(2), method(name)), 0.01);
    double nearest = 5;
    for (int n = 0; n < 1000; ++n) {
      REQUIRE(run.run(1).ok());
      nearest = std::min(nearest, std::sqrt(norm2(relative(head_on(2), run.particles().variables()).x)));
    }
    CHECK(std::abs(nearest - 1.48148148148148148148) < 2e-4);  // k/E; looked at every 0.01, of order 2
    // r_c = k/(mu c^2) = 4 comes before k/E = 3.33 or so.
    Simulation fall(initial_state(head_on(0.5)), classical(head_on(0.5), method(name)), 0.01);
    const Outcome outcome = fall.run(100000);
    CAPTURE(outcome.message);
    CHECK(outcome.kind == Outcome::Kind::solver_failure);
    const auto& y = fall.particles().variables();
    CHECK(y[0] - y[3] > 4);
    CHECK(y[0] - y[3] < 4.5);
  }
}

TEST_CASE("two pairs of like charges whose masses vanish at the same time end by name too", "[weber][extremes]") {
  // The determinant of all masses keeps its sign: that of each pair changes.
  const Weber far{.masses = {2, 2, 2, 2},
                  .charges = {1, 1, 1, 1},
                  .positions = {2.5, 1e6, 0, -2.5, 1e6, 0, 2.5, -1e6, 0, -2.5, -1e6, 0},
                  .velocities = {-0.5, 0, 0, 0.5, 0, 0, -0.5, 0, 0, 0.5, 0, 0},
                  .c = 0.5};
  for (const char* name :
       {"weber_implicit", "weber_extrapolated", "weber_weak", "galerkin_gauss_2", "rk4", "gauss_2"}) {
    Simulation fall(initial_state(far), classical(far, fixed(name)), 0.01);
    const Outcome outcome = fall.run(100000);
    CAPTURE(name, outcome.message);
    CHECK(outcome.kind == Outcome::Kind::solver_failure);
    const auto& y = fall.particles().variables();
    CHECK(y[0] - y[3] > 4);
    CHECK(y[0] - y[3] < 4.5);
  }
}

TEST_CASE("extrapolated r'' goes on bit for bit after a restart", "[weber][restart]") {
  const auto make = [] {
    return Simulation(initial_state(Weber{}), classical(Weber{}, method("weber_extrapolated")), 0.05);
  };
  auto whole = make(), first = make(), second = make();
  REQUIRE(whole.run(20).ok());
  REQUIRE(first.run(7).ok());
  second.restore(first.save());
  REQUIRE(second.run(13).ok());
  CHECK(whole.particles().variables() == second.particles().variables());
  CHECK(whole.evaluations().force == second.evaluations().force);
}

TEST_CASE("methods for r'' in forces refuse systems that tell none, and say what they keep", "[weber]") {
  CHECK_THROWS_WITH(Simulation(initial_state(SimplePendulum{}, {0.1}, {0.2}),
                               classical(SimplePendulum{}, method("weber_implicit")), 0.1),
                    "method 'weber_implicit' treats second derivatives in forces, such as r'' in Weber's, but system "
                    "'pendulum' names none; use 'variational_midpoint'");
  const auto claims = [](const char* name) {
    return Simulation(initial_state(Weber{}), classical(Weber{}, method(name)), 0.1).claims();
  };
  CHECK_FALSE(claims("weber_implicit").symplectic);
  CHECK(claims("weber_implicit").reversible);
  CHECK_FALSE(claims("weber_extrapolated").reversible);
  CHECK(claims("weber_weak").symplectic);
}
