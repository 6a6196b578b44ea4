#include "monitors/chaos.hpp"

#include "engine/sums.hpp"
#include "numbers/random.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {

namespace {

/// Changes of a run get random numbers that nothing else takes.
constexpr std::uint32_t change_stream = 16;
/// Beyond these a length is brought back to 1 within a stretch of steps.
constexpr double too_long = 1e100, too_short = 1e-100;
/// Steps between two times that several changes are made orthogonal, or that a single one is looked at.
constexpr std::int64_t stride_of_many = 8, stride_of_one = 64;

constexpr const char* not_finite_any_more = "changes of the state are not finite any more";

/// Rms distance from the mean over rms speed about the mean, of one particle over its own speed; 1 where one is 0.
template <class Real> double natural_time(const ParticleSystem<Real>& s) {
  const auto n = static_cast<double>(s.size());
  const auto spread = [&](const VectorColumn<Real>& column) {
    double squares = 0;
    for (int c = 0; c < 3; ++c) {
      const Real* of = column.component(c);
      const double mean = sum_over<double>(s.size(), [&](Index i) { return static_cast<double>(of[i]); }) / n;
      squares += sum_over<double>(s.size(), [&](Index i) {
        const double off = static_cast<double>(of[i]) - (s.size() > 1 ? mean : 0);
        return off * off;
      });
    }
    return std::sqrt(squares);
  };
  const double time = spread(s.positions()) / spread(s.velocities());
  return std::isfinite(time) && time > 0 ? time : 1;
}

void check_numbers(const char* monitor, std::int64_t seed, const std::optional<double>& time_scale) {
  if (seed < 0) refuse_field("seed", static_cast<double>(seed), "is below 0; whole numbers from 0 on are expected");
  if (time_scale && !(*time_scale > 0 && std::isfinite(*time_scale)))
    refuse_field("time_scale", *time_scale,
                 fmt::format("is not a time scale of '{}'; a time above 0 is expected", monitor));
}

[[noreturn]] void refuse_without_flow(const char* monitor) {
  throw Error(
      fmt::format("monitor '{}' was not told how changes of the state go along with this run; give it a "
                  "tangent_flow, or run a scene",
                  monitor));
}

std::string cost_of(Index coordinates, Index changes) {
  return fmt::format("every step once more, with {} of {} numbers beside it",
                     changes == 1 ? "a change" : fmt::format("{} changes", changes), 2 * coordinates);
}

}  // namespace

template <class Real>
void NearbyOrbits<Real>::begin(const Snapshot<Real>& now, std::int64_t seed, const std::optional<double>& time_scale,
                               std::int64_t stride) {
  const ParticleSystem<Real>& s = now.state();
  flow_->gather(s, y_);
  scale_ = time_scale ? *time_scale : s.variables().empty() ? natural_time(s) : 1;
  start_ = now.time();
  step_ = now.step();
  time_unit_ = now.units().is_reduced() ? "1" : std::string(now.units().time);
  changes_.resize(flow_->size(), count_);
  const Philox random(static_cast<std::uint64_t>(seed), change_stream);
  for (Index k = 0; k < count_; ++k) {
    for (Index i = 0; i < changes_.rows(); ++i) {
      const double deviate = normal_pair(random.at(static_cast<std::uint64_t>(i), static_cast<std::uint32_t>(k)))[0];
      changes_(i, k) = Real(2 * i < changes_.rows() ? deviate : deviate / scale_);
    }
  }
  orthonormalize();
  flow_->measure_along(stride, Real(scale_));
  const Clock<Real>& clock = s.clock();
  flow_->begin(Clock<Real>::fixed(clock.start(), clock.dt(), step_), y_, changes_);
  begun_ = true;
}

/// In (dx, tau dv).
template <class Real> Real NearbyOrbits<Real>::product(Index j, Index k) const {
  const Index half = changes_.rows() / 2;
  Real x(0), v(0);
  for (Index i = 0; i < changes_.rows(); ++i) (i < half ? x : v) += changes_(i, j) * changes_(i, k);
  return x + Real(scale_) * Real(scale_) * v;
}
template <class Real> Real NearbyOrbits<Real>::length(Index k) const {
  using std::sqrt;
  return sqrt(product(k, k));
}

/// Gram and Schmidt's way, each change less what it has of those before. @return the lengths that were left
template <class Real> std::vector<Real> NearbyOrbits<Real>::orthonormalize() {
  std::vector<Real> left;
  for (Index k = 0; k < count_; ++k) {
    for (Index j = 0; j < k; ++j) changes_.col(k) -= product(j, k) * changes_.col(j);
    left.push_back(length(k));
    changes_.col(k) *= Real(1) / left.back();
  }
  lengths_.assign(static_cast<std::size_t>(count_), Real(1));
  return left;
}

template <class Real> template <class Grown> bool NearbyOrbits<Real>::was_told(const Grown& grown) {
  using std::isfinite;
  bool finite = true;
  const bool told = flow_->tell_growth([&](std::int64_t steps, const Real& growth) {
    finite = finite && isfinite(growth);
    if (finite) grown(steps, std::vector<Real>{growth});
  });
  if (!finite) end(not_finite_any_more);
  return told;
}

