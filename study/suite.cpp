#include "study/suite.hpp"

#include "engine/sums.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "monitors/monitors.hpp"
#include "numbers/error.hpp"
#include "scene/minimize.hpp"
#include "study/multistep_roots.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>
#include <utility>

namespace noether {

namespace {

/// Mean kinetic energies of the particles over the second half of a run.
class Sharing {
 public:
  void look(const ParticleSystem<double>& s) {
    if (++looks_ * 2 <= RunLength::looks) return;
    sums_.resize(static_cast<std::size_t>(s.size()), 0);
    for (Index i = 0; i < s.size(); ++i) {
      sums_[static_cast<std::size_t>(i)] += s.masses()[i] * norm2(s.velocities()[i]) / 2;
    }
  }
  /// Largest difference, over the sum of all.
  double apart_from(const Sharing& truth) const {
    const double mine = looks_ - RunLength::looks / 2.0, others = truth.looks_ - RunLength::looks / 2.0;
    const double all =
        sum_over<double>(std::ssize(truth.sums_), [&](Index i) { return truth.sums_[static_cast<std::size_t>(i)]; }) /
        others;
    double worst = 0;
    for (std::size_t i = 0; i < std::min(sums_.size(), truth.sums_.size()); ++i) {
      worst = std::max(worst, std::abs(sums_[i] / mine - truth.sums_[i] / others));
    }
    return worst / all;
  }

 private:
  int looks_ = 0;
  std::vector<double> sums_;
};

RunLength length_of(const Scene& scene, const Candidate& who) {
  const SceneIntegrator& own = scene.integrator;
  if (who.adaptive) {
    if (!own.until) throw Error("a method that chooses its steps needs until in [integrator]");
    if (*own.until < own.start) {
      throw SceneError(
          fmt::format("a verdict needs a run that goes forward in time; this one would end at {}", *own.until),
          {.file = scene.source.file, .key = "integrator.until"});
    }
    return {.steps = 0, .until = *own.until - own.start};
  }
  if (!own.steps || *own.steps < RunLength::looks) {
    throw Error(fmt::format("a verdict needs a run of {} steps or more; give until or steps in [integrator]",
                            RunLength::looks));
  }
  return {.steps = *own.steps, .until = 0};
}

double tolerance_of(const Scene& scene) {
  const auto& classical = scene.integrator.classical;
  return classical ? classical->options.rtol.value_or(classical->info->rtol) : 1e-10;
}

/// Methods of fixed steps that can serve a scene.
std::vector<Candidate> every_method(const Scene& scene) {
  std::vector<std::string_view> names;
  for (const Scheme* scheme : schemes::all()) names.push_back(scheme->name);
  for (const MethodInfo* info : scene.parts->methods()) {
    if (info->fixed) names.push_back(info->name);
  }
  std::vector<Candidate> all;
  for (const std::string_view name : names) {
    try {
      all.push_back(fixed_candidate(scene, std::string(name)));
    } catch (const Error&) {
      continue;  // it cannot serve this scene
    }
  }
  return all;
}

std::vector<Candidate> methods_of(const Scene& scene, const SceneVerdict& verdict) {
  if (verdict.every_method) return every_method(scene);
  std::vector<std::string> names = verdict.methods;
  if (names.empty()) names.push_back(scene.integrator.method);
  std::vector<Candidate> all;
  for (const std::string& name : names) {
    all.push_back(scene.integrator.adaptive() ? candidate(scene, name) : fixed_candidate(scene, name));
  }
  return all;
}

std::string expectation(const SceneVerdict& verdict, const std::string& outcome) {
  std::string text = outcome;
  const auto add = [&](const char* what, const std::optional<double>& x) {
    if (x) text += fmt::format(", {} {:g}", what, *x);
  };
  add("energy <", verdict.energy_below);
  add("energy >", verdict.energy_above);
  add("sharing <", verdict.sharing_below);
  add("sharing >", verdict.sharing_above);
  return text;
}

bool within(const std::optional<double>& error, const std::optional<double>& below,
            const std::optional<double>& above) {
  if (below && !(error && *error < *below)) return false;
  return !(above && error && *error <= *above);  // what is not a number is above
}

/// Whether an error stays within the bound that a verdict names: the upper one, or the lower one if it is alone.
bool is_accurate(const std::optional<double>& error, const std::optional<double>& below,
                 const std::optional<double>& above) {
  return below ? within(error, below, {}) : !above || within(error, above, {});
}

/// Frequencies of the start, and whether the rates of the scene are linear; nothing where forces are not finite there,
/// as where bodies touch (the run then ends by name), or where spheres rebound, which has no rates.
std::pair<Spectrum, bool> rates_of_start(const Scene& scene) {
  if (!scene.hamiltonian.constraints.empty()) return {};
  try {
    const Spectrum spectrum = spectrum_at(scene, scene.particles);
    return {spectrum, is_linear(scene)};
  } catch (const Error&) {
    return {};
  }
}

/// One verdict on one scene, method by method.
class Judge {
 public:
  Judge(const Scene& scene, const SceneVerdict& verdict, const SuiteOptions& options, Share place)
      : scene_(scene), verdict_(verdict), options_(options), place_(std::move(place)) {
    std::tie(spectrum_, bounds_.linear) = rates_of_start(scene);
    if (spectrum_.fastest > 0) bounds_.frequency = spectrum_.fastest;
  }

