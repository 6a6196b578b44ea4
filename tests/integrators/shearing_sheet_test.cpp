/// The shearing sheet: epicycles at any step, encounters under gravity, and what a run keeps.

#include "integrators/shearing_sheet.hpp"
#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "monitors/monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "numbers/dual.hpp"
#include "numbers/pack.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/sheets.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace noether {
namespace {

using Start = std::array<double, 6>;

ParticleSystem<double> one(const Start& at) {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("stone", 1, {at[0], at[1], at[2]}, {at[3], at[4], at[5]});
  return s;
}

/// Largest difference of a number of a particle, relative to the larger of it and 1.
template <class Real> double distance(const ParticleSystem<Real>& s, const std::array<Quad, 6>& exact) {
  double worst = 0;
  for (int k = 0; k < 6; ++k) {
    const Quad found = Quad(k < 3 ? s.positions()[0][k] : s.velocities()[0][k - 3]);
    const Quad expected = exact[static_cast<std::size_t>(k)];
    worst = std::max(worst, static_cast<double>(Quad(abs(found - expected)) / std::max(Quad(1), Quad(abs(expected)))));
  }
  return worst;
}

struct Orbit {
  ShearingSheetOptions options;
  Start start;
  double time;
  std::array<Quad, 6> end;
};

// An independent integration of the equations to 4.8e-35 and 7.1e-30, printed with 20 digits.
const std::array<Orbit, 2> seen_orbits = {
    {{{.Omega = 1},
      {1, 2, 0.5, 0.3, -1.2, 0.1},
      100,
      {0.93069898429446200144_q, -238.69024744595910019_q, 0.38052287203286608768_q, -0.0451237229795500959_q,
       -1.0613979685889240028_q, 0.33941470778364779023_q}},
     {{.Omega = 0.7, .Omega_z = 2.5},
      {0.02, 0, 0.01, 0.001, -0.02, 0.004},
      1000,
      {0.02603168453589265786_q, -24.002146180797582831_q, 0.00655804709718202391_q, 0.00024883672084600884_q,
       -0.02844435835024972101_q, 0.01929248854333313284_q}}}};

template <class Real> ParticleSystem<Real> after(const Orbit& orbit, int steps) {
  Simulation<Real> sim(one(orbit.start).as<Real>(), compose(test::sheet<Real>(orbit.options), schemes::verlet_aba),
                       Clock<Real>::fixed(0, orbit.time / steps));
  REQUIRE(sim.run(steps).ok());
  return sim.particles();
}

}  // namespace

