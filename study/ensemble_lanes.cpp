#include "study/ensemble_lanes.hpp"

#include "engine/not_finite.hpp"
#include "engine/schedule.hpp"
#include "forces/gr_potential.hpp"
#include "forces/speed_of_light.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/composition.hpp"
#include "integrators/force_motion.hpp"
#include "integrators/lane_method.hpp"
#include "integrators/methods/collocation_table.hpp"
#include "integrators/planet_systems.hpp"
#include "integrators/system_lanes.hpp"
#include "integrators/wisdom_holman.hpp"
#include "numbers/error.hpp"
#include "scene/toml.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <list>
#include <map>
#include <memory>
#include <utility>

namespace noether {

namespace {

/// The state is looked at for finite values at least this often, as in any run.
constexpr std::int64_t longest_cut = 1024;
/// Above, the lanes are better filled with particles.
constexpr Index most_in_lanes = 64;
constexpr std::size_t member_lanes = LaneRun::lanes;

/// Arcs about a primary and kicks, split in coordinates and by nothing else.
bool is_planetary(const Scene& scene) {
  const SceneSplitting& splitting = scene.hamiltonian.splitting;
  const auto* keys = splitting.effective.get<SceneValue::Table>();
  const bool plain = keys != nullptr && std::all_of(keys->begin(), keys->end(), [](const auto& entry) {
                       return entry.first == "G" || entry.first == "coordinates";
                     });
  return plain && splitting.claims().kepler && splitting.effective.find("coordinates") != nullptr;
}
/// p^2/2m and kicks by forces.
bool is_kicked(const Scene& scene) {
  const HamiltonianClaims& claims = scene.hamiltonian.splitting.claims();
  return scene.hamiltonian.splitting.only_forces && claims.twists && claims.inertial && !claims.kepler;
}

/// Gravity alone under a method of eight stages, which has a form of its own for it: stages in lanes, and separations
/// that keep their digits in close pairs.
bool is_gravity_in_stages(const Scene& scene) {
  if (!scene.integrator.classical || scene.particles.size() < 2) return false;
  const CollocationTable* const table = collocation_of(scene.integrator.classical->info->name);
  if (table == nullptr || table->stages() != member_lanes) return false;
  const detail::PointGravity<double> gravity(forces_of(scene).terms(), scene.particles);
  return gravity.G && gravity.beside.terms().empty();
}

/// Why there is none of a method with steps of one length.
std::string why_method_has_no_lanes(const MethodInfo& info) {
  const auto is_of = [&](std::span<const MethodInfo> family) {
    return std::any_of(family.begin(), family.end(), [&](const MethodInfo& one) { return one.name == info.name; });
  };
  if (is_of(methods::encke_list()) || is_of(methods::wide_gauss_list()))
    return fmt::format("the stages of '{}' fill the lanes of one system", info.name);
  if (info.family == "line integral") return fmt::format("the nodes of '{}' take the lanes of one system", info.name);
  if (info.takes(*linear_solver))
    return fmt::format("the method '{}' solves linear systems, which have no lanes", info.name);
  return fmt::format("the method '{}' has no lanes", info.name);
}

std::string why_alone_by_method(const Scene& scene) {
  const SceneIntegrator& integrator = scene.integrator;
  if (!integrator.classical) return "";
  if (scene.integrator.adaptive()) return fmt::format("the method '{}' chooses its steps", integrator.method);
  if (!method_in_lanes(*integrator.classical)) return why_method_has_no_lanes(*integrator.classical->info);
  return "";
}

std::string why_alone_by_hamiltonian(const Scene& scene) {
  const SceneHamiltonian& made = scene.hamiltonian;
  if (!is_kicked(scene) && (!is_planetary(scene) || scene.integrator.classical)) {
    return fmt::format("the Hamiltonian '{}' has no lanes", made.splitting.name);
  }
  for (const SceneForce& force : made.forces) {
    const bool split = !scene.integrator.classical;
    if (force.letter && split && force.force.claims().drag > 0) continue;
    if (force.letter && split) return fmt::format("'{}' is a letter of its own, which has no lanes", force.name);
    if (!force.force.has_lanes()) return fmt::format("the force '{}' is written for doubles only", force.name);
    if (force.force.claims().velocity_dependent && split)
      return fmt::format("the force '{}' depends on velocities", force.name);
    if (force.force.claims().gyrates) return fmt::format("the force '{}' turns velocities", force.name);
    if (force.force.claims().range > 0) return fmt::format("the force '{}' has a cutoff", force.name);
    if (force.force.claims().bonded) return fmt::format("the force '{}' acts on bonds", force.name);
  }
  if (is_gravity_in_stages(scene))
    return fmt::format("the stages of '{}' fill the lanes where gravity acts alone", scene.integrator.method);
  if (!is_planetary(scene)) return "";
  const std::string* which = made.splitting.effective.find("coordinates")->get<std::string>();
  if (which != nullptr && *which != "jacobi") return fmt::format("coordinates = \"{}\" have no lanes", *which);
  const StepKernel kernel = scene.integrator.composition.kernel;
  if (kernel == StepKernel::modified || kernel == StepKernel::lazy) return "kernels of modified kicks have no lanes";
  if (scene.particles.size() < 2) return "there are no planets";
  for (Index i = 0; i < scene.particles.size(); ++i) {
    if (scene.particles.masses()[i] == 0) return "tracers of wisdom_holman go in lanes by themselves";
  }
  return "";
}

/// Monitors of chaos may look more often than they are asked to: what they have to be told until then stays short.
constexpr std::int64_t longest_without_telling = 65536;

std::string why_alone_by_monitors(const Scene& scene) {
  Watched watched = detail::watched_of(scene);
  Index changes = 0;
  watched.tangents.make = [&](Index wanted) {
    changes = wanted;
    return std::unique_ptr<TangentFlow<double>>();
  };
  for (const SceneWatch& watch : scene.watches) {
    if (watch.kind != SceneWatch::Kind::monitor) continue;
    if (watch.cadence.steps == 0) return fmt::format("monitor '{}' looks by time, not by steps", watch.monitor.name);
    changes = 0;
    if (watch.monitor.make(watched).wanted().action) {
      return fmt::format("monitor '{}' asks for the action of the flows", watch.monitor.name);
    }
    if (changes > 1) {
      return fmt::format("monitor '{}' follows {} vectors, of which one goes in lanes", watch.monitor.name, changes);
    }
    if (changes == 1 && watch.cadence.after) {
      return fmt::format("monitor '{}' does not begin with the run", watch.monitor.name);
    }
  }
  return "";
}

/// What lanes of one batch have in common. Members of equal makes differ in masses, positions and velocities, and in
/// what watches and stops them.
std::string make_of(const Scene& scene, const std::vector<std::int64_t>& order) {
  std::string tracers;
  for (const double m : scene.particles.masses().all()) tracers += m == 0 ? '0' : '1';
  return fmt::format("{}{}{} {} {}", print_toml(*scene.effective.find("hamiltonian")),
                     print_toml(*scene.effective.find("integrator")), fmt::join(scene.particles.ids(), ","),
                     fmt::join(order, ","), tracers);
}

std::vector<std::int64_t> jacobi_order_of(const Scene& scene) {
  if (!is_planetary(scene)) return {};
  WisdomHolman<double> probe(WisdomHolmanOptions{.G = scene.hamiltonian.G});
  ParticleSystem<double> s = scene.particles;
  probe.bind(s);
  return probe.order();
}

std::unique_ptr<SystemLanes> systems_of(const Scene& scene, const std::vector<std::int64_t>& order) {
  const bool compensated = scene.integrator.composition.compensated;
  ForceField<double> forces;
  double drag = 0;
  const GrPotential* relativity = nullptr;
  for (const SceneForce& force : scene.hamiltonian.forces) {
    if (force.letter) {
      drag += force.force.claims().drag;
      continue;
    }
    forces.add(force.force);
    relativity = force.force.as<GrPotential>();
  }
  const auto finished = [&](std::unique_ptr<SystemLanes> systems) {
    return drag > 0 ? with_drag(std::move(systems), drag) : std::move(systems);
  };
  if (!is_planetary(scene)) return finished(systems_under_forces(forces, scene.particles, compensated));
  const double units_G = scene.units->G;
  PlanetSystemsOptions options{.G = scene.hamiltonian.G.value_or(units_G),
                               .order = order,
                               .light = {},
                               .G_of_light = units_G,
                               .others = {},
                               .compensated = compensated};
  if (relativity != nullptr && forces.terms().size() == 1) {
    options.light = speed_of_light_in(scene.particles, relativity->c, "gr_potential");
    options.G_of_light = relativity->G.value_or(units_G);
  } else {
    options.others = std::move(forces);
  }
  return finished(planet_systems(std::move(options), scene.particles));
}

/// What steps lanes of one make.
std::unique_ptr<LaneRun> run_of(const Scene& scene, const std::vector<std::int64_t>& order) {
  const SceneIntegrator& made = scene.integrator;
  if (!made.classical) {
    return std::make_unique<SplittingLanes>(systems_of(scene, order), scheme_of(made), made.composition,
                                            clock_of(made));
  }
  return run_in_lanes(method_in_lanes(*made.classical), forces_of(scene), scene.particles, clock_of(made));
}

/// A member in a lane: its state as users see it, and who looks at it.
class LaneMember {
 public:
  LaneMember(std::int64_t member, Scene scene)
      : member_(member),
        scene_(std::move(scene)),
        now_(scene_.particles),
        copy_(now_.units()),
        mapped_(now_.units()),
        integrator_(integrator_of(scene_)) {
    now_.clock() = clock_of(scene_.integrator);
    integrator_.bind(now_);
    now_.keep_low_words(false);
    Watched watched = detail::watched_of(scene_);
    watched.tangents.make = [this](Index /*one*/) {
      changes_.push_back(std::make_shared<LaneChange>());
      return tangent_flow_in_lanes(changes_.back(), 6 * now_.size());
    };
    for (const SceneWatch& watch : scene_.watches) {
      if (watch.kind == SceneWatch::Kind::monitor) add(watch, watched);
    }
    for (const SceneStop& stop : scene_.stops) stops_.push_back({stop.steps, StopCheck<double>(stop.rule)});
  }

