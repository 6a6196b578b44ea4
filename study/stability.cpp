#include "study/stability.hpp"

#include "engine/sums.hpp"
#include "integrators/all_methods.hpp"
#include "study/solution_growth.hpp"
#include "study/wide_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

namespace noether {

namespace {

/// What h is multiplied by in the search [1/time]: the scale of the mode; where nothing oscillates, a hundredth of the
/// scene's own step stands for one of the search.
double scale_of(const Scene& scene, const Mode& mode) {
  if (mode.scale() > 0) return mode.scale();
  return 0.2 / std::abs(scene.integrator.step > 0 ? scene.integrator.step : 1);
}

/// One row on its way.
class Search {
 public:
  Search(const Scene& scene, const Stability& all, const StabilityOptions& options, SolutionGrowth& growth,
         StabilityRow& row, Share place)
      : scene_(scene),
        options_(options),
        growth_(growth),
        row_(row),
        place_(std::move(place)),
        begin_(std::chrono::steady_clock::now()) {
    scale_ = scale_of(scene, all.mode);
    oscillates_ = all.mode.scale() > 0;
    bounds_ = {.frequency = scale_, .linear = all.linear};
  }

  void run() {
    choose_scan_steps();
    const auto found = scan();
    if (row_.settled) {
      const auto missed = scan_long(found ? found->first : end_of_scan(), !found);
      if (missed) {
        settle(missed->first, missed->second, true);
      } else if (found) {
        settle(found->first, found->second, false);
      }
    }
    row_.seconds = spent();
  }

 private:
  double spent() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }
  double left() const { return options_.row_budget - spent(); }

  void tell(double z) const {
    if (!options_.progress) return;
    // A row that goes through its whole budget is over; one that has scanned all of h omega is half over.
    const double of_row = std::clamp(std::max(spent() / options_.row_budget, 0.5 * z / end_of_scan()), 0.0, 1.0);
    const double done = (static_cast<double>(place_.row - 1) + of_row) / static_cast<double>(place_.rows);
    options_.progress({place_.row, place_.rows, done, fmt::format("{}, h omega = {:.3f}", row_.who.label, z)});
  }

  Trial attempt(double z, std::int64_t steps) {
    tell(z);
    const double step = z / scale_;
    Trial trial = try_step(scene_, row_.who, step, steps, bounds_, std::max(left(), 0.01));
    row_.steps += trial.steps;
    if (!growth_.explains(trial, step * static_cast<double>(trial.steps), left() / 4, bounds_)) return trial;
    trial = try_step(scene_, row_.who, step, steps, bounds_, std::max(left(), 0.01));
    row_.steps += trial.steps;
    return trial;
  }
  /// Tries a point over many steps: bounded there, it becomes `stable`, else `unstable`.
  /// @return false where the budget was over before anything was settled
  bool narrow(double z, double& stable, double& unstable) {
    const Trial trial = attempt(z, options_.confirm_steps);
    if (trial.verdict == Bounded::unsettled) return false;
    (trial.stable() ? stable : unstable) = z;
    if (!trial.stable()) failed_ = trial;
    return true;
  }

  /// A point of the search, as rows tell it.
  std::string told(double z) const {
    return oscillates_ ? fmt::format("h omega = {:.6g}", z) : fmt::format("a step of {:.6g}", z / scale_);
  }

  /// The budget is over before a limit is found.
  void stop_at(double bounded_until) {
    row_.settled = false;
    row_.reason = "not_settled";
    row_.bounded_until = bounded_until;
    row_.bounded_step = bounded_until / scale_;
    row_.message = fmt::format("the budget ran out at {}, bounded until there", told(bounded_until));
  }

  /// Where the search ends without having found anything.
  double end_of_scan() const {
    if (row_.theory.limit) return std::min(1.2 * *row_.theory.limit + 0.5, largest_z);
    return largest_z;
  }

  struct Point {
    double z;
    bool suspect;  ///< theory sees trouble here: many steps
    bool operator<(const Point& other) const { return z < other.z; }
  };

