/// Statements of the literature about classical methods, held to what they really do.

#include "forces/gravity.hpp"
#include "integrators/kinetic_potential.hpp"
#include "tests/methods/motions.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/order_fit.hpp"

#include <cmath>

using namespace noether;

namespace {

MethodOptions of_one_length(const char* name) {
  MethodOptions options;
  if (methods::find(name)->adaptive) options.adaptive = false;
  return options;
}

/// y' = lambda y.
class Decay final : public VectorField<double> {
 public:
  explicit Decay(double lambda) : lambda_(lambda) {}
  std::unique_ptr<VectorField<double>> clone() const override { return std::make_unique<Decay>(*this); }
  FieldClaims claims() const override { return {.name = "decay"}; }
  std::string signature() const override { return "decay"; }
  void bind(const ParticleSystem<double>& /*s*/) override {}
  Index size() const override { return 1; }
  void gather(const ParticleSystem<double>& /*s*/, Vector<double>& /*y*/) const override {}
  void scatter(const Vector<double>& /*y*/, ParticleSystem<double>& /*s*/) const override {}
  EnergyTerms<double> energy(const ParticleSystem<double>& /*s*/) override { return {}; }
  void accelerations(const ParticleSystem<double>& /*s*/, VectorColumn<double>& /*a*/) override {}

 protected:
  void evaluate(const double& /*t*/, const Vector<double>& y, Vector<double>& dy) override {
    dy.resize(1);
    dy[0] = lambda_ * y[0];
  }

 private:
  double lambda_;
};

double decayed(const char* name, double lambda, double h, long steps) {
  Decay f(lambda);
  const auto method = test::make<double>(name, of_one_length(name));
  Vector<double> y(1);
  y << 1;
  return test::walk(*method, f, y, h, steps)[0];
}

/// The first h at which y' = -y no longer decays.
double real_limit(const char* name) {
  double low = 0.5, high = 10;
  for (int k = 0; k < 60; ++k) {
    const double middle = (low + high) / 2;
    (std::abs(decayed(name, -1, middle, 1)) < 1 ? low : high) = middle;
  }
  return low;
}

/// q'' = -q - 2 gamma v from (1, -gamma), gamma = 0.1, to T = 20: largest |q - exact| at the steps.
double damped_error(const char* name, double h) {
  constexpr double gamma = 0.1, end = 20;
  const double w = std::sqrt(1 - gamma * gamma);
  test::Motion<double> f(
      1, [](const double&, const Vector<double>& y, double* a) { a[0] = -y[0] - 2 * gamma * y[1]; }, true);
  const auto method = test::make<double>(name, of_one_length(name));
  method->bind(f);
  Vector<double> y(2);
  y << 1, -gamma;
  double worst = 0;
  const long steps = std::lround(end / h);
  for (long n = 1; n <= steps; ++n) {
    REQUIRE(!method->step(f, h * static_cast<double>(n - 1), y, h).failure);
    const double t = h * static_cast<double>(n);
    worst = std::max(worst, std::abs(y[0] - std::exp(-gamma * t) * std::cos(w * t)));
  }
  return worst;
}

/// Whether two figures agree to the digits that one is printed with, three of them.
bool to_three_digits(double value, double printed) {
  return std::abs(value - printed) <= 0.51 * std::pow(10, std::floor(std::log10(std::abs(printed))) - 2);
}

/// Relative energy error of the oscillator from (1, 0) after T = 20.
double energy_drift(const char* name, double h) {
  auto f = test::oscillator<double>();
  const auto method = test::make<double>(name, of_one_length(name));
  Vector<double> y(2);
  y << 1, 0;
  y = test::walk(*method, f, y, h, std::lround(20 / h));
  return y[0] * y[0] + y[1] * y[1] - 1;
}

/// Verlet on a Kepler ellipse with e = 0.8 whose steps vary: largest energy errors of the first and last tenth.
struct Drift {
  double first = 0, last = 0;
};

Drift verlet_with_steps(bool reversible) {
  constexpr double e = 0.8, epsilon = 0.05, alpha = 1.5;
  constexpr int steps = 15060;
  ParticleSystem<double> s;
  s.add("sun", 1, {0, 0, 0}, {0, 0, 0});
  s.add("planet", 0, {1 - e, 0, 0}, {0, std::sqrt((1 + e) / (1 - e)), 0});
  auto verlet = test::kinetic_potential(Gravity{.G = 1});
  verlet.bind(s);
  const auto state = [&] {
    return std::pair<Vec3<double>, Vec3<double>>(std::as_const(s).positions()[1], std::as_const(s).velocities()[1]);
  };
  const auto energy = [&] {
    const auto [x, v] = state();
    return norm2(v) / 2 - 1 / std::sqrt(norm2(x));
  };
  const auto growth = [&] {
    const auto [x, v] = state();
    return -alpha * dot(x, v) / norm2(x);
  };
  const auto size = [&] { return std::pow(norm2(state().first), alpha / 2); };
  double density = 1 / size() + epsilon / 2 * growth();
  const double before = energy();
  Drift drift;
  for (int n = 0; n < steps; ++n) {
    const double h = reversible ? epsilon / density : epsilon * size();
    verlet.flow('B', s, h / 2);
    verlet.flow('A', s, h);
    verlet.flow('B', s, h / 2);
    density += epsilon * growth();
    const double error = std::abs(energy() - before);
    if (n < steps / 10) drift.first = std::max(drift.first, error);
    if (n >= steps - steps / 10) drift.last = std::max(drift.last, error);
  }
  return drift;
}

}  // namespace

