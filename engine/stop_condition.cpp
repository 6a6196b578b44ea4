#include "engine/stop_condition.hpp"

#include "engine/hermite.hpp"
#include "engine/kepler_passage.hpp"
#include "engine/moments.hpp"
#include "engine/sums.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

/// Mean of the rows of a column, weighted by mass; zero where nobody has any.
template <class Real> Vec3<Real> mean_by_mass(const ParticleSystem<Real>& s, const VectorColumn<Real>& of) {
  const Real mass = sum_over<Real>(s.size(), [&](Index i) { return s.masses()[i]; });
  return mass > Real(0) ? Vec3<Real>(rounded(weighted_sum(s, of)) / mass) : Vec3<Real>(Vec3<Real>::Zero());
}

template <class Real> Vec3<Real> mean_by_mass(const ParticleSystem<Real>& s, const std::vector<Vec3<Real>>& rows) {
  VectorColumn<Real> column(s.size());
  for (Index i = 0; i < s.size(); ++i) column.set(i, rows[static_cast<std::size_t>(i)]);
  return mean_by_mass(s, column);
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

template <class Real> std::optional<StopReason> StopCheck<Real>::look(const Snapshot<Real>& now) {
  moved_ = static_cast<Index>(x_.size()) == now.state().size() && now.time() != last_time_;
  const auto event = rule_.kind == StopRule::Kind::escape ? escape(now) : collision(now);
  std::optional<StopReason> reason;
  if (event) {
    const ParticleSystem<Real>& s = now.state();
    const double at = moved_ ? last_time_ + static_cast<double>(event->at) * (now.time() - last_time_) : now.time();
    const std::string who = event->other < 0
                                ? "escape of " + s.name(event->particle)
                                : "collision of " + s.name(event->other) + " and " + s.name(event->particle);
    reason = StopReason{event->particle, at,
                        fmt::format("{}, distance {:.6g} {} {:.6g} since time {:.9g}", who, root(event->distance2),
                                    event->other < 0 ? "above" : "below", rule_.distance, at)};
  }
  remember(now);
  return reason;
}

template <class Real>
std::optional<typename StopCheck<Real>::Event> StopCheck<Real>::escape(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  const Real limit2 = Real(rule_.distance) * Real(rule_.distance);
  const Vec3<Real> center = mean_by_mass(s, s.positions());
  const auto center_now = [&] {
    return Motion<Real>{center, mean_by_mass(s, s.velocities()), mean_by_mass(s, now.accelerations())};
  };
  const auto center_before = [&] {
    return Motion<Real>{mean_by_mass(s, x_), mean_by_mass(s, v_), mean_by_mass(s, a_)};
  };
  std::optional<Event> first;
  for (Index i = 0; i < s.size(); ++i) {
    const Real d2 = norm2(s.positions()[i] - center);
    if (!(d2 > limit2)) continue;
    Real at(1);
    if (moved_) {
      const Motion<Real> begin = last_motion(i) - center_before(), end = now.motion(i) - center_now();
      const Hermite<Real> path(begin, end, Real(now.time()) - Real(last_time_));
      at = Hermite<Real>::bisect(Real(0), Real(1), [&](const Real& u) { return norm2(path.position(u)) > limit2; });
    }
    if (!first || at < first->at) first = Event{i, -1, d2, at};
  }
  return first;
}

template <class Real>
std::optional<typename StopCheck<Real>::Event> StopCheck<Real>::collision(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  const Real limit2 = Real(rule_.distance) * Real(rule_.distance);
  const Real h = Real(now.time()) - Real(last_time_);
  std::optional<Event> first;
  for (Index i = 0; i < s.size(); ++i) {
    for (Index j = 0; j < i; ++j) {
      if (s.masses()[i] == Real(0) && s.masses()[j] == Real(0)) continue;
      Event event{i, j, norm2(s.positions()[i] - s.positions()[j]), Real(1)};
      if (moved_) {
        const Hermite<Real> path(last_motion(i) - last_motion(j), now.motion(i) - now.motion(j), h);
        if (!path.may_come_within(Real(rule_.distance))) continue;
        const auto nearest = path.nearest(Real(rule_.distance));
        if (nearest.resolved && nearest.distance2 < limit2) {
          event.distance2 = nearest.distance2;
          event.at = Hermite<Real>::bisect(Real(0), nearest.at,
                                           [&](const Real& u) { return norm2(path.position(u)) < limit2; });
        }
        if (!nearest.resolved) {
          const auto passage =
              kepler_passage<Real>(last_motion(i) - last_motion(j), now.motion(i) - now.motion(j), h, rule_.distance);
          if (!passage) ++unresolved_;
          if (passage && passage->distance2 < limit2) event.distance2 = passage->distance2, event.at = passage->since;
        }
      }
      if (event.distance2 < limit2 && (!first || event.at < first->at)) first = event;
    }
  }
  return first;
}

template <class Real> Motion<Real> StopCheck<Real>::last_motion(Index i) const {
  const auto k = static_cast<std::size_t>(i);
  return {x_[k], v_[k], a_[k]};
}

template <class Real> void StopCheck<Real>::remember(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  const auto n = static_cast<std::size_t>(s.size());
  x_.resize(n);
  v_.resize(n);
  a_.resize(n);
  for (Index i = 0; i < s.size(); ++i) {
    const Motion<Real> m = now.motion(i);
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
  save_value(saved, prefix + "/unresolved", unresolved_);
}

template <class Real> void StopCheck<Real>::load(const SavedState& saved, const std::string& prefix) {
  load_value(saved, prefix + "/time", last_time_);
  load_value(saved, prefix + "/x", x_);
  load_value(saved, prefix + "/v", v_);
  load_value(saved, prefix + "/a", a_);
  unresolved_ = 0;  // of runs that were saved before these were counted
  if (saved.contains(prefix + "/unresolved")) load_value(saved, prefix + "/unresolved", unresolved_);
  if (x_.size() != v_.size() || x_.size() != a_.size()) throw Error("the saved state of a stop is inconsistent");
}

template class StopCheck<double>;
template class StopCheck<Quad>;

}  // namespace noether
