#include "study/solution.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/damped.hpp"
#include "numbers/quantity.hpp"
#include "study/find_truth.hpp"
#include "study/spectrum.hpp"

#include <fmt/format.h>

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

/// @param axes  how many coordinates stand before the velocities
std::optional<Shape> shape_of(const Truth& truth, std::size_t axes) {
  std::array<double, 3> mean{}, spread{}, force_mean{}, force{};
  const auto n = static_cast<double>(truth.y.size());
  for (std::size_t j = 0; j < truth.y.size(); ++j) {
    for (std::size_t k = 0; k < axes; ++k) {
      mean[k] += static_cast<double>(truth.y[j][static_cast<Index>(k)]) / n;
      force_mean[k] += static_cast<double>(truth.rate[j][static_cast<Index>(k + axes)]) / n;
    }
  }
  for (std::size_t j = 0; j < truth.y.size(); ++j) {
    for (std::size_t k = 0; k < axes; ++k) {
      spread[k] += std::pow(static_cast<double>(truth.y[j][static_cast<Index>(k)]) - mean[k], 2);
      force[k] += std::pow(static_cast<double>(truth.rate[j][static_cast<Index>(k + axes)]) - force_mean[k], 2);
    }
  }
  const auto most = static_cast<std::size_t>(std::max_element(spread.begin(), spread.end()) - spread.begin());
  if (!(spread[most] > 0) || !(force[most] > 0)) return {};
  return Shape{static_cast<Index>(most), std::pow(force[most] / spread[most], 0.25)};
}

/// Methods worth looking at here: those compared, then some that are known for their faults.
std::vector<Candidate> displayed(const Scene& scene, const Comparison& c) {
  std::vector<Candidate> all;
  const auto add = [&](const Candidate& who) {
    const bool known = std::find(all.begin(), all.end(), who) != all.end();
    if (!who.adaptive && !known && all.size() < 8) all.push_back(who);
  };
  if (!c.methods.empty()) add(c.methods.front());
  for (const char* name : {"verlet", "euler", "symplectic_euler_a", "rk4", "implicit_midpoint", "backward_euler"}) {
    try {
      add(candidate(scene, name));
    } catch (const Error&) {
      continue;  // it cannot serve this scene
    }
  }
  for (const Candidate& who : c.methods) add(who);
  return all;
}

/// Whether a system is one coordinate and its velocity, x' = v.
bool is_oscillator(const Scene& scene, const Truth& truth) {
  if (!scene.system || truth.y.empty() || truth.y[0].size() != 2) return false;
  double size = 0;
  for (const Vector<Quad>& y : truth.y) size = std::max(size, std::abs(static_cast<double>(y[1])));
  for (std::size_t j = 0; j < truth.y.size(); ++j) {
    // The state of a moment is led there along its rate, by a rounding error of time.
    if (std::abs(static_cast<double>(truth.rate[j][0] - truth.y[j][1])) > 1e-9 * size) return false;
  }
  return true;
}

/// The rate of the drag a = -rate v, that of a system from its own rates [1/time]; 0 where there is none.
double damping_of(const Scene& scene) {
  if (!scene.system) return drag_of(scene);
  const auto field = scene.system->field();
  Vector<double> y = Vector<double>::Zero(2), still(2), moving(2);
  field->rate(scene.integrator.start, y, still);
  y[1] = 1;
  field->rate(scene.integrator.start, y, moving);
  return still[1] - moving[1];
}

Scene damped(const Scene& scene, double rate) {
  if (scene.system) {
    if (scene.system->effective.find("gamma") == nullptr) return scene;
    const std::string unit = scene.units->is_reduced() ? "" : fmt::format(" 1/{}", scene.units->time);
    const std::string gamma = unit.empty() ? format_number(rate / 2) : fmt::format("\"{}{}\"", rate / 2, unit);
    return read_scene(scene.effective_toml, scene.file, *scene.parts, {"system.gamma=" + gamma});
  }
  Scene made = scene;
  std::vector<SceneForce>& forces = made.hamiltonian.forces;
  const bool had = std::erase_if(forces, [](const SceneForce& force) { return force.force.claims().drag > 0; }) > 0;
  if (rate > 0 || had) forces.push_back(scene_force(LinearDrag{rate}));
  return made;
}

/// From no damping to far beyond the critical one, that of the scene among them.
void choose_dampings(Solution& s, const Scene& scene) {
  const double rate = damping_of(scene);
  if (scene.system && scene.system->effective.find("gamma") == nullptr) {
    s.dampings = {rate};
  } else if (rate > 0) {
    s.dampings = {0, rate / 4, rate, 4 * rate, 16 * rate};
    s.own_damping = 2;
  } else if (scene.system || is_linear(scene)) {
    s.dampings = {0, s.omega / 20, s.omega / 4, 2 * s.omega, 8 * s.omega};  // the fourth is critical
  } else {
    s.dampings = {0};
  }
}

DisplayedRun display(const Scene& scene, const Candidate& who, double step, double end, const Shape& shape,
                     const Truth& truth) {
  // The moments of this run are every so many steps, or every so many moments of the truth.
  const double spacing = end / moments;
  const auto every = std::max<std::int64_t>(1, std::llround(step / spacing));
  const Sampling own{spacing * static_cast<double>(every), static_cast<int>(moments / every), scene.integrator.start};
  Row row;
  try {
    row = measure(scene, who, {.step = step, .tolerance = 0}, own, {.repeats = 1, .budget = 1});
  } catch (const Error& error) {
    return {.outcome = error.message(), .refused = true};  // it serves the scene, but not with this damping
  }
  DisplayedRun run{.outcome = row.outcome};
  const Track& track = row.track;
  const bool kept = track.energy_report.reason.empty();
  double largest = 0;
  for (const Vector<Quad>& y : truth.y) largest = std::max(largest, std::abs(static_cast<double>(y[shape.axis])));
  for (std::size_t j = 0; j < track.y.size(); ++j) {
    const double q = track.y[j][shape.axis];
    if (!(std::abs(q) < 1e6 * largest)) break;
    run.t.push_back(static_cast<double>(track.times[j]));
    run.q.push_back(q);
    const std::size_t at = j * static_cast<std::size_t>(every);
    if (track.energy.empty() || track.energy_scale == 0 || (!kept && at >= truth.energy.size())) continue;
    const Quad right = kept ? track.energy[0] : truth.energy[at];
    run.energy_error.push_back(static_cast<double>(track.energy[j] - right) / track.energy_scale);
  }
  return run;
}

}  // namespace

std::optional<Solution> solution_of(const Scene& scene, const Comparison& c) {
  if (c.truth.kind != TruthKind::quad) return {};
  const bool system = is_oscillator(scene, c.truth);
  if (scene.particles.size() != 1 && !system) return {};
  const auto shape = shape_of(c.truth, system ? 1 : 3);
  if (!shape) return {};
  Solution s;
  s.omega = shape->omega;
  s.coordinate = "xyz"[shape->axis];
  const double end = std::min(c.end, periods * 2 * M_PI / s.omega), spacing = end / moments;
  for (const int m : {1, 2, 4, 8, 12, 13, 16}) s.steps.push_back(spacing * m);
  choose_dampings(s, scene);
  const std::vector<Candidate> methods = displayed(scene, c);
  for (const Candidate& who : methods) s.methods.push_back(who.label);
  for (std::size_t d = 0; d < s.dampings.size(); ++d) {
    const Scene one = damped(scene, s.dampings[d]);
    const Truth truth = find_truth(one, {spacing, moments, one.integrator.start}, {.budget = 20, .rtol = 1e-18});
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
