/// Tangent flows against differences of two runs of the same steps in 113 bits, which know nothing of derivatives.

#include "forces/external_fields.hpp"
#include "forces/gr_potential.hpp"
#include "forces/henon_heiles.hpp"
#include "forces/oblateness.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "integrators/first_order_system.hpp"
#include "integrators/force_motion.hpp"
#include "integrators/systems/lorenz.hpp"
#include "integrators/tangent_run.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/refusal.hpp"

#include <cmath>

using namespace noether;
using namespace noether::test;

namespace {

constexpr double days = 100;
constexpr std::int64_t steps = 30;

/// A change that is different in every number.
Vector<double> some_change(Index numbers, double velocities) {
  Vector<double> c(numbers);
  for (Index i = 0; i < numbers; ++i) c[i] = std::sin(1.0 + 2.7 * i) * (2 * i < numbers ? 1.0 : velocities);
  return c;
}

/// The end of a run in 113 bits from a state moved by epsilon c.
template <class Make>
Vector<Quad> end_of(const Make& make, const ParticleSystem<double>& start, const Vector<double>& c, const Quad& epsilon,
                    double dt) {
  ParticleSystem<Quad> s = start.as<Quad>();
  const Index n = s.size(), half = n > 0 ? 3 * n : static_cast<Index>(s.variables().size());
  for (Index k = 0; n > 0 && k < 3; ++k) {
    for (Index i = 0; i < n; ++i) {
      s.positions().component(static_cast<int>(k))[i] += epsilon * Quad(c[k * n + i]);
      s.velocities().component(static_cast<int>(k))[i] += epsilon * Quad(c[half + k * n + i]);
    }
  }
  for (Index i = 0; n == 0 && i < half; ++i) s.variables()[static_cast<std::size_t>(i)] += epsilon * Quad(c[i]);
  s.clock() = Clock<Quad>::fixed(0, dt);
  AnyIntegrator<Quad> integrator = make();
  integrator.bind(s);
  const Advance done = integrator.advance(s, {.steps = steps});
  REQUIRE(done.failure == nullptr);
  ParticleSystem<Quad> end = s;
  integrator.settle(s, end, {}, {}, true);
  Vector<Quad> y(n > 0 ? 2 * half : half);
  for (Index k = 0; n > 0 && k < 3; ++k) {
    for (Index i = 0; i < n; ++i) {
      y[k * n + i] = end.positions().component(static_cast<int>(k))[i];
      y[half + k * n + i] = end.velocities().component(static_cast<int>(k))[i];
    }
  }
  for (Index i = 0; n == 0 && i < half; ++i) y[i] = end.variables()[static_cast<std::size_t>(i)];
  return y;
}

/// Largest difference of the tangent from that of two runs, relative to the largest number of each half.
template <class Make>
double error_of(std::unique_ptr<TangentFlow<double>> flow, const Make& make, const ParticleSystem<double>& start,
                double dt, double velocities = 0.01) {
  Vector<double> y;
  flow->gather(start, y);
  Matrix<double> changes(y.size(), 1);
  changes.col(0) = some_change(y.size(), velocities);
  const Vector<double> c = changes.col(0);
  flow->begin(Clock<double>::fixed(0, dt), y, changes);
  // In two stretches, so that a pending stage is on the way.
  const auto failure = flow->advance(steps / 2);
  INFO((failure ? failure->message : ""));
  REQUIRE_FALSE(failure.has_value());
  REQUIRE_FALSE(flow->advance(steps - steps / 2).has_value());
  flow->read(y, changes);
  const Quad epsilon(0x1p-52);
  const Vector<Quad> up = end_of(make, start, c, epsilon, dt), down = end_of(make, start, c, -epsilon, dt);
  double worst = 0;
  const Index half = start.size() > 0 ? y.size() / 2 : y.size();
  for (Index from = 0; from < y.size(); from += half) {
    double size = 0, error = 0;
    for (Index i = from; i < from + half; ++i) {
      const auto truth = static_cast<double>((up[i] - down[i]) / (Quad(2) * epsilon));
      size = std::max(size, std::abs(truth));
      error = std::max(error, std::abs(truth - changes(i, 0)));
    }
    worst = std::max(worst, error / size);
  }
  return worst;
}

ForceField<double> pulls() { return ForceField<double>().add(Gravity{.G = outer_G}).add(HarmonicField{.k = 1e-15}); }
ForceField<Quad> wide_pulls() { return ForceField<Quad>().add(Gravity{.G = outer_G}).add(HarmonicField{.k = 1e-15}); }

}  // namespace

