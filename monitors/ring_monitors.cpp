#include "monitors/ring_monitors.hpp"

#include "engine/force_sink.hpp"
#include "engine/sphere_columns.hpp"
#include "engine/sums.hpp"
#include "monitors/series_report.hpp"
#include "numbers/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace noether {

namespace {

void check_rate(const std::optional<double>& Omega) {
  if (!Omega) {
    throw Error("the angular velocity of the frame is missing; give Omega, or use the Hamiltonian 'shearing_sheet'",
                {.key = "Omega"});
  }
  if (*Omega > 0 && std::isfinite(*Omega)) return;
  refuse_field("Omega", *Omega, "is not a valid angular velocity of the frame; a number above 0 is expected");
}

void check_box(const Box& box, const std::string& monitor, const std::string& why) {
  if (box.is_periodic()) return;
  throw Error(fmt::format("monitor '{}' needs a periodic box, because {}; give the particles a box", monitor, why));
}

std::string per_time(const std::string& unit, const UnitSystem& units) {
  return units.is_reduced() ? "1" : fmt::format("{}/{}", unit, units.time);
}

/// A velocity about the shear of a sheet.
template <class Real> Vec3<Real> about_shear(const ParticleSystem<Real>& s, Index i, double Omega) {
  Vec3<Real> u = s.velocities()[i];
  u[1] += Real(1.5) * Real(Omega) * s.unwrapped(i)[0];
  return u;
}

void put_mean(MonitorReport& report, const SeriesStatistics& values) {
  if (report.samples == 0) return;
  report.worst.reset();
  report.note = fmt::format("mean {:.6g}", values.mean());
  if (const auto error = values.mean_error()) report.note += fmt::format(" +- {:.1g}", *error);
}

}  // namespace

void VelocityDispersion::check() const { check_rate(Omega); }

template <class Real> void VelocityDispersion::observe(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  const Real n(static_cast<double>(std::max<Index>(s.size(), 1)));
  const auto sums = sums_over<Real, 3>(s.size(), [&](Index i) {
    const Vec3<Real> u = about_shear(s, i, *Omega);
    return std::array{u[0], u[1], u[2]};
  });
  const Vec3<Real> mean(sums[0] / n, sums[1] / n, sums[2] / n);
  const auto squares = sums_over<Real, 3>(s.size(), [&](Index i) {
    const Vec3<Real> u = about_shear(s, i, *Omega) - mean;
    return std::array<Real, 3>{u[0] * u[0], u[1] * u[1], u[2] * u[2]};
  });
  for (std::size_t k = 0; k < 3; ++k) now_[k] = std::sqrt(static_cast<double>(Real(squares[k] / n)));
  slope_unit_ = per_time(fmt::format("{}/{}", now.units().length, now.units().time), now.units());
  values_.add(now.time(), value());
}

double VelocityDispersion::value() const {
  return std::sqrt(now_[0] * now_[0] + now_[1] * now_[1] + now_[2] * now_[2]);
}

std::vector<Series> VelocityDispersion::series() const {
  return {{"value", "length/time", {}, {value()}},
          {"components", "length/time", {3}, {now_[0], now_[1], now_[2]}, {"x", "y", "z"}}};
}

MonitorReport VelocityDispersion::report() const {
  MonitorReport report = report_of(values_, slope_unit_);
  put_mean(report, values_);
  return report;
}

template <class Real> void FillingFactor::check(const ParticleSystem<Real>& s) const {
  check_box(s.box(), "filling_factor", "it divides by the area");
  if (s.template has<BodyRadius>()) return;
  throw Error(
      "monitor 'filling_factor' needs radii, which the particles of this scene do not have; add a force "
      "'hard_spheres', and give the bodies a radius");
}

template <class Real> void FillingFactor::observe(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  const auto& radii = s.template column<BodyRadius>();
  const Real inside = sum_over<Real>(s.size(), [&](Index i) {
    const Real z = s.unwrapped(i)[2], square = radii[i] * radii[i] - z * z;
    return square > Real(0) ? square : Real(0);
  });
  const Vec3<double>& edges = s.box().edges();
  now_ = std::numbers::pi * static_cast<double>(inside) / (edges[0] * edges[1]);
  slope_unit_ = per_time("1", now.units());
  values_.add(now.time(), now_);
}

MonitorReport FillingFactor::report() const {
  MonitorReport report = report_of(values_, slope_unit_);
  put_mean(report, values_);
  return report;
}

void Viscosity::check() const {
  check_rate(Omega);
  check_constant_of_gravitation(G);
  if (softening && !(*softening >= 0))
    refuse_field("softening", *softening, "is negative; 0 or a length above is expected");
}

void Viscosity::watch(const ForceClaims& gravity) {
  if (!gravity.kepler) return;
  if (!G) G = gravity.G;
  if (!softening) softening = gravity.softening;
}

