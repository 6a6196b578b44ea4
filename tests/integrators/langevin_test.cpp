// The bath: what it does to distributions, exactly for oscillators and by statistics elsewhere; its noise and its bits.

#include "integrators/langevin.hpp"
#include "constraints/constraint_residual.hpp"
#include "engine/simulation.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/damped.hpp"
#include "integrators/wisdom_holman.hpp"
#include "integrators/wrapped.hpp"
#include "monitors/monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "monitors/temperature.hpp"
#include "numbers/random.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/normal_bins.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/settings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace noether {
namespace {

constexpr double stiffness = 3, mass = 2, kT = 0.7, friction = 0.8;

/// Particles at rest in the origin, or where they are told.
template <class Real> ParticleSystem<Real> bodies(Index n, const Real& x = Real(0), const Real& v = Real(0)) {
  ParticleSystem<Real> s;
  for (Index i = 0; i < n; ++i) s.add("", Real(mass), Vec3<Real>(x, x, x), Vec3<Real>(v, v, v));
  return s;
}

template <class Real> auto oscillators(double temperature = kT) {
  return Langevin(KineticPotential<ForceField<Real>, Real>(test::field_of<Real>(HarmonicField{.k = stiffness})),
                  {.temperature = temperature, .friction = friction, .seed = 7});
}

/// A Hamiltonian that does not let others bring velocities back along its constraints.
struct Silent : Wrapped<AnyHamiltonian<double>> {
  using Wrapped<AnyHamiltonian<double>>::Wrapped;
  bool can_project() const { return false; }
};

using TwoByTwo = Eigen::Matrix<Quad, 2, 2>;
using Pair = Eigen::Matrix<Quad, 2, 1>;

Pair state_of(const ParticleSystem<Quad>& s, Index i, int c) {
  return Pair(s.positions().component(c)[i], s.velocities().component(c)[i]);
}

/// The settled states of one run after 1 and after 2 steps.
std::pair<ParticleSystem<Quad>, ParticleSystem<Quad>> two_steps(const Scheme& scheme, double dt, double temperature,
                                                                ParticleSystem<Quad> s) {
  auto integrator = compose(oscillators<Quad>(temperature), scheme);
  s.clock() = Clock<Quad>::fixed(0, dt);
  integrator.bind(s);
  auto one = s, two = s;
  integrator.advance(s, {.steps = 1});
  integrator.settle(s, one, {}, std::nullopt, true);
  integrator.advance(s, {.steps = 1});
  integrator.settle(s, two, {}, std::nullopt, true);
  return {one, two};
}

/// The covariance of x and v that a word keeps on an oscillator: S = M S M^T + sum of L L^T.
///
/// M and the answers L to the noise of each O are measured in a run: z_2 = M z_1 + sum of L xi for every particle.
/// @param places  of the O's in the word; 127 is one that is joined with the first of the next step
TwoByTwo kept_covariance(const Scheme& scheme, double dt, const std::vector<std::uint32_t>& places) {
  TwoByTwo M;
  M.col(0) = state_of(two_steps(scheme, dt, 0, bodies<Quad>(1, Quad(1), Quad(0))).first, 0, 0);
  M.col(1) = state_of(two_steps(scheme, dt, 0, bodies<Quad>(1, Quad(0), Quad(1))).first, 0, 0);
  constexpr Index n = 5;
  const auto [one, two] = two_steps(scheme, dt, kT, bodies<Quad>(n));
  const auto xi = [&](Index i, int c, std::size_t o) {
    return Quad(noise(noise_key(7), i, 1, places[o])[static_cast<std::size_t>(c)]);
  };
  const auto rest = [&, &first = one, &second = two](Index i, int c) {
    return Pair(state_of(second, i, c) - M * state_of(first, i, c));
  };
  Eigen::Matrix<Quad, 2, 2> L = TwoByTwo::Zero();
  if (places.size() == 1) {
    L.col(0) = rest(0, 0) / xi(0, 0, 0);
  } else {
    const Quad a = xi(0, 0, 0), b = xi(0, 0, 1), c = xi(0, 1, 0), d = xi(0, 1, 1), det = a * d - b * c;
    L.col(0) = (d * rest(0, 0) - b * rest(0, 1)) / det;
    L.col(1) = (a * rest(0, 1) - c * rest(0, 0)) / det;
  }
  for (Index i = 0; i < n; ++i) {  // all others must agree: the noise is that of these places, and of no others
    for (int c = 0; c < 3; ++c) {
      Pair left = rest(i, c);
      for (std::size_t o = 0; o < places.size(); ++o) left -= L.col(static_cast<Index>(o)) * xi(i, c, o);
      CHECK(static_cast<double>(norm2(Vec3<Quad>(left[0], left[1], Quad(0)))) < 1e-56);
    }
  }
  TwoByTwo S = L * L.transpose();
  for (int doublings = 0; doublings < 30; ++doublings) {
    S += M * S * M.transpose();
    M = TwoByTwo(M * M);
  }
  return S;
}

TEST_CASE("BAOAB and ABOBA keep the positions of an oscillator in exact equilibrium, other words by their formulas",
          "[langevin]") {
  const Quad variance_x = Quad(kT) / Quad(stiffness), variance_v = Quad(kT) / Quad(mass);
  for (const double dt : {0.01, 0.3, 1.0, 1.6}) {  // unstable from 2 sqrt(m/k) = 1.63
    const Quad q = Quad(dt) * Quad(dt) * Quad(stiffness) / Quad(mass) / Quad(4), left = Quad(1) - q;
    struct Known {
      const char* letters;
      std::vector<std::uint32_t> places;
      Quad x, v;
    };
    const Known known[] = {{"BAOAB", {2}, variance_x, variance_v * left},
                           {"ABOBA", {2}, variance_x, variance_v / left},
                           {"OBABO", {0, 127}, variance_x / left, variance_v},
                           {"OABAO", {0, 127}, variance_x * left, variance_v}};
    for (const Known& one : known) {
      CAPTURE(one.letters, dt);
      const TwoByTwo S = kept_covariance(word(one.letters), dt, one.places);
      CHECK(static_cast<double>(abs(S(0, 0) / one.x - Quad(1))) < 1e-27);
      CHECK(static_cast<double>(abs(S(1, 1) / one.v - Quad(1))) < 1e-27);
    }
  }
}

TEST_CASE("a word without an O gets half an O at both ends", "[langevin]") {
  const auto made = compose(oscillators<double>(), schemes::verlet),
             meant = compose(oscillators<double>(), word("OBABO"));
  REQUIRE(made.stages().size() == meant.stages().size());
  for (std::size_t i = 0; i < made.stages().size(); ++i) {
    CHECK(made.stages()[i].letter == meant.stages()[i].letter);
    CHECK(made.stages()[i].weight == meant.stages()[i].weight);
  }
}

TEST_CASE("a bath brings velocities to Maxwell's and positions to Boltzmann's distribution", "[langevin]") {
  const double dt = 1.5, q = dt * dt * stiffness / mass / 4;  // near the limit: a wrong word would be far off
  const auto s = test::run(oscillators<double>(), word("BAOAB"), bodies<double>(5000), dt, 60);
  test::NormalBins x(kT / stiffness), v(kT / mass * (1 - q)), wrong(kT / mass);
  for (Index i = 0; i < s.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      x.add(s.positions().component(c)[i]);
      v.add(s.velocities().component(c)[i]);
      wrong.add(s.velocities().component(c)[i]);
    }
  }
  // 63 degrees of freedom: above 131.7 once in a million times.
  CHECK(x.chi_square() < 131.7);
  CHECK(v.chi_square() < 131.7);
  CHECK(wrong.chi_square() > 1000);
}

