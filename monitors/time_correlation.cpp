#include "monitors/time_correlation.hpp"

#include "engine/moments.hpp"
#include "engine/sums.hpp"
#include "numbers/quantity.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace noether {

namespace {

constexpr std::int64_t longest_length = 1'000'000;
constexpr std::size_t fit_numbers = 5;
/// Spans of time side by side, below which their scatter says little.
constexpr double fewest_spans = 5;

/// Mean of x or v weighted by mass, from its sum; zero where nobody has any.
template <class Real> Vec3<Real> mean_by_mass(const ParticleSystem<Real>& s, const Vec3<Real>& sum) {
  const Real mass = sum_over<Real>(s.size(), [&](Index i) { return s.masses()[i]; });
  return mass > Real(0) ? Vec3<Real>(sum / mass) : Vec3<Real>(Vec3<Real>::Zero());
}

template <class T> void drop_front(std::vector<T>& all, std::size_t count) {
  all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
}

/// A straight line through points (t, y), by its sums: n, t, y, t t, t y.
double slope_of(const double* sums) {
  const double spread = sums[3] - sums[1] * sums[1] / sums[0];
  return spread > 0 ? (sums[4] - sums[1] * sums[2] / sums[0]) / spread : 0;
}

}  // namespace

void TimeCorrelation::check() const {
  if (length < 2 || length > longest_length) {
    refuse_field("length", std::to_string(length),
                 fmt::format("is not a valid longest lag; 2 to {} samples are expected", longest_length));
  }
  if (origins < 1) {
    refuse_field("origins", std::to_string(origins),
                 "is not a valid number of samples between origins; at least 1 is expected");
  }
}

void TimeCorrelation::check_types(const Topology* topology) const {
  check();
  const std::vector<std::string> names = topology == nullptr ? std::vector<std::string>{} : topology->type_names;
  for (const std::string& type : types) {
    if (std::find(names.begin(), names.end(), type) != names.end()) continue;
    throw Error(fmt::format("unknown type '{}' to average over{}", type,
                            names.empty() ? "; the particles have no types" : did_you_mean(type, names)),
                {.key = "types", .value = type});
  }
}

void TimeCorrelation::forget() {
  begun_.clear();
  begun_at_.clear();
  held_.clear();
  fits_.clear();
}

void TimeCorrelation::check_loaded() const {
  const std::size_t count = begun_.size(), lags = static_cast<std::size_t>(length) + 1;
  const bool origins_fit = begun_at_.size() == count && fits_.size() == fit_numbers * count &&
                           (count == 0 ? held_.empty() : held_.size() % (3 * count) == 0);
  const bool tables_fit = looks_ == 0 || (sums_.size() == lags && times_.size() == lags && counts_.size() == lags);
  // Origins begin at multiples of `origins`; the oldest has not been followed to the end.
  bool known = true;
  for (const std::int64_t begun : begun_) known = known && begun >= looks_ - length && begun < looks_;
  if (!origins_fit || !tables_fit || !known) throw Error("the saved origins of a time correlation are inconsistent");
}

template <class Real> std::vector<double> TimeCorrelation::chosen(const ParticleSystem<Real>& s, Kind kind) const {
  const auto of = [&](Index i) { return kind == Kind::displacement ? s.unwrapped(i) : Vec3<Real>(s.velocities()[i]); };
  const Vec3<Real> center =
      mean_by_mass(s, rounded(kind == Kind::displacement ? weighted_positions(s) : weighted_sum(s, s.velocities())));
  std::vector<double> rows;
  rows.reserve(3 * static_cast<std::size_t>(s.size()));
  for (Index i = 0; i < s.size(); ++i) {
    if (!types.empty()) {
      const std::string& type = s.topology()->type_names[static_cast<std::size_t>(s.topology()->type(i))];
      if (std::find(types.begin(), types.end(), type) == types.end()) continue;
    }
    const Vec3<Real> row = of(i) - center;
    for (int k = 0; k < 3; ++k) rows.push_back(static_cast<double>(row[k]));
  }
  return rows;
}