  void run(std::vector<SuiteRow>& rows) {
    for (const Candidate& who : methods_of(scene_, verdict_)) {
      SuiteRow row;
      row.scene = scene_.source.file;
      row.title = scene_.title;
      row.method = who.label;
      row.sets = verdict_.sets;
      row.why = verdict_.why;
      if (options_.progress)
        options_.progress({place_.row, place_.rows, place_.done,
                           fmt::format("{}, {} {}", row.title, row.method, fmt::join(row.sets, " "))});
      std::string outcome = verdict_.outcome;
      if (outcome == "theory") outcome = expected_by_theory(scene_, who, scene_.integrator.step);
      if (outcome.empty()) {
        throw SceneError(
            fmt::format("theory does not predict '{}' here; give bounded, unbounded or solver for it", row.method),
            {.file = scene_.source.file, .key = "verdict.outcome", .value = "theory"});
      }
      row.expected = expectation(verdict_, outcome);
      judge(row, who, outcome);
      rows.push_back(std::move(row));
    }
  }

 private:
  void judge(SuiteRow& row, const Candidate& who, const std::string& outcome) {
    const auto begin = std::chrono::steady_clock::now();
    Simulation<double> sim = assemble(variant(scene_, who, {scene_.integrator.step, tolerance_of(scene_)}));
    const RunLength length = length_of(scene_, who);
    const Energy* energy = nullptr;
    if (sim.claims().energy) {
      energy = who.adaptive ? &sim.every_time(length.until / RunLength::looks, Energy())
                            : &sim.every(length.between_looks(), Energy());
    }
    Sharing shared;
    const double budget = options_.row_budget * (verdict_.nightly ? 10 : 1);
    const Trial trial = follow(sim, length, Amplitude(scene_, bounds_.frequency), bounds_, budget,
                               [&](Simulation<double>& now) { shared.look(now.particles()); });
    row.found = name(trial.verdict);
    row.steps = trial.steps;
    row.message = trial.message;
    if (!who.adaptive && spectrum_.fastest > 0) row.h_omega = scene_.integrator.step * spectrum_.fastest;
    if (energy != nullptr) row.energy_error = energy->report().worst;
    if (verdict_.sharing_below || verdict_.sharing_above) row.sharing_error = shared.apart_from(reference());
    row.agrees = row.found == outcome && within(row.energy_error, verdict_.energy_below, verdict_.energy_above) &&
                 within(row.sharing_error, verdict_.sharing_below, verdict_.sharing_above);
    row.accurate = is_accurate(row.energy_error, verdict_.energy_below, verdict_.energy_above) &&
                   is_accurate(row.sharing_error, verdict_.sharing_below, verdict_.sharing_above);
    row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

  const Sharing& reference() {
    if (reference_) return *reference_;
    reference_.emplace();
    const double end = scene_.integrator.length().value_or(0);
    Simulation<double> sim = assemble(variant(scene_, candidate(scene_, "dop853"), {.step = 0, .tolerance = 1e-10}));
    static_cast<void>(follow(sim, {.steps = 0, .until = end}, Amplitude(scene_, bounds_.frequency), bounds_,
                             options_.row_budget, [&](Simulation<double>& now) { reference_->look(now.particles()); }));
    return *reference_;
  }

  const Scene& scene_;
  const SceneVerdict& verdict_;
  const SuiteOptions& options_;
  Share place_;  ///< which scene of how many
  Spectrum spectrum_;
  Bounds bounds_;
  std::optional<Sharing> reference_;
};

}  // namespace

std::size_t Suite::agreeing() const {
  return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [](const SuiteRow& r) { return r.agrees; }));
}

