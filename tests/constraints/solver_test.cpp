#include "constraints/constraint_residual.hpp"
#include "forces/gravity.hpp"
#include "forces/sum.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/mechanisms.hpp"

#include <limits>

namespace noether {
namespace {

using namespace noether::test;

template <class Real> double reach(const ParticleSystem<Real>& s) {
  double most = 1;
  for (Index i = 0; i < s.size(); ++i) {
    most = std::max(most, std::sqrt(static_cast<double>(norm2(Vec3<Real>(s.positions()[i])))));
  }
  return most;
}

/// Flows of one letter after the other; after each of them positions and velocities are on the constraints to rounding.
template <class Real> void check_stages(const Mechanism& mechanism, double h, int steps) {
  auto hamiltonian = hamiltonian_of<Real>(mechanism);
  ParticleSystem<Real> s = mechanism.particles.as<Real>();
  s.clock() = Clock<Real>::fixed(0, h);
  hamiltonian.bind(s);
  const double u = static_cast<double>(std::numeric_limits<Real>::epsilon()) / 2;
  for (int k = 0; k < steps; ++k) {
    for (const char letter : {'B', 'A'}) {
      hamiltonian.flow(letter, s, Real(h));
      REQUIRE(!hamiltonian.failure());
      REQUIRE(mechanism.constraints.worst(s).residual <= 6 * u * reach(s));
      REQUIRE(velocity_across(mechanism.constraints, s) <= 8 * u * reach(s));
    }
  }
}

TEST_CASE("after every stage positions and velocities are on the constraints to rounding", "[constraints]") {
  check_stages<double>(spherical_pendulum(), 0.05, 400);
  check_stages<double>(double_pendulum(), 0.02, 400);
  check_stages<double>(free_chain(12), 0.05, 400);
  check_stages<double>(hanging_chain(100), 0.005, 200);
  check_stages<Quad>(double_pendulum(), 0.02, 20);
  check_stages<Quad>(hanging_chain(6), 0.02, 20);
}

TEST_CASE("a hundred steps forth and back return to the start to rounding", "[constraints]") {
  const auto error = [](const Mechanism& mechanism, const Scheme& scheme, double h) {
    Simulation<double> sim(mechanism.particles, compose(hamiltonian_of(mechanism), scheme), h);
    const ParticleSystem<double> start = sim.particles();
    REQUIRE(sim.run(100).ok());
    CHECK(distance_of_states(sim.particles(), start) > 0.1);
    sim.change_step(-h);
    REQUIRE(sim.run(100).ok());
    return distance_of_states(sim.particles(), start);
  };
  for (const Scheme* scheme : {&schemes::verlet, &schemes::yoshida_4, &schemes::kahan_li_6_s9}) {
    INFO(scheme->name);
    CHECK(error(spherical_pendulum(), *scheme, 0.02) < 1e-13);
    CHECK(error(double_pendulum(), *scheme, 0.01) < 1e-12);
    CHECK(error(hanging_chain(10), *scheme, 0.01) < 1e-11);
  }
  // What is solved to a tolerance only does not return.
  CHECK(error(hanging_chain(10, {.solver = ConstraintMethod::rattle, .tolerance = 1e-6}), schemes::verlet, 0.01) >
        1e-9);
}

/// One rod of length 1 that turns freely at a speed; the rate is along the rod's normal.
Mechanism rod(double speed) {
  Mechanism m;
  m.particles.add("tip", 1, {0, 0, -1}, {speed, 0, 0});
  m.constraints.add(m.particles, OnSphere{}, {0});
  return m;
}

TEST_CASE("a rod turns by arcsin(h v / L) in a step, and beyond h v = L there is no solution", "[constraints]") {
  const UniformField none{};
  for (const double hv : {0.01, 0.3, 0.7, 0.9, 0.99, 0.9999}) {
    INFO(hv);
    const auto end = run(rod(hv), schemes::verlet, 1, 1, none);
    const Vec3<double> x = end.positions()[0];
    // Near the limit the solution itself feels rounding by 1/sqrt(1 - (h v)^2).
    CHECK(std::fabs(std::atan2(x[0], -x[2]) - std::asin(hv)) < 4e-16 / std::sqrt(1 - hv * hv));
    CHECK(std::fabs(std::sqrt(norm2(Vec3<double>(end.velocities()[0]))) - hv) < 1e-14);
  }
  for (const double hv : {1.01, 1.5, 10.0, 1e6}) {
    INFO(hv);
    const Mechanism too_fast = rod(hv);
    Simulation<double> sim(too_fast.particles, compose(hamiltonian_of(too_fast, none), schemes::verlet), 1);
    const Outcome outcome = sim.run(5);
    CHECK(outcome.kind == Outcome::Kind::constraint_failure);
    CHECK(outcome.step == 0);
    CHECK(outcome.message.starts_with("on_sphere of 'tip' has no solution: free motion violates it by "));
    CHECK(outcome.message.ends_with("so the step is too large"));
    CHECK(distance_of_states(sim.particles(), too_fast.particles) == 0);
  }
}

TEST_CASE("a step too large by 10 ends with the constraint, its particles, the step and the last good state",
          "[constraints]") {
  for (const ConstraintOptions& options :
       {ConstraintOptions{}, ConstraintOptions{.solver = ConstraintMethod::rattle, .tolerance = 1e-9}}) {
    const Mechanism chain = hanging_chain(10, options);
    Simulation<double> sim(chain.particles, compose(hamiltonian_of(chain), schemes::verlet), 0.5);
    auto& energy = sim.every(1, Energy{});
    const Outcome outcome = sim.run(100);
    INFO(to_text(outcome));
    CHECK(outcome.kind == Outcome::Kind::constraint_failure);
    CHECK(exit_code(outcome) == 1);
    CHECK(outcome.quantity == "constraint");
    REQUIRE(outcome.particle);
    CHECK(outcome.message.find("'" + outcome.particle->name + "'") != std::string::npos);
    CHECK(outcome.step == sim.particles().clock().step());
    CHECK(chain.constraints.worst(sim.particles()).residual < 2e-9);
    CHECK(std::isfinite(energy.worst()));
    // Where it ends does not depend on who looks.
    Simulation<double> unwatched(chain.particles, compose(hamiltonian_of(chain), schemes::verlet), 0.5);
    const Outcome same = unwatched.run(100);
    CHECK(to_text(same) == to_text(outcome));
    CHECK(distance_of_states(unwatched.particles(), sim.particles()) == 0);
  }
}

TEST_CASE("sweeps stop at their tolerance, count themselves, and fail by name at their limit", "[constraints]") {
  double before = 1;
  std::int64_t fewer = 0;
  const auto exact = run(hanging_chain(10), schemes::verlet, 0.01, 50);
  for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13}) {
    const Mechanism chain = hanging_chain(10, {.solver = ConstraintMethod::rattle, .tolerance = tolerance});
    Simulation<double> sim(chain.particles, compose(hamiltonian_of(chain), schemes::verlet), 0.01);
    REQUIRE(sim.run(50).ok());
    const double violation = chain.constraints.worst(sim.particles()).residual;
    CHECK(violation < 1.1 * tolerance);
    CHECK(violation > 1e-3 * tolerance);
    const double error = distance_of_states(sim.particles(), exact);
    CHECK(error < before);
    CHECK(error < 2e4 * tolerance);
    before = error;
    CHECK(sim.evaluations().constraint.iterations > fewer);
    fewer = sim.evaluations().constraint.iterations;
  }
  const Mechanism few = hanging_chain(10, {.solver = ConstraintMethod::rattle, .tolerance = 1e-12, .iterations = 3});
  Simulation<double> sim(few.particles, compose(hamiltonian_of(few), schemes::verlet), 0.01);
  const Outcome outcome = sim.run(10);
  CHECK(outcome.kind == Outcome::Kind::constraint_failure);
  CHECK(outcome.message.find("after 3 sweeps") != std::string::npos);
}

