// A Lagrangian as a vector field: velocities of momenta, rates, energies, Jacobians, and what is refused.

#include "integrators/systems/lorenz.hpp"
#include "monitors/monitors.hpp"
#include "tests/variational/lagrangians.hpp"

using namespace noether;

namespace {

/// Motion at nearly the speed of light: momenta beyond what Newton's iteration from rest reaches in one step.
struct Relativistic {
  Index size() const { return 1; }
  template <class Real> Real lagrangian(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& v) const {
    using std::sqrt;
    return -sqrt(Real(1) - v[0] * v[0]) - q[0];
  }
};

/// Nothing of it depends on q': there are no momenta.
struct Motionless {
  Index size() const { return 1; }
  template <class Real> Real lagrangian(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& /*v*/) const {
    return -q[0] * q[0];
  }
};

/// Driven by a force that is none at rest in the origin.
struct PushedAtRest {
  static std::string_view name() { return "pushed_at_rest"; }
  static Index size() { return 1; }
  template <class Real> Real lagrangian(const Real& t, const Vector<Real>& q, const Vector<Real>& v) const {
    using std::cos;
    return (v[0] * v[0] - q[0] * q[0]) / Real(2) + q[0] * cos(Real(2) * t);
  }
};

/// A drag that grows with time, beside a Lagrangian that does not know it.
struct WearingOut {
  static std::string_view name() { return "wearing_out"; }
  static Index size() { return 1; }
  template <class Real> Real lagrangian(const Real& /*t*/, const Vector<Real>& /*q*/, const Vector<Real>& v) const {
    return v[0] * v[0] / Real(2);
  }
  template <class Real>
  void force(const Real& t, const Vector<Real>& /*q*/, const Vector<Real>& v, Vector<Real>& f) const {
    f[0] = -t * v[0];
  }
};

Vector<double> vector_of(const std::vector<double>& list) {
  return Eigen::Map<const Vector<double>>(list.data(), static_cast<Index>(list.size()));
}

}  // namespace

TEST_CASE("rates of a Lagrangian are those of Lagrange's equations", "[lagrangian]") {
  LagrangianMotion<PolarKepler, double> f(PolarKepler{});
  const Vector<double> y = vector_of({0.8, 0.3, 0.1, 1.2});
  Vector<double> dy;
  f.rate(0, y, dy);
  // r' = p_r, theta' = p_theta / r^2, p_r' = p_theta^2 / r^3 - 1 / r^2, p_theta' = 0
  CHECK(test::apart(dy, vector_of({0.1, 1.2 / 0.64, 1.44 / 0.512 - 1 / 0.64, 0})) < 1e-14);
  CHECK(dy[3] == 0);
  CHECK(f.evaluations().force == 1);
}

TEST_CASE("momenta of any size have their velocity, and those that no velocity has are a failure", "[lagrangian]") {
  LagrangianMotion<Relativistic, double> fast(Relativistic{});
  Vector<double> v;
  for (const double p : {0.0, 1e-3, 1.0, 30.0, 1e4}) {
    REQUIRE(!fast.velocity(0, vector_of({0}), vector_of({p}), v));
    CHECK(std::abs(v[0] - p / std::sqrt(1 + p * p)) < 1e-15);
  }
  for (const double mass : {1e-3, 1.0, 1e6}) {  // what is damped ends among the smallest numbers
    LagrangianMotion<SimplePendulum, double> swing(SimplePendulum{.mass = mass});
    for (const double p : {1e-300, 3.5e-308, 1.2e-309, -7e-314, 4.9e-324}) {
      REQUIRE(!swing.velocity(0, vector_of({3.5e-308}), vector_of({p}), v));
      CHECK(std::abs(v[0] - p / mass) <= 1e-15 * std::abs(p / mass) + 4e-322 / mass);
    }
  }
  LagrangianMotion<Motionless, double> none(Motionless{});
  const auto failure = none.velocity(0, vector_of({0.25}), vector_of({1}), v);
  REQUIRE(failure);
  CHECK(failure->message ==
        "the Lagrangian gives no velocity for the momentum at q = (0.25): d^2L/dq'^2 has no inverse there");
}

