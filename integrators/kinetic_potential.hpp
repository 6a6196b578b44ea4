#pragma once
/// H = T(p) + U(q): free motion and kicks, along constraints if there are any.

#include "engine/bodies.hpp"
#include "engine/concepts.hpp"
#include "engine/erasure.hpp"
#include "engine/signature.hpp"
#include "engine/sums.hpp"
#include "engine/unconstrained.hpp"
#include "engine/word.hpp"
#include "forces/sum.hpp"
#include "neighbors/neighbor_list.hpp"
#include "numbers/cost_book.hpp"

#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace noether {

/// Kinetic energy of inertial particles, T = sum m v^2 / 2, the same in any order of them [energy].
template <class Real> Real kinetic_energy(const ParticleSystem<Real>& s) {
  return sum_over<Real>(s.size(), [&](Index i) { return s.masses()[i] * norm2(s.velocities()[i]) / Real(2); });
}

/// The Hamiltonian H = T(p) + U(q, t) of forces that depend on positions and stage time.
///
///     A (drift):  x -> x + h v                 action increment  h T
///     B (kick):   v -> v + h a(x, t)           action increment  - h U
///
/// `B A B` is velocity Verlet. Accelerations are kept until positions change: settling a step for an observer and the
/// next kick share one evaluation.
///
/// Forces that claim kicks of other letters (`ForceClaims::kicks`, `AnyForce::in_kick`) have flows of their own: slow
/// ones under C, say, make the words of multiple time steps, such as C B A B A B C, and the basic word C B A B C.
///
/// With constraints g(q) = 0 both flows end on them, positions and velocities, and `B A B` is RATTLE:
///
///     A:  v -> v - M^-1 G(x0)^T lambda / h,  x -> x + h v so that g(x) = 0,  v -> P(x) v
///     B:  v -> P(x) (v + h a(x, t))
///
/// P(x) projects velocities along the constraints; the T of the drift's action increment is that before the projection.
/// The kick is still an exact flow; the drift is a symmetric map of order 2, so a scheme of higher order is to be a
/// composition of whole steps of `verlet`.
/// @cost one force evaluation per kick, no allocation after `bind`
/// @source HairerLubichWanner2006, Andersen1983, LeimkuhlerSkeel1994
template <class F, class Real = double, class C = Unconstrained> class KineticPotential {
 public:
  using real = Real;
  static constexpr bool constrained = !C::trivial;

  /// @throws SchemeMismatch  if a force depends on velocities: its kick would be no exact flow
  explicit KineticPotential(F forces, C constraints = C())
      : forces_(std::move(forces)), constraints_(std::move(constraints)) {
    if (claims_of(forces_).velocity_dependent) {
      throw SchemeMismatch(
          "a force depends on velocities, so kicks by it are not an exact flow; give it as a letter of its own (drag: "
          "linear_drag), or use a method for q'' = f(q, v, t)");
    }
  }

  std::string name() const { return "kinetic_potential"; }

  HamiltonianClaims claims() const {
    const ForceClaims forces = claims_of(forces_);
    const std::string kicks = letters_of(forces);
    HamiltonianClaims claims{.alphabet = "A" + kicks,
                             .basic = std::string(kicks.rbegin(), kicks.rend()) + "A" + kicks,
                             .kicks = kicks,
                             .energy = forces.energy,
                             .time_dependent = forces.time_dependent,
                             .dissipative = forces.dissipative,
                             .twists = true,
                             .periodic = true,
                             .neighbors = true,
                             .keeps_momentum = forces.keeps_momentum && !holds_,
                             .keeps_angular_momentum = forces.keeps_angular_momentum && !periodic_ && !holds_};
    if constexpr (constrained) {
      claims.inexact = "A";
      claims.constraints = constraints_.set().equations();
      claims.constraint_tolerance = constraints_.tolerance();
      claims.keeps_momentum = claims.keeps_momentum && constraints_.set().keeps_momentum();
      claims.keeps_angular_momentum = claims.keeps_angular_momentum && constraints_.set().keeps_angular_momentum();
    }
    return claims;
  }
  const F& forces() const { return forces_; }

  void bind(ParticleSystem<Real>& s) {
    bind_force(forces_, s);
    const ForceClaims claims = claims_of(forces_);
    kicks_.clear();
    twists_ = s.bodies() != nullptr;
    holds_ = twists_ && s.bodies()->any_held();
    for (const char letter : letters_of(claims)) kicks_.emplace_back(letter, s.size(), twists_);
    workspace_ = Workspace();
    workspace_.put(NeighborList(claims.range, neighbor_options_));
    periodic_ = s.box().is_periodic();
    failure_.reset();
    if constexpr (constrained) constraints_.bind(s);
  }
  /// How long the longest kick is: pair forces tell where a step cannot follow them.
  void expect_kicks(double longest) { longest_kick_ = longest; }
  /// How neighbors are found; before the first step.
  bool set_neighbor_options(const NeighborOptions& options) {
    neighbor_options_ = options;
    return true;
  }
  /// What its forces keep between evaluations; after `bind` with the neighbor list that they share.
  const Workspace& workspace() const { return workspace_; }
  void open(ParticleSystem<Real>& /*inertial already*/) {}
  void close(ParticleSystem<Real>& /*inertial already*/) {}

  void flow(char letter, ParticleSystem<Real>& s, const Real& h) {
    if (letter == 'A') {
      move(s, h);
      project(s, h);
      return;
    }
    Kick& kick = kick_of(letter);
    evaluate(kick, s, observing_.value_or(Request{}));
    push(kick, s, h);
    project(s, h);
    if (!observing_) count(kick);
  }

  /// Tells that a flow that stands around it has moved the particles: the next kick of a run is an evaluation.
  void note_move() {
    if (observing_) return;
    for (Kick& kick : kicks_) kick.moved = true;
  }
  /// Brings velocities back along the constraints, for flows of other letters; nothing where there are none.
  void project_velocities(ParticleSystem<Real>& s, const Real& h) { project(s, h); }

  /// The fused walk: between the stages of whole steps nobody asks whether the forces are known, but where kicks of
  /// another letter may stand between two that nothing has moved.
  Advance run(const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span) requires(!constrained) {
    const Real dt(s.clock().dt());
    Advance done;
    bool drifted = false;  // before that an observer may have evaluated what the first kick needs
    while (done.steps < span.steps) {
      word.step(s.phase(), [&](char letter, const Real& weight, const Real& fraction) {
        s.clock().set_fraction(fraction);
        if (letter == 'A') {
          s.advance_positions(weight * dt);
          drifted = true;
          for (Kick& kick : kicks_) kick.moved = true;
        } else {
          Kick& kick = kick_of(letter);
          drifted&& kicks_.size() == 1 ? sum(kick, s, {}) : evaluate(kick, s, {});
          push(kick, s, weight * dt);
          count(kick);
        }
      });
      s.clock().tick(Real(0));
      ++done.steps;
      if (failure_) done.failure = &*failure_;
      if (failure_ || span.asked_to_stop()) break;
    }
    if (drifted && kicks_.size() == 1) forget();
    return done;
  }

  Real flow_with_action(char letter, ParticleSystem<Real>& s, const Real& h) {
    if (letter == 'A') {
      move(s, h);
      const Real action = h * kinetic_energy(s);
      project(s, h);
      return action;
    }
    Kick& kick = kick_of(letter);
    evaluate(kick, s, {.energy = true});
    flow(letter, s, h);
    return -h * kick.potential;
  }

  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) {
    Real potential(0);
    for (Kick& kick : kicks_) {
      evaluate(kick, s, {.energy = true});
      potential += kick.potential;
    }
    return {kinetic_energy(s), potential};
  }
  /// Sum x (x) f, the forces of constraints too [energy]; empty if a force does not tell it, or a constraint holds
  /// particles in place. Once asked for, it is summed along with the energy.
  std::optional<Mat3<Real>> virial(const ParticleSystem<Real>& s) {
    if (!claims_of(forces_).virial || holds_) return {};
    if constexpr (constrained) {
      if (!constraints_.set().keeps_momentum()) return {};
    }
    virial_wanted_ = true;
    Mat3<Real> virial = Mat3<Real>::Zero();
    for (Kick& kick : kicks_) {
      evaluate(kick, s, {.energy = true, .virial = true});
      virial += kick.virial;
    }
    if constexpr (constrained) {
      VectorColumn<Real> a;
      sum_of_kicks(a);
      const Spent spent("constraints");
      virial += constraints_.virial(s, a);
    }
    return virial;
  }
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
    for (Kick& kick : kicks_) evaluate(kick, s, {});
    sum_of_kicks(a);
    if constexpr (constrained) {
      const Spent spent("constraints");
      constraints_.constrain(s, a);
    }
  }

  void observe(std::optional<Request> wanted) {
    observing_ = wanted;
    if constexpr (constrained) {
      if (wanted) {
        evaluations_.constraint = constraints_.work();
      } else {
        constraints_.forget_failure();
        constraints_.restore(evaluations_.constraint);
      }
    }
  }
  const std::optional<Failure>& failure() const {
    if constexpr (constrained) {
      if (constraints_.failure()) return constraints_.failure();
    }
    return failure_;
  }
  Evaluations evaluations() const {
    Evaluations evaluations = evaluations_;
    if constexpr (constrained) evaluations.constraint = constraints_.work();
    const auto* list = workspace_.find<NeighborList>();
    if (list != nullptr && list->statistics().searches > 0) evaluations.neighbors = list->statistics();
    return evaluations;
  }
  void save(SavedState& saved, const std::string& prefix) const {
    detail::save_signature(saved, prefix, forces_);
    save_value(saved, prefix + "evaluations", evaluations_.force);
    for (const Kick& kick : kicks_) save_value(saved, moved_key(prefix, kick), kick.moved);
    if constexpr (constrained) {
      detail::save_signature(saved, prefix + "constraints/", constraints_.set());
      constraints_.save_work(saved, prefix + "constraints/");
    }
  }
  void load(const SavedState& saved, const std::string& prefix) {
    detail::check_signature(saved, prefix, forces_);
    load_value(saved, prefix + "evaluations", evaluations_.force);
    for (Kick& kick : kicks_) {
      load_value(saved, moved_key(prefix, kick), kick.moved);
      kick.failure.reset();
    }
    forget();
    failure_.reset();
    if constexpr (constrained) {
      detail::check_signature(saved, prefix + "constraints/", constraints_.set());
      constraints_.load_work(saved, prefix + "constraints/");
      evaluations_.constraint = constraints_.work();
      constraints_.forget_failure();
    }
  }

 private:
  struct Known {
    std::uint64_t version;
    Real time;
    bool energy, virial;
  };
  /// The forces of one letter, as they were evaluated last.
  struct Kick {
    Kick(char of, Index n, bool twists) : letter(of), acceleration(n), torque(twists ? n : 0) {}

    char letter;
    bool moved = true;  ///< since the last evaluation that was counted
    VectorColumn<Real> acceleration;
    VectorColumn<Real> torque;  ///< of particles with spins; else empty
    Real potential = Real(0);
    Mat3<Real> virial = Mat3<Real>::Zero();
    std::optional<Known> known;
    std::optional<Failure> failure;  ///< of the last evaluation, whoever asked for it
  };

  static std::string letters_of(const ForceClaims& forces) { return forces.kicks.empty() ? "B" : forces.kicks; }
  static std::string moved_key(const std::string& prefix, const Kick& kick) {
    return prefix + "moved" + (kick.letter == 'B' ? std::string() : std::string("_") + kick.letter);
  }
  Kick& kick_of(char letter) {
    if (kicks_.size() == 1) return kicks_.front();
    for (Kick& kick : kicks_) {
      if (kick.letter == letter) return kick;
    }
    throw LogicError("there are no kicks of this letter");
  }
  void sum_of_kicks(VectorColumn<Real>& a) const {
    a = kicks_.front().acceleration;
    for (std::size_t k = 1; k < kicks_.size(); ++k) a.add_scaled(Real(1), kicks_[k].acceleration);
  }
  void forget() {
    for (Kick& kick : kicks_) kick.known.reset();
  }

  void move(ParticleSystem<Real>& s, const Real& h) {
    if constexpr (constrained) {
      const Spent spent("constraints");
      constraints_.advance_positions(s, h);
    } else {
      s.advance_positions(h);
    }
    note_move();
  }
  /// v += h a, and where there are bodies S += h torque.
  void push(const Kick& kick, ParticleSystem<Real>& s, const Real& h) {
    s.advance_velocities(h, kick.acceleration);
    if (twists_) s.template column<BodySpin>().add_scaled(h, kick.torque);
  }
  void project(ParticleSystem<Real>& s, const Real& h) {
    if constexpr (constrained) {
      const Spent spent("constraints");
      constraints_.project_velocities(s, h);
    }
  }
  /// Counts an evaluation of the run. The first failure of a step is told: what follows from it, positions that are no
  /// numbers, may be worse.
  void count(Kick& kick) {
    if (kick.failure && !failure_) failure_ = kick.failure;
    if (std::exchange(kick.moved, false)) ++evaluations_.force;
  }
  void evaluate(Kick& kick, const ParticleSystem<Real>& s, Request wanted) {
    const Real time = s.time();
    const std::optional<Known>& known = kick.known;
    const bool here = known && known->version == s.version() && known->time == time;
    if (here && (known->energy || !wanted.energy) && (known->virial || !wanted.virial)) return;
    wanted.virial = wanted.virial || (wanted.energy && virial_wanted_);
    sum(kick, s, wanted);
    kick.known = Known{s.version(), time, wanted.energy, wanted.virial};
  }
  void sum(Kick& kick, const ParticleSystem<Real>& s, Request wanted) {
    const Request of_forces{.energy = wanted.energy, .virial = wanted.virial};
    ForceSink<Real> sink(kick.acceleration, s, of_forces, &workspace_, longest_kick_);
    if (kicks_.size() > 1) sink.set_kick_letter(kick.letter);
    if (twists_) sink.set_torques(kick.torque);
    forces_.add_to(sink, s);
    for (Index i = 0; holds_ && i < s.size(); ++i) {
      if (s.bodies()->is_held(i)) kick.acceleration.set(i, Vec3<Real>::Zero());
    }
    if (wanted.energy) kick.potential = sink.potential();
    if (wanted.virial) kick.virial = sink.virial();
    kick.failure = sink.failure();
  }

  F forces_;
  typename C::template Solver<Real> constraints_;
  std::vector<Kick> kicks_{Kick('B', 0, false)};  ///< one for each letter
  bool twists_ = false;                           ///< whether there are rigid bodies
  bool holds_ = false;                            ///< whether fixed points hold some of the bodies
  bool virial_wanted_ = false;
  std::optional<Request> observing_;
  std::optional<Failure> failure_;  ///< why the last flow could not be done
  NeighborOptions neighbor_options_;
  Workspace workspace_;
  bool periodic_ = false;
  double longest_kick_ = 0;  ///< of a step [time]; 0: nobody has told
  Evaluations evaluations_;
};