TEST_CASE("momentum and angular momentum are kept to rounding where the constraints allow it", "[constraints]") {
  for (const ConstraintOptions& options :
       {ConstraintOptions{}, ConstraintOptions{.solver = ConstraintMethod::rattle, .tolerance = 1e-4}}) {
    const Mechanism chain = free_chain(12, options);
    const auto hamiltonian = kinetic_potential_over(field_of(Gravity{.G = 0.1, .softening = 0.5}), chain.constraints);
    CHECK(hamiltonian.claims().keeps_momentum);
    CHECK(hamiltonian.claims().keeps_angular_momentum);
    Simulation<double> sim(chain.particles, compose(hamiltonian, schemes::verlet), 0.02);
    auto& momentum = sim.every(10, Momentum{});
    auto& angular = sim.every(10, AngularMomentum{});
    const int steps = 2000;
    REQUIRE(sim.run(steps).ok());
    // Two flows a step, each with the roundings of its corrections: CONTRACT's measure for "to rounding".
    const double bound = 8 * 0x1p-53 * std::sqrt(2.0 * steps);
    CHECK(momentum.worst() < bound);
    CHECK(angular.worst() < bound);
  }
  CHECK_FALSE(hamiltonian_of(hanging_chain(3)).claims().keeps_momentum);
  CHECK_FALSE(kinetic_potential_over(field_of(Gravity{}), hanging_chain(3).constraints).claims().keeps_momentum);
  CHECK(kinetic_potential_over(field_of(Gravity{}), hanging_chain(3).constraints).claims().keeps_angular_momentum);
  ConstraintSet aside;
  aside.add(hanging_chain(3).particles, OnSphere{{0, 0, 0.1}}, {0});
  CHECK_FALSE(kinetic_potential_over(field_of(Gravity{}), aside).claims().keeps_angular_momentum);
}

