// The reference in extended precision, against closed forms and against itself.

#include "study/find_truth.hpp"
#include "study/position_error.hpp"
#include "tests/study/scenes.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <cmath>

namespace noether::test {
namespace {

/// Two bodies of total mass 1 at their mean anomaly t, in extended precision: separation at time t.
Vec3<Quad> separation(Quad e, Quad t) {
  Quad E = t;
  for (int k = 0; k < 200; ++k) {
    const Quad step = (E - e * sin(E) - t) / (Quad(1) - e * cos(E));
    E -= step;
    if (abs(step) < Quad(1e-32)) break;
  }
  return Vec3<Quad>(cos(E) - e, sqrt(Quad(1) - e * e) * sin(E), Quad(0));
}

TEST_CASE("the truth of a Kepler orbit is the closed form of its own doubles", "[truth]") {
  const Scene scene = kepler(0.6, "method = \"verlet\"\nstep = 0.01\nsteps = 100");
  const Sampling sampling{0.0625, 200};
  const Truth truth = find_truth(scene, sampling);
  INFO(truth.note);
  REQUIRE(truth.kind == TruthKind::quad);
  REQUIRE(truth.error);
  CHECK(*truth.error < 1e-15);
  REQUIRE(truth.y.size() == 201);
  // The orbit that the rounded start is on, from its energy and angular momentum.
  const auto relative = [&](const Vector<Quad>& y, Index first) {
    return Vec3<Quad>(y[first + 1] - y[first], y[first + 3] - y[first + 2], y[first + 5] - y[first + 4]);
  };
  const Vec3<Quad> r0 = relative(truth.y[0], 0), v0 = relative(truth.y[0], 6);
  const Quad v2 = v0[0] * v0[0] + v0[1] * v0[1], r = sqrt(r0[0] * r0[0] + r0[1] * r0[1]);
  const Quad a = Quad(1) / (Quad(2) / r - v2), n = Quad(1) / (a * sqrt(a)), e = Quad(1) - r / a;
  Quad worst(0);
  for (int j = 0; j <= 200; ++j) {
    const Vec3<Quad> exact = a * separation(e, n * sampling.exact_time(j));
    const Vec3<Quad> found = relative(truth.y[static_cast<std::size_t>(j)], 0);
    const Vec3<Quad> off(found[0] - exact[0], found[1] - exact[1], found[2] - exact[2]);
    worst = std::max(worst, abs(off[0]) + abs(off[1]) + abs(off[2]));
  }
  CHECK(static_cast<double>(worst) < 3 * *truth.error + 1e-19);
  CHECK(static_cast<double>(worst) < 1e-15);
}

TEST_CASE("the truth of the outer Solar System has an error bar below 1e-15, over the splitting's own scene",
          "[truth]") {
  const Scene scene = outer_solar_system();
  const Truth truth = find_truth(scene, {100, 200});
  INFO(truth.note);
  REQUIRE(truth.kind == TruthKind::quad);
  CHECK(*truth.error < 1e-15);
  CHECK(truth.name.ends_with(" in quad"));
  // Gravity with the scene's own constant: energies of extended precision stay where they are.
  REQUIRE(truth.energy.size() == 201);
  CHECK(std::abs(static_cast<double>(truth.energy.back() / truth.energy.front()) - 1) < 1e-15);
}

TEST_CASE("the truth of a damped oscillator is the closed form", "[truth]") {
  const Scene scene = oscillator("method = \"verlet\"\nstep = 0.01\nsteps = 1000", 0.125);
  const Sampling sampling{0.125, 200};
  const Truth truth = find_truth(scene, sampling);
  REQUIRE(truth.kind == TruthKind::quad);
  const Quad g = Quad(1) / Quad(16), w = sqrt(Quad(1) - g * g);
  for (int j = 0; j <= 200; ++j) {
    const Quad t = sampling.exact_time(j), x = exp(-g * t) * (cos(w * t) + g / w * sin(w * t));
    CHECK(static_cast<double>(abs(x - truth.y[static_cast<std::size_t>(j)][0])) < 1e-16);
  }
}

TEST_CASE("a truth stands beside that of a method of another family, and says so", "[truth]") {
  const Scene orbit = kepler(0.6, "method = \"verlet\"\nstep = 0.01\nsteps = 100");
  const Truth two = find_truth(orbit, {0.0625, 200});
  CHECK(two.note == "gragg_bulirsch_stoer in extended precision, rtol 3e-22, checked against gauss_8 at 1e-18");
  CHECK(two.error.value() > 0);
  CHECK(two.error.value() < 1e-18);
}

TEST_CASE("where Gauss's iteration does not get on, extrapolation stands beside itself, and finds the closed form",
          "[truth]") {
  constexpr int points = 100;
  const Scene scene = read_scene(R"(units = "reduced"
[system]
type = "heat_line"
points = 100
mode = 1
[integrator]
method = "rodas_5p"
until = 0.01
)",
                                 "heat.toml");
  const Sampling sampling{0.0005, 20};
  const Truth truth = find_truth(scene, sampling);
  INFO(truth.note);
  REQUIRE(truth.kind == TruthKind::quad);
  CHECK(truth.note == "gragg_bulirsch_stoer in extended precision, rtol 3e-22, checked against itself at 1e-20");
  REQUIRE(truth.error);
  CHECK(*truth.error > 0);
  CHECK(*truth.error < 1e-17);
  REQUIRE(truth.y.size() == 21);
  // The sine's share of a state decays at its rate, 4 (n + 1)^2 sin^2(pi / (2 (n + 1))), whatever else rounding began.
  const Quad part = acos(Quad(-1)) / Quad(points + 1), half = Quad(points + 1) * sin(part / Quad(2));
  const auto share = [&](const Vector<Quad>& y) {
    Quad sum(0);
    for (Index i = 0; i < points; ++i) sum += y[i] * sin(part * Quad(static_cast<double>(i + 1)));
    return sum;
  };
  const Quad first = share(truth.y.front());
  for (int j = 1; j <= 20; ++j) {
    const Quad expected = exp(-Quad(4) * half * half * sampling.exact_time(j));
    const Quad found = share(truth.y[static_cast<std::size_t>(j)]) / first;
    CHECK(static_cast<double>(abs(found / expected - Quad(1))) < 1e-17);
  }
}

struct DoubleOnly {
  static constexpr auto describe() { return part<DoubleOnly>("double_only", "a spring, in doubles"); }
  void add_to(ForceSink<double>& out, const ParticleSystem<double>& s) const {
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<double> x = s.positions()[i];
      out.acceleration(i, -x);
      if (out.wants_energy()) out.energy(s.masses()[i] * (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) / 2);
    }
  }
};

