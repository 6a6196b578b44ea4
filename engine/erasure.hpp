#pragma once
/// The erased seams AnyHamiltonian and AnyIntegrator. (AnyForce is in engine/any_force.hpp, AnyMonitor in
/// engine/monitor.hpp.) Each satisfies its own concept, so a scene is one more instantiation of the same templates.

#include "engine/any_force.hpp"
#include "engine/concepts.hpp"
#include "engine/word.hpp"

#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace noether {

namespace detail {

/// Writes the state a part declares by its description, or by `save` of its own. What stands around another part
/// (integrators/wrapped.hpp) is written with its fields, and then the one inside.
template <class T> void save_any(SavedState& saved, const std::string& prefix, const T& value) {
  if constexpr (requires { value.save(saved, prefix); }) {
    value.save(saved, prefix);
  } else {
    if constexpr (requires { value.inside(); } && Described<T>) save_signature(saved, prefix, value);
    save_part(saved, prefix, value);
    if constexpr (requires { value.inside(); }) save_any(saved, prefix + "inside/", value.inside());
  }
}
/// @throws Error  if something is missing, or was saved around a part by one with other fields
template <class T> void load_any(const SavedState& saved, const std::string& prefix, T& value) {
  if constexpr (requires { value.load(saved, prefix); }) {
    value.load(saved, prefix);
  } else {
    if constexpr (requires { value.inside(); } && Described<T>) check_signature(saved, prefix, value);
    load_part(saved, prefix, value);
    if constexpr (requires { value.inside(); }) load_any(saved, prefix + "inside/", value.inside());
  }
}

/// The virial of what moves particles; empty for a type that knows none.
template <class T, class Real> std::optional<Mat3<Real>> virial_of(T& moves, const ParticleSystem<Real>& s) {
  if constexpr (requires { moves.virial(s); }) return moves.virial(s);
  return {};
}

/// The energy of particles with all digits of their second words; empty where nobody computes it.
template <class T, class Real>
std::optional<EnergyTerms<Quad>> wide_energy_of(T& moves, const ParticleSystem<Real>& s) {
  if constexpr (requires { moves.wide_energy(s); }) return moves.wide_energy(s);
  return {};
}

/// Asks a Hamiltonian to look for neighbors in its own way. @return whether it does
template <class H> bool set_neighbor_options(H& hamiltonian, const NeighborOptions& options) {
  if constexpr (requires { hamiltonian.set_neighbor_options(options); }) {
    using Result = decltype(hamiltonian.set_neighbor_options(options));
    if constexpr (std::is_same_v<Result, bool>) return hamiltonian.set_neighbor_options(options);
    hamiltonian.set_neighbor_options(options);
    return true;
  }
  return false;
}

/// Whether flows of other letters may have their velocities brought back along its constraints.
template <class H> bool can_project(const H& hamiltonian) {
  if constexpr (requires { hamiltonian.can_project(); }) return hamiltonian.can_project();
  return requires(H & h, ParticleSystem<typename H::real> & s, const typename H::real& tau) {
    h.project_velocities(s, tau);
  };
}
/// Brings velocities back along the constraints; nothing where there are none.
template <class H, class Real> void project_velocities(H& hamiltonian, ParticleSystem<Real>& s, const Real& h) {
  if constexpr (requires { hamiltonian.project_velocities(s, h); }) hamiltonian.project_velocities(s, h);
}

/// Tells what moves particles how long the longest kick of a step is [time], if it wants to know.
template <class T> void expect_kicks(T& moves, double longest) {
  if constexpr (requires { moves.expect_kicks(longest); }) moves.expect_kicks(longest);
}

NOETHER_FINDS_MEMBER(virial, viral, viriel, virail, vrial, viiral, viriall)
NOETHER_FINDS_MEMBER(can_project, can_porject, can_projcet, can_projects, can_proejct, can_poject, can_prject)
NOETHER_FINDS_MEMBER(project_velocities, project_velocites, project_velocity, project_velocitys, project_velocties,
                     project_velcities, project_velocitites)
NOETHER_FINDS_MEMBER(expect_kicks, expect_kick, expects_kicks, expect_kciks, expcet_kicks, exepct_kicks, except_kicks)
NOETHER_FINDS_MEMBER(set_neighbor_options, set_neighbour_options, set_neigbor_options, set_neighbor_option,
                     set_neighbors_options, set_neigbour_options, set_neighbor_opitons)
NOETHER_FINDS_MEMBER(has_action, has_aciton, has_actoin, has_actions, has_acton, have_action, hsa_action)
NOETHER_FINDS_MEMBER(advance_with_action, advance_with_actions, advance_with_acton, advance_with_actoin,
                     advance_with_aciton, advances_with_action, advance_whit_action)
NOETHER_FINDS_MEMBER(wide_energy, wide_enregy, wide_enery, wide_energies, wide_enegry, wide_engery, wied_energy)

template <class T>
concept GivesVirial = requires(T& moves, const ParticleSystem<typename T::real>& s) {
  { moves.virial(s) } -> std::convertible_to<std::optional<Mat3<typename T::real>>>;
};
template <class H>
concept SaysWhetherItProjects = requires(const H& hamiltonian) {
  { hamiltonian.can_project() } -> std::convertible_to<bool>;
};
template <class H>
concept ProjectsVelocities = requires(H& hamiltonian, ParticleSystem<typename H::real>& s,
                                      const typename H::real& tau) {
  hamiltonian.project_velocities(s, tau);
};
template <class H>
concept ExpectsKicks = requires(H& hamiltonian, double longest) {
  hamiltonian.expect_kicks(longest);
};
template <class H>
concept TakesNeighborOptions = requires(H& hamiltonian, const NeighborOptions& options) {
  hamiltonian.set_neighbor_options(options);
};

/// Whether each optional member of a Hamiltonian, where there is one of its name, is what it has to be.
template <class H> struct HamiltonianMembers {
  static constexpr bool virial = !misspells_virial<H>() && (!finds_virial<H>() || GivesVirial<H>);
  static constexpr bool can_project =
      !misspells_can_project<H>() && (!finds_can_project<H>() || SaysWhetherItProjects<H>);
  static constexpr bool project_velocities =
      !misspells_project_velocities<H>() && (!finds_project_velocities<H>() || ProjectsVelocities<H>);
  static constexpr bool expect_kicks = !misspells_expect_kicks<H>() && (!finds_expect_kicks<H>() || ExpectsKicks<H>);
  static constexpr bool neighbor_options =
      !misspells_set_neighbor_options<H>() && (!finds_set_neighbor_options<H>() || TakesNeighborOptions<H>);
};

template <class Real> struct HamiltonianBase {
  virtual ~HamiltonianBase() = default;
  virtual std::unique_ptr<HamiltonianBase> clone() const = 0;
  virtual HamiltonianClaims claims() const = 0;
  virtual std::string name() const = 0;
  virtual void bind(ParticleSystem<Real>&) = 0;
  virtual void expect_kicks(double) = 0;
  virtual bool set_neighbor_options(const NeighborOptions&) = 0;
  virtual bool can_project() const = 0;
  virtual void project_velocities(ParticleSystem<Real>&, const Real&) = 0;
  virtual void open(ParticleSystem<Real>&) = 0;
  virtual void close(ParticleSystem<Real>&) = 0;
  virtual void flow(char, ParticleSystem<Real>&, const Real&) = 0;
  virtual Real flow_with_action(char, ParticleSystem<Real>&, const Real&) = 0;
  virtual Advance run(const TimedWord<Real>&, ParticleSystem<Real>&, const Span&) = 0;
  virtual EnergyTerms<Real> energy(const ParticleSystem<Real>&) = 0;
  virtual std::optional<Mat3<Real>> virial(const ParticleSystem<Real>&) = 0;
  virtual void accelerations(const ParticleSystem<Real>&, VectorColumn<Real>&) = 0;
  virtual void observe(std::optional<Request>) = 0;
  virtual const std::optional<Failure>& failure() const = 0;
  virtual Evaluations evaluations() const = 0;
  virtual void save(SavedState&, const std::string&) const = 0;
  virtual void load(const SavedState&, const std::string&) = 0;
};
template <class H> struct HamiltonianModel final : HamiltonianBase<typename H::real> {
  using Real = typename H::real;
  using Members = HamiltonianMembers<H>;
  static_assert(Members::virial,
                "a Hamiltonian has `Mat3<Real> virial(const ParticleSystem<Real>&)`, which may be "
                "optional, or no member of that name or nearly that name");
  static_assert(Members::can_project,
                "a Hamiltonian has `bool can_project() const`, or no member of that name or nearly that name");
  static_assert(Members::project_velocities,
                "a Hamiltonian has `void project_velocities(ParticleSystem<Real>&, const "
                "Real&)`, or no member of that name or nearly that name");
  static_assert(Members::expect_kicks,
                "a Hamiltonian has `void expect_kicks(double)`, or no member of that name or nearly that name");
  static_assert(Members::neighbor_options,
                "a Hamiltonian has `void set_neighbor_options(const NeighborOptions&)`, "
                "or no member of that name or nearly that name");
  explicit HamiltonianModel(H h) : hamiltonian(std::move(h)) {}
  std::unique_ptr<HamiltonianBase<Real>> clone() const override {
    return std::make_unique<HamiltonianModel>(hamiltonian);
  }
  HamiltonianClaims claims() const override { return hamiltonian.claims(); }
  std::string name() const override { return name_of(hamiltonian); }
  void bind(ParticleSystem<Real>& s) override { hamiltonian.bind(s); }
  void expect_kicks(double longest) override { detail::expect_kicks(hamiltonian, longest); }
  bool set_neighbor_options(const NeighborOptions& o) override { return detail::set_neighbor_options(hamiltonian, o); }
  bool can_project() const override { return detail::can_project(hamiltonian); }
  void project_velocities(ParticleSystem<Real>& s, const Real& h) override {
    detail::project_velocities(hamiltonian, s, h);
  }
  void open(ParticleSystem<Real>& s) override { hamiltonian.open(s); }
  void close(ParticleSystem<Real>& s) override { hamiltonian.close(s); }
  void flow(char letter, ParticleSystem<Real>& s, const Real& h) override { hamiltonian.flow(letter, s, h); }
  Real flow_with_action(char letter, ParticleSystem<Real>& s, const Real& h) override {
    return hamiltonian.flow_with_action(letter, s, h);
  }
  Advance run(const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span) override {
    return walk(hamiltonian, word, s, span);
  }
  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) override { return hamiltonian.energy(s); }
  std::optional<Mat3<Real>> virial(const ParticleSystem<Real>& s) override { return virial_of(hamiltonian, s); }
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) override { hamiltonian.accelerations(s, a); }
  void observe(std::optional<Request> wanted) override { hamiltonian.observe(wanted); }
  const std::optional<Failure>& failure() const override { return hamiltonian.failure(); }
  Evaluations evaluations() const override { return hamiltonian.evaluations(); }
  void save(SavedState& saved, const std::string& prefix) const override { save_any(saved, prefix, hamiltonian); }
  void load(const SavedState& saved, const std::string& prefix) override { load_any(saved, prefix, hamiltonian); }
  H hamiltonian;
};

