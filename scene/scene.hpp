#pragma once
/// A scene: a whole run as a text file says it, read, checked, and ready to be assembled.

#include "engine/simulation.hpp"
#include "forces/sum.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/composition_options.hpp"
#include "integrators/minimize.hpp"
#include "integrators/rotating.hpp"
#include "integrators/scheme.hpp"
#include "numbers/simd.hpp"
#include "scene/parts.hpp"

#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// The Hamiltonian of a scene.
struct SceneHamiltonian {
  SceneSplitting splitting;
  std::optional<double> G;  ///< as the scene gives it [length^3/mass/time^2]
  std::vector<SceneForce> forces;
  std::vector<SceneConstraint> constraints;
  ConstraintOptions constraint_options;
  std::optional<SceneThermostat> thermostat;
  std::optional<NeighborOptions> neighbors;
  std::optional<RotatingOptions> rotating;  ///< how rigid bodies turn, where there are some

  /// The Hamiltonian as it is walked: kicks by the forces, and every letter beside them.
  /// @param particles  those that constraints tie
  AnyHamiltonian<double> make(const ParticleSystem<double>& particles) const;
  /// Refuses a force in a kick that the Hamiltonian does not have: it would be summed in another one.
  /// @throws SchemeMismatch
  void check_kicks(const std::string& kicks) const;
  /// The constraints of the first `tables` tables; all of them unless told.
  ConstraintSet constraint_set(const ParticleSystem<double>& particles,
                               std::size_t tables = std::numeric_limits<std::size_t>::max()) const;

  /// Forces as a Hamiltonian of bodies takes them: those that act on bodies themselves, and the others on their sites;
  /// without bodies as they are.
  template <class Real> ForceField<Real> on_bodies(const ForceField<Real>& forces) const;
  AnyForce<double> on_bodies(const AnyForce<double>& force) const;
  /// The same of all that pull, in the order of `forces_of`: those that the splitting has in itself pull at centres.
  template <class Real> ForceField<Real> all_on_bodies(const ForceField<Real>& all) const;

  /// Every term that pulls: what the splitting has in itself, and the scene's forces that are no letters.
  std::vector<SceneForce> terms() const;
  /// Whether a force moves pairs on Kepler orbits, one in the splitting or beside it.
  bool is_keplerian() const;
};

/// The integrator of a scene.
struct SceneIntegrator {
  std::string method;                      ///< name of the scheme, or a word
  Scheme scheme;                           ///< `scheme_of` gives it its name
  std::optional<MethodChoice> classical;   ///< a classical method instead of the scheme
  double step = 0;                         ///< [time], signed; 0: the method chooses, and finds the first one itself
  std::string step_text;                   ///< as the scene writes it
  double start = 0;                        ///< what the clock shows at the first step [time]
  std::optional<std::int64_t> steps;       ///< of the whole run; empty if the scene has no end, or one in time
  std::optional<double> until;             ///< [time] by the clock: the end, where the method chooses its steps
  bool exact = false;                      ///< times between two steps are refused where the method has no states there
  bool between_steps = false;              ///< steps are of one length, and the method tells states between them
  CompositionOptions composition;          ///< of the scheme
  std::vector<SceneDecorator> decorators;  ///< the first stands around the method, each further one around all before

  /// Whether the method chooses its steps.
  bool adaptive() const { return classical && classical->info->is_adaptive(classical->options); }
  /// Whether rigid bodies are stepped on their group.
  bool on_groups() const { return classical && classical->info->on_groups; }
  /// Which way the run goes: the end says it where there is one in time, else the step.
  Direction direction() const { return (until ? *until - start : step) < 0 ? Direction::backward : Direction::forward; }
  /// How long the whole run is, below 0 where time falls [time]; empty where the scene does not say.
  std::optional<double> length() const {
    if (until) return *until - start;
    if (steps && step != 0 && !adaptive()) return static_cast<double>(*steps) * step;
    return {};
  }
};

