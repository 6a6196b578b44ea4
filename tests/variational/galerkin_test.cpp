// Variational methods: equal to what they have to be equal to, their orders, momenta, forces, and where they end.

#include "forces/external_fields.hpp"
#include "forces/henon_heiles.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "tests/support/drivers.hpp"
#include "tests/variational/lagrangians.hpp"

using namespace noether;

namespace {

const std::vector<double> pendulum_start = {2.0, 0.3};

/// Of q at t = 6, against (geometry/galerkin.json), in extended precision.
double pendulum_error(const char* name, double h) {
  const Vector<Quad> end = test::walked<Quad>(SimplePendulum{}, name, pendulum_start, h, std::lround(6 / h));
  return std::abs(static_cast<double>(end[0] - parse_quad("-1.113341245855598054627371")));
}

ParticleSystem<double> in_the_well() {
  ParticleSystem<double> s;
  s.add("particle", 1.0, {0.18, 0.18, 0}, {0.18, 0.18, 0});
  return s;
}
ParticleSystem<double> after(AnyIntegrator<double> integrator) {
  Simulation<double> run(in_the_well(), std::move(integrator), 0.1);
  REQUIRE(run.run(200).ok());
  return run.particles();
}
double apart(const ParticleSystem<double>& a, const ParticleSystem<double>& b) {
  return std::max((a.positions()[0] - b.positions()[0]).cwiseAbs().maxCoeff(),
                  (a.velocities()[0] - b.velocities()[0]).cwiseAbs().maxCoeff());
}

/// A spring that stiffens: one root of every step, which turns ever more slowly as the step grows.
struct StiffeningSpring {
  double k = 1e6;
  Index size() const { return 1; }
  template <class Real> Real lagrangian(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& v) const {
    return v[0] * v[0] / Real(2) - Real(k / 4) * q[0] * q[0] * q[0] * q[0];
  }
};

/// Many coordinates, of which one moves.
struct FreeCrowd {
  Index size() const { return 6001; }
  template <class Real> Real lagrangian(const Real& /*t*/, const Vector<Real>& /*q*/, const Vector<Real>& v) const {
    return v[0] * v[0] / Real(2);
  }
};

}  // namespace

TEST_CASE("the midpoint L_d is the implicit midpoint rule, and the trapezoidal one is verlet, to rounding",
          "[variational][C32]") {
  const auto by = [](const char* name) { return after(test::classical_over(HenonHeiles{}, method(name))); };
  CHECK(apart(by("variational_midpoint"), by("implicit_midpoint")) < 1e-14);
  CHECK(apart(by("galerkin_gauss_3"),
              after(test::classical_over(HenonHeiles{}, method("gauss_3", {.adaptive = false})))) < 1e-14);
  CHECK(apart(by("variational_trapezoidal"), after(compose(test::kinetic_potential(HenonHeiles{}), schemes::verlet))) <
        1e-14);
  // Over any Lagrangian the midpoint L_d is the midpoint rule of (q, p).
  const std::vector<double> start = {1, 0, 0, 1.2};
  CHECK(test::apart(test::walked<double>(PolarKepler{}, "variational_midpoint", start, 0.05, 400),
                    test::walked<double>(PolarKepler{}, "implicit_midpoint", start, 0.05, 400)) < 1e-12);
  CHECK(test::apart(test::walked<Quad>(PolarKepler{}, "variational_midpoint", start, 0.05, 40),
                    test::walked<Quad>(PolarKepler{}, "implicit_midpoint", start, 0.05, 40)) < 1e-30);
}

TEST_CASE("Kepler's problem in polar coordinates ends where the oracle has it, the angular momentum bit for bit",
          "[variational]") {
  const Vector<double> end = test::walked<double>(PolarKepler{}, "variational_midpoint", {1, 0, 0, 1.2}, 0.05, 400);
  CHECK(std::abs(end[0] - 2.3630679050188) < 2e-13);
  CHECK(std::abs(end[1] - 8.9478058558147) < 2e-13);
  CHECK(std::abs(end[2] - 0.168649) < 1e-6);
  CHECK(end[3] == 1.2);
  for (const char* name : {"variational_trapezoidal", "galerkin_gauss_4", "galerkin_lobatto_5"}) {
    CHECK(test::walked<double>(PolarKepler{}, name, {1, 0, 0, 1.2}, 0.05, 100)[3] == 1.2);
  }
}

