/// Runs that begin at another time than 0, and monitors that look at the times of a list.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "monitors/monitors.hpp"
#include "monitors/time_correlation.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

#include <cmath>
#include <limits>

namespace noether {
namespace {

/// Keeps every state that it sees, and when.
struct StateDiary {
  std::vector<std::pair<double, ParticleSystem<double>>>* pages;
  std::vector<std::int64_t>* steps = nullptr;
  void observe(const Snapshot<double>& now) const {
    pages->emplace_back(now.time(), now.state());
    if (steps != nullptr) steps->push_back(now.step());
  }
};
using Pages = std::vector<std::pair<double, ParticleSystem<double>>>;

AnyIntegrator<double> planets_by(const std::string& name) {
  const Gravity gravity{.G = test::outer_G};
  if (const Scheme* scheme = schemes::find(name)) {
    return AnyIntegrator<double>(compose(test::kinetic_potential(gravity), *scheme));
  }
  return AnyIntegrator<double>(test::classical_over(gravity, method(name)));
}

Clock<double> clock_from(double start, const std::string& name, double dt) {
  const MethodInfo* info = methods::find(name);
  const bool free = info != nullptr && info->is_adaptive({});
  if (free) return Clock<double>::free(start, dt < 0 ? Direction::backward : Direction::forward);
  return Clock<double>::fixed(start, dt);
}

Simulation<double> planets_from(double start, const std::string& name, double dt = 32) {
  return {test::outer_planets(), planets_by(name), clock_from(start, name, dt)};
}

/// x'' = g cos(omega t + phase) from x0, v0 at time t0, in closed form.
double driven(const OscillatingField& drive, double x0, double v0, double t0, double t) {
  const double g = drive.acceleration[0], w = drive.omega, a = w * t0 + drive.phase, b = w * t + drive.phase;
  return x0 + (v0 - g / w * std::sin(a)) * (t - t0) - g / (w * w) * (std::cos(b) - std::cos(a));
}

}  // namespace

TEST_CASE("where nothing depends on time, a run from another time has the same states to the bit", "[start time]") {
  for (const std::string name : {"verlet", "yoshida_8", "blanes_moan_s6", "rk4", "dop853", "gauss_radau_15", "bdf"}) {
    for (const double start : {1e3, -262144.5}) {
      for (const double dt : {32.0, -32.0}) {
        if (dt < 0 && name == "bdf") continue;
        CAPTURE(name, start, dt);
        Pages pages, shifted;
        auto run = planets_from(0, name, dt), other = planets_from(start, name, dt);
        run.every(1, StateDiary{&pages});
        other.every(1, StateDiary{&shifted});
        REQUIRE(run.run(60).ok());
        REQUIRE(other.run(60).ok());
        REQUIRE(pages.size() == 61);
        REQUIRE(shifted.size() == 61);
        for (std::size_t k = 0; k < pages.size(); ++k) {
          CHECK(test::same_bits(pages[k].second, shifted[k].second));
          CHECK(std::abs(shifted[k].first - start - pages[k].first) <= 1e-10);
        }
        CHECK(shifted.front().first == start);
        CHECK((other.time() < start) == (dt < 0));
      }
    }
  }
}

TEST_CASE("a force that oscillates in time is that of the clock, wherever a run begins", "[start time]") {
  const OscillatingField drive{.acceleration = {0.7, 0, 0}, .omega = 1.25, .phase = 0.5};
  ParticleSystem<double> ball;
  ball.add("ball", 2, {0.25, 0, 0}, {-0.5, 0, 0});
  // A quarter of a period of the drive apart: forgotten starts are off by as much as the motion itself.
  for (const double start : {0.0, 1000.0, 1000 + M_PI / 2.5, -77.0}) {
    CAPTURE(start);
    const double end = start + 3;
    const double exact = driven(drive, 0.25, -0.5, start, end);
    CHECK(std::abs(exact - driven(drive, 0.25, -0.5, 0, 3)) > (start == 0 ? -1 : 0.1));
    Simulation by_verlet(ball, compose(test::kinetic_potential(drive), schemes::verlet), 1.0 / 4096, start);
    CHECK(by_verlet.run_until(end).ok());
    CHECK(by_verlet.step() == 3 * 4096);
    CHECK(std::abs(by_verlet.particles().positions()[0][0] - exact) < 1e-7);
    Simulation by_yoshida(ball, compose(test::kinetic_potential(drive), schemes::yoshida_8), 1.0 / 64, start);
    CHECK(by_yoshida.run(192).ok());
    CHECK(std::abs(by_yoshida.particles().positions()[0][0] - exact) < 1e-11);
    for (const char* name : {"dop853", "gauss_8", "gauss_radau_15", "gragg_bulirsch_stoer"}) {
      CAPTURE(name);
      MethodOptions options;
      options.rtol = options.atol = 1e-12;
      if (std::string(name).starts_with("gauss")) options = {};
      Simulation<double> run(ball, test::classical_over(drive, method(name, options)), Clock<double>::free(start));
      CHECK(run.run_until(end).ok());
      CHECK(run.time() == end);
      CHECK(std::abs(run.particles().positions()[0][0] - exact) < 1e-9);
    }
  }
}

TEST_CASE("run_until is a time of the clock, and a start far from 0 rounds", "[start time]") {
  auto run = planets_from(2460000.5, "verlet", 0.1);
  CHECK(run.run_until(2460010.5).ok());
  CHECK(run.step() == 100);
  CHECK(run.run_until(2460031.2).ok());
  CHECK(run.step() == 307);
  CHECK_THROWS_WITH(run.run_until(2460031.25),
                    Catch::Contains("of 0.1 after the start at 2460000.5; the nearest whole numbers are"));
  CHECK_THROWS_WITH(run.run_until(100), "time 100 has passed: the run is already at 2460031.2");
  CHECK_THROWS_WITH(planets_from(std::numeric_limits<double>::quiet_NaN(), "verlet"),
                    "a run cannot begin at time nan; a finite time is expected");
  CHECK_THROWS_WITH(planets_from(std::numeric_limits<double>::infinity(), "dop853"),
                    "a run cannot begin at time inf; a finite time is expected");
}

TEST_CASE("a run that began elsewhere is restored where it was", "[start time][restart]") {
  for (const std::string name : {"yoshida_4", "dop853"}) {
    CAPTURE(name);
    Pages whole, later;
    auto run = planets_from(1000, name);
    run.every(10, StateDiary{&whole});
    REQUIRE(run.run(20).ok());
    const SavedRun saved = run.save();
    auto other = planets_from(1000, name);
    other.every(10, StateDiary{&later});
    other.restore(saved);
    CHECK(other.time() == run.time());
    REQUIRE(run.run(33).ok());
    REQUIRE(other.run(33).ok());
    CHECK(other.time() == run.time());
    CHECK(test::same_bits(run.particles(), other.particles()));
    REQUIRE(whole.size() == 6);
    REQUIRE(later.size() == 3);
    CHECK(later.back().first == whole.back().first);
  }
}

TEST_CASE("a monitor looks at the times of a list, and no bit of the run depends on them", "[start time][times]") {
  for (const std::string name : {"verlet", "yoshida_8", "dop853", "gauss_radau_15"}) {
    for (const double start : {0.0, 1024.0}) {
      CAPTURE(name, start);
      const std::vector<double> times = {start + 64, start + 96, start + 960, start + 3200, start + 1e6};
      Pages listed, every;
      auto run = planets_from(start, name), other = planets_from(start, name), bare = planets_from(start, name);
      run.at_times(times, StateDiary{&listed});
      other.every_time(32, StateDiary{&every});
      for (Simulation<double>* one : {&run, &other, &bare}) REQUIRE(one->run_until(start + 3200).ok());
      CHECK(test::same_bits(run.particles(), bare.particles()));
      CHECK(test::same_bits(run.particles(), other.particles()));
      CHECK(run.step() == bare.step());
      CHECK(run.evaluations().force == bare.evaluations().force);
      REQUIRE(listed.size() == 4);
      REQUIRE(every.size() == 101);
      for (std::size_t k = 0; k < listed.size(); ++k) {
        CHECK(listed[k].first == times[k]);
        const auto& same = every[static_cast<std::size_t>((times[k] - start) / 32)];
        CHECK(same.first == times[k]);
        CHECK(test::same_bits(listed[k].second, same.second));
      }
    }
  }
}

TEST_CASE("times of a list between steps of a method's own choice are met exactly", "[start time][times]") {
  Pages listed, backward;
  auto run = planets_from(5, "dop853"), back = planets_from(5, "dop853", -1);
  run.at_times({5, 5.5, 777.125, 4001}, StateDiary{&listed});
  back.at_times({5, -100.5, -4001}, StateDiary{&backward});
  REQUIRE(run.run_until(4001).ok());
  REQUIRE(back.run_until(-5000).ok());
  REQUIRE(listed.size() == 4);
  REQUIRE(backward.size() == 3);
  CHECK(listed[0].first == 5);
  CHECK(listed[2].first == 777.125);
  CHECK(listed[3].first == 4001);
  CHECK(test::same_bits(listed[3].second, run.particles()));
  CHECK(backward[1].first == -100.5);
  CHECK(backward[2].first == -4001);
}

TEST_CASE("a run goes on in the middle of a list, cut into pieces or restored", "[start time][times][restart]") {
  const std::vector<double> times = {0, 320, 352, 1600, 1632, 3200};
  for (const std::string name : {"verlet", "dop853"}) {
    CAPTURE(name);
    Pages whole, first, second;
    auto run = planets_from(0, name);
    run.at_times(times, StateDiary{&whole});
    REQUIRE(run.run_until(3200).ok());
    auto begun = planets_from(0, name);
    begun.at_times(times, StateDiary{&first});
    REQUIRE(begun.run_until(352).ok());
    auto other = planets_from(0, name);
    other.at_times(times, StateDiary{&second});
    other.restore(begun.save());
    REQUIRE(other.run_until(1600).ok());
    REQUIRE(other.run_until(3200).ok());
    CHECK(test::same_bits(other.particles(), run.particles()));
    REQUIRE(whole.size() == 6);
    REQUIRE(first.size() == 3);
    REQUIRE(second.size() == 3);
    for (std::size_t k = 0; k < 6; ++k) {
      const auto& page = k < 3 ? first[k] : second[k - 3];
      CHECK(page.first == whole[k].first);
      CHECK(test::same_bits(page.second, whole[k].second));
    }
  }
}

TEST_CASE("who wants several steps in a row has them from each listed one on", "[start time][times]") {
  struct InARow : StateDiary {
    std::int64_t steps_in_a_row() const { return 3; }
  };
  Pages pages;
  std::vector<std::int64_t> seen;
  auto run = planets_from(0, "verlet");
  run.at_times({64, 96, 320}, InARow{{&pages, &seen}});
  REQUIRE(run.run(11).ok());
  CHECK(seen == std::vector<std::int64_t>{2, 3, 4, 5, 10, 11});
  REQUIRE(run.run(4).ok());
  CHECK(seen == std::vector<std::int64_t>{2, 3, 4, 5, 10, 11, 12});
}

TEST_CASE("lists of times that cannot be are refused", "[start time][times][messages]") {
  const auto refused = [](const std::string& name, std::vector<double> times, double start = 0) {
    auto run = planets_from(start, name);
    try {
      run.at_times(std::move(times), Energy{});
    } catch (const Error& error) {
      return error.message();
    }
    return std::string();
  };
  const std::string cannot = "monitor 'energy' cannot sample at time ";
  for (const std::string name : {"verlet", "dop853"}) {
    CAPTURE(name);
    CHECK(refused(name, {}).starts_with("monitor 'energy' has 0 cadences; give one: "));
    CHECK(refused(name, {32, std::nan("")}) == cannot + "nan: a finite time is expected");
    CHECK(refused(name, {-32, 32}) == cannot + "-32: it lies before the start at 0");
    CHECK(refused(name, {32, 64}, 40) == cannot + "32: it lies before the start at 40");
    CHECK(refused(name, {32, 32}) == cannot + "32: it is listed twice");
    CHECK(refused(name, {64, 32}) == cannot + "32: it is listed after 64, which the run reaches later");
    CHECK(refused(name, {32, 64}).empty());
  }
  CHECK(refused("verlet", {32, 72}) ==
        cannot + "72: a duration of 72 is 2.25 steps of 32; the nearest whole numbers are 64 (2) and 96 (3)");
  CHECK(refused("verlet", {40, 88}, 8) ==
        cannot +
            "88: time 88 is 2.5 steps of 32 after the start at 8; the nearest whole numbers are at 72 (2) and 104 (3)");
  CHECK(refused("verlet", {32, 32 * (1 + 1e-14)}) == cannot + "32.00000000000032: it is listed twice, at step 1");
  auto run = planets_from(0, "dop853");
  const auto refusal = [&](std::vector<double> times) {
    try {
      run.at_times(std::move(times), MeanSquareDisplacement(2, 1));
    } catch (const Error& error) {
      return error.message();
    }
    return std::string();
  };
  CHECK(refusal({1, 2, 4}) ==
        "monitor 'mean_square_displacement' counts lags in samples, so it needs equal intervals: its list goes from 2 "
        "to 4, but its first two times are 1 apart; attach it by steps or by an interval of time");
  CHECK(refusal({1, 2, 3, 4}).empty());
  run.at_times({7, 9}, Energy{});
  REQUIRE(run.run_until(10).ok());
  CHECK_THROWS_WITH(run.run_until(5), Catch::Contains("samples at times of a list, so the run cannot turn back"));
  auto fixed = planets_from(0, "verlet");
  fixed.at_times({64}, Energy{});
  CHECK_THROWS_WITH(fixed.change_step(16),
                    "monitor 'energy' samples at times of a list, which a new step would shift; attach it by steps");
}

TEST_CASE("errors of what is conserved are measured from the start, not from the first time of a list",
          "[start time][times][monitors]") {
  // Two steps of 1/2 of x'' = -x from rest at 1, by hand: x = 17/32, v = -105/128; all are numbers of doubles.
  ParticleSystem<double> ball;
  ball.add("ball", 1, {1, 0, 0}, {0, 0, 0});
  Simulation<double> spring(ball, compose(test::kinetic_potential(HarmonicField{.k = 1}), schemes::verlet), 0.5);
  auto& listed = spring.at_times({1}, Energy{});
  auto& regular = spring.every(2, Energy{});
  auto& pushed = spring.at_times({1}, Momentum{});
  REQUIRE(spring.run(2).ok());
  CHECK(listed.worst() == 0.04486083984375);  // 1 - x^2 - v^2
  CHECK(regular.worst() == listed.worst());
  CHECK(listed.report().samples == 1);
  CHECK(listed.report().first == 0.5);
  CHECK(pushed.worst() == 0.8203125);  // of nothing, so relative to 1

  // Falling from (1, 0) with v = (1, 0): velocity Verlet has the parabola.
  ParticleSystem<double> stone;
  stone.add("stone", 1, {1, 0, 0}, {1, 0, 0});
  const UniformField down{.acceleration = {0, -1, 0}};
  Simulation<double> fall(stone, compose(test::kinetic_potential(down), schemes::verlet), 0.5);
  auto& turn = fall.at_times({1}, AngularMomentum{});
  auto& push = fall.at_times({1}, Momentum{});
  auto& center = fall.at_times({1}, CenterOfMass{});
  REQUIRE(fall.run(2).ok());
  CHECK(turn.worst() == 1.5);    // |(1 + t) t - t^2 / 2| / (|x| |v|)
  CHECK(push.worst() == 1);      // t / |v|
  CHECK(center.worst() == 0.5);  // t^2 / 2

  ParticleSystem<double> pair;
  pair.add("left", 1, {-1, 0, 0}, {-2, 0, 0});
  pair.add("right", 1, {1, 0, 0}, {2, 0, 0});
  for (const bool again : {false, true}) {
    const auto made = [&] {
      return Simulation<double>(pair, compose(test::kinetic_potential(UniformField{}), schemes::verlet), 0.5);
    };
    auto first = made(), other = made();
    first.at_times({1, 2}, MeanSquareDisplacement(2, 1));
    auto& away = other.at_times({1, 2}, MeanSquareDisplacement(2, 1));
    if (again) {  // saved between the start and the first look
      REQUIRE(first.run(1).ok());
      other.restore(first.save());
    }
    REQUIRE(other.run_until(1).ok());
    CHECK(away.since_start() == 4);
    REQUIRE(other.run_until(2).ok());
    CHECK(away.since_start() == 16);
  }
}

TEST_CASE("a first time that is the start but for rounding is the start", "[start time][times]") {
  for (const std::string name : {"verlet", "dop853"}) {
    for (const double off : {-1.0, 1.0}) {
      CAPTURE(name, off);
      const double start = 1024;
      Pages pages;
      auto run = planets_from(start, name);
      run.at_times({std::nextafter(start, start + off), start + 64}, StateDiary{&pages});
      REQUIRE(run.run_until(start + 64).ok());
      REQUIRE(pages.size() == 2);
      CHECK(pages[0].first == start);
      CHECK(test::same_bits(pages[0].second, test::outer_planets()));
    }
  }
  auto run = planets_from(1024, "verlet");
  CHECK_THROWS_WITH(run.at_times({1024 - 1e-9, 1056}, Energy{}), Catch::Contains("it lies before the start at 1024"));
}

TEST_CASE("a restored run that began at another time looks at the times of its list", "[start time][times][restart]") {
  Pages pages, other_pages;
  auto begun = planets_from(1024, "verlet"), other = planets_from(0, "verlet");
  begun.at_times({1344, 1376}, StateDiary{&pages});
  other.at_times({1344, 1376}, StateDiary{&other_pages});  // by its own clock steps 42 and 43
  REQUIRE(begun.run(5).ok());
  other.restore(begun.save());
  REQUIRE(begun.run_until(3200).ok());
  REQUIRE(other.run_until(3200).ok());
  REQUIRE(pages.size() == 2);
  REQUIRE(other_pages.size() == 2);
  CHECK(other_pages[0].first == 1344);
  CHECK(other_pages[1].first == 1376);
  CHECK(test::same_bits(other_pages[0].second, pages[0].second));
}

TEST_CASE("a monitor that begins later looks when others do, and no bit depends on it", "[start time][after]") {
  for (const std::string name : {"verlet", "dop853"}) {
    for (const double start : {0.0, 1024.0}) {
      CAPTURE(name, start);
      Pages late, all, by_steps;
      auto run = planets_from(start, name), other = planets_from(start, name);
      run.every({.interval = 96, .after = start + 1000}, StateDiary{&late});
      run.every({.steps = 3, .after = start + 1000}, StateDiary{&by_steps});
      other.every_time(96, StateDiary{&all});
      REQUIRE(run.run_until(start + 3200).ok());
      REQUIRE(other.run_until(start + 3200).ok());
      CHECK(test::same_bits(run.particles(), other.particles()));
      REQUIRE(all.size() == 34);
      REQUIRE(late.size() == 34 - 11);  // from 1056 on
      for (std::size_t k = 0; k < late.size(); ++k) {
        CHECK(late[k].first == all[k + 11].first);
        CHECK(test::same_bits(late[k].second, all[k + 11].second));
      }
      REQUIRE(!by_steps.empty());
      CHECK(by_steps[0].first >= start + 1000);
      if (name == "verlet") CHECK(by_steps.size() == late.size());
    }
  }
  Pages at, back;
  auto run = planets_from(0, "verlet"), backward = planets_from(0, "verlet", -32);
  run.every({.steps = 10, .after = 320}, StateDiary{&at});
  backward.every({.interval = -64, .after = -100}, StateDiary{&back});
  REQUIRE(run.run_until(640).ok());
  REQUIRE(backward.run_until(-320).ok());
  REQUIRE(at.size() == 2);
  CHECK(at[0].first == 320);  // at that time itself
  REQUIRE(back.size() == 4);
  CHECK(back[0].first == -128);
}

TEST_CASE("errors of a monitor that begins later are relative to its first look", "[start time][after]") {
  auto run = planets_from(0, "verlet");
  const auto& late = run.every({.steps = 10, .after = 3000}, Energy());
  const auto& whole = run.every(10, Energy());
  REQUIRE(run.run_until(6400).ok());
  CHECK(late.report().samples == 11);
  CHECK(whole.report().samples == 21);
  CHECK(late.report().first != whole.report().first);  // the energy at its own first look
}

TEST_CASE("a run goes on before and behind the time when a monitor begins", "[start time][after][restart]") {
  for (const std::string name : {"verlet", "dop853"}) {
    for (const double cut : {352.0, 1632.0}) {
      CAPTURE(name, cut);
      Pages whole, first, second;
      const Schedule late{.interval = 160, .after = 1000};
      auto run = planets_from(0, name), begun = planets_from(0, name), other = planets_from(0, name);
      run.every(late, StateDiary{&whole});
      begun.every(late, StateDiary{&first});
      other.every(late, StateDiary{&second});
      REQUIRE(run.run_until(3200).ok());
      REQUIRE(begun.run_until(cut).ok());
      other.restore(begun.save());
      REQUIRE(other.run_until(3200).ok());
      first.insert(first.end(), second.begin(), second.end());
      REQUIRE(whole.size() == 14);
      REQUIRE(first.size() == 14);
      for (std::size_t k = 0; k < 14; ++k) {
        CHECK(first[k].first == whole[k].first);
        CHECK(test::same_bits(first[k].second, whole[k].second));
      }
    }
  }
}

TEST_CASE("only looks by steps or an interval can begin later", "[start time][after]") {
  auto run = planets_from(0, "verlet");
  Pages pages;
  CHECK_THROWS_WITH(run.every({.times = {64, 96}, .after = 70}, StateDiary{&pages}),
                    Catch::Contains("cannot begin after a time"));
  CHECK_THROWS_WITH(run.every({.wall = 1, .after = 70}, StateDiary{&pages}), Catch::Contains("wall time"));
  CHECK_THROWS_WITH(run.every({.steps = 1, .after = NAN}, StateDiary{&pages}), Catch::Contains("finite"));
  run.every({.steps = 2, .after = 70}, StateDiary{&pages});
  CHECK_THROWS_WITH(run.change_step(16), Catch::Contains("from a time on"));
}

}  // namespace noether
