#pragma once
/// The parts a scene may name: each is one type that describes itself.

#include "constraints/constraint_set.hpp"
#include "engine/any_force.hpp"
#include "engine/simulation.hpp"
#include "forces/linear_drag.hpp"
#include "integrators/first_order_system.hpp"
#include "scene/fields.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace noether {

/// When a monitor looks: every so many steps, every so much time, or every so many seconds of wall time.
struct Cadence {
  std::int64_t steps = 0;
  double wall = 0;      ///< [s]; 0: not by wall time
  double interval = 0;  ///< [time], where the method chooses the steps; 0: by steps
};

/// A force as a scene asked for it.
struct SceneForce {
  std::string name;
  SceneValue effective;                   ///< its table, defaults included
  std::optional<AnyForce<double>> force;  ///< empty for drag, which becomes a letter
  std::optional<LinearDrag> drag;
};

/// Particles that constraints of one table tie: so many for each constraint.
using TiedParticles = std::vector<std::vector<Index>>;

/// The constraints of one table, as a scene asked for them.
struct SceneConstraint {
  std::string name;
  SceneValue effective;
  TiedParticles tied;
  std::function<void(ConstraintSet&, const ParticleSystem<double>&, const std::vector<Index>&)> add;

  void add_to(ConstraintSet& set, const ParticleSystem<double>& s) const {
    for (const std::vector<Index>& particles : tied) add(set, s, particles);
  }
};

/// A monitor as a scene asked for it.
struct SceneMonitor {
  std::string name;
  SceneValue effective;
  std::function<void(Simulation<double>&, const Cadence&, const ConstraintSet&)> attach;
  /// What it costs beside the run, in words, by particles and cadence [steps]; empty for what is not worth a word.
  std::function<std::string(Index, std::int64_t)> cost;
};

/// A first-order system as a scene asked for it.
struct SceneSystem {
  std::string name;
  SceneValue effective;          ///< its table, defaults included
  ParticleSystem<double> start;  ///< its variables and no particles
  std::function<std::unique_ptr<VectorField<double>>()> field;
  std::function<std::unique_ptr<VectorField<Quad>>()> wide_field;  ///< empty for a system that knows doubles only
  /// The closed solution, by time; empty where there is none, or the scene starts elsewhere.
  std::function<std::vector<double>(double)> exact;
};

namespace detail {
/// The values of `start = [...]`. @throws SceneError  unless there are as many as the system has variables
std::vector<double> read_start(const TableReader& reader, const SceneValue& list, Index size,
                               const std::vector<std::string>& names);

template <class M> void attach(Simulation<double>& sim, const Cadence& cadence, const M& monitor) {
  if (cadence.wall > 0) {
    sim.every_wall(cadence.wall, monitor);
  } else if (cadence.interval != 0) {
    sim.every_time(cadence.interval, monitor);
  } else {
    sim.every(cadence.steps, monitor);
  }
}
}  // namespace detail

/// Forces, constraints, systems and monitors by name. A user's own part is one line:
///
///     Parts parts = standard_parts();
///     parts.add_force<Oblateness>();
class Parts {
 public:
  struct ForceKind {
    PartInfo info;
    std::function<SceneForce(TableReader&, const TiedParticles&)> read;
    std::size_t particles = 0;  ///< of each tuple that the force ties; 0: it acts on all
  };
  struct ConstraintKind {
    PartInfo info;
    std::size_t particles;                              ///< of each constraint; 0: any number
    std::function<SceneConstraint(TableReader&)> read;  ///< all but which particles
  };
  struct SystemKind {
    PartInfo info;
    std::function<SceneSystem(TableReader&)> read;
  };
  struct MonitorKind {
    PartInfo info;
    std::function<SceneMonitor(TableReader&)> read;
  };

  /// Makes force `F` known by the name it describes itself with; a force of the same name is replaced.
  ///
  /// One that acts on some particles only has `static constexpr std::size_t particles`, how many each of its terms
  /// ties, and a member `std::vector<std::array<Index, particles>> tied`: scenes then say which, as for constraints.
  template <class F> Parts& add_force() {
    static_assert(Described<F>, "a force in a scene describes itself: static constexpr auto describe()");
    std::size_t particles = 0;
    if constexpr (requires { F{}.tied; }) particles = F::particles;
    put(forces_, ForceKind{part_info<F>(),
                           [](TableReader& reader, const TiedParticles& tied) { return read_force<F>(reader, tied); },
                           particles});
    return *this;
  }

