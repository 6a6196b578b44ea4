/// Newmark's method: what it keeps and what it loses, its options, forces that depend on velocities.

#include "integrators/methods/newmark.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/classical.hpp"
#include "tests/methods/stiff_problems.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/problems.hpp"

using namespace noether;
using namespace noether::test;

namespace {

/// A spring to the origin with a length of its own, U = k (|x| - 1)^2 / 2.
struct LongSpring {
  double k = 100;
  static std::string_view name() { return "long_spring"; }
  static ForceClaims claims() { return {.keeps_momentum = false}; }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    using std::sqrt;
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> x = s.positions()[i];
      const Real r = sqrt(norm2(x)), stretch = r - Real(1);
      out.force(i, Vec3<Real>(-Real(k) * stretch / r * x));
      out.energy(Real(k) * stretch * stretch / Real(2));
    }
  }
};

/// x'' = -x - |v| v / 5.
struct RoughSpring {
  static std::string_view name() { return "rough_spring"; }
  static ForceClaims claims() {
    return {.energy = false, .velocity_dependent = true, .dissipative = true, .keeps_momentum = false};
  }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    using std::sqrt;
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> v = s.velocities()[i];
      out.acceleration(i, Vec3<Real>(-s.positions()[i] - sqrt(norm2(v)) / Real(5) * v));
    }
  }
};

struct Drift {
  double energy = 0, angular_momentum = 0;
};

/// Largest relative changes of energy and angular momentum of a particle on the spring, 2000 steps of 0.05.
Drift drift_on_spring(const MethodChoice& choice, double k) {
  auto integrator = classical_over(LongSpring{.k = k}, choice);
  auto s = particle_in_plane(1.02, 0, 0, 1);
  s.clock() = Clock<double>::fixed(0, 0.05);
  integrator.bind(s);
  const auto energy = [&] { return integrator.energy(s).total(); };
  const auto momentum = [&] {
    const auto [x, v] = motion_of(s);
    return x[0] * v[1] - x[1] * v[0];
  };
  const double first_energy = energy(), first_momentum = momentum();
  Drift worst;
  for (int step = 0; step < 2000; ++step) {
    const Advance done = integrator.advance(s, {.steps = 1});
    REQUIRE(done.failure == nullptr);
    worst.energy = std::max(worst.energy, std::abs(energy() / first_energy - 1));
    worst.angular_momentum = std::max(worst.angular_momentum, std::abs(momentum() / first_momentum - 1));
  }
  return worst;
}

/// Whether two numbers are the same to the two digits that a table prints.
bool to_two_digits(double value, double printed) {
  return std::abs(value - printed) <= 0.5 * std::pow(10, std::floor(std::log10(printed)) - 1) * 1.000001;
}

}  // namespace

TEST_CASE("Newmark's method loses energy and angular momentum on a stiff spring, by the figures of the claim") {
  const Drift soft = drift_on_spring(method("newmark"), 100), stiff = drift_on_spring(method("newmark"), 1e4);
  INFO(soft.energy << " " << soft.angular_momentum << " " << stiff.energy << " " << stiff.angular_momentum);
  CHECK(to_two_digits(soft.energy, 2.4e-3));
  CHECK(to_two_digits(soft.angular_momentum, 1.2e-3));
  CHECK(to_two_digits(stiff.energy, 0.13));
  CHECK(to_two_digits(stiff.angular_momentum, 0.28));
}

TEST_CASE("Newmark's method of average acceleration is the trapezoidal rule") {
  const auto s = particle_in_plane(1.02, 0, 0, 1);
  auto newmark = classical_over(LongSpring{}, method("newmark"));
  auto trapezoidal = classical_over(LongSpring{}, method("trapezoidal"));
  CHECK(distance(run(newmark, s, 0.05, 200), run(trapezoidal, s, 0.05, 200)) < 1e-12);
}