  /// Points of the search up to `end`, those among them that theory asks for.
  std::vector<Point> points(double begin, double end) const {
    std::vector<Point> all;
    for (double z = next_z(begin); z <= end; z = next_z(z)) all.push_back({z, false});
    const LinearTheory& theory = row_.theory;
    if (theory.limit && theory.gap_end) all.push_back({(*theory.limit + *theory.gap_end) / 2, true});
    for (const auto& [n, z] : theory.resonances) all.push_back({z, true});
    std::sort(all.begin(), all.end());
    all.erase(all.begin(), std::upper_bound(all.begin(), all.end(), Point{begin, false}));
    return all;
  }

  /// As many steps for each point as half the budget allows.
  void choose_scan_steps() {
    constexpr std::int64_t least = 300, most = 1000;
    const auto before = std::chrono::steady_clock::now();
    const Trial trial = attempt(next_z(0), 2000);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
    const double a_step = seconds / static_cast<double>(std::max<std::int64_t>(trial.steps, 1));
    const double count = static_cast<double>(points(0, end_of_scan()).size());
    row_.scan_steps = std::clamp(static_cast<std::int64_t>(options_.row_budget / 2 / count / a_step), least, most);
  }

  /// Goes upward. @return the last stable point and the first unstable one
  std::optional<std::pair<double, double>> scan() {
    double stable = 0;
    for (const auto& [z, suspect] : points(0, end_of_scan())) {
      const Trial trial = attempt(z, suspect ? options_.confirm_steps : row_.scan_steps);
      if (trial.verdict == Bounded::unsettled || left() <= 0) {
        stop_at(stable);
        return {};
      }
      failed_ = trial;
      if (!trial.stable()) return std::pair(stable, z);
      stable = z;
    }
    return {};
  }

  /// Points for many steps below `end`: every 0.05, from 10 on every 10 %.
  static std::vector<double> long_points(double end) {
    std::vector<double> all;
    for (int k = 1; k <= 200 && 0.05 * k < end; ++k) all.push_back(0.05 * k);
    for (double z = 11; z < end; z *= 1.1) all.push_back(z);
    return all;
  }

  /// Goes upward below `end` with larger gaps and many steps, for what is too weak for the short runs of `scan`.
  /// @param all  whether a budget that ends here leaves the row unsettled; else half of what is left is enough
  /// @return as `scan`
  std::optional<std::pair<double, double>> scan_long(double end, bool all) {
    const double reserve = all ? 0 : left() / 2;
    double stable = 0;
    for (const double z : long_points(end)) {
      const Trial trial = attempt(z, options_.confirm_steps);
      if (trial.verdict == Bounded::unsettled || left() <= reserve) {
        if (all) stop_at(stable);
        return {};
      }
      if (!trial.stable()) {
        failed_ = trial;
        return std::pair(stable, z);
      }
      stable = z;
    }
    return {};
  }

  /// From a bounded point down to one that is bounded over the long run too, then up again.
  /// @param wide  whether other points of the search lie between the two
  void settle(double stable, double unstable, bool wide) {
    row_.settled = close_in(stable, unstable, wide);
    row_.limit_step = unstable / scale_;
    row_.limit_h_omega = unstable;
    row_.message = failed_.message;
    if (!row_.settled) {
      row_.message = fmt::format("the budget ran out between {} and {}", told(stable), told(unstable));
    }
    explain(failed_, unstable);
    if (row_.settled && failed_.verdict == Bounded::unbounded) find_gap_end(unstable);
  }

  /// @return whether the budget sufficed
  bool close_in(double& stable, double& unstable, bool wide) {
    const double met = unstable;
    for (double down = 0.002; stable > 0; down *= 2) {
      double low = 0, high = 0;
      if (!narrow(stable, low, high)) return false;
      if (low > 0) break;
      unstable = high;
      stable = std::max(stable - down, 0.0);
    }
    if (wide || unstable < met) {  // the first of what lies between
      for (const auto& [z, suspect] : points(stable, unstable)) {
        double high = 0;
        if (z >= unstable) break;
        if (!narrow(z, stable, high)) return false;
        if (high > 0) unstable = high;
      }
    }
    while (unstable - stable > 1e-5 * std::min(1.0, unstable)) {
      if (!narrow((stable + unstable) / 2, stable, unstable)) return false;
    }
    return true;
  }

