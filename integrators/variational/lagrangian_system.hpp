#pragma once
/// A user's own action: a Lagrangian in any coordinates, stepped by variational and by classical methods.

#include "engine/signature.hpp"
#include "engine/symmetry.hpp"
#include "integrators/first_order_system.hpp"
#include "integrators/hidden_time.hpp"
#include "integrators/variational/lagrangian_field.hpp"
#include "numbers/dual.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace noether {

/// What a system with a Lagrangian offers: how many coordinates it has, and L over any number type.
///
///     struct Pendulum {
///       Index size() const { return 1; }
///       template <class Real> Real lagrangian(const Real& t, const Vector<Real>& q, const Vector<Real>& v) const {
///         return v[0] * v[0] / Real(2) + cos(q[0]);
///       }
///     };
///
/// Its state is (q, p), p = dL/dq', 2 n variables. It may also offer
///
///     template <class Real> void force(const Real& t, const Vector<Real>& q, const Vector<Real>& v,
///                                      Vector<Real>& f) const;   // beside the Lagrangian, such as drag: d'Alembert
///     bool forced() const;                      // whether there is one; default: where it has `force`
///     static constexpr bool workless = true;    // the force does no work, as that of a magnetic field: energy is kept
///     static constexpr bool time_dependent = true;               // has to be said where L or the force depends on t
///     std::vector<Symmetry> symmetries() const;                  // for the monitor `momentum_map`
///     std::vector<double> start() const;                         // q, then p
///     std::vector<std::string> names() const;                    // of all 2 n
///     std::vector<double> exact(double t) const;                 // from `start()` at time 0
///
/// Where L is m q'^2/2 with constant masses and terms whose forces contain second derivatives w, linearly, it may tell
/// these apart, for methods that treat them each in its own way (`weber_extrapolated`):
///
///     Index second_rates() const;                                // how many w, such as r'' of each pair
///     template <class Real> void find_second_rates(const Vector<Real>& q, const Vector<Real>& v,
///                                                  const Vector<Real>& a, Vector<Real>& w) const;
///     template <class Real> void acceleration_with(const Real& t, const Vector<Real>& q, const Vector<Real>& v,
///                                                  const Vector<Real>& w, Vector<Real>& a) const;   // force / masses
///
/// All derivatives are found by dual numbers, nested where they are second ones.
/// @source MarsdenWest2001
template <class S, class Real>
concept LagrangianSystem = requires(const S& system, const Real& t, const Vector<Real>& q) {
  { system.size() } -> std::convertible_to<Index>;
  { system.lagrangian(t, q, q) } -> std::convertible_to<Real>;
};

namespace detail {

/// Momenta and forces of L over numbers of any type, and what they are computed in.
template <class S, class Number> class ActionTerms {
 public:
  /// m = dL/dq' and f = dL/dq with the force beside it at (t, q, v), shape (n) each.
  /// @cost L in numbers with four slopes, for every four of 2 n variables
  void find(const S& system, const Number& t, const Vector<Number>& q, const Vector<Number>& v,
            LagrangianTerms<Number>& out) {
    const Index n = q.size();
    for (Vector<Sloped>* of : {&q_, &v_}) of->resize(n);
    for (Vector<Number>* of : {&out.momentum, &out.force}) of->resize(n);
    for (Index i = 0; i < n; ++i) {
      q_[i] = Sloped(q[i]);
      v_[i] = Sloped(v[i]);
    }
    const Sloped time(t);
    for (Index first = 0; first < 2 * n; first += slopes) {
      const Index last = std::min(first + slopes, 2 * n);
      for (Index j = first; j < last; ++j) slope(j, j - first) = Number(1);
      const Sloped l = system.lagrangian(time, q_, v_);
      for (Index j = first; j < last; ++j) {
        slope(j, j - first) = Number(0);
        (j < n ? out.force[j] : out.momentum[j - n]) = l.slope[static_cast<std::size_t>(j - first)];
      }
    }
    if constexpr (requires { system.force(t, q, v, beside_); }) {
      beside_.setConstant(n, Number(0));
      system.force(t, q, v, beside_);
      for (Index i = 0; i < n; ++i) out.force[i] = out.force[i] + beside_[i];
    }
  }

 private:
  static constexpr Index slopes = 4;
  using Sloped = Dual<Number, static_cast<std::size_t>(slopes)>;

  Number& slope(Index variable, Index direction) {
    const Index n = q_.size();
    Sloped& of = variable < n ? q_[variable] : v_[variable - n];
    return of.slope[static_cast<std::size_t>(direction)];
  }

  Vector<Sloped> q_, v_;
  Vector<Number> beside_;
};

}  // namespace detail

