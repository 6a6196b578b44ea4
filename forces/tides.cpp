#include "forces/tides.hpp"

#include <fmt/format.h>

namespace noether {

namespace {

[[noreturn]] void refuse_tides(const std::string& body, std::string_view what) {
  throw Error(fmt::format("'{}' has a love_number, but {}", body, what));
}

}  // namespace

void Tides::check() const { check_constant_of_gravitation(G); }

template <class Real> void Tides::check(const ParticleSystem<Real>& s) const {
  if (has_bodies(s) && s.bodies()->any_held())
    throw Error("tides move bodies, but a fixed point holds one of them; take tides out, or the fixed point");
  bool any = false;
  for (Index i = 0; s.template has<LoveNumber>() && i < s.size(); ++i) {
    const Real love = s.template column<LoveNumber>()[i];
    if (love == Real(0)) continue;
    any = true;
    if (!(love > Real(0))) {
      throw Error(
          fmt::format("the love_number of '{}' is {}; 0 or more is expected", s.name(i), static_cast<double>(love)));
    }
    const int turns = has_bodies(s) ? turning_freedoms<Real>(s.template column<BodyInertia>()[i]) : 0;
    if (turns == 0) refuse_tides(s.name(i), "no moments of inertia; tides turn bodies, so make it a rigid body");
    if (turns < 3)
      refuse_tides(s.name(i), "is a line, about which tides would turn it; give it three moments of inertia");
    const Real radius = s.template has<BodyRadius>() ? s.template column<BodyRadius>()[i] : Real(0);
    if (radius == Real(0)) refuse_tides(s.name(i), "no radius; give one above 0");
    if (!(radius > Real(0))) {
      throw Error(fmt::format("the radius of '{}' is {}; a length above 0 is expected", s.name(i),
                              static_cast<double>(radius)));
    }
    if (s.template has<TideLag>() && !(s.template column<TideLag>()[i] >= Real(0))) {
      throw Error(fmt::format("the tide_lag of '{}' is {}; 0 or more is expected", s.name(i),
                              static_cast<double>(s.template column<TideLag>()[i])));
    }
  }
  if (!any) throw Error("no body has tides; give at least one a love_number, a radius and a tide_lag");
}

template <class Real>
  requires(std::is_same_v<Real, double> || std::is_same_v<Real, Quad>)
void Tides::add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
  const Real g(G ? *G : s.units().G);
  const auto &love = s.template column<LoveNumber>(), &radius = s.template column<BodyRadius>();
  const ScalarColumn<Real>* lags = s.template has<TideLag>() ? &s.template column<TideLag>() : nullptr;
  const auto &x = s.positions(), &v = s.velocities();
  const auto& m = s.masses();
  for (Index i = 0; i < s.size(); ++i) {
    if (love[i] == Real(0)) continue;
    const Vec3<Real> turning = angular_velocity<Real>(
        s.template column<BodyOrientation>()[i], s.template column<BodySpin>()[i], s.template column<BodyInertia>()[i]);
    const Real lag = lags != nullptr ? (*lags)[i] : Real(0), R = radius[i], R2 = R * R;
    for (Index j = 0; j < s.size(); ++j) {
      if (j == i || m[j] == Real(0)) continue;
      const Vec3<Real> r = x[j] - x[i], w = v[j] - v[i];
      const Real r2 = norm2(r), size2 = R2 / r2;
      const Real f = Real(3) * g * love[i] * m[j] * m[j] * R * size2 * size2 / (r2 * r2);
      const Vec3<Real> slip = w + cross<Real>(r, turning);  // of who raises the bulge over the ground below
      const Vec3<Real> pull = f * ((Real(1) + Real(2) * lag * dot(r, w) / r2) * r + lag * slip);  // on i
      out.pair(i, j, pull);
      out.torque(i, f * lag * cross<Real>(r, slip));  // of what points along r there is none, not even its rounding
      out.energy(-(f * r2) / Real(6));
    }
  }
}

template void Tides::check(const ParticleSystem<double>&) const;
template void Tides::check(const ParticleSystem<Quad>&) const;
template void Tides::add_to(ForceSink<double>&, const ParticleSystem<double>&) const;
template void Tides::add_to(ForceSink<Quad>&, const ParticleSystem<Quad>&) const;
template struct detail::ForceModel<Tides, double>;
template struct detail::ForceModel<Tides, Quad>;

}  // namespace noether