std::string expected_by_theory(const Scene& scene, const Candidate& who, double step) {
  const Mode mode = mode_of(scene, spectrum_at(scene, scene.particles));
  const double z = step * mode.scale();
  const auto matrix = step_matrix(scene, who, mode);
  if (!matrix) {
    const auto roots = multistep_roots(scene, who, mode);
    if (!roots) return first_step_fails(scene, who, mode, z) ? "solver" : "";
    if (roots->solver && z >= *roots->solver) return "solver";
    return roots->growth(z) > growth_threshold ? "unbounded" : "bounded";
  }
  const Eigen::Matrix2d M = (*matrix)(z);
  if (!M.allFinite()) return "solver";
  if (growth_of(M) > growth_threshold) return "unbounded";
  // A double eigenvalue on the unit circle: unless the step is 1 or -1 itself, amplitudes grow as the number of steps.
  const double half = M.trace() / 2, sign = half > 0 ? 1 : -1;
  const bool edge = std::abs(std::abs(half) - 1) < 1e-12 && std::abs(M.determinant() - 1) < 1e-12;
  return edge && (M - sign * Eigen::Matrix2d::Identity()).norm() > 1e-6 ? "unbounded" : "bounded";
}

std::filesystem::path suite_folder() {
  std::error_code ignored;
  // First the file that this function stands in: in Python that is the module. Of a program it may lack the folder.
  Dl_info here{};
  const bool known = dladdr(reinterpret_cast<const void*>(&suite_folder), &here) != 0 && here.dli_fname != nullptr;
  for (const std::filesystem::path& file :
       {std::filesystem::path(known ? here.dli_fname : ""), std::filesystem::read_symlink("/proc/self/exe", ignored)}) {
    if (!file.is_absolute()) continue;
    const std::filesystem::path whole = std::filesystem::weakly_canonical(file, ignored);
    for (std::filesystem::path at = whole.parent_path(); !at.empty(); at = at.parent_path()) {
      for (const char* below : {"study/suite", "share/noether/suite"}) {
        if (std::filesystem::is_directory(at / below, ignored)) return at / below;
      }
      if (at == at.root_path()) break;
    }
  }
  throw Error("the scenes of the suite are missing; they are in study/suite, or in share/noether/suite once installed");
}

std::vector<std::filesystem::path> suite_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) throw FileError("no scene is in this folder", {.file = folder.string()});
  return files;
}

Suite run_suite(const std::vector<std::filesystem::path>& scenes, const SuiteOptions& options, const Parts& parts) {
  Suite suite;
  Share place{.rows = static_cast<int>(scenes.size())};
  for (const std::filesystem::path& file : scenes) {
    place.done = place.row++ / static_cast<double>(scenes.size());
    const Scene scene = load_scene(file, parts);
    if (!scene.wrong_verdicts.empty()) throw scene.wrong_verdicts.front();
    if (scene.verdicts.empty()) {
      throw SceneError("the scene has no verdict; give [[verdict]] tables", {.file = file.string(), .key = "verdict"});
    }
    for (const SceneVerdict& verdict : scene.verdicts) {
      if (verdict.nightly && !options.nightly) continue;
      Scene changed = verdict.sets.empty() ? scene : load_scene(file, *scene.parts, verdict.sets);
      begin_at_minimum(changed);
      Judge(changed, verdict, options, place).run(suite.rows);
    }
  }
  return suite;
}

}  // namespace noether
