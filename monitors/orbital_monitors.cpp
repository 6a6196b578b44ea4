#include "monitors/orbital_monitors.hpp"

#include "engine/hermite.hpp"
#include "engine/kepler_passage.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace noether {

namespace {

constexpr std::size_t elements_of_body = 6;
constexpr std::size_t motion_length = 9;

/// What a run that was saved before these figures were kept has of them: they stay as they are until the next look.
void complete(SavedState& saved, const std::string& key, SavedArray value) { saved.try_emplace(key, std::move(value)); }

/// The motion of particle `i` as it was seen before; what was a double is one again.
template <class Real> Motion<Real> motion_from(const std::vector<Quad>& seen, Index i) {
  const std::size_t row = static_cast<std::size_t>(i) * motion_length;
  const auto at = [&](std::size_t k) { return static_cast<Real>(seen[row + k]); };
  return {{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, {at(6), at(7), at(8)}};
}

}  // namespace

template <class Real> Index Elements::primary_of(const ParticleSystem<Real>& s) const {
  if (about.empty()) return 0;
  for (Index i = 0; i < s.size(); ++i) {
    if (s.name(i) == about) return i;
  }
  throw Error(fmt::format("about = \"{}\" is not a particle{}", about, did_you_mean(about, s.names())),
              {.key = "about"});
}

void Elements::refuse_massless(const std::string& name) {
  throw Error(
      fmt::format("elements are about '{}', whose mass is 0; give about = \"NAME\" of a body that has mass", name),
      {.key = "about"});
}

template <class Real> void Elements::observe(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  const Index primary = primary_of(s);
  Index heaviest = primary;
  for (Index i = 0; i < s.size(); ++i) heaviest = s.masses()[i] > s.masses()[heaviest] ? i : heaviest;
  primary_ = s.size() > 0 ? s.name(primary) : "";
  heaviest_ = heaviest != primary ? s.name(heaviest) : "";
  const Real g(G ? *G : now.units().G);
  rows_.assign(static_cast<std::size_t>(s.size()) * elements_of_body, std::numeric_limits<double>::quiet_NaN());
  for (Index i = 0; i < s.size(); ++i) {
    if (i == primary) continue;
    const Vec3<Real> x = s.positions()[i] - s.positions()[primary], v = s.velocities()[i] - s.velocities()[primary];
    const OrbitalElements<Real> o = elements_from_state<Real>(x, v, g * (s.masses()[primary] + s.masses()[i]));
    std::size_t k = static_cast<std::size_t>(i) * elements_of_body;
    for (const Real& value : {o.a, o.e, o.inc, o.Omega, o.omega, o.M}) rows_[k++] = static_cast<double>(value);
  }
  ++samples_;
}

void Elements::load(const SavedState& saved, const std::string& prefix) {
  SavedState whole = saved;
  for (const char* name : {"primary", "heaviest"}) {
    complete(whole, detail::key_below(prefix, name), std::vector<std::string>{""});
  }
  load_part(whole, prefix, *this);
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
  if (about.empty() && !heaviest_.empty()) {
    report.note += fmt::format("; they are about '{}', which comes first, and '{}' has more mass: give about = \"{}\"",
                               primary_, heaviest_, heaviest_);
  }
  return report;
}

OrbitalElements<double> Elements::of(Index i) const {
  const auto at = [&](std::size_t k) { return rows_.at(static_cast<std::size_t>(i) * elements_of_body + k); };
  return {at(0), at(1), at(2), at(3), at(4), at(5)};
}

template <class Real> void ClosestApproach::at_end(const Snapshot<Real>& end) {
  auto seen = std::make_shared<ClosestApproach>(*this);
  seen->observe(end);
  seen->samples_ = samples_;
  at_end_ = std::move(seen);
}

template <class Real> void ClosestApproach::observe(const Snapshot<Real>& now) {
  at_end_.reset();
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
          const auto found = [&](const Real& least2, const Real& part) {
            if (!(least2 < distance2)) return;
            distance2 = least2;
            at = seen_time_ + static_cast<double>(part) * h;
          };
          if (nearest.resolved) {
            found(nearest.distance2, nearest.at);
          } else if (const auto passage =
                         kepler_passage<Real>(motion_from<Real>(seen_, i) - motion_from<Real>(seen_, j),
                                              now.motion(i) - now.motion(j), Real(h), Real(0));
                     passage && passage->agreed) {
            found(passage->distance2, passage->at);
          } else {
            ++unresolved_;
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
  tracers_ = 0;
  for (Index i = 0; i < s.size(); ++i) tracers_ += s.masses()[i] == Real(0) ? 1 : 0;
}

void ClosestApproach::load(const SavedState& saved, const std::string& prefix) {
  SavedState whole = saved;
  complete(whole, detail::key_below(prefix, "tracers"), std::vector<std::int64_t>{0});
  load_part(whole, prefix, *this);
  const bool has_pair = pair_.size() == 2 && names_.size() == 2;
  if (seen_.size() != 9 * seen_ids_.size() || !(has_pair || (pair_.empty() && names_.empty()))) {
    throw Error("the saved state of closest_approach is inconsistent");
  }
}

std::vector<Series> ClosestApproach::series() const {
  std::vector<double> pair(2, -1);
  for (std::size_t k = 0; k < pair_.size(); ++k) pair[k] = static_cast<double>(pair_[k]);
  return {{"distance", "length", {}, {distance_}}, {"pair", "1", {2}, pair}, {"at_time", "time", {}, {at_time_}}};
}

MonitorReport ClosestApproach::report() const {
  if (at_end_) return at_end_->report();
  MonitorReport report;
  report.samples = samples_;
  const std::string left_out =
      tracers_ > 1 ? fmt::format("pairs of the {} tracers, whose mass is 0, are left out", tracers_) : "";
  report.note = left_out;
  if (pair_.empty()) return report;
  report.first = first_;
  report.last = distance_;
  report.note =
      fmt::format("{} and {} at time {:.9g}{}{}", names_[0], names_[1], at_time_, tracers_ > 1 ? "; " : "", left_out);
  if (unresolved_ > 0) {
    report.note += fmt::format(
        "; {} times a pair may have come nearer between two samples, too far apart to tell: sample more often",
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
