#pragma once
/// Hamiltonian systems given by one function H(t, q, p), which need not be kinetic and potential energy.

#include "integrators/first_order_system.hpp"
#include "integrators/hidden_time.hpp"
#include "integrators/named_invariant.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace noether {

/// What a Hamiltonian system offers: how many coordinates it has, and its energy.
///
///     struct Pendulum {
///       Index size() const { return 1; }
///       template <class Real>
///       Real value(const Real& t, const Vector<Real>& q, const Vector<Real>& p) const {
///         return p[0] * p[0] / Real(2) - cos(q[0]);
///       }
///     };
///
/// It may also offer `std::vector<double> start() const`, all q and then all p that it begins with,
/// `std::vector<std::string> names() const` of them, `std::vector<double> exact(double t) const`, the solution from
/// `start()` at time 0, `std::vector<NamedInvariant> invariants() const`, what its motion keeps beside H, for methods
/// that are to keep it too, and `static constexpr bool time_dependent = true`, which it has to say where H depends on
/// t.
/// Rates and their Jacobian are derivatives of `value` by dual numbers, exact to rounding.
template <class S, class Real>
concept HamiltonianSystem = requires(const S& system, const Real& t, const Vector<Real>& q, const Vector<Real>& p) {
  { system.size() } -> std::convertible_to<Index>;
  { system.value(t, q, p) } -> std::convertible_to<Real>;
};

/// A Hamiltonian system as the classical methods see it: y = (q, p) stands in `ParticleSystem::variables`, and
///
///     q' = dH/dp,   p' = -dH/dq
///
/// Its energy is H: as potential energy counts what H is at p = 0, as kinetic energy the rest.
/// @cost see `CanonicalRates`; a product with df/dy three times that
template <class S, class Real> class CanonicalMotion final : public VectorField<Real> {
 public:
  explicit CanonicalMotion(S system) : system_(std::move(system)) {}

  std::unique_ptr<VectorField<Real>> clone() const override { return std::make_unique<CanonicalMotion>(*this); }
  FieldClaims claims() const override {
    return {.name = detail::name_of(system_),
            .variables = true,
            .canonical = true,
            .time_dependent = detail::depends_on_time<S>(),
            .energy = true};
  }
  std::string signature() const override { return detail::signature_of(system_); }

  void bind(const ParticleSystem<Real>& s) override {
    const auto given = static_cast<Index>(s.variables().size());
    if (given != size() || s.size() != 0) {
      throw Error(
          fmt::format("system '{}' has {} variables, a momentum for each coordinate, but it was given {} and "
                      "{} particles",
                      detail::name_of(system_), size(), given, s.size()));
    }
    gather(s, point_);
    if (!detail::depends_on_time<S>()) check_time(s.clock().time());
  }
  Index size() const override { return 2 * Index(system_.size()); }
  void gather(const ParticleSystem<Real>& s, Vector<Real>& y) const override {
    y.resize(size());
    std::copy_n(s.variables().data(), y.size(), y.data());
  }
  void scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const override {
    std::copy_n(y.data(), y.size(), s.variables().data());
  }

  bool has_derivative() const override { return true; }
  void derivative(const Real& t, const Vector<Real>& y, const Real& dt, const Vector<Real>& dy,
                  Vector<Real>& out) override {
    const Index n = y.size();
    for (auto* v : {&moving_, &moving_rates_}) v->resize(n);
    for (Index i = 0; i < n; ++i) moving_[i] = detail::along(y[i], dy[i]);
    along_.find(system_, detail::along(t, dt), moving_, moving_rates_);
    out.resize(n);
    for (Index i = 0; i < n; ++i) out[i] = moving_rates_[i].slope[0];
  }

  std::vector<FieldInvariant<Real>> invariants() const override {
    std::vector<FieldInvariant<Real>> all;
    if constexpr (requires { system_.invariants(); }) {
      for (const NamedInvariant& one : system_.invariants()) all.push_back(one.template over<Real>());
    }
    return all;
  }
  bool has_hamiltonian() const override { return true; }
  Real hamiltonian(const Real& t, const Vector<Real>& y) override {
    const Index n = y.size() / 2;
    q_ = y.head(n);
    p_ = y.tail(n);
    return system_.value(t, q_, p_);
  }
  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) override {
    using std::isfinite;
    gather(s, point_);
    const Real t = s.clock().time(), whole = hamiltonian(t, point_);
    p_.setZero(size() / 2);
    const Real at_rest = system_.value(t, q_, p_);
    if (!isfinite(at_rest)) return {.kinetic = Real(0), .potential = whole};
    return {.kinetic = whole - at_rest, .potential = at_rest};
  }
  void accelerations(const ParticleSystem<Real>& /*s*/, VectorColumn<Real>& /*a*/) override {}

 protected:
  void evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) override {
    dy.resize(y.size());
    rates_.find(system_, t, y, dy);
  }

 private:
  /// @throws Error  where H depends on time and does not say so; without it, its energy would be taken for conserved
  void check_time(const Real& start) {
    const Index n = size() / 2;
    const auto changes = [&](const auto& t, const auto& q, const auto& p) {
      return detail::moves(system_.value(t, q, p));
    };
    const Vector<Real> q = point_.head(n), p = point_.tail(n);
    if (!detail::hides_time(start, q, p, changes)) return;
    throw Error(
        fmt::format("the energy of system '{}' depends on time; let it say so: static constexpr bool "
                    "time_dependent = true",
                    detail::name_of(system_)));
  }

  S system_;
  detail::CanonicalRates<S, Real> rates_;
  detail::CanonicalRates<S, Dual<Real, 1>> along_;
  Vector<Dual<Real, 1>> moving_, moving_rates_;  ///< work of `derivative`
  Vector<Real> point_, q_, p_;                   ///< work of energies
};

template <class S, class Real>
  requires HamiltonianSystem<S, Real>
struct detail::MotionOf<S, Real> {
  using type = CanonicalMotion<S, Real>;
  static constexpr bool has_momenta = true;
};

}  // namespace noether