template <class Real>
template <class Grown>
void NearbyOrbits<Real>::follow(const Snapshot<Real>& now, std::int64_t stride, const Grown& grown) {
  using std::isfinite, std::log;
  if (!ended_.empty() || now.step() == step_) return;
  if (was_told(grown)) {
    step_ = now.step();
    return;
  }
  const Clock<Real>& clock = now.state().clock();
  const auto go_on = [&] { flow_->begin(Clock<Real>::fixed(clock.start(), clock.dt(), step_), y_, changes_); };
  go_on();
  while (step_ < now.step()) {
    const std::int64_t steps = std::min(stride, now.step() - step_);
    if (const auto failure = flow_->advance(steps)) return end(failure->message);
    flow_->read(y_, changes_);
    step_ += steps;
    std::vector<Real> lengths{length(0)}, growth;
    const bool last = step_ == now.step();
    const bool again = last || count_ > 1 || !(lengths[0] < Real(too_long) && lengths[0] > Real(too_short));
    const std::vector<Real> before = lengths_;
    if (again) lengths = orthonormalize();
    for (std::size_t k = 0; k < before.size(); ++k) growth.push_back(log(lengths[k] / before[k]));
    if (!again) lengths_ = lengths;
    for (const Real& g : growth) {
      if (!isfinite(g)) return end(not_finite_any_more);
    }
    grown(steps, growth);
    if (again && !last) go_on();
  }
  flow_->gather(now.state(), y_);
}

template <class Real> void NearbyOrbits<Real>::save_changes(SavedState& saved, const std::string& prefix) const {
  const auto key = [&](const char* name) { return detail::key_below(prefix, name); };
  save_value(saved, key("begun"), begun_);
  save_value(saved, key("state"), std::vector<Real>(y_.data(), y_.data() + y_.size()));
  save_value(saved, key("changes"), std::vector<Real>(changes_.data(), changes_.data() + changes_.size()));
  save_value(saved, key("step"), step_);
  save_value(saved, key("start"), start_);
  save_value(saved, key("scale"), scale_);
  save_value(saved, key("ended"), ended_);
  save_value(saved, key("time_unit"), time_unit_);
}

template <class Real> void NearbyOrbits<Real>::load_changes(const SavedState& saved, const std::string& prefix) {
  const auto key = [&](const char* name) { return detail::key_below(prefix, name); };
  std::vector<Real> state, changes;
  load_value(saved, key("begun"), begun_);
  load_value(saved, key("state"), state);
  load_value(saved, key("changes"), changes);
  load_value(saved, key("step"), step_);
  load_value(saved, key("start"), start_);
  load_value(saved, key("scale"), scale_);
  load_value(saved, key("ended"), ended_);
  load_value(saved, key("time_unit"), time_unit_);
  const auto numbers = static_cast<Index>(state.size());
  if (static_cast<Index>(changes.size()) != numbers * count_ && begun_)
    throw Error("the saved changes of the state do not match this monitor");
  y_ = Eigen::Map<const State>(state.data(), numbers);
  changes_ = Eigen::Map<const Changes>(changes.data(), numbers, begun_ ? count_ : 0);
  lengths_.assign(static_cast<std::size_t>(count_), Real(1));
}

template <class Real> void Megno<Real>::check() const { check_numbers("megno", seed, time_scale); }
template <class Real> void Megno<Real>::check_run() const {
  check();
  if (this->missing()) refuse_without_flow("megno");
}

template <class Real> void Megno<Real>::at_start(const Snapshot<Real>& start) {
  if (!this->begun()) this->begin(start, seed, time_scale, 1);
}

template <class Real> void Megno<Real>::observe(const Snapshot<Real>& now) {
  at_start(now);
  this->follow(now, 1, [&](std::int64_t, const std::vector<Real>& growth) { sums_.add(growth[0]); });
  time_ = std::abs(now.time() - this->start());
  ++samples_;
}

template <class Real> std::vector<Series> Megno<Real>::series() const {
  return {{.name = "value", .dimension = "1", .shape = {}, .values = {value()}},
          {.name = "mean", .dimension = "1", .shape = {}, .values = {mean()}}};
}

template <class Real> MonitorReport Megno<Real>::report() const {
  MonitorReport report;
  report.samples = samples_;
  report.reason = this->ended();
  if (samples_ == 0 || sums_.steps == 0) return report;
  report.last = mean();
  const double rate = 2 * mean() / time_;
  const std::string per = this->time_unit() == "1" ? "" : " " + this->time_unit();
  if (mean() >= 4) {
    report.verdict =
        fmt::format("chaotic: <Y> = {:.4g} grows as t/2 over a Lyapunov time of about {:.3g}{}", mean(), 1 / rate, per);
  } else if (std::abs(mean() - 2) < 0.5) {
    report.verdict = fmt::format("regular so far: <Y> = {:.4g}, near 2", mean());
  } else {
    report.verdict = fmt::format("too short to tell: <Y> = {:.4g}", mean());
  }
  return report;
}

