// Systems that one function H(t, q, p) gives: their rates, energy, exact Jacobians, and what is refused.

#include "integrators/hamiltonian_system.hpp"
#include "integrators/systems/lorenz.hpp"
#include "integrators/systems/nonseparable_oscillator.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <vector>

using namespace noether;

namespace {

/// Three coordinates, all coupled, so that six slopes are found four at a time.
struct Coupled {
  Index size() const { return 3; }
  std::vector<double> start() const { return {0.3, -0.2, 0.5, 0.1, 0.4, -0.6}; }
  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    return p[0] * p[0] * exp(q[1]) / Real(2) + p[1] * p[2] * cos(q[0]) + sin(q[2]) * p[1] + q[0] * q[1] * q[2];
  }
};

/// A pendulum whose support is shaken.
struct Shaken {
  Index size() const { return 1; }
  std::vector<double> start() const { return {0.3, 0}; }
  template <class Real> Real value(const Real& t, const Vector<Real>& q, const Vector<Real>& p) const {
    return p[0] * p[0] / Real(2) - (Real(1) + Real(0.1) * cos(Real(2) * t)) * cos(q[0]);
  }
};
struct ToldShaken : Shaken {
  static constexpr bool time_dependent = true;
};

template <class S> Vector<double> bound(CanonicalMotion<S, double>& f, const S& system) {
  const ParticleSystem<double> s = initial_state(system);
  f.bind(s);
  Vector<double> y;
  f.gather(s, y);
  return y;
}

}  // namespace

TEST_CASE("rates of a Hamiltonian system are its derivatives, and so is their Jacobian", "[hamiltonian_system]") {
  CanonicalMotion<Coupled, double> f(Coupled{});
  const Vector<double> y = bound(f, Coupled{});
  Vector<double> dy, up, down;
  f.rate(0, y, dy);
  const double q0 = y[0], q1 = y[1], q2 = y[2], p0 = y[3], p1 = y[4], p2 = y[5];
  const std::vector<double> expected = {p0 * std::exp(q1),
                                        p2 * std::cos(q0) + std::sin(q2),
                                        p1 * std::cos(q0),
                                        p1 * p2 * std::sin(q0) - q1 * q2,
                                        -p0 * p0 * std::exp(q1) / 2 - q0 * q2,
                                        -std::cos(q2) * p1 - q0 * q1};
  for (Index i = 0; i < 6; ++i) CHECK(std::abs(dy[i] - expected[static_cast<std::size_t>(i)]) < 1e-15);
  Matrix<double> J;
  REQUIRE(f.jacobian(0, y, J));
  const double h = 1e-5;
  for (Index j = 0; j < 6; ++j) {
    Vector<double> moved = y;
    moved[j] += h;
    f.rate(0, moved, up);
    moved[j] -= 2 * h;
    f.rate(0, moved, down);
    for (Index i = 0; i < 6; ++i) CHECK(std::abs(J(i, j) - (up[i] - down[i]) / (2 * h)) < 1e-9);
  }
}

TEST_CASE("the oscillator that does not separate follows its closed solution, with the period of the literature",
          "[hamiltonian_system]") {
  const NonseparableOscillator system;
  const double period = 3.26105723835888532109;
  CHECK(std::abs(system.exact(0)[0] + 3) < 1e-15);
  CHECK(std::abs(system.exact(period)[0] + 3) < 1e-14);
  CHECK(std::abs(system.exact(10)[0] + 2.4022383131008272595) < 1e-13);
  CHECK(std::abs(system.exact(10)[1] - 0.69060950745725347076) < 1e-13);
  CHECK(NonseparableOscillator{.position = 0}.exact(3) == std::vector<double>{0, 0});
  Simulation run(initial_state(system), classical(system, method("gauss_8")));
  Energy& energy = run.every_time(1, Energy());
  REQUIRE(run.run_until(10).ok());
  CHECK(std::abs(run.particles().variables()[0] + 2.4022383131008272595) < 1e-12);
  CHECK(std::abs(run.particles().variables()[1] - 0.69060950745725347076) < 1e-12);
  CHECK(energy.total() == 5);
  CHECK(energy.worst() < 1e-13);
}

TEST_CASE("the energy of a Hamiltonian system is H: at rest potential, else kinetic", "[hamiltonian_system]") {
  CanonicalMotion<NonseparableOscillator, double> f(NonseparableOscillator{});
  const ParticleSystem<double> s = initial_state(NonseparableOscillator{}, {2, 3});
  f.bind(s);
  CHECK(f.energy(s).potential == 2.5);
  CHECK(f.energy(s).kinetic == 22.5);
  CHECK(f.hamiltonian(0, Vector<double>::Constant(2, 1)) == 2);
  const IntegratorClaims claims = classical(NonseparableOscillator{}, method("gauss_2")).claims();
  CHECK(claims.variables);
  CHECK(claims.energy);
  CHECK(claims.symplectic);
  CHECK_FALSE(claims.time_dependent);
}

TEST_CASE("a Hamiltonian that depends on time has to say so; then its energy has no error", "[hamiltonian_system]") {
  CHECK_THROWS_WITH(Simulation(initial_state(Shaken{}), classical(Shaken{}, method("rk4")), 0.1),
                    "the energy of system '' depends on time; let it say so: static constexpr bool "
                    "time_dependent = true");
  Simulation run(initial_state(ToldShaken{}), classical(ToldShaken{}, method("gauss_4", {.adaptive = false})), 0.1);
  Energy& energy = run.every(1, Energy());
  REQUIRE(run.run(10).ok());
  CHECK(std::isnan(energy.worst()));
  CHECK(run.claims().time_dependent);
}

/// Driven by a force that does no work at rest in the origin.
struct PushedAtRest {
  static std::string_view name() { return "pushed_at_rest"; }
  static Index size() { return 1; }
  template <class Real> Real value(const Real& t, const Vector<Real>& q, const Vector<Real>& p) const {
    using std::cos;
    return (p[0] * p[0] + q[0] * q[0]) / Real(2) - q[0] * cos(t);
  }
};

TEST_CASE("a Hamiltonian that depends on time is seen where it does not at the start", "[hamiltonian_system]") {
  CHECK_THROWS_WITH(Simulation(initial_state(PushedAtRest{}, {0, 0}), classical(PushedAtRest{}, method("hbvm_2")), 0.1),
                    "the energy of system 'pushed_at_rest' depends on time; let it say so: static constexpr bool "
                    "time_dependent = true");
}

TEST_CASE("a Hamiltonian system is refused particles, other numbers of variables, and monitors of particles",
          "[hamiltonian_system]") {
  const NonseparableOscillator system;
  CHECK_THROWS_WITH(initial_state(system, {1, 2, 3}),
                    "system 'nonseparable_oscillator' has 2 variables, but there are 3 values to start from");
  CHECK_THROWS_WITH(Simulation(initial_state(Lorenz{}), classical(system, method("rk4")), 0.01),
                    "system 'nonseparable_oscillator' has 2 variables, a momentum for each coordinate, but it was "
                    "given 3 and 0 particles");
  Simulation run(initial_state(system), classical(system, method("rk4")), 0.01);
  CHECK_THROWS_WITH(run.every(1, Momentum{}),
                    "monitor 'momentum' watches particles, but system 'nonseparable_oscillator' has only variables");
}