TEST_CASE("a pendulum by galerkin_gauss_S has order 2 S and the errors of the oracle, by galerkin_lobatto_S 2 S - 2",
          "[variational]") {
  struct Row {
    const char* name;
    double h, error;  // at h
    int order;
  };
  const Row rows[] = {{"variational_midpoint", 0.1, 5.612e-4, 2},    {"galerkin_gauss_2", 0.2, 6.78e-6, 4},
                      {"galerkin_gauss_3", 0.5, 1.416e-6, 6},        {"galerkin_gauss_4", 1, 5.885e-6, 8},
                      {"variational_trapezoidal", 0.1, 1.418e-3, 2}, {"galerkin_lobatto_3", 0.2, 5.325e-6, 4},
                      {"galerkin_lobatto_4", 0.5, 6.368e-7, 6}};
  for (const Row& row : rows) {
    CAPTURE(row.name);
    CHECK(std::abs(pendulum_error(row.name, row.h) / row.error - 1) < 1e-3);
    // The series in h^2 begins where the step is a fraction of the swing.
    const double coarse = pendulum_error(row.name, 0.25), fine = pendulum_error(row.name, 0.125);
    CHECK(std::abs(std::log2(coarse / fine) - row.order) < 0.1);
  }
  CHECK(std::abs(pendulum_error("galerkin_gauss_3", 0.25) / 2.257e-8 - 1) < 1e-3);
  const Vector<double> end = test::walked<double>(SimplePendulum{}, "galerkin_gauss_3", pendulum_start, 0.5, 12);
  CHECK(std::abs(std::abs(end[0] + 1.113341245855598) - 1.416e-6) < 1e-9);
}

TEST_CASE("a step back undoes a step, and areas are kept, in 113 bits", "[variational]") {
  for (const char* name : {"variational_midpoint", "galerkin_gauss_3", "galerkin_lobatto_4"}) {
    CAPTURE(name);
    LagrangianMotion<PolarKepler, Quad> f(PolarKepler{});
    const auto steps = make_method<Quad>(*methods::find(name), {});
    steps->bind(f);
    Vector<Quad> start(4), y;
    start << Quad(0.75), Quad(0.5), Quad(0.25), Quad(1.125);
    const auto stepped = [&](Vector<Quad> from, double h) {
      REQUIRE(!steps->step(f, Quad(0), from, h).failure);
      return from;
    };
    CHECK(test::apart<Quad>(stepped(stepped(start, 0.25), -0.25), start) < 1e-31);
    // M^T J M = J, by central differences.
    Matrix<Quad> m(4, 4);
    const Quad d(1e-11);
    for (Index k = 0; k < 4; ++k) {
      Vector<Quad> up = start, down = start;
      up[k] += d;
      down[k] -= d;
      m.col(k) = (stepped(up, 0.25) - stepped(down, 0.25)) / (Quad(2) * d);
    }
    for (Index a = 0; a < 4; ++a) {
      for (Index b = 0; b < 4; ++b) {
        Quad area(0);
        for (Index i = 0; i < 2; ++i) area += m(i, a) * m(2 + i, b) - m(2 + i, a) * m(i, b);
        const double exact = b == a + 2 ? 1 : a == b + 2 ? -1 : 0;
        CHECK(std::abs(static_cast<double>(area) - exact) < 1e-19);
      }
    }
  }
}

TEST_CASE("forces beside the Lagrangian enter as d'Alembert has it, at the order of the method", "[variational]") {
  const SimplePendulum damped{.damping = 0.3};
  const std::vector<double> start = {2.0, 0.3};
  const Vector<Quad> truth = test::walked<Quad>(damped, "gauss_5", start, 0.25, 16);
  for (const auto& [name, order] : {std::pair{"variational_midpoint", 2}, std::pair{"galerkin_gauss_2", 4},
                                    std::pair{"variational_trapezoidal", 2}, std::pair{"galerkin_lobatto_3", 4}}) {
    CAPTURE(name);
    const double coarse = test::apart(test::walked<Quad>(damped, name, start, 0.125, 32), truth);
    const double fine = test::apart(test::walked<Quad>(damped, name, start, 0.0625, 64), truth);
    CHECK(std::abs(std::log2(coarse / fine) - order) < 0.1);
  }
}

