#include "scene/run.hpp"

#include "io/digest.hpp"
#include "io/files.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "numbers/parallel.hpp"
#include "numbers/quantity.hpp"
#include "scene/default_watches.hpp"
#include "scene/minimize.hpp"
#include "scene/progress_line.hpp"
#include "scene/read_particles.hpp"
#include "scene/resume.hpp"
#include "scene/signals.hpp"
#include "scene/toml.hpp"
#include "scene/warnings.hpp"

#include <fmt/format.h>

#include <cmath>

namespace noether {

namespace {

/// Whether this build can write HDF5 files.
constexpr bool has_files = NOETHER_HDF5 != 0;

SceneFiles files_of(const Scene& scene, const OutputFolder& folder, const RunOptions& options) {
  SceneFiles files;
  files.by_default = true;
  bool asks = false;
  for (const SceneWatch& watch : scene.watches) asks = asks || watch.kind != SceneWatch::Kind::monitor;
  // Without HDF5 a run can still be watched; a scene that asks for files is told that there are none.
  if (!has_files && !asks) return files;
  if (has_files ? !scene.watches.empty() : asks) files.trajectory = folder.trajectory();
  files.checkpoint = folder.checkpoint();
  if (has_files) files.checkpoint_wall = options.checkpoint_wall;
  return files;
}

bool writes_trajectory(const Scene& scene) {
  for (const SceneWatch& watch : scene.watches) {
    if (watch.kind != SceneWatch::Kind::checkpoint) return true;
  }
  return false;
}

/// One run of one scene.
class Runner {
 public:
  /// @param start  of the scene, the run that was put together to check it; null: it is put together here
  Runner(const Scene& scene, SceneRun* start, const RunOptions& options)
      : given_(scene),
        checked_(start),
        options_(options),
        folder_(options.out.empty() ? default_output_folder(scene.file) : options.out) {}

  RunReport go() {
    const std::optional<io::Checkpoint> checkpoint = folder_.prepare(options_.existing);
    if (checkpoint && scene().default_watches) {
      kept_ = given_;
      const std::string note =
          keep_default_watches(parse_toml(checkpoint->scene_toml, "the scene in the checkpoint"), *kept_);
      const bool told = told_of_kept_watches(checkpoint->run) || is_over(*checkpoint);
      if (!note.empty() && !told) kept_->notes.push_back(note);
    }
    tell_notes();
    files_ = files_of(scene(), folder_, options_);
    choose_simd(checkpoint);
    if (scene().minimize && !checkpoint) minimize();
    if (checkpoint) check_resume(*checkpoint);
    Simulation<double> sim = checkpoint ? restored(*checkpoint) : assembled();
    if (checkpoint) {
      report_.resumed_from_step = checkpoint->step;
      if (is_over(*checkpoint)) return finished(sim, *checkpoint);
    }
    const std::int64_t first = sim.step();
    if (ending_.outcome.ok()) ending_.outcome = options_.cost ? advance_by_the_book(sim) : advance(sim);
    ending_.wall_s = sim.seconds();
    ending_.steps_made = sim.step() - first;
    close(sim);
    return report(sim);
  }

 private:
  const Scene& scene() const { return kept_ ? *kept_ : given_; }

  /// The run at its first step: the one that was checked, unless it begins elsewhere or looks at other times.
  Simulation<double> assembled() {
    if (checked_ == nullptr || start_ || kept_) {
      if (checked_ != nullptr) checked_->forget();
      return assemble(start_ ? *start_ : scene(), files_);
    }
    return checked_->assemble(files_);
  }

  void tell_notes() {
    report_.notes = scene().notes;
    if (!folder_.moved_to().empty()) {
      report_.notes.push_back(
          fmt::format("the finished run in {} was moved to {}", folder_.path().string(), folder_.moved_to().string()));
    }
    if (options_.notes) noether::tell_notes(report_.notes);
  }

  /// Finds the particles the run begins with; where there are none, the run is over before its first step.
  void minimize() {
    start_ = scene();
    report_.minimized = minimize_start(*start_);
    const UnitSystem& units = *scene().units;
    report_.force_unit = units.is_reduced() ? "1" : fmt::format("{}/{}", units.energy, units.length);
    const std::optional<Failure>& failure = report_.minimized->failure;
    if (!failure) return;
    ending_.outcome.kind = failure->kind;
    ending_.outcome.quantity = failure->quantity;
    ending_.outcome.message = failure->message;
    if (failure->particle < 0) return;
    const auto i = static_cast<std::size_t>(failure->particle);
    ending_.outcome.particle = {failure->particle, start_->particles.ids()[i], start_->particles.names()[i]};
  }

  /// The end, in time where the method chooses its steps, else in steps.
  bool ends_in_time() const { return scene().integrator.until.has_value(); }
  std::int64_t target() const { return *scene().integrator.steps; }

