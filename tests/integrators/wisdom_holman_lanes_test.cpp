/// Planets in lanes: the same motion as letter by letter, the same bits however a run is made.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/wisdom_holman.hpp"
#include "monitors/monitors.hpp"
#include "tests/integrators/random_planets.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/settings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>

namespace noether {
namespace {

using namespace noether::test;  // random_planets.hpp

constexpr Coordinates in_lanes[] = {Coordinates::jacobi, Coordinates::democratic};

std::vector<Course> courses() {
  std::mt19937_64 random(5);
  std::vector<Course> all;
  const GrPotential relativity{};
  for (const Coordinates coordinates : in_lanes) {
    const WisdomHolmanOptions options{.coordinates = coordinates};
    const auto plain = test::wisdom_holman(options), bent = test::wisdom_holman(options, relativity);
    for (const int planets : {1, 3, 8, 9, 17}) {
      const auto s = random_planets(planets, random, true);
      all.push_back({s, plain, &schemes::verlet_aba, 4.0});
      all.push_back({s, plain, &schemes::verlet, 3.0, {.compensated = true}});
      all.push_back({s, bent, &schemes::verlet_aba, -5.0, {.corrector = 7}});
      all.push_back({s, plain, &schemes::abah_8_6_4, 12.0});
      if (coordinates != Coordinates::jacobi) continue;
      const StepKernel modified = StepKernel::modified, lazy = StepKernel::lazy;
      all.push_back({s, bent, &schemes::verlet_aba, 4.0, {.corrector = 7, .kernel = lazy}});
      all.push_back({s, plain, &schemes::verlet_aba, -3.0, {.compensated = true, .kernel = lazy}});
      all.push_back({s, bent, &schemes::verlet, 3.0, {.corrector = 3, .kernel = modified, .second_corrector = true}});
      all.push_back({s, plain, &schemes::saba_2, 8.0, {.compensated = true, .kernel = modified}});
    }
    all.push_back({crowd_of_planets(260), bent, &schemes::verlet_aba, 4.0});
    const auto with_tracers = random_planets(4, random, true, 300);
    all.push_back({with_tracers, bent, &schemes::verlet_aba, 4.0});
    all.push_back({with_tracers, plain, &schemes::verlet, -3.0, {.compensated = true}});
    all.push_back({random_planets(10, random, true, 3), plain, &schemes::abah_8_6_4, 12.0});
  }
  all.push_back(
      {random_planets(5, random, true), test::wisdom_holman({}), &schemes::aba_10_6_4, 15.0, {.compensated = true}});
  // With tracers, kicks of kernels go letter by letter.
  for (const StepKernel kernel : {StepKernel::modified, StepKernel::lazy}) {
    all.push_back({random_planets(5, random, true, 20),
                   test::wisdom_holman({}),
                   &schemes::verlet_aba,
                   5.0,
                   {.corrector = 11, .kernel = kernel}});
  }
  return all;
}

}  // namespace

TEST_CASE("a step in lanes is the step of 113 bits to rounding, for 1 to 30 planets of any shape", "[wisdom_holman]") {
  std::mt19937_64 random(17);
  const GrPotential relativity{};
  for (const Coordinates coordinates : in_lanes) {
    const WisdomHolmanOptions splitting{.coordinates = coordinates};
    for (const bool bent : {false, true}) {
      Roundings lanes, letters;
      for (int trial = 0; trial < 100; ++trial) {
        const auto s = random_planets(1 + trial % 30, random, false, trial % 4 == 0 ? 5 : 0);
        const double dt =
            std::exp(std::log(40.0) * std::uniform_real_distribution<double>(0, 1)(random)) * (trial % 3 == 0 ? -1 : 1);
        const Scheme& scheme = trial % 2 == 0 ? schemes::verlet : schemes::verlet_aba;
        const std::int64_t steps = 1 + trial % 4;
        CompositionOptions options;
        if (coordinates == Coordinates::jacobi && trial % 3 > 0)
          options.kernel = trial % 3 == 1 ? StepKernel::lazy : StepKernel::modified;
        const auto exact = [&](double size, double speed) {
          const auto field = bent ? test::field_of<Quad>(relativity) : ForceField<Quad>();
          return after<Quad>(s, test::wisdom_holman_over(splitting, field), scheme, dt, steps, size, speed, options);
        };
        const auto in_doubles = [&](const ForceField<double>& field) {
          return after<double>(s, test::wisdom_holman_over(splitting, field), scheme, dt, steps, 1, 1, options);
        };
        compare(exact, in_doubles(bent ? test::field_of(relativity) : ForceField<double>()), lanes);
        compare(exact, in_doubles(bent ? test::field_of(relativity, no_field) : test::field_of(no_field)), letters);
      }
      CAPTURE(static_cast<int>(coordinates), bent, lanes.worst, lanes.sum / lanes.count, letters.worst,
              letters.sum / letters.count);
      CHECK(lanes.sum < 2 * letters.sum);
      CHECK(lanes.worst < 10 * letters.worst);
      CHECK(lanes.sum < 20 * lanes.count);
    }
  }
}

TEST_CASE("planets are in lanes where their forces are there, and letter by letter elsewhere", "[wisdom_holman]") {
  auto s = test::outer_planets();
  const auto bound = [&](auto hamiltonian) {
    hamiltonian.bind(s);
    return hamiltonian.lanes().bound();
  };
  CHECK(bound(WisdomHolman({.G = test::outer_G})));
  CHECK(bound(WisdomHolman({.G = test::outer_G, .coordinates = Coordinates::democratic})));
  CHECK_FALSE(bound(WisdomHolman({.G = test::outer_G, .coordinates = Coordinates::whds})));
  CHECK_FALSE(bound(WisdomHolman({.G = test::outer_G, .coordinates = Coordinates::barycentric})));
  CHECK(bound(WisdomHolman<double, ForceField<double>>({}, test::field_of(GrPotential{}))));
  CHECK_FALSE(bound(WisdomHolman<double, ForceField<double>>({}, test::field_of(GrPotential{}, no_field))));
  CHECK_FALSE(bound(WisdomHolman<double, ForceField<double>>({}, test::field_of(no_field))));
  for (const int planets : {256, 257}) {
    s = ParticleSystem<double>();
    s.add("star", 1, {0, 0, 0}, {0, 0, 0});
    for (int k = 0; k < planets; ++k) s.add("planet " + std::to_string(k), 1e-9, {1 + 0.1 * k, 0, 0}, {0, 1, 0});
    CHECK(bound(WisdomHolman({.G = 1})));
  }
  s = test::outer_planets();
  s.masses()[5] = 1e-70;  // products of masses would not be normal numbers
  CHECK_FALSE(bound(WisdomHolman({.G = test::outer_G})));
}

TEST_CASE("planets whose pairs have no constants that are kept move as letter by letter, and are noted so",
          "[wisdom_holman][encounter]") {
  const auto crowd = crowd_of_planets(300);
  auto meeting = crowd;  // planets of different rows, of equal masses
  meeting.masses()[200] = meeting.masses()[100] = 3e-7;
  meeting.positions().set(200, 1.004 * std::as_const(meeting).positions()[100]);
  meeting.velocities().set(200, std::as_const(meeting).velocities()[100]);
  for (const Coordinates coordinates : in_lanes) {
    for (const StepKernel kernel : {StepKernel::plain, StepKernel::lazy, StepKernel::modified}) {
      if (kernel != StepKernel::plain && coordinates != Coordinates::jacobi) continue;
      CAPTURE(static_cast<int>(coordinates), static_cast<int>(kernel));
      const CompositionOptions composed{.kernel = kernel};
      const WisdomHolmanOptions options{.coordinates = coordinates};
      const auto lanes = test::wisdom_holman(options, GrPotential{});
      const auto letters = test::wisdom_holman(options, GrPotential{}, no_field);
      const auto mine = after<double>(crowd, lanes, schemes::verlet, 6.0, 10, 1, 1, composed);
      const auto others = after<double>(crowd, letters, schemes::verlet, 6.0, 10, 1, 1, composed);
      for (std::size_t k = 0; k < mine.size(); ++k) {
        CHECK(std::sqrt(norm2(Vec3<double>(mine[k].first - others[k].first)) / norm2(mine[k].first)) < 2e-14);
        CHECK(std::sqrt(norm2(Vec3<double>(mine[k].second - others[k].second)) / norm2(mine[k].second)) < 2e-14);
      }
      const auto seen = [&](const AnyHamiltonian<double>& hamiltonian) {
        Simulation<double> run(meeting, Composition<AnyHamiltonian<double>>(hamiltonian, schemes::verlet, composed),
                               3.0);
        REQUIRE(run.run(12).ok());
        return run.evaluations().encounter;
      };
      const auto of_lanes = seen(lanes), of_letters = seen(letters);
      REQUIRE((of_lanes.has_value() && of_letters.has_value()));
      CHECK(of_lanes->first == of_letters->first);
      CHECK(of_lanes->second == of_letters->second);
      CHECK(of_lanes->time == of_letters->time);
      CHECK(of_lanes->since == of_letters->since);
    }
  }
}

TEST_CASE("planets in lanes have the same bits for any level, cadence and division of a run, and across a restart",
          "[wisdom_holman][determinism][restart]") {
  constexpr std::int64_t steps = 23;
  for (const Course& course : courses()) {
    CAPTURE(course.start.size(), course.scheme->name, course.dt, course.options.compensated);
    std::optional<ParticleSystem<double>> first;
    for (const SimdLevel level : test::all_levels()) {
      const test::AtLevel at(level);
      const auto end = end_of(course, steps);
      if (!first) first = end;
      CAPTURE(name(level));
      CHECK(test::same_bits(*first, end));
    }
    auto watched = course.begin();
    watched.every(1, Energy{});
    REQUIRE(watched.run(steps).ok());
    CHECK(test::same_bits(*first, watched.particles()));
    for (const std::int64_t half : {1, 2, 3, 9}) {
      auto before = course.begin(), again = course.begin();
      REQUIRE(before.run(half).ok());
      again.restore(before.save());
      REQUIRE(again.run(steps - half).ok());
      CHECK(test::same_bits(*first, again.particles()));
    }
    const test::Threads threads(3);
    CHECK(test::same_bits(*first, end_of(course, steps)));
  }
}

TEST_CASE("flows one by one, with their action, have the bits of whole runs, and the action of letters",
          "[wisdom_holman]") {
  std::mt19937_64 random(23);
  const auto start = random_planets(6, random, true);
  const std::pair<Coordinates, StepKernel> kinds[] = {{Coordinates::jacobi, StepKernel::plain},
                                                      {Coordinates::democratic, StepKernel::plain},
                                                      {Coordinates::jacobi, StepKernel::modified}};
  for (const auto& kind : kinds) {
    const Coordinates coordinates = kind.first;
    const StepKernel kernel = kind.second;
    const WisdomHolmanOptions options{.coordinates = coordinates};
    const CompositionOptions composed{.kernel = kernel};
    const auto walked = [&](const AnyHamiltonian<double>& hamiltonian, bool with_action) {
      auto s = start;
      s.clock() = Clock<double>::fixed(0, 4.0);
      Composition<AnyHamiltonian<double>> integrator(hamiltonian, schemes::verlet, composed);
      integrator.bind(s);
      double action = 0;
      if (with_action) {
        integrator.advance_with_action(s, {.steps = 40}, action);
      } else {
        integrator.advance(s, {.steps = 40});
      }
      return std::pair(s, action);
    };
    const auto lanes = test::wisdom_holman(options, GrPotential{});
    const auto one = walked(lanes, true), whole = walked(lanes, false);
    CHECK(test::same_bits(one.first, whole.first));
    const auto letters = walked(test::wisdom_holman(options, GrPotential{}, no_field), true);
    CHECK(one.second != 0);
    CHECK(std::fabs(one.second / letters.second - 1) < 1e-12);
  }
}

TEST_CASE("the prediction of the next arcs is state, and runs saved without it go on", "[wisdom_holman][restart]") {
  const auto integrator = compose(WisdomHolman({.G = test::outer_G}), schemes::verlet_aba);
  Simulation first(test::outer_planets(), integrator, 200.0);
  REQUIRE(first.run(5).ok());
  SavedRun saved = first.save();
  int found = 0;
  for (auto& [part, state] : saved.parts) {
    for (auto entry = state.begin(); entry != state.end();) {
      const bool own = entry->first.find("/lanes/") != std::string::npos;
      if (own && entry->first.ends_with("predicted")) {
        CHECK(std::get<std::vector<double>>(entry->second).size() == 5);
        ++found;
      }
      entry = own ? state.erase(entry) : std::next(entry);
    }
  }
  CHECK(found == 1);
  Simulation old(test::outer_planets(), integrator, 200.0);
  old.restore(saved);
  REQUIRE(first.run(5).ok());
  REQUIRE(old.run(5).ok());
  const auto a = first.particles(), b = old.particles();
  for (Index i = 0; i < a.size(); ++i) {
    CHECK(std::sqrt(norm2(Vec3<double>(a.positions()[i] - b.positions()[i])) / norm2(a.positions()[i])) < 1e-13);
  }
}

TEST_CASE("planets in lanes that come near each other are noted as letter by letter", "[encounter]") {
  const std::pair<Coordinates, StepKernel> kinds[] = {{Coordinates::jacobi, StepKernel::plain},
                                                      {Coordinates::democratic, StepKernel::plain},
                                                      {Coordinates::jacobi, StepKernel::lazy},
                                                      {Coordinates::jacobi, StepKernel::modified}};
  for (const auto& kind : kinds) {
    const Coordinates coordinates = kind.first;
    const StepKernel kernel = kind.second;
    CAPTURE(static_cast<int>(coordinates), static_cast<int>(kernel));
    const CompositionOptions options{.kernel = kernel};
    std::vector<std::int64_t> counts;
    const auto seen = [&](const AnyHamiltonian<double>& hamiltonian) {
      ParticleSystem<double> s;
      s.add("star", 1, {0, 0, 0}, {0, 0, 0});
      for (int k = 0; k < 9; ++k) {  // beyond the pair that meets, and one of them before it in the file
        const double r = k == 0 ? 3 : 3 + 0.8 * k, angle = 2.0 * k;
        s.add("far " + std::to_string(k), 1e-7, {r * std::cos(angle), r * std::sin(angle), 0},
              {-std::sin(angle) / std::sqrt(r), std::cos(angle) / std::sqrt(r), 0});
      }
      s.add("outer", 1e-5, {1.04 * std::cos(0.05), 1.04 * std::sin(0.05), 0},
            {-std::sin(0.05) / std::sqrt(1.04), std::cos(0.05) / std::sqrt(1.04), 0});
      s.add("inner", 1e-5, {1, 0, 0}, {0, 1, 0});
      Simulation<double> run(std::move(s), Composition<AnyHamiltonian<double>>(hamiltonian, schemes::verlet, options),
                             0.05);
      REQUIRE(run.run(1500).ok());
      counts.push_back(run.evaluations().force);
      return run.evaluations().encounter;
    };
    const auto lanes = seen(test::wisdom_holman({.G = 1, .coordinates = coordinates}));
    const auto letters = seen(test::wisdom_holman({.G = 1, .coordinates = coordinates}, no_field));
    CHECK(counts[0] == counts[1]);
    REQUIRE((lanes.has_value() && letters.has_value()));
    CHECK(lanes->first == letters->first);
    CHECK(lanes->second == letters->second);
    CHECK(lanes->since == letters->since);
    CHECK(lanes->time == letters->time);
    CHECK(std::fabs(lanes->hill_radii / letters->hill_radii - 1) < 1e-4);
  }
}

TEST_CASE("second passes are few at short steps, and arcs beyond them go to the exact solver", "[wisdom_holman]") {
  std::mt19937_64 random(2);
  const auto start = random_planets(8, random, true);
  const auto counts = [&](double dt) {
    auto s = start;
    s.clock() = Clock<double>::fixed(0, dt);
    Composition integrator(WisdomHolman(WisdomHolmanOptions{}), schemes::verlet_aba);
    integrator.bind(s);
    integrator.advance(s, {.steps = 200});
    const PlanetLanes& lanes = integrator.hamiltonian().lanes();
    return std::pair(lanes.second_passes(), lanes.exact_arcs());
  };
  const auto fine = counts(1), coarse = counts(60);
  CHECK(fine.first < 5);
  CHECK(fine.second == 0);
  CHECK(coarse.first > 100);
  CHECK(coarse.second > 0);
}

TEST_CASE("two planets at one place end the run at the step at which it ends letter by letter", "[wisdom_holman]") {
  for (const Coordinates coordinates : in_lanes) {
    const auto outcome = [](const AnyHamiltonian<double>& hamiltonian) {
      auto s = test::outer_planets();
      s.positions().set(3, std::as_const(s).positions()[2]);
      Simulation<double> run(std::move(s), Composition<AnyHamiltonian<double>>(hamiltonian, schemes::verlet), 40.0);
      return run.run(10);
    };
    const WisdomHolmanOptions options{.G = test::outer_G, .coordinates = coordinates};
    const Outcome lanes = outcome(test::wisdom_holman(options));
    const Outcome letters = outcome(test::wisdom_holman(options, no_field));
    CHECK(lanes.kind == letters.kind);
    CHECK(lanes.step == letters.step);
    if (coordinates == Coordinates::jacobi) continue;  // where planets are a rounding apart, and thrown out
    CHECK(lanes.kind == Outcome::Kind::diverged);
    REQUIRE(lanes.particle.has_value());
    CHECK(lanes.particle->index > 0);  // a planet; letter by letter a jump may have spoilt the star too
  }
}

TEST_CASE("planets too near or too far for lanes, and none there, are never the ones that fail", "[wisdom_holman]") {
  // In a row of eight lanes six or seven have no planet: what stands there may not end the run.
  for (const double size : {1e-70, 1e-59, 1.0, 1e59, 1e70}) {
    for (const double dt : {1e-150, 1.0, 1e150}) {
      CAPTURE(size, dt);
      ParticleSystem<double> s;
      s.add("star", 1, {0, 0, 0}, {0, 0, 0});
      s.add("planet", 1e-3, {size, 0, 0}, {0, 1 / std::sqrt(size), 0});
      Simulation<double> run(std::move(s), compose(WisdomHolman({.G = 1.0}), schemes::verlet), dt);
      const Outcome end = run.run(3);
      if (end.ok()) continue;
      REQUIRE(end.particle.has_value());
      CHECK(end.particle->index < 2);
    }
  }
}

TEST_CASE("compensation keeps what rounding takes from planets in lanes", "[wisdom_holman]") {
  // A step so short that the energy error of the method is below rounding.
  const auto error = [](bool compensated) {
    std::mt19937_64 random(41);
    double sum = 0;
    for (int trial = 0; trial < 4; ++trial) {
      const auto start = random_planets(4, random, true);
      const auto wide = [](const ParticleSystem<double>& s) {
        auto particles = s.as<Quad>();
        if (const auto* low = s.low_words()) {
          for (Index i = 0; i < s.size(); ++i) {
            particles.positions().add(i, Vec3<double>(low->x[i]).cast<Quad>());
            particles.velocities().add(i, Vec3<double>(low->v[i]).cast<Quad>());
          }
        }
        return particles;
      };
      auto s = start;
      WisdomHolman<double> lanes(WisdomHolmanOptions{});
      WisdomHolman<Quad> exact(WisdomHolmanOptions{});
      auto truth = start.as<Quad>();
      lanes.bind(s);
      exact.bind(truth);
      lanes.open(s);
      s.keep_low_words(compensated);
      truth = wide(s);
      for (int k = 0; k < 1500; ++k) {
        lanes.flow('A', s, 2.0);
        exact.flow('A', truth, Quad(2.0));
      }
      const auto mine = wide(s);
      for (Index i = 1; i < s.size(); ++i) {
        const Vec3<Quad> x = mine.positions()[i] - truth.positions()[i];
        sum += static_cast<double>(norm2(x) / norm2(Vec3<Quad>(std::as_const(truth).positions()[i])));
      }
    }
    return std::sqrt(sum);
  };
  const double plain = error(false), kept = error(true);
  CAPTURE(plain, kept);
  CHECK(kept < 0.7 * plain);
}

}  // namespace noether
