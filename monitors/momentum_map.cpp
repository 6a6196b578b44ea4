#include "monitors/momentum_map.hpp"

#include "engine/sums.hpp"
#include "monitors/series_report.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

const Symmetry& MomentumMap::chosen(std::size_t variables) const {
  if (variables == 0)
    throw Error("monitor 'momentum_map' watches a system with coordinates, but this run has particles");
  if (known_.empty())
    throw Error(
        "monitor 'momentum_map' needs a symmetry, but this system names none; take it out, or give the system "
        "symmetries()");
  if (symmetry.empty()) return known_.front();
  const auto named = std::find_if(known_.begin(), known_.end(), [&](const Symmetry& s) { return s.name == symmetry; });
  if (named != known_.end()) return *named;
  std::vector<std::string> names;
  for (const Symmetry& one : known_) names.push_back(one.name);
  throw Error(fmt::format("monitor 'momentum_map' names the symmetry '{}', which the system does not have{}", symmetry,
                          did_you_mean(symmetry, names)),
              {.key = "symmetry", .value = symmetry});
}

template <class Real> void MomentumMap::observe(const Snapshot<Real>& now) {
  const auto& y = now.state().variables();
  const Symmetry& of = chosen(y.size());
  const auto n = static_cast<Index>(y.size() / 2);
  Eigen::VectorXd q(n);
  for (Index i = 0; i < n; ++i) q[i] = static_cast<double>(y[static_cast<std::size_t>(i)]);
  const Eigen::VectorXd xi = of.generator(q);
  NOETHER_EXPECTS(xi.size() == n, "the generator of the symmetry '" + of.name + "' has another size than q");
  const auto product = [&](Index i) { return static_cast<double>(y[static_cast<std::size_t>(n + i)]) * xi[i]; };
  const double J = sum_over<double>(n, product);
  if (!begun_) {
    begun_ = true;
    reference_ = minus_ = J;
    const double parts = sum_over<double>(n, [&](Index i) { return std::abs(product(i)); });
    scale_ = std::max(std::abs(J), 1e-3 * parts);
    if (scale_ == 0) scale_ = 1;
    time_unit_ = now.units().is_reduced() ? "1" : fmt::format("1/{}", now.units().time);
  } else if (step_ + 1 == now.step()) {
    minus_ = plus_;
    worst_step_ = std::max(worst_step_, std::abs(J - minus_) / scale_);
  }
  plus_ = J;
  step_ = now.step();
  errors_.add(now.time(), (J - reference_) / scale_);
}

std::vector<Series> MomentumMap::series() const {
  return {{.name = "minus", .dimension = "1", .shape = {}, .values = {minus_}},
          {.name = "plus", .dimension = "1", .shape = {}, .values = {plus_}},
          {.name = "relative_error", .dimension = "1", .shape = {}, .values = {errors_.last()}}};
}

MonitorReport MomentumMap::report() const {
  MonitorReport report = report_of(errors_, time_unit_);
  if (!begun_) return report;
  report.first = reference_;
  report.last = plus_;
  report.scale = scale_;
  report.note = fmt::format("J+ and J- of a step differ by at most {:.1e}", worst_step_);
  return report;
}

template struct detail::MonitorModel<MomentumMap, double>;
template struct detail::MonitorModel<MomentumMap, Quad>;

}  // namespace noether