TEST_CASE("C1: explicit Euler needs h below 2/|lambda|", "[claims]") {
  CHECK(std::abs(std::log10(std::abs(decayed("euler", -50, 0.039, 2000))) - std::log10(3e-45)) < 0.1);
  CHECK(std::abs(std::abs(decayed("euler", -50, 0.040, 2000)) - 1) < 1e-9);
  CHECK(std::abs(std::log10(std::abs(decayed("euler", -50, 0.041, 2000))) - std::log10(2e42)) < 0.2);
}

TEST_CASE("C3: RK4's error on the oscillator is h^4 T / 120, not 1/180", "[claims]") {
  const std::pair<double, double> printed[] = {
      {0.2, 0.008330}, {0.1, 0.0083325}, {0.05, 0.0083331}, {0.025, 0.0083333}};
  for (const auto& [h, figure] : printed) {
    auto f = test::oscillator<Quad>();
    const auto method = test::make<Quad>("rk4");
    Vector<Quad> start(2);
    start << Quad(1), Quad(0);
    const long steps = std::lround(20 / h);
    const auto y = test::walk(*method, f, start, h, steps);
    const Quad t = Quad(h) * Quad(static_cast<double>(steps));
    const double dx = static_cast<double>(y[0] - cos(t)), dv = static_cast<double>(y[1] + sin(t));
    const double measured = std::hypot(dx, dv) / (std::pow(h, 4) * 20);
    CAPTURE(h, measured);
    CHECK(std::abs(measured - figure) < (h == 0.2 ? 6e-7 : 6e-8));  // the digits printed
  }
}

TEST_CASE("C4: on the real axis RK4 is stable to 2.785, and its opponents where tables say", "[claims]") {
  CHECK(std::abs(real_limit("rk4") - 2.78529) < 1e-5);
  CHECK(std::abs(real_limit("dormand_prince_5") - 3.306) < 1e-3);
  CHECK(std::abs(real_limit("dop853") - 6.394) < 1e-3);
}

TEST_CASE("C7: the damped oscillator has the known errors, method by method and step by step", "[claims]") {
  struct Row {
    double h, euler, heun, rk4, dp5;
  };
  const Row rows[] = {{0.01, 1.88e-2, 6.12e-5, 3.06e-10, 1.0e-13},
                      {0.1, 0.249, 6.14e-3, 3.08e-6, 1.04e-8},
                      {0.5, 15.1, 0.158, 1.98e-3, 3.67e-5},
                      {1, 263, 0.864, 3.09e-2, 1.39e-3},
                      {2, 1.6e3, 879, 0.374, 7.3e-2}};
  for (const Row& row : rows) {
    CAPTURE(row.h);
    CHECK((row.h == 2 ? std::abs(damped_error("euler", 2) - 1.6e3) < 50
                      : to_three_digits(damped_error("euler", row.h), row.euler)));
    CHECK(to_three_digits(damped_error("heun", row.h), row.heun));
    CHECK(to_three_digits(damped_error("rk4", row.h), row.rk4));
    if (row.h == 0.01) {
      CHECK(damped_error("dormand_prince_5", row.h) < 3e-13);  // rounding has a say
    } else if (row.h == 2) {
      CHECK(std::abs(damped_error("dormand_prince_5", row.h) - row.dp5) < 0.05e-2);
    } else {
      CHECK(to_three_digits(damped_error("dormand_prince_5", row.h), row.dp5));
    }
  }
}

TEST_CASE("C9: energy drifts of even orders fall with one power more", "[claims]") {
  struct Slope {
    const char* name;
    double coarse, slope;
  };
  const Slope expected[] = {
      {"euler", 0.01, 1.07},           {"heun", 0.1, 3.00},  {"rk4", 0.1, 5.00}, {"cash_karp_5", 0.4, 5.12},
      {"dormand_prince_5", 0.4, 4.79}, {"dop853", 0.8, 9.04}};
  for (const auto& [name, coarse, slope] : expected) {
    const double measured = std::log2(std::abs(energy_drift(name, coarse) / energy_drift(name, coarse / 2)));
    CAPTURE(name, measured);
    CHECK(std::abs(measured - slope) < 0.0051);
  }
  CHECK(std::abs(energy_drift("rk4", 0.1) + 2.77e-6) < 0.01e-6);
}

TEST_CASE("C11: a reversible choice of steps keeps what a naive one loses", "[claims]") {
  const Drift reversible = verlet_with_steps(true), naive = verlet_with_steps(false);
  CHECK(std::abs(reversible.first - 2.14e-3) < 0.01e-3);
  CHECK(std::abs(reversible.last - 2.14e-3) < 0.01e-3);
  CHECK(std::abs(naive.first - 3.5e-3) < 0.1e-3);
  CHECK(std::abs(naive.last - 1.5e-2) < 0.05e-2);
}
