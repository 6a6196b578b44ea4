#include "monitors/variables.hpp"

#include "monitors/series_report.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace noether {

template <class Real> std::size_t Variables::place_in(const ParticleSystem<Real>& s) const {
  const std::size_t n = s.variables().size();
  if (n == 0) throw Error("monitor 'variables' watches a first-order system, but this run has particles");
  if (variable.empty()) return 0;
  const auto& known = s.variable_names();
  const auto named = std::find(known.begin(), known.end(), variable);
  if (named != known.end()) return static_cast<std::size_t>(named - known.begin());
  for (std::size_t i = 0; i < n; ++i) {
    if (variable == fmt::format("y[{}]", i)) return i;
  }
  throw Error(fmt::format("monitor 'variables' names '{}', which is not a variable of the system{}", variable,
                          known.empty() ? fmt::format("; the variables are y[0] to y[{}]", n - 1)
                                        : did_you_mean(variable, known)),
              {.key = "variable", .value = variable});
}

template <class Real> void Variables::observe(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  if (figures_.samples() == 0 || place_ < 0) {
    place_ = static_cast<Index>(place_in(s));
    shown_ = s.variable_name(place_);
    slope_unit_ = now.units().is_reduced() ? "1" : fmt::format("1/{}", now.units().time);
  }
  values_.clear();
  for (const Real& y : s.variables()) values_.push_back(static_cast<double>(y));
  names_ = s.variable_names();
  figures_.add(now.time(), values_[static_cast<std::size_t>(place_)]);
}

std::vector<Series> Variables::series() const {
  return {{.name = "value",
           .dimension = "1",
           .shape = {static_cast<Index>(values_.size())},
           .values = values_,
           .columns = names_}};
}

MonitorReport Variables::report() const {
  MonitorReport report = report_of(figures_, slope_unit_);
  if (report.samples > 0) report.note = fmt::format("{} ends at {:.9g}", shown_, figures_.last());
  return report;
}

template struct detail::MonitorModel<Variables, double>;
template struct detail::MonitorModel<Variables, Quad>;

}  // namespace noether
