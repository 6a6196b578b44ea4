#include "monitors/spin.hpp"

#include "engine/bodies.hpp"
#include "engine/orbital_elements.hpp"
#include "monitors/series_report.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {

namespace {

template <class Real> std::array<double, 3> in_doubles(const Vec3<Real>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

template <class Real> Vec3<Real> unit_vector(const Vec3<Real>& v) {
  using std::sqrt;
  return v / sqrt(norm2(v));
}

}  // namespace

void Spin::check() const {
  check_constant_of_gravitation(G);
  // The angle is that of an axis without a front: M wraps by 2 pi, which p/q makes whole half turns for these alone.
  if (resonance.size() == 2 && (resonance[1] == 1 || resonance[1] == 2)) return;
  refuse_field("resonance", fmt::format("[{}]", fmt::join(resonance, ", ")),
               "is not a valid resonance; two whole numbers such as [3, 2], the second 1 or 2, are expected");
}

template <class Real> Index Spin::body_of(const ParticleSystem<Real>& s) const {
  if (!has_bodies(s)) throw Error("there are no rigid bodies, so nothing turns; take this monitor out");
  const auto& inertia = s.template column<BodyInertia>();
  for (Index i = 0; i < s.size(); ++i) {
    const bool turns = turning_freedoms<Real>(Vec3<Real>(inertia[i])) > 0;
    if (body.empty() ? turns : s.name(i) == body) {
      if (turns) return i;
      throw Error(fmt::format("body = \"{}\" is a point, which does not turn; give the name of a rigid body", body),
                  {.key = "body"});
    }
  }
  throw Error(fmt::format("body = \"{}\" is not a particle{}", body, did_you_mean(body, s.names())), {.key = "body"});
}

/// The body that it goes round; -1 where it is alone.
template <class Real> Index Spin::center_of(const ParticleSystem<Real>& s, Index of) const {
  if (about.empty()) return s.size() < 2 ? -1 : (of == 0 ? 1 : 0);
  for (Index i = 0; i < s.size(); ++i) {
    if (s.name(i) == about && i != of) return i;
  }
  std::vector<std::string> others = s.names();
  others.erase(others.begin() + of);
  throw Error(fmt::format("about = \"{}\" is not another particle{}", about, did_you_mean(about, others)),
              {.key = "about"});
}

template <class Real> void Spin::check(const ParticleSystem<Real>& s) const {
  check();
  static_cast<void>(center_of(s, body_of(s)));
}
template void Spin::check(const ParticleSystem<double>&) const;
template void Spin::check(const ParticleSystem<Quad>&) const;

template <class Real> void Spin::look_at_orbit(const ParticleSystem<Real>& s, Index of) {
  using std::acos, std::atan2, std::sqrt;
  obliquity_ = angle_ = std::numeric_limits<double>::quiet_NaN();
  const Index center = center_of(s, of);
  if (center < 0) return;
  const Vec3<Real> x = s.positions()[of] - s.positions()[center], v = s.velocities()[of] - s.velocities()[center];
  const Vec3<Real> normal = cross<Real>(x, v), spin = s.template column<BodySpin>()[of];
  if (!(norm2(normal) > Real(0))) return;
  const Vec3<Real> n = unit_vector<Real>(normal);
  if (norm2(spin) > Real(0)) {
    const Vec3<Real> along = unit_vector<Real>(spin);
    obliquity_ = static_cast<double>(atan2(Real(sqrt(norm2(cross<Real>(n, along)))), dot(n, along)));
  }
  const Real mu = Real(G ? *G : s.units().G) * (s.masses()[of] + s.masses()[center]);
  if (!(mu > Real(0))) return;
  const OrbitalElements<Real> orbit = elements_from_state<Real>(x, v, mu);
  if (!(orbit.e > Real(0)) || !(orbit.e < Real(1))) return;  // a circle has no pericenter to count from
  const Vec3<Real> toward = cross<Real>(v, normal) / mu - unit_vector<Real>(x);
  const Vec3<Real> first = unit_vector<Real>(toward), second = cross<Real>(n, first);
  const Vec3<Real> moments = s.template column<BodyInertia>()[of];
  int axis = 0;
  for (int k = 1; k < 3; ++k) axis = moments[k] < moments[axis] ? k : axis;
  const Vec3<Real> arm = rotation_matrix<Real>(s.template column<BodyOrientation>()[of]).col(axis);
  const Real theta = atan2(dot(arm, second), dot(arm, first));
  const Real orbits = Real(static_cast<double>(resonance[0])) / Real(static_cast<double>(resonance[1]));
  const Real half = detail::full_turn<Real>() / Real(2), apart = theta - orbits * orbit.M;
  using std::floor;
  angle_ = static_cast<double>(apart - half * floor(apart / half + Real(0.5)));  // the axis has no front
}

template <class Real> void Spin::observe(const Snapshot<Real>& now) {
  using std::sqrt;
  const ParticleSystem<Real>& s = now.state();
  const Index i = body_of(s);
  const Quaternion<Real> q = s.template column<BodyOrientation>()[i];
  const Vec3<Real> spin = s.template column<BodySpin>()[i], moments = s.template column<BodyInertia>()[i];
  const Vec3<Real> in_body = spin_in_body<Real>(q, spin);
  const Vec3<Real> rate = rate_in_body<Real>(in_body, moments);
  value_ = in_doubles(spin);
  in_body_ = in_doubles(in_body);
  rate_ = in_doubles(rate);
  energy_ = static_cast<double>(turning_energy<Real>(in_body, moments));
  defect_ = static_cast<double>(norm_defect(q));
  worst_defect_ = std::max(worst_defect_, std::abs(defect_));
  look_at_orbit(s, i);
  name_ = s.name(i);
  slope_unit_ = now.units().is_reduced() ? "1" : "1/" + std::string(now.units().time) + "^2";
  rates_.add(now.time(), static_cast<double>(sqrt(norm2(rate))));
  ++samples_;
}

std::vector<Series> Spin::series() const {
  const auto list = [](const std::array<double, 3>& v) { return std::vector<double>(v.begin(), v.end()); };
  return {{"value", "mass length^2/time", {3}, list(value_)},
          {"in_body", "mass length^2/time", {3}, list(in_body_)},
          {"rate", "1/time", {3}, list(rate_)},
          {"energy", "energy", {}, {energy_}},
          {"defect", "1", {}, {defect_}},
          {"obliquity", "angle", {}, {obliquity_}},
          {"angle", "angle", {}, {angle_}}};
}

MonitorReport Spin::report() const {
  MonitorReport report = report_of(rates_, slope_unit_);
  if (report.samples == 0) return report;
  report.note = fmt::format("rate of '{}'; its orientation is a unit quaternion within {:.1e}", name_, worst_defect_);
  return report;
}

template void Spin::observe(const Snapshot<double>&);
template void Spin::observe(const Snapshot<Quad>&);
template struct detail::MonitorModel<Spin, double>;
template struct detail::MonitorModel<Spin, Quad>;

}  // namespace noether
