#pragma once
/// Kicks of integrators/wisdom_holman.hpp: plain ones, those of kernels, and those by forces that depend on velocities;
/// included by it.

#include "integrators/wisdom_holman.hpp"

#include <limits>
#include <string>
#include <utility>

namespace noether {

namespace detail {

/// The name of the first force of a sum for which `is_wanted` holds; empty without one.
template <class F, class Wanted> std::string first_force(const F& forces, const Wanted& is_wanted) {
  std::string found;
  const auto look = [&](const auto& force) {
    if (found.empty() && is_wanted(force)) found = name_of(force);
  };
  if constexpr (requires { forces.terms(); }) {
    for (const auto& term : forces.terms()) look(term);
  } else if constexpr (requires { forces.for_each(look); }) {
    forces.for_each(look);
  } else {
    look(forces);
  }
  return found;
}

}  // namespace detail

/// Why there is no G or no L; empty where both are there.
template <class Real, class F> std::string WisdomHolman<Real, F>::no_kernel() const {
  if (!jacobi()) return "because kernels of modified kicks need Jacobi coordinates";
  const std::string moving =
      detail::first_force(forces_, [](const auto& f) { return claims_of(f).velocity_dependent; });
  if (!moving.empty()) return "because the force '" + moving + "' depends on velocities";
  const std::string turning = detail::first_force(forces_, [](const auto& f) { return claims_of(f).on_bodies; });
  if (!turning.empty()) return "because the force '" + turning + "' turns rigid bodies";
  const std::string plain = detail::first_force(forces_, [](const auto& f) { return !has_derivative<Real>(f); });
  if (!plain.empty()) return "because the force '" + plain + "' is written for doubles only and has no derivatives";
  return "";
}

template <class Real, class F> Real WisdomHolman<Real, F>::kick(ParticleSystem<Real>& s, const Real& h, bool action) {
  begin_kick(s);
  if constexpr (has_forces) {
    if (velocity_dependent_) {
      velocity_kick(s, h);
      return Real(0);
    }
  }
  const Real potential = accelerate(std::as_const(s).positions(), s.clock(), action);
  pulled_ = Place{s.version(), s.clock().step(), s.clock().fraction()};
  s.advance_velocities(h, acceleration_);
  if (has_forces && twists_) s.template column<BodySpin>().add_scaled(h, torque_);
  return -h * potential;
}

/// The flow of G = - dt^2 sum m' a^2, where dt is the step of the run and a the accelerations of B: a kick by
/// 2 dt^2 (a . grad) a. Behind a B at the same place its accelerations are those of B.
/// @source WisdomHolmanTouma1996, ReinTamayoBrown2019
template <class Real, class F>
Real WisdomHolman<Real, F>::gradient_kick(ParticleSystem<Real>& s, const Real& h, bool action) {
  const auto& c = std::as_const(s);
  begin_kick(s);
  const bool known = pulled_ && *pulled_ == Place{s.version(), s.clock().step(), s.clock().fraction()};
  if (!known) accelerate(c.positions(), s.clock(), false);
  pulled_.reset();
  if (!observing_) ++evaluations_.force;
  along_ = acceleration_;
  const Vec3<Real> of_center = std::as_const(along_)[0];
  from_jacobi(std::as_const(along_), scratch_, of_center);
  const JacobiBodies<Real> bodies{masses_, order_, within_, circled_, static_cast<Index>(massive()), g_};
  acceleration_.set_zero();
  add_pair_derivatives<Real>(bodies, positions_, scratch_, acceleration_);
  if constexpr (has_forces) add_force_derivatives(s.clock());
  to_jacobi(acceleration_);
  if (!has_forces) acceleration_.set(0, Vec3<Real>::Zero());
  add_arc_derivatives<Real>(bodies, c.positions(), along_, acceleration_);
  const Real dt(s.clock().dt()), factor = h * dt * dt;
  s.advance_velocities(Real(2) * factor, acceleration_);
  Real square(0);
  if (action && has_forces) square = interior_.back() * norm2(of_center);
  for (std::size_t k = 1; action && k < massive(); ++k)
    square += reduced_[static_cast<std::size_t>(at(k))] * norm2(std::as_const(along_)[at(k)]);
  return factor * square;
}

/// A kick by the acceleration at x + dt^2 a(x)/12, in the place of that by a + dt^2 (a . grad) a/12.
/// @source WisdomHolmanTouma1996
template <class Real, class F> void WisdomHolman<Real, F>::lazy_kick(ParticleSystem<Real>& s, const Real& h) {
  const auto& c = std::as_const(s);
  const Real dt(s.clock().dt());
  begin_kick(s);
  accelerate(c.positions(), s.clock(), false);
  for (Index i = 0; i < s.size(); ++i)
    along_.set(i, c.positions()[i] + dt * dt / Real(12) * std::as_const(acceleration_)[i]);
  noting_ = false;  // nothing is there
  accelerate(std::as_const(along_), s.clock(), false);
  s.advance_velocities(h, acceleration_);
}

/// The implicit midpoint rule over fixed positions: v_1 = v_0 + h a(x, (v_0 + v_1)/2), a symmetric map of order 2.
/// Forces that hardly depend on velocities, as those of relativity, take three or four rounds.
template <class Real, class F> void WisdomHolman<Real, F>::velocity_kick(ParticleSystem<Real>& s, const Real& h) {
  using std::isfinite;
  static constexpr int most_rounds = 100;
  const auto& v = std::as_const(s).velocities();
  const auto& x = std::as_const(s).positions();
  accelerate(x, s.clock(), false);
  along_ = acceleration_;
  inertial_->clock() = s.clock();
  inertial_positions(x, x[0], inertial_->positions());
  scratch_ = v;
  const Real rounding(16 * std::numeric_limits<Real>::epsilon() * std::numeric_limits<Real>::epsilon());
  bool settled = false;
  for (int round = 0; round < most_rounds && !settled; ++round) {
    inertial_velocities(std::as_const(scratch_), inertial_->velocities());
    ForceSink<Real> sink(other_, *inertial_, {}, &workspace_);
    forces_.add_to(sink, *inertial_);
    note_failure(sink.failure());
    if (jacobi()) {
      to_jacobi(other_);
    } else {
      about_center(other_);
      if (scaled()) scale(other_, false);
    }
    acceleration_ = along_;
    acceleration_.all() += other_.all();
    Real change(0), size(0);
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> middle = v[i] + h / Real(2) * std::as_const(acceleration_)[i];
      const Real moved2 = norm2(Vec3<Real>(middle - std::as_const(scratch_)[i]));
      if (!(moved2 <= change)) change = moved2;  // what is not a number stays
      size = std::max(size, norm2(middle));
      scratch_.set(i, middle);
    }
    settled = change <= rounding * size && isfinite(size);
  }
  if (!settled) {
    note_failure(Failure{Outcome::Kind::solver_failure, -1, "velocity",
                         "a kick by forces that depend on velocities did not converge; take a smaller step"});
    return;
  }
  s.advance_velocities(h, acceleration_);
}

