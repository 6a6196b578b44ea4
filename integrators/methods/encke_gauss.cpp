#include "integrators/methods/encke_gauss.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/kepler_double_double.hpp"
#include "integrators/methods/collocation_table.hpp"
#include "integrators/methods/encke_simd.hpp"
#include "integrators/methods/last_polynomial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace noether {

namespace {

/// Sweeps end when the next one is expected to change perturbations by no more than this part of them.
constexpr double settled_departures = 1e-16;
/// Where bodies are so near to each other that doubles hardly tell their distance, sweeps end at what rounding leaves:
/// at changes that move positions by no more than this part of the distance from the heaviest body.
constexpr double departures_may_round = 1e-16;
/// Rounding of distances r moves two bodies by some 1e-16 h^2 G (m + m') / r^3 of their distance from the heaviest one.
/// Steps in which that factor is larger have errors above 1e-18.
constexpr double strong_pull = 0.01;
/// So many sweeps are made before one that changes more than the one before it ends the step.
constexpr int patient_departures = 12;
constexpr int most_departure_sweeps = 60;
constexpr std::string_view ways_out =
    "give a shorter one, or use 'wide_gauss_8', or 'gauss_8', which chooses its steps";
/// A last Legendre coefficient above this part of the largest perturbation leaves errors of its square.
constexpr double rough_perturbations = 0.03;
/// A second mass above this part of the heaviest one perturbs orbits so much that doubles limit the departures.
constexpr double dominated = 0.1;

Vec3<double> high_words(const Vec3<DoubleDouble>& a) { return {a[0].high, a[1].high, a[2].high}; }

double split_in_two(const Quad& x, double& low) {
  const auto high = static_cast<double>(x);
  low = static_cast<double>(x - Quad(high));
  return high;
}

}  // namespace

EnckeGauss::EnckeGauss(std::string_view name) : name_(name), ahead_{} {
  const CollocationTable& table = gauss_table(stages);
  const auto twice = table.twice_end(), last = table.last_coefficient();
  const auto ahead = last_polynomial(table);
  for (std::size_t i = 0; i < stages; ++i) {
    c_[i] = static_cast<double>(table.c[i]);
    b_[i] = split_in_two(table.b[i], b_low_[i]);
    last_[i] = static_cast<double>(last[i]);
    twice_[0][i] = split_in_two(twice[i], twice_[1][i]);
    for (std::size_t j = 0; j < stages; ++j) ahead_[stages * j + i] = ahead[i][j];
    for (std::size_t j = 0; j < stages; ++j) a_[stages * j + i] = static_cast<double>(table.a[i][j]);
  }
}

void EnckeGauss::bind(const VectorField<double>& f) {
  const std::optional<double> G = f.gravity_of_points();
  if (!G) throw SchemeMismatch(fmt::format("method '{}' is for gravity; use 'gauss_8'", name_));
  n_ = f.particles();
  masses_ = f.masses().head(n_);
  masses_.maxCoeff(&primary_);
  const double heaviest = masses_[primary_];
  if (!(heaviest > 0)) {
    throw SchemeMismatch(fmt::format(
        "method '{}' follows orbits about the heaviest body, but no body has a mass; use 'gauss_8'", name_));
  }
  refuse_equals();
  beside_ = f.has_forces_beside_gravity();
  bodies_.clear();
  rows_.clear();
  DoubleDouble total;
  for (Index i = 0; i < n_; ++i) total += DoubleDouble(masses_[i]);
  for (Index i = 0; i < n_; ++i) {
    if (i == primary_) continue;
    Body body;
    body.particle = i;
    body.mu = *G * DoubleDouble::sum(heaviest, masses_[i]);
    body.share = DoubleDouble(masses_[i]) / total;
    bodies_.push_back(body);
    EnckeBody rows;
    rows.gm = *G * masses_[i];
    rows.mu = body.mu.high;
    rows_.push_back(rows);
  }
  stage_.setZero(f.size());
  stage_push_.setZero(f.size() / 2);
  low_.setZero(f.size());
  h_ = 0;
}

/// Of two bodies alone the orbit is exact, whatever their masses.
void EnckeGauss::refuse_equals() const {
  Index second = -1;
  for (Index i = 0; i < n_; ++i) {
    if (i != primary_ && (second < 0 || masses_[i] > masses_[second])) second = i;
  }
  if (n_ < 3 || masses_[second] <= dominated * masses_[primary_]) return;
  throw SchemeMismatch(
      fmt::format("method '{}' follows orbits about one body that dominates, but particle {} has {:.3g} of the mass of "
                  "the heaviest one, particle {}; use 'wide_gauss_8'",
                  name_, second, masses_[second] / masses_[primary_], primary_));
}