TEST_CASE("a force written for doubles only has no truth, and says so", "[truth]") {
  CHECK_FALSE(AnyForce<double>(DoubleOnly{}).in_quad());
  CHECK(AnyForce<double>(Gravity{}).in_quad());
  Parts parts = standard_parts();
  parts.add_force<DoubleOnly>();
  const Scene scene = read_scene(R"(units = "reduced"
[particles]
body = [{ name = "bob", mass = 1, x = [1, 0, 0], v = [0, 0, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "double_only"
[integrator]
method = "verlet"
step = 0.01
steps = 100
)",
                                 "spring.toml", parts);
  const Truth truth = find_truth(scene, {0.1, 200});
  CHECK(truth.kind == TruthKind::invariants);
  CHECK(truth.note == "force 'double_only' is written for doubles only");
  CHECK_FALSE(truth.has_states());
}

TEST_CASE("a truth beyond its budget is none, and says what it would cost", "[truth]") {
  const Truth truth = find_truth(outer_solar_system(), {1e6, 200}, {.budget = 0.05});
  CHECK(truth.kind == TruthKind::invariants);
  INFO(truth.note);
  CHECK(truth.note.starts_with("extended precision would take about "));
}

TEST_CASE("position errors are about the centre of mass where the forces keep it, else relative to a typical size",
          "[truth]") {
  const Scene two = kepler(0, "method = \"verlet\"\nstep = 0.01\nsteps = 100");
  REQUIRE(about_center(two));
  const PositionError error(two.particles, true);
  // x of both, y of both, z of both, velocities.
  Vector<Quad> exact = Vector<Quad>::Zero(12), shifted = exact;
  exact[0] = Quad(-0.25), exact[1] = Quad(0.75);
  shifted = exact;
  shifted[0] += Quad(3), shifted[1] += Quad(3);
  CHECK(error(shifted, exact) < 1e-30);
  shifted[1] += Quad(1e-3);
  CHECK(error(shifted, exact) > 5e-4);
  const Scene one = oscillator("method = \"verlet\"\nstep = 0.01\nsteps = 100");
  CHECK_FALSE(about_center(one));
  PositionError spring(one.particles, false);
  Vector<Quad> zero = Vector<Quad>::Zero(6), away = zero;
  away[0] = Quad(1);
  spring.set_scale({zero, away});
  CHECK(std::abs(spring(away, zero) - std::sqrt(2.0)) < 1e-12);
}

TEST_CASE("errors of a first-order system are relative to each variable's largest value", "[truth]") {
  PositionError error(ParticleSystem<double>(), false);
  const auto state = [](double a, double b, double c) {
    Vector<Quad> y(3);
    y << Quad(a), Quad(b), Quad(c);
    return y;
  };
  error.set_scale({state(1, 0, 0), state(0.5, -2e-5, 0), state(0.25, 1e-5, 0)});
  // A quarter of the trace's largest value, though it is 5e-6 of what is whole; a variable that rests is measured by 1.
  const Vector<Quad> truth = state(0.5, 1e-5, 0);
  CHECK(std::abs(error(state(0.5, 1.5e-5, 0), truth) - 0.25 / std::sqrt(3.0)) < 1e-12);
  CHECK(std::abs(error(state(0.75, 1e-5, 0), truth) - 0.25 / std::sqrt(3.0)) < 1e-12);
  CHECK(std::abs(error(state(0.5, 1e-5, 0.25), truth) - 0.25 / std::sqrt(3.0)) < 1e-12);
  CHECK(std::abs(error(state(0.75, 1.5e-5, 0.25), truth) - 0.25) < 1e-12);
}

}  // namespace
}  // namespace noether::test
