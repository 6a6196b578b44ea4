#include "monitors/pressure.hpp"

#include "engine/sums.hpp"
#include "monitors/series_report.hpp"

#include <fmt/format.h>

namespace noether {

namespace {

/// Sum of m v (x) v [energy].
template <class Real> Mat3<Real> momentum_flux(const ParticleSystem<Real>& s) {
  const auto [xx, yy, zz, xy, xz, yz] = sums_over<Real, 6>(s.size(), [&](Index i) {
    const Vec3<Real> v = s.velocities()[i], p = s.masses()[i] * v;
    return std::array{p[0] * v[0], p[1] * v[1], p[2] * v[2], p[0] * v[1], p[0] * v[2], p[1] * v[2]};
  });
  Mat3<Real> flux;
  flux << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return flux;
}

/// A bar is 10^5 Pa.
double bars_in(const UnitSystem& units) {
  if (units.is_reduced()) return 0;
  return (units.scale->energy / power(units.scale->length, 3) / units::decimal(1, 5)).rounded();
}

}  // namespace

template <class Real> Mat3<Real> pressure_tensor(const ParticleSystem<Real>& s, const Mat3<Real>& virial) {
  return (momentum_flux(s) + virial) / Real(s.box().volume());
}

void Pressure::check_box(const Box& box) {
  if (box.is_periodic()) return;
  throw Error("monitor 'pressure' needs a periodic box, because it divides by the volume; give the particles a box");
}

template <class Real> void Pressure::observe(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  const std::optional<Mat3<Real>>& virial = now.virial();
  NOETHER_EXPECTS(virial.has_value(), "the virial was available when the monitor was attached");
  const Mat3<Real> tensor = pressure_tensor(s, *virial);
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) now_[static_cast<std::size_t>(3 * a + b)] = static_cast<double>(tensor(a, b));
  }
  const UnitSystem& units = now.units();
  unit_ = units.is_reduced() ? "1" : fmt::format("{}/{}^3", units.energy, units.length);
  slope_unit_ = units.is_reduced() ? "1" : fmt::format("{}/{}", unit_, units.time);
  in_bar_ = bars_in(now.units());
  values_.add(now.time(), value());
}

std::vector<Series> Pressure::series() const {
  return {{"value", "pressure", {}, {value()}},
          {"tensor", "pressure", {3, 3}, std::vector<double>(now_.begin(), now_.end())}};
}

MonitorReport Pressure::report() const {
  MonitorReport report = report_of(values_, slope_unit_);
  if (report.samples == 0) return report;
  report.worst.reset();
  report.note = fmt::format("mean {:.6g}", values_.mean());
  if (const auto error = values_.mean_error()) report.note += fmt::format(" +- {:.1g}", *error);
  if (unit_ != "1") report.note += " " + unit_;
  if (in_bar_ != 0) report.note += fmt::format(", which is {:.6g} bar", values_.mean() * in_bar_);
  return report;
}

template Mat3<double> pressure_tensor(const ParticleSystem<double>&, const Mat3<double>&);

#define NOETHER_COMPILE(Type)                           \
  template void Type::observe(const Snapshot<double>&); \
  template void Type::observe(const Snapshot<Quad>&);   \
  template struct detail::MonitorModel<Type, double>;   \
  template struct detail::MonitorModel<Type, Quad>
NOETHER_COMPILE(Pressure);
#undef NOETHER_COMPILE

}  // namespace noether