  std::int64_t member() const { return member_; }
  const Scene& scene() const { return scene_; }
  ParticleSystem<double>& now() { return now_; }
  /// What monitors of chaos follow.
  const std::vector<std::shared_ptr<LaneChange>>& changes() const { return changes_; }
  const std::optional<Outcome>& ended() const { return ended_; }
  void end(Outcome outcome) { ended_ = std::move(outcome); }

  /// The next step at which somebody looks.
  std::int64_t next(std::int64_t step) const {
    std::int64_t next = std::numeric_limits<std::int64_t>::max();
    for (const Watcher& one : watchers_) next = std::min(next, one.looks.next(step));
    if (!changes_.empty()) next = std::min(next, detail::next_multiple(step, longest_without_telling));
    for (const Stop& one : stops_) next = std::min(next, detail::next_multiple(step, one.steps));
    return next;
  }
  /// Shows the state of a step to those who are due, in the order of a run (`Simulation`).
  void look() {
    const std::int64_t step = now_.clock().step();
    Request wanted;
    for (const Watcher& one : watchers_) {
      if (!one.looks.due(step)) continue;
      wanted.energy = wanted.energy || one.wanted.energy;
      wanted.virial = wanted.virial || one.wanted.virial;
    }
    const Snapshot<double> moment = snapshot(wanted);
    std::optional<StopReason> reason;
    for (Stop& one : stops_) {
      if (!detail::is_multiple(step, one.steps)) continue;
      const auto found = one.check.look(moment);
      if (found && !reason) reason = found;
    }
    for (Watcher& one : watchers_) {
      const bool told = one.follows && detail::is_multiple(step, longest_without_telling);
      if (told || one.looks.due(step)) one.monitor.observe(moment);
    }
    if (reason) stop(*reason);
  }
  /// The end of the run: stops that are not due look too.
  void look_at_the_end() {
    const std::int64_t step = now_.clock().step();
    const Snapshot<double> moment = snapshot({});
    for (Stop& one : stops_) {
      if (detail::is_multiple(step, one.steps)) continue;
      if (const auto reason = one.check.look(moment)) return stop(*reason);
    }
    for (Watcher& one : watchers_) {
      if (!one.monitor.looks_at_the_end() || one.looks.due(step) || step < one.looks.first) continue;
      one.monitor.at_end(moment);
    }
    ended_ = outcome(Outcome::Kind::completed);
  }
  /// The run has failed behind the step that `now` stands at.
  void fail(const Failure& failure) {
    Outcome ended = outcome(failure.kind);
    ended.message = failure.message;
    ended.quantity = failure.quantity;
    if (failure.particle >= 0) ended.particle = reference(failure.particle);
    ended_ = std::move(ended);
  }