TEST_CASE("Newmark's steps that are not stiff need no matrix and are the same") {
  auto s = particle_in_plane(1.02, 0, 0, 1);
  s.add("other", 2.0, Vec3<double>(0, 0.3, -0.9), Vec3<double>(0.5, 0, 0.1));
  for (const double h : {0.005, 0.05, 0.2}) {  // h^2 k / 4 = 0.0006, 0.06 and 1
    INFO(h);
    auto newmark = classical_over(LongSpring{}, method("newmark"));
    auto trapezoidal = classical_over(LongSpring{}, method("trapezoidal"));
    CHECK(distance(run(newmark, s, h, 50), run(trapezoidal, s, h, 50)) < 1e-12);
    CHECK((newmark.evaluations().jacobian == 0) == (h < 0.1));
  }
}

TEST_CASE("Newmark's method with beta = 0 is velocity Verlet, in one evaluation a stage") {
  const auto s = particle_in_plane(0.18, 0.18, 0.18, 0.18);
  auto newmark = classical_over(HenonHeilesField{}, method("newmark", NewmarkOptions{.beta = 0.0}));
  CHECK(newmark.claims().symplectic);
  const auto verlet = run(kinetic_potential(HenonHeilesField{}), schemes::verlet, s, 0.1, 100);
  CHECK(distance(run(newmark, s, 0.1, 100), verlet) < 1e-14);
  CHECK(newmark.evaluations().jacobian == 0);
  CHECK(newmark.evaluations().force == 200);
  CHECK_FALSE(classical_over(HenonHeilesField{}, method("newmark")).claims().symplectic);
}

TEST_CASE("Newmark's method is of order 2 with gamma = 1/2, of order 1 else, velocity-dependent forces or not") {
  const auto start = particle_in_plane(1, 0.2, 0, 0.7);
  auto reference = classical_over(RoughSpring{}, method("dop853", {.adaptive = false}));
  const auto end = run(reference, start, 0.01, 300);
  const auto slope = [&](const NewmarkOptions& options) {
    std::vector<ErrorPoint> points;
    for (const long n : {75, 150, 300}) {
      auto integrator = classical_over(RoughSpring{}, method("newmark", options));
      points.push_back(
          {3.0 / static_cast<double>(n), distance(run(integrator, start, 3.0 / static_cast<double>(n), n), end)});
    }
    return fitted_slope(points);
  };
  CHECK(std::abs(slope({}) - 2) < 0.05);
  CHECK(std::abs(slope({.beta = 1.0 / 6}) - 2) < 0.05);
  CHECK(std::abs(slope({.beta = 0.0}) - 2) < 0.05);
  CHECK(std::abs(slope({.beta = 0.3025, .gamma = 0.6}) - 1) < 0.05);
  CHECK(classical_over(RoughSpring{}, method("newmark")).claims().order == 2);
  CHECK(classical_over(RoughSpring{}, method("newmark", NewmarkOptions{.gamma = 0.6})).claims().order == 1);
}

TEST_CASE("Newmark's method refuses what it cannot do") {
  CHECK_THROWS_WITH(classical_over(RoughSpring{}, method("newmark", NewmarkOptions{.beta = -0.1})),
                    "beta = -0.1 is not valid in Newmark's method; 0 or more is expected, 0.25 by default");
  CHECK_THROWS_WITH(classical_over(RoughSpring{}, method("newmark", NewmarkOptions{.gamma = NAN})),
                    "gamma = nan is not valid in Newmark's method; a number is expected, 0.5 by default");
  CHECK_THROWS_WITH(classical_over(RoughSpring{}, method("trapezoidal", NewmarkOptions{})),
                    "method 'trapezoidal' has no options of 'newmark'; take them out");
  auto integrator = classical(Linear{}, method("newmark"));
  ParticleSystem<double> s;
  s.variables() = {1};
  CHECK_THROWS_AS(integrator.bind(s), SchemeMismatch);
}