/// Adds (u . grad) a of the other forces, u in `scratch_`, at the positions where they were summed last.
template <class Real, class F> void WisdomHolman<Real, F>::add_force_derivatives(const Clock<Real>& clock) {
  using D = Dual<Real, 1>;
  if constexpr (Force<F, D>) {
    const auto &x = std::as_const(*inertial_).positions(), &u = std::as_const(scratch_);
    auto& moving = forces_along_->particles.positions();
    for (int k = 0; k < 3; ++k) {
      for (Index i = 0; i < x.size(); ++i) moving.component(k)[i] = detail::along(x.component(k)[i], u.component(k)[i]);
    }
    forces_along_->particles.clock().set_stage_offset(D(clock.time()));
    ForceSink<D> sink(forces_along_->a, forces_along_->particles, {});
    forces_.add_to(sink, std::as_const(forces_along_->particles));
    note_failure(sink.failure());
    for (int k = 0; k < 3; ++k) {
      for (Index i = 0; i < x.size(); ++i) acceleration_.component(k)[i] += forces_along_->a.component(k)[i].slope[0];
    }
  }
}

/// Inertial velocities of all from working ones.
template <class Real, class F>
void WisdomHolman<Real, F>::inertial_velocities(const VectorColumn<Real>& from, VectorColumn<Real>& to) const {
  if (jacobi()) return from_jacobi(from, to, from[0]);
  to = from;
  if (scaled()) scale(to, true);
  const auto& relative = std::as_const(to);
  Vec3<Real> v = Vec3<Real>::Zero();
  for (std::size_t k = 1; k < massive(); ++k) v += masses_[k] * relative[static_cast<Index>(k)];
  const Vec3<Real> center = from[0];
  const Vec3<Real> of_primary = center - v / (barycentric() ? interior_.back() : masses_[0]);
  const Vec3<Real> origin = barycentric() ? of_primary : center;
  for (Index i = 1; i < to.size(); ++i) to.set(i, origin + relative[i]);
  to.set(0, of_primary);
}

}  // namespace noether