/// The Hamiltonian of forces alone, as a part of scenes; it has no parameters of its own.
struct KineticPotentialOptions {
  static constexpr auto describe() {
    return part<KineticPotentialOptions>("kinetic_potential", "free motion A and kicks B by a sum of forces",
                                         formula("H = sum p_i^2 / 2 m_i + U(q, t)"), source("HairerLubichWanner2006"),
                                         letter('A', "drifts"), letter('B', "kicks"));
  }

  /// Nothing in itself but the motion p^2/2m: methods that do not split serve it too.
  std::tuple<> forces() const { return {}; }
  template <class Real, template <class> class Field> AnyHamiltonian<Real> split(Field<Real> forces) const {
    return KineticPotential<Field<Real>, Real>(std::move(forces));
  }
  template <class Real, template <class> class Field, class C>
  AnyHamiltonian<Real> split(Field<Real> forces, C constraints) const {
    return KineticPotential<Field<Real>, Real, C>(std::move(forces), std::move(constraints));
  }
};

template <class F> KineticPotential(F) -> KineticPotential<F, double>;
template <class F, class C> KineticPotential(F, C) -> KineticPotential<F, double, C>;

// The Hamiltonian of a scene, compiled once.
extern template class KineticPotential<ForceField<double>>;
extern template class KineticPotential<ForceField<Quad>, Quad>;
extern template struct detail::HamiltonianModel<KineticPotential<ForceField<double>>>;
extern template struct detail::HamiltonianModel<KineticPotential<ForceField<Quad>, Quad>>;

}  // namespace noether
