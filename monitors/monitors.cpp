#include "monitors/monitors.hpp"

#include "engine/bodies.hpp"
#include "engine/moments.hpp"
#include "engine/sums.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

namespace noether {

namespace {

Quad wide(double x) { return Quad(x); }
Quad wide(const Quad& x) { return x; }

Vec3<Quad> wide(const Vec3<double>& v) { return Vec3<Quad>(wide(v[0]), wide(v[1]), wide(v[2])); }
Vec3<Quad> wide(const Vec3<Quad>& v) { return v; }

/// What sums over particles are computed in, so that a monitor adds no rounding of its own.
template <class Real> using WideVector = std::conditional_t<std::is_same_v<Real, double>, WideSums, Vec3<Quad>>;

Vec3<Quad> wide(const WideSums& sums) {
  const auto axis = [&](int k) { return Quad(sums.high[k]) + Quad(sums.low[k]); };
  return {axis(0), axis(1), axis(2)};
}

/// Second words that are further digits of positions and velocities; null where particles have none.
template <class Real> const typename ParticleSystem<Real>::LowWords* second_words(const Snapshot<Real>& now) {
  const auto* low = now.state().low_words();
  return low != nullptr && now.claims().second_words ? low : nullptr;
}

/// Sums over particles in 113 bits, of vectors that `term(i)` gives.
template <class Term> Vec3<Quad> wide_sum(Index n, const Term& term) {
  const auto sums = sums_over<Quad, 3>(n, [&](Index i) {
    const Vec3<Quad> one = term(i);
    return std::array<Quad, 3>{one[0], one[1], one[2]};
  });
  return {sums[0], sums[1], sums[2]};
}

/// Momentum and angular momentum of both words.
template <class Real>
Vec3<Quad> wide_momentum(const ParticleSystem<Real>& s, const typename ParticleSystem<Real>::LowWords& low) {
  return wide_sum(
      s.size(), [&](Index i) { return Vec3<Quad>(wide(s.masses()[i]) * (wide(s.velocities()[i]) + wide(low.v[i]))); });
}
template <class Real>
Vec3<Quad> wide_angular_momentum(const ParticleSystem<Real>& s, const typename ParticleSystem<Real>::LowWords& low) {
  return wide_sum(s.size(), [&](Index i) {
    const Vec3<Quad> x = wide(s.positions()[i]) + wide(low.x[i]), v = wide(s.velocities()[i]) + wide(low.v[i]);
    return Vec3<Quad>(wide(s.masses()[i]) * cross(x, v));
  });
}

/// With the spins of bodies.
template <class Real> Vec3<Quad> angular_momentum_of_bodies(const ParticleSystem<Real>& s) {
  const auto& spin = s.template column<BodySpin>();
  return wide_sum(s.size(), [&](Index i) {
    const Vec3<Quad> x = wide(Vec3<Real>(s.unwrapped(i))), v = wide(Vec3<Real>(s.velocities()[i]));
    return Vec3<Quad>(wide(s.masses()[i]) * cross(x, v) + wide(Vec3<Real>(spin[i])));
  });
}

/// x - start - t speed; the difference of the large parts is exact where x lies near that line.
double departure(const DoubleDouble& x, const DoubleDouble& start, const DoubleDouble& t, const DoubleDouble& speed) {
  const DoubleDouble way = DoubleDouble::product(t.high, speed.high), change = DoubleDouble::sum(x.high, -start.high);
  const double rest = (x.low - start.low) - (t.high * speed.low + t.low * speed.high);
  return (change.high - way.high) + ((change.low - way.low) + rest);
}

/// Of any size: where squares leave the range of doubles, by the slower way.
double length(const std::array<double, 3>& v) {
  const double squares = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  return squares > 1e-280 && squares < 1e300 ? std::sqrt(squares) : std::hypot(v[0], v[1], v[2]);
}

Vec3<double> narrow(const Vec3<Quad>& v) {
  return Vec3<double>(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2]));
}

