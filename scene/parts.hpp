#pragma once
/// The parts a scene may name: each is one type that describes itself.

#include "constraints/constraint.hpp"
#include "constraints/constraint_set.hpp"
#include "constraints/structure_constraints.hpp"
#include "engine/any_force.hpp"
#include "engine/momentum_shares.hpp"
#include "engine/simulation.hpp"
#include "engine/tangent_flow.hpp"
#include "forces/electromagnetic_field.hpp"
#include "forces/sum.hpp"
#include "integrators/hamiltonian_system.hpp"
#include "integrators/lie/group_system.hpp"
#include "integrators/method.hpp"
#include "integrators/variational/lagrangian_system.hpp"
#include "monitors/charges.hpp"
#include "scene/fields.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace noether {

/// When a monitor looks: every so many steps, every so much time, every so many seconds of wall time, or at the times
/// of a list.
struct Cadence {
  std::int64_t steps = 0;
  double wall = 0;                   ///< [s]; 0: not by wall time
  double interval = 0;               ///< [time], where the method chooses the steps; 0: by steps
  std::vector<double> times = {};    ///< by the clock of the run, as it comes to them [time]; empty: not by a list
  std::optional<double> after = {};  ///< by the clock of the run, for steps and intervals: not before [time]
};

/// What a part adds to a splitting as a letter of its own.
using SceneLetter = std::function<AnyHamiltonian<double>(AnyHamiltonian<double>)>;

/// A force as a scene asked for it.
struct SceneForce {
  std::string name;
  SceneValue effective;    ///< its table, defaults included
  AnyForce<double> force;  ///< what methods that do not split take
  SceneLetter letter;  ///< of one that splittings take as a letter, such as drag; empty: they take it in their kicks
};

/// A thermostat as a scene asked for it: a letter with noise.
struct SceneThermostat {
  std::string name;
  SceneValue effective;
  SceneLetter letter;
};

/// The claims of a Hamiltonian without forces, which is made for them when somebody asks first. Copies share them, and
/// threads may ask at once.
class SplittingClaims {
 public:
  SplittingClaims() = default;
  explicit SplittingClaims(std::function<HamiltonianClaims()> ask) : known_(std::make_shared<Known>()) {
    known_->ask = std::move(ask);
  }
  const HamiltonianClaims& operator()() const {
    std::call_once(known_->asked, [this] { known_->claims = known_->ask(); });
    return known_->claims;
  }

 private:
  struct Known {
    std::function<HamiltonianClaims()> ask;
    std::once_flag asked;
    HamiltonianClaims claims;
  };
  std::shared_ptr<Known> known_;
};

/// What is split, as a scene asked for it: the Hamiltonian without the forces, constraints and letters of the scene.
struct SceneSplitting {
  std::string name;
  SceneValue effective;          ///< its own keys, defaults included
  SplittingClaims claims;        ///< without forces: `claims()`
  std::optional<double> c = {};  ///< speed of light, where its particles are relativistic [length/time]
  bool only_forces = false;      ///< p^2/2m and forces are all of it: methods for y' = f serve it too
  bool canonical = false;        ///< and move momenta m v + q A of charges in fields
  std::vector<SceneForce> own;   ///< those it has in itself, as such methods take them
  std::function<AnyHamiltonian<double>(ForceField<double>)> make;
  std::function<AnyHamiltonian<double>(ForceField<double>, ConstraintSet)> make_constrained;  ///< empty: it knows none
  std::function<AnyHamiltonian<Quad>(ForceField<Quad>)> make_wide;  ///< empty: it knows doubles only
};

/// Particles that constraints of one table tie: so many for each constraint.
using TiedParticles = std::vector<std::vector<Index>>;

