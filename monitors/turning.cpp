#include "monitors/turning.hpp"

#include "engine/bodies.hpp"
#include "monitors/series_report.hpp"

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

template <class Real> void expect_bodies(const ParticleSystem<Real>& s) {
  if (!has_bodies(s)) throw Error("there are no rigid bodies, so nothing turns; take this monitor out");
}

}  // namespace

template <class Real> void OrientationDefect::check(const ParticleSystem<Real>& s) const { expect_bodies(s); }

template <class Real> void OrientationDefect::observe(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  const auto& orientation = s.template column<BodyOrientation>();
  now_ = 0;
  for (Index i = 0; i < s.size(); ++i) {
    const double defect = std::abs(static_cast<double>(norm_defect<Real>(orientation[i])));
    if (!(defect <= now_)) now_ = defect;  // what is not a number stays
  }
  values_.add(now.time(), now_);
}

MonitorReport OrientationDefect::report() const {
  MonitorReport report = report_of(values_, "");
  report.slope.reset();
  report.slope_error.reset();
  return report;
}

template <class Real> void TurningEnergy::check(const ParticleSystem<Real>& s) const { expect_bodies(s); }

template <class Real> void TurningEnergy::observe(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  now_ = static_cast<double>(turning_energy_of(s));
  of_centers_ = static_cast<double>(
      sum_over<Real>(s.size(), [&](Index i) { return s.masses()[i] * norm2(s.velocities()[i]) / Real(2); }));
  const std::string time(now.units().time);
  slope_unit_ = now.units().is_reduced() ? "1" : "energy/" + time;
  values_.add(now.time(), now_);
}

MonitorReport TurningEnergy::report() const { return report_of(values_, slope_unit_); }

template void OrientationDefect::check(const ParticleSystem<double>&) const;
template void OrientationDefect::check(const ParticleSystem<Quad>&) const;
template void OrientationDefect::observe(const Snapshot<double>&);
template void OrientationDefect::observe(const Snapshot<Quad>&);
template void TurningEnergy::check(const ParticleSystem<double>&) const;
template void TurningEnergy::check(const ParticleSystem<Quad>&) const;
template void TurningEnergy::observe(const Snapshot<double>&);
template void TurningEnergy::observe(const Snapshot<Quad>&);
template struct detail::MonitorModel<OrientationDefect, double>;
template struct detail::MonitorModel<OrientationDefect, Quad>;
template struct detail::MonitorModel<TurningEnergy, double>;
template struct detail::MonitorModel<TurningEnergy, Quad>;

}  // namespace noether