TEST_CASE("accelerations are those of the motion along the constraints", "[constraints]") {
  const Mechanism pendulum = spherical_pendulum();
  auto hamiltonian = hamiltonian_of(pendulum);
  ParticleSystem<double> s = pendulum.particles;
  hamiltonian.bind(s);
  VectorColumn<double> a(1);
  hamiltonian.accelerations(s, a);
  // a = g - (g.n) n - v^2 n / L along the rod n of length 1.
  const Vec3<double> n = std::as_const(s).positions()[0], v = std::as_const(s).velocities()[0], g(0, 0, -g_earth);
  const Vec3<double> expected = g - (dot(g, n) + norm2(v)) * n;
  CHECK(std::sqrt(norm2(Vec3<double>(std::as_const(a)[0] - expected))) < 1e-14);

  // And by differences of velocities along a chain, which have the error h^2.
  const Mechanism chain = hanging_chain(5);
  const double h = 1e-4;
  auto moving = hamiltonian_of(chain);
  ParticleSystem<double> start = chain.particles;
  moving.bind(start);
  VectorColumn<double> at_start(start.size());
  moving.accelerations(start, at_start);
  const auto after = run(chain, schemes::verlet, h, 1), before = run(chain, schemes::verlet, -h, 1);
  for (Index i = 0; i < start.size(); ++i) {
    const Vec3<double> difference = (after.velocities()[i] - before.velocities()[i]) / (2 * h);
    CHECK(std::sqrt(norm2(Vec3<double>(difference - std::as_const(at_start)[i]))) < 2e-5);
  }
}

TEST_CASE("a copy of an integrator goes on as the original does", "[constraints]") {
  const Mechanism chain = hanging_chain(6);
  auto original = compose(hamiltonian_of(chain), schemes::yoshida_4);
  ParticleSystem<double> s = chain.particles;
  s.clock() = Clock<double>::fixed(0, 0.01);
  original.bind(s);
  REQUIRE(original.advance(s, {.steps = 7}).failure == nullptr);
  auto copy = original;
  ParticleSystem<double> t = s;
  REQUIRE(original.advance(s, {.steps = 20}).failure == nullptr);
  REQUIRE(copy.advance(t, {.steps = 20}).failure == nullptr);
  CHECK(distance_of_states(s, t) == 0);
}

TEST_CASE("bits do not depend on threads, on who looks, on a save in between, nor on erased types", "[constraints]") {
  const Mechanism chain = hanging_chain(300);
  const auto integrator = compose(hamiltonian_of(chain), schemes::verlet);
  const auto straight = run(chain, schemes::verlet, 0.01, 24);
  const int threads = thread_count();
  for (const int other : {1, 2, 3, 4}) {
    set_thread_count(other);
    CHECK(distance_of_states(run(chain, schemes::verlet, 0.01, 24), straight) == 0);
  }
  set_thread_count(threads);
  Simulation<double> watched(chain.particles, integrator, 0.01);
  watched.every(1, Energy{});
  watched.every(3, AngularMomentum{});
  REQUIRE(watched.run(11).ok());
  Simulation<double> restored(chain.particles, integrator, 0.01);
  restored.restore(watched.save());
  REQUIRE(restored.run(13).ok());
  CHECK(distance_of_states(restored.particles(), straight) == 0);
  CHECK(restored.evaluations().constraint.iterations > 0);
  Simulation<double> erased(chain.particles, compose(AnyHamiltonian<double>(hamiltonian_of(chain)), schemes::verlet),
                            0.01);
  REQUIRE(erased.run(24).ok());
  CHECK(distance_of_states(erased.particles(), straight) == 0);
  CHECK(erased.evaluations().constraint.iterations == restored.evaluations().constraint.iterations);
}