/// U = sum x^4 / 4 by coordinates.
struct Quartic {
  std::string name() const { return "quartic"; }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> x = s.positions()[i];
      out.force(i, -Vec3<Real>(x[0] * x[0] * x[0], x[1] * x[1] * x[1], x[2] * x[2] * x[2]));
      if (out.wants_energy())
        out.energy((x[0] * x[0] * x[0] * x[0] + x[1] * x[1] * x[1] * x[1] + x[2] * x[2] * x[2] * x[2]) / Real(4));
    }
  }
};

/// <|grad U|^2> / <laplacian U> over kT, less 1, from many independent particles.
double configurational_error(const Scheme& scheme, double dt) {
  auto integrator =
      compose(test::in_bath(test::field_of(Quartic{}), {.temperature = kT, .friction = 1, .seed = 3}), scheme);
  auto s = bodies<double>(1000);
  s.clock() = Clock<double>::fixed(0, dt);
  integrator.bind(s);
  auto settled = s;
  double gradient = 0, laplacian = 0;
  for (int look = 0; look < 120; ++look) {
    integrator.advance(s, {.steps = 20});
    if (look < 3) continue;
    integrator.settle(s, settled, {}, std::nullopt, true);
    for (Index i = 0; i < s.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        const double x = std::as_const(settled).positions().component(c)[i];
        gradient += std::pow(x, 6);
        laplacian += 3 * x * x;
      }
    }
  }
  return gradient / laplacian / kT - 1;
}

