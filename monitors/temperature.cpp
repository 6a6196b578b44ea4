#include "monitors/temperature.hpp"

#include "engine/bodies.hpp"
#include "engine/moments.hpp"
#include "engine/sums.hpp"
#include "monitors/series_report.hpp"

#include <limits>

namespace noether {

template <class Real> void Temperature::observe(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  const IntegratorClaims claims = now.claims();
  Index massive = 0;
  for (Index i = 0; i < s.size(); ++i) massive += s.masses()[i] > Real(0) ? 1 : 0;
  const bool about_center = claims.keeps_momentum && massive > 0;
  Vec3<Real> drift = Vec3<Real>::Zero();
  if (about_center) {
    const Real mass = sum_over<Real>(s.size(), [&](Index i) { return s.masses()[i]; });
    drift = rounded(weighted_sum(s, s.velocities())) / mass;
  }
  Real twice =
      sum_over<Real>(s.size(), [&](Index i) { return s.masses()[i] * norm2(Vec3<Real>(s.velocities()[i] - drift)); });
  if (has_bodies(s)) twice += Real(2) * turning_energy_of(s);
  freedom_ = 3 * massive + turning_freedoms(s) - claims.constraints - (about_center ? 3 : 0);
  now_ = freedom_ > 0 ? static_cast<double>(twice) / (static_cast<double>(freedom_) * now.units().k_B)
                      : std::numeric_limits<double>::quiet_NaN();
  slope_unit_ = std::string(now.units().temperature) + "/" + std::string(now.units().time);
  if (now.units().is_reduced()) slope_unit_ = "1";
  values_.add(now.time(), now_);
}
template void Temperature::observe(const Snapshot<double>&);
template void Temperature::observe(const Snapshot<Quad>&);

MonitorReport Temperature::report() const {
  MonitorReport report;
  report.samples = values_.samples();
  if (report.samples == 0) return report;
  if (freedom_ <= 0) {
    report.reason = "there is no degree of freedom left to have a temperature";
    return report;
  }
  report = report_of(values_, slope_unit_);
  report.worst.reset();
  report.note = "of " + std::to_string(freedom_) + " degrees of freedom";
  return report;
}

}  // namespace noether