std::vector<double> list(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

std::string per_time(std::string_view unit, const std::string& time_unit) {
  return std::string(unit) + (time_unit == "1" ? "" : "/" + time_unit);
}

void fill_line(MonitorReport& report, const SeriesStatistics& series, const std::string& unit) {
  report.slope = series.slope();
  if (const auto line = series.line()) report.slope_error = line->error;
  report.slope_unit = unit;
}

/// Particles with mass, and degrees of freedom.
struct AtomCount {
  std::int64_t atoms = 0, freedom = 0;
};

/// Of a run of molecules; zeros for stars and planets.
template <class Real> AtomCount atoms_of(const ParticleSystem<Real>& s, const IntegratorClaims& claims) {
  const bool reduced = s.units().is_reduced();
  if (reduced ? !s.box().is_periodic() && s.topology() == nullptr : s.units().name != "molecular") return {};
  AtomCount count;
  const auto all = s.masses().all().array();
  const auto massive = static_cast<std::int64_t>((all > Real(0)).count());
  count.atoms = massive;
  if (has_bodies(s)) count.atoms += s.bodies()->sites_beyond_one();
  if (!reduced) {
    count.freedom = 3 * massive + turning_freedoms(s) - claims.constraints - (claims.keeps_momentum ? 3 : 0);
  }
  return count;
}

}  // namespace

template <class Real> void Energy::at_start(const Snapshot<Real>& start) {
  if (begun_) return;
  begun_ = true;
  const EnergyTerms<Real>& energy = start.energy();
  const auto& with_all_digits = start.wide_energy();
  reference_ = with_all_digits ? with_all_digits->conserved() : wide(energy.conserved());
  first_ = static_cast<double>(reference_);
  const double t = static_cast<double>(energy.kinetic), u = static_cast<double>(energy.potential);
  scale_ = std::max(std::abs(first_), 1e-3 * (t + std::abs(u)));
  if (scale_ == 0) scale_ = 1;
  const IntegratorClaims claims = start.claims();
  counts_heat_ = claims.counts_heat;
  if (claims.dissipative && !counts_heat_) {
    why_not_ = "the run is dissipative: its energy changes, so it has no energy error";
  } else if (claims.time_dependent) {
    why_not_ = "a force depends on time: the energy changes, so it has no energy error";
  }
  time_unit_ = std::string(start.units().time);
  const AtomCount count = atoms_of(start.state(), claims);
  atoms_ = count.atoms;
  freedom_ = count.freedom;
}

template <class Real> void Energy::observe(const Snapshot<Real>& now) {
  at_start(now);
  const EnergyTerms<Real>& energy = now.energy();
  now_ = {static_cast<double>(energy.total()), static_cast<double>(energy.kinetic),
          static_cast<double>(energy.potential), 0};
  heat_ = static_cast<double>(energy.heat);
  if (const auto& with_all_digits = now.wide_energy()) {
    now_[3] = static_cast<double>((with_all_digits->conserved() - reference_) / Quad(scale_));
  } else if constexpr (std::is_same_v<Real, double>) {
    now_[3] = (energy.conserved() - first_) / scale_;
  } else {
    now_[3] = static_cast<double>((energy.conserved() - reference_) / Real(scale_));
  }
  finite_ = finite_ && std::isfinite(now_[0]);
  kinetic_sum_ += now_[1];
  errors_.add(now.time(), now_[3]);
}

std::vector<Series> Energy::series() const {
  std::vector<Series> all = {{"total", "energy", {}, {now_[0]}},
                             {"kinetic", "energy", {}, {now_[1]}},
                             {"potential", "energy", {}, {now_[2]}},
                             {"relative_error", "1", {}, {now_[3]}}};
  if (counts_heat_) all.push_back({"conserved", "energy", {}, {conserved()}});
  return all;
}

void Energy::save(SavedState& saved, const std::string& prefix) const {
  save_part(saved, prefix, *this);
  if (counts_heat_) save_value(saved, detail::key_below(prefix, "heat"), heat_);
}

void Energy::load(const SavedState& saved, const std::string& prefix) {
  load_part(saved, prefix, *this);
  const std::string heat = detail::key_below(prefix, "heat");
  counts_heat_ = saved.contains(heat);
  if (counts_heat_) load_value(saved, heat, heat_);
}