  /// Makes constraint `C` known by the name it describes itself with; one of the same name is replaced.
  template <Constraint C> Parts& add_constraint() {
    static_assert(Described<C>, "a constraint in a scene describes itself: static constexpr auto describe()");
    put(constraints_,
        ConstraintKind{part_info<C>(), C::particles, [](TableReader& reader) { return read_constraint<C>(reader); }});
    return *this;
  }
  /// The same for one that ties any number of particles, by several constraints.
  Parts& add_constraint(ConstraintKind kind) {
    put(constraints_, std::move(kind));
    return *this;
  }

  /// Makes first-order system `S` known by the name it describes itself with; one of the same name is replaced.
  template <class S>
  requires FirstOrderSystem<S, double> Parts& add_system() {
    static_assert(Described<S>, "a system in a scene describes itself: static constexpr auto describe()");
    put(systems_, SystemKind{part_info<S>(), [](TableReader& reader) { return read_system<S>(reader); }});
    return *this;
  }

  /// Makes monitor `M` known by the name it describes itself with; one of the same name is replaced.
  template <class M> Parts& add_monitor() {
    static_assert(Described<M>, "a monitor in a scene describes itself: static constexpr auto describe()");
    put(monitors_, MonitorKind{part_info<M>(), [](TableReader& reader) { return read_monitor<M>(reader); }});
    return *this;
  }

  const std::vector<ForceKind>& forces() const { return forces_; }
  const std::vector<ConstraintKind>& constraints() const { return constraints_; }
  const std::vector<SystemKind>& systems() const { return systems_; }
  const std::vector<MonitorKind>& monitors() const { return monitors_; }

 private:
  template <class F> static SceneForce read_force(TableReader& reader, const TiedParticles& tied) {
    F force{};
    read_part(reader, force);
    if constexpr (requires { force.tied; }) {
      for (const std::vector<Index>& particles : tied) {
        std::copy(particles.begin(), particles.end(), force.tied.emplace_back().begin());
      }
    }
    SceneForce made{std::string(part_name<F>()), SceneValue::table(), {}, {}};
    put_fields(reader, force, made.effective);
    if constexpr (std::is_same_v<F, LinearDrag>) {
      made.drag = force;
    } else {
      made.force = AnyForce<double>(force);
    }
    return made;
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
      values = detail::read_start(reader, *start, system.size(), names);
      made.effective.put("start", *start);
    } else if constexpr (requires { system.start(); }) {
      values = system.start();
      if constexpr (requires { system.exact(0.0); }) made.exact = [system](double t) { return system.exact(t); };
    } else {
      reader.fail(nullptr, "start", fmt::format("{} does not say where to start; give start = [...]", reader.what()));
    }
    made.start = initial_state(system, std::move(values), *reader.context().units);
    made.field = [system] { return std::make_unique<SystemMotion<S, double>>(system); };
    if constexpr (FirstOrderSystem<S, Quad>) {
      made.wide_field = [system] { return std::make_unique<SystemMotion<S, Quad>>(system); };
    }
    return made;
  }

  template <class M> static SceneMonitor read_monitor(TableReader& reader) {
    M monitor{};
    read_part(reader, monitor);
    SceneMonitor made{std::string(part_name<M>()), SceneValue::table(), {}, {}};
    put_fields(reader, monitor, made.effective);
    made.attach = [monitor](Simulation<double>& sim, const Cadence& cadence, const ConstraintSet& constraints) {
      M attached = monitor;
      if constexpr (requires { attached.watch(constraints); }) attached.watch(constraints);
      detail::attach(sim, cadence, attached);
    };
    if constexpr (requires { monitor.cost(Index(1), std::int64_t{1}); }) {
      made.cost = [monitor](Index particles, std::int64_t cadence) { return monitor.cost(particles, cadence); };
    }
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

  std::vector<ForceKind> forces_;
  std::vector<ConstraintKind> constraints_;
  std::vector<SystemKind> systems_;
  std::vector<MonitorKind> monitors_;
};

/// Every force, constraint, system and monitor of noether.
Parts standard_parts();

/// What the writers say of themselves: they stand in `[[every]]` like monitors.
std::vector<PartInfo> writer_parts();
/// What the conditions that end a run say of themselves: they stand in `[[stop]]`.
std::vector<PartInfo> stop_parts();

/// Steps between two looks unless a scene says otherwise: an escape is seen late as well as early, a collision is found
/// between two looks only if they are close.
inline constexpr std::int64_t default_escape_steps = 100, default_collision_steps = 1;

/// What the Hamiltonians say of themselves.
std::vector<PartInfo> hamiltonian_parts();

}  // namespace noether