  io::EnsembleRow row(const EnsembleScene& ensemble) {
    io::EnsembleRow row = ensemble.row(member_);
    ensemble.end_row(row, *ended_, now_, [&](const auto& visit) {
      for (Watcher& one : watchers_) visit(one.name, one.monitor);
    });
    return row;
  }

 private:
  struct Watcher {
    std::string name;
    detail::Looks looks;
    AnyMonitor<double> monitor;
    Request wanted = {};
    bool follows = false;  ///< a small change
  };
  struct Stop {
    std::int64_t steps;
    StopCheck<double> check;
  };

  void add(const SceneWatch& watch, const Watched& watched) {
    const std::size_t changes = changes_.size();
    AnyMonitor<double> monitor = watch.monitor.make(watched);
    detail::Looks looks;
    looks.steps = watch.cadence.steps;
    looks.in_a_row = monitor.steps_in_a_row();
    if (watch.cadence.after) {
      looks.first = detail::first_multiple(*watch.cadence.after, now_.clock().start(), now_.clock().dt(), looks.steps);
    }
    const std::string base = monitor.name().empty() ? "monitor" : monitor.name();
    std::string name = base;
    const auto taken = [&] {
      return std::any_of(watchers_.begin(), watchers_.end(), [&](const Watcher& one) { return one.name == name; });
    };
    for (int k = 2; taken(); ++k) name = fmt::format("{}_{}", base, k);
    const Request wanted = monitor.wanted();
    watchers_.push_back({std::move(name), std::move(looks), std::move(monitor), wanted, changes_.size() > changes});
  }