  /// A run goes on at the level it began with: another would round in other ways.
  void choose_simd(const std::optional<io::Checkpoint>& checkpoint) {
    if (options_.simd) set_simd_level(*options_.simd);
    if (checkpoint && checkpoint->simd != name(simd_level())) {
      const SimdLevel level = simd_level_named(checkpoint->simd);
      if (options_.simd) {
        throw SceneError(fmt::format("the run was made at SIMD level '{}', not '{}'; leave --simd out, or give --fresh",
                                     name(level), name(*options_.simd)),
                         {.file = scene().source.file});
      }
      if (!has_simd_level(level)) {
        throw SceneError(fmt::format("the run was made at SIMD level '{}', which this processor does not support; "
                                     "resume on one that does, or give --fresh",
                                     name(level)),
                         {.file = scene().source.file});
      }
      set_simd_level(level);
    }
    report_.simd = name(simd_level());
  }

  void check_resume(const io::Checkpoint& checkpoint) {
    report_.warnings = check_same_scene(checkpoint, scene());
    if (ends_in_time()) {
      const double end = *scene().integrator.until;
      const double start = scene().integrator.start;
      const auto clock = clock_of(scene().integrator);
      if (clock.is_later(start, checkpoint.time)) {
        throw SceneError(
            fmt::format("the end at time {} lies in the opposite direction: the checkpoint is at time {}; give a "
                        "time {} {}, or --fresh",
                        end, checkpoint.time, end > start ? "below" : "above", start),
            {.file = scene().source.file, .key = "integrator.until"});
      }
      if (!clock.is_later(checkpoint.time, end)) return;
      throw SceneError(
          fmt::format("the end at time {} lies before the checkpoint at time {}; give a later one, or --fresh", end,
                      checkpoint.time),
          {.file = scene().source.file, .key = "integrator.until"});
    }
    if (target() < checkpoint.step) {
      throw SceneError(
          fmt::format("the end at step {} lies before the checkpoint at step {}; give a later one, or --fresh",
                      target(), checkpoint.step),
          {.file = scene().source.file, .key = "integrator.until"});
    }
  }

  /// The run as the checkpoint has it; with a new trajectory where the old one is not what the checkpoint counts on.
  Simulation<double> restored(const io::Checkpoint& checkpoint) {
    try {
      Simulation<double> sim = assembled();
      sim.restore(checkpoint.run);
      return sim;
    } catch (const io::TrajectoryLost& lost) {
      set_aside(checkpoint, lost.message());
    }
    files_.lost = true;
    Simulation<double> sim = assemble(scene(), files_);
    sim.restore(checkpoint.run);
    if (is_over(checkpoint)) return sim;
    sim.for_each_monitor([&](const std::string&, AnyMonitor<double>& monitor) {
      if (auto* writer = monitor.get<io::TrajectoryWriter>()) writer->begin(sim.particles());
    });
    count_on_new_file(checkpoint, sim);
    return sim;
  }

  /// The checkpoints on disk count on rows of the file that is gone, which must not come a second time. Both
  /// generations are replaced; a failure between the two leaves one that begins a new file again.
  void count_on_new_file(const io::Checkpoint& checkpoint, Simulation<double>& sim) const {
    if (files_.checkpoint.empty()) return;
    io::Checkpoint anew = checkpoint;
    sim.for_each_monitor([](const std::string&, AnyMonitor<double>& monitor) { monitor.flush(); });
    anew.run = sim.save();
    anew.run.parts.merge(mark_of_kept_watches(scene()));
    anew.outcome.clear();
    for (int generation = 0; generation < 2; ++generation) io::write_checkpoint(files_.checkpoint, anew);
  }

  /// Nothing of a trajectory that cannot be gone on with is lost: it stays beside the new one.
  void set_aside(const io::Checkpoint& checkpoint, const std::string& why) {
    const std::filesystem::path& file = files_.trajectory;
    const std::string wrong = fmt::format("{}: {}", file.string(), why);
    if (is_over(checkpoint)) {
      report_.warnings.push_back(fmt::format(
          "{}; the run is finished: 'noether verify --repair {}' repairs it if only frames or samples are missing",
          wrong, file.string()));
      return;
    }
    std::filesystem::path kept;
    if (std::filesystem::exists(file)) {
      for (int k = 0; kept.empty() || std::filesystem::exists(kept); ++k)
        kept = file.string() + (k == 0 ? ".damaged" : fmt::format(".damaged.{}", k));
      io::rename_if_there(file, kept);
    }
    report_.warnings.push_back(fmt::format("{}; a new one begins at step {}{}", wrong, checkpoint.step,
                                           kept.empty()
                                               ? std::string()
                                               : fmt::format(", and the old one is {}: 'noether verify --repair {}' "
                                                             "repairs it if only frames or samples are missing",
                                                             kept.string(), kept.string())));
  }

  /// A completed run goes on if its end has been moved; one that has stopped or failed does not.
  bool is_over(const io::Checkpoint& checkpoint) const {
    if (checkpoint.outcome.empty()) return false;
    if (checkpoint.outcome != name(Outcome::Kind::completed)) return true;
    return ends_in_time() ? *scene().integrator.until == checkpoint.time : target() == checkpoint.step;
  }

