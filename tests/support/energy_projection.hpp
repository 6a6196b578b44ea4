#pragma once
/// A decorator of integrators from outside the library: velocities are scaled back to the energy of the start.

#include "engine/description.hpp"
#include "integrators/wrapped.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace noether::test {

/// The decorator as a part of scenes: `[[integrator.decorator]] type = "energy_projection"`.
struct EnergyProjection {
  std::int64_t steps = 10;  ///< between two projections

  static constexpr auto describe() {
    return part<EnergyProjection>("energy_projection", "scales velocities back to the energy of the start",
                                  formula("v -> sqrt((T + E(0) - E) / T) v"),
                                  field<&EnergyProjection::steps>("steps", "1", "steps between two projections"));
  }
  void check() const {
    if (steps < 1) refuse_field("steps", std::to_string(steps), "is too few; at least 1 is expected");
  }
};

/// Any integrator with that projection after every so many steps, counted from step 0.
template <Integrator I> class EnergyProjected : public Wrapped<I>, public EnergyProjection {
 public:
  using real = typename I::real;

  EnergyProjected(const EnergyProjection& part, I integrator)
      : Wrapped<I>(std::move(integrator)), EnergyProjection(part) {}

  static constexpr auto describe() {
    return part<EnergyProjected>(EnergyProjection::describe(), state<&EnergyProjected::energy_>("energy"),
                                 state<&EnergyProjected::added_>("added"), state<&EnergyProjected::times_>("times"));
  }
  IntegratorClaims claims() const {
    IntegratorClaims claims = Wrapped<I>::claims();
    claims.symplectic = claims.reversible = false;
    claims.no_action = "velocities are scaled by energy_projection, so the motion has no action";
    claims.keeps_momentum = claims.keeps_angular_momentum = false;
    return claims;
  }
  /// @throws SchemeMismatch  where there is no energy
  void bind(ParticleSystem<real>& s) {
    const IntegratorClaims claims = Wrapped<I>::claims();
    if (!claims.energy || claims.variables) {
      throw SchemeMismatch("energy_projection keeps an energy, and '" + claims.hamiltonian + "' has none");
    }
    Wrapped<I>::bind(s);
    now_ = s;
    energy_.reset();
  }
  Advance advance(ParticleSystem<real>& s, const Span& span) {
    if (!energy_) energy_ = settled_energy(s).total();
    Advance done;
    while (done.steps < span.steps) {
      Span until_next = span;
      until_next.steps = std::min(span.steps - done.steps, steps - s.clock().step() % steps);
      const Advance made = this->integrator_.advance(s, until_next);
      done.steps += made.steps;
      done.at_limit = made.at_limit;
      done.failure = made.failure;
      if (made.failure != nullptr) break;
      if (made.steps > 0 && s.clock().step() % steps == 0 && !project(s)) done.failure = &*failure_;
      if (done.failure != nullptr || made.at_limit || made.steps < until_next.steps || span.asked_to_stop()) break;
    }
    return done;
  }
  bool has_action() const { return false; }

  std::int64_t times() const { return times_; }
  /// Energy that all projections have put in [energy].
  real added() const { return added_; }

 private:
  EnergyTerms<real> settled_energy(const ParticleSystem<real>& s) {
    this->integrator_.settle(s, *now_, {}, std::nullopt, true);
    return this->integrator_.energy(*now_);
  }
  /// @return whether there was kinetic energy enough
  bool project(ParticleSystem<real>& s) {
    using std::sqrt;
    const EnergyTerms<real> before = settled_energy(s);
    const real missing = *energy_ - before.total(), scale = (before.kinetic + missing) / before.kinetic;
    if (!(scale > real(0))) {
      failure_ = Failure{Outcome::Kind::solver_failure, -1, "energy", "no velocities have the energy of the start"};
      return false;
    }
    now_->scale_velocities(sqrt(scale));
    this->continue_from(*now_, s);
    added_ += missing;
    ++times_;
    return true;
  }

  std::optional<real> energy_;  ///< of the start [energy]
  real added_ = real(0);
  std::int64_t times_ = 0;
  std::optional<ParticleSystem<real>> now_;
  std::optional<Failure> failure_;
};

template <Integrator I> EnergyProjected<I> around(const EnergyProjection& part, I integrator) {
  return EnergyProjected<I>(part, std::move(integrator));
}

}  // namespace noether::test