  Snapshot<double> snapshot(Request wanted) {
    const RunSource run{this, [](const void* /*self*/) -> SavedRun {
                          throw LogicError("the whole run of a member in lanes was requested");
                        }};
    return Snapshot<double>(integrator_, now_, copy_, mapped_, wanted, {}, 0.0, run);
  }
  Outcome outcome(Outcome::Kind kind) const {
    Outcome made;
    made.kind = kind;
    made.step = now_.clock().step();
    made.time = now_.clock().at_step();
    return made;
  }
  ParticleRef reference(Index i) const { return {i, now_.ids()[static_cast<std::size_t>(i)], now_.name(i)}; }
  void stop(const StopReason& reason) {
    ended_ = outcome(Outcome::Kind::stopped);
    ended_->message = reason.message;
    ended_->particle = reference(reason.particle);
  }

  std::int64_t member_;
  Scene scene_;
  ParticleSystem<double> now_, copy_, mapped_;
  AnyIntegrator<double> integrator_;
  std::list<Watcher> watchers_;
  std::vector<Stop> stops_;
  std::vector<std::shared_ptr<LaneChange>> changes_;
  std::optional<Outcome> ended_;
};

/// Members of one make in the lanes of one run. A lane whose member has ended is a copy of one that goes on.
class Batch {
 public:
  explicit Batch(std::vector<std::unique_ptr<LaneMember>> members, const std::vector<std::int64_t>& order)
      : members_(std::move(members)),
        first_(members_[0]->scene()),
        run_(run_of(first_, order)),
        end_(*first_.integrator.steps) {
    for (std::size_t k = 0; k < member_lanes; ++k) {
      run_->put(k, members_[std::min(k, members_.size() - 1)]->scene().particles);
    }
    std::size_t changes = 0;
    for (const auto& one : members_) changes = std::max(changes, one->changes().size());
    if (changes > 0) run_->carry(changes);
  }

