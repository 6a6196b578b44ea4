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
NOETHER_FINDS_MEMBER(go_on_from, goes_on_from, go_on_form, go_on, goon_from, go_from, go_on_fron)
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

/// How a Hamiltonian answers where it need not have a member of this name.
struct HamiltonianAnswers {
  template <class H> static std::string name(const H& h) { return name_of(h); }
  template <class H> static void expect_kicks(H& h, double longest) { detail::expect_kicks(h, longest); }
  template <class H> static bool set_neighbor_options(H& h, const NeighborOptions& options) {
    return detail::set_neighbor_options(h, options);
  }
  template <class H> static bool can_project(const H& h) { return detail::can_project(h); }
  template <class H, class Real> static void project_velocities(H& h, ParticleSystem<Real>& s, const Real& tau) {
    detail::project_velocities(h, s, tau);
  }
  template <class H, class Real>
  static Advance run(H& h, const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span) {
    return walk(h, word, s, span);
  }
  template <class H, class Real> static auto virial(H& h, const ParticleSystem<Real>& s) { return virial_of(h, s); }
  template <class H> static void save(const H& h, SavedState& saved, const std::string& prefix) {
    save_any(saved, prefix, h);
  }
  template <class H> static void load(H& h, const SavedState& saved, const std::string& prefix) {
    load_any(saved, prefix, h);
  }
};

/* The members of AnyHamiltonian. `set_neighbor_options` says whether the Hamiltonian looks for neighbors at all, and
   comes before the first step; `virial` is that of the forces, sum x (x) f [energy], empty where it is not known. */
#define NOETHER_HAMILTONIAN_SEAM(OWN, ANSWERED)                                                                   \
  OWN(HamiltonianClaims, claims, () const)                                                                        \
  ANSWERED(std::string, name, () const)                                                                           \
  OWN(void, bind, (ParticleSystem<Real> & s), s)                                                                  \
  ANSWERED(void, expect_kicks, (double longest), longest)                                                         \
  ANSWERED(bool, set_neighbor_options, (const NeighborOptions& options), options)                                 \
  ANSWERED(bool, can_project, () const)                                                                           \
  ANSWERED(void, project_velocities, (ParticleSystem<Real> & s, const Real& h), s, h)                             \
  OWN(void, open, (ParticleSystem<Real> & s), s)                                                                  \
  OWN(void, close, (ParticleSystem<Real> & s), s)                                                                 \
  OWN(void, flow, (char letter, ParticleSystem<Real>& s, const Real& h), letter, s, h)                            \
  OWN(Real, flow_with_action, (char letter, ParticleSystem<Real>& s, const Real& h), letter, s, h)                \
  ANSWERED(Advance, run, (const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span), word, s, span) \
  OWN(EnergyTerms<Real>, energy, (const ParticleSystem<Real>& s), s)                                              \
  ANSWERED(std::optional<Mat3<Real>>, virial, (const ParticleSystem<Real>& s), s)                                 \
  OWN(void, accelerations, (const ParticleSystem<Real>& s, VectorColumn<Real>& a), s, a)                          \
  OWN(void, observe, (std::optional<Request> wanted), wanted)                                                     \
  OWN(const std::optional<Failure>&, failure, () const)                                                           \
  OWN(Evaluations, evaluations, () const)                                                                         \
  ANSWERED(void, save, (SavedState & saved, const std::string& prefix) const, saved, prefix)                      \
  ANSWERED(void, load, (const SavedState& saved, const std::string& prefix), saved, prefix)