template <class I>
concept GivesAction = requires(I& i, ParticleSystem<typename I::real>& s, const Span& span, typename I::real& action) {
  i.advance_with_action(s, span, action);
};
/// Whether an integrator offers `advance_with_action`.
template <class I> bool has_action(const I& integrator) {
  if constexpr (requires { integrator.has_action(); }) return integrator.has_action();
  return GivesAction<I>;
}
/// @throws LogicError  if it does not
template <class I, class Real>
Advance advance_with_action(I& integrator, ParticleSystem<Real>& s, const Span& span, Real& action) {
  if constexpr (GivesAction<I>) return integrator.advance_with_action(s, span, action);
  throw LogicError("the action was requested from a method that does not compute it");
}
/// Completes a copy. @return the action of the flows that do, if wanted; 0 for a method that gives none
template <class I, class Real>
Real settle(I& integrator, const ParticleSystem<Real>& raw, ParticleSystem<Real>& out, Request wanted,
            const std::optional<double>& at, bool corrected) {
  if constexpr (GivesAction<I>) return integrator.settle(raw, out, wanted, at, corrected);
  integrator.settle(raw, out, wanted, at, corrected);
  return Real(0);
}

template <class R, class C, class... A> std::type_identity<C> written_in(R (C::*)(A...));
template <class R, class C, class... A> std::type_identity<C> written_in(R (C::*)(A...) const);

