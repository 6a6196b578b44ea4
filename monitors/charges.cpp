#include "monitors/charges.hpp"

#include "engine/charge.hpp"
#include "engine/proper_velocity.hpp"
#include "engine/sums.hpp"
#include "monitors/series_report.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace noether {

namespace {

Vec3<double> vector_of(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

/// Of settled particles, whose velocities may have low words.
template <class Real> double gamma_of(const ChargeMotion& motion, const ParticleSystem<Real>& s, Index i) {
  if (!motion.c) return 1;
  return static_cast<double>(gamma_of_velocity(whole_velocity(s, i), FastNumber<Real>(*motion.c)));
}

/// Charges at the places of some of `s`, at a time: what fields look at.
template <class Real>
ParticleSystem<double> charges_at(const ParticleSystem<Real>& s, Index begin, Index end, double time) {
  ParticleSystem<double> there(s.units());
  there.add_column<Charge>();
  for (Index i = begin; i < end; ++i) {
    there.add("", static_cast<double>(s.masses()[i]), Vec3<Real>(s.positions()[i]).template cast<double>(),
              Vec3<Real>(s.velocities()[i]).template cast<double>());
    there.column<Charge>()[i - begin] = static_cast<double>(s.template column<Charge>()[i]);
  }
  there.clock() = Clock<double>::free(0);
  there.clock().set_stage_offset(time);
  return there;
}

/// What fields do there: q E/m, Omega = q B/m and, if wanted, q A.
struct Here {
  VectorColumn<double> acceleration, rate, momentum;
  std::optional<Failure> failure;

  Here(const ChargeMotion& motion, const ParticleSystem<double>& s, bool momenta)
      : acceleration(s.size()), rate(s.size()), momentum(s.size()) {
    ForceSink<double> sink(acceleration, s, {});
    sink.set_gyrations(rate);
    if (momenta) sink.set_field_momenta(momentum);
    for (const AnyForce<double>& field : motion.fields) field.add_to(sink, s);
    failure = sink.failure();
  }
};

/// @throws Error  where there are no fields, or no charges
template <class Real>
void expect_charges_in_fields(const ChargeMotion& motion, const ParticleSystem<Real>& s, const char* monitor) {
  if (motion.fields.empty()) {
    throw Error(
        fmt::format("monitor '{}' watches charges in fields, but this run has no field; take it out, or add a "
                    "[[hamiltonian.field]]",
                    monitor));
  }
  if (!s.template has<Charge>()) throw Error(fmt::format("monitor '{}' watches charges, but there are none", monitor));
}

}  // namespace

void CanonicalMomentum::check() const {
  if (!(norm2(vector_of(axis)) > 0)) refuse_field("axis", axis, "has no length; a direction is expected");
}

template <class Real> void CanonicalMomentum::check(const ParticleSystem<Real>& s) const {
  check();
  expect_charges_in_fields(motion_, s, "canonical_momentum");
  const Here here(motion_, charges_at(s, 0, s.size(), 0), true);
  if (here.failure) throw Error(here.failure->message);
}
template void CanonicalMomentum::check(const ParticleSystem<double>&) const;
template void CanonicalMomentum::check(const ParticleSystem<Quad>&) const;

template <class Real>
std::optional<CanonicalMomentum::Momentum> CanonicalMomentum::momentum_of(const ParticleSystem<Real>& s,
                                                                          double time) const {
  const ParticleSystem<double> there = charges_at(s, 0, s.size(), time);
  const Here here(motion_, there, true);
  if (here.failure) return {};
  Vec3<double> n = vector_of(axis);
  n /= std::sqrt(norm2(n));
  const auto along = [&](Index i, const Vec3<double>& p) {
    const Vec3<double> arm = Vec3<double>(there.positions()[i]) - vector_of(center);
    return symmetry == SpaceSymmetry::rotation ? dot(n, cross<double>(arm, p)) : dot(n, p);
  };
  const auto own = [&](Index i) {
    return along(i, gamma_of(motion_, s, i) * there.masses()[i] * Vec3<double>(there.velocities()[i]));
  };
  const auto of_field = [&](Index i) { return along(i, std::as_const(here.momentum)[i]); };
  return Momentum{
      .sum = sum_over<double>(s.size(), [&](Index i) { return own(i) + of_field(i); }),
      .parts = sum_over<double>(s.size(), [&](Index i) { return std::abs(own(i)) + std::abs(of_field(i)); })};
}

template <class Real> void CanonicalMomentum::observe(const Snapshot<Real>& now) {
  const std::optional<Momentum> momentum = momentum_of(now.state(), now.time());
  last_ = error_ = std::numeric_limits<double>::quiet_NaN();
  if (!momentum) return;  // the run itself ends where a field is not known
  if (!begun_) {
    begun_ = true;
    reference_ = momentum->sum;
    scale_ = std::max(std::abs(reference_), 1e-3 * momentum->parts);
    if (scale_ == 0) scale_ = 1;
    time_unit_ = now.units().is_reduced() ? "1" : fmt::format("1/{}", now.units().time);
  }
  last_ = momentum->sum;
  error_ = (last_ - reference_) / scale_;
  errors_.add(now.time(), error_);
}

std::vector<Series> CanonicalMomentum::series() const {
  const char* dimension = symmetry == SpaceSymmetry::rotation ? "mass length^2/time" : "mass length/time";
  return {{.name = "value", .dimension = dimension, .shape = {}, .values = {last_}},
          {.name = "relative_error", .dimension = "1", .shape = {}, .values = {error_}}};
}

MonitorReport CanonicalMomentum::report() const {
  MonitorReport report = report_of(errors_, time_unit_);
  if (!begun_) return report;
  report.first = reference_;
  report.last = last_;
  report.scale = scale_;
  return report;
}

template <class Real> Index MagneticMoment::charge_of(const ParticleSystem<Real>& s) const {
  const auto& charges = s.template column<Charge>();
  for (Index i = 0; i < s.size(); ++i) {
    const bool moves = charges[i] != Real(0) && s.masses()[i] != Real(0);
    if (body.empty() ? !moves : s.name(i) != body) continue;
    if (moves) return i;
    throw Error(fmt::format("body = \"{}\" has no charge, so no field turns it; give the name of a charge", body),
                {.key = "body"});
  }
  if (body.empty()) throw Error("no particle has a charge; give one to a body, or take this monitor out");
  throw Error(fmt::format("body = \"{}\" is not a particle{}", body, did_you_mean(body, s.names())), {.key = "body"});
}

template <class Real> void MagneticMoment::check(const ParticleSystem<Real>& s) const {
  expect_charges_in_fields(motion_, s, "magnetic_moment");
  static_cast<void>(charge_of(s));
}
template void MagneticMoment::check(const ParticleSystem<double>&) const;
template void MagneticMoment::check(const ParticleSystem<Quad>&) const;

template <class Real> bool MagneticMoment::look(const ParticleSystem<Real>& s, Index i, double time) {
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  value_ = error_ = parallel_ = nothing;
  center_ = {nothing, nothing, nothing};
  ParticleSystem<double> one = charges_at(s, i, i + 1, time);
  const Vec3<double> x = std::as_const(one).positions()[0], v = std::as_const(one).velocities()[0];
  const double mass = one.masses()[0], charge = one.column<Charge>()[0], gamma = gamma_of(motion_, s, i);
  Vec3<double> X = x, across = v, rate = v;
  const int sweeps = at == MomentPlace::particle ? 1 : 4;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    one.positions().set(0, X);
    one.moved();
    const Here here(motion_, one, false);
    rate = here.rate[0];
    const double rate2 = norm2(rate);
    if (here.failure || !(rate2 > 0)) return false;
    const Vec3<double> w = v - cross<double>(here.acceleration[0], rate) / rate2;  // without the drift E x B/B^2
    across = w - dot(w, rate) / rate2 * rate;
    X = x + gamma * cross<double>(across, rate) / rate2;
  }
  const double omega = std::sqrt(norm2(rate)), strength = omega * mass / std::abs(charge);
  value_ = gamma * gamma * mass * norm2(across) / (2 * strength);
  center_ = {X[0], X[1], X[2]};
  parallel_ = dot(v, rate) / omega * (charge < 0 ? -1 : 1);
  return std::isfinite(value_);
}

