#include "forces/check_gradient.hpp"

#include "engine/bodies.hpp"
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

/// Largest differences between what a force gives and the slopes of its energy, each over the largest of both.
struct SlopeErrors {
  double force = 0, torque = 0;
};

/// One of the two, as it is asked for particle by particle.
template <class Real> struct SlopeError {
  Real worst = Real(0), largest = Real(0);
  bool finite = true;

  /// @param at  at(m): the energy m steps of length `h` away
  /// @param here  the energy itself
  /// @param rounding  what rounding of an energy of 1 leaves open
  template <class At> void ask(const Real& given, const At& at, const Real& h, const Real& here, const Real& rounding) {
    using std::abs, std::isfinite;
    const Real up[3] = {at(1), at(2), at(3)}, down[3] = {at(-1), at(-2), at(-3)};
    const Real slope =
        (Real(45) * (up[0] - down[0]) - Real(9) * (up[1] - down[1]) + (up[2] - down[2])) / (Real(60) * h);
    const Real difference = abs(given + slope);
    finite = finite && isfinite(difference);  // std::max would drop a NaN
    worst = std::max(worst, Real(difference - rounding * abs(here) / h));
    largest = std::max(largest, Real(abs(given)));
    // A force that is missing is wrong by all of the slope; at a minimum the slope is rounding, beside what bends.
    if (abs(slope) * h > Real(1e-6) * (abs(up[2] - here) + abs(down[2] - here)))
      largest = std::max(largest, Real(abs(slope)));
  }
  double relative() const {
    if (!finite) return std::numeric_limits<double>::infinity();
    return static_cast<double>(largest > Real(0) ? Real(worst / largest) : worst);
  }
};

/// An orientation after a turn about an axis of space.
template <class Real> Quaternion<Real> turned(const Quaternion<Real>& q, int axis, const Real& angle) {
  using std::cos, std::sin;
  Vec3<Real> along = Vec3<Real>::Zero();
  along[axis] = sin(angle / Real(2));
  return quaternion_product(quaternion<Real>(cos(angle / Real(2)), along), q);
}

/// Forces against grad U, torques against the slopes of U with turns of each body, by central differences of order 6.
/// @param relative_step  of the differences, in mean distances between particles, and in radians
/// @param rounding  half a unit in the last place of 1
template <class Real>
SlopeErrors errors_by_differences(AnyForce<Real> force, ParticleSystem<Real> s, const Real& relative_step,
                                  const Real& rounding) {
  using std::sqrt;
  bind_force(force, s);
  VectorColumn<Real> a(s.size()), torque(has_bodies(s) ? s.size() : 0), scratch(s.size());
  ForceSink<Real> sink(a, s, {.energy = true});
  if (has_bodies(s)) sink.set_torques(torque);
  force.add_to(sink, s);
  const Real here = sink.potential();
  Real scale = sum_over<Real>(s.size(), [&](Index i) { return norm2(std::as_const(s).positions()[i]); });
  const auto n = static_cast<double>(s.size());
  scale = sqrt(scale / Real(n)) / Real(std::cbrt(n));
  const Real h = relative_step * (scale > Real(0) ? scale : Real(1));
  const Real open = Real(100) * rounding;
  SlopeError<Real> forces, torques;
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
      forces.ask(s.masses()[i] * std::as_const(a).component(k)[i], at, h, here, open);
    }
    if (!has_bodies(s) || turning_freedoms<Real>(std::as_const(s).template column<BodyInertia>()[i]) == 0) continue;
    const Quaternion<Real> q = std::as_const(s).template column<BodyOrientation>()[i];
    for (int k = 0; k < 3; ++k) {
      const auto at = [&](int steps) {
        auto& orientation = s.template column<BodyOrientation>();
        orientation.set(i, turned<Real>(q, k, Real(steps) * relative_step));
        const Real u = potential_of(force, s, scratch);
        orientation.set(i, q);
        return u;
      };
      torques.ask(std::as_const(torque).component(k)[i], at, relative_step, here, open);
    }
  }
  return {forces.relative(), torques.relative()};
}

/// The force in extended precision, where it and the system allow that, and where it is the same force: what a force
/// names as its truth is another one, whose slopes tell nothing of its own.
std::optional<AnyForce<Quad>> asked_in_quad(const AnyForce<double>& force, const ParticleSystem<double>& s) {
  if (s.size() > most_asked_in_quad) return {};
  std::optional<AnyForce<Quad>> wide = force.in_quad();
  if (wide && wide->signature() != force.signature()) return {};
  return wide;
}

}  // namespace

Index particles_asked(Index particles) { return particles <= most_asked_in_quad ? particles : 16; }

namespace {

SlopeErrors slope_errors(const AnyForce<double>& force, const ParticleSystem<double>& s) {
  if (const std::optional<AnyForce<Quad>> wide_force = asked_in_quad(force, s)) {
    ParticleSystem<Quad> wide = s.as<Quad>();
    wide.clock() = Clock<Quad>::fixed(s.clock().start(), s.clock().dt(), s.clock().step());
    return errors_by_differences<Quad>(*wide_force, std::move(wide), Quad(1) / Quad(100000), Quad(0x1p-113));
  }
  return errors_by_differences<double>(force, s, 1e-4, 0x1p-53);
}

}  // namespace

double gradient_error(const AnyForce<double>& force, const ParticleSystem<double>& s) {
  const SlopeErrors errors = slope_errors(force, s);
  return std::max(errors.force, errors.torque);
}

void detail::check_gradient(const AnyForce<double>& force, const ParticleSystem<double>& s) {
  const double limit = asked_in_quad(force, s) ? 1e-12 : 1e-5;
  const SlopeErrors errors = slope_errors(force, s);
  if (!(errors.force < limit)) {
    throw Error(
        fmt::format("the force is not minus the gradient of its energy: they differ by {:.2g} of the largest "
                    "force, {:.0g} is allowed; check the signs and factors of add_to",
                    errors.force, limit));
  }
  if (!(errors.torque < limit)) {
    throw Error(
        fmt::format("the torques of the force are not minus the slopes of its energy as bodies turn: they differ by "
                    "{:.2g} of the largest torque, {:.0g} is allowed; check the signs and factors of add_to",
                    errors.torque, limit));
  }
}

}  // namespace noether