template <class Real> void Viscosity::check(const ParticleSystem<Real>& s) const {
  check();
  check_box(s.box(), "viscosity", "momentum goes round in it");
  if (sum_over<Real>(s.size(), [&](Index i) { return s.masses()[i]; }) > Real(0)) return;
  throw Error("monitor 'viscosity' needs particles with mass, because it divides by their sum");
}

namespace {

/// The sum over pairs and their nine nearest images of the distance along x times the pull along y on the outer one
/// [energy].
template <class Real>
double pulled_outwards(const ParticleSystem<Real>& s, double Omega, double G, double softening, double time) {
  const Vec3<double>& edges = s.box().edges();
  const double slide = std::fmod(1.5 * Omega * time * edges[0], edges[1]);
  const auto of = [&](Index i, Index j) {
    double sum = 0;
    std::array<double, 3> d{};
    for (int k = 0; k < 3; ++k)
      d[static_cast<std::size_t>(k)] =
          static_cast<double>(Real(s.positions().component(k)[j] - s.positions().component(k)[i]));
    const double z = d[2] - edges[2] * std::nearbyint(d[2] / edges[2]), near = -std::nearbyint(d[0] / edges[0]);
    for (int across = -1; across <= 1; ++across) {
      const double x = d[0] + (near + across) * edges[0], slid = d[1] - (near + across) * slide;
      const double y0 = slid - edges[1] * std::nearbyint(slid / edges[1]);
      for (int along = -1; along <= 1; ++along) {
        const double y = y0 + along * edges[1], r2 = x * x + y * y + z * z + softening * softening;
        sum -= x * y / (r2 * std::sqrt(r2));
      }
    }
    return sum;
  };
  return static_cast<double>(reduce(s.size(), WideSum<double>{}, [&](Index begin, Index end) {
                               WideSum<double> block;
                               for (Index i = begin; i < end; ++i) {
                                 const auto mi = static_cast<double>(s.masses()[i]);
                                 if (mi == 0) continue;
                                 for (Index j = i + 1; j < s.size(); ++j) {
                                   const auto mj = static_cast<double>(s.masses()[j]);
                                   if (mj != 0) block += G * mi * mj * of(i, j);
                                 }
                               }
                               return block;
                             }).value());
}

}  // namespace

template <class Real> void Viscosity::observe(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  const auto [mass, flux] = sums_over<Real, 2>(s.size(), [&](Index i) {
    const Vec3<Real> u = about_shear(s, i, *Omega);
    return std::array<Real, 2>{s.masses()[i], s.masses()[i] * u[0] * u[1]};
  });
  double carried = 0;
  if (s.template has<ContactTransport>()) {
    const auto& column = s.template column<ContactTransport>();
    carried = static_cast<double>(sum_over<Real>(s.size(), [&](Index i) { return column[i]; }));
  }
  const double factor = 2 / (3 * *Omega * static_cast<double>(mass)), elapsed = now.time() - last_time_;
  const bool first = !looked_ || !(elapsed > 0);
  now_[0] = factor * static_cast<double>(flux);
  now_[1] = first ? std::numeric_limits<double>::quiet_NaN() : factor * (carried - carried_) / elapsed;
  now_[2] = G ? factor * pulled_outwards(s, *Omega, *G, softening.value_or(0), now.time()) : 0;
  looked_ = true;
  carried_ = carried;
  last_time_ = now.time();
  const std::string area = fmt::format("{}^2/{}", now.units().length, now.units().time);
  slope_unit_ = per_time(area, now.units());
  if (first) return;
  values_.add(now.time(), value());
  for (std::size_t k = 0; k < 3; ++k) parts_[k] += now_[k];
}

std::vector<Series> Viscosity::series() const {
  const std::string unit = "length^2/time";
  return {{"value", unit, {}, {value()}},
          {"local", unit, {}, {local()}},
          {"collisional", unit, {}, {collisional()}},
          {"gravitational", unit, {}, {gravitational()}}};
}

std::array<double, 3> Viscosity::means() const {
  std::array<double, 3> means = parts_;
  for (double& part : means) part /= static_cast<double>(std::max<std::int64_t>(values_.samples(), 1));
  return means;
}

MonitorReport Viscosity::report() const {
  MonitorReport report = report_of(values_, slope_unit_);
  put_mean(report, values_);
  if (report.samples == 0) return report;
  const std::array<double, 3> part = means();
  report.note += fmt::format(": local {:.4g}, collisional {:.4g}, gravitational {:.4g}", part[0], part[1], part[2]);
  return report;
}

void Wakes::check() const {
  check_rate(Omega);
  if (!(shortest > 0) || !std::isfinite(shortest))
    refuse_field("shortest", shortest, "is not the length of a wave; a length above 0 is expected");
}