MonitorReport Energy::report() const {
  MonitorReport report;
  report.samples = errors_.samples();
  if (report.samples == 0) return report;
  report.first = first_;
  report.last = conserved();
  report.scale = scale_;
  report.reason = why_not_;
  if (!finite_) report.reason = "the energy is beyond the range of double precision";
  if (!report.reason.empty()) return report;
  report.worst = errors_.worst();
  report.rms = errors_.rms();
  if (first_ == 0 && kinetic_sum_ == 0 && report.worst == 0) {
    report.note = "no massive particle moves or is pulled, so the energy says nothing about tracers: watch elements";
  }
  fill_line(report, errors_, per_time("1", time_unit_));
  fill_drift(report);
  if (counts_heat_) {
    report.note +=
        fmt::format("{}of the energy less the heat that the bath has given", report.note.empty() ? "" : ", ");
  }
  return report;
}

void Energy::fill_drift(MonitorReport& report) const {
  const std::optional<double> slope = errors_.slope();
  if (!slope || atoms_ == 0) return;
  double unit = static_cast<double>(atoms_) / scale_;  // of the slope of the relative error
  const bool by_kT = time_unit_ != "1";
  if (by_kT) {
    if (freedom_ <= 0 || !(kinetic_sum_ > 0)) return;
    const double kT = 2 * kinetic_sum_ / static_cast<double>(errors_.samples()) / static_cast<double>(freedom_);
    unit *= kT / units::molecular::ns;
  }
  report.drift = *slope / unit;
  if (const auto line = errors_.line()) report.drift_error = line->error / unit;
  report.drift_unit = by_kT ? "kT/ns/atom" : "epsilon/tau/atom";
  report.note =
      fmt::format("drift {:.3g}{} {}", *report.drift,
                  report.drift_error ? fmt::format(" +- {:.1g}", *report.drift_error) : "", report.drift_unit);
}

void VectorInvariant::begin(const Vec3<Quad>& value, const Quad& scale, bool kept) {
  begun_ = true;
  kept_ = kept;
  scale_ = static_cast<double>(scale);
  if (!(scale_ > 0)) scale_ = 1;
  refer_to(value);
}

void VectorInvariant::refer_to(const Vec3<Quad>& reference) {
  inverse_scale_ = std::min(1 / scale_, std::numeric_limits<double>::max());
  reference_ = reference;
  for (int k = 0; k < 3; ++k) near_reference_[static_cast<std::size_t>(k)] = DoubleDouble(reference[k]);
  const Vec3<double> near = narrow(reference);
  length_ = std::hypot(near[0], near[1], near[2]);
  inverse_length_ = 1 / length_;
  unit_ = near / length_;
}

inline void VectorInvariant::add_change(double time, const Vec3<double>& change) {
  error_ = change.norm() * inverse_scale_;
  sine2_ = 0;
  cosine_ = 1;
  if (has_direction()) {
    const Vec3<double> turn = change * inverse_length_;
    sine2_ = norm2(cross(unit_, turn));
    cosine_ = 1 + dot(unit_, turn);
    // Angles below a right one compare as their tangents; few looks see a new worst one.
    if (!(cosine_ > 0 && sine2_ <= worst_tangent2_ * (cosine_ * cosine_))) {
      worst_direction_ = std::max(worst_direction_, direction_error());
      worst_tangent2_ = cosine_ > 0 ? sine2_ / (cosine_ * cosine_) : std::numeric_limits<double>::infinity();
    }
  }
  errors_.add(time, error_);
}

/// Doubles near each other differ by a double, exactly; of others the difference need not be exact.
void VectorInvariant::add(double time, const WideSums& value) {
  Vec3<double> change;
  for (int k = 0; k < 3; ++k) {
    const DoubleDouble& reference = near_reference_[static_cast<std::size_t>(k)];
    value_[static_cast<std::size_t>(k)] = value.high[k] + value.low[k];
    change[k] = (value.high[k] - reference.high) + (value.low[k] - reference.low);
  }
  add_change(time, change);
}

void VectorInvariant::add(double time, const Vec3<Quad>& value) {
  for (int k = 0; k < 3; ++k) value_[static_cast<std::size_t>(k)] = static_cast<double>(value[k]);
  add_change(time, narrow(value - reference_));
}

double VectorInvariant::direction_error() const {
  return has_direction() ? std::atan2(std::sqrt(sine2_), cosine_) : std::numeric_limits<double>::quiet_NaN();
}

