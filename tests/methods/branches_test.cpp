/// Forces that branch on positions: in lanes, stages that take different branches get the bits of one stage at a time.

#include "engine/simulation.hpp"
#include "forces/sum.hpp"
#include "integrators/classical.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

#include <cmath>
#include <type_traits>

using namespace noether;

namespace {

/// Elastic walls at x = 1 and x = -1, as a user would write them.
struct Walls {
  double k = 100;
  static ForceClaims claims() { return {.keeps_momentum = false, .keeps_angular_momentum = false}; }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) {
      const Real x = s.positions().component(0)[i];
      if (x > Real(1)) {
        out.force(i, {-Real(k) * (x - Real(1)), Real(0), Real(0)});
        out.energy(Real(k) * (x - Real(1)) * (x - Real(1)) / Real(2));
      } else if (x < Real(-1)) {
        out.force(i, {-Real(k) * (x + Real(1)), Real(0), Real(0)});
        out.energy(Real(k) * (x + Real(1)) * (x + Real(1)) / Real(2));
      }
    }
  }
};

/// The same without a branch.
struct ChosenWalls {
  double k = 100;
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) {
      const Real x = s.positions().component(0)[i];
      const Real beyond =
          noether::select(x > Real(1), x - Real(1), noether::select(x < Real(-1), x + Real(1), Real(0)));
      out.force(i, {-Real(k) * beyond, Real(0), Real(0)});
    }
  }
};

/// A pull towards y = 0 by an angle E - 0.5 sin E = y, found by Newton's iteration: a loop that ends when it has
/// converged.
struct Iterated {
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    using std::abs, std::sin, std::cos;
    for (Index i = 0; i < s.size(); ++i) {
      const Real y = s.positions().component(1)[i];
      Real angle = y, error = Real(1);
      while (abs(error) > Real(1e-9)) {
        error = (angle - Real(0.5) * sin(angle) - y) / (Real(1) - Real(0.5) * cos(angle));
        angle -= error;
      }
      out.force(i, {Real(0), -angle, Real(0)});
    }
  }
};

/// The same force, never asked in lanes: what it gives in every stage is not in question.
template <class F> struct InDoubles {
  F force;
  template <class Real>
    requires(!std::is_same_v<Real, Pack>)
  void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const { force.add_to(out, s); }
};

ParticleSystem<double> balls() {
  ParticleSystem<double> s;
  s.add("first", 1, {0, 0.5, 0}, {1, 0, 0.25});
  s.add("second", 2, {0.97, -1, 0}, {-0.7, 1, 0});
  s.add("third", 0.5, {-1.03, 0, 1}, {0.3, 2, 0});
  return s;
}

struct Way {
  const MethodInfo* info;
  MethodOptions options;
};
std::vector<Way> every_way() {
  std::vector<Way> ways;
  for (const MethodInfo* info : methods::all()) {
    // What keeps the energy needs to know it of every force.
    // Copies of Tao's methods part on these balls.
    if (info->name.starts_with("tao_")) continue;
    if (info->gravity_only || make_method<double>(*info, {})->claims().conservative_only) continue;
    MethodOptions options;
    if (info->fixed && info->adaptive) options.adaptive = false;
    if (info->fixed) ways.push_back({info, options});
    options = {};
    if (info->rtol > 1e-15) options.rtol = options.atol = 1e-8;
    if (info->adaptive) ways.push_back({info, options});
  }
  return ways;
}

/// The balls after `steps` of 0.05, or after as much time.
template <class F> ParticleSystem<double> after(const F& force, const Way& way, int steps) {
  const auto integrator = classical(force, method(way.info->name, way.options));
  const bool adaptive = integrator.claims().clock == ClockMode::free;
  auto run = adaptive ? Simulation<double>(balls(), integrator) : Simulation<double>(balls(), integrator, 0.05);
  REQUIRE(run.run_until(0.05 * steps).kind == Outcome::Kind::completed);
  return run.particles();
}

}  // namespace

TEST_CASE("a force that branches gives every method the bits that it gives one stage at a time", "[branches]") {
  for (const Way& way : every_way()) {
    CAPTURE(way.info->name, way.options.adaptive.value_or(true));
    const auto alone = after(test::field_of(InDoubles<Walls>{}, InDoubles<Iterated>{}), way, 100);
    CHECK(test::same_bits(after(test::field_of(Walls{}, Iterated{}), way, 100), alone));
  }
}

TEST_CASE("branches differ in terms of a sum, alone, and beside what chooses without a branch", "[branches]") {
  for (const char* const name : {"gauss_8", "gauss_4", "implicit_midpoint"}) {
    CAPTURE(name);
    const Way way{method(name).info, {.adaptive = false}};
    const auto one = after(test::field_of(InDoubles<Walls>{}), way, 200);
    CHECK(test::same_bits(after(Walls{}, way, 200), one));
    CHECK(test::same_bits(after(ChosenWalls{}, way, 200), one));
    const auto both = after(test::field_of(InDoubles<Iterated>{}, InDoubles<Walls>{}), way, 200);
    CHECK(test::same_bits(after(Sum(Iterated{}, Walls{}), way, 200), both));
    CHECK(test::same_bits(after(Sum(Iterated{}, ChosenWalls{}), way, 200), both));
  }
}

TEST_CASE("a ball between two walls keeps its energy as its method does, in lanes too", "[branches]") {
  // The kinks of the force limit the order; 2.3e-1 was what stages gave that all took one branch.
  ParticleSystem<double> ball;
  ball.add("ball", 1, {0, 0, 0}, {1, 0, 0});
  auto run = Simulation(ball, classical(Walls{}, method("gauss_8", {.adaptive = false})), 0.05);
  const auto& energy = run.every(1, Energy{});
  REQUIRE(run.run(400).kind == Outcome::Kind::completed);
  CHECK(energy.worst() < 1e-2);
}