/// The constraints of one table, as a scene asked for them.
struct SceneConstraint {
  std::string name;
  SceneValue effective;
  TiedParticles tied;
  std::function<void(ConstraintSet&, const ParticleSystem<double>&, const std::vector<Index>&)> add;
  /// Of one that finds its particles in a structure: fills in `tied` and `add`. `bonded` leaves out what it holds.
  std::function<void(SceneConstraint&, const ParticleSystem<double>&)> find = {};

  void add_to(ConstraintSet& set, const ParticleSystem<double>& s) const {
    for (const std::vector<Index>& particles : tied) add(set, s, particles);
  }
};

/// What monitors may ask of a run beside its particles: constraints, symmetries of its system, fields of charges, how
/// the system shares its momentum with a field, how small changes of its state go along, and the gravity that acts.
struct Watched {
  ConstraintSet constraints;
  std::vector<Symmetry> symmetries;
  ChargeMotion charges;
  MomentumSharing momenta;  ///< empty where it has none
  TangentFlows<double> tangents = {};
  ForceClaims gravity = {};  ///< of what attracts all pairs, with its G; not `kepler` where nothing does
};

/// A monitor as a scene asked for it.
struct SceneMonitor {
  std::string name;
  SceneValue effective;
  std::function<AnyMonitor<double>(const Watched&)> make;
  /// What it costs beside the run, in words, by coordinates and cadence [steps]; empty for what is not worth a word.
  std::function<std::string(Index, std::int64_t)> cost;
};

/// A condition that ends the run, as a scene asked for it.
struct SceneStop {
  std::string name;
  SceneValue effective;  ///< its table without a cadence, defaults included
  StopRule rule;
  std::int64_t steps = 1;  ///< between two looks
};

/// What stands around the integrator, as a scene asked for it.
struct SceneDecorator {
  std::string name;
  SceneValue effective;  ///< its table, defaults included
  std::function<AnyIntegrator<double>(AnyIntegrator<double>, const ConstraintSet&)> around;  ///< those of the run
  std::string path = {};  ///< of its table: "integrator.projection", "integrator.decorator.0"
  std::string cost = {};  ///< that it adds to a step, in words; empty for what is not worth a word
};

/// A first-order system as a scene asked for it.
struct SceneSystem {
  std::string name;
  SceneValue effective;          ///< its table, defaults included
  ParticleSystem<double> start;  ///< its variables and no particles
  std::function<std::unique_ptr<VectorField<double>>()> field;
  std::function<std::unique_ptr<VectorField<Quad>>()> wide_field;  ///< empty for a system that knows doubles only
  /// The closed solution, by time; empty where there is none, or the scene starts elsewhere or at another time.
  std::function<std::vector<double>(double)> exact;
  std::vector<Symmetry> symmetries = {};  ///< that it names
  MomentumSharing momenta = {};           ///< with a field; empty where it has none
};

namespace detail {
/// The values of `start = [...]`. @throws SceneError  unless there are as many as the system has variables
std::vector<double> read_start(const TableReader& reader, const SceneValue& list, Index size,
                               const std::vector<std::string>& names);

/// Ties the pairs of a structure that are held.
void find_held(SceneConstraint& constraint, const std::vector<HeldDistance>& distances);

/// Attaches a monitor or writer that looks as a scene says.
void attach(Simulation<double>& sim, const Cadence& cadence, AnyMonitor<double> monitor);
}  // namespace detail

/// What a force part is to methods that do not split: itself, unless `as_force` (found by its argument) makes one of
/// it.
template <class F> auto force_of(const F& part) {
  if constexpr (requires { as_force(part); }) {
    return as_force(part);
  } else {
    return part;
  }
}

/// A force as a scene would have asked for it, with its own defaults.
template <class F> SceneForce scene_force(const F& part, SceneValue effective = SceneValue::table()) {
  SceneForce made{std::string(part_name<F>()), std::move(effective), AnyForce<double>(force_of(part)), {}};
  if constexpr (requires(AnyHamiltonian<double> h) { with_letter(part, h); }) {
    made.letter = [part](AnyHamiltonian<double> h) { return AnyHamiltonian<double>(with_letter(part, std::move(h))); };
  }
  return made;
}