TEST_CASE("changes along drifts and kicks are the derivative of the steps", "[chaos]") {
  const ParticleSystem<double> start = outer_planets();
  for (const char* name : {"verlet", "verlet_aba", "yoshida_4", "srkn6b", "blanes_moan_s6"}) {
    INFO(name);
    const Scheme& scheme = *schemes::find(name);
    const auto wide = [&] {
      return AnyIntegrator<Quad>(compose(KineticPotential<ForceField<Quad>, Quad>(wide_pulls()), scheme));
    };
    CHECK(error_of(tangent_flow(KineticPotential(pulls()), scheme, start), wide, start, days) < 1e-13);
  }
}

TEST_CASE("changes along Kepler arcs, kicks and jumps are the derivative of the steps", "[chaos]") {
  const ParticleSystem<double> start = planets_with_tracers(3);
  for (const Coordinates coordinates :
       {Coordinates::jacobi, Coordinates::democratic, Coordinates::whds, Coordinates::barycentric}) {
    const WisdomHolmanOptions options{.G = outer_G, .coordinates = coordinates};
    for (const char* name : {"verlet", "verlet_aba", "aba_8_6_4"}) {
      const Scheme& scheme = *schemes::find(name);
      INFO(name << " in coordinates " << static_cast<int>(coordinates));
      if (coordinates != Coordinates::jacobi && std::string(name) == "aba_8_6_4") continue;  // refused by its claims
      const auto wide = [&] { return AnyIntegrator<Quad>(compose(WisdomHolman<Quad>(options), scheme)); };
      CHECK(error_of(tangent_flow(WisdomHolman<double>(options), scheme, start), wide, start, days) < 2e-13);
    }
  }
}

TEST_CASE("changes feel forces beside gravity, and correctors", "[chaos]") {
  const ParticleSystem<double> start = outer_planets();
  const CompositionOptions corrected{.corrector = 11};
  for (const Coordinates coordinates : {Coordinates::jacobi, Coordinates::democratic}) {
    const WisdomHolmanOptions options{.G = outer_G, .coordinates = coordinates};
    const Oblateness j2{.J2 = 0.01, .radius = 1.0, .G = outer_G};
    const auto field = ForceField<double>().add(j2).add(GrPotential{.c = 10.0, .G = outer_G});
    const auto wide_field = ForceField<Quad>().add(j2).add(GrPotential{.c = 10.0, .G = outer_G});
    const CompositionOptions how = coordinates == Coordinates::jacobi ? corrected : CompositionOptions{};
    const auto wide = [&] {
      return AnyIntegrator<Quad>(
          compose(WisdomHolman<Quad, ForceField<Quad>>(options, wide_field), schemes::verlet_aba, how));
    };
    INFO(static_cast<int>(coordinates));
    CHECK(error_of(tangent_flow(WisdomHolman<double, ForceField<double>>(options, field), schemes::verlet_aba, start, 1,
                                how),
                   wide, start, days) < 2e-13);
  }
}

TEST_CASE("changes along steps of Gauss and of Runge and Kutta are their derivative", "[chaos]") {
  const ParticleSystem<double> start = outer_planets();
  for (const char* name : {"gauss_2", "gauss_4", "implicit_midpoint", "rk4", "newmark"}) {
    INFO(name);
    const MethodChoice choice = method(name, {.adaptive = false});
    const auto wide = [&] {
      return AnyIntegrator<Quad>(
          Classical<Quad>(std::make_unique<ForceMotion<ForceField<Quad>, Quad>>(wide_pulls()), choice));
    };
    CHECK(error_of(
              tangent_flow<double>(std::make_unique<ForceMotion<ForceField<double>, double>>(pulls()), choice, start),
              wide, start, days) < 1e-12);
  }
  ParticleSystem<double> lorenz = initial_state(Lorenz{}, {1.0, 2.0, 20.0});
  const MethodChoice choice = method("gauss_3", {.adaptive = false});
  const auto wide = [&] {
    return AnyIntegrator<Quad>(Classical<Quad>(std::make_unique<SystemMotion<Lorenz, Quad>>(Lorenz{}), choice));
  };
  CHECK(error_of(tangent_flow<double>(std::make_unique<SystemMotion<Lorenz, double>>(Lorenz{}), choice, lorenz), wide,
                 lorenz, 0.01) < 1e-12);
}

TEST_CASE("what has no derivative is refused by name", "[chaos]") {
  const ParticleSystem<double> start = outer_planets();
  const auto of_method = [&](const char* name, const MethodOptions& options) {
    return test::refusal_of([&] {
      tangent_flow<double>(std::make_unique<ForceMotion<ForceField<double>, double>>(pulls()), method(name, options),
                           start);
    });
  };
  CHECK(of_method("dop853", {}).find("'dop853' chooses its steps") != std::string::npos);
  CHECK(of_method("stormer_cowell_12", {}).find("'stormer_cowell_12' goes on from earlier steps") != std::string::npos);
}