double TimeCorrelation::average(const std::vector<double>& now, const double* then, Kind kind) {
  const auto particles = static_cast<Index>(now.size() / 3);
  const double sum = sum_over<double>(particles, [&](Index i) {
    const double *here = now.data() + 3 * i, *there = then + 3 * i;
    if (kind == Kind::velocity) return here[0] * there[0] + here[1] * there[1] + here[2] * there[2];
    const double x = here[0] - there[0], y = here[1] - there[1], z = here[2] - there[2];
    return x * x + y * y + z * z;
  });
  return sum / static_cast<double>(particles);
}

void TimeCorrelation::look(double time, const std::vector<double>& now, Kind kind) {
  const std::size_t lags = static_cast<std::size_t>(length) + 1;
  sums_.resize(lags);
  times_.resize(lags);
  counts_.resize(lags);
  if (held_.size() != begun_.size() * now.size()) throw Error("the saved time correlation is of other particles");
  if (looks_ % origins == 0) begin_origin(time, now);
  for (std::size_t origin = 0; origin < begun_.size(); ++origin) {
    const std::int64_t lag = looks_ - begun_[origin];
    const double value = average(now, held_.data() + origin * now.size(), kind);
    const double t = std::abs(time - begun_at_[origin]);  // time may fall
    const auto at = static_cast<std::size_t>(lag);
    sums_[at] += value;
    times_[at] += t;
    ++counts_[at];
    follow(origin, t, value, lag, kind);
  }
  if (!begun_.empty() && looks_ - begun_.front() == length) end_origin(kind);
  ++looks_;
}

void TimeCorrelation::begin_origin(double time, const std::vector<double>& now) {
  begun_.push_back(looks_);
  begun_at_.push_back(time);
  held_.insert(held_.end(), now.begin(), now.end());
  fits_.resize(fits_.size() + fit_numbers);
}

/// Of a displacement the sums of a straight line; of a velocity the integral so far, and where it stands.
void TimeCorrelation::follow(std::size_t origin, double t, double value, std::int64_t lag, Kind kind) {
  double* fit = fits_.data() + origin * fit_numbers;
  if (kind == Kind::velocity) {
    if (lag > 0) fit[0] += (t - fit[1]) * (value + fit[2]) / 2;
    fit[1] = t;
    fit[2] = value;
  } else if (2 * lag >= length) {
    const std::array<double, fit_numbers> terms = {1, t, value, t * t, t * value};
    for (std::size_t k = 0; k < fit_numbers; ++k) fit[k] += terms[k];
  }
}

void TimeCorrelation::end_origin(Kind kind) {
  const double one = kind == Kind::velocity ? fits_[0] / 3 : slope_of(fits_.data()) / 6;
  ++ended_;
  const double change = one - mean_;
  mean_ += change / static_cast<double>(ended_);
  squares_ += change * (one - mean_);
  drop_front(held_, held_.size() / begun_.size());
  drop_front(fits_, fit_numbers);
  drop_front(begun_, 1);
  drop_front(begun_at_, 1);
}

std::vector<double> TimeCorrelation::averages(const std::vector<double>& sums) const {
  std::vector<double> means(static_cast<std::size_t>(length) + 1, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < counts_.size(); ++k) {
    if (counts_[k] > 0) means[k] = sums[k] / static_cast<double>(counts_[k]);
  }
  return means;
}

std::optional<double> TimeCorrelation::diffusion_coefficient() const {
  if (ended_ == 0) return {};
  return mean_;
}

std::optional<double> TimeCorrelation::diffusion_error() const {
  const auto n = static_cast<double>(ended_);
  const double spans = std::min(n, 1 + (n - 1) * static_cast<double>(origins) / static_cast<double>(length));
  if (spans < fewest_spans) return {};
  return std::sqrt(squares_ / (n - 1) / spans);
}

