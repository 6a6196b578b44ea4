#include "integrators/damped.hpp"
#include "integrators/schemes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/problems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace noether {
namespace {

using namespace noether::test;

const HarmonicField spring{.k = 1};

/// Walks an integrator over one particle on a line and shows (x, v) after every step.
template <class I, class See> void walk(I integrator, double x, double v, double dt, long steps, const See& see) {
  auto s = particle_in_plane(x, 0, v, 0);
  s.clock() = Clock<double>::fixed(0, dt);
  integrator.bind(s);
  auto settled = s;
  for (long n = 1; n <= steps; ++n) {
    integrator.advance(s, {.steps = 1});
    integrator.settle(s, settled, {}, std::nullopt, true);
    see(n, std::as_const(settled).positions()[0][0], std::as_const(settled).velocities()[0][0]);
  }
}

TEST_CASE("Verlet's energy swings by h^2/8 on the oscillator, its shadow energy is kept", "[oracle]") {
  for (const double h : {0.2, 0.1, 0.05}) {
    double swing = 0, shadow = 0;
    const auto integrator = compose(KineticPotential(spring), schemes::verlet);
    walk(integrator, 1, 0, h, std::lround(1000 / h), [&](long, double q, double p) {
      swing = std::max(swing, std::fabs((p * p + q * q) / 2 - 0.5));
      shadow = std::max(shadow, std::fabs(p * p / (2 * (1 - h * h / 4)) + q * q / 2 - 0.5));
    });
    CHECK(std::fabs(swing / (h * h / 8) - 1) < 1e-5);
    CHECK(shadow < 8e-15);
  }
}

TEST_CASE("symplectic Euler's energy error on the oscillator is the same in the first and the last tenth", "[oracle]") {
  const auto largest = [](double h) {
    std::pair<double, double> tenths{};
    const long steps = std::lround(2e4 / h);
    const auto integrator = compose(KineticPotential(spring), schemes::symplectic_euler_a);
    walk(integrator, 1, 0, h, steps, [&](long n, double q, double p) {
      const double error = std::fabs((p * p + q * q) / 2 - 0.5);
      if (n <= steps / 10) tenths.first = std::max(tenths.first, error);
      if (n > steps - steps / 10) tenths.second = std::max(tenths.second, error);
    });
    return tenths;
  };
  for (const auto& [h, figure] : {std::pair{0.1, "0.02632"}, std::pair{0.05, "0.01282"}}) {
    const auto [first, last] = largest(h);
    CHECK(fmt::format("{:.5f}", first) == figure);
    CHECK(fmt::format("{:.5f}", last) == figure);
  }
}

/// Largest error over T = 20 of the damped oscillator y'' = -y - 0.2 y', y(0) = 1, y'(0) = -0.1.
std::string damped_error(const Scheme& scheme, double h) {
  double worst = 0;
  const auto integrator = compose(Damped(KineticPotential(spring), {.rate = 0.2}), scheme);
  walk(integrator, 1, -0.1, h, std::lround(20 / h), [&](long n, double y, double) {
    const double t = static_cast<double>(n) * h;
    worst = std::max(worst, std::fabs(y - std::exp(-0.1 * t) * std::cos(std::sqrt(0.99) * t)));
  });
  return fmt::format("{:.2e}", worst);
}

TEST_CASE("the damped oscillator has the known errors in the words D B A B D and B D A", "[oracle]") {
  CHECK(damped_error(schemes::verlet, 0.01) == "1.79e-05");
  CHECK(damped_error(schemes::verlet, 0.1) == "1.79e-03");
  CHECK(damped_error(schemes::verlet, 0.5) == "4.55e-02");
  CHECK(damped_error(schemes::verlet, 1) == "1.91e-01");
  CHECK(damped_error(schemes::verlet, 2) == "1.87e+00");
  CHECK(damped_error(schemes::symplectic_euler_a, 0.01) == "3.62e-03");
  CHECK(damped_error(schemes::symplectic_euler_a, 0.1) == "3.64e-02");
  CHECK(damped_error(schemes::symplectic_euler_a, 0.5) == "1.93e-01");
  CHECK(damped_error(schemes::symplectic_euler_a, 1) == "3.93e-01");
  CHECK(damped_error(schemes::symplectic_euler_a, 2) == "1.61e+00");
}

/// q'' = -q - q^2.
struct QuadraticSpring {
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const Real q = s.positions()[0][0];
    out.acceleration(0, Vec3<Real>(-q - q * q, Real(0), Real(0)));
  }
};

/// Largest start amplitude from rest, on a grid of 0.001, up to which 1500 steps of Verlet stay bounded.
double largest_bounded(double h) {
  for (int k = 1;; ++k) {
    const auto start = particle_in_plane(0.001 * k, 0, 0, 0);
    const auto end = run(KineticPotential(QuadraticSpring{}), schemes::verlet, start, h, 1500);
    if (!(std::fabs(end.positions()[0][0]) < 10)) return 0.001 * (k - 1);
  }
}