template <class Real> void MagneticMoment::observe(const Snapshot<Real>& now) {
  const double before = parallel_, then = time_;
  const ParticleSystem<Real>& s = now.state();
  time_ = now.time();
  time_unit_ = now.units().is_reduced() ? "1" : fmt::format("1/{}", now.units().time);
  unit_ = now.units().is_reduced() ? "" : std::string(now.units().time);
  if (!look(s, charge_of(s), time_)) return;
  if (!begun_) {
    begun_ = true;
    reference_ = least_ = most_ = value_;
    start_ = center_;
    began_at_ = time_;
  } else if (before * parallel_ < 0) {
    last_turn_ = then + (time_ - then) * before / (before - parallel_);
    if (turns_++ == 0) first_turn_ = last_turn_;
  }
  least_ = std::min(least_, value_);
  most_ = std::max(most_, value_);
  error_ = (value_ - reference_) / (reference_ > 0 ? reference_ : 1);
  errors_.add(time_, error_);
}

std::array<double, 3> MagneticMoment::drift() const {
  std::array<double, 3> mean{};
  for (std::size_t k = 0; k < 3; ++k) mean[k] = (center_[k] - start_[k]) / (time_ - began_at_);
  return mean;
}

double MagneticMoment::bounce_period() const {
  if (turns_ < 3) return std::numeric_limits<double>::quiet_NaN();
  return 2 * (last_turn_ - first_turn_) / static_cast<double>(turns_ - 1);
}

std::vector<Series> MagneticMoment::series() const {
  return {{"value", "energy charge time/mass", {}, {value_}},
          {"center", "length", {3}, {center_[0], center_[1], center_[2]}},
          {"parallel", "length/time", {}, {parallel_}},
          {"relative_error", "1", {}, {error_}}};
}

MonitorReport MagneticMoment::report() const {
  MonitorReport report = report_of(errors_, time_unit_);
  if (!begun_) {
    report.note = "no magnetic field turned the charge where it was looked at";
    return report;
  }
  report.first = reference_;
  report.last = value_;
  report.scale = reference_;
  report.note = fmt::format("swings by {:.2e} of its mean; {} turning points", swing(), turns_);
  if (turns_ >= 3) {
    report.note += fmt::format(", a bounce takes {:.6g}{}", bounce_period(), unit_.empty() ? "" : " " + unit_);
  }
  return report;
}

template void CanonicalMomentum::observe(const Snapshot<double>&);
template void CanonicalMomentum::observe(const Snapshot<Quad>&);
template void MagneticMoment::observe(const Snapshot<double>&);
template void MagneticMoment::observe(const Snapshot<Quad>&);
template struct detail::MonitorModel<CanonicalMomentum, double>;
template struct detail::MonitorModel<CanonicalMomentum, Quad>;
template struct detail::MonitorModel<MagneticMoment, double>;
template struct detail::MonitorModel<MagneticMoment, Quad>;

}  // namespace noether