/// Hamiltonians, forces, constraints, thermostats, systems, methods, decorators, monitors and stops by name. A user's
/// own part is one line:
///
///     Parts parts = standard_parts();
///     parts.add_force<Oblateness>();
class Parts {
 public:
  struct HamiltonianKind {
    PartInfo info;
    std::function<SceneSplitting(TableReader&)> read;  ///< its own keys, among those that all Hamiltonians have
    std::vector<ColumnInfo> columns = {};              ///< that it gives particles
    bool needs_forces = false;                         ///< without forces or constraints nothing would move
    std::function<HamiltonianClaims()> claims = {};    ///< of the Hamiltonian with its defaults, without forces
  };
  struct ThermostatKind {
    PartInfo info;
    std::function<SceneThermostat(TableReader&)> read;
  };
  struct ForceKind {
    PartInfo info;
    std::function<SceneForce(TableReader&, const TiedParticles&)> read;
    std::size_t particles = 0;             ///< of each tuple that the force ties; 0: it acts on all
    std::vector<ColumnInfo> columns = {};  ///< that it gives particles
    ForceClaims claims = {};               ///< of the force with its defaults
    std::string only_once = {};            ///< why it does not stand twice in a scene; empty: it may
    bool about_heaviest = false;           ///< it takes particle 0 for the heaviest one
    bool field = false;                    ///< of charges: it stands in [[hamiltonian.field]]
    std::string masses_key = {};           ///< its flag of whether masses attract each other in it; empty: it has none
  };
  struct ConstraintKind {
    PartInfo info;
    std::size_t particles;  ///< of each constraint; 0: any number, or those that the structure tells
    std::function<SceneConstraint(TableReader&)> read;  ///< all but which particles
    Drawn drawn = Drawn::nothing;                       ///< in pictures
    bool of_structure = false;                          ///< it finds its particles itself: the table names none
  };
  struct SystemKind {
    PartInfo info;
    std::function<SceneSystem(TableReader&)> read;
  };
  struct DecoratorKind {
    PartInfo info;
    std::function<SceneDecorator(TableReader&)> read;
  };
  struct StopKind {
    PartInfo info;
    std::function<SceneStop(TableReader&)> read;
  };
  struct MonitorKind {
    PartInfo info;
    std::function<SceneMonitor(TableReader&)> read;
  };

  /// Makes Hamiltonian `H` known by the name it describes itself with; one of the same name is replaced. The first is
  /// the plain one, of p^2/2m and forces alone.
  ///
  /// `H` is a struct of parameters with `describe()`, its letters in it, and a member template that makes the splitting
  /// over any number type, with the forces of the scene in its kicks:
  ///
  ///     template <class Real> auto split(ForceField<Real> forces) const;                      // a SplitHamiltonian
  ///     template <class Real, class C> auto split(ForceField<Real>, C constraints) const;     // where it knows them
  ///     std::tuple<Gravity> forces() const;  // where p^2/2m, these and the scene's forces are all of it
  ///     using columns = ColumnList<Orientation, Spin>;  // that particles get, and bodies of scenes may have as keys
  template <class H> Parts& add_hamiltonian() {
    static_assert(Described<H>, "a Hamiltonian in a scene describes itself: static constexpr auto describe()");
    HamiltonianKind kind{part_info<H>(), [](TableReader& reader) { return read_splitting<H>(reader); },
                         columns_of<H>()};
    if constexpr (requires { H{}.forces(); }) kind.needs_forces = std::tuple_size_v<decltype(H{}.forces())> == 0;
    kind.claims = [] { return AnyHamiltonian<double>(H{}.template split<double>(ForceField<double>{})).claims(); };
    put(hamiltonians_, std::move(kind));
    return *this;
  }