TEST_CASE("the configurational temperature of an anharmonic well is that of the bath, best by BAOAB", "[langevin]") {
  // 350 000 samples: a standard error of about 0.4 %.
  CHECK(std::abs(configurational_error(word("BAOAB"), 0.2)) < 0.015);
  const double rough = configurational_error(word("OBABO"), 0.55), fine = configurational_error(word("BAOAB"), 0.55);
  CHECK(rough > 0.05);
  CHECK(std::abs(fine) < rough / 4);
}

template <class Real> AnyIntegrator<Real> made(const char* letters) {
  return AnyIntegrator<Real>(compose(AnyHamiltonian<Real>(oscillators<Real>()), word(letters)));
}

TEST_CASE("a run in a bath goes on bit for bit, from a checkpoint, observed or not, and on any number of threads",
          "[langevin]") {
  for (const char* letters : {"BAOAB", "OBABO", "ABOBA", "BAO", "OABAOABAO"}) {
    CAPTURE(letters);
    const auto start = bodies<double>(300, 0.2, -0.1);
    Simulation<double> whole(start, made<double>(letters), 0.1);
    REQUIRE(whole.run(30).ok());
    for (const int threads : {1, 2, 3, 8}) {
      const test::Threads some(threads);
      Simulation<double> first(start, made<double>(letters), 0.1);
      first.every(1, Energy{});
      REQUIRE(first.run(11).ok());
      const SavedRun saved = first.save();
      Simulation<double> second(start, made<double>(letters), 0.1);
      second.every(1, Energy{});
      second.restore(saved);
      REQUIRE(second.run(19).ok());
      CHECK(test::same_bits(whole.particles(), second.particles()));
    }
    const auto direct = test::run(oscillators<double>(), word(letters), start, 0.1, 30);
    CHECK(test::same_bits(whole.particles(), direct));
  }
}

TEST_CASE("another seed is another run, and a saved run does not go on in another bath", "[langevin]") {
  const auto run_of = [](LangevinOptions options) {
    return Simulation<double>(
        bodies<double>(2, 0.2),
        compose(test::in_bath(test::field_of(HarmonicField{.k = stiffness}), options), word("BAOAB")), 0.1);
  };
  auto one = run_of({.temperature = 1, .friction = 1, .seed = 1}),
       two = run_of({.temperature = 1, .friction = 1, .seed = 2});
  REQUIRE(one.run(5).ok());
  REQUIRE(two.run(5).ok());
  CHECK_FALSE(test::same_bits(one.particles(), two.particles()));
  CHECK_THROWS_AS(two.restore(one.save()), Error);
}

TEST_CASE("the energy of a run in a bath is recorded without a verdict, and no shadow of it is watched", "[langevin]") {
  Simulation<double> sim(bodies<double>(3), made<double>("BAOAB"), 0.1);
  const Energy& energy = sim.every(1, Energy{});
  CHECK_THROWS_AS(sim.every(1, ShadowHamiltonian<double>{}), Error);
  REQUIRE(sim.run(50).ok());
  const MonitorReport report = energy.report();
  CHECK(report.first == 0);
  CHECK(*report.last > 0);
  CHECK_FALSE(report.worst.has_value());
  CHECK_FALSE(report.slope.has_value());
  CHECK(report.reason.find("dissipative") != std::string::npos);
}

