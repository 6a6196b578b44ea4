/// Projection onto invariants: published figures on Kepler orbits, what is kept, what is moved, what is refused.

#include "integrators/projected.hpp"

#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/linear_drag.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/first_order_system.hpp"
#include "monitors/monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/kepler_pair.hpp"
#include "tests/support/planets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

namespace noether {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::WithinRel;

using Onto = std::vector<Invariant>;
const Onto to_energy = {Invariant::energy}, to_momentum = {Invariant::momentum},
           to_angular = {Invariant::angular_momentum}, to_both = {Invariant::energy, Invariant::angular_momentum};

AnyIntegrator<double> pair_by(const std::string& name) {
  if (const Scheme* scheme = schemes::find(name)) return compose(test::kinetic_potential(Gravity{}), *scheme);
  MethodChoice choice = method(name);
  if (choice.info->fixed && choice.info->adaptive) choice.options.adaptive = false;
  return test::classical_over(Gravity{}, choice);
}
AnyIntegrator<double> pair_held(const std::string& name, ProjectionOptions options) {
  if (options.onto.empty()) return pair_by(name);
  return projected(pair_by(name), std::move(options));
}

/// What is left after whole turns of the pair.
struct PairEnd {
  ParticleSystem<double> particles;
  double error, energy, angular_momentum, iterations;
};

PairEnd pair_end(AnyIntegrator<double> integrator, int steps_a_turn, int turns = 10,
                 const ParticleSystem<double>& start = test::pairs::kepler_pair()) {
  Simulation<double> sim(start, std::move(integrator), test::pairs::turn / steps_a_turn);
  const Outcome outcome = sim.run(steps_a_turn * turns);
  INFO(outcome.message);
  REQUIRE(outcome.ok());
  const ParticleSystem<double>& s = sim.particles();
  const double mass = 0.75 * 0.25;  // of the relative motion, whose figures are published
  return {s, test::pairs::error_after_turns(s),
          std::abs(test::pairs::energy_of(s) - test::pairs::energy_of(start)) / mass,
          (test::pairs::angular_momentum_of_pair(s) - test::pairs::angular_momentum_of_pair(start)).norm() / mass,
          sim.evaluations().projection.mean()};
}

/// A row of the oracle: Kepler, e = 0.6, ten orbits.
struct ProjectedRow {
  std::string method;
  int steps;
  Onto onto;
  double error, iterations;
};

}  // namespace

TEST_CASE("figures of projected Kepler orbits are those of an independent program", "[integrators][projected]") {
  const std::vector<ProjectedRow> rows = {{"rk4", 200, {}, 7.443e-3, 0},
                                          {"rk4", 200, to_energy, 8.525e-6, 1.08},
                                          {"rk4", 200, to_angular, 4.25e-3, 1},
                                          {"rk4", 200, to_both, 1.914e-5, 1.08},
                                          {"euler", 1000, {}, 3.312, 0},
                                          {"euler", 1000, to_energy, 0.0719, 2.35},
                                          {"euler", 1000, to_angular, 1.127, 2.21},
                                          {"euler", 1000, to_both, 0.01201, 2.42},
                                          {"verlet", 200, {}, 1.032, 0},
                                          {"verlet", 200, to_energy, 0.02121, 1.99},
                                          {"verlet", 200, to_both, 0.04246, 2.19}};
  for (const ProjectedRow& row : rows) {
    CAPTURE(row.method, ProjectionOptions{.onto = row.onto}.words());
    const PairEnd end = pair_end(pair_held(row.method, {.onto = row.onto}), row.steps);
    CHECK_THAT(end.error, WithinRel(row.error, 0.02));
    CHECK(std::abs(end.iterations - row.iterations) < 0.2);
    const auto kept = [&](Invariant one) { return std::count(row.onto.begin(), row.onto.end(), one) > 0; };
    if (kept(Invariant::energy)) CHECK(end.energy < 1e-14);
    if (kept(Invariant::angular_momentum)) CHECK(end.angular_momentum < 1e-14);
    if (!kept(Invariant::energy)) CHECK(end.energy > 1e-5);
  }
}