std::vector<Series> VectorInvariant::series() const {
  std::vector<Series> all = {{"value", dimension_, {3}, list(value_)}, {"relative_error", "1", {}, {error_}}};
  if (with_direction_) all.push_back({"direction_error", "1", {}, {direction_error()}});
  return all;
}

MonitorReport VectorInvariant::report() const {
  MonitorReport report;
  report.samples = errors_.samples();
  if (report.samples == 0) return report;
  report.first = errors_.first();
  report.last = errors_.last();
  report.worst = errors_.worst();
  report.rms = errors_.rms();
  report.scale = scale_;
  fill_line(report, errors_, per_time("1", time_unit_));
  if (has_direction()) report.note = fmt::format("direction within {:.2g} rad", worst_direction_);
  if (!kept_)
    report.note +=
        fmt::format("{}not conserved by the forces or the method of this run", report.note.empty() ? "" : "; ");
  return report;
}

void VectorInvariant::save_series(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "/begun", begun_);
  save_value(saved, prefix + "/kept", kept_);
  save_value(saved, prefix + "/reference", reference_);
  save_value(
      saved, prefix + "/numbers",
      std::array{scale_, error_, sine2_, cosine_, worst_tangent2_, worst_direction_, value_[0], value_[1], value_[2]});
  save_value(saved, prefix + "/errors", errors_);
  save_value(saved, prefix + "/time_unit", time_unit_);
}

void VectorInvariant::load_series(const SavedState& saved, const std::string& prefix) {
  std::array<double, 9> n{};
  load_value(saved, prefix + "/begun", begun_);
  load_value(saved, prefix + "/kept", kept_);
  Vec3<Quad> reference;
  load_value(saved, prefix + "/reference", reference);
  load_value(saved, prefix + "/numbers", n);
  load_value(saved, prefix + "/errors", errors_);
  load_value(saved, prefix + "/time_unit", time_unit_);
  scale_ = n[0];
  error_ = n[1];
  sine2_ = n[2];
  cosine_ = n[3];
  worst_tangent2_ = n[4];
  worst_direction_ = n[5];
  value_ = {n[6], n[7], n[8]};
  refer_to(reference);
}

template <class Real> void Momentum::at_start(const Snapshot<Real>& start) {
  if (begun()) return;
  const ParticleSystem<Real>& s = start.state();
  const auto size = [&](Index i) { return wide(s.masses()[i]) * sqrt(norm2(wide(s.velocities()[i]))); };
  const auto* low = second_words(start);
  begin(low != nullptr ? wide_momentum(s, *low) : wide(weighted_sum(s, s.velocities())), sum_over<Quad>(s.size(), size),
        start.claims().keeps_momentum);
  time_unit_ = std::string(start.units().time);
}

template <class Real> void Momentum::observe(const Snapshot<Real>& now) {
  at_start(now);
  if (const auto* low = second_words(now)) return add(now.time(), wide_momentum(now.state(), *low));
  add(now.time(), weighted_sum(now.state(), now.state().velocities()));
}

template <class Real> void AngularMomentum::at_start(const Snapshot<Real>& start) {
  if (begun()) return;
  const ParticleSystem<Real>& s = start.state();
  const auto* spin = has_bodies(s) ? &s.template column<BodySpin>() : nullptr;
  const auto size = [&](Index i) {
    const Quad orbit = wide(s.masses()[i]) * sqrt(norm2(wide(s.positions()[i])) * norm2(wide(s.velocities()[i])));
    return spin != nullptr ? orbit + sqrt(norm2(wide(Vec3<Real>((*spin)[i])))) : orbit;
  };
  const auto* low = second_words(start);
  begin(spin != nullptr  ? angular_momentum_of_bodies(s)
        : low != nullptr ? wide_angular_momentum(s, *low)
                         : wide(angular_momentum(s)),
        sum_over<Quad>(s.size(), size), start.claims().keeps_angular_momentum);
  time_unit_ = std::string(start.units().time);
}

template <class Real> void AngularMomentum::observe(const Snapshot<Real>& now) {
  at_start(now);
  if (has_bodies(now.state())) return add(now.time(), angular_momentum_of_bodies(now.state()));
  if (const auto* low = second_words(now)) return add(now.time(), wide_angular_momentum(now.state(), *low));
  add(now.time(), angular_momentum(now.state()));
}