TEST_CASE("a Lagrangian that depends on time and mixes velocities has its order too", "[variational]") {
  const std::vector<double> start = test::Shaken{}.start();
  const Vector<Quad> truth = test::walked<Quad>(test::Shaken{}, "gauss_4", start, 0.125, 16);
  for (const auto& [name, order] :
       {std::pair{"variational_midpoint", 2}, std::pair{"galerkin_gauss_2", 4}, std::pair{"galerkin_lobatto_3", 4}}) {
    CAPTURE(name);
    const double coarse = test::apart(test::walked<Quad>(test::Shaken{}, name, start, 0.0625, 32), truth);
    const double fine = test::apart(test::walked<Quad>(test::Shaken{}, name, start, 0.03125, 64), truth);
    CHECK(std::abs(std::log2(coarse / fine) - order) < 0.15);
  }
}

TEST_CASE("a discrete Lagrangian that turns singular on its way ends the run with the step and the place",
          "[variational][extremes]") {
  // Without angular momentum the orbit falls into the centre, where the mass r^2 of the angle is gone, at t = 1.1107.
  for (const char* name : {"variational_midpoint", "galerkin_gauss_2", "galerkin_lobatto_4"}) {
    Simulation<double> falling(initial_state(PolarKepler{}, {1, 0}, {0, 0}), variational(PolarKepler{}, method(name)),
                               0.05);
    const Outcome outcome = falling.run(100);
    CAPTURE(name, outcome.message);
    CHECK(outcome.kind == Outcome::Kind::solver_failure);
    CHECK(outcome.step >= 21);
    CHECK(outcome.step <= 24);
    CHECK(outcome.message.find(", near q = (") != std::string::npos);
  }
  // Steps of 2.5: D1 D2 L_d = -1/h - h cos(q)/4 vanishes where cos(q) = -0.64.
  for (const double momentum : {1.9, 3.0}) {
    Simulation<double> swinging(initial_state(SimplePendulum{}, {0.1}, {momentum}),
                                variational(SimplePendulum{}, method("variational_midpoint")), 2.5);
    const Outcome outcome = swinging.run(400);
    CAPTURE(outcome.message);
    CHECK(outcome.kind == Outcome::Kind::solver_failure);
    CHECK(outcome.message.starts_with("the discrete Lagrangian is singular: D1 D2 L_d has no inverse at 0."));
    CHECK(outcome.message.find(" of the step of 2.5, near q = (") != std::string::npos);
    if (momentum == 3) CHECK(outcome.step == 0);
  }
}

TEST_CASE("stiff motion goes on where its root does: springs of h omega = 1e4", "[variational][extremes]") {
  ParticleSystem<double> s;
  s.add("particle", 1.0, {1, 0, 0}, {0, 0, 0});
  for (const char* name : {"variational_midpoint", "galerkin_gauss_2", "galerkin_gauss_4"}) {
    CAPTURE(name);
    Simulation<double> run(s, test::classical_over(HarmonicField{1e8}, method(name)), 1.0);
    const Outcome outcome = run.run(200);
    CAPTURE(outcome.message);
    REQUIRE(outcome.ok());
    CHECK(std::abs(run.particles().positions()[0][0]) < 1 + 1e-6);
  }
}

TEST_CASE("a root that takes too long to follow has the momentum of its own points", "[variational][extremes]") {
  LagrangianMotion<StiffeningSpring, double> f(StiffeningSpring{});
  const auto steps = make_method<double>(*methods::find("variational_midpoint"), {});
  steps->bind(f);
  Vector<double> y(2);
  y << 1, 0;
  REQUIRE(!steps->step(f, 0, y, 1).failure);
  // (q1 - q0)/h = (p0 + p1)/2 of the midpoint rule
  CHECK(y[0] < -0.9);
  CHECK(std::abs((y[0] - 1) - y[1] / 2) < 1e-9);
}

TEST_CASE("more unknowns than a matrix may have are told as such, before any of it is followed", "[variational]") {
  ParticleSystem<double> s;
  for (int i = 0; i < 2001; ++i) s.add("particle", 1.0, {1, 0, 0}, {0, 0, 0});
  Simulation<double> run(s, test::classical_over(HarmonicField{1e8}, method("variational_midpoint")), 1.0);
  const Outcome outcome = run.run(1);
  CHECK(outcome.kind == Outcome::Kind::solver_failure);
  CHECK(outcome.message ==
        "sweeps over the implicit step of 1 do not converge, and its 6003 unknowns are more than the 6000 for which it "
        "makes a matrix; take a smaller step");
  const LagrangianMotion<FreeCrowd, double> crowd(FreeCrowd{});
  CHECK_THROWS_AS(make_method<double>(*methods::find("variational_midpoint"), {})->bind(crowd), SchemeMismatch);
}