  /// @return whether it was not interrupted
  bool go(const std::atomic<bool>* stop) {
    settle();
    for (std::size_t k = 0; k < members_.size(); ++k) {
      if (const auto bad = not_finite(members_[k]->now())) {
        members_[k]->fail(*bad);
      } else {
        members_[k]->look();
        follow(k);
      }
    }
    run_->keep();
    replace_ended();
    while (going() && run_->step() < end_) {
      if (stop != nullptr && stop->load(std::memory_order_relaxed)) return false;
      advance_to(next_cut());
      for (auto& one : members_) {
        if (!one->ended()) one->look();
      }
      run_->keep();
      replace_ended();
    }
    for (auto& one : members_) {
      if (!one->ended()) one->look_at_the_end();
    }
    return true;
  }
  const std::vector<std::unique_ptr<LaneMember>>& members() const { return members_; }

 private:
  void follow(std::size_t member) {
    const auto& changes = members_[member]->changes();
    for (std::size_t j = 0; j < changes.size(); ++j) {
      if (changes[j]->begun()) run_->follow(member, j, changes[j]);
    }
  }
  bool going() const {
    return std::any_of(members_.begin(), members_.end(), [](const auto& one) { return !one->ended(); });
  }
  std::int64_t next_cut() const {
    std::int64_t cut = std::min(end_, run_->step() + longest_cut);
    for (const auto& one : members_) {
      if (!one->ended()) cut = std::min(cut, one->next(run_->step()));
    }
    return cut;
  }
  /// Gives the members who go on the settled states of their lanes.
  void settle() {
    run_->settle();
    for (std::size_t k = 0; k < members_.size(); ++k) {
      if (!members_[k]->ended()) run_->take(k, members_[k]->now());
    }
  }
  /// Steps to a cut. Where a lane fails on the way, each is looked at by itself, and those that did not fail go on.
  void advance_to(std::int64_t cut) {
    while (going()) {
      const bool good = run_->advance(cut - run_->step()) && run_->step() == cut;
      if (good) {
        settle();
        const bool finite = std::all_of(members_.begin(), members_.end(),
                                        [](const auto& one) { return one->ended() || !not_finite(one->now()); });
        if (finite) return;
      }
      run_->go_back();
      bool failed = false;
      for (std::size_t k = 0; k < members_.size(); ++k) {
        if (!members_[k]->ended()) failed = fails(k, cut) || failed;
      }
      if (!failed) throw LogicError("a member of an ensemble fails beside others, but not by itself");
      replace_ended();
      run_->keep();
    }
  }
  /// Whether a member fails on the way to a cut, in all lanes by itself; then it has ended at the last whole step
  /// before. The run is where it was.
  bool fails(std::size_t member, std::int64_t cut) {
    LaneMember& one = *members_[member];
    for (std::size_t k = 0; k < member_lanes; ++k) {
      if (k != member) run_->copy_lane(member, k);
    }
    std::optional<Failure> why;
    ParticleSystem<double> last = one.now();
    while (run_->step() < cut && !why) {
      if (!run_->advance(1)) why = run_->failure();
      run_->settle();
      run_->take(member, one.now());
      const std::optional<Failure> bad = not_finite(one.now());
      if (bad && !(why && says_more(*why))) why = bad;
      if (!why) last.assign_state(one.now());
    }
    one.now().assign_state(last);
    if (why) one.fail(*why);
    run_->go_back();
    return why.has_value();
  }
  /// What a force has named says more than what came of it.
  static bool says_more(const Failure& failure) {
    using Kind = Outcome::Kind;
    return failure.kind == Kind::overlap || failure.kind == Kind::overstretch || failure.kind == Kind::inverted_element;
  }
  /// The lanes of members who have ended go with those of others: nothing in them may fail any more.
  void replace_ended() {
    for (std::size_t k = 0; k < members_.size(); ++k) {
      if (members_[k]->ended()) run_->forget(k);
    }
    std::size_t from = 0;
    while (from < members_.size() && members_[from]->ended()) ++from;
    if (from == members_.size()) return;
    for (std::size_t k = 0; k < member_lanes; ++k) {
      if (k >= members_.size() || members_[k]->ended()) run_->copy_lane(from, k);
    }
  }