EnckeGauss::WideVector EnckeGauss::wide(const Vector<double>& y, Index particle, Index half) const {
  WideVector made;
  for (Index k = 0; k < 3; ++k) {
    const Index at = half + k * n_ + particle;
    made[k] = DoubleDouble::sum(y[at], low_[at]);
  }
  return made;
}

void EnckeGauss::put(const WideVector& value, Vector<double>& y, Index particle, Index half) {
  for (Index k = 0; k < 3; ++k) {
    const Index at = half + k * n_ + particle;
    y[at] = value[k].high;
    low_[at] = value[k].low;
  }
}

StepResult EnckeGauss::step(VectorField<double>& f, const double& t, Vector<double>& y, double h) {
  StepResult made{.h = h};
  made.failure = open(y, h);
  if (made.failure) return made;
  if (h == h_) predict();
  made.failure = sweep(f, t, h);
  if (!made.failure) made.failure = unresolved(h);
  if (!made.failure) made.failure = close(y, h);
  if (made.failure) return made;
  h_ = h;
  if (h * h * strongest_ > strong_pull) ++f.evaluations().unsettled;
  f.evaluations().kepler += static_cast<std::int64_t>((stages + 1) * bodies_.size());
  return made;
}

Failure EnckeGauss::no_arc(const Body& body, double h) const {
  return {Outcome::Kind::solver_failure, body.particle, "position",
          fmt::format("no Kepler orbit about the heaviest body was found over a step of {:.6g}", h)};
}

/// Orbits of all bodies at the beginning of the step; no departures from them yet.
std::optional<Failure> EnckeGauss::open(const Vector<double>& y, double h) {
  const WideVector x = wide(y, primary_, 0), v = wide(y, primary_, 3 * n_);
  for (std::size_t m = 0; m < bodies_.size(); ++m) {
    Body& body = bodies_[m];
    EnckeBody& rows = rows_[m];
    body.x = wide(y, body.particle, 0) - x;
    body.v = wide(y, body.particle, 3 * n_) - v;
    body.x0 = high_words(body.x);
    body.v0 = high_words(body.v);
    for (std::size_t k = 0; k < 3; ++k) {
      rows.x0[k] = body.x0[static_cast<Index>(k)];
      rows.v0[k] = body.v0[static_cast<Index>(k)];
      std::fill_n(rows.rate_x[k], stages, 0.0);
      std::fill_n(rows.rate_v[k], stages, 0.0);
      if (h != h_) std::fill_n(rows.perturbation[k], stages, 0.0);
    }
    if (auto failure = find_orbits(body, rows, h)) return failure;
  }
  if (!beside_) return {};
  center_ = {high_words(x), high_words(v)};
  for (const Body& body : bodies_) {
    center_.x += body.share.high * body.x0;
    center_.v += body.share.high * body.v0;
  }
  return {};
}

std::optional<Failure> EnckeGauss::find_orbits(const Body& body, EnckeBody& rows, double h) const {
  Lanes tau{};
  for (std::size_t i = 0; i < stages; ++i) tau[i] = c_[i] * h;
  const unsigned missed = encke_kernels().orbits(rows, tau.data());
  for (std::size_t i = 0; i < stages; ++i) {
    if ((missed >> i & 1U) == 0) continue;
    const KeplerArc<double> arc = kepler_arc(body.x0, body.v0, body.mu.high, tau[i]);
    if (arc.status != KeplerStatus::converged) return no_arc(body, h);
    const KeplerTangent tangent(body.x0, body.v0, body.mu.high, tau[i], arc.s);
    const std::array<double, 8> upper = tangent.upper();
    for (std::size_t k = 0; k < upper.size(); ++k) rows.upper[k][i] = upper[k];
    const Vec3<double> x = body.x0 + arc.dx;
    const double r2 = norm2(x);
    for (std::size_t k = 0; k < 3; ++k) rows.orbit[k][i] = x[static_cast<Index>(k)];
    rows.inverse_r2[i] = 1 / r2;
    rows.mu_r3[i] = body.mu.high / (r2 * std::sqrt(r2));
  }
  return {};
}

/// Perturbations as the polynomial of the last step has them in this one.
void EnckeGauss::predict() {
  encke_kernels().predict(rows_.data(), std::ssize(rows_), ahead_.data());
  take_perturbations(h_);
}

