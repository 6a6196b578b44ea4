#include "forces/check_gradient.hpp"

#include "engine/force_sink.hpp"
#include "engine/sums.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {

namespace {

/// Systems of more particles are asked in double, where forces of short range cost O(n), and at some particles.
constexpr Index most_asked_in_quad = 64;

template <class Real>
Real potential_of(const AnyForce<Real>& force, const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
  ForceSink<Real> sink(a, s, {.energy = true});
  force.add_to(sink, s);
  return sink.potential();
}

/// Largest |m a + grad U| over the largest |m a|, with grad U by central differences of order 6, beyond what rounding
/// of the energy leaves open; infinite if any of them is not finite.
/// @param relative_step  of the differences, in mean distances between particles
/// @param rounding  half a unit in the last place of 1
template <class Real>
double error_by_differences(AnyForce<Real> force, ParticleSystem<Real> s, const Real& relative_step,
                            const Real& rounding) {
  using std::abs, std::isfinite, std::sqrt;
  bind_force(force, s);
  VectorColumn<Real> a(s.size()), scratch(s.size());
  const Real energy = abs(potential_of(force, s, a));
  Real scale = sum_over<Real>(s.size(), [&](Index i) { return norm2(std::as_const(s).positions()[i]); });
  const auto n = static_cast<double>(s.size());
  scale = sqrt(scale / Real(n)) / Real(std::cbrt(n));
  const Real h = relative_step * (scale > Real(0) ? scale : Real(1));
  const Real noise = Real(100) * rounding * energy / h;
  Real worst(0), largest(0);
  const Index asked = particles_asked(s.size());
  for (Index place = 0; place < asked; ++place) {
    const Index i = place * s.size() / asked;
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
      const Real difference = abs(f + slope);
      if (!isfinite(difference)) return std::numeric_limits<double>::infinity();  // std::max would drop a NaN
      worst = std::max(worst, Real(difference - noise));
      largest = std::max(largest, Real(abs(f)));
    }
  }
  return largest > Real(0) ? static_cast<double>(worst / largest) : static_cast<double>(worst);
}

/// The force in extended precision, where it and the system allow that.
std::optional<AnyForce<Quad>> asked_in_quad(const AnyForce<double>& force, const ParticleSystem<double>& s) {
  if (s.size() > most_asked_in_quad) return {};
  return force.in_quad();
}

}  // namespace

Index particles_asked(Index particles) { return particles <= most_asked_in_quad ? particles : 16; }

double gradient_error(const AnyForce<double>& force, const ParticleSystem<double>& s) {
  if (const std::optional<AnyForce<Quad>> wide_force = asked_in_quad(force, s)) {
    ParticleSystem<Quad> wide = s.as<Quad>();
    wide.clock() = Clock<Quad>::fixed(s.clock().start(), s.clock().dt(), s.clock().step());
    return error_by_differences<Quad>(*wide_force, std::move(wide), Quad(1) / Quad(100000), Quad(0x1p-113));
  }
  return error_by_differences<double>(force, s, 1e-4, 0x1p-53);
}

void detail::check_gradient(const AnyForce<double>& force, const ParticleSystem<double>& s) {
  const double limit = asked_in_quad(force, s) ? 1e-12 : 1e-5;
  const double error = gradient_error(force, s);
  if (!(error < limit)) {
    throw Error(
        fmt::format("the force is not minus the gradient of its energy: they differ by {:.2g} of the largest "
                    "force, {:.0g} is allowed; check the signs and factors of add_to",
                    error, limit));
  }
}

}  // namespace noether
