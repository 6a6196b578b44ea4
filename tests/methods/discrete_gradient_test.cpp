/// Discrete gradients: the energy to rounding of particles and of systems, by the figures of the oracle, and refusals.

#include "forces/external_fields.hpp"
#include "forces/fermi_pasta_ulam.hpp"
#include "forces/gravity.hpp"
#include "forces/henon_heiles.hpp"
#include "forces/linear_drag.hpp"
#include "integrators/classical.hpp"
#include "integrators/hamiltonian_system.hpp"
#include "integrators/systems/lorenz.hpp"
#include "integrators/systems/nonseparable_oscillator.hpp"
#include "tests/methods/stiff_problems.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/problems.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

using namespace noether;
using namespace noether::test;

namespace {

/// Henon and Heiles as one function.
struct HenonHeilesSystem {
  static std::string_view name() { return "henon_heiles_system"; }
  static Index size() { return 2; }
  static std::vector<double> start() { return {0.18, 0.18, 0.18, 0.18}; }
  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    return (p[0] * p[0] + p[1] * p[1] + q[0] * q[0] + q[1] * q[1]) / Real(2) + q[0] * q[0] * q[1] -
           q[1] * q[1] * q[1] / Real(3);
  }
};

/// Two coordinates and their momenta, all coupled.
struct CoupledPair {
  static std::string_view name() { return "coupled_pair"; }
  static Index size() { return 2; }
  static std::vector<double> start() { return {0.3, -0.2, 0.1, 0.4}; }
  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    using std::cos, std::exp;
    return p[0] * p[0] * exp(q[1]) / Real(2) + p[1] * p[1] * (Real(2) + cos(q[0])) / Real(2) + p[0] * p[1] / Real(4) +
           q[0] * q[0] + q[1] * q[1] * (Real(1) + q[0] / Real(5));
  }
};

/// The state (q, p) at the end of a run of whole steps, and the largest error of the energy on its way.
struct Walked {
  std::vector<double> y;
  double energy = 0;
};

/// Henon and Heiles by particles, or by the system.
Walked henon_heiles_at_20(std::string_view name, double h, bool of_particles) {
  auto integrator =
      of_particles ? classical_over(HenonHeiles{}, method(name)) : classical(HenonHeilesSystem{}, method(name));
  auto s = of_particles ? particle_in_plane(0.18, 0.18, 0.18, 0.18) : initial_state(HenonHeilesSystem{});
  s.clock() = Clock<double>::fixed(0, h);
  integrator.bind(s);
  const double energy = integrator.energy(s).total();
  Walked walked;
  for (std::int64_t n = std::lround(20 / h); n > 0; --n) {
    REQUIRE(integrator.advance(s, {.steps = 1}).failure == nullptr);
    walked.energy = std::max(walked.energy, std::abs(integrator.energy(s).total() - energy));
  }
  walked.y = s.variables();
  if (of_particles) {
    const Vec3<double> x = s.positions()[0], v = s.velocities()[0];
    walked.y = {x[0], x[1], v[0], v[1]};
  }
  return walked;
}

double most_apart(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}
double henon_heiles_error(const Walked& walked) {
  return most_apart(walked.y, {0.119936895278271929620182, 0.2809431280773217541051955, 0.150648473610744641795933,
                               0.1675336702728667023031444});
}

/// A system at t = 2 by steps of a length.
template <class S> Walked system_at_2(const S& system, std::string_view name, int steps) {
  auto integrator = classical(system, with_fixed_steps(std::string(name)));
  auto s = initial_state(system);
  s.clock() = Clock<double>::fixed(0, 2.0 / steps);
  integrator.bind(s);
  const double energy = integrator.energy(s).total();
  Walked walked;
  for (int n = 0; n < steps; ++n) {
    REQUIRE(integrator.advance(s, {.steps = 1}).failure == nullptr);
    walked.energy = std::max(walked.energy, std::abs(integrator.energy(s).total() / energy - 1));
  }
  walked.y = s.variables();
  return walked;
}

template <class... Fs> std::string refusal_of(std::string_view name, const Fs&... forces) {
  auto integrator = classical_over(field_of(forces...), method(name));
  ParticleSystem<double> s = particle_in_plane(1, 0, 0, 1);
  s.clock() = Clock<double>::fixed(0, 0.1);
  try {
    integrator.bind(s);
  } catch (const SchemeMismatch& error) {
    return error.message();
  }
  return "";
}

