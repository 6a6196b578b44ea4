#pragma once
/// An integrator whose every step is brought back to invariants of the motion.

#include "engine/description.hpp"
#include "integrators/manifold.hpp"
#include "integrators/own_equations.hpp"
#include "integrators/wrapped.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// Any integrator with a projection after each of its steps onto the values that invariants had at the start:
///
///     y_1 = Phi_h(y_0) + D lambda,   g(y_1) = g(start),   D = W^-1 g'(Phi_h(y_0))^T
///
/// by simplified Newton iteration in lambda, to rounding. A state that is there already, to rounding, keeps its bits.
/// W weighs x by m and v by m time_scale^2, so that the sum of the m dx is 0; `norm = plain` leaves m out. With `how` =
///
/// - oblique: D is the part of that in velocities or positions, or a direction that is given;
/// - hamiltonian: D are the flows of the invariants themselves, for pairs of which no bracket vanishes;
/// - symmetric: the multiplier is used before the step and after it, and the step is as reversible as it was,
///
///       y_1 = Phi_h(y_0 + D(y_0) mu) + D(y_1) mu,   g(y_1) = g(start).
///
/// What the method remembers goes on from the moved state (`Memory`). States between steps, which dense output tells,
/// are projected by themselves, orthogonally if symmetric. Nothing here is symplectic any more: no action, no shadow.
/// @cost per step one energy, and where the state moves one evaluation of the forces and an energy for each iteration;
///       symmetric: a step, forces and an energy for each iteration
/// @source HairerLubichWanner2006
template <class Real> class Projected : public Wrapped<AnyIntegrator<Real>> {
 public:
  using real = Real;

  /// @throws Error  see `ProjectionOptions::check`
  Projected(AnyIntegrator<Real> integrator, ProjectionOptions options,
            std::vector<std::unique_ptr<Equations<Real>>> own = {});

  static constexpr auto describe() {
    return part<Projected>("projection", "brings every step back to invariants", state<&Projected::aims_>("aims"),
                           state<&Projected::steps_>("steps"), state<&Projected::iterations_>("iterations"));
  }
  std::string signature() const { return manifold_.signature(); }
  IntegratorClaims claims() const;
  /// @throws SchemeMismatch  for invariants that the run does not have or keep, and methods that it cannot move
  void bind(ParticleSystem<Real>& s);
  Advance advance(ParticleSystem<Real>& s, const Span& span);
  bool has_action() const { return false; }
  Real settle(const ParticleSystem<Real>& raw, ParticleSystem<Real>& out, Request wanted,
              const std::optional<double>& at, bool corrected);
  Evaluations evaluations() const;

 private:
  void take_aim(const ParticleSystem<Real>& raw);
  /// How far the invariants are from what they are to be, in units of what is tolerated; leaves that in `missing_`.
  double distance(const ParticleSystem<Real>& s);
  /// The distance up to which a state is left as it is.
  double near_enough() const;
  /// The distance up to which one that gets no nearer stands as it is.
  double floor() const;
  void factorize(const Matrix<Real>& G);
  void solve(Vector<Real>& multiplier) const;
  /// Brings a settled state back. @return whether it was moved; empty: no state was found
  std::optional<bool> project(ParticleSystem<Real>& s);
  Advance step_and_project(ParticleSystem<Real>& s, const Span& one);
  Advance symmetric_step(ParticleSystem<Real>& s, const Span& one);
  /// How far the end of a symmetric step is from its invariants, in units of what is tolerated, and from where it is
  /// to be, in units of rounding.
  struct Off {
    double invariants, state;
    double most() const { return std::max(invariants, state); }
    bool finite() const { return std::isfinite(invariants) && std::isfinite(state); }
  };
  Off improve(ParticleSystem<Real>& s);
  /// @param tried  iterations
  const Failure* fail(const ParticleSystem<Real>& s, std::int64_t tried);

  Manifold<Real> manifold_;
  std::vector<Real> aims_;  ///< values at the start
  std::int64_t steps_ = 0, iterations_ = 0;

  // Work of one projection.
  std::optional<ParticleSystem<Real>> now_, begin_;
  Vector<Real> y_, moved_, reached_, g_, scale_, missing_, lambda_, step_, sizes_, lengths_;
  Matrix<Real> G_, D_, D_begin_;
  PivotedSolver<Real> newton_;
  std::optional<Failure> failure_;
};

extern template class Projected<double>;
extern template class Projected<Quad>;
extern template struct detail::IntegratorModel<Projected<double>>;
extern template struct detail::IntegratorModel<Projected<Quad>>;

/// `projected(std::move(integrator), {.onto = {Invariant::angular_momentum}, .how = Projection::symmetric})`.
/// @throws Error  see `ProjectionOptions::check`
template <Integrator I> Projected<typename I::real> projected(I integrator, ProjectionOptions options) {
  check_part(options);
  return {AnyIntegrator<typename I::real>(std::move(integrator)), std::move(options)};
}

/// The same onto invariants that a program writes itself, beside those of the options: `OwnInvariant`.
template <Integrator I, OwnInvariant... Gs>
  requires(sizeof...(Gs) > 0)
Projected<typename I::real> projected(I integrator, ProjectionOptions options, Gs... own) {
  using Real = typename I::real;
  std::vector<std::unique_ptr<Equations<Real>>> all;
  (all.push_back(std::make_unique<OwnEquations<Gs, Real>>(std::move(own))), ...);
  return {AnyIntegrator<Real>(std::move(integrator)), std::move(options), std::move(all)};
}

/// What knows equations that a state has to satisfy: a `ConstraintSet`.
template <class C, class Real>
concept GivesEquations = requires(const C& constraints) {
  { constraints.template as_equations<Real>() } -> std::convertible_to<std::unique_ptr<Equations<Real>>>;
};

/// The same in a run that constraints hold: the set that the Hamiltonian has, for `Invariant::constraints`.
template <Integrator I, class C>
  requires GivesEquations<C, typename I::real> Projected<typename I::real> projected(I integrator,
                                                                                     ProjectionOptions options,
                                                                                     const C& constraints) {
    using Real = typename I::real;
    check_part(options);
    std::vector<std::unique_ptr<Equations<Real>>> all;
    if (options.has(Invariant::constraints)) all.push_back(constraints.template as_equations<Real>());
    return {AnyIntegrator<Real>(std::move(integrator)), std::move(options), std::move(all)};
  }

/// The projection as a decorator of scenes.
template <Integrator I, class C>
  requires GivesEquations<C, typename I::real> Projected<typename I::real> around(const ProjectionOptions& options,
                                                                                  I integrator, const C& constraints) {
    return projected(std::move(integrator), options, constraints);
  }

}  // namespace noether