  /// Makes thermostat `T` known by the name it describes itself with: a struct for which `with_letter(part, H)` makes a
  /// Hamiltonian with one more, irreversible letter.
  template <class T> Parts& add_thermostat() {
    static_assert(Described<T>, "a thermostat in a scene describes itself: static constexpr auto describe()");
    put(thermostats_, ThermostatKind{part_info<T>(), [](TableReader& reader) { return read_thermostat<T>(reader); }});
    return *this;
  }

  /// Makes force `F` known by the name it describes itself with; a force of the same name is replaced.
  ///
  /// One that acts on some particles only has `static constexpr std::size_t particles`, how many each of its terms
  /// ties, and a member `Tied<particles> tied` (engine/tied.hpp): scenes then say which, as for constraints.
  /// One that reads files has `void read_files(F&, TableReader&)`, found by its argument. One that is a letter of its
  /// own (drag) has `with_letter(part, H)`, and `as_force(part)` for methods that do not split.
  template <class F> Parts& add_force() {
    static_assert(Described<F>, "a force in a scene describes itself: static constexpr auto describe()");
    std::size_t particles = 0;
    if constexpr (requires { F{}.tied; }) particles = F::particles;
    ForceKind kind{part_info<F>(),
                   [](TableReader& reader, const TiedParticles& tied) { return read_force<F>(reader, tied); },
                   particles, columns_of<F>(), claims_of(force_of(F{}))};
    if constexpr (requires { F::only_once; }) kind.only_once = F::only_once;
    if constexpr (requires { F::about_heaviest; }) kind.about_heaviest = F::about_heaviest;
    if constexpr (requires { F::masses_key; }) kind.masses_key = F::masses_key;
    if constexpr (requires { F::is_field; }) kind.field = F::is_field;
    put(forces_, std::move(kind));
    return *this;
  }
  /// The same for a field that acts on charges (forces/electromagnetic_field.hpp), in [[hamiltonian.field]].
  template <class F> Parts& add_field() { return add_force<InField<F>>(); }

  /// Makes constraint `C` known by the name it describes itself with; one of the same name is replaced.
  template <Constraint C> Parts& add_constraint() {
    static_assert(Described<C>, "a constraint in a scene describes itself: static constexpr auto describe()");
    ConstraintKind kind{part_info<C>(), C::particles, [](TableReader& reader) { return read_constraint<C>(reader); }};
    if constexpr (requires { C::drawn; }) kind.drawn = C::drawn;
    put(constraints_, std::move(kind));
    return *this;
  }
  /// The same for one that finds its particles in a structure: a struct of parameters, `lengths` among them, with what
  /// it holds as `static constexpr RigidTerms what` (constraints/structure_constraints.hpp).
  template <class C> Parts& add_structure_constraint() {
    ConstraintKind kind{part_info<C>(), 0, [](TableReader& reader) { return read_structure_constraint<C>(reader); }};
    kind.of_structure = true;
    put(constraints_, std::move(kind));
    return *this;
  }
  /// The same for one that ties any number of particles, by several constraints.
  Parts& add_constraint(ConstraintKind kind) {
    put(constraints_, std::move(kind));
    return *this;
  }

  /// Makes system `S`, of first order, Hamiltonian, with a Lagrangian, or on a group, known by the name it describes
  /// itself with; one of the same name is replaced.
  template <class S>
  requires MovingSystem<S, double> Parts& add_system() {
    static_assert(Described<S>, "a system in a scene describes itself: static constexpr auto describe()");
    put(systems_, SystemKind{part_info<S>(), [](TableReader& reader) { return read_system<S>(reader); }});
    return *this;
  }

  /// Makes a method for y' = f known by its name, with the options that it brings; one of the same name is replaced.
  /// @param method  lives as long as scenes are read
  Parts& add_method(const MethodInfo& method);