/// Whether what stands around an integrator and advances in its own way says so of steps with their action as well.
template <class I> constexpr bool action_follows() {
  if constexpr (requires(I & i) {
                  i.inside();
                  written_in(&I::advance);
                  written_in(&I::advance_with_action);
                  written_in(&I::has_action);
                }) {
    using Advances = decltype(written_in(&I::advance));
    using WithAction = decltype(written_in(&I::advance_with_action));
    return std::is_same_v<Advances, WithAction> || !std::is_same_v<decltype(written_in(&I::has_action)), WithAction>;
  }
  return true;
}

template <class I>
concept SaysWhetherItHasAction = requires(const I& integrator) {
  { integrator.has_action() } -> std::convertible_to<bool>;
};
template <class I>
concept GivesWideEnergy = requires(I& integrator, const ParticleSystem<typename I::real>& s) {
  { integrator.wide_energy(s) } -> std::convertible_to<std::optional<EnergyTerms<Quad>>>;
};

/// Whether each optional member of an integrator, where there is one of its name, is what it has to be.
template <class I> struct IntegratorMembers {
  static constexpr bool virial = !misspells_virial<I>() && (!finds_virial<I>() || GivesVirial<I>);
  static constexpr bool has_action =
      !misspells_has_action<I>() && (!finds_has_action<I>() || SaysWhetherItHasAction<I>);
  static constexpr bool advance_with_action =
      !misspells_advance_with_action<I>() && (!finds_advance_with_action<I>() || GivesAction<I>);
  static constexpr bool wide_energy = !misspells_wide_energy<I>() && (!finds_wide_energy<I>() || GivesWideEnergy<I>);
};

