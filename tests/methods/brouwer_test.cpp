/// Brouwer's law: rounding that favors no side lets the error of the energy grow as the square root of time, and any
/// bias, of a coefficient that is off by 1e-17 or of sums that forget, as time itself.

#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/classical.hpp"
#include "integrators/kinetic_potential.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/planets.hpp"

#include <array>
#include <cmath>

using namespace noether;

namespace {

/// Relative error of the energy, in 113 bits, of the doubles a run has come to.
class EnergyError {
 public:
  explicit EnergyError(const ParticleSystem<double>& start) : start_(energy(start)) {}
  double operator()(const ParticleSystem<double>& now) { return static_cast<double>((energy(now) - start_) / start_); }

 private:
  Quad energy(const ParticleSystem<double>& s) {
    const ParticleSystem<Quad> wide = s.as<Quad>();
    VectorColumn<Quad> a(wide.size());
    ForceSink<Quad> sink(a, wide, {.energy = true});
    Gravity{.G = test::outer_G}.add_to(sink, wide);
    return kinetic_energy(wide) + sink.potential();
  }

  Quad start_;
};

/// Mean square energy error over `members` runs that differ in the tenth digit, after 4^k times `first` steps each.
template <std::size_t times> std::array<double, times> mean_squares(int members, std::int64_t first, double step) {
  std::array<double, times> sum{};
  for (int member = 0; member < members; ++member) {
    ParticleSystem<double> s = test::outer_planets();
    s.velocities().set(1, (1 + 1e-10 * member) * Vec3<double>(s.velocities()[1]));
    EnergyError error(s);
    Simulation run(s, classical(Gravity{.G = test::outer_G}, method("gauss_8", {.adaptive = false})), step);
    for (std::size_t k = 0; k < times; ++k) {
      REQUIRE(run.run((first << (2 * k)) - run.step()).ok());
      sum[k] += std::pow(error(run.particles()), 2) / members;
    }
  }
  return sum;
}

/// Power of time with which the root of the mean square grows.
template <std::size_t times> double exponent(const std::array<double, times>& squares) {
  std::vector<test::ErrorPoint> points;
  for (std::size_t k = 0; k < times; ++k) points.push_back({std::pow(4.0, k), std::sqrt(squares[k])});
  return test::fitted_slope(points);
}

}  // namespace

TEST_CASE("the energy error of Gauss's method with steps of one length grows as the root of time", "[kept]") {
  // The square of the second step is no double: what rounding takes from it is the same at every step.
  for (const double step : {300.0, 294.55645161290323}) {
    const auto squares = mean_squares<4>(12, 512, step);
    const double power = exponent(squares);
    CAPTURE(step, squares, power);
    CHECK(std::abs(power - 0.5) < 0.25);
    CHECK(std::sqrt(squares[3]) < 1e-14);
  }
}

TEST_CASE("and does so over a million years", "[kept][nightly]") {
  const auto squares = mean_squares<6>(8, 1024, 350.0);  // 4^5 * 1024 * 350 d: a million years
  const double power = exponent(squares);
  CAPTURE(squares, power);
  CHECK(std::abs(power - 0.5) < 0.2);
  CHECK(std::sqrt(squares[5]) < 2e-13);
}