TEST_CASE("masses weigh, so that a pair is projected as its relative motion is", "[integrators][projected]") {
  const auto end = [](double m, ProjectionNorm norm) {
    return pair_end(pair_held("rk4", {.onto = to_both, .norm = norm}), 200, 10, test::pairs::kepler_pair(0.6, m));
  };
  const auto center_moves = [](const ParticleSystem<double>& s) {
    const Vec3<double> x = s.positions()[0], y = s.positions()[1];
    return Vec3<double>(s.masses()[0] * x + s.masses()[1] * y).norm();
  };
  for (const double m : {0.5, 0.75, 0.999}) {
    CAPTURE(m);
    const PairEnd by_mass = end(m, ProjectionNorm::mass), plain = end(m, ProjectionNorm::plain);
    CHECK_THAT(by_mass.error, WithinRel(1.914e-5, 0.02));
    CHECK(center_moves(by_mass.particles) < 1e-13);
    CHECK((center_moves(plain.particles) < 1e-13) == (m == 0.5));  // of equal masses: no difference
  }
}

TEST_CASE("a symmetric projection is undone by steps back", "[integrators][projected]") {
  const ProjectionOptions symmetric{.onto = to_both, .how = Projection::symmetric};
  const PairEnd end = pair_end(pair_held("verlet", symmetric), 200);
  CHECK_THAT(end.error, WithinRel(4.189e-2, 0.02));
  CHECK(std::abs(end.iterations - 6.7) < 1);
  CHECK(end.energy < 1e-14);
  const auto there_and_back = [](const ProjectionOptions& options) {
    Simulation<double> sim(test::pairs::kepler_pair(), pair_held("verlet", options), test::pairs::turn / 200);
    REQUIRE(sim.run(200).ok());
    sim.change_step(-test::pairs::turn / 200);
    REQUIRE(sim.run(200).ok());
    return test::pairs::error_after_turns(sim.particles());
  };
  CHECK(there_and_back(symmetric) < 1e-14);
  CHECK(there_and_back({.onto = to_both}) > 1e-9);
}

TEST_CASE("a state that is there already keeps its bits", "[integrators][projected]") {
  for (const char* name : {"verlet", "yoshida_4", "implicit_midpoint", "gauss_3"}) {
    for (const Projection how : {Projection::orthogonal, Projection::symmetric}) {
      CAPTURE(name, static_cast<int>(how));
      Simulation<double> bare(test::pairs::kepler_pair(), pair_by(name), test::pairs::turn / 200),
          sim(test::pairs::kepler_pair(),
              pair_held(name, {.onto = {Invariant::momentum, Invariant::angular_momentum}, .how = how}),
              test::pairs::turn / 200);
      REQUIRE(bare.run(200).ok());
      REQUIRE(sim.run(200).ok());
      CHECK(test::same_bits(sim.particles(), bare.particles()));
      CHECK(sim.evaluations().projection.steps == 200);
      CHECK(sim.evaluations().projection.iterations == 0);
    }
  }
}

TEST_CASE("a projection along velocities rescales them", "[integrators][projected]") {
  Simulation<double> bare(test::pairs::kepler_pair(), pair_by("rk4"), 0.1),
      sim(test::pairs::kepler_pair(),
          pair_held("rk4", {.onto = to_energy, .how = Projection::oblique, .moves = Moves::velocities}), 0.1);
  REQUIRE(bare.run(1).ok());
  REQUIRE(sim.run(1).ok());
  const Vec3<double> v = bare.particles().velocities()[1], w = sim.particles().velocities()[1];
  CHECK(test::pairs::apart(bare.particles()) == test::pairs::apart(sim.particles()));
  CHECK(cross(v, w).norm() < 1e-15);
  CHECK(w != v);
  CHECK(std::abs(test::pairs::energy_of(sim.particles()) - test::pairs::energy_of(test::pairs::kepler_pair())) < 1e-15);
  // A direction of one's own: along the radius alone.
  std::vector<double> direction(12, 0);
  direction[0] = -0.25;
  direction[1] = 0.75;
  Simulation<double> along(test::pairs::kepler_pair(),
                           pair_held("rk4", {.onto = to_energy, .how = Projection::oblique, .direction = direction}),
                           0.1);
  REQUIRE(along.run(1).ok());
  CHECK(test::pairs::apart(along.particles())[1] == test::pairs::apart(bare.particles())[1]);
  CHECK(test::pairs::apart(along.particles())[0] != test::pairs::apart(bare.particles())[0]);
  CHECK(along.particles().velocities()[1] == bare.particles().velocities()[1]);
}