  /// Makes decorator `D` known by the name it describes itself with: a struct of its parameters for which
  /// `around(part, I)` (found by its argument) makes an integrator around another one, see integrators/wrapped.hpp;
  /// one that has to know the constraints of the run takes them as well, `around(part, I, ConstraintSet)`. One of the
  /// same name is replaced.
  template <class D> Parts& add_decorator() {
    static_assert(Described<D>, "a decorator in a scene describes itself: static constexpr auto describe()");
    put(decorators_, DecoratorKind{part_info<D>(), [](TableReader& reader) { return read_decorator<D>(reader); }});
    return *this;
  }

  /// Makes monitor `M` known by the name it describes itself with; one of the same name is replaced.
  template <class M> Parts& add_monitor() {
    static_assert(Described<M>, "a monitor in a scene describes itself: static constexpr auto describe()");
    put(monitors_, MonitorKind{part_info<M>(), [](TableReader& reader) { return read_monitor<M>(reader); }});
    return *this;
  }

  /// Makes stop `S` known by the name it describes itself with: a struct of parameters, `steps` between two looks among
  /// them, with `StopRule rule() const`. One of the same name is replaced.
  template <class S> Parts& add_stop() {
    static_assert(Described<S>, "a stop in a scene describes itself: static constexpr auto describe()");
    put(stops_, StopKind{part_info<S>(), [](TableReader& reader) { return read_stop<S>(reader); }});
    return *this;
  }

  const std::vector<HamiltonianKind>& hamiltonians() const { return hamiltonians_; }
  const std::vector<ThermostatKind>& thermostats() const { return thermostats_; }
  const std::vector<ForceKind>& forces() const { return forces_; }
  const std::vector<ConstraintKind>& constraints() const { return constraints_; }
  const std::vector<SystemKind>& systems() const { return systems_; }
  const std::vector<MonitorKind>& monitors() const { return monitors_; }
  const std::vector<StopKind>& stops() const { return stops_; }
  const std::vector<DecoratorKind>& decorators() const { return decorators_; }
  const std::vector<const MethodInfo*>& methods() const { return methods_; }

  /// The method for y' = f of a name or an alias; null if there is none.
  const MethodInfo* find_method(std::string_view name) const;
  /// Names and aliases of all schemes and methods: what a misspelt name may have meant.
  std::vector<std::string> method_names() const;
  /// Every group of options that some method takes, once.
  std::vector<const OptionGroup*> method_options() const;

 private:
  template <class H> static SceneSplitting read_splitting(TableReader& reader) {
    H part{};
    read_fields(reader, part);
    reader.finish();  // a misspelt key is told before the one that it should have been
    SceneSplitting made;
    made.name = part_name<H>();
    made.effective = SceneValue::table();
    put_fields(reader, part, made.effective);
    made.make = [part](ForceField<double> forces) {
      return AnyHamiltonian<double>(part.template split<double>(std::move(forces)));
    };
    if constexpr (requires(ForceField<double> f, ConstraintSet c) { part.template split<double>(f, c); }) {
      made.make_constrained = [part](ForceField<double> forces, ConstraintSet constraints) {
        return AnyHamiltonian<double>(part.template split<double>(std::move(forces), std::move(constraints)));
      };
    }
    if constexpr (requires(ForceField<Quad> f) { part.template split<Quad>(f); }) {
      made.make_wide = [part](ForceField<Quad> forces) {
        return AnyHamiltonian<Quad>(part.template split<Quad>(std::move(forces)));
      };
    }
    if constexpr (requires { part.forces(); }) {
      made.only_forces = true;
      if constexpr (requires { part.only_forces(); }) made.only_forces = part.only_forces();
      std::apply([&](const auto&... own) { (made.own.push_back(scene_force(own, set_fields(reader, own))), ...); },
                 part.forces());
    }
    if constexpr (requires { part.canonical; }) made.canonical = part.canonical;
    detail::check_fields(reader, part);
    if constexpr (requires { part.light(*reader.context().units); }) {
      try {
        made.c = part.light(*reader.context().units);
      } catch (const Error& error) {
        reader.refuse(error);
      }
    }
    made.claims = SplittingClaims([make = made.make] { return make({}).claims(); });
    return made;
  }