template <class Real> void Wakes::check(const ParticleSystem<Real>& s) const {
  check();
  check_box(s.box(), "wakes", "waves repeat with it");
  const Vec3<double>& edges = s.box().edges();
  const double waves = std::numbers::pi * edges[0] * edges[1] / (shortest * shortest);
  if (waves <= 1e5) return;
  refuse_field("shortest", shortest,
               fmt::format("would count {:.0f} waves; a length above {:.3g} is expected", waves,
                           std::sqrt(std::numbers::pi * edges[0] * edges[1] / 1e5)));
}

namespace {

struct Wave {
  double x, y;  ///< of k [1/length]
};

/// One of each pair k and - k.
std::vector<Wave> waves_of(const Vec3<double>& edges, double slide, double shortest) {
  const double circle = 2 * std::numbers::pi, most = circle / shortest;
  std::vector<Wave> waves;
  for (double q = 0; circle * q / edges[1] <= most; ++q) {
    const double ky = circle * q / edges[1], shift = ky * slide / circle, half = edges[0] / shortest;
    for (double p = std::ceil(-half - shift); p <= half - shift; ++p) {
      if (q == 0 && p <= 0) continue;
      const double kx = (circle * p + ky * slide) / edges[0];
      if (kx * kx + ky * ky <= most * most) waves.push_back({kx, ky});
    }
  }
  return waves;
}

}  // namespace

template <class Real> void Wakes::observe(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  const Vec3<double>& edges = s.box().edges();
  const double slide = std::fmod(1.5 * *Omega * now.time() * edges[0], edges[1]);
  const auto [mass, squares] = sums_over<Real, 2>(s.size(), [&](Index i) {
    return std::array<Real, 2>{s.masses()[i], s.masses()[i] * s.masses()[i]};
  });
  const double of_random = static_cast<double>(squares) / (static_cast<double>(mass) * static_cast<double>(mass));
  const std::vector<Wave> waves = waves_of(edges, slide, shortest);
  std::array<double, 3> sums{};
  for (const Wave& wave : waves) {
    const auto [real, imaginary] = sums_over<double, 2>(s.size(), [&](Index i) {
      const auto m = static_cast<double>(s.masses()[i]);
      const double phase = wave.x * static_cast<double>(s.positions().component(0)[i]) +
                           wave.y * static_cast<double>(s.positions().component(1)[i]);
      return std::array<double, 2>{m * std::cos(phase), m * std::sin(phase)};
    });
    const double a = real / static_cast<double>(mass), b = imaginary / static_cast<double>(mass);
    const double power = a * a + b * b - of_random, k2 = wave.x * wave.x + wave.y * wave.y;
    sums[0] += power;
    sums[1] += power * (wave.x * wave.x - wave.y * wave.y) / k2;
    sums[2] += power * 2 * wave.x * wave.y / k2;
  }
  contrast_ = std::sqrt(std::max(0.0, 2 * sums[0]));  // k and - k
  pitch_ = contrast_ > 0 ? std::atan2(sums[2], sums[1]) / 2 : std::numeric_limits<double>::quiet_NaN();
  slope_unit_ = per_time("1", now.units());
  values_.add(now.time(), contrast_);
  if (contrast_ > 0) pitches_.add(now.time(), pitch_);
}

std::vector<Series> Wakes::series() const {
  return {{"contrast", "1", {}, {contrast_}}, {"pitch", "angle", {}, {pitch_}}};
}

MonitorReport Wakes::report() const {
  MonitorReport report = report_of(values_, slope_unit_);
  put_mean(report, values_);
  if (pitches_.samples() > 0)
    report.note += fmt::format(", pitch {:.3g} degrees", pitches_.mean() * 180 / std::numbers::pi);
  return report;
}

template void FillingFactor::check(const ParticleSystem<double>&) const;
template void FillingFactor::check(const ParticleSystem<Quad>&) const;
template void Viscosity::check(const ParticleSystem<double>&) const;
template void Viscosity::check(const ParticleSystem<Quad>&) const;
template void Wakes::check(const ParticleSystem<double>&) const;
template void Wakes::check(const ParticleSystem<Quad>&) const;

#define NOETHER_COMPILE(Type)                           \
  template void Type::observe(const Snapshot<double>&); \
  template void Type::observe(const Snapshot<Quad>&);   \
  template struct detail::MonitorModel<Type, double>;   \
  template struct detail::MonitorModel<Type, Quad>
NOETHER_COMPILE(VelocityDispersion);
NOETHER_COMPILE(FillingFactor);
NOETHER_COMPILE(Viscosity);
NOETHER_COMPILE(Wakes);
#undef NOETHER_COMPILE

}  // namespace noether