TEST_CASE("what every method remembers goes on from the moved state", "[integrators][projected]") {
  // The order stays, for methods with a history too: were that stale or lost, they would fall to lower orders.
  struct Way {
    std::string method;
    double order;
    int steps;
  };
  const double until = 0.7 * test::pairs::turn;
  const ParticleSystem<double> start = test::pairs::kepler_pair(0.3);
  Simulation<double> exact(start, test::classical_over(Gravity{}, method("gauss_radau_15")));
  REQUIRE(exact.run_until(until).ok());
  for (const Way& way : {Way{"dormand_prince_5", 5, 60},
                         {"adams_bashforth_4", 4, 300},
                         {"adams_moulton_3", 3, 150},
                         {"stormer_cowell_12", 12, 90},
                         {"bdf_3", 3, 300},
                         {"gauss_2", 4, 40}}) {
    const auto error = [&](int steps, bool project) {
      const ProjectionOptions options{.onto = project ? to_energy : Onto{}};
      Simulation<double> sim(start, pair_held(way.method, options), until / steps);
      REQUIRE(sim.run(steps).ok());
      if (project) CHECK(std::abs(test::pairs::energy_of(sim.particles()) - test::pairs::energy_of(start)) < 1e-14);
      return (test::pairs::apart(sim.particles()) - test::pairs::apart(exact.particles())).norm();
    };
    const double longer = error(way.steps, true), shorter = error(way.steps * 3 / 2, true);
    const double slope = std::log(longer / shorter) / std::log(1.5);
    CAPTURE(way.method, longer, shorter, slope, error(way.steps, false));
    CHECK(slope > way.order - 0.5);
    CHECK(longer < 2 * error(way.steps, false));
  }
}

TEST_CASE("adaptive methods keep the lengths of their steps, and states between them are projected",
          "[integrators][projected]") {
  for (const char* name :
       {"dormand_prince_5", "dop853", "adams_pece", "bdf", "gragg_bulirsch_stoer", "rodas_4", "gauss_radau_15"}) {
    CAPTURE(name);
    const std::string text = name;
    const double rtol = text == "gauss_radau_15" ? 1e-12 : text == "bdf" || text == "rodas_4" ? 1e-5 : 1e-7;
    const auto run = [&](bool project, double interval) {
      AnyIntegrator<double> integrator = test::classical_over(Gravity{}, method(name, {.rtol = rtol}));
      if (project) integrator = projected(std::move(integrator), {.onto = to_both});
      Simulation<double> sim(test::pairs::kepler_pair(), std::move(integrator), Clock<double>::free(0));
      Energy* energy = interval > 0 ? &sim.every_time(interval, Energy()) : nullptr;
      REQUIRE(sim.run_until(test::pairs::turn).ok());
      return std::tuple(sim.step(), energy != nullptr ? energy->worst() : 0, sim.particles());
    };
    const auto [steps, worst, end] = run(true, 0.037);
    const auto [bare_steps, bare_worst, bare_end] = run(false, 0.037);
    CHECK(worst < 1e-13);
    if (text != "gauss_radau_15") CHECK(bare_worst > 1e-11);
    CHECK(steps < 1.3 * static_cast<double>(bare_steps) + 5);
    CHECK(test::same_bits(std::get<2>(run(true, 0)), end));  // whatever looked on
  }
}

TEST_CASE("states between steps of one length are projected, and the run does not know of it",
          "[integrators][projected]") {
  for (const char* name : {"dormand_prince_5", "dop853", "rodas_4", "encke_gauss_8", "wide_gauss_8"}) {
    CAPTURE(name);
    const auto run = [&](const ProjectionOptions& options, bool look) {
      Simulation<double> sim(test::pairs::kepler_pair(), pair_held(name, options), test::pairs::turn / 50);
      Energy* energy = look ? &sim.every_time(0.037, Energy()) : nullptr;
      REQUIRE(sim.run(50).ok());
      return std::pair(look ? energy->worst() : 0, sim.particles());
    };
    const auto [worst, end] = run({.onto = to_both}, true);
    CHECK(worst < 1e-13);
    CHECK(test::same_bits(run({.onto = to_both}, false).second, end));
    if (pair_by(name).claims().order < 10) CHECK(run({}, true).first > 1e-8);
  }
}

