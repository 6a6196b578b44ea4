#pragma once
/// H = T(p) + U(q): free motion and kicks, along constraints if there are any.

#include "engine/concepts.hpp"
#include "engine/erasure.hpp"
#include "engine/neighbor_list.hpp"
#include "engine/parallel.hpp"
#include "engine/signature.hpp"
#include "engine/unconstrained.hpp"
#include "engine/word.hpp"
#include "forces/sum.hpp"

#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

namespace noether {

/// Kinetic energy of inertial particles, T = sum m v^2 / 2, summed in fixed blocks [energy].
template <class Real> Real kinetic_energy(const ParticleSystem<Real>& s) {
  return reduce(s.size(), Real(0), [&](Index begin, Index end) {
    Real sum(0);
    for (Index i = begin; i < end; ++i) sum += s.masses()[i] * norm2(s.velocities()[i]) / Real(2);
    return sum;
  });
}

/// The Hamiltonian H = T(p) + U(q, t) of forces that depend on positions and stage time.
///
///     A (drift):  x -> x + h v                 action increment  h T
///     B (kick):   v -> v + h a(x, t)           action increment  - h U
///
/// `B A B` is velocity Verlet. Accelerations are kept until positions change: settling a step for an observer and the
/// next kick share one evaluation.
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
          "a force depends on velocities, so kicks by it are no exact flow; "
          "give it as a letter of its own (drag: linear_drag), or use a method for q'' = f(q, v, t)");
    }
  }

  std::string name() const { return "kinetic_potential"; }

  HamiltonianClaims claims() const {
    const ForceClaims forces = claims_of(forces_);
    HamiltonianClaims claims{.alphabet = "AB",
                             .energy = forces.energy,
                             .time_dependent = forces.time_dependent,
                             .dissipative = forces.dissipative,
                             .periodic = true,
                             .neighbors = true,
                             .keeps_momentum = forces.keeps_momentum,
                             .keeps_angular_momentum = forces.keeps_angular_momentum && !periodic_};
    if constexpr (constrained) {
      claims.inexact = "A";
      claims.constraints = constraints_.set().equations();
      claims.constraint_tolerance = constraints_.set().tolerance();
      claims.keeps_momentum = claims.keeps_momentum && constraints_.set().keeps_momentum();
      claims.keeps_angular_momentum = claims.keeps_angular_momentum && constraints_.set().keeps_angular_momentum();
    }
    return claims;
  }
  const F& forces() const { return forces_; }

  void bind(ParticleSystem<Real>& s) {
    check_force(forces_, s);
    acceleration_ = VectorColumn<Real>(s.size());
    neighbors_ = NeighborList(claims_of(forces_).range, neighbor_options_);
    periodic_ = s.box().is_periodic();
    known_.reset();
    failure_.reset();
    force_failure_.reset();
    moved_ = true;
    if constexpr (constrained) constraints_.bind(s);
  }
  /// How long the longest kick is: pair forces tell where a step cannot follow them.
  void expect_kicks(double longest) { kick_ = longest; }
  /// How neighbors are found; before the first step.
  bool set_neighbor_options(const NeighborOptions& options) {
    neighbor_options_ = options;
    return true;
  }
  const NeighborList& neighbors() const { return neighbors_; }
  void open(ParticleSystem<Real>& /*inertial already*/) {}
  void close(ParticleSystem<Real>& /*inertial already*/) {}

  void flow(char letter, ParticleSystem<Real>& s, const Real& h) {
    if (letter == 'A') {
      move(s, h);
      project(s, h);
      return;
    }
    evaluate(s, observing_.value_or(Wanted{}));
    s.advance_velocities(h, acceleration_);
    project(s, h);
    if (!observing_) note_failure();
    if (!observing_ && std::exchange(moved_, false)) ++evaluations_.force;
  }

  /// Brings velocities back along the constraints, for flows of other letters; nothing where there are none.
  void project_velocities(ParticleSystem<Real>& s, const Real& h) { project(s, h); }

  /// The fused walk: between the stages of whole steps nobody asks whether the forces are known.
  Advanced run(const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span) requires(!constrained) {
    const Real dt(s.clock().dt());
    Advanced done;
    bool drifted = false;  // before that an observer may have evaluated what the first kick needs
    while (done.steps < span.steps) {
      word.step(s.phase(), [&](char letter, const Real& weight, const Real& fraction) {
        s.clock().set_fraction(fraction);
        if (letter == 'A') {
          s.advance_positions(weight * dt);
          drifted = moved_ = true;
        } else {
          drifted ? sum(s, {}) : evaluate(s, {});
          s.advance_velocities(weight * dt, acceleration_);
          note_failure();
          if (std::exchange(moved_, false)) ++evaluations_.force;
        }
      });
      s.clock().tick(Real(0));
      ++done.steps;
      if (failure_) done.failure = &*failure_;
      if (failure_ || span.asked_to_stop()) break;
    }
    if (drifted) known_.reset();
    return done;
  }

  Real flow_with_action(char letter, ParticleSystem<Real>& s, const Real& h) {
    if (letter == 'A') {
      move(s, h);
      const Real action = h * kinetic_energy(s);
      project(s, h);
      return action;
    }
    evaluate(s, {.energy = true});
    flow(letter, s, h);
    return -h * potential_;
  }

  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) {
    evaluate(s, {.energy = true});
    return {kinetic_energy(s), potential_};
  }
  /// Sum x (x) f, the forces of constraints too [energy]; empty if a force does not tell it, or a constraint holds
  /// particles in place. Once asked for, it is summed along with the energy.
  std::optional<Mat3<Real>> virial(const ParticleSystem<Real>& s) {
    if (!claims_of(forces_).virial) return {};
    if constexpr (constrained) {
      if (!constraints_.set().keeps_momentum()) return {};
    }
    virial_wanted_ = true;
    evaluate(s, {.energy = true, .virial = true});
    if constexpr (constrained) return Mat3<Real>(virial_ + constraints_.virial(s, acceleration_));
    return virial_;
  }
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
    evaluate(s, {});
    a = acceleration_;
    if constexpr (constrained) constraints_.constrain(s, a);
  }

  void observe(std::optional<Wanted> wanted) {
    observing_ = wanted;
    if constexpr (constrained) {
      if (wanted) {
        evaluations_.constraint = constraints_.iterations();
      } else {
        constraints_.forget_failure();
        constraints_.restore_iterations(evaluations_.constraint);
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
    if constexpr (constrained) evaluations.constraint = constraints_.iterations();
    if (neighbors_.statistics().searches > 0) evaluations.neighbors = neighbors_.statistics();
    return evaluations;
  }
  void save(SavedState& saved, const std::string& prefix) const {
    detail::save_signature(saved, prefix, forces_);
    save_value(saved, prefix + "evaluations", evaluations_.force);
    save_value(saved, prefix + "moved", moved_);
    if constexpr (constrained) {
      detail::save_signature(saved, prefix + "constraints/", constraints_.set());
      save_value(saved, prefix + "constraints/iterations", constraints_.iterations());
    }
  }
  void load(const SavedState& saved, const std::string& prefix) {
    detail::check_signature(saved, prefix, forces_);
    load_value(saved, prefix + "evaluations", evaluations_.force);
    load_value(saved, prefix + "moved", moved_);
    known_.reset();
    failure_.reset();
    force_failure_.reset();
    if constexpr (constrained) {
      detail::check_signature(saved, prefix + "constraints/", constraints_.set());
      load_value(saved, prefix + "constraints/iterations", evaluations_.constraint);
      constraints_.restore_iterations(evaluations_.constraint);
      constraints_.forget_failure();
    }
  }

 private:
  struct Known {
    std::uint64_t version;
    Real time;
    bool energy, virial;
  };

  void move(ParticleSystem<Real>& s, const Real& h) {
    if constexpr (constrained) {
      constraints_.advance_positions(s, h);
    } else {
      s.advance_positions(h);
    }
    if (!observing_) moved_ = true;
  }
  void project(ParticleSystem<Real>& s, const Real& h) {
    if constexpr (constrained) constraints_.project_velocities(s, h);
  }
  /// The first of a step is told: what follows from it, positions that are no numbers, may be worse.
  void note_failure() {
    if (force_failure_ && !failure_) failure_ = force_failure_;
  }
  void evaluate(const ParticleSystem<Real>& s, Wanted wanted) {
    const Real time = s.time();
    const bool here = known_ && known_->version == s.version() && known_->time == time;
    if (here && (known_->energy || !wanted.energy) && (known_->virial || !wanted.virial)) return;
    wanted.virial = wanted.virial || (wanted.energy && virial_wanted_);
    sum(s, wanted);
    known_ = Known{s.version(), time, wanted.energy, wanted.virial};
  }
  void sum(const ParticleSystem<Real>& s, Wanted wanted) {
    ForceSink<Real> sink(acceleration_, s, {.energy = wanted.energy, .virial = wanted.virial}, &neighbors_, kick_);
    forces_.add_to(sink, s);
    if (wanted.energy) potential_ = sink.potential();
    if (wanted.virial) virial_ = sink.virial();
    force_failure_ = sink.failure();
  }

  F forces_;
  typename C::template Solver<Real> constraints_;
  VectorColumn<Real> acceleration_;
  Real potential_ = Real(0);
  Mat3<Real> virial_ = Mat3<Real>::Zero();
  bool virial_wanted_ = false;
  std::optional<Known> known_;
  std::optional<Wanted> observing_;
  bool moved_ = true;                     ///< since the last evaluation that was counted
  std::optional<Failure> failure_;        ///< why the last flow could not be done
  std::optional<Failure> force_failure_;  ///< of the last evaluation, whoever asked for it
  NeighborOptions neighbor_options_;
  NeighborList neighbors_;
  bool periodic_ = false;
  double kick_ = 0;  ///< the longest of a step [time]; 0: nobody has told
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