/// One `[[every]]`.
struct SceneWatch {
  enum class Kind : std::uint8_t { monitor, trajectory, checkpoint };
  Kind kind = Kind::monitor;
  SceneMonitor monitor;
  Cadence cadence;
  bool sites = false;  ///< frames have the sites of rigid bodies too
};

/// One `[[verdict]]`: what runs of the scene show (study/suite.hpp). A run passes it over.
struct SceneVerdict {
  std::vector<std::string> methods = {};  ///< empty: the scene's own
  bool every_method = false;              ///< every method of fixed steps that can serve the scene
  std::vector<std::string> sets = {};     ///< changes "key.path=value" of the scene
  std::string outcome = "bounded";        ///< bounded, unbounded, solver, or theory: what linear theory says
  std::optional<double> energy_below = {}, energy_above = {};    ///< of the largest relative error of the energy
  std::optional<double> sharing_below = {}, sharing_above = {};  ///< of the error of how particles share kinetic energy
  bool nightly = false;                                          ///< too long to be run by the way
  std::string why = {};                                          ///< in a line
};

/// A scene as plain data. Everything in it has been checked: `assemble` cannot fail for what the file says.
struct Scene {
  std::filesystem::path file;
  std::shared_ptr<const Parts> parts;  ///< those it was read with
  std::string title;
  const UnitSystem* units = &unit_system("solar");
  ParticleSystem<double> particles;   ///< in the frame the scene asks for; of a system, its variables
  std::optional<SceneSystem> system;  ///< of first order, in the place of a Hamiltonian
  SceneHamiltonian hamiltonian;
  std::optional<MinimizeOptions> minimize;  ///< before the first step
  SceneIntegrator integrator;
  std::vector<SceneWatch> watches;
  bool default_watches = false;  ///< the scene has no [[every]], so these are those of `add_default_watches`
  bool kept_watches = false;     ///< they look as often as in the run that this one goes on with
  std::vector<SceneStop> stops;
  std::map<std::string, SceneValue> expect;  ///< dotted key below [expect]
  std::vector<SceneVerdict> verdicts;
  std::vector<SceneError> wrong_verdicts;  ///< what is wrong in [[verdict]], which ends no run
  SceneSource source;                      ///< where errors point
  SceneValue effective;                    ///< the scene with every default, as a tree
  std::string effective_toml;              ///< the same as text: what files store
  std::vector<std::string> warnings;       ///< of its reading; `warnings_of` has all
  std::vector<std::string> notes;   ///< what was taken otherwise than written, with its place; `tell_notes` tells it
  std::vector<std::string> unread;  ///< of [expect]: what no run could be compared with, with its place
};

/// Reads a scene and checks all that can be checked before the first step.
/// @param sets  changes "key.path=value", applied in order
/// @throws SceneError for what is wrong in it, FileError if it or its bodies cannot be read
/// @cost one force evaluation where two bodies stand in one place
Scene load_scene(const std::filesystem::path& file, const Parts& parts = standard_parts(),
                 const std::vector<std::string>& sets = {});

/// The same from text; paths in it are relative to the folder of `file`, which errors show.
Scene read_scene(std::string_view text, const std::filesystem::path& file, const Parts& parts = standard_parts(),
                 const std::vector<std::string>& sets = {});

/// The same from a tree of values, as other languages put it together (scene/value.hpp): errors show their keys.
Scene read_scene(SceneValue root, const std::filesystem::path& file = "scene", const Parts& parts = standard_parts(),
                 const std::vector<std::string>& sets = {});

/// Where a run writes. An empty path leaves its writer out.
struct SceneFiles {
  std::filesystem::path trajectory, checkpoint;
  double checkpoint_wall = 0;  ///< seconds between checkpoints beside those of the scene; 0: none
  bool lost = false;           ///< the trajectory of the run that is gone on with is gone: it begins anew
  bool by_default = false;     ///< what a scene without [[every]] is given watches too
};