namespace {

/// y of Laplace's vector of a pair with G (m1 + m2) = 1.
struct LaplaceY {
  template <class Real> Real operator()(const ParticleState<Real>& s) const {
    using std::sqrt;
    const Vec3<Real> r = s.x(1) - s.x(0), v = s.v(1) - s.v(0), l = cross(r, v);
    return Real(cross(v, l)[1] - r[1] / Real(sqrt(norm2(r))));
  }
};

/// Energy and angular momentum about z of a pair, as a program would write them.
struct EnergyAndTurn {
  template <class Real> std::array<Real, 2> operator()(const ParticleState<Real>& s) const {
    using std::sqrt;
    const Vec3<Real> r = s.x(1) - s.x(0);
    Real energy = -s.m(0) * s.m(1) / Real(sqrt(norm2(r))), turn_z(0);
    for (Index i = 0; i < s.size(); ++i) {
      energy += s.m(i) * norm2(s.v(i)) / Real(2);
      turn_z += s.m(i) * cross(s.x(i), s.v(i))[2];
    }
    return {energy, turn_z};
  }
};

/// Predators and prey, on closed curves.
struct Predators {
  static constexpr auto describe() { return part<Predators>("predators", "they eat and are eaten"); }
  Index size() const { return 2; }
  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const {
    dy[0] = y[0] * (Real(1) - y[1]);
    dy[1] = y[1] * (y[0] - Real(1));
  }
  std::vector<double> start() const { return {2, 0.5}; }
};
struct Balance {
  template <class Real> Real operator()(const Vector<Real>& y) const {
    using std::log;
    return Real(y[0] - log(y[0]) + y[1] - log(y[1]));
  }
};
double balance_of(const ParticleSystem<double>& s) {
  return Balance{}(Vector<double>(Eigen::Map<const Vector<double>>(s.variables().data(), 2)));
}

}  // namespace

TEST_CASE("an invariant of one's own is held, of particles and of first-order systems", "[integrators][projected]") {
  const auto laplace = [](const ParticleSystem<double>& s) {
    Vector<double> y;
    detail::gather_particles(s, y);
    const double masses[] = {0.75, 0.25};
    return LaplaceY{}(ParticleState<double>(y, masses));
  };
  Simulation<double> sim(test::pairs::kepler_pair(), projected(pair_by("rk4"), {.onto = to_both}, LaplaceY{}),
                         test::pairs::turn / 100);
  const Outcome outcome = sim.run(300);
  INFO(outcome.message);
  REQUIRE(outcome.ok());
  CHECK(std::abs(laplace(sim.particles())) < 1e-13);
  CHECK(std::abs(test::pairs::energy_of(sim.particles()) - test::pairs::energy_of(test::pairs::kepler_pair())) < 1e-14);

  Simulation<double> both(test::pairs::kepler_pair(), projected(pair_by("rk4"), {}, EnergyAndTurn{}),
                          test::pairs::turn / 200);
  REQUIRE(both.run(2000).ok());
  CHECK_THAT(test::pairs::error_after_turns(both.particles()), WithinRel(1.914e-5, 0.02));

  for (const char* name : {"heun", "rk4", "bdf_2"}) {
    CAPTURE(name);
    Simulation<double> bare(initial_state(Predators{}), classical(Predators{}, method(name)), 0.1),
        kept(initial_state(Predators{}), projected(classical(Predators{}, method(name)), {}, Balance{}), 0.1);
    REQUIRE(bare.run(300).ok());
    REQUIRE(kept.run(300).ok());
    CHECK(std::abs(balance_of(kept.particles()) - balance_of(initial_state(Predators{}))) < 1e-14);
    CHECK(std::abs(balance_of(bare.particles()) - balance_of(initial_state(Predators{}))) > 1e-7);
  }
}

TEST_CASE("in 113 bits rounding is that of 113 bits", "[integrators][projected]") {
  const ParticleSystem<Quad> start = test::pairs::kepler_pair<Quad>();
  AnyIntegrator<Quad> rk4 = test::classical_over(test::field_of<Quad>(Gravity{}), method("rk4"));
  Simulation<Quad> sim(start, projected(std::move(rk4), {.onto = to_both}), test::pairs::turn / 200);
  REQUIRE(sim.run(200).ok());
  CHECK(abs(test::pairs::energy_of(sim.particles()) - test::pairs::energy_of(start)) < Quad(1e-32));
  CHECK(norm2(Vec3<Quad>(test::pairs::angular_momentum_of_pair(sim.particles()) -
                         test::pairs::angular_momentum_of_pair(start))) < Quad(1e-64));
  CHECK(test::pairs::error_after_turns(sim.particles()) < 1e-4);
}