  void explain(const Trial& failed, double limit) {
    const LinearTheory& theory = row_.theory;
    row_.resonance = theory.resonance_at(limit);
    const bool near = theory.limit && limit > *theory.limit - 0.01;
    if (failed.verdict == Bounded::solver) {
      row_.reason = "solver";
    } else {
      row_.reason = near || bounds_.linear ? "linear" : "resonance";
    }
    if (row_.reason != "resonance") row_.resonance = 0;
  }

  /// Upward from an unstable point to the next that is bounded, if one is near.
  void find_gap_end(double limit) {
    double unstable = limit, stable = 0;
    double by = 2e-4;  // a gap may be much narrower than the steps of the search
    for (double z = limit + by; z < limit + 1 && stable == 0; z += by) {
      double low = 0;
      if (attempt(z, row_.scan_steps).stable() && !narrow(z, low, unstable)) return;
      if (left() <= 0) return;
      stable = low;
      if (low == 0) unstable = z;
      by = std::min(2 * by, 2e-3);
    }
    if (stable == 0) return;
    while (stable - unstable > 1e-5) {
      if (!narrow((stable + unstable) / 2, stable, unstable)) return;
    }
    row_.gap_end = stable;
  }

  const Scene& scene_;
  const StabilityOptions& options_;
  SolutionGrowth& growth_;
  StabilityRow& row_;
  Share place_;  ///< which row of how many
  std::chrono::steady_clock::time_point begin_;
  Trial failed_;  ///< the last run that was not bounded
  double scale_ = 1;
  bool oscillates_ = true;
  Bounds bounds_;
};

/// By n, the h omega at which steps along Kepler arcs go n times into the shortest period.
std::map<int, double> resonances_of(const KeplerSteps& kepler, double scale) {
  std::map<int, double> found;
  for (int n = 1; kepler.period > 0 && n <= KeplerSteps::resonances; ++n) found[n] = kepler.resonance(n) * scale;
  return found;
}

/// A step that is accurate, and far from where the method fails.
/// @param kepler  of a method along Kepler arcs
std::optional<double> recommended(const StabilityRow& row, double scale, const std::optional<KeplerSteps>& kepler,
                                  const std::optional<TurningSteps>& turning) {
  const LinearTheory& theory = row.theory;
  double z = theory.accurate > 0 ? theory.accurate : M_PI / 10;
  if (kepler) z = kepler->recommended() * scale;
  if (turning && turning->recommended()) z = std::min(z, *turning->recommended() * scale);
  for (const auto& limit : {row.limit_h_omega, theory.limit}) {
    if (limit) z = std::min(z, *limit / 2);
  }
  if (!(z > 0)) return {};
  return z / scale;
}

void check(const StabilityOptions& options) {
  if (!(options.row_budget > 0))
    throw Error(fmt::format("a budget of {} s is not valid; a number above 0 is expected", options.row_budget));
  if (options.confirm_steps < 1000)
    throw Error(fmt::format("{} steps are too few; 1000 or more are expected", options.confirm_steps));
}

/// @throws Error  for a scene in which nothing could grow
void check_motion(const Scene& scene, double frequency) {
  const ParticleSystem<double>& s = scene.particles;
  double size = sum_over<double>(
      s.size(), [&](Index i) { return norm2(s.velocities()[i]) + frequency * frequency * norm2(s.positions()[i]); });
  for (const double y : s.variables()) size += y * y;
  bool all_held = has_bodies(s);
  for (Index i = 0; i < s.size() && all_held; ++i) all_held = s.bodies()->is_held(i);
  if (all_held || (!(size > 0) && has_bodies(s))) {
    throw Error(
        "the bodies turn, but nothing else moves, and stability looks at positions and velocities; use compare "
        "for turns");
  }
  if (!(size > 0)) throw Error("everything rests at the origin, where no step is too long; start the scene elsewhere");
}

}  // namespace