  std::vector<std::unique_ptr<LaneMember>> members_;
  const Scene& first_;
  std::unique_ptr<LaneRun> run_;
  std::int64_t end_;
};

/// Makes the row of a member, or that of one whose values make no scene.
template <class Make> void attempt(const EnsembleScene& ensemble, EnsembleMember& result, const Make& make) {
  try {
    make();
  } catch (const FileError&) {
    throw;
  } catch (const LogicError&) {
    throw;
  } catch (const Error& error) {
    result.refusal = error.message();
    result.row = ensemble.refused(result.member);
  }
}

}  // namespace

std::string why_alone(const Scene& scene) {
  const SceneIntegrator& integrator = scene.integrator;
  const ParticleSystem<double>& s = scene.particles;
  if (scene.system) return "a system of first order has no lanes";
  if (const std::string of_method = why_alone_by_method(scene); !of_method.empty()) return of_method;
  if (!integrator.steps || integrator.step == 0) return "the run has no number of steps";
  if (!integrator.decorators.empty()) {
    return fmt::format("'{}' around the method has no lanes", integrator.decorators.front().name);
  }
  if (!scene.hamiltonian.constraints.empty()) return "constraints have no lanes";
  if (scene.hamiltonian.thermostat) return "a thermostat has no lanes";
  if (s.bodies() != nullptr) return "rigid bodies have no lanes";
  if (s.box().is_periodic()) return "a periodic box has no lanes";
  if (s.topology() != nullptr || !s.columns().empty())
    return "particles with bonds or columns of their own have no lanes";
  if (s.size() > most_in_lanes) {
    return fmt::format("{} particles are more than {}, so that lanes are filled with particles", s.size(),
                       most_in_lanes);
  }
  const std::string of_hamiltonian = why_alone_by_hamiltonian(scene);
  return of_hamiltonian.empty() ? why_alone_by_monitors(scene) : of_hamiltonian;
}

std::vector<EnsembleMember> run_members(const EnsembleScene& ensemble, std::span<const std::int64_t> members,
                                        bool in_lanes, const std::atomic<bool>* stop) {
  struct Made {
    std::vector<std::int64_t> order;
    std::vector<std::unique_ptr<LaneMember>> members;
    std::vector<EnsembleMember*> results;
  };
  std::vector<EnsembleMember> results;
  for (const std::int64_t member : members) results.push_back({.member = member, .row = {}, .refusal = {}});
  std::map<std::string, Made> makes;
  for (EnsembleMember& one : results) {
    attempt(ensemble, one, [&] {
      if (in_lanes) {
        const SceneRun start = ensemble.member(one.member);
        if (why_alone(start.scene()).empty()) {
          std::vector<std::int64_t> order = jacobi_order_of(start.scene());
          Made& made = makes[make_of(start.scene(), order)];
          made.members.push_back(std::make_unique<LaneMember>(one.member, start.scene()));
          made.results.push_back(&one);
          made.order = std::move(order);
          return;
        }
      }
      one.row = run_alone(ensemble, one.member, stop);
    });
  }
  for (auto& [make, made] : makes) {
    Batch batch(std::move(made.members), made.order);
    if (!batch.go(stop)) continue;
    for (std::size_t k = 0; k < made.results.size(); ++k) made.results[k]->row = batch.members()[k]->row(ensemble);
  }
  return results;
}

}  // namespace noether