/// The scheme of a scene; its name lives as long as `integrator`.
Scheme scheme_of(const SceneIntegrator& integrator);

/// The clock of a scene at its first step.
Clock<double> clock_of(const SceneIntegrator& integrator);

/// The constraints of a scene's first `tables` tables; all of them unless told.
ConstraintSet constraints_of(const Scene& scene, std::size_t tables = std::numeric_limits<std::size_t>::max());

/// How rigid bodies of a scene turn: as its scheme has it, else as its Hamiltonian says. Empty without bodies, and for
/// methods on their group, which have no rotor.
std::optional<Rotor> rotor_of(const Scene& scene);

/// The Hamiltonian of a scene, drag or bath included.
AnyHamiltonian<double> hamiltonian_of(const Scene& scene);

/// All forces of a scene together, for methods that do not split: gravity of a wisdom_holman scene and drag among them.
ForceField<double> forces_of(const Scene& scene);

/// All that moves a scene as y' = f(t, y): its system, or all its forces together (constraints left out).
std::unique_ptr<VectorField<double>> field_of(const Scene& scene);
/// Whether its method for y' = f moves charges by their momenta m v + q A instead: where it serves an energy H(q, p),
/// or the Hamiltonian asks for it.
bool moves_momenta(const Scene& scene);

/// The integrator of a scene: its scheme over the parts of its Hamiltonian, or its classical method over all its
/// forces, with what stands around it.
/// @param decorators  of the scene's, so many are taken; all of them unless told
/// @throws SchemeMismatch
AnyIntegrator<double> integrator_of(const Scene& scene,
                                    std::size_t decorators = std::numeric_limits<std::size_t>::max());

/// The run of a scene, at its first step.
///
/// Monitors carry the names of their types; without a trajectory file there are no writers and no checkpoints.
Simulation<double> assemble(const Scene& scene, const SceneFiles& files = {});

namespace detail {
/// What the monitors of a scene may ask of its run.
Watched watched_of(const Scene& scene);
/// The run of a scene without what it writes, and without watches that the scene does not name.
Simulation<double> assemble_start(const Scene& scene);
}  // namespace detail

/// A scene, and the run that was put together to check it: nothing is made twice if that is the one that is run.
class SceneRun {
 public:
  /// @param start  of this scene, by `detail::assemble_start`
  SceneRun(Scene scene, Simulation<double> start);

  const Scene& scene() const { return scene_; }
  /// As `noether::assemble`. The first call takes the run that was checked, unless it was bound at another SIMD level
  /// or for another number of threads.
  Simulation<double> assemble(const SceneFiles& files = {});
  /// Frees the run that was checked; the next one is put together anew.
  void forget() { start_.reset(); }

 private:
  Scene scene_;
  std::optional<Simulation<double>> start_;
  SimdLevel simd_;
  int threads_;
};

/// As `load_scene` and `read_scene`; the run that was put together to check the scene is kept.
SceneRun load_run(const std::filesystem::path& file, const Parts& parts = standard_parts(),
                  const std::vector<std::string>& sets = {});
SceneRun read_run(std::string_view text, const std::filesystem::path& file, const Parts& parts = standard_parts(),
                  const std::vector<std::string>& sets = {});
SceneRun read_run(SceneValue root, const std::filesystem::path& file = "scene", const Parts& parts = standard_parts(),
                  const std::vector<std::string>& sets = {});

/// Runs a scene as `noether run SCENE` does: into `default_output_folder`, with checkpoints and a report on stdout.
///
///     return exit_code(run(load_run("saturn.toml", parts)));
///
/// More is in scene/run.hpp.
/// @throws SceneError, FileError
Outcome run(SceneRun start);
/// The same of a scene that may have been changed since it was read: its run is put together anew.
Outcome run(const Scene& scene);

}  // namespace noether
