/// The form for gravity with the nodes of Radau, and with six and seven stages of Gauss.

#include "integrators/methods/gravity_gauss.hpp"

#include "forces/gravity.hpp"
#include "integrators/classical.hpp"
#include "integrators/kepler.hpp"
#include "monitors/monitors.hpp"
#include "numbers/simd.hpp"
#include "tests/methods/restarts.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

using namespace noether;

namespace {

const Gravity pull_of_planets{.G = test::outer_G};
constexpr const char* of_gravity[] = {"gauss_6", "gauss_7", "gauss_radau_15"};

Classical<double> with_stages(const char* name, const Gravity& gravity, bool adaptive = true) {
  return test::classical_over(gravity, method(name, {.adaptive = adaptive}));
}

/// A star, a planet of e = 0.5, a smaller one outside, and a tracer; G = 1.
ParticleSystem<double> eccentric_planets() {
  ParticleSystem<double> s;
  s.add("star", 1, {0.01, 0, 0}, {0, -0.001, 0});
  s.add("planet", 1e-3, {0.5, 0, 0.01}, {0, 1.7, 0.1});
  s.add("tracer", 0, {-3, 0.2, 0}, {0.02, -0.6, 0.03});
  s.add("outer", 3e-5, {0.1, 5, 0.3}, {-0.45, 0, 0.02});
  return s;
}

double away(const Vec3<double>& a, const Vec3<double>& b) { return std::sqrt(norm2(Vec3<double>(a - b))); }

}  // namespace

TEST_CASE("steps of one length by gauss_radau_15 are those of the method in 113 bits", "[gravity_gauss]") {
  for (const double h : {300.0, -97.0}) {
    auto used = with_stages("gauss_radau_15", pull_of_planets, false);
    auto other =
        test::classical_over(test::field_of<Quad>(pull_of_planets), method("gauss_radau_15", {.adaptive = false}));
    const auto start = test::planets_with_tracers(3);
    const auto made = test::run(used, start, h, 40);
    const auto right = test::run(other, start.as<Quad>(), h, 40);
    for (Index i = 0; i < made.size(); ++i) {
      const Vec3<Quad> off = made.positions()[i].cast<Quad>() - right.positions()[i];
      const Vec3<Quad> apart = right.positions()[i] - right.positions()[i > 0 ? 0 : 1];
      const double error = std::sqrt(static_cast<double>(norm2(off) / norm2(apart)));
      CAPTURE(h, i, fmt::format("{:.2e}", error));
      CHECK(error < 4e-14);
    }
  }
}

TEST_CASE("a pericentre of 1e-9 about a mass in motion at x = 1 keeps its digits with other stages",
          "[gravity_gauss]") {
  constexpr double a = 1e-2, M = 1e-3, q = 1e-9, e = 1 - q / a;
  for (const char* name : of_gravity) {
    ParticleSystem<double> s;
    s.add("mass", M, {1, 0, 0}, {0, 1, 0});
    s.add("tracer", 0, {1 + a * (1 + e), 0, 0}, {0, 1 + std::sqrt(M / a * (q / a) / (1 + e)), 0});
    const double end = 1.5 * 3.141592653589793 * std::sqrt(a * a * a / M);
    Simulation run(s, with_stages(name, Gravity{.G = 1}));
    REQUIRE(run.run_until(end).ok());
    const Vec3<Quad> x = s.positions()[1].cast<Quad>() - s.positions()[0].cast<Quad>();
    const Vec3<Quad> v = s.velocities()[1].cast<Quad>() - s.velocities()[0].cast<Quad>();
    const auto arc = kepler_arc<Quad>(x, v, Quad(M), Quad(end));
    REQUIRE(arc.status == KeplerStatus::converged);
    const Vec3<double> reached = run.particles().positions()[1] - run.particles().positions()[0];
    const Vec3<Quad> off = reached.cast<Quad>() - x - arc.dx;
    const double error = std::sqrt(static_cast<double>(norm2(off)));
    CAPTURE(name, run.step(), run.evaluations().rejected, fmt::format("{:.2e}", error));
    CHECK(error < 1e-11);
    CHECK(run.step() < 5000);
  }
}

