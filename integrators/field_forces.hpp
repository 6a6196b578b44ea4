#pragma once
/// What Hamiltonians of charges share: fields and forces at the places of the particles, kept until these move.

#include "engine/concepts.hpp"
#include "engine/erasure.hpp"
#include "engine/signature.hpp"
#include "forces/electromagnetic_field.hpp"
#include "neighbors/neighbor_list.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace noether::detail {

/// A field as a force; a force as it is.
template <class F> struct OnCharges { using type = std::conditional_t<Force<F, double>, F, InField<F>>; };

/// Accelerations but for v x Omega, and Omega, of a sum of forces; evaluated where they are not known, and counted.
/// (The kicks of `KineticPotential` keep the like for several letters, with torques, virials and constraints.)
template <class F, class Real> class FieldForces {
 public:
  /// @param who  the Hamiltonian, in messages
  /// @throws SchemeMismatch  if a force depends on velocities otherwise than fields do, or has a kick of its own
  FieldForces(F forces, const char* who) : forces_(std::move(forces)) {
    const ForceClaims all = claims();
    if (all.velocity_dependent && !all.gyrates) {
      throw SchemeMismatch(
          "a force depends on velocities otherwise than by a magnetic field, so kicks by it are not an exact flow; use "
          "a method for q'' = f(q, v, t)");
    }
    if (!all.kicks.empty() && all.kicks != "B") {
      throw SchemeMismatch(std::string(who) + " has kicks of the letter B only; take multiple time steps out");
    }
  }

  const F& forces() const { return forces_; }
  ForceClaims claims() const { return claims_of(forces_); }
  void bind(ParticleSystem<Real>& s) {
    bind_force(forces_, s);
    workspace_ = Workspace();
    workspace_.put(NeighborList(claims().range, neighbor_options_));
    acceleration_ = rate_ = VectorColumn<Real>(s.size());
    known_.reset();
    failure_.reset();
  }
  void expect_kicks(double longest) { longest_kick_ = longest; }
  void set_neighbor_options(const NeighborOptions& options) { neighbor_options_ = options; }

  /// Brings the columns and, if wanted, the potential and q A to where `s` stands.
  void evaluate(const ParticleSystem<Real>& s, bool energy, bool momenta = false) {
    const Real time = s.time();
    if (known_ && known_->version == s.version() && known_->time == time && (known_->energy || !energy) &&
        (known_->momenta || !momenta)) {
      return;
    }
    ForceSink<Real> sink(acceleration_, s, {.energy = energy}, &workspace_, longest_kick_);
    sink.set_gyrations(rate_);
    if (momenta) {
      if (momentum_.size() != s.size()) momentum_ = VectorColumn<Real>(s.size());
      sink.set_field_momenta(momentum_);
    }
    forces_.add_to(sink, s);
    if (energy) potential_ = sink.potential();
    last_failure_ = sink.failure();
    known_ = Known{s.version(), time, energy, momenta};
  }
  const VectorColumn<Real>& accelerations() const { return acceleration_; }
  Vec3<Real> acceleration(Index i) const { return acceleration_[i]; }
  Vec3<Real> rate(Index i) const { return rate_[i]; }
  Vec3<Real> momentum(Index i) const { return momentum_[i]; }
  const Real& potential() const { return potential_; }
  const std::optional<Failure>& last_failure() const { return last_failure_; }

  /// Positions move in the run itself, not for an observer.
  void note_move() { moved_ = true; }
  /// The run has used an evaluation.
  void count() {
    if (last_failure_ && !failure_) failure_ = last_failure_;
    if (std::exchange(moved_, false)) ++evaluations_;
  }
  /// The run has used so many more, of places beside its particles.
  void count_beside(std::int64_t evaluations) { evaluations_ += evaluations; }
  const std::optional<Failure>& failure() const { return failure_; }
  Evaluations evaluations() const {
    Evaluations all{.force = evaluations_};
    const auto* list = workspace_.find<NeighborList>();
    if (list != nullptr && list->statistics().searches > 0) all.neighbors = list->statistics();
    return all;
  }
  void save(SavedState& saved, const std::string& prefix) const {
    save_signature(saved, prefix, forces_);
    save_value(saved, prefix + "evaluations", evaluations_);
    save_value(saved, prefix + "moved", moved_);
  }
  void load(const SavedState& saved, const std::string& prefix) {
    check_signature(saved, prefix, forces_);
    load_value(saved, prefix + "evaluations", evaluations_);
    load_value(saved, prefix + "moved", moved_);
    known_.reset();
    failure_.reset();
    last_failure_.reset();
  }

 private:
  struct Known {
    std::uint64_t version;
    Real time;
    bool energy, momenta;
  };

  F forces_;
  VectorColumn<Real> acceleration_{0}, rate_{0};  ///< F/m + q E/m, and q B/m
  VectorColumn<Real> momentum_{0};                ///< q A, where somebody asked for it
  Real potential_ = Real(0);
  std::optional<Known> known_;
  bool moved_ = true;                              ///< since the last evaluation that was counted
  std::optional<Failure> failure_, last_failure_;  ///< of the run; of the last evaluation, whoever asked for it
  NeighborOptions neighbor_options_;
  Workspace workspace_;
  double longest_kick_ = 0;
  std::int64_t evaluations_ = 0;
};

/// What splittings of charges have in common, beside their flows.
template <class F, class Real> class ChargesInFields {
 public:
  using real = Real;

  const F& forces() const { return forces_.forces(); }
  void expect_kicks(double longest) { forces_.expect_kicks(longest); }
  bool set_neighbor_options(const NeighborOptions& options) {
    forces_.set_neighbor_options(options);
    return true;
  }
  /// @throws LogicError  always
  Real flow_with_action(char /*letter*/, ParticleSystem<Real>& /*s*/, const Real& /*h*/) {
    throw LogicError("motion by x and v in a magnetic field has no action");
  }
  void observe(std::optional<Request> wanted) { observing_ = wanted.has_value(); }
  const std::optional<Failure>& failure() const { return forces_.failure(); }
  Evaluations evaluations() const { return forces_.evaluations(); }

 protected:
  ChargesInFields(F forces, const char* who) : forces_(std::move(forces), who) {}

  /// What the forces make of the claims of a splitting.
  HamiltonianClaims with_forces(HamiltonianClaims claims) const {
    const ForceClaims forces = forces_.claims();
    claims.kicks = "B";
    claims.quadratic_kinetic = false;
    claims.energy = forces.energy;
    claims.time_dependent = forces.time_dependent;
    claims.dissipative = forces.dissipative;
    claims.velocity_forces = claims.neighbors = true;
    claims.keeps_momentum = claims.keeps_momentum && forces.keeps_momentum;
    claims.keeps_angular_momentum = claims.keeps_angular_momentum && forces.keeps_angular_momentum;
    return claims;
  }

  FieldForces<F, Real> forces_;
  bool observing_ = false;
};

}  // namespace noether::detail
