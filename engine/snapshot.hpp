#pragma once
/// What monitors see of a run: settled copies, read-only.

#include "engine/erasure.hpp"
#include "engine/motion.hpp"

#include <optional>

namespace noether {

/// Where a snapshot finds the whole run: two pointers, because most looks do not need it.
struct RunSource {
  const void* run;
  SavedRun (*save)(const void* run);
};

/// One moment of a run. The settled copies and the energy are made when somebody asks, once for all monitors.
///
/// `state()` is what users see: word completed, corrector applied. `mapped()` is the word completed and nothing more.
template <class Real> class Snapshot {
 public:
  /// @param copy, mapped  storage for the settled copies, reused from one moment to the next
  /// @param at  the time to be shown between the last whole step and the next one
  /// @param action  of the run's flows in the step before this moment, where it was asked for
  Snapshot(AnyIntegrator<Real>& integrator, const ParticleSystem<Real>& raw, ParticleSystem<Real>& copy,
           ParticleSystem<Real>& mapped, Request wanted, const std::optional<double>& at, const Real& action,
           const RunSource& run)
      : integrator_(integrator),
        raw_(raw),
        copy_(copy),
        mapped_(mapped),
        wanted_(wanted),
        at_(at),
        action_(action),
        run_(run) {}

  /// The settled, inertial particles.
  const ParticleSystem<Real>& state() const {
    if (!have_state_) integrator_.settle(raw_, copy_, wanted_, at_, true);
    have_state_ = true;
    return copy_;
  }
  /// The same without the corrector: the point the composed map itself reaches.
  const ParticleSystem<Real>& mapped() const {
    if (!have_mapped_) settling_action_ = integrator_.settle(raw_, mapped_, wanted_, at_, false);
    have_mapped_ = true;
    return mapped_;
  }
  /// Action of the flows of the run itself, from the unsettled state of the step before to this one [energy time]. It
  /// is there for monitors that want it, at looks that follow a look at the step before.
  const Real& action() const { return action_; }
  /// Action of the flows that lead from the unsettled state to `mapped()` [energy time], for monitors that want it.
  const Real& settling_action() const {
    static_cast<void>(mapped());
    return settling_action_;
  }
  /// Energy of `state()` [energy].
  const EnergyTerms<Real>& energy() const {
    if (!have_energy_) energy_ = integrator_.energy(state());
    have_energy_ = true;
    return energy_;
  }
  /// The same in 113 bits, of runs whose particles keep second words: errors below the rounding of doubles show in it.
  /// Empty for others, and where a force is in doubles only.
  const std::optional<EnergyTerms<Quad>>& wide_energy() const {
    if (!have_wide_energy_) wide_energy_ = integrator_.wide_energy(state());
    have_wide_energy_ = true;
    return wide_energy_;
  }
  /// Virial of the forces at `state()`, sum x (x) f [energy]; empty where a force or a constraint does not tell.
  const std::optional<Mat3<Real>>& virial() const {
    if (!have_virial_) virial_ = integrator_.virial(state());
    have_virial_ = true;
    return virial_;
  }
  /// Energy that the run's Hamiltonian has for other positions and velocities of its particles [energy].
  EnergyTerms<Real> energy_of(const ParticleSystem<Real>& settled) const { return integrator_.energy(settled); }
  /// Accelerations at `state()`, shape (n, 3) [length/time^2].
  const VectorColumn<Real>& accelerations() const {
    if (!accelerations_) {
      accelerations_.emplace(raw_.size());
      integrator_.accelerations(state(), *accelerations_);
    }
    return *accelerations_;
  }
  /// Position, velocity and acceleration of particle `i` in `state()`.
  Motion<Real> motion(Index i) const { return {state().positions()[i], state().velocities()[i], accelerations()[i]}; }
  std::int64_t step() const { return raw_.clock().step(); }
  /// Time of this moment [time].
  double time() const { return at_.value_or(raw_.clock().at_step()); }
  IntegratorClaims claims() const { return integrator_.claims(); }
  const UnitSystem& units() const { return raw_.units(); }
  /// The whole run as it stands, unsettled: only checkpoints have any business here.
  SavedRun saved_run() const { return run_.save(run_.run); }

 private:
  AnyIntegrator<Real>& integrator_;
  const ParticleSystem<Real>& raw_;
  ParticleSystem<Real>& copy_;
  ParticleSystem<Real>& mapped_;
  Request wanted_;
  std::optional<double> at_;  ///< a time after the last whole step [time]
  Real action_;
  RunSource run_;
  mutable Real settling_action_ = Real(0);
  mutable bool have_state_ = false, have_mapped_ = false, have_energy_ = false, have_virial_ = false;
  mutable bool have_wide_energy_ = false;
  mutable std::optional<EnergyTerms<Quad>> wide_energy_;
  mutable std::optional<Mat3<Real>> virial_;
  mutable EnergyTerms<Real> energy_{};
  mutable std::optional<VectorColumn<Real>> accelerations_;
};

}  // namespace noether
