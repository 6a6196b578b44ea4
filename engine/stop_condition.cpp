#include "engine/stop_condition.hpp"

#include "engine/hermite.hpp"

#include <fmt/format.h>

#include <cmath>

namespace noether {

namespace {

template <class Real> Motion<Real> motion_of(const Snapshot<Real>& now, Index i) {
  return {now.state().positions()[i], now.state().velocities()[i], now.accelerations()[i]};
}

template <class Real> Motion<Real> difference(const Motion<Real>& a, const Motion<Real>& b) {
  return {a.x - b.x, a.v - b.v, a.a - b.a};
}

template <class Real> Motion<Real> center_of_mass(const ParticleSystem<Real>& s, const std::vector<Motion<Real>>& all) {
  Motion<Real> center{Vec3<Real>::Zero(), Vec3<Real>::Zero(), Vec3<Real>::Zero()};
  Real total(0);
  for (Index i = 0; i < s.size(); ++i) {
    const Real m = s.masses()[i];
    const auto& p = all[static_cast<std::size_t>(i)];
    center.x += m * p.x;
    center.v += m * p.v;
    center.a += m * p.a;
    total += m;
  }
  if (total > Real(0)) {
    center.x /= total;
    center.v /= total;
    center.a /= total;
  }
  return center;
}

template <class Real> double root(const Real& x) {
  using std::sqrt;
  return static_cast<double>(sqrt(x));
}

}  // namespace

template <class Real> StopCheck<Real>::StopCheck(const StopRule& rule) : rule_(rule) {
  if (!(rule.distance > 0) || !std::isfinite(rule.distance)) {
    throw Error(
        fmt::format("a distance of {} cannot stop a run; a finite distance above 0 is expected", rule.distance));
  }
}

template <class Real> std::optional<StopReason> StopCheck<Real>::look(const Snapshot<Real>& snapshot) {
  auto reason = rule_.kind == StopRule::Kind::escape ? look_for_escape(snapshot) : look_for_collision(snapshot);
  remember(snapshot);
  return reason;
}

template <class Real> std::optional<StopReason> StopCheck<Real>::look_for_escape(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  const Real limit2 = Real(rule_.distance) * Real(rule_.distance);
  Vec3<Real> center = Vec3<Real>::Zero();
  Real total(0);
  for (Index i = 0; i < s.size(); ++i) {
    center += s.masses()[i] * s.positions()[i];
    total += s.masses()[i];
  }
  if (total > Real(0)) center /= total;
  for (Index i = 0; i < s.size(); ++i) {
    const Real d2 = norm2(s.positions()[i] - center);
    if (!(d2 > limit2)) continue;
    double at = now.time();
    if (static_cast<Index>(x_.size()) == s.size()) {
      std::vector<Motion<Real>> before, after;
      for (Index j = 0; j < s.size(); ++j) {
        const auto k = static_cast<std::size_t>(j);
        before.push_back({x_[k], v_[k], a_[k]});
        after.push_back(motion_of(now, j));
      }
      const auto k = static_cast<std::size_t>(i);
      const Hermite<Real> path(difference(before[k], center_of_mass(s, before)),
                               difference(after[k], center_of_mass(s, after)), Real(now.time()) - Real(last_time_));
      const Real u =
          Hermite<Real>::bisect(Real(0), Real(1), [&](const Real& w) { return norm2(path.position(w)) > limit2; });
      at = last_time_ + static_cast<double>(u) * (now.time() - last_time_);
    }
    return StopReason{i, at, fmt::format("escape of {}, distance {:.6g} above {:.6g} since time {:.9g}", s.name(i),
                                     root(d2), rule_.distance, at)};
  }
  return {};
}

template <class Real> std::optional<StopReason> StopCheck<Real>::look_for_collision(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  const Real limit2 = Real(rule_.distance) * Real(rule_.distance);
  const bool have_before = static_cast<Index>(x_.size()) == s.size() && now.time() != last_time_;
  const Real h = Real(now.time()) - Real(last_time_);
  for (Index i = 0; i < s.size(); ++i) {
    for (Index j = 0; j < i; ++j) {
      if (s.masses()[i] == Real(0) && s.masses()[j] == Real(0)) continue;
      Real d2 = norm2(s.positions()[i] - s.positions()[j]);
      double at = now.time();
      if (have_before) {
        const auto k = static_cast<std::size_t>(i), l = static_cast<std::size_t>(j);
        const Motion<Real> before{x_[k] - x_[l], v_[k] - v_[l], a_[k] - a_[l]};
        const auto nearest = Hermite<Real>(before, difference(motion_of(now, i), motion_of(now, j)), h).nearest();
        if (nearest.distance2 < d2) {
          d2 = nearest.distance2;
          at = last_time_ + static_cast<double>(nearest.at) * (now.time() - last_time_);
        }
      }
      if (!(d2 < limit2)) continue;
      return StopReason{i, at, fmt::format("collision of {} and {}, distance {:.6g} below {:.6g} at time {:.9g}", s.name(j),
                                       s.name(i), root(d2), rule_.distance, at)};
    }
  }
  return {};
}

template <class Real> void StopCheck<Real>::remember(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  const auto n = static_cast<std::size_t>(s.size());
  x_.resize(n);
  v_.resize(n);
  a_.resize(n);
  for (Index i = 0; i < s.size(); ++i) {
    const Motion<Real> m = motion_of(now, i);
    const auto k = static_cast<std::size_t>(i);
    x_[k] = m.x;
    v_[k] = m.v;
    a_[k] = m.a;
  }
  last_time_ = now.time();
}

template <class Real> void StopCheck<Real>::save(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "/time", last_time_);
  save_value(saved, prefix + "/x", x_);
  save_value(saved, prefix + "/v", v_);
  save_value(saved, prefix + "/a", a_);
}

template <class Real> void StopCheck<Real>::load(const SavedState& saved, const std::string& prefix) {
  load_value(saved, prefix + "/time", last_time_);
  load_value(saved, prefix + "/x", x_);
  load_value(saved, prefix + "/v", v_);
  load_value(saved, prefix + "/a", a_);
}

template class StopCheck<double>;
template class StopCheck<Quad>;

}  // namespace noether
