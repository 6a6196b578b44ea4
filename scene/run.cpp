#include "scene/run.hpp"

#include "io/digest.hpp"
#include "io/files.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "numbers/parallel.hpp"
#include "numbers/quantity.hpp"
#include "scene/minimize.hpp"
#include "scene/read_particles.hpp"
#include "scene/resume.hpp"
#include "scene/signals.hpp"
#include "scene/warnings.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace noether {

namespace {

std::filesystem::path default_folder(const Scene& scene) {
  std::filesystem::path name = scene.file.filename();
  if (name.extension() == ".toml") name.replace_extension();
  return name.string() + ".out";
}

/// Whether this build can write HDF5 files.
constexpr bool has_files = NOETHER_HDF5 != 0;

SceneFiles files_of(const Scene& scene, const OutputFolder& folder, const RunOptions& options) {
  SceneFiles files;
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

std::string duration_text(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

/// The line a terminal shows while the run goes on.
class ProgressLine {
 public:
  explicit ProgressLine(bool wanted) : shows_(wanted && ::isatty(STDERR_FILENO) == 1) {}
  ~ProgressLine() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// @param begin  what the clock showed at step 0 [time]
  void attach(Simulation<double>& sim, double begin) {
    if (!shows_) return;
    Energy* energy = nullptr;
    sim.for_each_monitor([&](const std::string&, AnyMonitor<double>& monitor) {
      if (auto* found = monitor.get<Energy>()) energy = found;
    });
    const std::int64_t first = sim.step();
    const double from = sim.time();
    sim.on_progress([=, this](const Progress& now) { show(now, first, from, begin, energy); });
  }

 private:
  void show(const Progress& now, std::int64_t first, double from, double begin, const Energy* energy) {
    shown_ = true;
    const auto made = static_cast<double>(now.step - first);
    const bool in_time = std::isfinite(now.until);
    const double done = in_time ? now.time - begin : static_cast<double>(now.step);
    const double end = in_time ? now.until - begin : static_cast<double>(now.end);
    const double gone = in_time ? now.time - from : made;
    const double rate = now.seconds > 0 ? made / now.seconds : 0;
    std::string line = fmt::format("{:5.1f} %  {:.3g} steps/s", 100 * done / end, rate);
    if (gone != 0) line += fmt::format("  {} left", duration_text((end - done) / gone * now.seconds));
    if (energy != nullptr && std::isfinite(energy->worst()))
      line += fmt::format("  energy error {:.1e}", energy->worst());
    fmt::print(stderr, "\r\033[K{}", line);
    std::fflush(stderr);
  }

  bool shows_, shown_ = false;
};

/// One run of one scene.
class Runner {
 public:
  Runner(const Scene& scene, const RunOptions& options)
      : scene_(scene),
        options_(options),
        folder_(options.out.empty() ? default_folder(scene) : options.out),
        files_(files_of(scene, folder_, options)) {}

  RunReport go() {
    const std::optional<io::Checkpoint> checkpoint = folder_.prepare(options_.existing);
    choose_simd(checkpoint);
    if (scene_.minimize && !checkpoint) minimize();
    if (checkpoint) check_resume(*checkpoint);
    Simulation<double> sim = checkpoint ? restored(*checkpoint) : assemble(start_ ? *start_ : scene_, files_);
    if (checkpoint) {
      report_.resumed_from_step = checkpoint->step;
      if (is_over(*checkpoint)) return finished(sim, *checkpoint);
    }
    const std::int64_t first = sim.step();
    if (ending_.outcome.ok()) ending_.outcome = advance(sim);
    ending_.wall_s = sim.seconds();
    ending_.steps_made = sim.step() - first;
    close(sim);
    return report(sim);
  }

 private:
  /// Finds the particles the run begins with; where there are none, the run is over before its first step.
  void minimize() {
    start_ = scene_;
    report_.minimized = minimize_start(*start_);
    const UnitSystem& units = *scene_.units;
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
  bool ends_in_time() const { return scene_.integrator.until.has_value(); }
  std::int64_t target() const { return *scene_.integrator.steps; }

  /// A run goes on at the level it began with: another would round in other ways.
  void choose_simd(const std::optional<io::Checkpoint>& checkpoint) {
    if (options_.simd) set_simd_level(*options_.simd);
    if (checkpoint && checkpoint->simd != name(simd_level())) {
      const SimdLevel level = simd_level_named(checkpoint->simd);
      if (options_.simd) {
        throw SceneError(fmt::format("the run was made at SIMD level '{}', not '{}'; leave --simd out, or give --fresh",
                                     name(level), name(*options_.simd)),
                         {.file = scene_.source.file});
      }
      if (!has_simd_level(level)) {
        throw SceneError(fmt::format("the run was made at SIMD level '{}', which this processor does not support; "
                                     "resume on one that does, or give --fresh",
                                     name(level)),
                         {.file = scene_.source.file});
      }
      set_simd_level(level);
    }
    report_.simd = name(simd_level());
  }

  void check_resume(const io::Checkpoint& checkpoint) {
    report_.warnings = check_same_scene(checkpoint, scene_);
    if (ends_in_time()) {
      const double end = *scene_.integrator.until;
      const double start = scene_.integrator.start;
      const auto clock = clock_of(scene_.integrator);
      if (clock.is_later(start, checkpoint.time)) {
        throw SceneError(
            fmt::format("the end at time {} lies in the opposite direction: the checkpoint is at time {}; give a "
                        "time {} {}, or --fresh",
                        end, checkpoint.time, end > start ? "below" : "above", start),
            {.file = scene_.source.file, .key = "integrator.until"});
      }
      if (!clock.is_later(checkpoint.time, end)) return;
      throw SceneError(
          fmt::format("the end at time {} lies before the checkpoint at time {}; give a later one, or --fresh", end,
                      checkpoint.time),
          {.file = scene_.source.file, .key = "integrator.until"});
    }
    if (target() < checkpoint.step) {
      throw SceneError(
          fmt::format("the end at step {} lies before the checkpoint at step {}; give a later one, or --fresh",
                      target(), checkpoint.step),
          {.file = scene_.source.file, .key = "integrator.until"});
    }
  }

  /// The run as the checkpoint has it; with a new trajectory where the old one is not what the checkpoint counts on.
  Simulation<double> restored(const io::Checkpoint& checkpoint) {
    try {
      Simulation<double> sim = assemble(scene_, files_);
      sim.restore(checkpoint.run);
      return sim;
    } catch (const io::TrajectoryLost& lost) {
      set_aside(checkpoint, lost.message());
    }
    files_.lost = true;
    Simulation<double> sim = assemble(scene_, files_);
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
    return ends_in_time() ? *scene_.integrator.until == checkpoint.time : target() == checkpoint.step;
  }

  RunReport finished(Simulation<double>& sim, const io::Checkpoint& checkpoint) {
    ending_ = load_ending(checkpoint);
    finish_monitors(sim);
    return report(sim);
  }

  Outcome advance(Simulation<double>& sim) const {
    std::optional<StopOnSignals> signals;
    if (options_.handle_signals) sim.stop_on(signals.emplace().flag());
    ProgressLine line(options_.progress);
    line.attach(sim, scene_.integrator.start);
    return ends_in_time() ? sim.run_until(*scene_.integrator.until) : sim.run(target() - sim.step());
  }

  /// Puts everything on disk: writers first, then the checkpoint that counts on them, then the mark of completeness.
  void close(Simulation<double>& sim) {
    sim.for_each_monitor([](const std::string&, AnyMonitor<double>& monitor) { monitor.flush(); });
    if (has_files && !files_.checkpoint.empty()) {
      io::Checkpoint checkpoint;
      checkpoint.run = sim.save();
      const bool over = ending_.outcome.kind != Outcome::Kind::interrupted;
      if (over) save_ending(checkpoint.run, ending_);
      if (over) checkpoint.outcome = name(ending_.outcome.kind);
      checkpoint.scene_toml = scene_.effective_toml;
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
    const std::vector<std::string> of_scene = warnings_of(scene_);
    r.warnings.insert(r.warnings.end(), of_scene.begin(), of_scene.end());
    r.epoch = epoch_of(scene_.effective);
    r.scene = scene_.source.file;
    r.scene_sha256 = io::sha256(scene_.effective_toml);
    r.method = claims.method;
    r.hamiltonian = claims.hamiltonian;
    r.time_unit = scene_.units->time;
    r.digest = io::digest(sim.particles());
    r.dt = scene_.integrator.step;
    r.start_time = scene_.integrator.start;
    r.particles = sim.particles().size();
    r.threads = thread_count();
    r.steps_made = ending_.steps_made;
    r.wall_s = ending_.wall_s;
    r.evaluations = sim.evaluations();
    sim.for_each_monitor([&](const std::string& name, AnyMonitor<double>& monitor) {
      if (auto one = monitor.report()) r.monitors.emplace_back(name, *one);
    });
    if (!files_.trajectory.empty() && writes_trajectory(scene_)) r.trajectory = files_.trajectory;
    if (has_files) r.checkpoint = files_.checkpoint;
    return r;
  }

  const Scene& scene_;
  const RunOptions& options_;
  std::optional<Scene> start_;  ///< the scene with other particles, if it asks for a minimum
  OutputFolder folder_;
  SceneFiles files_;
  RunReport report_;
  Ending ending_;
};

}  // namespace

RunReport run(const Scene& scene, const RunOptions& options) {
  if (!scene.integrator.steps && !scene.integrator.until) {
    throw SceneError("the scene has no end; give until or steps in [integrator]",
                     {.file = scene.source.file, .key = "integrator.until"});
  }
  return Runner(scene, options).go();
}

Outcome run(const Scene& scene) {
  const RunReport report = run(scene, {.progress = true});
  fmt::print("{}", to_text(report));
  return report.outcome;
}

}  // namespace noether