TEST_CASE("a projection says what it keeps and what it destroys", "[integrators][projected]") {
  const IntegratorClaims bare = pair_by("verlet").claims(), both = pair_held("verlet", {.onto = to_both}).claims();
  CHECK((bare.symplectic && bare.reversible && bare.keeps_momentum));
  CHECK_FALSE((both.symplectic || both.reversible || both.keeps_momentum));
  CHECK((both.energy_exact && both.keeps_angular_momentum));
  CHECK(pair_held("verlet", {.onto = to_energy, .how = Projection::symmetric}).claims().reversible);
  CHECK_FALSE(pair_held("rk4", {.onto = to_energy, .how = Projection::symmetric}).claims().reversible);
  Simulation<double> sim(test::pairs::kepler_pair(), pair_held("verlet", {.onto = to_energy}), 0.1);
  CHECK_THROWS_WITH(sim.every(1, ShadowHamiltonian<double>(std::vector<std::int64_t>{4})),
                    Contains("a projection moves the state after every step, so the motion has no action"));
}

TEST_CASE("a state that cannot be reached ends the run by name", "[integrators][projected]") {
  // A particle that rolls up a hill loses all its velocity before it is there.
  Simulation<double> sim(
      test::pairs::kepler_pair(0.9),
      pair_held("euler", {.onto = to_energy, .how = Projection::oblique, .moves = Moves::velocities}), 0.5);
  const Outcome outcome = sim.run(200);
  CHECK(outcome.kind == Outcome::Kind::solver_failure);
  CHECK_THAT(outcome.message, Contains("no state was found on the invariants"));
  CHECK_THAT(outcome.message, Contains("energy is off by"));
}

TEST_CASE("a tolerance is what may be left, and not 64 of it", "[integrators][projected]") {
  // Thrown up, and by Euler's second step higher than its energy reaches, by 2 % of that energy.
  ParticleSystem<double> thrown;
  thrown.add("stone", 1, {0, 0, 0}, {0, 0, 1});
  const auto euler = test::classical_over(UniformField{{0, 0, -1}}, method("euler"));
  Simulation<double> up(
      thrown,
      projected(euler, {.onto = to_energy, .how = Projection::oblique, .moves = Moves::velocities, .tolerance = 1e-3}),
      0.51);
  const Outcome outcome = up.run(1);
  CHECK(outcome.kind == Outcome::Kind::solver_failure);
  CHECK_THAT(outcome.message, Contains("energy is off by"));

  for (const double tolerance : {1e-3, 1e-6, 1e-14}) {
    for (const Projection how : {Projection::orthogonal, Projection::symmetric}) {
      CAPTURE(tolerance, static_cast<int>(how));
      Simulation<double> sim(test::pairs::kepler_pair(),
                             pair_held("verlet", {.onto = to_energy, .how = how, .tolerance = tolerance}),
                             test::pairs::turn / 200);
      const auto& energy = sim.every(1, Energy());
      const Outcome end = sim.run(400);
      INFO(end.message);
      CHECK(end.ok());
      CHECK(energy.worst() < 8 * tolerance + 1e-14);  // |T| + |U| is 7 |H| at the pericenter
    }
  }
}

TEST_CASE("an invariant of positions is refused in a periodic box, where they jump", "[integrators][projected]") {
  ParticleSystem<double> s = test::pairs::kepler_pair();
  s.set_box(Box::periodic({10, 10, 10}));
  const auto bare = compose(test::kinetic_potential(UniformField{}), schemes::verlet);
  const ProjectionOptions kicks{.how = Projection::oblique, .moves = Moves::velocities};
  CHECK_THROWS_WITH(Simulation<double>(s, projected(bare, kicks, LaplaceY{}), 0.1),
                    Contains("depends on positions, which jump where particles cross the periodic box"));
  const auto speeds = [](const auto& state) { return dot(state.v(0), state.v(0)); };
  CHECK_NOTHROW(Simulation<double>(s, projected(bare, kicks, speeds), 0.1));
}

namespace {

/// A number that grows, and its logarithm, which is not conserved: there is nothing to be reached beyond e.
struct Growth {
  static constexpr auto describe() { return part<Growth>("growth", "a number that grows"); }
  Index size() const { return 1; }
  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const { dy[0] = y[0]; }
  std::vector<double> start() const { return {1}; }
};
struct Logarithm {
  template <class Real> Real operator()(const Vector<Real>& y) const {
    using std::log;
    return Real(log(y[0]));
  }
};

}  // namespace

