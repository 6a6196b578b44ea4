#include "monitors/resonance_angle.hpp"

#include "numbers/suggest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace noether {

namespace {

constexpr double turn = 2 * std::numbers::pi;
constexpr std::int64_t largest_order = 1000;

}  // namespace

void ResonanceAngle::check() const {
  check_constant_of_gravitation(G);
  if (bodies.size() != 2 || bodies[0] == bodies[1]) {
    refuse_field("bodies", fmt::format("[{}]", fmt::join(bodies, ", ")),
                 "is not a pair of bodies; give the names of the inner and the outer one");
  }
  if (p < 1 || p > largest_order)
    refuse_field("p", static_cast<double>(p), fmt::format("is out of range; 1 to {} is expected", largest_order));
  if (q < 0 || q > largest_order)
    refuse_field("q", static_cast<double>(q), fmt::format("is out of range; 0 to {} is expected", largest_order));
}

template <class Real> ResonanceAngle::Places ResonanceAngle::places_in(const ParticleSystem<Real>& s) const {
  const auto find = [&](const std::string& name, const char* key) {
    for (Index i = 0; i < s.size(); ++i) {
      if (s.name(i) == name) return i;
    }
    throw Error(fmt::format("\"{}\" in {} is not a particle{}", name, key, did_you_mean(name, s.names())),
                {.key = key, .value = name});
  };
  Places places{find(bodies[0], "bodies"), find(bodies[1], "bodies"), 0, about.empty() ? 0 : find(about, "about")};
  places.pericenter = pericenter.empty() ? places.outer : find(pericenter, "pericenter");
  return places;
}

template <class Real> void ResonanceAngle::check(const ParticleSystem<Real>& s) const {
  check();
  const Places places = places_in(s);
  const std::string primary = s.name(places.primary);
  if (places.primary == places.inner || places.primary == places.outer) {
    throw Error(
        fmt::format("'{}' is one of the two bodies and what they orbit; give about = \"NAME\" of a third one", primary),
        {.key = "about"});
  }
  if (!(s.masses()[places.primary] > Real(0))) {
    throw Error(
        fmt::format("elements are about '{}', whose mass is 0; give about = \"NAME\" of a body that has mass", primary),
        {.key = "about"});
  }
  if (places.pericenter != places.inner && places.pericenter != places.outer) {
    throw Error(fmt::format("pericenter = \"{}\" is not one of the two bodies", pericenter),
                {.key = "pericenter", .value = pericenter});
  }
}

template <class Real> void ResonanceAngle::observe(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  const Places places = places_in(s);
  const Real g(G ? *G : now.units().G);
  const auto elements = [&](Index i) {
    const Vec3<Real> x = s.positions()[i] - s.positions()[places.primary];
    const Vec3<Real> v = s.velocities()[i] - s.velocities()[places.primary];
    return elements_from_state<Real>(x, v, g * (s.masses()[places.primary] + s.masses()[i]));
  };
  const OrbitalElements<Real> inner = elements(places.inner), outer = elements(places.outer);
  const OrbitalElements<Real>& of = places.pericenter == places.inner ? inner : outer;
  const auto longitude = [](const OrbitalElements<Real>& o) { return static_cast<double>(o.Omega + o.omega + o.M); };
  const bool bound = inner.a > Real(0) && outer.a > Real(0);
  const double angle = static_cast<double>(p + q) * longitude(outer) - static_cast<double>(p) * longitude(inner) -
                       static_cast<double>(q) * static_cast<double>(of.Omega + of.omega);
  if (!bound || !std::isfinite(angle)) {
    followed_ = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  if (samples_ == 0) low_ = high_ = followed_ = first_ = std::remainder(angle, turn);
  // Behind a stretch without an angle the middle of what was seen is what it is nearest to.
  const double before = std::isfinite(followed_) ? followed_ : (low_ + high_) / 2;
  followed_ = before + std::remainder(angle - before, turn);
  low_ = std::min(low_, followed_);
  high_ = std::max(high_, followed_);
  ++samples_;
}

double ResonanceAngle::value() const { return std::remainder(followed_, turn); }
double ResonanceAngle::center() const { return std::remainder((low_ + high_) / 2, turn); }
bool ResonanceAngle::librates() const { return samples_ > 1 && high_ - low_ < turn; }

std::vector<Series> ResonanceAngle::series() const {
  return {{.name = "value", .dimension = "angle", .shape = {}, .values = {value()}},
          {.name = "center", .dimension = "angle", .shape = {}, .values = {center()}},
          {.name = "amplitude", .dimension = "angle", .shape = {}, .values = {amplitude()}}};
}

MonitorReport ResonanceAngle::report() const {
  constexpr double degree = turn / 360;
  MonitorReport report;
  report.samples = samples_;
  if (samples_ == 0) return report;
  report.first = first_;
  report.last = value();
  report.verdict = librates()
                       ? fmt::format("librates about {:.1f} deg by {:.1f} deg", center() / degree, amplitude() / degree)
                   : samples_ > 1 ? fmt::format("circulates: it has gone through {:.1f} turns", (high_ - low_) / turn)
                                  : "too short to tell";
  return report;
}

template void ResonanceAngle::check(const ParticleSystem<double>&) const;
template void ResonanceAngle::check(const ParticleSystem<Quad>&) const;
template struct detail::MonitorModel<ResonanceAngle, double>;
template struct detail::MonitorModel<ResonanceAngle, Quad>;

}  // namespace noether