TEST_CASE("where forces cancel steps do not shrink, and a collision ends by name, with other stages",
          "[gravity_gauss]") {
  for (const char* name : of_gravity) {
    CAPTURE(name);
    ParticleSystem<double> pair;
    pair.add("left", 0.5, {-0.5, 0, 0}, {0, -0.5, 0});
    pair.add("right", 0.5, {0.5, 0, 0}, {0, 0.5, 0});
    pair.add("light", 0, {0, 0, 1e-12}, {0, 0, 0});
    Simulation cancel(pair, with_stages(name, Gravity{.G = 1}));
    REQUIRE(cancel.run_until(20).ok());
    CHECK(cancel.step() < 400);
    ParticleSystem<double> fall;
    fall.add("left", 0.5, {-1, 0, 0}, {0, 0, 0});
    fall.add("right", 0.5, {1, 0, 0}, {0, 0, 0});
    Simulation head_on(fall, with_stages(name, Gravity{.G = 1}));
    const Outcome outcome = head_on.run_until(100);
    CAPTURE(to_text(outcome), head_on.step());
    CHECK(outcome.kind == Outcome::Kind::step_underflow);
    CHECK(std::abs(head_on.particles().time() - 3.141592653589793) < 1e-12);
    CHECK(head_on.step() < 2000);
  }
}

TEST_CASE("runs with other stages go on with the same bits, whatever looks on", "[gravity_gauss][restart]") {
  for (const char* name : of_gravity) {
    CAPTURE(name);
    for (const std::int64_t n : {1, 2, 3, 60}) {
      test::check_goes_on(with_stages(name, pull_of_planets), test::outer_planets(), n, 0);
      test::check_goes_on(with_stages(name, Gravity{.G = 1}), eccentric_planets(), n, 0);
    }
    Simulation bare(eccentric_planets(), with_stages(name, Gravity{.G = 1}));
    Simulation watched(eccentric_planets(), with_stages(name, Gravity{.G = 1}));
    watched.every_time(0.37, Energy{});
    REQUIRE(bare.run_until(30).ok());
    REQUIRE(watched.run_until(30).ok());
    CHECK(test::same_bits(bare.particles(), watched.particles()));
  }
  test::check_goes_on(with_stages("gauss_radau_15", pull_of_planets, false), test::planets_with_tracers(3), 7, 50);
}

TEST_CASE("a run of gauss_radau_15 that an earlier version has saved goes on", "[gravity_gauss][restart]") {
  auto first = with_stages("gauss_radau_15", pull_of_planets), second = first;
  ParticleSystem<double> s = test::outer_planets();
  s.clock() = Clock<double>::free(0);
  first.bind(s);
  REQUIRE(first.advance(s, {.steps = 20}).steps == 20);
  const double energy = first.energy(s).total();
  SavedState saved;
  first.save(saved, "");
  for (const char* key : {"gravity", "ladder", "before", "h_before", "grids"})
    REQUIRE(saved.erase(std::string("state/") + key) == 1);
  second.bind(s);
  second.load(saved, "");
  REQUIRE(second.advance(s, {.steps = 400}).steps == 400);
  CHECK(std::abs(second.energy(s).total() / energy - 1) < 2e-15);
}

TEST_CASE("with other stages registers of four and of eight numbers give the same bits", "[gravity_gauss][simd]") {
  const SimdLevel used = simd_level();
  for (const char* name : of_gravity) {
    std::vector<ParticleSystem<double>> ends;
    for (const SimdLevel level : {SimdLevel::base, SimdLevel::avx2, SimdLevel::avx512}) {
      if (!has_simd_level(level)) continue;
      set_simd_level(level);
      Simulation run(eccentric_planets(), with_stages(name, Gravity{.G = 1}));
      const Outcome outcome = run.run_until(30);
      set_simd_level(used);
      REQUIRE(outcome.ok());
      ends.push_back(run.particles());
    }
    CAPTURE(name);
    for (Index i = 0; i < 4 && ends.size() > 1; ++i) {
      CHECK(away(ends[0].positions()[i], ends[1].positions()[i]) < 1e-12);
    }
    if (ends.size() > 2) CHECK(test::same_bits(ends[1], ends[2]));
  }
}
