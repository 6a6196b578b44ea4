#include "monitors/charges.hpp"

#include "engine/charge.hpp"
#include "engine/sums.hpp"
#include "monitors/series_report.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {

namespace {

Vec3<double> vector_of(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

double gamma_of(const ChargeMotion& motion, const Vec3<double>& v) {
  if (!motion.c) return 1;
  const double beta = std::sqrt(norm2(v)) / *motion.c;
  return 1 / std::sqrt((1 - beta) * (1 + beta));
}

/// What fields and forces do at the places of the particles: accelerations but v x Omega, and Omega.
struct Here {
  VectorColumn<double> acceleration, rate, momentum;

  Here(const ChargeMotion& motion, const ParticleSystem<double>& s, bool momenta)
      : acceleration(s.size()), rate(s.size()), momentum(s.size()) {
    ForceSink<double> sink(acceleration, s, {});
    sink.set_gyrations(rate);
    if (momenta) sink.set_field_momenta(momentum);
    for (const AnyForce<double>& force : motion.forces) {
      if (!force.claims().gyrates) continue;
      force.add_to(sink, s);
    }
    if (momenta && sink.failure()) throw Error(sink.failure()->message);
  }
};

/// The fields among the forces of a run. @throws Error  where there are none
void expect_fields(const ChargeMotion& motion, const char* monitor) {
  const auto is_field = [](const AnyForce<double>& force) { return force.claims().gyrates; };
  if (std::any_of(motion.forces.begin(), motion.forces.end(), is_field)) return;
  throw Error(
      fmt::format("monitor '{}' watches charges in fields, but this run has no field; take it out, or add a "
                  "[[hamiltonian.field]]",
                  monitor));
}

}  // namespace

void CanonicalMomentum::check() const {
  if (!(norm2(vector_of(axis)) > 0)) refuse_field("axis", axis, "has no length; a direction is expected");
}

template <class Real> void CanonicalMomentum::check(const ParticleSystem<Real>& s) const {
  check();
  expect_fields(motion_, "canonical_momentum");
  static_cast<void>(Here(motion_, s.template as<double>(), true));
}
template void CanonicalMomentum::check(const ParticleSystem<double>&) const;
template void CanonicalMomentum::check(const ParticleSystem<Quad>&) const;

std::pair<double, double> CanonicalMomentum::momentum_of(const ParticleSystem<double>& s) const {
  const Here here(motion_, s, true);
  Vec3<double> n = vector_of(axis);
  n /= std::sqrt(norm2(n));
  double parts = 0;
  const double J = sum_over<double>(s.size(), [&](Index i) {
    const Vec3<double> x = s.positions()[i], v = s.velocities()[i], arm = x - vector_of(center);
    const Vec3<double> own = gamma_of(motion_, v) * s.masses()[i] * v, of_field = here.momentum[i];
    const auto along = [&](const Vec3<double>& p) {
      return symmetry == SpaceSymmetry::rotation ? dot(n, cross<double>(arm, p)) : dot(n, p);
    };
    parts += std::abs(along(own)) + std::abs(along(of_field));
    return along(own) + along(of_field);
  });
  return {J, parts};
}

template <class Real> void CanonicalMomentum::observe(const Snapshot<Real>& now) {
  const auto [J, parts] = momentum_of(now.state().template as<double>());
  if (!begun_) {
    begun_ = true;
    reference_ = J;
    scale_ = std::max(std::abs(J), 1e-3 * parts);
    if (scale_ == 0) scale_ = 1;
    time_unit_ = now.units().is_reduced() ? "1" : fmt::format("1/{}", now.units().time);
  }
  last_ = J;
  errors_.add(now.time(), (J - reference_) / scale_);
}

std::vector<Series> CanonicalMomentum::series() const {
  const char* dimension = symmetry == SpaceSymmetry::rotation ? "mass length^2/time" : "mass length/time";
  return {{.name = "value", .dimension = dimension, .shape = {}, .values = {last_}},
          {.name = "relative_error", .dimension = "1", .shape = {}, .values = {errors_.last()}}};
}

MonitorReport CanonicalMomentum::report() const {
  MonitorReport report = report_of(errors_, time_unit_);
  if (!begun_) return report;
  report.first = reference_;
  report.last = last_;
  report.scale = scale_;
  return report;
}

Index MagneticMoment::charge_of(const ParticleSystem<double>& s) const {
  if (s.has<Charge>()) {
    const auto& charges = s.column<Charge>();
    for (Index i = 0; i < s.size(); ++i) {
      const bool moves = charges[i] != 0 && s.masses()[i] != 0;
      if (body.empty() ? !moves : s.name(i) != body) continue;
      if (moves) return i;
      throw Error(fmt::format("body = \"{}\" has no charge, so no field turns it; give the name of a charge", body),
                  {.key = "body"});
    }
  }
  if (body.empty()) throw Error("no particle has a charge; give one to a body, or take this monitor out");
  throw Error(fmt::format("body = \"{}\" is not a particle{}", body, did_you_mean(body, s.names())), {.key = "body"});
}

template <class Real> void MagneticMoment::check(const ParticleSystem<Real>& s) const {
  expect_fields(motion_, "magnetic_moment");
  static_cast<void>(charge_of(s.template as<double>()));
}
template void MagneticMoment::check(const ParticleSystem<double>&) const;
template void MagneticMoment::check(const ParticleSystem<Quad>&) const;

void MagneticMoment::look(ParticleSystem<double> s, Index i) {
  const Vec3<double> x = std::as_const(s).positions()[i], v = std::as_const(s).velocities()[i];
  const double gamma = gamma_of(motion_, v);
  Vec3<double> rate, across = Vec3<double>::Zero();
  const auto take = [&] {
    const Here here(motion_, s, false);
    rate = std::as_const(here.rate)[i];
    const double rate2 = norm2(rate);
    const Vec3<double> drift = cross<double>(std::as_const(here.acceleration)[i], rate) / rate2, w = v - drift;
    across = w - dot(w, rate) / rate2 * rate;
    return Vec3<double>(x + gamma * cross<double>(across, rate) / rate2);
  };
  Vec3<double> X = take();
  for (int sweep = 0; sweep < 3; ++sweep) {
    if (at == MomentPlace::particle && sweep > 0) break;
    if (at == MomentPlace::gyrocenter) {
      s.positions().set(i, X);
      s.moved();
    }
    X = take();
  }
  const double charge = s.column<Charge>()[i], strength = std::sqrt(norm2(rate)) * s.masses()[i] / std::abs(charge);
  value_ = gamma * gamma * s.masses()[i] * norm2(across) / (2 * strength);
  center_ = {X[0], X[1], X[2]};
  parallel_ = dot(v, rate) / std::sqrt(norm2(rate)) * (charge < 0 ? -1 : 1);
}

template <class Real> void MagneticMoment::observe(const Snapshot<Real>& now) {
  const double before = parallel_, then = time_;
  const ParticleSystem<double> s = now.state().template as<double>();
  look(s, charge_of(s));
  time_ = now.time();
  if (!begun_) {
    begun_ = true;
    reference_ = least_ = most_ = value_;
    start_ = center_;
    began_at_ = time_;
    time_unit_ = now.units().is_reduced() ? "1" : fmt::format("1/{}", now.units().time);
    unit_ = now.units().time == std::string_view("1") ? "" : std::string(now.units().time);
  } else if (before * parallel_ < 0) {
    last_turn_ = then + (time_ - then) * before / (before - parallel_);
    if (turns_++ == 0) first_turn_ = last_turn_;
  }
  least_ = std::min(least_, value_);
  most_ = std::max(most_, value_);
  errors_.add(now.time(), (value_ - reference_) / (reference_ > 0 ? reference_ : 1));
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
          {"relative_error", "1", {}, {errors_.last()}}};
}

MonitorReport MagneticMoment::report() const {
  MonitorReport report = report_of(errors_, time_unit_);
  if (!begun_) return report;
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