template <class Real> std::string Megno<Real>::cost(Index coordinates, std::int64_t /*cadence*/) const {
  return cost_of(coordinates, 1);
}

template <class Real> void Megno<Real>::save(SavedState& saved, const std::string& prefix) const {
  const auto key = [&](const char* name) { return detail::key_below(prefix, name); };
  this->save_changes(saved, prefix);
  save_value(saved, key("sums"), std::vector<Real>{sums_.weighted, sums_.value, sums_.integral});
  save_value(saved, key("steps"), sums_.steps);
  save_value(saved, key("samples"), samples_);
  save_value(saved, key("time"), time_);
}

template <class Real> void Megno<Real>::load(const SavedState& saved, const std::string& prefix) {
  const auto key = [&](const char* name) { return detail::key_below(prefix, name); };
  std::vector<Real> sums;
  this->load_changes(saved, prefix);
  load_value(saved, key("sums"), sums);
  load_value(saved, key("steps"), sums_.steps);
  load_value(saved, key("samples"), samples_);
  load_value(saved, key("time"), time_);
  if (sums.size() != 3) throw Error("the saved sums of 'megno' are inconsistent");
  sums_.weighted = sums[0];
  sums_.value = sums[1];
  sums_.integral = sums[2];
}

template <class Real> void Lyapunov<Real>::check() const {
  check_numbers("lyapunov", seed, time_scale);
  if (vectors < 1) refuse_field("vectors", static_cast<double>(vectors), "is below 1; 1 or more are expected");
}
template <class Real> void Lyapunov<Real>::check_run(std::int64_t numbers) const {
  check();
  if (vectors > numbers) {
    refuse_field("vectors", static_cast<double>(vectors),
                 fmt::format("is more than the {} numbers of a state, which have as many exponents", numbers));
  }
  if (this->missing()) refuse_without_flow("lyapunov");
}

template <class Real> std::int64_t Lyapunov<Real>::stride() const {
  return vectors > 1 ? stride_of_many : stride_of_one;
}

template <class Real> void Lyapunov<Real>::at_start(const Snapshot<Real>& start) {
  if (this->begun()) return;
  this->begin(start, seed, time_scale, stride());
  grown_.assign(static_cast<std::size_t>(vectors), Real(0));
}

template <class Real> void Lyapunov<Real>::observe(const Snapshot<Real>& now) {
  at_start(now);
  double steps_made = 0;
  this->follow(now, stride(), [&](std::int64_t steps, const std::vector<Real>& growth) {
    for (std::size_t k = 0; k < growth.size(); ++k) grown_[k] += growth[k];
    steps_made += static_cast<double>(steps);
  });
  time_ += steps_made * std::abs(now.state().clock().dt());
  ++samples_;
}

template <class Real> std::vector<double> Lyapunov<Real>::exponents() const {
  std::vector<double> all;
  for (const Real& grown : grown_) {
    all.push_back(time_ > 0 ? static_cast<double>(grown) / time_ : std::numeric_limits<double>::quiet_NaN());
  }
  return all;
}

template <class Real> std::vector<Series> Lyapunov<Real>::series() const {
  return {{.name = "exponent", .dimension = "1/time", .shape = {static_cast<Index>(vectors)}, .values = exponents()}};
}

template <class Real> MonitorReport Lyapunov<Real>::report() const {
  MonitorReport report;
  report.samples = samples_;
  report.reason = this->ended();
  if (!(time_ > 0)) return report;
  report.last = exponents()[0];
  const bool plain = this->time_unit() == "1";
  report.note = fmt::format("largest exponent {:.4g}{}", *report.last, plain ? "" : " /" + this->time_unit());
  if (*report.last > 0)
    report.note += fmt::format(", a time of {:.4g}{}", 1 / *report.last, plain ? "" : " " + this->time_unit());
  return report;
}

template <class Real> std::string Lyapunov<Real>::cost(Index coordinates, std::int64_t /*cadence*/) const {
  return cost_of(coordinates, vectors);
}

template <class Real> void Lyapunov<Real>::save(SavedState& saved, const std::string& prefix) const {
  const auto key = [&](const char* name) { return detail::key_below(prefix, name); };
  this->save_changes(saved, prefix);
  save_value(saved, key("grown"), grown_);
  save_value(saved, key("samples"), samples_);
  save_value(saved, key("time"), time_);
}

template <class Real> void Lyapunov<Real>::load(const SavedState& saved, const std::string& prefix) {
  const auto key = [&](const char* name) { return detail::key_below(prefix, name); };
  this->load_changes(saved, prefix);
  load_value(saved, key("grown"), grown_);
  load_value(saved, key("samples"), samples_);
  load_value(saved, key("time"), time_);
}

template class NearbyOrbits<double>;
template class NearbyOrbits<Quad>;
template class Megno<double>;
template class Megno<Quad>;
template class Lyapunov<double>;
template class Lyapunov<Quad>;

template struct detail::MonitorModel<Megno<double>, double>;
template struct detail::MonitorModel<Megno<Quad>, Quad>;
template struct detail::MonitorModel<Lyapunov<double>, double>;
template struct detail::MonitorModel<Lyapunov<Quad>, Quad>;

}  // namespace noether