/// Forces that are not gravity of points, at all stages; positions alone count, relative to the centre of mass and its
/// even motion.
void EnckeGauss::add_forces_beside(VectorField<double>& f, double t, double h) {
  for (std::size_t i = 0; i < stages; ++i) {
    Vec3<double> x = center_.x + c_[i] * h * center_.v;
    for (std::size_t m = 0; m < bodies_.size(); ++m) {
      for (std::size_t k = 0; k < 3; ++k) x[static_cast<Index>(k)] -= bodies_[m].share.high * rows_[m].place[k][i];
    }
    for (Index k = 0; k < 3; ++k) stage_[k * n_ + primary_] = x[k];
    for (std::size_t m = 0; m < bodies_.size(); ++m) {
      for (Index k = 0; k < 3; ++k)
        stage_[k * n_ + bodies_[m].particle] = x[k] + rows_[m].place[static_cast<std::size_t>(k)][i];
    }
    f.accelerations_beside_gravity(t + c_[i] * h, stage_, stage_push_);
    for (std::size_t k = 0; k < 3; ++k) {
      const double* const push = stage_push_.data() + static_cast<Index>(k) * n_;
      double mean = push[primary_];
      for (std::size_t m = 0; m < bodies_.size(); ++m) {
        const double relative = push[bodies_[m].particle] - push[primary_];
        rows_[m].fresh[k][i] += relative;
        mean += bodies_[m].share.high * relative;
      }
      drift_[k][i] = mean;
    }
  }
}

/// The fresh perturbations become those at hand, and the rates follow.
EnckeGauss::Change EnckeGauss::take_perturbations(double h) {
  encke_kernels().take(rows_.data(), std::ssize(rows_));
  Change worst;
  for (const EnckeBody& rows : rows_) {
    double change = 0, size = 0, inverse = 0;
    for (std::size_t i = 0; i < stages; ++i) {
      if (!(rows.change2[i] <= change)) change = rows.change2[i];  // a NaN stays
      size = std::max(size, rows.size2[i]);
      inverse = std::max(inverse, rows.inverse_r2[i]);
    }
    if (!std::isfinite(change)) return {change, change};
    if (change == 0) continue;
    worst.relative = std::max(worst.relative, std::sqrt(change / size));
    worst.moves = std::max(worst.moves, h * h * std::sqrt(change * inverse));
  }
  return worst;
}

/// @return why perturbations do not stand still, if they do not
std::optional<Failure> EnckeGauss::sweep(VectorField<double>& f, double t, double h) {
  double before = std::numeric_limits<double>::infinity();
  for (int round = 1; round <= most_departure_sweeps; ++round) {
    encke_kernels().depart(rows_.data(), std::ssize(rows_), a_.data(), h);
    strongest_ = encke_kernels().attract(rows_.data(), std::ssize(rows_));
    f.evaluations().force += stages;
    if (beside_) add_forces_beside(f, t, h);
    if (beside_ && f.failure()) return f.failure();
    const Change change = take_perturbations(h);
    if (!std::isfinite(change.relative)) break;
    const double shrinks = round > 1 ? change.relative / before : 1;
    if (change.relative * std::min(shrinks, 1.0) <= settled_departures) return {};
    if (round > 2 && shrinks >= 1) {
      if (change.moves <= departures_may_round) return {};
      if (round > patient_departures) break;
    }
    before = change.relative;
  }
  return Failure{
      Outcome::Kind::solver_failure, -1, "departures",
      fmt::format("the departures from Kepler orbits do not converge with a step of {:.6g}; {}", h, ways_out)};
}

/// Perturbations that a polynomial of degree 7 does not follow, unless they are too small to matter.
std::optional<Failure> EnckeGauss::unresolved(double h) const {
  for (std::size_t m = 0; m < bodies_.size(); ++m) {
    const EnckeBody& rows = rows_[m];
    double last2 = 0, largest2 = 0, nearest2 = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      double last = 0;
      for (std::size_t i = 0; i < stages; ++i) last += last_[i] * rows.perturbation[k][i];
      last2 += last * last;
    }
    for (std::size_t i = 0; i < stages; ++i) {
      double size2 = 0;
      for (std::size_t k = 0; k < 3; ++k) size2 += rows.perturbation[k][i] * rows.perturbation[k][i];
      largest2 = std::max(largest2, size2);
      nearest2 = std::min(nearest2, 1 / rows.inverse_r2[i]);
    }
    constexpr double negligible = 1e-14;
    const bool matters = h * h * std::sqrt(last2) > negligible * std::sqrt(nearest2);
    if (!matters || last2 <= rough_perturbations * rough_perturbations * largest2) continue;
    return Failure{Outcome::Kind::solver_failure, bodies_[m].particle, "departure",
                   fmt::format("perturbations change too fast to be followed with a step of {:.6g}; {}", h, ways_out)};
  }
  return {};
}