  /// The fields of a part that differ from their defaults, as a scene would set them.
  template <class F> static SceneValue set_fields(TableReader& reader, const F& part) {
    SceneValue all = SceneValue::table(), usual = SceneValue::table(), set = SceneValue::table();
    put_fields(reader, part, all);
    put_fields(reader, F{}, usual);
    for (const auto& [key, value] : *all.get<SceneValue::Table>()) {
      const SceneValue* other = usual.find(key);
      if (other == nullptr || to_text(*other) != to_text(value)) set.put(key, value);
    }
    return set;
  }

  template <class T> static SceneThermostat read_thermostat(TableReader& reader) {
    T part{};
    read_part(reader, part);
    SceneThermostat made{std::string(part_name<T>()), SceneValue::table(), {}};
    put_fields(reader, part, made.effective);
    made.letter = [part](AnyHamiltonian<double> h) { return AnyHamiltonian<double>(with_letter(part, std::move(h))); };
    return made;
  }

  template <class F> static SceneForce read_force(TableReader& reader, const TiedParticles& tied) {
    F force{};
    read_part(reader, force);
    if constexpr (requires { read_files(force, reader); }) read_files(force, reader);
    if constexpr (requires { force.tied; }) {
      for (const std::vector<Index>& particles : tied) {
        std::copy(particles.begin(), particles.end(), force.tied.emplace_back().begin());
      }
    }
    SceneValue effective = SceneValue::table();
    put_fields(reader, force, effective);
    return scene_force(force, std::move(effective));
  }

  template <class C> static SceneConstraint read_constraint(TableReader& reader) {
    C constraint{};
    read_part(reader, constraint);
    SceneConstraint made{std::string(part_name<C>()), SceneValue::table(), {}, {}};
    put_fields(reader, constraint, made.effective);
    made.add = [constraint](ConstraintSet& set, const ParticleSystem<double>& s, const std::vector<Index>& particles) {
      std::array<Index, C::particles> tied{};
      std::copy(particles.begin(), particles.end(), tied.begin());
      set.add(s, constraint, tied);
    };
    return made;
  }

  template <class C> static SceneConstraint read_structure_constraint(TableReader& reader) {
    C constraint{};
    read_part(reader, constraint);
    SceneConstraint made{std::string(part_name<C>()), SceneValue::table(), {}, {}};
    put_fields(reader, constraint, made.effective);
    made.find = [constraint](SceneConstraint& found, const ParticleSystem<double>& s) {
      detail::find_held(found, held_distances(s, C::what, constraint.lengths));
    };
    return made;
  }

  template <class S> static SceneSystem read_system(TableReader& reader) {
    const SceneValue* start = reader.find("start");
    S system{};
    read_part(reader, system);
    SceneSystem made;
    made.name = part_name<S>();
    made.effective = SceneValue::table();
    put_fields(reader, system, made.effective);
    std::vector<std::string> names;
    if constexpr (requires { system.names(); }) names = system.names();
    std::vector<double> values;
    if (start != nullptr) {
      values = detail::read_start(reader, *start, detail::variable_count(system), names);
      made.effective.put("start", *start);
    } else if constexpr (requires { system.start(); }) {
      const double begin = reader.context().start_time;
      values = system.start();
      if constexpr (requires { system.start_at(begin); }) values = system.start_at(begin);
      if constexpr (requires { system.exact(0.0); }) {
        const bool there = begin == 0 || requires { system.start_at(begin); };
        if (there) made.exact = [system](double t) { return system.exact(t); };
      }
    } else {
      reader.fail(nullptr, "start", fmt::format("{} has no start; give start = [...]", reader.what()));
    }
    made.start = initial_state(system, std::move(values), *reader.context().units);
    if constexpr (requires { system.symmetries(); }) made.symmetries = system.symmetries();
    if constexpr (requires { system.momentum_sharing(); }) made.momenta = system.momentum_sharing();
    made.field = [system] { return std::make_unique<typename detail::MotionOf<S, double>::type>(system); };
    if constexpr (MovingSystem<S, Quad>) {
      made.wide_field = [system] { return std::make_unique<typename detail::MotionOf<S, Quad>::type>(system); };
    }
    return made;
  }

