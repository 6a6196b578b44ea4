#include "monitors/field_momentum.hpp"

#include "monitors/series_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

/// As a monitor saves them: particles, field, particles_about, field_about, size, size_about.
std::vector<double> listed(const MomentumShares& of) {
  std::vector<double> all;
  for (const Vec3<double>* v : {&of.particles, &of.field, &of.particles_about, &of.field_about})
    all.insert(all.end(), v->begin(), v->end());
  all.push_back(of.size);
  all.push_back(of.size_about);
  return all;
}
MomentumShares shares_in(const std::vector<double>& all) {
  const auto vector = [&](std::size_t k) { return Vec3<double>(all[3 * k], all[3 * k + 1], all[3 * k + 2]); };
  return {vector(0), vector(1), vector(2), vector(3), all[12], all[13]};
}

double relative(const Vec3<double>& change, double size) { return std::sqrt(norm2(change)) / (size > 0 ? size : 1); }

}  // namespace

void FieldMomentum::require_sharing() const {
  if (sharing_) return;
  throw Error(
      "monitor 'field_momentum' needs a system that has momentum_sharing(), such as 'darwin' or 'lorentz_pairs'; take "
      "it out, or use 'momentum_map'");
}

template <class Real> void FieldMomentum::observe(const Snapshot<Real>& now) {
  const auto& y = now.state().variables();
  Eigen::VectorXd point(static_cast<Index>(y.size()));
  for (Index i = 0; i < point.size(); ++i) point[i] = static_cast<double>(y[static_cast<std::size_t>(i)]);
  require_sharing();
  const MomentumShares is = sharing_(point);
  last_ = listed(is);
  if (start_.empty()) {
    start_ = last_;
    time_unit_ = now.units().is_reduced() ? "1" : fmt::format("1/{}", now.units().time);
  }
  const MomentumShares was = shares_in(start_);
  const Vec3<double> change = is.particles - was.particles, about = is.particles_about - was.particles_about;
  const Vec3<double> of_field = is.field - was.field, field_about = is.field_about - was.field_about;
  of_particles_.add(now.time(), std::max(relative(change, was.size), relative(about, was.size_about)));
  errors_.add(now.time(), std::max(relative(Vec3<double>(change + of_field), was.size),
                                   relative(Vec3<double>(about + field_about), was.size_about)));
}

MomentumShares FieldMomentum::last() const { return last_.empty() ? MomentumShares{} : shares_in(last_); }

std::vector<Series> FieldMomentum::series() const {
  const MomentumShares is = last();
  std::vector<Series> all;
  const auto add = [&](const char* name, const char* dimension, const Vec3<double>& v) {
    all.push_back({.name = name, .dimension = dimension, .shape = {3}, .values = {v[0], v[1], v[2]}});
  };
  add("particles", "mass length/time", is.particles);
  add("field", "mass length/time", is.field);
  add("particles_about", "mass length^2/time", is.particles_about);
  add("field_about", "mass length^2/time", is.field_about);
  all.push_back({.name = "relative_error", .dimension = "1", .shape = {}, .values = {errors_.last()}});
  return all;
}

MonitorReport FieldMomentum::report() const {
  MonitorReport report = report_of(errors_, time_unit_);
  if (start_.empty()) return report;
  const MomentumShares was = shares_in(start_), is = last();
  report.note = fmt::format(
      "momenta of the particles alone change by up to {:.2e}; those of the field by {:.2e} and {:.2e} about the origin "
      "since the start",
      of_particles_.worst(), relative(Vec3<double>(is.field - was.field), was.size),
      relative(Vec3<double>(is.field_about - was.field_about), was.size_about));
  return report;
}

template struct detail::MonitorModel<FieldMomentum, double>;
template struct detail::MonitorModel<FieldMomentum, Quad>;

}  // namespace noether