template <class Real> void CenterOfMass::at_start(const Snapshot<Real>& start) {
  if (begun_) return;
  begun_ = true;
  const ParticleSystem<Real>& s = start.state();
  const Vec3<Quad> first = wide(weighted_positions(s)), speed = wide(weighted_sum(s, s.velocities()));
  start_ = {first[0], first[1], first[2], speed[0], speed[1], speed[2]};
  start_time_ = start.time();
  refer_to_start();
  slope_unit_ = per_time(start.units().length, std::string(start.units().time));
}

template <class Real> void CenterOfMass::observe(const Snapshot<Real>& now) {
  at_start(now);
  const ParticleSystem<Real>& s = now.state();
  const WideVector<Real> x = weighted_positions(s), v = weighted_sum(s, s.velocities());
  // 0 with tracers alone, who have no center: 0/0, which the report explains.
  const double mass = sum_over<double>(s.size(), [&](Index i) { return static_cast<double>(s.masses()[i]); });
  mass_ = mass;
  const DoubleDouble t = DoubleDouble::sum(now.time(), -start_time_);
  std::array<double, 3> away{};
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    if constexpr (std::is_same_v<Real, double>) {
      away[axis] = departure(DoubleDouble(x.high[k], x.low[k]), near_start_[axis], t, near_start_[axis + 3]);
      moments_[axis] = x.high[k] + x.low[k];
      moments_[axis + 3] = v.high[k] + v.low[k];
    } else {
      away[axis] = static_cast<double>(x[k] - start_[axis] - Quad(t) * start_[axis + 3]);
      moments_[axis] = static_cast<double>(x[k]);
      moments_[axis + 3] = static_cast<double>(v[k]);
    }
  }
  departures_.add(now.time(), length(away) / mass);
}

void CenterOfMass::refer_to_start() {
  std::transform(start_.begin(), start_.end(), near_start_.begin(), [](const Quad& x) { return DoubleDouble(x); });
}

void CenterOfMass::save(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "/begun", begun_);
  save_value(saved, prefix + "/start_moments", start_);
  save_value(saved, prefix + "/start_time", start_time_);
  save_value(saved, prefix + "/moments", moments_);
  save_value(saved, prefix + "/mass", mass_);
  save_value(saved, prefix + "/departures", departures_);
  save_value(saved, prefix + "/slope_unit", slope_unit_);
}

void CenterOfMass::load(const SavedState& saved, const std::string& prefix) {
  load_value(saved, prefix + "/begun", begun_);
  load_value(saved, prefix + "/start_moments", start_);
  load_value(saved, prefix + "/start_time", start_time_);
  load_value(saved, prefix + "/moments", moments_);
  load_value(saved, prefix + "/mass", mass_);
  load_value(saved, prefix + "/departures", departures_);
  load_value(saved, prefix + "/slope_unit", slope_unit_);
  refer_to_start();
}

std::vector<Series> CenterOfMass::series() const {
  const auto mean = [&](std::size_t first) {
    return std::vector{moments_[first] / mass_, moments_[first + 1] / mass_, moments_[first + 2] / mass_};
  };
  return {{"position", "length", {3}, mean(0)}, {"velocity", "length/time", {3}, mean(3)}};
}

MonitorReport CenterOfMass::report() const {
  MonitorReport report;
  report.samples = departures_.samples();
  if (report.samples == 0) return report;
  if (std::isnan(departures_.first())) {
    report.reason = "no particle has a mass, so there is no center of mass";
    return report;
  }
  report.first = departures_.first();
  report.last = departures_.last();
  report.worst = departures_.worst();
  report.rms = departures_.rms();
  report.note = "distance from the initial straight line";
  fill_line(report, departures_, slope_unit_);
  return report;
}

#define NOETHER_COMPILE(Type)                           \
  template void Type::observe(const Snapshot<double>&); \
  template void Type::observe(const Snapshot<Quad>&);   \
  template struct detail::MonitorModel<Type, double>;   \
  template struct detail::MonitorModel<Type, Quad>
NOETHER_COMPILE(Energy);
NOETHER_COMPILE(Momentum);
NOETHER_COMPILE(AngularMomentum);
NOETHER_COMPILE(CenterOfMass);
#undef NOETHER_COMPILE

}  // namespace noether