  template <class M> static SceneMonitor read_monitor(TableReader& reader) {
    M monitor{};
    read_part(reader, monitor);
    if constexpr (requires(const ForceClaims& gravity) { monitor.watch(gravity); }) {
      if (!reader.has("G")) monitor.G.reset();  // a scene may have a constant though nothing attracts
    }
    SceneMonitor made{std::string(part_name<M>()), SceneValue::table(), {}, {}};
    put_fields(reader, monitor, made.effective);
    made.make = [monitor](const Watched& of) {
      M watching = monitor;
      if constexpr (requires { watching.watch(of.constraints); }) watching.watch(of.constraints);
      if constexpr (requires { watching.watch(of.symmetries); }) watching.watch(of.symmetries);
      if constexpr (requires { watching.watch(of.charges); }) watching.watch(of.charges);
      if constexpr (requires { watching.watch(of.momenta); }) watching.watch(of.momenta);
      if constexpr (requires { watching.watch(of.gravity); }) watching.watch(of.gravity);
      if constexpr (requires { watching.watch(of.tangents); }) {
        if (of.tangents.make) watching.watch(of.tangents);
      }
      return AnyMonitor<double>(std::move(watching));
    };
    if constexpr (requires { monitor.cost(Index(1), std::int64_t{1}); }) {
      made.cost = [monitor](Index coordinates, std::int64_t cadence) { return monitor.cost(coordinates, cadence); };
    }
    return made;
  }

  template <class D> static SceneDecorator read_decorator(TableReader& reader) {
    D part{};
    read_part(reader, part);
    SceneDecorator made{std::string(part_name<D>()), SceneValue::table(), {}};
    put_fields(reader, part, made.effective);
    if constexpr (requires { part.cost(); }) made.cost = part.cost();
    made.around = [part](AnyIntegrator<double> inside, const ConstraintSet& constraints) {
      if constexpr (requires { around(part, std::move(inside), constraints); }) {
        return AnyIntegrator<double>(around(part, std::move(inside), constraints));
      } else {
        return AnyIntegrator<double>(around(part, std::move(inside)));
      }
    };
    return made;
  }

  template <class S> static SceneStop read_stop(TableReader& reader) {
    S stop{};
    read_part(reader, stop);
    SceneStop made{std::string(part_name<S>()), SceneValue::table(), stop.rule(), stop.steps};
    put_fields(reader, stop, made.effective);
    return made;
  }

  template <class Kind> static void put(std::vector<Kind>& kinds, Kind kind) {
    for (Kind& known : kinds) {
      if (known.info.name != kind.info.name) continue;
      known = std::move(kind);
      return;
    }
    kinds.push_back(std::move(kind));
  }

  std::vector<HamiltonianKind> hamiltonians_;
  std::vector<ThermostatKind> thermostats_;
  std::vector<ForceKind> forces_;
  std::vector<ConstraintKind> constraints_;
  std::vector<SystemKind> systems_;
  std::vector<MonitorKind> monitors_;
  std::vector<StopKind> stops_;
  std::vector<DecoratorKind> decorators_;
  std::vector<const MethodInfo*> methods_;
};

/// Every Hamiltonian, force, constraint, thermostat, system, method, monitor and stop of noether.
Parts standard_parts();

/// What the writers say of themselves: they stand in `[[every]]` like monitors.
std::vector<PartInfo> writer_parts();
/// What no list has: the kind of each, and what it says of itself.
std::vector<std::pair<std::string, PartInfo>> other_parts();

}  // namespace noether