/// A Lagrangian system as methods see it; q and p stand in `ParticleSystem::variables`.
/// @cost see `ActionTerms`; 2 n times those over dual numbers for their derivatives
template <class S, class Real> class LagrangianMotion final : public LagrangianField<Real> {
 public:
  explicit LagrangianMotion(S system) : system_(std::move(system)) {}

  std::unique_ptr<VectorField<Real>> clone() const override { return std::make_unique<LagrangianMotion>(*this); }
  FieldClaims claims() const override {
    return {.name = detail::name_of(system_),
            .variables = true,
            .canonical = !forced(),
            .time_dependent = detail::depends_on_time<S>(),
            .energy = true,
            .dissipative = forced() && !workless,
            .symplectic = !forced()};
  }
  std::string signature() const override { return detail::signature_of(system_); }

  void bind(const ParticleSystem<Real>& s) override {
    if (static_cast<Index>(s.variables().size()) != size() || s.size() != 0) {
      throw Error(fmt::format("system '{}' has {} variables, but it was given {} and {} particles",
                              detail::name_of(system_), size(), s.variables().size(), s.size()));
    }
    this->forget_signs();
    if (!detail::depends_on_time<S>()) check_time(s);
  }
  Index size() const override { return 2 * Index(system_.size()); }
  void gather(const ParticleSystem<Real>& s, Vector<Real>& y) const override {
    y.resize(size());
    for (Index i = 0; i < size(); ++i) y[i] = s.variables()[static_cast<std::size_t>(i)];
  }
  void scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const override {
    for (Index i = 0; i < size(); ++i) s.variables()[static_cast<std::size_t>(i)] = y[i];
  }

  Real action_density(const Real& t, const Vector<Real>& q, const Vector<Real>& v) override {
    return system_.lagrangian(t, q, v);
  }
  void terms_along(const Real& t, const Vector<Real>& q, const Vector<Real>& v, const Real& dt, const Vector<Real>& dq,
                   const Vector<Real>& dv, LagrangianTerms<Real>& out) override {
    const Index n = q.size();
    along_q_.resize(n);
    along_v_.resize(n);
    for (Index i = 0; i < n; ++i) {
      along_q_[i] = detail::along(q[i], dq[i]);
      along_v_[i] = detail::along(v[i], dv[i]);
    }
    moving_terms_.find(system_, detail::along(t, dt), along_q_, along_v_, along_);
    out.momentum.resize(n);
    out.force.resize(n);
    for (Index i = 0; i < n; ++i) {
      out.momentum[i] = along_.momentum[i].slope[0];
      out.force[i] = along_.force[i].slope[0];
    }
  }

  Index second_rates() const override {
    if constexpr (tells_second_rates) return system_.second_rates();
    return 0;
  }
  void find_second_rates(const Vector<Real>& q, const Vector<Real>& v, const Vector<Real>& a,
                         Vector<Real>& w) override {
    if constexpr (!tells_second_rates) return LagrangianField<Real>::find_second_rates(q, v, a, w);
    w.resize(second_rates());
    if constexpr (tells_second_rates) system_.find_second_rates(q, v, a, w);
  }
  void acceleration_with(const Real& t, const Vector<Real>& q, const Vector<Real>& v, const Vector<Real>& w,
                         Vector<Real>& a) override {
    if constexpr (!tells_second_rates) return LagrangianField<Real>::acceleration_with(t, q, v, w, a);
    a.resize(q.size());
    if constexpr (tells_second_rates) system_.acceleration_with(t, q, v, w, a);
  }

  bool has_derivative() const override { return true; }
  /// By the derivative of p = dL/dq'(t, q, v): L_vv dv = dp - L_vq dq - L_vt dt.
  void derivative(const Real& t, const Vector<Real>& y, const Real& dt, const Vector<Real>& dy,
                  Vector<Real>& out) override {
    const Index n = this->coordinates();
    const Vector<Real> q = y.head(n), p = y.tail(n), dq = dy.head(n);
    Vector<Real> v, dv = Vector<Real>::Zero(n);
    out.setConstant(2 * n, Real(std::numeric_limits<double>::quiet_NaN()));
    if (this->velocity(t, q, p, v)) return;
    LagrangianTerms<Real> change;
    LagrangianTangent<Real> tangent;
    terms_along(t, q, v, dt, dq, dv, change);
    find_tangent(t, q, v, tangent);
    if (!factors_.compute(tangent.momentum_v)) return;
    factors_.solve(dy.tail(n) - change.momentum, dv);
    out.head(n) = dv;
    for (Index i = 0; i < n; ++i) {
      out[n + i] = change.force[i] + sum_over<Real>(n, [&](Index k) { return tangent.force_v(i, k) * dv[k]; });
    }
  }

  /// H = p v - L; what rests in it, -L(t, q, 0), is called potential.
  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) override {
    Vector<Real> y;
    gather(s, y);
    const Index n = this->coordinates();
    const Vector<Real> q = y.head(n), still = Vector<Real>::Zero(n);
    const Real total = hamiltonian(s.time(), y), at_rest = -system_.lagrangian(s.time(), q, still);
    using std::isfinite;
    if (!isfinite(at_rest)) return {.kinetic = total, .potential = Real(0)};
    return {.kinetic = total - at_rest, .potential = at_rest};
  }
  bool has_hamiltonian() const override { return true; }
  Real hamiltonian(const Real& t, const Vector<Real>& y) override {
    const Index n = this->coordinates();
    const Vector<Real> q = y.head(n), p = y.tail(n);
    Vector<Real> v;
    if (this->velocity(t, q, p, v)) return Real(std::numeric_limits<double>::quiet_NaN());
    return sum_over<Real>(n, [&](Index i) { return p[i] * v[i]; }) - system_.lagrangian(t, q, v);
  }
  void accelerations(const ParticleSystem<Real>& /*s*/, VectorColumn<Real>& /*a*/) override {}

 protected:
  void find_terms(const Real& t, const Vector<Real>& q, const Vector<Real>& v, LagrangianTerms<Real>& out) override {
    terms_.find(system_, t, q, v, out);
  }
  void find_tangent(const Real& t, const Vector<Real>& q, const Vector<Real>& v,
                    LagrangianTangent<Real>& out) override {
    const Index n = q.size();
    for (Matrix<Real>* m : {&out.momentum_q, &out.momentum_v, &out.force_q, &out.force_v}) m->resize(n, n);
    rest_.setZero(n);
    direction_.setZero(n);
    for (Index k = 0; k < n; ++k) {
      direction_[k] = Real(1);
      terms_along(t, q, v, Real(0), direction_, rest_, column_);
      out.momentum_q.col(k) = column_.momentum;
      out.force_q.col(k) = column_.force;
      terms_along(t, q, v, Real(0), rest_, direction_, column_);
      out.momentum_v.col(k) = column_.momentum;
      out.force_v.col(k) = column_.force;
      direction_[k] = Real(0);
    }
  }

 private:
  static constexpr bool has_force = requires(const S& system, const Real& t, const Vector<Real>& q, Vector<Real>& f) {
    system.force(t, q, q, f);
  };
  static constexpr bool workless = requires { requires S::workless; };
  static constexpr bool tells_second_rates = requires(const S& system) { system.second_rates(); };
  bool forced() const {
    if constexpr (has_force && requires { system_.forced(); }) return system_.forced();
    return has_force;
  }

  /// @throws Error  where L or the force depends on time and does not say so; without it, an energy would be taken for
  /// conserved
  void check_time(const ParticleSystem<Real>& s) {
    using Moving = Dual<Real, 1>;
    Vector<Real> y, v;
    gather(s, y);
    const Index n = this->coordinates();
    const Vector<Real> q = y.head(n), p = y.tail(n);
    if (this->velocity(s.time(), q, p, v)) v.setZero(n);
    const auto changes = [&](const Moving& t, const Vector<Moving>& x, const Vector<Moving>& u) {
      bool any = detail::moves(Moving(system_.lagrangian(t, x, u)));
      if constexpr (has_force) {
        Vector<Moving> beside = Vector<Moving>::Constant(n, Moving(Real(0)));
        system_.force(t, x, u, beside);
        any = std::any_of(beside.begin(), beside.end(), detail::moves<Real>) || any;
      }
      return any;
    };
    if (!detail::hides_time(s.time(), q, v, changes)) return;
    throw Error(
        fmt::format("the Lagrangian of system '{}', or its force, depends on time; let it say so: static constexpr "
                    "bool time_dependent = true",
                    detail::name_of(system_)));
  }

  S system_;
  detail::ActionTerms<S, Real> terms_;
  detail::ActionTerms<S, Dual<Real, 1>> moving_terms_;
  DenseFactors<Real> factors_;
  Vector<Real> rest_, direction_;
  Vector<Dual<Real, 1>> along_q_, along_v_;
  LagrangianTerms<Dual<Real, 1>> along_;
  LagrangianTerms<Real> column_;
};

