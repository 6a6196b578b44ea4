#include "engine/statistics.hpp"

#include <algorithm>

namespace noether {

namespace {

constexpr std::size_t most_blocks = 64;
constexpr std::size_t fewest_for_error = 20;

struct Fit {
  double slope, residual, spread;
};

Fit least_squares(const std::vector<double>& t, const std::vector<double>& y) {
  const double n = static_cast<double>(t.size());
  double t_mean = 0, y_mean = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    t_mean += t[i] / n;
    y_mean += y[i] / n;
  }
  double tt = 0, ty = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    tt += (t[i] - t_mean) * (t[i] - t_mean);
    ty += (t[i] - t_mean) * (y[i] - y_mean);
  }
  const double slope = tt > 0 ? ty / tt : 0;
  double residual = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double r = y[i] - y_mean - slope * (t[i] - t_mean);
    residual += r * r;
  }
  return {slope, residual, tt};
}

}  // namespace

void SeriesStatistics::add(double time, double value) {
  if (samples_ == 0) first_ = value;
  last_ = value;
  // A value that is not finite must show: it would lose every comparison.
  worst_ = std::isfinite(value) ? std::max(worst_, std::abs(value)) : value;
  squares_ += value * value;
  ++samples_;
  open_time_ += time;
  open_sum_ += value;
  if (++open_ < block_) return;
  times_.push_back(open_time_ / static_cast<double>(open_));
  means_.push_back(open_sum_ / static_cast<double>(open_));
  open_ = 0;
  open_time_ = open_sum_ = 0;
  if (times_.size() < most_blocks) return;
  for (std::size_t i = 0; i < most_blocks / 2; ++i) {
    times_[i] = (times_[2 * i] + times_[2 * i + 1]) / 2;
    means_[i] = (means_[2 * i] + means_[2 * i + 1]) / 2;
  }
  times_.resize(most_blocks / 2);
  means_.resize(most_blocks / 2);
  block_ *= 2;
}

std::optional<double> SeriesStatistics::slope() const {
  if (times_.size() < 2) return {};
  return least_squares(times_, means_).slope;
}

std::optional<SeriesStatistics::Line> SeriesStatistics::line() const {
  if (times_.size() < fewest_for_error) return {};
  const Fit fit = least_squares(times_, means_);
  const double freedom = static_cast<double>(times_.size() - 2);
  return Line{fit.slope, fit.spread > 0 ? std::sqrt(fit.residual / freedom / fit.spread) : 0};
}

double SeriesStatistics::mean() const {
  double sum = open_sum_;
  for (const double mean : means_) sum += mean * static_cast<double>(block_);
  return samples_ > 0 ? sum / static_cast<double>(samples_) : 0;
}

std::optional<double> SeriesStatistics::mean_error() const {
  if (means_.size() < fewest_for_error) return {};
  const std::size_t blocks = means_.size();
  const double n = static_cast<double>(blocks);
  double mean = 0;
  for (const double one : means_) mean += one / n;
  const auto products = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t k = lag; k < blocks; ++k) sum += (means_[k] - mean) * (means_[k - lag] - mean);
    return sum;
  };
  const double squares = products(0);
  double all = squares;
  for (std::size_t lag = 1; lag < blocks / 2; ++lag) {
    const double more = products(lag);
    if (!(more > 0)) break;
    all += 2 * more;
  }
  return std::sqrt(all / (n - 1) / n);
}

void SeriesStatistics::save(SavedState& saved, const std::string& prefix) const { save_part(saved, prefix, *this); }

void SeriesStatistics::load(const SavedState& saved, const std::string& prefix) {
  load_part(saved, prefix, *this);
  if (times_.size() != means_.size() || times_.size() >= most_blocks || block_ < 1) {
    throw Error("the saved figures of a series are inconsistent");
  }
}

}  // namespace noether