constexpr std::array<std::string_view, 3> discrete_gradients = {"gonzalez", "itoh_abe", "itoh_abe_symmetric"};

}  // namespace

TEST_CASE("discrete gradients on Henon and Heiles have the errors of the oracle and keep the energy to rounding",
          "[discrete_gradient]") {
  const auto check = [](std::string_view name, bool of_particles, double h, double error, double tolerance,
                        double slope) {
    CAPTURE(std::string(name), of_particles);
    const Walked coarse = henon_heiles_at_20(name, h, of_particles),
                 fine = henon_heiles_at_20(name, h / 2, of_particles);
    CHECK(std::abs(henon_heiles_error(coarse) / error - 1) < tolerance);
    CHECK(std::abs(std::log2(henon_heiles_error(coarse) / henon_heiles_error(fine)) - slope) < 0.06);
    CHECK(coarse.energy < 1e-14);
    CHECK(fine.energy < 1e-14);
  };
  check("gonzalez", false, 0.5, 8.37e-2, 1e-3, 2.06);
  check("itoh_abe", false, 0.05, 1.713e-2, 1e-3, 0.97);
  check("itoh_abe_symmetric", false, 0.5, 2.936e-2, 1e-3, 1.93);
  // Of particles Gonzalez's missing work goes along the displacement of q alone, so that no units matter.
  check("gonzalez", true, 0.5, 8.41e-2, 1e-3, 2.11);
  check("itoh_abe", true, 0.05, 1.713e-2, 1e-3, 0.97);
  check("itoh_abe_symmetric", true, 0.5, 2.936e-2, 1e-3, 1.93);
}

TEST_CASE("discrete gradients keep energies that do not separate, and have their orders there", "[discrete_gradient]") {
  const std::vector<double> truth = system_at_2(CoupledPair{}, "gauss_4", 100).y;
  for (const std::string_view name : discrete_gradients) {
    CAPTURE(std::string(name));
    std::vector<ErrorPoint> points;
    for (const int steps : {40, 80, 160}) {
      const Walked walked = system_at_2(CoupledPair{}, name, steps);
      CHECK(walked.energy < 1e-14);
      points.push_back({2.0 / steps, most_apart(walked.y, truth)});
    }
    CHECK(std::abs(fitted_slope(points) - (name == "itoh_abe" ? 1 : 2)) < 0.1);
    // From rest, where the first quotient is one of nothing by nothing.
    CHECK(system_at_2(NonseparableOscillator{}, name, 100).energy < 2e-14);
  }
}

TEST_CASE(
    "Gonzalez's discrete gradient keeps the momentum of particles, not the angular momentum; Itoh and Abe's neither",
    "[discrete_gradient]") {
  for (const std::string_view name : discrete_gradients) {
    CAPTURE(std::string(name));
    auto integrator = classical_over(Gravity{}, method(name));
    ParticleSystem<double> s = kepler_pair(0.6);
    for (Index i = 0; i < 2; ++i) s.velocities().add(i, Vec3<double>(0.3, -0.2, 0.1));
    s.clock() = Clock<double>::fixed(0, 0.02);
    integrator.bind(s);
    const auto momentum = [&]() -> Vec3<double> {
      return 0.75 * Vec3<double>(s.velocities()[0]) + 0.25 * Vec3<double>(s.velocities()[1]);
    };
    const auto turning = [&] {
      const auto [x, v] = relative_motion(s);
      return x[0] * v[1] - x[1] * v[0];
    };
    const Vec3<double> p = momentum();
    const double energy = integrator.energy(s).total(), l = turning();
    double most = 0;
    for (int n = 0; n < 200; ++n) {
      REQUIRE(integrator.advance(s, {.steps = 1}).failure == nullptr);
      most = std::max(most, std::abs(integrator.energy(s).total() / energy - 1));
    }
    CHECK(most < 2e-13);
    CHECK((std::sqrt(norm2(Vec3<double>(momentum() - p))) < 1e-14) == integrator.claims().keeps_momentum);
    CHECK(integrator.claims().keeps_momentum == (name == "gonzalez"));
    CHECK(std::abs(turning() / l - 1) > 1e-8);
    CHECK_FALSE(integrator.claims().keeps_angular_momentum);
    CHECK((integrator.claims().energy_exact && !integrator.claims().symplectic));
  }
}

