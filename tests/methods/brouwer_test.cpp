/// Brouwer's law: rounding that favors no side lets the error of the energy grow as the square root of time, and any
/// bias, of a coefficient that is off by 1e-17 or of sums that forget, as time itself.

#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/classical.hpp"
#include "integrators/kinetic_potential.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/planets.hpp"

#include <array>
#include <cmath>
#include <vector>

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

/// Energy errors of one run after spans that are four times as long each.
template <std::size_t times> using Errors = std::array<double, times>;

/// Errors of `members` runs that differ in the tenth digit. `start` makes a run of particles, `go` leads it to the end
/// of span k.
template <std::size_t times, class Start, class Go>
std::vector<Errors<times>> ensemble(int members, const Start& start, const Go& go) {
  std::vector<Errors<times>> all(static_cast<std::size_t>(members));
  for (int member = 0; member < members; ++member) {
    ParticleSystem<double> s = test::outer_planets();
    s.velocities().set(1, (1 + 1e-10 * member) * Vec3<double>(s.velocities()[1]));
    EnergyError error(s);
    Simulation<double> run = start(s);
    for (std::size_t k = 0; k < times; ++k) {
      REQUIRE(go(run, k).ok());
      all[static_cast<std::size_t>(member)][k] = error(run.particles());
    }
  }
  return all;
}

/// By gauss_8 with steps of one length, `first` of them in the first span.
template <std::size_t times>
std::vector<Errors<times>> with_steps_of_one_length(int members, std::int64_t first, double step) {
  return ensemble<times>(
      members,
      [&](const ParticleSystem<double>& s) {
        return Simulation<double>(
            s, test::classical_over(Gravity{.G = test::outer_G}, method("gauss_8", {.adaptive = false})), step);
      },
      [&](Simulation<double>& run, std::size_t k) { return run.run((first << (2 * k)) - run.step()); });
}

/// By a method with steps of its own choice, the first span of `years`.
template <std::size_t times>
std::vector<Errors<times>> with_steps_of_its_own(const char* name, int members, double years) {
  MethodOptions options;
  options.adaptive = true;
  return ensemble<times>(
      members,
      [&](const ParticleSystem<double>& s) {
        return Simulation<double>(s, test::classical_over(Gravity{.G = test::outer_G}, method(name, options)));
      },
      [&](Simulation<double>& run, std::size_t k) { return run.run_until(365.25 * years * std::pow(4.0, k)); });
}

/// Mean square over the runs, span by span.
template <std::size_t times> Errors<times> mean_squares(const std::vector<Errors<times>>& runs) {
  Errors<times> sum{};
  for (const Errors<times>& run : runs) {
    for (std::size_t k = 0; k < times; ++k) sum[k] += run[k] * run[k] / static_cast<double>(runs.size());
  }
  return sum;
}

/// What the runs have in common after the last span, and how well it is known: a random walk favors no side.
struct Bias {
  double mean = 0, standard_error = 0;
};
template <std::size_t times> Bias common_bias(const std::vector<Errors<times>>& runs) {
  const double n = static_cast<double>(runs.size());
  double mean = 0, variance = 0;
  for (const Errors<times>& run : runs) mean += run.back() / n;
  for (const Errors<times>& run : runs) variance += (run.back() - mean) * (run.back() - mean) / (n - 1);
  return {mean, std::sqrt(variance / n)};
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
    const auto squares = mean_squares(with_steps_of_one_length<4>(12, 512, step));
    const double power = exponent(squares);
    CAPTURE(step, squares, power);
    CHECK(std::abs(power - 0.5) < 0.25);
    CHECK(std::sqrt(squares[3]) < 1e-14);
  }
}

TEST_CASE("and does so over a million years", "[kept][nightly]") {
  const auto squares =
      mean_squares(with_steps_of_one_length<6>(8, 1024, 350.0));  // 4^5 * 1024 * 350 d: a million years
  const double power = exponent(squares);
  CAPTURE(squares, power);
  CHECK(std::abs(power - 0.5) < 0.2);
  CHECK(std::sqrt(squares[5]) < 2e-13);
}

TEST_CASE("runs by Gauss's method with steps of one length have no energy error in common", "[kept][slow]") {
  // What rounding takes from a coefficient, or from the square of the second step, is the same at every step. With
  // coefficients of one word the sixteen runs have -1.4e-14 and -1.7e-14 in common, seven and twelve standard errors.
  for (const double step : {330.0, 294.55645161290323}) {
    const auto runs = with_steps_of_one_length<4>(16, 1536, step);
    const Bias bias = common_bias(runs);
    CAPTURE(step, bias.mean, bias.standard_error);
    CHECK(std::abs(bias.mean) < 4 * bias.standard_error);
    CHECK(bias.standard_error < 3e-15);
  }
}

TEST_CASE("so does that of Gauss's and of the Gauss-Radau method with steps of their own choice", "[kept][slow]") {
  // Mean squares of 16 random walks are known to 35 %, their roots to 18 %: over a factor of 64 in time that is 0.06 of
  // the slope, which a drift would bring to 1. The bounds are four standard errors.
  constexpr double years = 1500 * 64;
  for (const char* name : {"gauss_8", "gauss_radau_15"}) {
    const auto runs = with_steps_of_its_own<4>(name, 16, years / 64);
    const auto squares = mean_squares(runs);
    const double power = exponent(squares);
    const Bias bias = common_bias(runs);
    CAPTURE(name, squares, power, bias.mean, bias.standard_error);
    CHECK(std::abs(power - 0.5) < 0.25);
    CHECK(std::sqrt(squares[3]) < 3e-14);
    CHECK(std::abs(bias.mean) < 4 * bias.standard_error);
  }
}
