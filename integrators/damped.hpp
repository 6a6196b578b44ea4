#pragma once
/// A Hamiltonian with linear drag as one more letter.

#include "engine/description.hpp"
#include "engine/erasure.hpp"
#include "engine/proper_velocity.hpp"
#include "forces/linear_drag.hpp"
#include "integrators/wrapped.hpp"

#include <cmath>
#include <string>

namespace noether {

/// Adds the letter `D`, the exact flow of linear drag, to a split Hamiltonian.
///
///     D:  v -> exp(-rate h) v
///
/// It is irreversible: schemes with negative steps are refused. A word without a D gets half a D at both ends,
/// `symplectic_euler_a` and `_b` one between their two flows (see `Composition`). Velocities of every coordinate
/// system are linear in the inertial ones, so the same flow serves them all.
template <SplitHamiltonian H> class Damped : public Wrapped<H> {
 public:
  using real = typename H::real;

  Damped(H hamiltonian, LinearDrag drag) : Wrapped<H>(std::move(hamiltonian)), drag_(drag) {
    if (!(drag.rate >= 0))
      throw Error("a drag rate of " + std::to_string(drag.rate) +
                  " would drive the motion instead of damping it; give 0 or more");
    if (Wrapped<H>::claims().coordinates == proper_velocities) {
      throw SchemeMismatch(
          "linear drag slows velocities, but relativistic particles go by u = gamma v; take one of the two out");
    }
  }

  std::string name() const { return "damped"; }
  HamiltonianClaims claims() const {
    HamiltonianClaims claims = Wrapped<H>::claims();
    claims.alphabet += 'D';
    claims.irreversible.insert(claims.irreversible.begin(), 'D');
    claims.dissipative = true;
    claims.counts_heat = false;
    claims.symplectic = false;
    claims.keeps_momentum = claims.keeps_angular_momentum = false;
    return claims;
  }
  void flow(char letter, ParticleSystem<real>& s, const real& h) {
    if (letter != 'D') return Wrapped<H>::flow(letter, s, h);
    using std::exp;
    s.scale_velocities(exp(-real(drag_.rate) * h));
  }
  /// @throws LogicError  for D: a dissipative flow has no action
  real flow_with_action(char letter, ParticleSystem<real>& s, const real& h) {
    NOETHER_EXPECTS(letter != 'D', "the dissipative flow D has no action increment");
    return Wrapped<H>::flow_with_action(letter, s, h);
  }
  void accelerations(const ParticleSystem<real>& s, VectorColumn<real>& a) {
    Wrapped<H>::accelerations(s, a);
    for (Index i = 0; i < s.size(); ++i) a.add(i, -real(drag_.rate) * s.velocities()[i]);
  }
  void save(SavedState& saved, const std::string& prefix) const {
    detail::save_signature(saved, prefix + "drag/", drag_);
    detail::save_any(saved, prefix, this->hamiltonian_);
  }
  void load(const SavedState& saved, const std::string& prefix) {
    detail::check_signature(saved, prefix + "drag/", drag_);
    detail::load_any(saved, prefix, this->hamiltonian_);
  }

 private:
  LinearDrag drag_;
};

/// Drag as a letter, for scenes: what `[[hamiltonian.force]] type = "linear_drag"` adds to a splitting.
template <SplitHamiltonian H> Damped<H> with_letter(const LinearDrag& drag, H hamiltonian) {
  return Damped<H>(std::move(hamiltonian), drag);
}

extern template class Damped<AnyHamiltonian<double>>;
extern template struct detail::HamiltonianModel<Damped<AnyHamiltonian<double>>>;

}  // namespace noether
