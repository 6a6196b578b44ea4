#include "cli/commands.hpp"
#include "cli/explain_bodies.hpp"
#include "cli/explain_kept.hpp"
#include "cli/explain_mesh.hpp"
#include "cli/gyration_text.hpp"
#include "cli/method_text.hpp"
#include "cli/scene_reports.hpp"

#include "integrators/composition.hpp"
#include "integrators/stiffness.hpp"
#include "numbers/quantity.hpp"
#include "numbers/simd.hpp"
#include "numbers/text.hpp"
#include "scene/json.hpp"
#include "scene/read_particles.hpp"
#include "scene/scene.hpp"
#include "scene/warnings.hpp"
#include "study/ensemble_lanes.hpp"
#include "study/kepler_steps.hpp"
#include "study/sheet_steps.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {

namespace {

/// What a scene does and does not do, before it runs.
struct Explanation {
  std::string method, hamiltonian;
  std::vector<std::string> in, out, columns;
  std::size_t bytes_per_particle = 0;
  Index particles = 0, constraints = 0;
  std::map<char, int> flows;                    ///< stages of one step, by letter, the last joined to the next first
  std::string kicks, inexact;                   ///< letters that evaluate forces, and those that are no exact flows
  std::map<char, int> of_kicks;                 ///< evaluations of the forces of each kick in one step
  std::map<char, int> of_kernel;                ///< evaluations of the forces in one step, by letters of kernels
  int behind_kicks = 0;                         ///< of these, those that G may take from a kick B before it
  std::string processing;                       ///< what a corrector or a kernel makes of the scheme
  int corrector = 0;                            ///< flows before the run, and for every look at it
  int evaluations = 0;                          ///< of the forces in one step: kicks between which something has moved
  std::optional<KeplerSteps> kepler;            ///< of gravity
  std::optional<SheetSteps> sheet;              ///< of a turning frame
  Index variables = 0;                          ///< of a system without particles
  std::optional<NeighborStatistics> neighbors;  ///< of the first step
  std::string kept;                             ///< of energy, momentum and angular momentum
  std::string shadow;                           ///< whether it can be watched, of bodies and systems with an energy
  int jacobians = 0;                            ///< of the forces in one step
  std::string small_box;                        ///< what is done where it is smaller than twice the range
  std::optional<Stiffness> stiffness;           ///< at the start
  std::optional<StiffnessAlong> along;          ///< of a system whose run has an end
  std::string why_no_stiffness;
};

void count_flows(const FittedWord& word, std::map<char, int>& flows) {
  const std::vector<Stage>& stages = word.stages;
  for (const Stage& stage : stages) ++flows[stage.letter];
  if (word.joins && stages.size() > 1 && stages.front().letter == stages.back().letter) --flows[stages.front().letter];
}

/// How often a kick follows something that has moved particles, in steps that follow each other.
int evaluations_of(const FittedWord& word, char kick, std::string_view moves) {
  int count = 0;
  bool moved = false;
  for (int step = 0; step < 2; ++step) {  // the first one tells what has moved before the second
    count = 0;
    for (const Stage& stage : word.stages) {
      if (stage.letter == kick && std::exchange(moved, false)) ++count;
      moved = moved || moves.find(stage.letter) != std::string_view::npos;
    }
  }
  return count;
}

/// Letters of kernels evaluate forces twice.
/// @return how many of these behind a kick B, whose forces they take where they can
int count_of_kernel(const FittedWord& word, std::string_view kernels, std::map<char, int>& evaluations) {
  const std::vector<Stage>& stages = word.stages;
  const bool joined = word.joins && stages.size() > 1 && stages.front().letter == stages.back().letter;
  int behind = 0;
  for (std::size_t k = joined ? 1 : 0; k < stages.size(); ++k) {
    if (kernels.find(stages[k].letter) == std::string_view::npos) continue;
    evaluations[stages[k].letter] += 2;
    behind += stages[k].letter == 'G' && k > 0 && stages[k - 1].letter == 'B' ? 1 : 0;
  }
  return behind;
}

/// A value as a sentence has it: texts without their quotes.
std::string plain_text(const SceneValue& value) {
  const std::string* text = value.get<std::string>();
  return text != nullptr ? *text : to_text(value);
}

/// The keys of a part behind its name: ", temperature 300 K, seed 1".
std::string keys_text(const SceneValue& table) {
  std::string text;
  for (const auto& [key, value] : *table.get<SceneValue::Table>())
    text += fmt::format(", {} {}", key, plain_text(value));
  return text;
}

std::string length_text(double length, const UnitSystem& units) {
  return format_number(length) + (units.is_reduced() ? "" : " " + std::string(units.length));
}

/// Length of the whole run [time]; infinite where the scene gives none, or steps of the method's own choice.
double length_of(const SceneIntegrator& made) {
  return made.length().value_or(std::numeric_limits<double>::infinity());
}

/// What the Jacobian says: of systems along their run, and of few particles under a method for y' = f at its start.
void measure_stiffness(const Scene& scene, Explanation& e) {
  static constexpr Index most_bodies = 50;
  if (!scene.integrator.classical || scene.particles.size() > most_bodies || has_bodies(scene.particles)) return;
  try {
    const std::unique_ptr<VectorField<double>> field = field_of(scene);
    Vector<double> y;
    field->bind(scene.particles);
    field->gather(scene.particles, y);
    std::vector<std::complex<double>> eigenvalues = eigenvalues_of(*field, scene.integrator.start, y);
    if (scene.integrator.direction() == Direction::backward) {
      for (auto& one : eigenvalues) one = -one;  // back in time what decays grows
    }
    const double length = length_of(scene.integrator);
    e.stiffness = stiffness_of(eigenvalues, std::abs(length));
    if (scene.system && std::isfinite(length) && length != 0)
      e.along = stiffness_along(*field, y, length, scene.integrator.start);
  } catch (const Error& error) {
    e.why_no_stiffness = error.message();
  }
}

/// ", without 80 of its 512 terms, which constraints hold"; empty for a force that has all of them.
std::string held_terms(const SceneForce& force, const ParticleSystem<double>& s) {
  const Topology* topology = s.topology();
  if (!force.force.claims().bonded || topology == nullptr || topology->rigid.empty()) return "";
  const auto terms = [](const Topology& t) {
    return t.bonds.size() + t.angles.size() + t.dihedrals.size() + t.impropers.size();
  };
  const std::size_t all = terms(*topology), left = terms(topology->without_rigid_terms(s.size()));
  return left == all ? "" : fmt::format(", without {} of its {} terms, which constraints hold", all - left, all);
}

void sort_parts(const Scene& scene, Explanation& e) {
  const Parts& parts = *scene.parts;
  if (scene.system) e.in.push_back("system " + scene.system->name);
  for (const SceneForce& force : scene.hamiltonian.forces) {
    const bool wide = force.force.in_quad().has_value();
    e.in.push_back((force.force.claims().gyrates ? "field " : "force ") + force.name +
                   held_terms(force, scene.particles) +
                   (wide ? "" : ", in double precision only: compare has no reference for it"));
  }
  if (const auto& bath = scene.hamiltonian.thermostat) {
    e.in.push_back("thermostat " + bath->name + keys_text(bath->effective));
  }
  for (const SceneConstraint& constraint : scene.hamiltonian.constraints) {
    e.in.push_back(fmt::format("constraint {}, {}", constraint.name,
                               counted(static_cast<std::int64_t>(constraint.tied.size()), "time")));
  }
  for (const SceneDecorator& decorator : scene.integrator.decorators) {
    e.in.push_back("decorator " + decorator.name + keys_text(decorator.effective) +
                   (decorator.cost.empty() ? "" : ": " + decorator.cost));
  }
  const std::string unit = scene.units->time == "1" ? "" : " " + std::string(scene.units->time);
  for (const SceneWatch& watch : scene.watches) {
    const bool monitor = watch.kind == SceneWatch::Kind::monitor;
    const std::string name = monitor                                      ? "monitor " + watch.monitor.name
                             : watch.kind == SceneWatch::Kind::trajectory ? "writer trajectory"
                                                                          : "writer checkpoint";
    const std::string beside = watch.sites ? ", frames with sites of bodies" : "";
    const std::size_t listed = watch.cadence.times.size();
    const std::string when =
        listed > 0               ? fmt::format("at {} of a list", counted(static_cast<std::int64_t>(listed), "time"))
        : watch.cadence.wall > 0 ? fmt::format("every {} s of wall time", watch.cadence.wall)
        : watch.cadence.interval != 0
            ? fmt::format("every {:.12g}{}", watch.cadence.interval, unit.empty() ? " of time" : unit)
            : "every " + counted(watch.cadence.steps, "step");
    const std::string later =
        watch.cadence.after ? fmt::format(", not before {:.12g}{}", *watch.cadence.after, unit) : "";
    const Index coordinates =
        scene.system ? static_cast<Index>(scene.particles.variables().size()) / 2 : 3 * scene.particles.size();
    const std::string cost =
        watch.monitor.cost && listed == 0 ? watch.monitor.cost(coordinates, watch.cadence.steps) : "";
    e.in.push_back(name + ", " + when + later + beside + (scene.default_watches ? ", by default" : "") +
                   (cost.empty() ? "" : ": " + cost));
  }
  for (const SceneStop& stop : scene.stops) {
    const bool escape = stop.rule.kind == StopRule::Kind::escape;
    e.in.push_back(fmt::format("stop {}, {} {}, every {}", stop.name, escape ? "beyond" : "below",
                               length_text(stop.rule.distance, *scene.units), counted(stop.steps, "step")));
  }
  const auto leave_out = [&](const std::string& what) {
    const bool used = std::any_of(e.in.begin(), e.in.end(),
                                  [&](const std::string& one) { return one == what || one.starts_with(what + ","); });
    if (!used) e.out.push_back(what);
  };
  if (scene.system) return leave_out("writer trajectory");  // nothing else could be in
  const std::vector<SceneForce>& inside = scene.hamiltonian.splitting.own;
  for (const auto& kind : parts.forces()) {
    const bool own = std::any_of(inside.begin(), inside.end(), [&](const auto& f) { return f.name == kind.info.name; });
    if (!own) leave_out((kind.field ? "field " : "force ") + kind.info.name);
  }
  for (const auto& kind : parts.constraints()) leave_out("constraint " + kind.info.name);
  for (const auto& kind : parts.decorators()) leave_out("decorator " + kind.info.name);
  for (const auto& kind : parts.monitors()) leave_out("monitor " + kind.info.name);
  leave_out("writer trajectory");
  for (const auto& kind : parts.stops()) leave_out("stop " + kind.info.name);
}

/// What the stages of a scheme do, from its word.
void explain_scheme(const Scene& scene, Explanation& e) {
  const AnyHamiltonian<double> hamiltonian = hamiltonian_of(scene);
  e.constraints = hamiltonian.claims().constraints;
  const CompositionOptions& options = scene.integrator.composition;
  const Scheme scheme = processed(scheme_of(scene.integrator), options);
  const FittedWord fitted = fitted_word(scheme, hamiltonian.claims(), e.hamiltonian, options);
  count_flows(fitted, e.flows);
  e.behind_kicks = count_of_kernel(fitted, hamiltonian.claims().kernels, e.of_kernel);
  if (options.changes_scheme()) {
    const Order order = order_over(scheme, hamiltonian.claims());
    e.processing =
        fmt::format("{}: order {}, errors of dt^{} in the first power of the masses and dt^{} in the second",
                    options.processing_text(), order.classical, order.near_integrable[0], order.near_integrable[1]);
  }
  e.corrector = static_cast<int>(scheme.before.size());
  e.kicks = hamiltonian.claims().kicks;
  for (const char kick : e.kicks) e.of_kicks[kick] = evaluations_of(fitted, kick, hamiltonian.claims().timed);
  for (const char letter : e.kicks) e.evaluations += e.flows.contains(letter) ? e.flows.at(letter) : 0;
  for (const auto& [letter, count] : e.of_kernel) e.evaluations += count;
  e.inexact = hamiltonian.claims().inexact;
}

/// How often forces are evaluated is counted, over the first steps; of a splitting without the first one, before which
/// a corrector may have its own.
void count_evaluations(const Scene& scene, Explanation& e) {
  const std::int64_t steps = scene.integrator.classical ? 64 : 4, before = scene.integrator.classical ? 0 : 1;
  Scene bare = scene;
  bare.watches.clear();
  bare.stops.clear();
  Simulation<double> sim = assemble(bare);
  std::int64_t known = 0;
  if (before > 0) {
    if (sim.run(before).step < before) return;
    known = sim.evaluations().force;
  }
  const auto in_a_step = [&](std::int64_t count) {
    return static_cast<int>(std::lround(static_cast<double>(count) / static_cast<double>(steps)));
  };
  const std::int64_t made = sim.run(steps).step - before;
  if (made < steps) return;  // a step that fails is made again and again: the word alone tells
  const int by_word = e.evaluations;
  e.evaluations = in_a_step(sim.evaluations().force - known);
  e.jacobians = in_a_step(sim.evaluations().jacobian);
  if (e.behind_kicks > 0 && e.evaluations == by_word - e.behind_kicks) e.of_kernel['G'] -= e.behind_kicks;
}

/// The list of the first step.
void measure_neighbors(AnyIntegrator<double>& integrator, ParticleSystem<double>& s, Explanation& e) {
  if (integrator.advance(s, {.steps = 1}).failure == nullptr) e.neighbors = integrator.evaluations().neighbors;
}

/// What a box smaller than twice the range of the pair forces means.
std::string small_box_of(const Scene& scene) {
  double range = 0;
  for (const SceneForce& force : scene.hamiltonian.forces) {
    range = std::max(range, force.force.claims().range);
  }
  const Box& box = scene.particles.box();
  if (!box.is_periodic() || range == 0 || box.edges().minCoeff() >= 2 * range) return "";
  return fmt::format(
      "box: an edge of {:.6g} is smaller than twice the range {:.6g} of the pair forces; all images in "
      "range count, also of a particle itself",
      box.edges().minCoeff(), range);
}

Explanation explained(const Scene& scene) {
  Explanation e;
  AnyIntegrator<double> integrator = integrator_of(scene);
  e.method = scene.integrator.method;
  e.hamiltonian = integrator.claims().hamiltonian;
  sort_parts(scene, e);
  ParticleSystem<double> s = scene.particles;
  s.clock() = Clock<double>::fixed(scene.integrator.start, scene.integrator.step);
  integrator.bind(s);
  e.particles = s.size();
  e.variables = static_cast<Index>(s.variables().size());
  if (!scene.system) e.columns = {"id", "position", "velocity", "mass"};
  if (s.low_words() != nullptr) e.columns.insert(e.columns.end(), {"low word of position", "low word of velocity"});
  for (const auto& column : s.columns()) e.columns.push_back(column.info.name);
  if (!scene.system) e.bytes_per_particle = s.bytes_per_particle();
  measure_stiffness(scene, e);
  if (!scene.integrator.classical) explain_scheme(scene, e);
  count_evaluations(scene, e);
  const auto sheet = sheet_steps(scene);
  if (!sheet) e.kepler = kepler_steps(scene);  // in a turning frame orbits are no ellipses
  if (!scene.integrator.classical) e.sheet = sheet;
  e.small_box = small_box_of(scene);
  e.kept = kept_text(scene, integrator.claims());
  e.shadow = shadow_text(scene, integrator);
  measure_neighbors(integrator, s, e);
  return e;
}

/// A force in the kicks of a letter; of one that is in several, the part in these.
std::string force_in_kick(const SceneForce& force, char letter) {
  const SceneValue* waves = force.effective.find("wave_kick");
  const std::string* of_waves = waves != nullptr ? waves->get<std::string>() : nullptr;
  if (of_waves == nullptr) return force.name;
  return force.name + (*of_waves == std::string(1, letter) ? " (waves)" : " (near part)");
}

/// The forces of a kick, where kicks have several letters.
std::string forces_in_kick(char letter, const Scene& scene) {
  std::vector<std::string> names;
  for (const SceneForce& force : scene.hamiltonian.forces) {
    const bool kicks = !force.letter && force.force.claims().kicks.find(letter) != std::string::npos;
    if (kicks) names.push_back(force_in_kick(force, letter));
  }
  return fmt::format("kicks by {}", fmt::join(names, ", "));
}

/// What the part that gives a letter calls its flow.
std::string flow_of(char letter, const Scene& scene, std::string_view kicks) {
  if (kicks.size() > 1 && kicks.find(letter) != std::string::npos) return forces_in_kick(letter, scene);
  const auto meaning_in = [&](const auto& kinds, const auto& is_used) {
    std::string found;
    for (const auto& kind : kinds) {
      if (found.empty() && is_used(kind.info.name)) found = kind.info.meaning(letter);
    }
    return found;
  };
  const SceneHamiltonian& h = scene.hamiltonian;
  std::string found =
      meaning_in(scene.parts->hamiltonians(), [&](const auto& name) { return name == h.splitting.name; });
  if (found.empty() && h.thermostat) {
    found = meaning_in(scene.parts->thermostats(), [&](const auto& name) { return name == h.thermostat->name; });
  }
  if (found.empty()) {
    found = meaning_in(scene.parts->forces(), [&](const auto& name) {
      return std::any_of(h.forces.begin(), h.forces.end(), [&](const auto& f) { return f.name == name; });
    });
  }
  if (found.empty() && kicks.find(letter) != std::string::npos) found = forces_in_kick(letter, scene);
  return found.empty() ? "flows" : found;
}

std::string meaning(char letter, const Scene& scene, const Explanation& e) {
  const std::string flow = flow_of(letter, scene, e.kicks);
  if (e.constraints > 0 && e.inexact.find(letter) != std::string::npos) {
    return fmt::format(
        "{}, each with {} of constraints solved for positions and for velocities; degrees of freedom left: {}", flow,
        counted(e.constraints, "equation"), 3 * e.particles - e.constraints);
  }
  if (const auto kernel = e.of_kernel.find(letter); kernel != e.of_kernel.end())
    return flow + ", " + counted(kernel->second, "force evaluation");
  if (e.kicks.find(letter) == std::string::npos) return flow;
  if (e.kicks.size() > 1) return fmt::format("{}, {}", flow, counted(e.of_kicks.at(letter), "force evaluation"));
  int kicks = 0;
  for (const char one : e.kicks) kicks += e.flows.contains(one) ? e.flows.at(one) : 0;
  int own = e.evaluations;
  for (const auto& [one, count] : e.of_kernel) own -= count;
  if (own == kicks) return flow + ", one force evaluation each";
  return fmt::format("{}, {}: a kick where nothing has moved uses the forces again", flow,
                     counted(own, "force evaluation"));
}

void print_stiffness(const Scene& scene, const Explanation& e) {
  const Stiffness& start = *e.stiffness;
  if (!e.along) {
    fmt::print("stiffness at the start: {}\n", start.verdict());
  } else {
    const StiffnessAlong& along = *e.along;
    fmt::print("stiffness: {}\n", along.mean.verdict());
    const double length = length_of(scene.integrator);
    const double begin = scene.integrator.start;
    const bool whole = std::abs((along.reached - begin) / length - 1) < 1e-9;
    fmt::print("  seen at {} of a rough run to t = {:.3g}{}\n", counted(along.places, "place"), along.reached,
               whole ? "" : fmt::format(" of {:.3g}; what comes later is not known", begin + length));
    fmt::print("  fastest rate {:.3g}, at t = {:.3g}; at the start {:.3g}\n", along.fastest, along.at, start.fastest);
  }
  if (start.spread() > 1) {
    fmt::print("  rates{} from {:.3g} to {:.3g}, {:.3g} times as fast\n", e.along ? " at the start" : "", start.slowest,
               start.fastest, start.spread());
  }
}

/// The step, and the one that is recommended.
void print_step(const Scene& scene, const Explanation& e) {
  const std::string unit = scene.units->is_reduced() ? "" : " " + std::string(scene.units->time);
  fmt::print("step: {}", scene.integrator.adaptive() ? "of the method's own choice" : scene.integrator.step_text);
  if (e.kepler) {
    fmt::print("; at most {:.3g}{} is recommended, a twentieth of the time {} needs around its pericenter",
               e.kepler->recommended(), unit, e.kepler->passage_of);
  }
  if (e.sheet) {
    const auto step = e.sheet->recommended();
    fmt::print("; {}{}", step ? fmt::format("at most {:.3g}{} is recommended, ", *step, unit) : "", e.sheet->reason());
  }
  if (const auto& steps = scene.integrator.steps) fmt::print("; {} in all", counted(*steps, "step"));
  fmt::print("\n");
}

/// What a step costs.
void print_cost(const Scene& scene, const Explanation& e) {
  fmt::print("each step:\n");
  for (const auto& [letter, count] : e.flows) fmt::print("  {} x {}: {}\n", count, letter, meaning(letter, scene, e));
  if (!e.processing.empty()) fmt::print("  {}\n", e.processing);
  if (e.corrector > 0)
    fmt::print("  before the first and for every look: {} of the corrector\n", counted(e.corrector, "flow"));
  if (!scene.integrator.classical) return;
  const bool group = scene.system ? scene.system->field()->on_group() != nullptr : has_bodies(scene.particles);
  const auto& [info, options] = *scene.integrator.classical;
  if (group && info->group_work != nullptr) {
    fmt::print("  {}{}\n", group_work_text(info->group_work(*info, options)), dexp_text(*info, options));
  }
  if (moves_momenta(scene))
    fmt::print("  positions and the momenta m v + q A move, under H = |p - q A|^2/2m + q phi\n");
  fmt::print("  {} of {}{}, on the average of the first steps\n", counted(e.evaluations, "evaluation"),
             scene.system ? "all rates" : "all forces together",
             e.jacobians > 0 ? fmt::format(" and {} of their Jacobian", e.jacobians) : "");
}

/// The parts that are left out, each in a line, or how many of each kind.
void print_left_out(const Explanation& e, bool all) {
  if (e.out.empty()) return;
  if (all) {
    fmt::print("left out:\n");
    for (const std::string& one : e.out) fmt::print("  {}\n", one);
    return;
  }
  std::vector<std::pair<std::string, std::int64_t>> kinds;
  for (const std::string& one : e.out) {
    const std::string kind = one.substr(0, one.find(' '));
    if (kinds.empty() || kinds.back().first != kind) kinds.emplace_back(kind, 0);
    ++kinds.back().second;
  }
  std::vector<std::string> counts;
  for (const auto& [kind, count] : kinds) counts.push_back(counted(count, kind));
  fmt::print("left out: {}; --all names them\n", fmt::join(counts, ", "));
}

void print_text(const Scene& scene, const Explanation& e, bool all) {
  fmt::print("{}{}{} over {}, {}\n", plain_line(scene.title), scene.title.empty() ? "" : ": ", e.method, e.hamiltonian,
             scene.system ? counted(e.variables, "variable") : counted(e.particles, "particle"));
  print_step(scene, e);
  print_cost(scene, e);
  fmt::print("in:\n");
  for (const std::string& one : e.in) fmt::print("  {}\n", one);
  print_left_out(e, all);
  if (!scene.system) {
    fmt::print("columns: {}; {} per particle\n", fmt::join(e.columns, ", "),
               counted(static_cast<std::int64_t>(e.bytes_per_particle), "byte"));
  }
  if (const std::string bodies = bodies_text(scene); !bodies.empty()) fmt::print("{}\n", bodies);
  if (e.neighbors) {
    fmt::print("neighbors: {:.3g} listed for each particle with a skin of {:.3g}, {:.0f} bytes per particle\n",
               e.neighbors->pairs, e.neighbors->skin,
               static_cast<double>(e.neighbors->bytes) / static_cast<double>(e.particles));
  }
  for (const SceneForce& force : scene.hamiltonian.forces) {
    const SceneValue* precision = force.effective.find("precision");
    const std::string* chosen = precision != nullptr ? precision->get<std::string>() : nullptr;
    if (chosen == nullptr || *chosen != "mixed" || force.force.claims().charges.value_or(false)) continue;
    fmt::print(
        "precision: {}'s forces of pairs are single, right to about 1e-6 of the strongest attraction; their sums are "
        "exact, energies are doubles\n",
        force.name);
  }
  if (const std::string mesh = mesh_text(scene); !mesh.empty()) fmt::print("{}\n", mesh);
  if (const std::string gyration = gyration_text(scene); !gyration.empty()) fmt::print("{}\n", gyration);
  if (!e.kept.empty()) fmt::print("{}\n", e.kept);
  if (!e.shadow.empty()) fmt::print("{}\n", e.shadow);
  if (!e.small_box.empty()) fmt::print("{}\n", e.small_box);
  if (const std::string epoch = epoch_of(scene.effective); !epoch.empty()) {
    const double start = scene.integrator.start;
    const std::string unit = scene.units->is_reduced() ? "" : " " + std::string(scene.units->time);
    fmt::print("bodies: as of {}{}\n", epoch, start == 0 ? "" : fmt::format(", at time {:.9g}{}", start, unit));
  }
  for (const std::string& warning : warnings_of(scene)) fmt::print("warning: {}\n", warning);
  if (e.stiffness) print_stiffness(scene, e);
  if (!e.why_no_stiffness.empty()) fmt::print("stiffness: not known: {}\n", e.why_no_stiffness);
  const std::string alone = why_alone(scene);
  fmt::print("ensembles: {}\n",
             alone.empty() ? "members go in lanes, eight at a time" : fmt::format("members go one by one: {}", alone));
  fmt::print("SIMD level: {}\n", name(simd_level()));
}

Json::Members members_of(const Stiffness& stiffness) {
  return {{"S", stiffness.ratio},       {"fastest", stiffness.fastest}, {"slowest", stiffness.slowest},
          {"growth", stiffness.growth}, {"turning", stiffness.turning}, {"verdict", stiffness.verdict()}};
}

/// At the start, and of the run from there, where it was looked at.
Json stiffness_json(const Explanation& e) {
  if (!e.stiffness) return {};
  Json along;
  if (e.along) {
    Json::Members members = members_of(e.along->mean);
    members.emplace_back("largest", e.along->fastest);
    members.emplace_back("largest_at", e.along->at);
    members.emplace_back("reached", e.along->reached);
    members.emplace_back("places", e.along->places);
    along = Json::object(members);
  }
  Json::Members members = members_of(*e.stiffness);
  if (e.along) members.back().second = Json(e.along->mean.verdict());
  members.emplace_back("along", along);
  return Json::object(members);
}

Json recommended_step(const Explanation& e) {
  if (e.kepler) return e.kepler->recommended();
  const auto of_sheet = e.sheet ? e.sheet->recommended() : std::nullopt;
  return of_sheet ? Json(*of_sheet) : Json();
}

Json json_of(const Scene& scene, const Explanation& e) {
  const std::string epoch = epoch_of(scene.effective);
  Json::Members flows;
  std::vector<std::string> letters;
  letters.reserve(e.flows.size());  // the members point into it
  for (const auto& [letter, count] : e.flows) flows.emplace_back(letters.emplace_back(1, letter), count);
  const std::string alone = why_alone(scene);
  return Json::object(
      {{"schema", "noether.explain/1"},
       {"method", e.method},
       {"hamiltonian", e.hamiltonian},
       {"parts", Json::list_of(e.in)},
       {"left_out", Json::list_of(e.out)},
       {"columns", Json::list_of(e.columns)},
       {"bytes_per_particle", static_cast<std::int64_t>(e.bytes_per_particle)},
       {"particles", std::int64_t{e.particles}},
       {"variables", std::int64_t{e.variables}},
       {"neighbors", e.neighbors ? Json::object({{"pairs_per_particle", e.neighbors->pairs},
                                                 {"skin", e.neighbors->skin},
                                                 {"bytes", static_cast<std::int64_t>(e.neighbors->bytes)}})
                                 : Json()},
       {"rigid_bodies", bodies_json(scene)},
       {"mesh", mesh_json(scene)},
       {"stiffness", stiffness_json(e)},
       {"constraints", std::int64_t{e.constraints}},
       {"flows_per_step", Json::object(flows)},
       {"force_evaluations_per_step", e.evaluations},
       {"jacobians_per_step", e.jacobians},
       {"simd", std::string(name(simd_level()))},
       {"step", scene.integrator.step},
       {"members_alone", alone.empty() ? Json() : Json(alone)},
       {"epoch", epoch.empty() ? Json() : Json(epoch)},
       {"recommended_step", recommended_step(e)},
       {"time_unit", scene.units->time}});
}

}  // namespace

std::string explanation_json(const Scene& scene) { return json_of(scene, explained(scene)).text(); }

void add_explain_command(CLI::App& app, const Parts& parts, int& exit_code) {
  struct Arguments {
    std::string scene;
    std::vector<std::string> sets;
    bool all = false, json = false;
  };
  const auto given = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("explain", "which parts a scene uses and leaves out, and what a step costs");
  command->add_option("scene", given->scene, "scene file")->required()->type_name("SCENE");
  command->add_option("--set", given->sets, "change a key of the scene: key.path=value")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->add_flag("--all", given->all, "name every part that is left out");
  command->add_flag("--json", given->json, "as one line of JSON");
  command->callback([given, &parts, &exit_code] {
    const Scene scene = load_scene(given->scene, parts, given->sets);
    tell_notes(scene.notes);
    if (given->json) {
      fmt::print("{}\n", explanation_json(scene));
    } else {
      print_text(scene, explained(scene), given->all);
    }
    exit_code = 0;
  });
}

}  // namespace noether