/// The arcs in double-double, the departures at the end, and the centre of mass.
std::optional<Failure> EnckeGauss::close(Vector<double>& y, double h) {
  const DoubleDouble step(h);
  WideVector dx = WideVector::Zero(), dv = WideVector::Zero(), center_v = wide(y, primary_, 3 * n_);
  for (std::size_t m = 0; m < bodies_.size(); ++m) {
    Body& body = bodies_[m];
    const EnckeBody& rows = rows_[m];
    const KeplerArc<DoubleDouble> arc = kepler_arc(body.x, body.v, body.mu, step);
    if (arc.status != KeplerStatus::converged) return no_arc(body, h);
    const KeplerTangent tangent(body.x0, body.v0, body.mu.high, h, arc.s.high);
    KeplerChange sum{Vec3<double>::Zero(), Vec3<double>::Zero()};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Index>(k);
      for (std::size_t i = 0; i < stages; ++i) {
        sum.x[axis] += b_[i] * rows.rate_x[k][i] + b_low_[i] * rows.rate_x[k][i];
        sum.v[axis] += b_[i] * rows.rate_v[k][i] + b_low_[i] * rows.rate_v[k][i];
      }
    }
    const Vec3<double> away = h * tangent.position(sum), faster = h * tangent.velocity(sum);
    for (Index k = 0; k < 3; ++k) {
      center_v[k] += body.share * body.v[k];
      body.x[k] = arc.dx[k] + DoubleDouble(away[k]);
      body.v[k] = arc.dv[k] + DoubleDouble(faster[k]);
      dx[k] -= body.share * body.x[k];
      dv[k] -= body.share * body.v[k];
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Index>(k);
    dx[axis] += step * center_v[axis];
    if (!beside_) continue;
    double way = 0, speed = 0;
    for (std::size_t i = 0; i < stages; ++i) {
      way += twice_[0][i] * drift_[k][i] + twice_[1][i] * drift_[k][i];
      speed += b_[i] * drift_[k][i] + b_low_[i] * drift_[k][i];
    }
    dx[axis] += DoubleDouble(h * h * way);
    dv[axis] += DoubleDouble(h * speed);
  }
  for (const Body& body : bodies_) {
    put(wide(y, body.particle, 0) + body.x + dx, y, body.particle, 0);
    put(wide(y, body.particle, 3 * n_) + body.v + dv, y, body.particle, 3 * n_);
  }
  put(wide(y, primary_, 0) + dx, y, primary_, 0);
  put(wide(y, primary_, 3 * n_) + dv, y, primary_, 3 * n_);
  return {};
}

void EnckeGauss::save(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "h", h_);
  std::vector<double> perturbations;
  for (const EnckeBody& rows : rows_) {
    for (const auto& p : rows.perturbation) perturbations.insert(perturbations.end(), p, p + stages);
  }
  save_value(saved, prefix + "perturbations", perturbations);
}

void EnckeGauss::load(const SavedState& saved, const std::string& prefix) {
  load_value(saved, prefix + "h", h_);
  std::vector<double> perturbations;
  load_value(saved, prefix + "perturbations", perturbations);
  std::size_t at = 0;
  for (EnckeBody& rows : rows_) {
    for (auto& p : rows.perturbation) {
      for (double& x : p) x = detail::element(perturbations, at++);
    }
  }
}

namespace methods {

namespace {

std::unique_ptr<Method<double>> encke_gauss(const MethodInfo& info, const MethodOptions& /*options*/) {
  return std::make_unique<EnckeGauss>(info.name);
}

}  // namespace

std::span<const MethodInfo> encke_list() {
  static const MethodInfo list[] = {
      {.name = "encke_gauss_8",
       .summary = "departures from Kepler orbits by Gauss's collocation with 8 stages, on states of double-doubles",
       .use = "planets about one star with errors below the rounding of doubles, for as long as it takes",
       .source = "Encke1852",
       .family = "collocation",
       .order = 16,
       .gravity_only = true,
       .make = encke_gauss,
       .make_quad = nullptr},
  };
  return list;
}

}  // namespace methods

}  // namespace noether