template <class Real> struct IntegratorBase {
  virtual ~IntegratorBase() = default;
  virtual std::unique_ptr<IntegratorBase> clone() const = 0;
  virtual IntegratorClaims claims() const = 0;
  virtual void bind(ParticleSystem<Real>&) = 0;
  virtual Advance advance(ParticleSystem<Real>&, const Span&) = 0;
  virtual bool has_action() const = 0;
  virtual Advance advance_with_action(ParticleSystem<Real>&, const Span&, Real&) = 0;
  virtual Real settle(const ParticleSystem<Real>&, ParticleSystem<Real>&, Request, const std::optional<double>&,
                      bool) = 0;
  virtual EnergyTerms<Real> energy(const ParticleSystem<Real>&) = 0;
  virtual std::optional<EnergyTerms<Quad>> wide_energy(const ParticleSystem<Real>&) = 0;
  virtual std::optional<Mat3<Real>> virial(const ParticleSystem<Real>&) = 0;
  virtual void accelerations(const ParticleSystem<Real>&, VectorColumn<Real>&) = 0;
  virtual Evaluations evaluations() const = 0;
  virtual void save(SavedState&, const std::string&) const = 0;
  virtual void load(const SavedState&, const std::string&) = 0;
};
template <class I> struct IntegratorModel final : IntegratorBase<typename I::real> {
  using Real = typename I::real;
  using Members = IntegratorMembers<I>;
  static_assert(Members::virial,
                "an integrator has `Mat3<Real> virial(const ParticleSystem<Real>&)`, which may be "
                "optional, or no member of that name or nearly that name");
  static_assert(Members::has_action,
                "an integrator has `bool has_action() const`, or no member of that name or nearly that name");
  static_assert(Members::advance_with_action,
                "an integrator has `Advance advance_with_action(ParticleSystem<Real>&, "
                "const Span&, Real&)`, or no member of that name or nearly that name");
  static_assert(Members::wide_energy,
                "an integrator has `EnergyTerms<Quad> wide_energy(const ParticleSystem<Real>&)`, "
                "which may be optional, or no member of that name or nearly that name");
  static_assert(action_follows<I>(),
                "a wrapper of an integrator that has its own `advance` needs its own `advance_with_action` too, or a "
                "`has_action` that returns false");
  explicit IntegratorModel(I i) : integrator(std::move(i)) {}
  std::unique_ptr<IntegratorBase<Real>> clone() const override { return std::make_unique<IntegratorModel>(integrator); }
  IntegratorClaims claims() const override { return integrator.claims(); }
  void bind(ParticleSystem<Real>& s) override { integrator.bind(s); }
  Advance advance(ParticleSystem<Real>& s, const Span& span) override { return integrator.advance(s, span); }
  bool has_action() const override { return detail::has_action(integrator); }
  Advance advance_with_action(ParticleSystem<Real>& s, const Span& span, Real& action) override {
    return detail::advance_with_action(integrator, s, span, action);
  }
  Real settle(const ParticleSystem<Real>& raw, ParticleSystem<Real>& out, Request wanted,
              const std::optional<double>& at, bool corrected) override {
    return detail::settle(integrator, raw, out, wanted, at, corrected);
  }
  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) override { return integrator.energy(s); }
  std::optional<EnergyTerms<Quad>> wide_energy(const ParticleSystem<Real>& s) override {
    return wide_energy_of(integrator, s);
  }
  std::optional<Mat3<Real>> virial(const ParticleSystem<Real>& s) override { return virial_of(integrator, s); }
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) override { integrator.accelerations(s, a); }
  Evaluations evaluations() const override { return integrator.evaluations(); }
  void save(SavedState& saved, const std::string& prefix) const override { save_any(saved, prefix, integrator); }
  void load(const SavedState& saved, const std::string& prefix) override { load_any(saved, prefix, integrator); }
  I integrator;
};

}  // namespace detail