TEST_CASE("a trial of a symmetric step that diverges is not the end of the step", "[integrators][projected]") {
  Simulation<double> sim(initial_state(Growth{}),
                         projected(classical(Growth{}, method("euler")), {.how = Projection::symmetric}, Logarithm{}),
                         3.0);
  const Outcome outcome = sim.run(1);
  CHECK(outcome.kind == Outcome::Kind::solver_failure);
  CHECK_THAT(outcome.message, Contains("an invariant of your own is not finite after 1 iterations"));
}

namespace {

/// Euler's method by someone who has not heard of projections.
class OutsideEuler final : public Method<double> {
 public:
  std::unique_ptr<Method<double>> clone() const override { return std::make_unique<OutsideEuler>(*this); }
  MethodClaims claims() const override { return {.name = "outside_euler", .order = 1}; }
  void bind(const VectorField<double>& f) override { rate_.resize(f.size()); }
  StepResult step(VectorField<double>& f, const double& t, Vector<double>& y, double h) override {
    f.rate(t, y, rate_);
    y += h * rate_;
    return {.h = h};
  }
  void save(SavedState& /*saved*/, const std::string& /*prefix*/) const override {}
  void load(const SavedState& /*saved*/, const std::string& /*prefix*/) override {}

 private:
  Vector<double> rate_;
};

std::unique_ptr<Method<double>> outside_euler(const MethodInfo& /*info*/, const MethodOptions& /*options*/) {
  return std::make_unique<OutsideEuler>();
}

}  // namespace

TEST_CASE("a method that does not say what it remembers is refused by name", "[integrators][projected]") {
  const MethodInfo info{.name = "outside_euler", .make = outside_euler};
  const auto euler = test::classical_over(Gravity{}, MethodChoice{&info, {}});
  Simulation<double> bare(test::pairs::kepler_pair(), euler, 0.1);
  CHECK(bare.run(1).ok());
  CHECK_THROWS_WITH(Simulation<double>(test::pairs::kepler_pair(), projected(euler, {.onto = to_energy}), 0.1),
                    Contains("method 'outside_euler' remembers a state that a projection moves"));
}

TEST_CASE("what cannot be projected onto is refused in one line", "[integrators][projected]") {
  const auto refusal = [](AnyIntegrator<double> integrator, const ProjectionOptions& options) {
    try {
      Simulation<double> sim(test::pairs::kepler_pair(), projected(std::move(integrator), options), 0.1);
    } catch (const Error& error) {
      return error.message();
    }
    return std::string("nothing");
  };
  CHECK_THAT(refusal(pair_by("verlet"), {}), Contains("onto = [] is empty"));
  CHECK_THAT(refusal(pair_by("verlet"), {.onto = {Invariant::energy, Invariant::energy}}),
             Contains("has energy twice"));
  CHECK_THAT(refusal(pair_by("verlet"), {.onto = to_angular, .how = Projection::hamiltonian}),
             Contains("{J_z, J_z} = 0"));
  CHECK_THAT(refusal(pair_by("verlet"), {.onto = to_energy, .how = Projection::hamiltonian}), Contains("{H, H} = 0"));
  CHECK_THROWS_WITH(Simulation<double>(test::pairs::kepler_pair(),
                                       projected(pair_by("verlet"), {.how = Projection::hamiltonian}, LaplaceY{}), 0.1),
                    Contains("{g, g} = 0"));
  CHECK_THAT(refusal(pair_by("verlet"), {.onto = to_energy, .how = Projection::oblique}), Contains("has no direction"));
  CHECK_THAT(refusal(pair_by("adams_bashforth_4"), {.onto = to_energy, .how = Projection::symmetric}),
             Contains("goes on from earlier states"));
  CHECK_THAT(refusal(pair_by("verlet"), {.onto = {Invariant::constraints}}), Contains("no constraints"));
  const auto pushed = compose(test::kinetic_potential(UniformField{{1, 0, 0}}), schemes::verlet);
  CHECK_THAT(refusal(pushed, {.onto = to_momentum}), Contains("the momentum is not conserved here"));
  CHECK_THAT(refusal(pushed, {.onto = to_angular}), Contains("the angular momentum is not conserved here"));
  CHECK(refusal(pushed, {.onto = to_energy}) == "nothing");
  const auto dragged = test::classical_over(as_force(LinearDrag{.rate = 0.1}), method("rk4"));
  CHECK_THAT(refusal(dragged, {.onto = to_energy}), Contains("the energy is not conserved here"));
}

}  // namespace noether