TEST_CASE("a run saved, rebuilt and restored goes on bit for bit, for every scheme and both solvers",
          "[constraints][restart]") {
  for (const ConstraintMethod solver : {ConstraintMethod::newton, ConstraintMethod::rattle}) {
    const Mechanism chain = hanging_chain(5, {.solver = solver, .tolerance = 1e-5});
    for (const Scheme* scheme : schemes::all()) {
      if (scheme->exact.find('A') != std::string_view::npos) continue;
      CAPTURE(scheme->name, static_cast<int>(solver));
      const auto integrator = compose(hamiltonian_of(chain), *scheme);
      Simulation<double> whole(chain.particles, integrator, 0.01), first(chain.particles, integrator, 0.01),
          second(chain.particles, integrator, 0.01);
      const auto& residual = whole.every(2, ConstraintResidual{chain.constraints});
      first.every(2, ConstraintResidual{chain.constraints});
      const auto& restored = second.every(2, ConstraintResidual{chain.constraints});
      REQUIRE(whole.run(14).ok());
      REQUIRE(first.run(7).ok());
      second.restore(first.save());
      REQUIRE(second.run(7).ok());
      CHECK(distance_of_states(whole.particles(), second.particles()) == 0);
      CHECK(whole.evaluations().constraint.iterations == second.evaluations().constraint.iterations);
      CHECK(residual.report().rms == restored.report().rms);
      CHECK(residual.report().samples == restored.report().samples);
    }
  }
}

TEST_CASE("a copy of a solver goes on from any stage with the same bits, and apart from it", "[constraints][restart]") {
  for (const ConstraintMethod method : {ConstraintMethod::newton, ConstraintMethod::rattle}) {
    CAPTURE(static_cast<int>(method));
    const Mechanism chain = hanging_chain(5, {.solver = method, .tolerance = 1e-5});
    ParticleSystem<double> s = chain.particles;
    ConstraintSolver<double> solver(chain.constraints), assigned(ConstraintSet{});
    solver.bind(s);
    for (int step = 0; step < 3; ++step) {
      solver.advance_positions(s, 0.01);
      ConstraintSolver<double> copy = solver;  // between the two stages
      assigned = copy;
      ParticleSystem<double> other = s, third = s;
      copy.project_velocities(other, 0.01);
      copy.advance_positions(other, 0.02);
      copy.project_velocities(other, 0.02);
      assigned.project_velocities(third, 0.01);
      solver.project_velocities(s, 0.01);
      CHECK(distance_of_states(third, s) == 0);
      CHECK(assigned.iterations() == solver.iterations());
      assigned.advance_positions(third, 0.02);
      assigned.project_velocities(third, 0.02);
      CHECK(distance_of_states(other, third) == 0);
      if (method == ConstraintMethod::newton) CHECK(copy.iterations() > solver.iterations());
      REQUIRE(!copy.failure());
    }
  }
}

TEST_CASE("what is edited in a run is moved onto the constraints again", "[constraints]") {
  const Mechanism chain = free_chain(4);
  Simulation<double> sim(
      chain.particles, compose(kinetic_potential_over(field_of(Gravity{}), chain.constraints), schemes::verlet), 0.01);
  REQUIRE(sim.run(5).ok());
  sim.edit([](ParticleSystem<double>& s) { s.velocities().add(1, {0.5, 0.5, 0.5}); });
  CHECK(velocity_across(chain.constraints, sim.particles()) < 8 * 0x1p-53);
  REQUIRE(sim.run(5).ok());
  CHECK_THROWS_AS(sim.edit([](ParticleSystem<double>& s) { s.positions().add(1, {0.1, 0, 0}); }), BadConstraints);
}

}  // namespace
}  // namespace noether
