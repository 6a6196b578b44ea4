#include "study/solution.hpp"

#include "integrators/methods.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace noether {

namespace {

constexpr int moments = 320, periods = 8;

/// Which coordinate moves most, and how fast the motion turns.
struct Shape {
  Index axis = 0;
  double omega = 0;
};

std::optional<Shape> shape_of(const Truth& truth) {
  std::array<double, 3> mean{}, spread{}, force_mean{}, force{};
  const auto n = static_cast<double>(truth.y.size());
  for (std::size_t j = 0; j < truth.y.size(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      mean[k] += static_cast<double>(truth.y[j][static_cast<Index>(k)]) / n;
      force_mean[k] += static_cast<double>(truth.rate[j][static_cast<Index>(k) + 3]) / n;
    }
  }
  for (std::size_t j = 0; j < truth.y.size(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      spread[k] += std::pow(static_cast<double>(truth.y[j][static_cast<Index>(k)]) - mean[k], 2);
      force[k] += std::pow(static_cast<double>(truth.rate[j][static_cast<Index>(k) + 3]) - force_mean[k], 2);
    }
  }
  const auto most = static_cast<std::size_t>(std::max_element(spread.begin(), spread.end()) - spread.begin());
  if (!(spread[most] > 0) || !(force[most] > 0)) return {};
  return Shape{static_cast<Index>(most), std::pow(force[most] / spread[most], 0.25)};
}

/// Methods worth looking at here: those compared, then some that are known for their faults.
std::vector<Opponent> displayed(const Scene& scene, const Comparison& c) {
  std::vector<Opponent> all;
  const auto add = [&](const Opponent& who) {
    const bool known = std::find(all.begin(), all.end(), who) != all.end();
    if (!who.adaptive && !known && all.size() < 8) all.push_back(who);
  };
  if (!c.methods.empty()) add(c.methods.front());
  for (const char* name : {"verlet", "euler", "symplectic_euler_a", "rk4", "implicit_midpoint", "backward_euler"}) {
    try {
      add(opponent(scene, name));
    } catch (const Error&) {
      continue;  // it cannot serve this scene
    }
  }
  for (const Opponent& who : c.methods) add(who);
  return all;
}

Scene damped(const Scene& scene, double rate) {
  Scene made = scene;
  for (SceneForce& force : made.hamiltonian.forces) {
    if (force.drag) force.drag->rate = rate;
  }
  return made;
}

DisplayedRun display(const Scene& scene, const Opponent& who, double step, double end, const Shape& shape,
                     const Truth& truth) {
  // The moments of this run are every so many steps, or every so many moments of the truth.
  const double spacing = end / moments;
  const auto every = std::max<std::int64_t>(1, std::llround(step / spacing));
  const Sampling own{spacing * static_cast<double>(every), static_cast<int>(moments / every)};
  const Row row = measure(scene, who, {.step = step, .tolerance = 0}, own, {.repeats = 1, .budget = 1});
  DisplayedRun run{.outcome = row.outcome};
  const Track& track = row.track;
  const bool kept = track.energy_report.reason.empty();
  for (std::size_t j = 0; j < track.y.size(); ++j) {
    const double q = track.y[j][shape.axis];
    if (!(std::abs(q) < 1e6)) break;
    run.t.push_back(static_cast<double>(track.times[j]));
    run.q.push_back(q);
    const std::size_t at = j * static_cast<std::size_t>(every);
    if (track.energy.empty() || track.energy_scale == 0 || (!kept && at >= truth.energy.size())) continue;
    run.energy_error.push_back((track.energy[j] - (kept ? track.energy[0] : truth.energy[at])) / track.energy_scale);
  }
  return run;
}

}  // namespace

std::optional<Solution> solution_of(const Scene& scene, const Comparison& c) {
  if (scene.particles.size() != 1 || c.truth.kind != TruthKind::quad) return {};
  const auto shape = shape_of(c.truth);
  if (!shape) return {};
  Solution s;
  s.omega = shape->omega;
  s.coordinate = "xyz"[shape->axis];
  const double end = std::min(c.end, periods * 2 * M_PI / s.omega), spacing = end / moments;
  for (const int m : {1, 2, 4, 8, 12, 13, 16}) s.steps.push_back(spacing * m);
  double rate = 0;
  for (const SceneForce& force : scene.hamiltonian.forces) rate = force.drag ? force.drag->rate : rate;
  s.dampings = {0};
  if (rate > 0) s.dampings = {0, rate / 4, rate, 4 * rate, 16 * rate};
  const std::vector<Opponent> methods = displayed(scene, c);
  for (const Opponent& who : methods) s.methods.push_back(who.label);
  for (std::size_t d = 0; d < s.dampings.size(); ++d) {
    const Scene one = damped(scene, s.dampings[d]);
    const Truth truth = find_truth(one, {spacing, moments}, {.budget = 20, .rtol = 1e-18});
    ExactMotion exact;
    for (std::size_t j = 0; j < truth.y.size(); ++j) {
      exact.t.push_back(spacing * static_cast<double>(j));
      exact.q.push_back(static_cast<double>(truth.y[j][shape->axis]));
    }
    s.exact.push_back(std::move(exact));
    for (std::size_t m = 0; m < methods.size(); ++m) {
      for (std::size_t h = 0; h < s.steps.size(); ++h) {
        DisplayedRun run = display(one, methods[m], s.steps[h], end, *shape, truth);
        run.method = m;
        run.step = h;
        run.damping = d;
        s.runs.push_back(std::move(run));
      }
    }
  }
  return s;
}

}  // namespace noether