std::string TimeCorrelation::diffusion_note(const char* from) const {
  std::string note = fmt::format("D = {:.4g}", mean_);
  if (const auto error = diffusion_error()) note += fmt::format(" +- {:.1g}", *error);
  return note + fmt::format("{} from {} of {} origins", unit_, from, ended_);
}

std::vector<Series> TimeCorrelation::table(const char* dimension) const {
  const std::vector<Index> shape{static_cast<Index>(length) + 1};
  const double D = diffusion_coefficient().value_or(std::numeric_limits<double>::quiet_NaN());
  return {{"lag", "time", shape, lags()},
          {"value", dimension, shape, values()},
          {"diffusion_coefficient", "length^2/time", {}, {D}}};
}

template <class Real> void MeanSquareDisplacement::at_start(const Snapshot<Real>& start) {
  if (start_.empty()) start_ = chosen(start.state(), Kind::displacement);
}

template <class Real> void MeanSquareDisplacement::observe(const Snapshot<Real>& now) {
  const std::vector<double> rows = chosen(now.state(), Kind::displacement);
  if (start_.empty()) start_ = rows;
  if (start_.size() != rows.size()) throw Error("the saved mean square displacement is of other particles");
  since_start_ = average(rows, start_.data(), Kind::displacement);
  slope_unit_ = unit_of(power(dimensions::length, 2) / dimensions::time, now.units());
  unit_ = now.units().is_reduced() ? "" : " " + slope_unit_;
  look(now.time(), rows, Kind::displacement);
}

std::vector<Series> MeanSquareDisplacement::series() const {
  std::vector<Series> all = table("length^2");
  all.push_back({"since_start", "length^2", {}, {since_start_}});
  return all;
}

MonitorReport MeanSquareDisplacement::report() const {
  MonitorReport report;
  report.samples = looks_;
  if (looks_ == 0) return report;
  report.last = since_start_;
  if (ended_ == 0) {
    report.reason = fmt::format("no diffusion coefficient: no origin has been followed for {} samples", length);
    return report;
  }
  report.slope = 6 * mean_;
  if (const auto error = diffusion_error()) report.slope_error = 6 * *error;
  report.slope_unit = slope_unit_;
  report.note = diffusion_note("slope / 6");
  return report;
}

void MeanSquareDisplacement::forget() {
  TimeCorrelation::forget();
  start_.clear();
}

void MeanSquareDisplacement::load(const SavedState& saved, const std::string& prefix) {
  load_part(saved, prefix, *this);
  check_loaded();
}

template <class Real> void VelocityAutocorrelation::observe(const Snapshot<Real>& now) {
  slope_unit_ = unit_of(power(dimensions::length, 2) / dimensions::time, now.units());
  unit_ = now.units().is_reduced() ? "" : " " + slope_unit_;
  look(now.time(), chosen(now.state(), Kind::velocity), Kind::velocity);
}

MonitorReport VelocityAutocorrelation::report() const {
  MonitorReport report;
  report.samples = looks_;
  if (looks_ == 0) return report;
  report.first = values()[0];
  if (ended_ == 0) {
    report.reason = fmt::format("no diffusion coefficient: no origin has been followed for {} samples", length);
    return report;
  }
  report.last = values().back();
  report.note = diffusion_note("the integral / 3");
  return report;
}

void VelocityAutocorrelation::load(const SavedState& saved, const std::string& prefix) {
  load_part(saved, prefix, *this);
  check_loaded();
}

#define NOETHER_COMPILE(Type)                           \
  template void Type::observe(const Snapshot<double>&); \
  template void Type::observe(const Snapshot<Quad>&);   \
  template struct detail::MonitorModel<Type, double>;   \
  template struct detail::MonitorModel<Type, Quad>
NOETHER_COMPILE(MeanSquareDisplacement);
NOETHER_COMPILE(VelocityAutocorrelation);
#undef NOETHER_COMPILE

}  // namespace noether
