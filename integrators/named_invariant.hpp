#pragma once
/// Invariants of a motion that a program, or a system, gives by name.

#include "integrators/canonical_rates.hpp"

#include <functional>
#include <string>
#include <type_traits>
#include <utility>

namespace noether {

/// What a motion keeps, as its gradient: of y = (q, v) of particles, all x before all y before all z, or of y = (q, p).
struct NamedInvariant {
  std::string name;
  std::function<void(const Vector<double>& y, Vector<double>& gradient)> gradient;
  std::function<void(const Vector<Quad>& y, Vector<Quad>& gradient)> wide_gradient;

  template <class Real> FieldInvariant<Real> over() const {
    if constexpr (std::is_same_v<Real, double>) {
      return {name, gradient};
    } else {
      return {name, wide_gradient};
    }
  }
};

namespace detail {
/// A function of q and p in the place of a Hamiltonian, so that its slopes are found as those are.
template <class F> struct AsHamiltonian {
  F function;
  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    return function(q, p);
  }
};

template <class Real, class F> auto gradient_of(F function) {
  return [as = AsHamiltonian<F>{std::move(function)}, rates = CanonicalRates<AsHamiltonian<F>, Real>(),
          canonical = Vector<Real>()](const Vector<Real>& y, Vector<Real>& gradient) mutable {
    const Index n = y.size() / 2;
    canonical.resize(y.size());
    rates.find(as, Real(0), y, canonical);
    gradient.head(n) = -canonical.tail(n);
    gradient.tail(n) = canonical.head(n);
  };
}
}  // namespace detail

/// `invariant("laplace_x", f)` of a function `template <class Real> Real operator()(const Vector<Real>& q,
/// const Vector<Real>& v) const`, whose derivatives are found by dual numbers; a Hamiltonian system has p in the place
/// of v.
template <class F> NamedInvariant invariant(std::string name, F function) {
  return {std::move(name), detail::gradient_of<double>(function), detail::gradient_of<Quad>(function)};
}

}  // namespace noether
