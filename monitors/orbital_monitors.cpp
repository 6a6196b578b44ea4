#include "monitors/orbital_monitors.hpp"

#include "engine/hermite.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace noether {

namespace {

constexpr std::size_t elements_of_body = 6;
constexpr std::size_t motion_length = 9;

/// The motion of particle `i` as it was seen before; what was a double is one again.
template <class Real> Motion<Real> motion_from(const std::vector<Quad>& seen, Index i) {
  const std::size_t row = static_cast<std::size_t>(i) * motion_length;
  const auto at = [&](std::size_t k) { return static_cast<Real>(seen[row + k]); };
  return {{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, {at(6), at(7), at(8)}};
}

}  // namespace

template <class Real> void Elements::observe(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  const Real g(G ? *G : now.units().G);
  rows_.assign(static_cast<std::size_t>(s.size()) * elements_of_body, std::numeric_limits<double>::quiet_NaN());
  for (Index i = 1; i < s.size(); ++i) {
    const Vec3<Real> x = s.positions()[i] - s.positions()[0], v = s.velocities()[i] - s.velocities()[0];
    const OrbitalElements<Real> o = elements_from_state<Real>(x, v, g * (s.masses()[0] + s.masses()[i]));
    std::size_t k = static_cast<std::size_t>(i) * elements_of_body;
    for (const Real& value : {o.a, o.e, o.inc, o.Omega, o.omega, o.M}) rows_[k++] = static_cast<double>(value);
  }
  ++samples_;
}

std::vector<Series> Elements::series() const {
  const Index rows = static_cast<Index>(rows_.size() / elements_of_body);
  return {{.name = "value",
           .dimension = "length, 1, angle, angle, angle, angle",
           .shape = {rows, static_cast<Index>(elements_of_body)},
           .values = rows_,
           .columns = {"a", "e", "inc", "Omega", "omega", "M"}}};
}

MonitorReport Elements::report() const {
  MonitorReport report;
  report.samples = samples_;
  report.note = "six numbers for each particle: see the trajectory file";
  return report;
}

OrbitalElements<double> Elements::of(Index i) const {
  const auto at = [&](std::size_t k) { return rows_.at(static_cast<std::size_t>(i) * elements_of_body + k); };
  return {at(0), at(1), at(2), at(3), at(4), at(5)};
}

template <class Real> void ClosestApproach::observe(const Snapshot<Real>& now) {
  look_at_pairs(now);
  if (samples_++ == 0) first_ = distance_;
  remember(now);
}

template <class Real> void ClosestApproach::look_at_pairs(const Snapshot<Real>& now) {
  using std::sqrt;
  const ParticleSystem<Real>& s = now.state();
  // In a periodic box the path between two looks leads across its faces: there pairs are seen at the looks alone.
  const bool path_known = samples_ > 0 && seen_ids_ == s.ids() && seen_time_ != now.time() && !s.box().is_periodic();
  const double h = now.time() - seen_time_;
  for (Index i = 0; i < s.size(); ++i) {
    for (Index j = 0; j < i; ++j) {
      if (s.masses()[i] == Real(0) && s.masses()[j] == Real(0)) continue;
      Real distance2 = norm2(s.box().minimum_image(Vec3<Real>(s.positions()[i] - s.positions()[j])));
      double at = now.time();
      if (path_known) {
        const Hermite<Real> path(motion_from<Real>(seen_, i) - motion_from<Real>(seen_, j),
                                 now.motion(i) - now.motion(j), Real(h));
        if (path.may_come_within(Real(distance_))) {
          const auto nearest = path.nearest();
          if (!nearest.resolved) ++unresolved_;
          if (nearest.resolved && nearest.distance2 < distance2) {
            distance2 = nearest.distance2;
            at = seen_time_ + static_cast<double>(nearest.at) * h;
          }
        }
      }
      const double distance = static_cast<double>(sqrt(distance2));
      if (!(distance < distance_)) continue;
      distance_ = distance;
      at_time_ = at;
      pair_ = {s.ids()[static_cast<std::size_t>(j)], s.ids()[static_cast<std::size_t>(i)]};
      names_ = {s.name(j), s.name(i)};
    }
  }
}

template <class Real> void ClosestApproach::remember(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  seen_.clear();
  for (Index i = 0; i < s.size(); ++i) {
    const Motion<Real> motion = now.motion(i);
    for (const Vec3<Real>& vector : {motion.x, motion.v, motion.a}) {
      for (int k = 0; k < 3; ++k) seen_.push_back(Quad(vector[k]));
    }
  }
  seen_ids_ = s.ids();
  seen_time_ = now.time();
}

void ClosestApproach::load(const SavedState& saved, const std::string& prefix) {
  load_part(saved, prefix, *this);
  const bool has_pair = pair_.size() == 2 && names_.size() == 2;
  if (seen_.size() != 9 * seen_ids_.size() || !(has_pair || (pair_.empty() && names_.empty()))) {
    throw Error("what closest_approach saw last was saved in parts that do not fit");
  }
}

std::vector<Series> ClosestApproach::series() const {
  std::vector<double> pair(2, -1);
  for (std::size_t k = 0; k < pair_.size(); ++k) pair[k] = static_cast<double>(pair_[k]);
  return {{"distance", "length", {}, {distance_}}, {"pair", "1", {2}, pair}, {"at_time", "time", {}, {at_time_}}};
}

MonitorReport ClosestApproach::report() const {
  MonitorReport report;
  report.samples = samples_;
  if (pair_.empty()) return report;
  report.first = first_;
  report.last = distance_;
  report.note = fmt::format("{} and {} at time {:.9g}", names_[0], names_[1], at_time_);
  if (unresolved_ > 0) {
    report.note +=
        fmt::format("; {} times a pair may have been nearer between two looks, too far apart to tell: look more often",
                    unresolved_);
  }
  return report;
}

#define NOETHER_COMPILE(Type)                           \
  template void Type::observe(const Snapshot<double>&); \
  template void Type::observe(const Snapshot<Quad>&);   \
  template struct detail::MonitorModel<Type, double>;   \
  template struct detail::MonitorModel<Type, Quad>
NOETHER_COMPILE(Elements);
NOETHER_COMPILE(ClosestApproach);
#undef NOETHER_COMPILE

}  // namespace noether
