#include "integrators/all_schemes.hpp"
#include "integrators/damped.hpp"
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
    const auto integrator = compose(kinetic_potential(spring), schemes::verlet);
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
    const auto integrator = compose(kinetic_potential(spring), schemes::symplectic_euler_a);
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
  const auto integrator = compose(damped(kinetic_potential(spring), {.rate = 0.2}), scheme);
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
    const auto end = run(kinetic_potential(QuadraticSpring{}), schemes::verlet, start, h, 1500);
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
    Composition integrator{kinetic_potential(force), *scheme};
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
  Composition integrator{damped(kinetic_potential(force), {.rate = 0.1}), schemes::verlet};  // D B A B D
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

/// A scheme whose letters are exchanged: of a composition of velocity Verlet, the one of position Verlet.
Scheme drift_first(Scheme scheme) {
  Word word;
  for (const Stage& stage : scheme.word) word.push_back({stage.letter == 'A' ? 'B' : 'A', stage.weight});
  scheme.word = word;
  scheme.exact = "A";
  return scheme;
}

/// Error of one step of 0.1 on Henon and Heiles, (|x - x*|^2 + |v - v*|^2)^(1/2).
double error_of_step(const Scheme& scheme, const ParticleSystem<double>& state) {
  const auto start = state.as<Quad>();
  const auto hamiltonian = kinetic_potential<Quad>(HenonHeilesField{});
  const PhasePoint<Quad> found = motion_of(run(hamiltonian, scheme, start, 0.1, 1)),
                         exact = henon_heiles_flow(motion_of(start), 0.1);
  const Vec3<Quad> x = found.x - exact.x, v = found.v - exact.v;
  return std::sqrt(static_cast<double>(norm2(x) + norm2(v)));
}

/// A scheme of the survey, with the error of one step from x = (0.1, 0.05), v = (0.3, 0.4) as it is printed there.
struct SurveyRow {
  const Scheme* scheme;
  std::string error;
};

/// Compositions of Verlet, in the survey with the drift first.
std::vector<SurveyRow> compositions_of_verlet() {
  using namespace schemes;
  return {{&verlet, "5.4e-05"},
          {&yoshida_4, "4.1e-07"},
          {&suzuki_4, "3.2e-08"},
          {&mclachlan_ss5, "1.0e-08"},
          {&yoshida_6, "4.4e-10"},
          {&yoshida_6_b, "3.2e-09"},
          {&yoshida_6_c, "3.4e-09"},
          {&kahan_li_6_s9, "3.3e-11"},
          {&mclachlan_ss9, "2.6e-11"},
          {&sofroniou_spaletta_6_s11, "7.5e-12"},
          {&sofroniou_spaletta_6_s13, "4.5e-12"},
          {&yoshida_8_a, "7.5e-08"},
          {&yoshida_8_b, "8.2e-11"},
          {&yoshida_8_c, "4.7e-10"},
          {&yoshida_8, "1.0e-12"},
          {&yoshida_8_e, "3.7e-11"},
          {&suzuki_umeno_8_s15, "3.3e-14"},
          {&kahan_li_8_s17, "7.5e-15"},
          {&mclachlan_ss17, "9.0e-15"},
          {&morales_8_s17, "7.4e-15"},
          {&sofroniou_spaletta_8_s21, "1.7e-15"},
          {&kahan_li_10_s33, "1.3e-16"},
          {&sofroniou_spaletta_10_s35, "4.2e-19"}};
}

std::vector<SurveyRow> splittings() {
  using namespace schemes;
  return {{&ruth_3, "2.5e-06"},
          {&mclachlan_2_s2, "8.1e-06"},
          {&mclachlan_s4, "1.6e-08"},
          {&mclachlan_s5, "4.1e-09"},
          {&pefrl, "1.7e-08"},
          {&vefrl, "2.5e-08"},
          {&mclachlan_sb3a_m4, "1.9e-08"},
          {&mclachlan_sb3a_m5, "1.7e-09"},
          {&mclachlan_atela_4, "2.5e-09"},
          {&mclachlan_atela_5, "4.9e-10"},
          {&blanes_moan_s6, "8.3e-10"},
          {&srkn6b, "1.7e-10"},
          {&okunbor_skeel_6_13, "7.7e-12"},
          {&blanes_moan_s10, "2.1e-13"},
          {&srkn11b, "1.5e-14"},
          {&srkn14a, "5.8e-16"}};
}