template <class S, class Real>
  requires(LagrangianSystem<S, Real> && !FirstOrderSystem<S, Real>)
struct detail::MotionOf<S, Real> {
  using type = LagrangianMotion<S, Real>;
  static constexpr bool has_momenta = true;
};

/// The state with coordinates q and momenta p: `initial_state(Pendulum{}, {2.0}, {0.3})`.
/// @throws Error  as `initial_state` of any system
template <class S>
  requires LagrangianSystem<S, double> ParticleSystem<double> initial_state(const S& system, std::vector<double> q,
                                                                            const std::vector<double>& p) {
    q.insert(q.end(), p.begin(), p.end());
    return initial_state(system, std::move(q));
  }

/// The same for lists in braces.
template <class S>
  requires LagrangianSystem<S, double> ParticleSystem<double> initial_state(const S& system,
                                                                            std::initializer_list<double> q,
                                                                            std::initializer_list<double> p) {
    return initial_state(system, std::vector<double>(q), std::vector<double>(p));
  }

/// A method over a Lagrangian: `variational(Pendulum{}, method("galerkin_gauss_3"))`, or any classical one.
template <class S>
  requires LagrangianSystem<S, double> Classical<double> variational(S system, const MethodChoice& choice) {
    return Classical<double>(std::make_unique<LagrangianMotion<S, double>>(std::move(system)), choice);
  }

}  // namespace noether