template <class Real> struct HamiltonianBase {
  virtual ~HamiltonianBase() = default;
  virtual std::unique_ptr<HamiltonianBase> clone() const = 0;
  NOETHER_HAMILTONIAN_SEAM(NOETHER_SEAM_PURE, NOETHER_SEAM_PURE)
};
template <class H> struct HamiltonianModel final : HamiltonianBase<typename H::real> {
  using Real = typename H::real;
  using Members = HamiltonianMembers<H>;
  using Answers = HamiltonianAnswers;
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
  explicit HamiltonianModel(H h) : held(std::move(h)) {}
  std::unique_ptr<HamiltonianBase<Real>> clone() const override { return std::make_unique<HamiltonianModel>(held); }
  NOETHER_HAMILTONIAN_SEAM(NOETHER_SEAM_HELD, NOETHER_SEAM_ANSWERED)
  H held;
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

template <class I>
concept GoesOnFrom = requires(I& integrator, const ParticleSystem<typename I::real>& now,
                              ParticleSystem<typename I::real>& raw) {
  integrator.go_on_from(now, raw);
};
/// Goes on from another state of the particles at a whole step, as after an edit: the method begins anew.
/// @param now  settled, then changed
template <class I, class Real>
void begin_from(I& integrator, const ParticleSystem<Real>& now, ParticleSystem<Real>& raw) {
  raw = now;
  raw.phase() = Phase{};
  raw.keep_low_words(false);
  integrator.bind(raw);
}
/// Goes on from a state that was moved a little; one that does not know how begins anew.
template <class I, class Real>
void go_on_from(I& integrator, const ParticleSystem<Real>& now, ParticleSystem<Real>& raw) {
  if constexpr (GoesOnFrom<I>) {
    integrator.go_on_from(now, raw);
  } else {
    begin_from(integrator, now, raw);
  }
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
  static constexpr bool go_on_from = !misspells_go_on_from<I>() && (!finds_go_on_from<I>() || GoesOnFrom<I>);
};

/// How an integrator answers where it need not have a member of this name.
struct IntegratorAnswers {
  template <class I> static bool has_action(const I& i) { return detail::has_action(i); }
  template <class I, class Real>
  static Advance advance_with_action(I& i, ParticleSystem<Real>& s, const Span& span, Real& action) {
    return detail::advance_with_action(i, s, span, action);
  }
  template <class I, class Real>
  static Real settle(I& i, const ParticleSystem<Real>& raw, ParticleSystem<Real>& out, Request wanted,
                     const std::optional<double>& at, bool corrected) {
    return detail::settle(i, raw, out, wanted, at, corrected);
  }
  template <class I, class Real> static auto wide_energy(I& i, const ParticleSystem<Real>& s) {
    return wide_energy_of(i, s);
  }
  template <class I, class Real>
  static void go_on_from(I& i, const ParticleSystem<Real>& now, ParticleSystem<Real>& raw) {
    detail::go_on_from(i, now, raw);
  }
  template <class I, class Real> static auto virial(I& i, const ParticleSystem<Real>& s) { return virial_of(i, s); }
  template <class I> static void save(const I& i, SavedState& saved, const std::string& prefix) {
    save_any(saved, prefix, i);
  }
  template <class I> static void load(I& i, const SavedState& saved, const std::string& prefix) {
    load_any(saved, prefix, i);
  }
};

/* The members of AnyIntegrator. `advance_with_action` throws LogicError where `has_action` is false. `settle` returns
   the action of the flows that complete the copy, if wanted; 0 for a method that gives none. `wide_energy` is the
   energy with all digits of particles that keep second words; empty for others, and where a force is in doubles only.
   `virial` is that of the forces, sum x (x) f [energy]; empty where it is not known. */
#define NOETHER_INTEGRATOR_SEAM(OWN, ANSWERED)                                                                        \
  OWN(IntegratorClaims, claims, () const)                                                                             \
  OWN(void, bind, (ParticleSystem<Real> & s), s)                                                                      \
  OWN(Advance, advance, (ParticleSystem<Real> & s, const Span& span), s, span)                                        \
  ANSWERED(bool, has_action, () const)                                                                                \
  ANSWERED(Advance, advance_with_action, (ParticleSystem<Real> & s, const Span& span, Real& action), s, span, action) \
  ANSWERED(Real, settle,                                                                                              \
           (const ParticleSystem<Real>& raw, ParticleSystem<Real>& out, Request wanted,                               \
            const std::optional<double>& at, bool corrected),                                                         \
           raw, out, wanted, at, corrected)                                                                           \
  ANSWERED(void, go_on_from, (const ParticleSystem<Real>& now, ParticleSystem<Real>& raw), now, raw)                  \
  OWN(EnergyTerms<Real>, energy, (const ParticleSystem<Real>& s), s)                                                  \
  ANSWERED(std::optional<EnergyTerms<Quad>>, wide_energy, (const ParticleSystem<Real>& s), s)                         \
  ANSWERED(std::optional<Mat3<Real>>, virial, (const ParticleSystem<Real>& s), s)                                     \
  OWN(void, accelerations, (const ParticleSystem<Real>& s, VectorColumn<Real>& a), s, a)                              \
  OWN(Evaluations, evaluations, () const)                                                                             \
  ANSWERED(void, save, (SavedState & saved, const std::string& prefix) const, saved, prefix)                          \
  ANSWERED(void, load, (const SavedState& saved, const std::string& prefix), saved, prefix)

template <class Real> struct IntegratorBase {
  virtual ~IntegratorBase() = default;
  virtual std::unique_ptr<IntegratorBase> clone() const = 0;
  NOETHER_INTEGRATOR_SEAM(NOETHER_SEAM_PURE, NOETHER_SEAM_PURE)
};
template <class I> struct IntegratorModel final : IntegratorBase<typename I::real> {
  using Real = typename I::real;
  using Members = IntegratorMembers<I>;
  using Answers = IntegratorAnswers;
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
  static_assert(Members::go_on_from,
                "an integrator has `void go_on_from(const ParticleSystem<Real>&, ParticleSystem<Real>&)`, or no member "
                "of that name or nearly that name");
  static_assert(action_follows<I>(),
                "a wrapper of an integrator that has its own `advance` needs its own `advance_with_action` too, or a "
                "`has_action` that returns false");
  explicit IntegratorModel(I i) : held(std::move(i)) {}
  std::unique_ptr<IntegratorBase<Real>> clone() const override { return std::make_unique<IntegratorModel>(held); }
  NOETHER_INTEGRATOR_SEAM(NOETHER_SEAM_HELD, NOETHER_SEAM_ANSWERED)
  I held;
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

  NOETHER_HAMILTONIAN_SEAM(NOETHER_SEAM_CALL, NOETHER_SEAM_CALL)

  /// The Hamiltonian itself where it is of this type, or null.
  template <class H> const H* as() const {
    const auto* model = dynamic_cast<const detail::HamiltonianModel<H>*>(this->held_.get());
    return model != nullptr ? &model->held : nullptr;
  }
};

/// Any integrator over one number type; one virtual call per cut of the run.
template <class Real = double> class AnyIntegrator : private detail::Erased<detail::IntegratorBase<Real>> {
 public:
  using real = Real;
  template <Integrator I>
    requires(!std::is_same_v<I, AnyIntegrator>)
  AnyIntegrator(I i)  // NOLINT: erases on purpose
      : detail::Erased<detail::IntegratorBase<Real>>(std::make_unique<detail::IntegratorModel<I>>(std::move(i))) {}

  NOETHER_INTEGRATOR_SEAM(NOETHER_SEAM_CALL, NOETHER_SEAM_CALL)
};

}  // namespace noether