TEST_CASE("constraints hold in a bath, and what is left of the velocities has its temperature", "[langevin]") {
  const test::Mechanism chain = test::hanging_chain(8);
  Simulation<double> sim(chain.particles,
                         compose(test::in_bath(test::field_of(test::weight), chain.constraints,
                                               {.temperature = 5, .friction = 2, .seed = 1}),
                                 word("BAOAB")),
                         0.02);
  ConstraintResidual residual;
  residual.watch(chain.constraints);
  const ConstraintResidual& violated = sim.every(10, residual);
  const Temperature& temperature = sim.every(75, Temperature{});
  REQUIRE(sim.run(75 * 600).ok());
  CHECK(*violated.report().worst < 1e-14);
  CHECK(temperature.degrees_of_freedom() == 24 - 8);
  // 600 samples of 16 degrees of freedom, exp(-3) correlated: a standard error of 1.5 %.
  CHECK(std::abs(*temperature.report().rms / 5 - 1) < 0.1);
  const auto s = sim.particles();
  for (Index i = 1; i < s.size(); ++i) {
    const Vec3<double> bar = s.positions()[i] - s.positions()[i - 1], v = s.velocities()[i] - s.velocities()[i - 1];
    CHECK(std::abs(dot(bar, v)) < 1e-13);
  }
}

TEST_CASE("baths that cannot be are refused by name", "[langevin]") {
  const KineticPotential field(test::field_of(HarmonicField{.k = 1}));
  CHECK(test::refusal_of([&] { Langevin(field, {.temperature = -1, .friction = 1}); }) ==
        "temperature = -1 is not a valid temperature; 0 or more is expected");
  CHECK(test::refusal_of([&] { Langevin(field, {.temperature = 1, .friction = -2}); }) ==
        "friction = -2 would drive the motion instead of damping it; 0 or more is expected");
  const Langevin bath(field, {.temperature = 1, .friction = 1});
  CHECK(test::refusal_of([&] { compose(bath, schemes::yoshida_4); }).find("part O of 'langevin' is irreversible") !=
        std::string::npos);
  auto tracers = bodies<double>(2);
  tracers.add("dust", 0, {1, 0, 0}, {0, 0, 0});
  CHECK(test::refusal_of([&] { Simulation<double>(tracers, compose(bath, word("BAOAB")), 0.1); }) ==
        "'dust' has no mass, so it has no temperature; give it a mass, or take the thermostat out");
  CHECK(test::refusal_of([&] { Simulation<double>(bodies<double>(2), compose(bath, word("BAOAB")), -0.1); }) ==
        "a thermostat cannot go back in time; a step above 0 is expected");
  const Langevin planets(test::wisdom_holman({.G = test::outer_G}), {.temperature = 1, .friction = 1});
  CHECK(test::refusal_of([&] {
          Simulation<double>(test::outer_planets(), compose(planets, schemes::verlet), 10);
        }).find("'wisdom_holman' uses its own coordinates") == 0);
  const auto hanging = test::hamiltonian_of(test::hanging_chain(2));
  CHECK(
      test::refusal_of([&] { Langevin(AnyHamiltonian<double>(hanging), {.temperature = 1, .friction = 1}); }).empty());
  const Silent chain(hanging);
  CHECK(test::refusal_of([&] {
          Langevin(chain, {.temperature = 1, .friction = 1});
        }).find("noise would push velocities off") == 0);
}

TEST_CASE("drag and bath stand side by side, and an O by itself is refused", "[langevin]") {
  const Langevin both(test::damped(test::kinetic_potential(HarmonicField{.k = 1}), {.rate = 0.1}),
                      {.temperature = 1, .friction = 1});
  CHECK(both.claims().alphabet == "ABDO");
  CHECK(both.claims().irreversible == "DO");
  Langevin alone(test::kinetic_potential(HarmonicField{.k = 1}), {.temperature = 1, .friction = 1});
  auto s = bodies<double>(1);
  CHECK_THROWS_AS(alone.flow('O', s, 0.1), LogicError);
}

}  // namespace
}  // namespace noether