TEST_CASE("epicycles are exact at any step, in doubles and in 113 bits", "[integrators][shearing_sheet]") {
  for (const Orbit& orbit : seen_orbits) {
    // Steps of many turns, of about half a turn, and short ones. Starts are rounded to doubles: 0.3 and the like.
    for (const int steps : {1, 3, 16, 31, 32, 33, 100, 1000, 20'000}) {
      INFO(steps << " steps");
      CHECK(distance(after<double>(orbit, steps), orbit.end) <= 1e-12);
    }
    Orbit exact = orbit;  // a step of 1 and of 10 is a double
    for (const int steps : {1, 100}) {
      CHECK(distance(after<Quad>(exact, steps), orbit.end) <= 1e-13);
      const auto s = after<Quad>(exact, steps), t = after<Quad>(exact, 2 * steps);
      CHECK(test::distance(s, t) <= 1e-27);
    }
  }
}

TEST_CASE("an epicycle neither grows nor fades, and keeps its phase", "[integrators][shearing_sheet]") {
  // 1.6e5 turns in 1e6 steps that are no part of a turn. In 113 bits the same step has an error of 1e-26.
  const int steps = 1'000'000;
  const double h = 1.0009765625;
  const Start start = {1, 0, 0.5, 0.25, -1.25, 0.125};
  Simulation<double> sim(one(start), compose(test::sheet<double>({}), schemes::verlet_aba), h);
  REQUIRE(sim.run(steps).ok());
  Simulation<Quad> exact(one(start).as<Quad>(), compose(test::sheet<Quad>({}), schemes::verlet_aba),
                         Clock<Quad>::fixed(0, steps * h));
  REQUIRE(exact.run(1).ok());
  const auto s = sim.particles();
  const auto e = exact.particles();
  const auto size = [](const auto& of) {
    const auto x = of.positions()[0], v = of.velocities()[0];
    const double w = static_cast<double>(v[1]) + 1.5 * static_cast<double>(x[0]);
    return std::hypot(static_cast<double>(v[0]), 2 * w);
  };
  // Rounding of the state alone, 1e6 steps of some ulp, which add up as their root; a drift of an ulp a step were
  // 1e-10.
  CHECK(std::abs(size(s) / size(e) - 1) <= 3e-12);
  // The angle of a step is right to half an ulp, as Omega itself is.
  for (const int k : {0, 2}) {
    CHECK(std::abs(s.positions()[0][k] - static_cast<double>(e.positions()[0][k])) <= 1.2e-10);
    CHECK(std::abs(s.velocities()[0][k] - static_cast<double>(e.velocities()[0][k])) <= 1.2e-10);
  }
}

TEST_CASE("a Hill encounter by the symplectic epicycle", "[integrators][shearing_sheet]") {
  // Independent figures: relative motion of two bodies with G(m1 + m2) = 1, of the same splitting and of the exact
  // motion, error bar 3e-17.
  const Vec3<double> exact_x(2.15445219053169441925, -102.32007031846431272, 0),
      exact_v(0.02453290171924357685, -3.0155048719916098592, 0);
  struct Figures {
    double position = 0, jacobi = 0;
  };
  const auto meet = [&](double h, const Scheme& scheme) {
    ParticleSystem<double> s(unit_system("reduced"));
    s.add("one", 0.25, {-1.875, -9, 0}, {0, 2.8125, 0});
    s.add("other", 0.75, {0.625, 3, 0}, {0, -0.9375, 0});
    Simulation<double> sim(std::move(s), compose(test::sheet<double>({}, Gravity{}), scheme), h);
    Figures figures;
    const double reduced = 0.1875;
    // Of the relative motion; that of the centre of mass is an epicycle of its own, here at rest.
    auto& energy = sim.every(1, Energy{});
    REQUIRE(sim.run(std::lround(30 / h)).ok());
    figures.jacobi = energy.worst() * energy.scale().value() / reduced;
    const auto end = sim.particles();
    const Vec3<double> x = end.positions()[1] - end.positions()[0];
    figures.position = (x - exact_x).norm();
    return figures;
  };
  const Figures coarse = meet(0.02, schemes::verlet_aba), fine = meet(0.01, schemes::verlet_aba);
  CHECK(std::abs(coarse.position / 1.08e-5 - 1) <= 0.03);
  CHECK(std::abs(fine.position / 2.7e-6 - 1) <= 0.03);
  CHECK(std::abs(std::log2(coarse.position / fine.position) - 2.0) <= 0.03);
  CHECK(std::abs(coarse.jacobi / 1.51e-5 - 1) <= 0.03);
  CHECK(meet(0.02, *schemes::find("aba_8_6_4")).position <= 1e-8);
}

TEST_CASE("the error of an encounter is proportional to the masses", "[integrators][shearing_sheet]") {
  // A splitting into epicycle and gravity knows the motion without masses: for 1e-4 and 1e-6 of the mass at the same
  // step the errors differ by 100, to the order of the larger mass.
  const auto error = [](double mass, double h, const Scheme& scheme) {
    ParticleSystem<double> s(unit_system("reduced"));
    s.add("moonlet", mass, {0, 0, 0}, {0, 0, 0});
    s.add("stone", 0, {2.5, 12, 0}, {0, -3.75, 0});
    const auto end = [&](const Scheme& by, double step) {
      const auto wide = s.as<Quad>();
      const auto after = test::run(test::sheet<Quad>({}, Gravity{}), by, wide, step, std::lround(6 / step));
      return Vec3<Quad>(after.positions()[1]);
    };
    const Vec3<Quad> off = end(scheme, h) - end(schemes::aba_10_6_4, 0.0625);
    return std::sqrt(static_cast<double>(norm2(off)));
  };
  const double heavy = error(1e-4, 0.125, schemes::verlet_aba), light = error(1e-6, 0.125, schemes::verlet_aba);
  CHECK(heavy > 1e-9);
  CHECK(std::abs(heavy / light / 100 - 1) <= 1e-3);
}

TEST_CASE("a sheet has the action of its flows, in p = m (v_x, v_y + 2 Omega x, v_z)",
          "[integrators][shearing_sheet]") {
  // dS = p1 dq1 - p0 dq0 over all directions of phase space, by central differences of order 2: their error is 1e-20.
  auto hamiltonian = test::sheet<Quad>({.Omega = 0.7, .Omega_z = 1.3}, Gravity{.softening = 0.3});
  auto s = test::planets(0.5, 2).as<Quad>();
  hamiltonian.bind(s);
  const auto momenta = [](const ParticleSystem<Quad>& of, Index i) {
    const Vec3<Quad> x = of.positions()[i], v = of.velocities()[i];
    return Vec3<Quad>(of.masses()[i] * Vec3<Quad>(v[0], v[1] + Quad(2) * Quad(0.7) * x[0], v[2]));
  };
  const Quad delta(1e-10);
  for (const char letter : {'A', 'B'}) {
    for (const double h : {0.37, -0.2, 5.1}) {  // the last one beyond half a turn
      auto end = s, plain = s;
      hamiltonian.flow_with_action(letter, end, Quad(h));
      hamiltonian.flow(letter, plain, Quad(h));
      CHECK((end.positions().all() == plain.positions().all()));
      CHECK((end.velocities().all() == plain.velocities().all()));
      double worst = 0;
      for (Index i = 0; i < s.size(); ++i) {
        for (int d = 0; d < 6; ++d) {
          auto up = s, down = s;
          for (auto* moved : {&up, &down}) {
            (d < 3 ? moved->positions() : moved->velocities())[i][d % 3] += moved == &up ? delta : -delta;
          }
          Quad expected(0);
          for (Index j = 0; j < s.size(); ++j) {
            expected -=
                dot(momenta(s, j), Vec3<Quad>(std::as_const(up).positions()[j] - std::as_const(down).positions()[j]));
          }
          const Quad more = hamiltonian.flow_with_action(letter, up, Quad(h));
          const Quad less = hamiltonian.flow_with_action(letter, down, Quad(h));
          for (Index j = 0; j < s.size(); ++j) {
            expected +=
                dot(momenta(end, j), Vec3<Quad>(std::as_const(up).positions()[j] - std::as_const(down).positions()[j]));
          }
          worst = std::max(worst, std::fabs(static_cast<double>((more - less - expected) / (Quad(2) * delta))));
        }
      }
      INFO("letter " << letter << " for " << h);
      CHECK(worst <= 1e-16);
    }
  }
}

TEST_CASE("the shadow Hamiltonian of a sheet is flatter than its energy", "[integrators][shearing_sheet][shadow]") {
  // The orders of the formula itself: half the step, 2^-4 and 2^-8 of the fluctuation.
  const auto shadow = [](double h) {
    auto s = test::planets(0.2, 2);
    Simulation<Quad> sim(s.as<Quad>(), compose(test::sheet<Quad>({}, Gravity{.softening = 0.5}), schemes::verlet_aba),
                         Clock<Quad>::fixed(0, h));
    auto& watched = sim.every(1, ShadowHamiltonian<Quad>({4, 8}));
    REQUIRE(sim.run(std::lround(4 / h)).ok());
    CHECK(watched.verdict().starts_with("kept"));
    return std::array{watched.fluctuation(0), watched.fluctuation(1)};
  };
  const auto coarse = shadow(0.0625), fine = shadow(0.03125);
  CHECK(std::abs(std::log2(coarse[0] / fine[0]) - 4) <= 0.3);
  CHECK(std::abs(std::log2(coarse[1] / fine[1]) - 8) <= 0.5);
}

TEST_CASE("a sheet with compensated sums, in lanes and over dual numbers", "[integrators][shearing_sheet]") {
  const Orbit& orbit = seen_orbits[0];
  Simulation<double> plain(one(orbit.start), compose(test::sheet<double>(orbit.options), schemes::verlet_aba), 0.01);
  Simulation<double> compensated(
      one(orbit.start), compose(test::sheet<double>(orbit.options), schemes::verlet_aba, {.compensated = true}), 0.01);
  REQUIRE(plain.run(10'000).ok());
  REQUIRE(compensated.run(10'000).ok());
  CHECK(distance(compensated.particles(), orbit.end) <= 1e-13);
  CHECK(distance(compensated.particles(), orbit.end) < distance(plain.particles(), orbit.end));

  const auto moved = [&]<class Real>(const Real& dx) {  // the end, from a start that is a little beside
    ParticleSystem<Real> s = one(orbit.start).as<Real>();
    s.positions()[0][0] += dx;
    return test::run(ShearingSheet<HarmonicField, Real>(HarmonicField{.k = 0.3}, orbit.options), schemes::yoshida_4, s,
                     0.1, 30);
  };
  Pack beside(0);
  for (std::size_t lane = 0; lane < Pack::lanes; ++lane) beside.lane[lane] = 0.01 * static_cast<double>(lane);
  const auto eight = moved(beside);
  for (std::size_t lane = 0; lane < Pack::lanes; ++lane) {
    const auto alone = moved(0.01 * static_cast<double>(lane));
    for (int k = 0; k < 3; ++k) {
      CHECK(std::abs(eight.positions()[0][k].lane[lane] - alone.positions()[0][k]) <= 1e-13);
      CHECK(std::abs(eight.velocities()[0][k].lane[lane] - alone.velocities()[0][k]) <= 1e-13);
    }
  }
  Dual<double, 1> along(0);
  along.slope[0] = 1;
  const auto derivative = moved(along);
  const auto up = moved(Quad(1e-12)), down = moved(Quad(-1e-12));
  for (int k = 0; k < 3; ++k) {
    const Quad slope = (up.positions()[0][k] - down.positions()[0][k]) / Quad(2e-12);
    CHECK(std::abs(derivative.positions()[0][k].slope[0] - static_cast<double>(slope)) <= 1e-12);
  }
}

TEST_CASE("methods that do not split know the same sheet", "[integrators][shearing_sheet]") {
  auto s = test::planets(0.2, 2);
  const ShearingSheetOptions options{.Omega = 0.5, .Omega_z = 0.9};
  const auto& [frame] = options.forces();
  auto gauss = test::classical_over(test::field_of(frame, Gravity{}), method("gauss_8", {.adaptive = false}));
  const auto by_gauss = test::run(gauss, s, 0.01, 300);
  const auto by_scheme =
      test::run(test::sheet<double>(options, Gravity{}), schemes::sofroniou_spaletta_10_s35, s, 0.01, 300);
  CHECK(test::distance(by_gauss, by_scheme) <= 1e-12);
  // The same energy, and the same accelerations.
  auto hamiltonian = test::sheet<double>(options, Gravity{});
  hamiltonian.bind(s);
  CHECK(std::abs(hamiltonian.energy(s).total() - gauss.energy(s).total()) <= 1e-15);
  VectorColumn<double> a(s.size()), b(s.size());
  hamiltonian.accelerations(s, a);
  gauss.accelerations(s, b);
  CHECK((a.all() - b.all()).cwiseAbs().maxCoeff() <= 1e-15);
}

TEST_CASE("what is no sheet is refused in one line", "[integrators][shearing_sheet]") {
  const auto refusal = [](const ShearingSheetOptions& options) {
    try {
      options.check();
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refusal({}) == "");
  CHECK(refusal({.Omega = 2, .Omega_z = 0}) == "");
  CHECK(refusal({.Omega = 0}) ==
        "Omega = 0 is not a valid angular velocity of the frame; a number above 0 is expected");
  CHECK(refusal({.Omega = -1}) ==
        "Omega = -1 is not a valid angular velocity of the frame; a number above 0 is expected");
  CHECK(refusal({.Omega_z = -2}) ==
        "Omega_z = -2 is not a valid angular velocity; 0 (no force along z) or more is expected");
}

TEST_CASE("many steps at a time of free particles have the bits of each step alone", "[integrators][shearing_sheet]") {
  ParticleSystem<double> s(unit_system("reduced"));
  for (Index i = 0; i < 3000; ++i) {
    const double k = static_cast<double>(i);
    s.add("", 1, {std::sin(k), std::cos(3 * k), 0.1 * std::sin(7 * k)}, {0.1 * std::cos(k), -1.5 * std::sin(k), 0.02});
  }
  for (const Scheme* scheme : {&schemes::verlet, &schemes::verlet_aba, &schemes::yoshida_6}) {
    for (const double h : {0.05, 2.0}) {  // of the second some are beyond half a turn
      const auto hamiltonian = test::sheet<double>({.Omega = 1.1, .Omega_z = 1.7});
      Composition<AnyHamiltonian<double>> stepped(hamiltonian, *scheme);
      ParticleSystem<double> alone = s, together = s;
      alone.clock() = together.clock() = Clock<double>::fixed(0, h);
      stepped.bind(alone);
      for (int k = 0; k < 150; ++k) stepped.advance(alone, {.steps = 1});
      Composition<AnyHamiltonian<double>> at_once(hamiltonian, *scheme);
      at_once.bind(together);
      at_once.advance(together, {.steps = 150});
      CHECK((alone.positions().all() == together.positions().all()));
      CHECK((alone.velocities().all() == together.velocities().all()));
      CHECK(alone.clock().step() == together.clock().step());
    }
  }
}

TEST_CASE("threads do not change a sheet of many particles", "[integrators][shearing_sheet]") {
  ParticleSystem<double> s(unit_system("reduced"));
  for (Index i = 0; i < 5000; ++i) {
    const double k = static_cast<double>(i);
    s.add("", 0, {std::sin(k), std::cos(3 * k), 0.1 * std::sin(7 * k)}, {0.1 * std::cos(k), -1.5 * std::sin(k), 0.02});
  }
  s.add("moonlet", 1e-3, {0, 0, 0}, {0, 0, 0});
  const auto end = [&](int threads) {
    const int before = thread_count();
    set_thread_count(threads);
    auto state = test::run(test::sheet<double>({}, Gravity{.softening = 0.01}), schemes::verlet_aba, s, 0.05, 5);
    set_thread_count(before);
    return state;
  };
  const auto alone = end(1);
  for (const int threads : {2, 3, 8}) {
    const auto shared = end(threads);
    CHECK((shared.positions().all() == alone.positions().all()));
    CHECK((shared.velocities().all() == alone.velocities().all()));
  }
}

}  // namespace noether