Candidate fixed_candidate(const Scene& scene, const std::string& name) {
  Candidate who = candidate(scene, name);
  const MethodInfo* info = scene.parts->find_method(who.method);
  if (info != nullptr && !info->fixed) {
    throw Error(
        fmt::format("method '{}' chooses its steps by a tolerance, so it has no largest step; give one of fixed steps, "
                    "such as 'rk4'",
                    who.method));
  }
  who.adaptive = false;
  static_cast<void>(assemble(variant(scene, who, {.step = 1, .tolerance = 0})));
  return who;
}

std::vector<std::string> default_stability_methods(const Scene& scene) {
  std::vector<std::string> names = {scene.integrator.method};
  if (scene.particles.size() == 0) {
    names.insert(names.end(), {"euler", "rk4", "dormand_prince_5", "dop853", "adams_bashforth_3", "backward_euler",
                               "trapezoidal", "sdirk_4", "rodas_4", "gauss_2"});
  } else {
    names.insert(names.end(), {"verlet", "yoshida_4", "blanes_moan_s6", "srkn11b", "kahan_li_8_s17", "rk4",
                               "dormand_prince_5", "dop853", "adams_bashforth_3", "implicit_midpoint", "gauss_2"});
  }
  std::vector<Candidate> all;
  std::vector<std::string> kept;
  for (const std::string& one : names) {
    try {
      Candidate who = fixed_candidate(scene, one);
      if (std::find(all.begin(), all.end(), who) != all.end()) continue;
      all.push_back(std::move(who));
      kept.push_back(one);
    } catch (const Error&) {
      continue;  // it cannot serve this scene
    }
  }
  return kept;
}

Stability find_stability(const Scene& scene, const StabilityOptions& options) {
  refuse_noise(scene);
  check(options);
  Stability found;
  found.scene = scene.source.file;
  found.title = scene.title;
  found.time_unit = scene.units->time;
  for (const SceneDecorator& one : scene.integrator.decorators) found.decorators.push_back(one.name);
  std::vector<Candidate> methods;
  for (const std::string& name : options.methods.empty() ? default_stability_methods(scene) : options.methods) {
    Candidate who = fixed_candidate(scene, name);
    if (std::find(methods.begin(), methods.end(), who) == methods.end()) methods.push_back(std::move(who));
  }
  found.turning = turning_steps(scene);
  found.spectrum = spectrum_along(scene);
  const bool oscillates = scene.hamiltonian.constraints.empty();  // else forces alone tell no frequencies
  if (!oscillates) found.spectrum = {};
  found.linear = oscillates && is_linear(scene);
  found.growth_told = told_growth(options.confirm_steps);
  found.mode = mode_of(scene, found.spectrum);
  check_motion(scene, found.spectrum.fastest > 0 ? found.spectrum.fastest : 1);
  SolutionGrowth growth(scene, scale_of(scene, found.mode));
  for (const Candidate& who : methods) {
    StabilityRow row;
    row.who = who;
    row.theory = linear_theory(scene, who, found.mode);
    const bool along_arcs = !who.joined && !scene.system && scene.hamiltonian.splitting.claims().kepler;
    if (along_arcs && !found.kepler) found.kepler = kepler_steps(scene);
    const std::optional<KeplerSteps> kepler = along_arcs ? found.kepler : std::nullopt;
    if (kepler) row.theory.resonances = resonances_of(*kepler, found.mode.scale());
    const auto turning = turning_steps(variant(scene, who, {.step = 1, .tolerance = 0}));
    const Share place{static_cast<int>(found.rows.size()) + 1, static_cast<int>(methods.size())};
    Search(scene, found, options, growth, row, place).run();
    found.solution_leaves = growth.leaves();
    const double scale = found.mode.scale();
    if (scale > 0) {
      row.recommended_step = recommended(row, scale, kepler, turning);
    } else {
      if (row.limit_step) row.recommended_step = *row.limit_step / 2;
      if (const auto rule = turning ? turning->recommended() : std::nullopt)
        row.recommended_step = std::min(row.recommended_step.value_or(*rule), *rule);
      row.limit_h_omega.reset();
      row.gap_end.reset();
      row.bounded_until.reset();
    }
    found.rows.push_back(std::move(row));
  }
  return found;
}

}  // namespace noether