TEST_CASE("a chain that begins at rest moves, and keeps its energy", "[discrete_gradient]") {
  for (const std::string_view name : discrete_gradients) {
    CAPTURE(std::string(name));
    ParticleSystem<double> s;
    for (int i = 1; i <= 6; ++i) s.add("", 1, {1.2 * std::sin(3.14159265358979323846 * i / 7), 0, 0}, {0, 0, 0});
    auto integrator = classical_over(FermiPastaUlam{.k = 1, .quartic = 2}, method(name));
    s.clock() = Clock<double>::fixed(0, 0.1);
    integrator.bind(s);
    const double energy = integrator.energy(s).total();
    for (int n = 0; n < 50; ++n) {
      REQUIRE(integrator.advance(s, {.steps = 1}).failure == nullptr);
      CHECK(std::abs(integrator.energy(s).total() / energy - 1) < 1e-14);
    }
    CHECK(std::abs(s.velocities()[2][0]) > 1e-3);
  }
}

TEST_CASE("discrete gradients refuse what has no energy that is kept", "[discrete_gradient]") {
  for (const std::string_view name : discrete_gradients) {
    CAPTURE(std::string(name));
    CHECK_THAT(refusal_of(name, HarmonicField{1}, OscillatingField{{1, 0, 0}, 2, 0}),
               Catch::Contains("keeps the energy, but a force of this run depends on time"));
    CHECK_THAT(refusal_of(name, HarmonicField{1}, DragForce{{.rate = 0.1}}),
               Catch::Contains("keeps the energy, but a force of this run"));
    auto rates = classical(Lorenz{}, method(name));
    auto s = initial_state(Lorenz{});
    s.clock() = Clock<double>::fixed(0, 0.1);
    CHECK_THROWS_WITH(rates.bind(s), Catch::Contains("system 'lorenz' has rates, and no energy that they keep"));
  }
  auto with_tracer = classical_over(Gravity{}, method("itoh_abe"));
  ParticleSystem<double> s = kepler_pair(0.1);
  s.add("dust", 0, {3, 0, 0}, {0, 0.5, 0});
  s.clock() = Clock<double>::fixed(0, 0.1);
  CHECK_THROWS_WITH(with_tracer.bind(s),
                    "method 'itoh_abe' uses energies alone, but a particle of mass 0 has none; give every particle a "
                    "mass, or use 'gonzalez'");
  auto served = classical_over(Gravity{}, method("gonzalez"));
  CHECK_NOTHROW(served.bind(s));
  CHECK_THROWS_WITH(classical_over(Gravity{}, method("itoh_abe", {.jacobian = JacobianForm::dense})),
                    "method 'itoh_abe' does not solve linear systems, so jacobian has no effect here; take it out");
}

namespace {

/// A spring that can be followed up to x = 1.
struct ShortSpring {
  static constexpr std::string_view name() { return "short_spring"; }
  static ForceClaims claims() { return {.keeps_momentum = false}; }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> x = s.positions()[i];
      if constexpr (std::is_same_v<Real, double> || std::is_same_v<Real, Quad>) {
        if (x[0] > Real(1)) out.fail({Outcome::Kind::overlap, i, "distance", "the spring is too long"});
      }
      out.force(i, Vec3<Real>(-x));
      out.energy(norm2(x) / Real(2));
    }
  }
};

}  // namespace

TEST_CASE("a force that fails ends a run by energies alone, too", "[discrete_gradient]") {
  ParticleSystem<double> s;
  s.add("bob", 1, {0, 0.1, 0.1}, {2, 0, 0});
  for (const char* name : {"itoh_abe", "itoh_abe_symmetric", "gonzalez"}) {
    CAPTURE(name);
    Simulation run(s, test::classical_over(ShortSpring{}, method(name)), 0.1);
    const Outcome outcome = run.run(100);
    CHECK_FALSE(outcome.ok());
    CHECK(outcome.message == "the spring is too long");
  }
}

TEST_CASE("a close pair far from the origin keeps its energy by energies alone", "[discrete_gradient][extremes]") {
  const double apart = 1e-5, speed = std::sqrt(2 / apart) / 2;
  ParticleSystem<double> s;
  s.add("a", 1, {1 + apart / 2, 0, 0}, {0, speed, 0});
  s.add("b", 1, {1 - apart / 2, 0, 0}, {0, -speed, 0});
  const double period = 2 * std::acos(-1.0) * std::sqrt(apart * apart * apart / 2);
  Simulation run(s, test::classical_over(Gravity{.G = 1}, method("itoh_abe_symmetric")), period / 200);
  const Energy& energy = run.every(1, Energy{});
  REQUIRE(run.run(400).ok());
  CHECK(energy.worst() < 1e-8);  // distances are differences of numbers near 1
}