  RunReport finished(Simulation<double>& sim, const io::Checkpoint& checkpoint) {
    ending_ = load_ending(checkpoint);
    finish_monitors(sim);
    return report(sim);
  }

  Outcome advance_by_the_book(Simulation<double>& sim) {
    const CostBook book;
    const Outcome outcome = advance(sim);
    report_.cost = book.entries();
    return outcome;
  }

  Outcome advance(Simulation<double>& sim) const {
    std::optional<StopOnSignals> signals;
    sim.stop_on(options_.handle_signals ? signals.emplace().flag() : options_.stop);
    ProgressLine line(options_.progress);
    line.attach(sim, scene().integrator.start, scene().units->time);
    if (options_.tell) sim.on_progress(options_.tell);
    return ends_in_time() ? sim.run_until(*scene().integrator.until) : sim.run(target() - sim.step());
  }

  /// Puts everything on disk: writers first, then the checkpoint that counts on them, then the mark of completeness.
  void close(Simulation<double>& sim) {
    sim.for_each_monitor([](const std::string&, AnyMonitor<double>& monitor) { monitor.flush(); });
    if (has_files && !files_.checkpoint.empty()) {
      io::Checkpoint checkpoint;
      checkpoint.run = sim.save();
      checkpoint.run.parts.merge(mark_of_kept_watches(scene()));
      const bool over = ending_.outcome.kind != Outcome::Kind::interrupted;
      if (over) save_ending(checkpoint.run, ending_);
      if (over) checkpoint.outcome = name(ending_.outcome.kind);
      checkpoint.scene_toml = scene().effective_toml;
      checkpoint.digest = io::digest(sim.particles());
      checkpoint.simd = report_.simd;
      checkpoint.step = sim.step();
      checkpoint.time = sim.time();
      io::write_checkpoint(files_.checkpoint, checkpoint);
    }
    finish_monitors(sim);
  }

  void finish_monitors(Simulation<double>& sim) const {
    sim.for_each_monitor([&](const std::string&, AnyMonitor<double>& monitor) { monitor.finish(ending_.outcome); });
  }

  RunReport report(Simulation<double>& sim) {
    RunReport r = report_;
    const IntegratorClaims claims = sim.claims();
    r.outcome = ending_.outcome;
    const std::vector<std::string> of_scene = warnings_of(scene());
    r.warnings.insert(r.warnings.end(), of_scene.begin(), of_scene.end());
    r.epoch = epoch_of(scene().effective);
    r.scene = scene().source.file;
    r.scene_sha256 = io::sha256(scene().effective_toml);
    r.method = claims.method;
    r.hamiltonian = claims.hamiltonian;
    r.time_unit = scene().units->time;
    r.digest = io::digest(sim.particles());
    r.dt = scene().integrator.step;
    r.start_time = scene().integrator.start;
    r.particles = sim.particles().size();
    r.threads = thread_count();
    r.steps_made = ending_.steps_made;
    r.wall_s = ending_.wall_s;
    r.evaluations = sim.evaluations();
    if (!scene().hamiltonian.constraints.empty()) r.solver = scene().hamiltonian.constraint_options.solver;
    if (const auto& encounter = r.evaluations.encounter) {
      r.warnings.push_back(warning_of(*encounter, scene().hamiltonian.splitting.name, sim.particles(), *scene().units));
    }
    if (r.evaluations.unsettled > 0) r.warnings.push_back(warning_of(r.evaluations, claims.method));
    sim.for_each_monitor([&](const std::string& name, AnyMonitor<double>& monitor) {
      if (auto one = monitor.report()) r.monitors.emplace_back(name, *one);
    });
    if (!files_.trajectory.empty() && writes_trajectory(scene())) r.trajectory = files_.trajectory;
    if (has_files) r.checkpoint = files_.checkpoint;
    return r;
  }

  const Scene& given_;
  SceneRun* checked_;
  std::optional<Scene> kept_;  ///< the scene with the default watches of the run that it goes on with
  const RunOptions& options_;
  std::optional<Scene> start_;  ///< the scene with other particles, if it asks for a minimum
  OutputFolder folder_;
  SceneFiles files_;
  RunReport report_;
  Ending ending_;
};

}  // namespace

namespace {

RunReport run_from(const Scene& scene, SceneRun* start, const RunOptions& options) {
  if (!scene.integrator.steps && !scene.integrator.until) {
    throw SceneError("the scene has no end; give until or steps in [integrator]",
                     {.file = scene.source.file, .key = "integrator.until"});
  }
  return Runner(scene, start, options).go();
}

Outcome told(const RunReport& report) {
  fmt::print("{}", to_text(report));
  return report.outcome;
}

}  // namespace

RunReport run(SceneRun start, const RunOptions& options) { return run_from(start.scene(), &start, options); }
RunReport run(const Scene& scene, const RunOptions& options) { return run_from(scene, nullptr, options); }

Outcome run(SceneRun start) { return told(run(std::move(start), {.progress = true, .notes = true})); }
Outcome run(const Scene& scene) { return told(run(scene, {.progress = true, .notes = true})); }

}  // namespace noether