TEST_CASE("the Jacobian of a Lagrangian's rates is exact, with time and velocities mixed", "[lagrangian]") {
  LagrangianMotion<test::Shaken, Quad> f(test::Shaken{});
  const Vector<Quad> y = vector_of(test::Shaken{}.start()).cast<Quad>();
  const Quad t(0.7), d(1e-9);
  Vector<Quad> up, down, column;
  for (Index j = -1; j < 4; ++j) {
    Vector<Quad> direction = Vector<Quad>::Zero(4);
    if (j >= 0) direction[j] = Quad(1);
    const Quad dt(j < 0 ? 1 : 0);
    f.rate(t + d * dt, y + d * direction, up);
    f.rate(t - d * dt, y - d * direction, down);
    f.derivative(t, y, dt, direction, column);
    CHECK(test::apart<Quad>(column, (up - down) / (Quad(2) * d)) < 1e-15);
  }
}

TEST_CASE("the energy of a Lagrangian is p v - L, at rest all of it potential", "[lagrangian]") {
  LagrangianMotion<PolarKepler, double> f(PolarKepler{.mu = 2});
  const ParticleSystem<double> s = initial_state(PolarKepler{.mu = 2}, {0.8, 0.3}, {0.1, 1.2});
  f.bind(s);
  CHECK(std::abs(f.energy(s).kinetic - (0.005 + 1.44 / 1.28)) < 1e-14);
  CHECK(f.energy(s).potential == -2 / 0.8);
  CHECK(f.claims().energy);
  CHECK(f.claims().canonical);
  CHECK(!f.claims().dissipative);
  CHECK(!f.claims().time_dependent);
}

TEST_CASE("a Lagrangian or a force that depends on time has to say so, seen also where it does not at the start",
          "[lagrangian]") {
  const auto run = [](const auto& system) {
    return Simulation(initial_state(system, {0}, {0}), variational(system, method("galerkin_gauss_2")), 0.1);
  };
  CHECK_THROWS_WITH(run(PushedAtRest{}),
                    "the Lagrangian of system 'pushed_at_rest', or its force, depends on time; let it say so: static "
                    "constexpr bool time_dependent = true");
  CHECK_THROWS_WITH(run(WearingOut{}),
                    "the Lagrangian of system 'wearing_out', or its force, depends on time; let it say so: static "
                    "constexpr bool time_dependent = true");
  LagrangianMotion<test::Shaken, double> shaken(test::Shaken{});
  shaken.bind(initial_state(test::Shaken{}));
  CHECK(shaken.claims().time_dependent);
}

TEST_CASE("a Lagrangian with a force beside it is dissipative", "[lagrangian]") {
  const LagrangianMotion<SimplePendulum, double> free(SimplePendulum{}), damped(SimplePendulum{.damping = 0.1});
  CHECK(!free.claims().dissipative);
  CHECK(damped.claims().dissipative);
  CHECK(!damped.claims().symplectic);
}

TEST_CASE("any method for y' = f steps a Lagrangian, to the same orbit", "[lagrangian]") {
  const std::vector<double> start = {1, 0, 0, 1.2};
  const Vector<double> by_gauss = test::walked<double>(PolarKepler{}, "gauss_6", start, 0.05, 400);
  const Vector<double> by_path = test::walked<double>(PolarKepler{}, "galerkin_gauss_6", start, 0.05, 400);
  // r, theta, p_r at t = 20 (geometry.md)
  CHECK(test::apart(by_gauss, vector_of({2.36321982428593281, 8.94667173420781636, 0.16870281305668601, 1.2})) < 2e-12);
  CHECK(test::apart(by_path, by_gauss) < 2e-12);
}

TEST_CASE("states that do not fit, and fields without an action, are refused in one line", "[lagrangian]") {
  CHECK_THROWS_WITH(initial_state(PolarKepler{}, {1, 0}, {1.2}),
                    "system 'polar_kepler' has 4 variables, but there are 3 values to start from");
  CHECK_THROWS_WITH(Simulation(initial_state(PolarKepler{}), variational(PolarKepler{}, method("newmark")), 0.1),
                    "method 'newmark' is for q'' = a only, but 'polar_kepler' is a first-order system; use a method "
                    "for y' = f, such as 'dormand_prince_5'");
  CHECK_THROWS_WITH(Simulation(initial_state(Lorenz{}), classical(Lorenz{}, method("galerkin_gauss_2")), 0.1),
                    "method 'galerkin_gauss_2' is for q'' = a only, but 'lorenz' is a first-order system; use a method "
                    "for y' = f, such as 'dormand_prince_5'");
}
