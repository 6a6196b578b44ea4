/// Looks at times of their own at runs whose method chooses its steps: rounding of times must not end the run.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "integrators/classical.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace noether;

namespace {

/// Where a body on a spring has been seen.
struct Seen {
  double time, x;
};
struct SpringDiary {
  std::vector<Seen>* seen;
  void observe(const Snapshot<double>& now) const { seen->push_back({now.time(), now.state().positions()[0][0]}); }
};

Simulation<double> spring_run(const MethodInfo& info, double start) {
  ParticleSystem<double> s;
  s.add("bob", 1, {1, 0, 0}, {0, 0, 0});
  MethodOptions options;
  options.rtol = std::max(info.rtol, 1e-12);
  if (info.fixed) options.adaptive = true;
  AnyIntegrator<double> integrator(classical(HarmonicField{.k = 1}, MethodChoice{&info, options}));
  return {std::move(s), std::move(integrator), Clock<double>::free(start)};
}

std::vector<const MethodInfo*> adaptive_methods() {
  std::vector<const MethodInfo*> found;
  for (const MethodInfo* info : methods::all()) {
    if (info->adaptive) found.push_back(info);
  }
  return found;
}

}  // namespace

TEST_CASE("a look a rounding error behind a whole step shows the state there, by every adaptive method",
          "[methods][free clock]") {
  for (const MethodInfo* info : adaptive_methods()) {
    for (const double start : {0.0, 1000.0 / 3}) {
      CAPTURE(info->name, start);
      std::vector<Seen> steps, looks;
      auto bare = spring_run(*info, start);
      bare.every(1, SpringDiary{&steps});
      REQUIRE(bare.run(12).ok());
      std::vector<double> times;
      for (const Seen& one : steps) times.push_back(std::nextafter(one.time, 1e300));
      times.erase(times.begin());
      auto run = spring_run(*info, start);
      run.at_times(times, SpringDiary{&looks});
      const Outcome outcome = run.run_until(steps.back().time + 1e-3);
      CAPTURE(outcome.message);
      REQUIRE(outcome.ok());
      REQUIRE(looks.size() + 1 == steps.size());
      for (std::size_t k = 0; k < looks.size(); ++k) CHECK(std::abs(looks[k].x - steps[k + 1].x) < 1e-12);
    }
  }
}

TEST_CASE("two hundred looks at a short run succeed and are right, by every adaptive method", "[methods][free clock]") {
  for (const MethodInfo* info : adaptive_methods()) {
    for (const double interval : {0.00175, 0.0035}) {
      CAPTURE(info->name, interval);
      std::vector<Seen> looks;
      auto run = spring_run(*info, 0);
      run.every_time(interval, SpringDiary{&looks});
      const Outcome outcome = run.run_until(200 * interval);
      CAPTURE(outcome.message);
      REQUIRE(outcome.ok());
      REQUIRE(looks.size() == 201);
      double worst = 0;
      for (const Seen& one : looks) worst = std::max(worst, std::abs(one.x - std::cos(one.time)));
      CHECK(worst < 1e-5);
    }
  }
}