TEST_CASE("Verlet's largest bounded amplitude on a nonlinear spring shrinks to nothing at the 3:1 resonance",
          "[oracle]") {
  struct Row {
    double h, amplitude, tolerance;
  };
  // Far from the resonance the edge of what is bounded is fractal: the figure depends on how finely one looks.
  const std::vector<Row> table = {
      {1.0, 0.526, 0.06},   {1.2, 0.466, 0.06}, {1.414, 0.396, 0.06}, {1.6, 0.309, 0.06},   {1.70, 0.088, 0.002},
      {1.72, 0.028, 0.002}, {1.732, 0, 0.002},  {1.74, 0.009, 0.002}, {1.78, 0.047, 0.002}, {1.9, 0.127, 0.002}};
  for (const auto& [h, amplitude, tolerance] : table) {
    const double found = largest_bounded(h);
    INFO("h " << h << " amplitude " << found << ", expected " << amplitude);
    CHECK(std::fabs(found - amplitude) < tolerance);
  }
}

/// Counts how often it is asked.
struct CountingForce {
  std::shared_ptr<long> calls = std::make_shared<long>(0);
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    ++*calls;
    spring.add_to(out, s);
  }
};

TEST_CASE("every scheme costs the evaluations it declares, counted, and observers add one in all", "[oracle]") {
  for (const Scheme* scheme : schemes::all()) {
    const CountingForce force;
    auto s = particle_in_plane(0.1, 0, 0, 0);
    s.clock() = Clock<double>::fixed(0, 0.05);
    Composition integrator{KineticPotential(force), *scheme};
    integrator.bind(s);
    auto settled = s;
    integrator.advance(s, {.steps = 10});
    INFO(scheme->name);
    CHECK(*force.calls == 10 * scheme->evaluations());
    CHECK(integrator.evaluations().force == 10 * scheme->evaluations());
    for (int n = 0; n < 10; ++n) {
      integrator.settle(s, settled, {}, std::nullopt, true);
      integrator.advance(s, {.steps = 1});
    }
    CHECK(*force.calls == 20 * scheme->evaluations());
    CHECK(integrator.evaluations().force == 20 * scheme->evaluations());
  }
}

TEST_CASE("a kick at positions that have not moved costs no evaluation, and is not counted as one", "[oracle]") {
  const CountingForce force;
  auto s = particle_in_plane(0.1, 0, 0, 0);
  s.clock() = Clock<double>::fixed(0, 0.05);
  Composition integrator{Damped(KineticPotential(force), {.rate = 0.1}), schemes::verlet};  // D B A B D
  integrator.bind(s);
  auto settled = s;
  for (int n = 0; n < 10; ++n) {
    integrator.advance(s, {.steps = 1});
    integrator.settle(s, settled, {.energy = true}, std::nullopt, true);
  }
  CHECK(integrator.evaluations().force == 11);
  CHECK(*force.calls == 11);
}

TEST_CASE("stage counts are those of the literature", "[oracle]") {
  const auto counted = [](std::string_view name) { return schemes::find(name)->evaluations(); };
  CHECK(counted("leapfrog") == 1);
  CHECK(counted("yoshida_4") == 3);
  CHECK(counted("pefrl") == 4);
  CHECK(counted("suzuki_4") == 5);
  CHECK(counted("blanes_moan_s6") == 6);
  CHECK(counted("srkn14a") == 14);
  CHECK(counted("suzuki_umeno_8_s15") == 15);
  CHECK(counted("kahan_li_8_s17") == 17);
  CHECK(counted("aba_10_6_4") == 8);
}

/// Evaluations per unit time at which the local error per unit step would be 1e-6, extrapolated from h = 0.1.
double cost(const Scheme& scheme) {
  const double h = 0.1;
  const auto start = particle_in_plane(0.1, 0.05, 0.3, 0.4).as<Quad>();
  const KineticPotential<HenonHeilesField, Quad> hamiltonian(HenonHeilesField{});
  const PhasePoint<Quad> exact = henon_heiles_flow(motion_of(start), h);
  const double error = distance(motion_of(run(hamiltonian, scheme, start, h, 1)), exact);
  return scheme.evaluations() / (h * std::pow(1e-6 / (error / h), 1.0 / scheme.order.classical));
}

TEST_CASE("at an error of 1e-6 the ranking of schemes by evaluations is the known one", "[oracle]") {
  INFO("yoshida_4 " << cost(schemes::yoshida_4) << ", blanes_moan_s6 " << cost(schemes::blanes_moan_s6) << ", pefrl "
                    << cost(schemes::pefrl) << ", srkn11b " << cost(schemes::srkn11b) << ", verlet "
                    << cost(schemes::verlet));
  CHECK(cost(schemes::blanes_moan_s6) < 0.5 * cost(schemes::yoshida_4));
  CHECK(cost(schemes::blanes_moan_s6) < cost(schemes::pefrl));
  CHECK(cost(schemes::srkn11b) < cost(schemes::blanes_moan_s6));
  CHECK(cost(schemes::yoshida_4) < cost(schemes::verlet));
}

}  // namespace
}  // namespace noether
