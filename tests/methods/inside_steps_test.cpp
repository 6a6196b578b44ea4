/// Times between two steps of one length: what methods with dense output tell of them, and that runs do not notice.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/oblateness.hpp"
#include "integrators/classical.hpp"
#include "integrators/force_motion.hpp"
#include "monitors/monitors.hpp"
#include "tests/methods/both_words.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/problems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

using namespace noether;
using namespace noether::test;

namespace {

const Gravity pull_inside{.G = outer_G};

/// All particles with both words, at whatever moments are asked for.
struct StateDiary {
  std::vector<std::pair<double, ParticleSystem<double>>>* seen;
  void observe(const Snapshot<double>& now) const { seen->emplace_back(now.time(), now.state()); }
};
using SeenStates = std::vector<std::pair<double, ParticleSystem<double>>>;

template <class... Fs>
Simulation<double> orbits_by(const char* name, ParticleSystem<double> s, double h, Fs... forces) {
  return {std::move(s), classical_over(field_of(std::move(forces)...), method(name)), h};
}

/// Largest errors of positions and velocities, relative to where bodies are and how they move.
struct InsideErrors {
  double position = 0, velocity = 0;
};

/// Errors at looks every 5/8 of a step, which are inside steps but for each fifth, on the way of so many steps.
template <class... Fs>
InsideErrors errors_inside(const char* name, const ParticleSystem<double>& start, double h, int steps, Fs... forces) {
  auto run = orbits_by(name, start, h, forces...);
  SeenStates seen;
  run.every_time(0.625 * h, StateDiary{&seen});
  REQUIRE(run.run(steps).ok());
  REQUIRE(std::ssize(seen) == steps * 8 / 5 + 1);
  auto gauss = classical_over(field_of<Quad>(forces...), method("gauss_8", {.adaptive = false}));
  ParticleSystem<Quad> right = start.as<Quad>();
  right.clock() = Clock<Quad>::fixed(0, 0.625 * h / 4);
  gauss.bind(right);
  InsideErrors worst;
  for (std::size_t k = 1; k < seen.size(); ++k) {
    gauss.advance(right, {.steps = 4});
    CHECK(seen[k].first == 0.625 * h * static_cast<double>(k));
    for (Index i = 0; i < right.size(); ++i) {
      const Words words = words_of(seen[k].second, i);
      const Vec3<Quad> x = right.positions()[i], v = right.velocities()[i], dx = words.x - x, dv = words.v - v;
      worst.position = std::max(worst.position, static_cast<double>(sqrt(norm2(dx) / norm2(x))));
      worst.velocity = std::max(worst.velocity, static_cast<double>(sqrt(norm2(dv) / norm2(v))));
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("inside steps both methods of two words are as right as at the ends of steps", "[inside]") {
  // Jupiter passes Saturn on the way, after 2150 days. There polynomials of degree 9 through the rates of a step of 240
  // days are wrong by 2.6e-14 au where y' of departures is one, by 3e-16 au where accelerations are. Measured,
  // positions and velocities: 1.2e-18 and 1.6e-18, 6.0e-18 and 6.7e-18; 1.5e-19 and 1.6e-19, 7.5e-21 and 6.5e-21.
  struct Case {
    const char* name;
    double h;
    int steps;
    double most;
  };
  for (const Case& c : {Case{"encke_gauss_8", 240, 15, 5e-18}, Case{"encke_gauss_8", 300, 15, 2e-17},
                        Case{"wide_gauss_8", 240, 15, 5e-19}, Case{"wide_gauss_8", 180, 20, 5e-20}}) {
    const InsideErrors errors = errors_inside(c.name, outer_planets(), c.h, c.steps, pull_inside);
    CAPTURE(c.name, c.h, fmt::format("{:.2e} {:.2e}", errors.position, errors.velocity));
    CHECK(errors.position < c.most);
    CHECK(errors.velocity < c.most);
  }
}

TEST_CASE("forces beside gravity count inside steps, at the times they are at there", "[inside]") {
  ParticleSystem<double> start = outer_planets();
  start.add("tracer", 0, {2.5, 0.3, 0.2}, {-0.001, 0.0105, 0.001});
  const Oblateness flat{.J2 = 1e-4, .radius = 0.1, .axis = {0.2, 0, 1}, .G = outer_G};
  const OscillatingField wind{.acceleration = {1e-9, 0, 0}, .omega = 0x1p-7, .phase = 0.3};
  for (const char* name : {"encke_gauss_8", "wide_gauss_8"}) {
    for (const double h : {64.0, -64.0}) {
      const InsideErrors errors = errors_inside(name, start, h, 10, pull_inside, flat, wind);
      CAPTURE(name, h, fmt::format("{:.2e} {:.2e}", errors.position, errors.velocity));
      CHECK(errors.position < 1e-17);
      CHECK(errors.velocity < 1e-17);
    }
  }
}

TEST_CASE("looks inside a step begin their sweeps with its polynomial", "[inside]") {
  for (const char* name : {"encke_gauss_8", "wide_gauss_8"}) {
    ParticleSystem<double> s = outer_planets();
    ForceMotion<ForceField<double>, double> field(field_of(pull_inside));
    field.bind(s);
    const auto planets = make_method<double>(*methods::find(name), {});
    planets->bind(field);
    Vector<double> y, inside(field.size());
    field.gather(s, y);
    const Vector<double> start = y;
    REQUIRE(!planets->step(field, 0, y, 240).failure);
    const auto before = field.evaluations().force;
    planets->interpolate(field, 0.75, inside);
    const auto used = field.evaluations().force - before;
    const auto alone = make_method<double>(*methods::find(name), {});
    alone->bind(field);
    y = start;
    const auto then = field.evaluations().force;
    REQUIRE(!alone->step(field, 0, y, 180).failure);
    CAPTURE(name, used, field.evaluations().force - then);
    CHECK(used < field.evaluations().force - then);
    CHECK((inside - y).cwiseAbs().maxCoeff() < 1e-14);
  }
}

TEST_CASE("the inside of a step begins and ends where the step does", "[inside]") {
  for (const char* name : {"encke_gauss_8", "wide_gauss_8"}) {
    for (const double h : {240.0, -240.0}) {
      ParticleSystem<double> s = outer_planets();
      ForceMotion<ForceField<double>, double> field(field_of(pull_inside));
      field.bind(s);
      const auto planets = make_method<double>(*methods::find(name), {});
      planets->bind(field);
      Vector<double> y, before, inside(field.size());
      field.gather(s, y);
      double worst = 0;
      const auto gap = [&](const Vector<double>& high, const Vector<double>& low) {
        const Vector<double>& inside_low = *planets->interpolated_low_words();
        for (Index k = 0; k < y.size(); ++k)
          worst = std::max(worst, std::abs((inside[k] - high[k]) + (inside_low[k] - low[k])));
      };
      for (int n = 0; n < 3; ++n) {
        before = y;
        const Vector<double> low_before = *planets->low_words();
        REQUIRE(!planets->step(field, n * h, y, h).failure);
        const Vector<double> after = y, low = *planets->low_words();
        planets->interpolate(field, 0, inside);
        gap(before, low_before);
        planets->interpolate(field, 1, inside);
        gap(after, low);
        CHECK((y == after && *planets->low_words() == low));
      }
      CAPTURE(name, h, fmt::format("{:.2e}", worst));
      CHECK(worst < (name == std::string("wide_gauss_8") ? 1e-22 : 1e-19));
    }
  }
}

TEST_CASE("looks inside steps leave the bits of both words, and a restart sees the same", "[inside][restart]") {
  for (const char* name : {"encke_gauss_8", "wide_gauss_8", "dop853", "dormand_prince_5"}) {
    for (const double h : {200.0, -200.0}) {
      CAPTURE(name, h);
      const auto planets = [&] {
        MethodOptions options;
        if (methods::find(name)->adaptive) options.adaptive = false;
        return Simulation<double>(outer_planets(), classical_over(field_of(pull_inside), method(name, options)), h);
      };
      auto whole = planets(), first = planets(), second = planets(), bare = planets();
      SeenStates of_whole, of_parts;
      whole.every_time(0.15 * h, StateDiary{&of_whole});
      first.every_time(0.15 * h, StateDiary{&of_parts});
      second.every_time(0.15 * h, StateDiary{&of_parts});
      REQUIRE(bare.run(20).ok());
      REQUIRE(whole.run(20).ok());
      REQUIRE(first.run(7).ok());
      second.restore(first.save());
      REQUIRE(second.run(13).ok());
      CHECK(same_bits(whole.particles(), bare.particles()));
      CHECK(same_low_words(whole.particles(), bare.particles()));
      CHECK(same_bits(second.particles(), bare.particles()));
      CHECK(same_low_words(second.particles(), bare.particles()));
      CHECK(whole.evaluations().force == bare.evaluations().force);
      CHECK(whole.evaluations().kepler == bare.evaluations().kepler);
      REQUIRE(of_whole.size() == 134);  // 20 / 0.15, and the start
      REQUIRE(of_parts.size() == of_whole.size());
      for (std::size_t k = 0; k < of_whole.size(); ++k) {
        CHECK(of_whole[k].first == of_parts[k].first);
        CHECK(std::abs(of_whole[k].first - 0.15 * h * static_cast<double>(k)) < 1e-9);
        CHECK(same_bits(of_whole[k].second, of_parts[k].second));
        CHECK(same_low_words(of_whole[k].second, of_parts[k].second));
      }
    }
  }
}

TEST_CASE("a list of times may lie between steps, at them, and behind the end", "[inside]") {
  auto run = orbits_by("encke_gauss_8", outer_planets(), 300, pull_inside);
  SeenStates seen, steps;
  run.at_times({300, 750, 800, 900, 3100}, StateDiary{&seen});
  run.every(1, StateDiary{&steps});
  REQUIRE(run.run(10).ok());
  REQUIRE(seen.size() == 4);
  CHECK(same_bits(seen[0].second, steps[1].second));
  CHECK(same_low_words(seen[0].second, steps[1].second));
  CHECK(seen[1].first == 750);
  CHECK(seen[1].second.clock().time() == 750);
  CHECK(same_bits(seen[3].second, steps[3].second));
  REQUIRE(run.run(1).ok());  // a longer run comes there
  REQUIRE(seen.size() == 5);
  CHECK(seen[4].first == 3100);

  auto late = orbits_by("encke_gauss_8", outer_planets(), 300, pull_inside);
  SeenStates after;
  late.every({.interval = 450, .after = 1000}, StateDiary{&after});
  REQUIRE(late.run_until(3000).ok());
  REQUIRE(after.size() == 4);  // 1350, 1800, 2250, 2700
  CHECK(after[0].first == 1350);
  CHECK(after[3].first == 2700);
}

TEST_CASE("the energy inside steps is that of the steps, in 113 bits", "[inside][energy]") {
  auto run = orbits_by("encke_gauss_8", outer_planets(), 240, pull_inside);
  const Energy& energy = run.every_time(150, Energy{});
  REQUIRE(run.run(500).ok());
  auto again = orbits_by("encke_gauss_8", outer_planets(), 240, pull_inside);
  const Energy& right = again.every(1, Energy{});
  REQUIRE(again.run(500).ok());
  CAPTURE(fmt::format("{:.2e} {:.2e}", energy.worst(), right.worst()));
  CHECK(energy.worst() < 1.5 * right.worst() + 3e-19);
  CHECK(energy.worst() > 1e-22);
}

TEST_CASE("methods without dense output refuse times between steps by name", "[inside]") {
  Simulation<double> run(outer_planets(), classical_over(pull_inside, method("rk4")), 300.0);
  CHECK_THROWS_WITH(run.at_times({300, 750}, Energy{}),
                    Catch::StartsWith("monitor 'energy' cannot sample at time 750: ") && Catch::Contains("2.5 steps"));
  CHECK_THROWS(run.every_time(750, Energy{}));
}

TEST_CASE("a step that fails ends the run as it does without looks inside", "[inside]") {
  for (const char* name : {"encke_gauss_8", "wide_gauss_8"}) {
    CAPTURE(name);
    auto run = orbits_by(name, outer_planets(), 200, pull_inside, EndingField{1000});
    SeenStates seen;
    run.every_time(150, StateDiary{&seen});
    const Outcome outcome = run.run(10);
    CHECK(outcome.kind == Outcome::Kind::overlap);
    CHECK(outcome.message == "the field has ended");
    CHECK(run.step() == 5);
    CHECK(seen.back().first == 900);
  }
}

TEST_CASE("every method with dense output tells states inside steps of one length as well as at them", "[inside]") {
  const ParticleSystem<double> start = kepler_pair(0.3);
  const double h = 0x1p-5;
  int found = 0;
  for (const MethodInfo* info : methods::all()) {
    if (!info->fixed || info->gravity_only) continue;
    MethodOptions options;
    if (info->adaptive) options.adaptive = false;
    Simulation<double> run(start, classical_over(Gravity{}, MethodChoice{info, options}), h);
    if (!run.claims().between_steps) continue;
    ++found;
    SeenStates seen, steps;
    run.every_time(0.3 * h, StateDiary{&seen});
    run.every(1, StateDiary{&steps});
    REQUIRE(run.run_until(6).ok());
    REQUIRE(seen.size() == 641);
    const auto worst = [&](const SeenStates& states) {
      double most = 0;
      for (const auto& [time, s] : states) {
        const Vec3<double> off = relative_motion(s).x - kepler_motion(start, time).x;
        most = std::max(most, std::sqrt(norm2(off)));
      }
      return most;
    };
    const double inside = worst(seen), at_steps = worst(steps);
    CAPTURE(info->name, inside, at_steps);
    CHECK(inside < 1.5 * at_steps + 1e-13);
  }
  CHECK(found >= 4);
}

TEST_CASE("a run that blows up between two looks ends where it does without any", "[inside]") {
  const auto end = [](double interval) {
    ParticleSystem<double> s(unit_system("reduced"));
    s.add("one", 1, {1, 0, 0}, {0, 0, 0});
    Simulation<double> run(s, classical_over(field_of(HarmonicField{.k = 1}), method("dop853", {.adaptive = false})),
                           20.0);
    if (interval > 0) run.every_time(interval, Energy{});
    const Outcome outcome = run.run(1000);
    CHECK(outcome.kind == Outcome::Kind::diverged);
    CHECK(run.particles().positions().all().allFinite());
    return run.step();
  };
  const std::int64_t step = end(0);
  CHECK(step > 10);
  CHECK(end(20.0 * 10.4) == step);
}

TEST_CASE("a look at the time from which on a monitor looks is not lost by rounding", "[inside]") {
  const double day = 86400;
  for (const int k : {1, 3, 7, 11, 21}) {
    ParticleSystem<double> s(unit_system("reduced"));
    s.add("one", 1, {1, 0, 0}, {0, 0, 0});
    const auto swing = classical_over(field_of(HarmonicField{.k = 1e-12}), method("dop853", {.adaptive = false}));
    Simulation<double> run(s, swing, day);
    SeenStates seen;
    run.every({.interval = 0.7 * day, .after = std::stod(fmt::format("{:.12g}", 0.7 * k)) * day}, StateDiary{&seen});
    REQUIRE(run.run(20).ok());
    REQUIRE_FALSE(seen.empty());
    CAPTURE(k, seen.front().first / day);
    CHECK(std::abs(seen.front().first / day - 0.7 * k) < 1e-9);
  }
}

TEST_CASE("a run that was begun with looks at whole steps keeps them", "[inside][restart]") {
  const auto begin = [](SeenStates& seen, bool listed) {
    auto run = orbits_by("encke_gauss_8", outer_planets(), 100, pull_inside);
    if (listed) {
      run.at_times({0, 260, 540, 1130}, StateDiary{&seen});
    } else {
      run.every_time(260, StateDiary{&seen});
    }
    return run;
  };
  for (const bool listed : {false, true}) {
    SeenStates early, late;
    auto first = begin(early, listed), again = begin(late, listed);
    REQUIRE(first.run(4).ok());
    SavedRun saved = first.save();
    int marks = 0;
    for (auto& [name, state] : saved.parts) marks += static_cast<int>(state.erase("looks_between_steps"));
    CHECK(marks == 1);
    again.restore(saved);
    REQUIRE(again.run(8).ok());
    std::vector<double> times;
    for (const auto& [time, state] : late) times.push_back(time);
    CHECK(times == (listed ? std::vector<double>{500, 1100} : std::vector<double>{600, 900, 1200}));
  }
}
