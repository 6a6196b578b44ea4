#include "study/analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {

std::vector<bool> pareto_front(const std::vector<std::optional<double>>& cost,
                               const std::vector<std::optional<double>>& error) {
  std::vector<bool> front(cost.size(), false);
  for (std::size_t i = 0; i < cost.size(); ++i) {
    if (!cost[i] || !error[i]) continue;
    front[i] = true;
    for (std::size_t j = 0; j < cost.size() && front[i]; ++j) {
      if (!cost[j] || !error[j]) continue;
      const bool as_good = *cost[j] <= *cost[i] && *error[j] <= *error[i];
      const bool better = *cost[j] < *cost[i] || *error[j] < *error[i];
      front[i] = !(as_good && better);
    }
  }
  return front;
}

double PowerLaw::operator()(double x) const { return std::exp(log_factor + exponent * std::log(x)); }

namespace {

/// Least squares through points of logarithms.
PowerLaw line_through(const std::vector<std::pair<double, double>>& points, std::size_t begin, std::size_t count) {
  const auto n = static_cast<double>(count);
  double mean_x = 0, mean_y = 0;
  for (std::size_t k = begin; k < begin + count; ++k) {
    mean_x += points[k].first / n;
    mean_y += points[k].second / n;
  }
  double xx = 0, xy = 0;
  for (std::size_t k = begin; k < begin + count; ++k) {
    xx += (points[k].first - mean_x) * (points[k].first - mean_x);
    xy += (points[k].first - mean_x) * (points[k].second - mean_y);
  }
  PowerLaw law{.exponent = xy / xx, .points = static_cast<int>(count)};
  law.log_factor = mean_y - law.exponent * mean_x;
  law.range = std::exp(points[begin].first - points[begin + count - 1].first);
  double squares = 0;
  for (std::size_t k = begin; k < begin + count; ++k) {
    const double off = points[k].second - law.log_factor - law.exponent * points[k].first;
    squares += off * off;
  }
  if (count > 2) law.exponent_error = std::sqrt(squares / (n - 2) / xx);
  return law;
}

}  // namespace

std::optional<PowerLaw> asymptotic_fit(std::vector<std::pair<double, double>> points, double floor, double spread) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::pair<double, double>> logs;
  for (const auto& [x, error] : points) {
    if (x > 0 && error > floor && error < 0.1) logs.emplace_back(std::log(x), std::log(error));
  }
  std::size_t best_begin = 0, best = 0;
  double steepest = 0;
  for (std::size_t begin = 0; begin + 1 < logs.size(); ++begin) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t k = begin; k + 1 < logs.size(); ++k) {
      const double slope = (logs[k].second - logs[k + 1].second) / (logs[k].first - logs[k + 1].first);
      low = std::min(low, slope);
      high = std::max(high, slope);
      if (!(slope > 0.25) || high - low > spread * std::max(high, 1.0)) break;
      const std::size_t count = k + 2 - begin;
      // Of equally long parts the steeper one: the other has rounding in it.
      if (count < best || (count == best && high < steepest)) continue;
      best = count;
      best_begin = begin;
      steepest = high;
    }
  }
  if (best < 2) return {};
  return line_through(logs, best_begin, best);
}

namespace {

std::optional<OrderFit> order_of(const Comparison& c, const Candidate& who) {
  OrderFit fit{.label = who.label, .adaptive = who.adaptive, .measured = c.position_measured ? "position" : "energy"};
  std::vector<std::pair<double, double>> points;
  for (const Row& row : c.rows) {
    const auto error = c.error_of(row);
    if (!(row.who == who) || !row.completed() || !error) continue;
    const double x =
        who.adaptive ? 1.0 / static_cast<double>(std::max<std::int64_t>(row.evaluations.force, 1)) : row.setting.step;
    points.emplace_back(x, *error);
  }
  const double floor = std::max(who.below_rounding ? 1e-19 : 1e-13, 10 * c.truth.error.value_or(0));
  // Work that hardly changes with the tolerance shows no order.
  const auto law = asymptotic_fit(points, floor);
  if (law && (law->range >= 2 || !who.adaptive)) {
    fit.rows = law->points;
    fit.order = law->exponent;
    if (law->points > 2) fit.error = law->exponent_error;
  }
  return fit;
}

}  // namespace

void analyse(Comparison& c) {
  std::vector<std::optional<double>> seconds, evaluations, errors;
  for (const Row& row : c.rows) {
    const bool counts = row.completed();
    const auto error = c.error_of(row);
    errors.push_back(counts && error && *error < 1 ? error : std::nullopt);  // beyond that all are equally lost
    seconds.push_back(counts ? row.wall_s : std::nullopt);
    evaluations.push_back(counts ? std::optional(static_cast<double>(row.evaluations.force)) : std::nullopt);
  }
  const auto by_time = pareto_front(seconds, errors), by_evaluations = pareto_front(evaluations, errors);
  for (std::size_t i = 0; i < c.rows.size(); ++i) {
    c.rows[i].pareto_time = by_time[i];
    c.rows[i].pareto_evaluations = by_evaluations[i];
  }
  c.orders.clear();
  for (const Candidate& who : c.methods) {
    if (auto fit = order_of(c, who)) c.orders.push_back(std::move(*fit));
  }
}

void use_finest_run(Comparison& c, const PositionError& error) {
  const Row* finest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate& who : c.methods) {
    std::vector<const Row*> done;
    for (const Row& row : c.rows) {
      if (row.who == who && row.completed() && !row.track.y.empty()) done.push_back(&row);
    }
    if (done.size() < 2) continue;
    const Row &fine = *done[done.size() - 1], &next = *done[done.size() - 2];
    double worst = 0;
    for (std::size_t j = 0; j < fine.track.y.size() && j < next.track.y.size(); ++j) {
      worst = std::max(worst, error(next.track.state(j), fine.track.state(j)));
    }
    if (worst < least) {
      least = worst;
      finest = &fine;
    }
  }
  const std::string why = c.truth.note;
  if (finest == nullptr || !(least < 1e-3)) {
    c.truth.note = fmt::format("{}; the finest runs do not agree either, so errors are those of the invariants", why);
    return;
  }
  c.truth.kind = TruthKind::finest_run;
  c.truth.name = "finest run";
  c.truth.error = least;
  for (std::size_t j = 0; j < finest->track.y.size(); ++j) c.truth.y.push_back(finest->track.state(j));
  c.truth.energy = finest->track.energy;
  c.reference = static_cast<std::size_t>(finest - c.rows.data());
  c.truth.note =
      fmt::format("{}; errors are distances from the finest run of {}, which is {:.1e} from the run before it", why,
                  finest->who.label, least);
}

}  // namespace noether