/// Any split Hamiltonian over one number type; one virtual call per cut of the run.
template <class Real = double> class AnyHamiltonian : private detail::Erased<detail::HamiltonianBase<Real>> {
 public:
  using real = Real;
  template <SplitHamiltonian H>
    requires(!std::is_same_v<H, AnyHamiltonian>)
  AnyHamiltonian(H h)  // NOLINT: erases on purpose
      : detail::Erased<detail::HamiltonianBase<Real>>(std::make_unique<detail::HamiltonianModel<H>>(std::move(h))) {}

  HamiltonianClaims claims() const { return this->held_->claims(); }
  std::string name() const { return this->held_->name(); }
  void bind(ParticleSystem<Real>& s) { this->held_->bind(s); }
  void expect_kicks(double longest) { this->held_->expect_kicks(longest); }
  /// How neighbors are found; before the first step. @return whether it looks for any
  bool set_neighbor_options(const NeighborOptions& options) { return this->held_->set_neighbor_options(options); }
  bool can_project() const { return this->held_->can_project(); }
  void project_velocities(ParticleSystem<Real>& s, const Real& h) { this->held_->project_velocities(s, h); }
  void open(ParticleSystem<Real>& s) { this->held_->open(s); }
  void close(ParticleSystem<Real>& s) { this->held_->close(s); }
  void flow(char letter, ParticleSystem<Real>& s, const Real& h) { this->held_->flow(letter, s, h); }
  Real flow_with_action(char letter, ParticleSystem<Real>& s, const Real& h) {
    return this->held_->flow_with_action(letter, s, h);
  }
  Advance run(const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span) {
    return this->held_->run(word, s, span);
  }
  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) { return this->held_->energy(s); }
  /// The virial of the forces, sum x (x) f [energy]; empty where it is not known.
  std::optional<Mat3<Real>> virial(const ParticleSystem<Real>& s) { return this->held_->virial(s); }
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) { this->held_->accelerations(s, a); }
  void observe(std::optional<Request> wanted) { this->held_->observe(wanted); }
  const std::optional<Failure>& failure() const { return this->held_->failure(); }
  Evaluations evaluations() const { return this->held_->evaluations(); }
  void save(SavedState& saved, const std::string& prefix) const { this->held_->save(saved, prefix); }
  void load(const SavedState& saved, const std::string& prefix) { this->held_->load(saved, prefix); }
};

/// Any integrator over one number type; one virtual call per cut of the run.
template <class Real = double> class AnyIntegrator : private detail::Erased<detail::IntegratorBase<Real>> {
 public:
  using real = Real;
  template <Integrator I>
    requires(!std::is_same_v<I, AnyIntegrator>)
  AnyIntegrator(I i)  // NOLINT: erases on purpose
      : detail::Erased<detail::IntegratorBase<Real>>(std::make_unique<detail::IntegratorModel<I>>(std::move(i))) {}

  IntegratorClaims claims() const { return this->held_->claims(); }
  void bind(ParticleSystem<Real>& s) { this->held_->bind(s); }
  Advance advance(ParticleSystem<Real>& s, const Span& span) { return this->held_->advance(s, span); }
  /// Whether the method offers `advance_with_action`.
  bool has_action() const { return this->held_->has_action(); }
  /// @throws LogicError  if it does not
  Advance advance_with_action(ParticleSystem<Real>& s, const Span& span, Real& action) {
    return this->held_->advance_with_action(s, span, action);
  }
  /// @return the action of the flows that complete the copy, if wanted; 0 for a method that gives none
  Real settle(const ParticleSystem<Real>& raw, ParticleSystem<Real>& out, Request wanted,
              const std::optional<double>& at, bool corrected) {
    return this->held_->settle(raw, out, wanted, at, corrected);
  }
  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) { return this->held_->energy(s); }
  /// The same with all digits of particles that keep second words; empty for others, and where a force is in doubles
  /// only.
  std::optional<EnergyTerms<Quad>> wide_energy(const ParticleSystem<Real>& s) { return this->held_->wide_energy(s); }
  /// The virial of the forces, sum x (x) f [energy]; empty where it is not known.
  std::optional<Mat3<Real>> virial(const ParticleSystem<Real>& s) { return this->held_->virial(s); }
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) { this->held_->accelerations(s, a); }
  Evaluations evaluations() const { return this->held_->evaluations(); }
  void save(SavedState& saved, const std::string& prefix) const { this->held_->save(saved, prefix); }
  void load(const SavedState& saved, const std::string& prefix) { this->held_->load(saved, prefix); }
};

}  // namespace noether
