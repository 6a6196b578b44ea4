#pragma once
/// Is a force the gradient of its energy? Asked by differences, in extended precision where the force allows it.

#include "engine/description.hpp"
#include "engine/force_sink.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {

namespace detail {

template <class F, class Real> Real potential_of(const F& force, const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
  ForceSink<Real> sink(a, s, {.energy = true});
  force.add_to(sink, s);
  return sink.potential();
}

/// Largest |m a + grad U| over the largest |m a|, with grad U by central differences of order 6; infinite if any of
/// them is not finite.
template <class F, class Real>
double gradient_error(const F& force, ParticleSystem<Real> s, const Real& relative_step) {
  using std::sqrt;
  VectorColumn<Real> a(s.size()), scratch(s.size());
  potential_of(force, s, a);
  Real scale(0);
  for (Index i = 0; i < s.size(); ++i) scale += norm2(s.positions()[i]);
  scale = sqrt(scale / Real(static_cast<double>(s.size())));
  const Real h = relative_step * (scale > Real(0) ? scale : Real(1));
  Real worst(0), largest(0);
  for (Index i = 0; i < s.size(); ++i) {
    if (s.masses()[i] == Real(0)) continue;
    for (int k = 0; k < 3; ++k) {
      const Real x = std::as_const(s).positions().component(k)[i];
      const auto at = [&](int steps) {
        s.positions().component(k)[i] = x + Real(steps) * h;
        const Real u = potential_of(force, s, scratch);
        s.positions().component(k)[i] = x;
        return u;
      };
      const Real slope = (Real(45) * (at(1) - at(-1)) - Real(9) * (at(2) - at(-2)) + (at(3) - at(-3))) / (Real(60) * h);
      const Real f = s.masses()[i] * std::as_const(a).component(k)[i];
      using std::abs, std::isfinite;
      const Real difference = abs(f + slope);
      if (!isfinite(difference)) return std::numeric_limits<double>::infinity();  // std::max would drop a NaN
      worst = std::max(worst, difference);
      largest = std::max(largest, Real(abs(f)));
    }
  }
  return largest > Real(0) ? static_cast<double>(worst / largest) : static_cast<double>(worst);
}

}  // namespace detail

/// How far the force is from minus the gradient of the energy it reports: largest difference over largest force.
///
/// In Quad (error of the differences about 1e-20) if the force is a template on the number type, else in double (1e-9).
/// @cost 18 n force evaluations
template <class F> double gradient_error(const F& force, const ParticleSystem<double>& s) {
  if constexpr (Force<F, Quad>) {
    ParticleSystem<Quad> wide = s.as<Quad>();
    wide.clock() = Clock<Quad>::fixed(s.clock().start(), s.clock().dt(), s.clock().step());
    return detail::gradient_error<F, Quad>(force, std::move(wide), Quad(1) / Quad(100000));
  } else {
    return detail::gradient_error<F, double>(force, s, 1e-3);
  }
}

/// @throws Error  if a force is not minus the gradient of the energy it reports, or its `check` refuses its fields
template <class F> void check_gradient(const F& force, const ParticleSystem<double>& s) {
  check_part(force);
  const double limit = Force<F, Quad> ? 1e-12 : 1e-6;
  const double error = gradient_error(force, s);
  if (!(error < limit)) {
    throw Error(
        fmt::format("the force is not minus the gradient of its energy: they differ by {:.2g} of the largest "
                    "force, {:.0g} is allowed; check the signs and factors of add_to",
                    error, limit));
  }
}

}  // namespace noether