/// Whether a figure is what is printed: half a unit of its last digit, and a tenth of one for digits of the tables.
bool is_printed(double found, const std::string& printed) {
  const double unit = std::pow(10.0, std::stoi(printed.substr(printed.find('e') + 1)) - 1);
  return std::fabs(found - std::stod(printed)) < 0.6 * unit;
}

TEST_CASE("one step of each scheme on Henon and Heiles is off by the figure of the survey", "[oracle]") {
  const auto start = particle_in_plane(0.1, 0.05, 0.3, 0.4);
  for (const SurveyRow& row : compositions_of_verlet()) {
    CAPTURE(std::string(row.scheme->name), row.error);
    CHECK(is_printed(error_of_step(drift_first(*row.scheme), start), row.error));
  }
  for (const SurveyRow& row : splittings()) {
    CAPTURE(std::string(row.scheme->name), row.error);
    CHECK(is_printed(error_of_step(*row.scheme, start), row.error));
  }
}

/// Evaluations per unit time at which the local error per unit step would be `error`, extrapolated from h = 0.1 with
/// the order of the method: geometric mean over three states.
///
/// The survey names one of its three. The other two are those of all multiples of 0.05 at which every figure of its
/// table comes out as it is printed.
double cost(const Scheme& scheme, double error) {
  double logs = 0;
  for (const auto& start : {particle_in_plane(0.1, 0.05, 0.3, 0.4), particle_in_plane(0.3, -0.1, -0.2, 0.2),
                            particle_in_plane(0.2, 0.3, -0.1, -0.35)}) {
    const double per_step = error_of_step(scheme, start) / 0.1;
    logs += std::log(scheme.evaluations() / (0.1 * std::pow(error / per_step, 1.0 / scheme.order.classical)));
  }
  return std::exp(logs / 3);
}

/// Costs at errors of 1e-4, 1e-6, ..., 1e-14 as printed; empty: not printed.
struct CostRow {
  Scheme scheme;
  std::vector<std::string> printed;
};

TEST_CASE("evaluations for an error are those of the survey: 19 by Blanes and Moan, 47 by Yoshida at 1e-6",
          "[oracle]") {
  using namespace schemes;
  const std::vector<CostRow> table = {
      {drift_first(verlet), {"25", "252", "2515", "2.5e+04", "2.5e+05", "2.5e+06"}},
      {drift_first(yoshida_4), {"15", "47", "148", "469", "1482", "4686"}},
      {pefrl, {"8", "25", "78", "247", "780", "2467"}},
      {blanes_moan_s6, {"6", "19", "59", "188", "593", "1875"}},
      {drift_first(yoshida_6), {"14", "30", "65", "140", "302", "651"}},
      {blanes_moan_s10, {"6", "12", "26.5", "57.1", "123", "265"}},
      {drift_first(kahan_li_8_s17), {"12", "21", "36.5", "65", "115", "205"}},
      {drift_first(sofroniou_spaletta_10_s35), {"15", "25", "39", "62", "97.8", "155"}},
      {srkn6b, {"3.6", "11.3"}},
      {srkn11b, {"3.5", "7.5", "16.2", "34.9", "75.2", "162"}},
      {srkn14a, {"3.5", "7.5", "16.1", "34.6", "74.5", "161"}},
  };
  for (const CostRow& row : table) {
    double error = 1e-4;
    for (const std::string& printed : row.printed) {
      const double found = cost(row.scheme, error);
      CAPTURE(std::string(row.scheme.name), error, found);
      const bool power = printed.find('e') != std::string::npos, decimal = printed.find('.') != std::string::npos;
      CHECK((power ? fmt::format("{:.1e}", found) : fmt::format("{:.{}f}", found, decimal ? 1 : 0)) == printed);
      error /= 100;
    }
  }
}

}  // namespace
}  // namespace noether
