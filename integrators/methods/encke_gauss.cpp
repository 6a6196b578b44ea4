#include "integrators/methods/encke_gauss.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/kepler_double_double.hpp"
#include "integrators/methods/collocation_table.hpp"
#include "integrators/methods/encke_simd.hpp"
#include "integrators/methods/encke_words_simd.hpp"
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

Vec3<double> vector_of(const double (&from)[3]) { return {from[0], from[1], from[2]}; }

void put_words(const DoubleDouble& value, EightWords& words, std::size_t lane) {
  words[0][lane] = value.high;
  words[1][lane] = value.low;
}
DoubleDouble words_at(const EightWords& words, std::size_t lane) { return {words[0][lane], words[1][lane]}; }

double split_in_two(const Quad& x, double& low) {
  const auto high = static_cast<double>(x);
  low = static_cast<double>(x - Quad(high));
  return high;
}

}  // namespace

EnckeGauss::EnckeGauss(std::string_view name) : name_(name) {
  const CollocationTable& table = gauss_table(stages);
  const auto twice = table.twice_end(), last = table.last_coefficient();
  const auto ahead = last_polynomial(table);
  for (std::size_t i = 0; i < stages; ++i) {
    c_[i] = split_in_two(table.c[i], c_low_[i]);
    weights_.end[0][i] = split_in_two(table.b[i], weights_.end[1][i]);
    weights_.last[i] = static_cast<double>(last[i]);
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
  const bool alone = n_ == 2 && !beside_;  // an orbit without departures
  DoubleDouble total;
  for (Index i = 0; i < n_; ++i) total += DoubleDouble(masses_[i]);
  for (Index i = 0; i < n_; ++i) {
    if (i == primary_) continue;
    Body body;
    body.particle = i;
    body.mu = *G * DoubleDouble::sum(heaviest, masses_[i]);
    body.share = DoubleDouble(masses_[i]) / total;
    EnckeBody rows;
    rows.gm = *G * masses_[i];
    rows.mu = body.mu.high;
    if (!alone) {
      rows.mu_low = body.mu.low;
      body.mu = DoubleDouble(rows.mu);
    }
    bodies_.push_back(body);
    rows_.push_back(rows);
  }
  eights_.assign((bodies_.size() + stages - 1) / stages, EnckeEight{});
  for (std::size_t m = 0; m < eights_.size() * stages; ++m) {
    const Body& body = bodies_[in_lane(m)];
    put_words(body.mu, eights_[m / stages].mu, m % stages);
    if (m < bodies_.size()) put_words(body.share, eights_[m / stages].share, m % stages);
  }
  stage_.setZero(f.size());
  stage_push_.setZero(f.size() / 2);
  for (Vector<double>* words : {&low_, &start_, &start_low_, &inside_low_}) words->setZero(f.size());
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

/// Both words of all particles, side by side.
void EnckeGauss::gather(const Vector<double>& y) {
  for (Index k = 0; k < 6; ++k) {
    const double *const high = y.data() + k * n_, *const low = low_.data() + k * n_;
    center_[0][k] = high[primary_];
    center_[1][k] = low[primary_];
    for (std::size_t m = 0; m < eights_.size() * stages; ++m) {
      const Index particle = bodies_[in_lane(m)].particle;
      EightWords& words = eights_[m / stages].at[k];
      words[0][m % stages] = high[particle];
      words[1][m % stages] = low[particle];
    }
  }
}

void EnckeGauss::scatter(Vector<double>& y) {
  for (Index k = 0; k < 6; ++k) {
    double *const high = y.data() + k * n_, *const low = low_.data() + k * n_;
    high[primary_] = center_[0][k];
    low[primary_] = center_[1][k];
    for (std::size_t m = 0; m < bodies_.size(); ++m) {
      const EightWords& words = eights_[m / stages].at[k];
      high[bodies_[m].particle] = words[0][m % stages];
      low[bodies_[m].particle] = words[1][m % stages];
    }
  }
}

StepResult EnckeGauss::step(VectorField<double>& f, const double& t, Vector<double>& y, double h) {
  StepResult made{.h = h};
  t_ = t;
  start_ = y;
  start_low_ = low_;
  made.failure = open(y, h);
  if (made.failure) return made;
  if (h == h_) predict();
  made.failure = sweep(f, t, h);
  if (!made.failure) made.failure = end_stages(h);
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
  gather(y);
  encke_word_kernels().relate(eights_.data(), std::ssize(eights_), center_);
  for (std::size_t m = 0; m < bodies_.size(); ++m) {
    EnckeBody& rows = rows_[m];
    const EnckeEight& eight = eights_[m / stages];
    for (std::size_t k = 0; k < 3; ++k) {
      rows.x0[k] = eight.own[k][0][m % stages];
      rows.v0[k] = eight.own[k + 3][0][m % stages];
    }
    if (h == h_) continue;
    for (auto& p : rows.perturbation) std::fill_n(p, stages, 0.0);
    for (auto& rate : rows.rate) std::fill_n(rate, stages, 0.0);
  }
  for (std::size_t i = 0; i < stages; ++i) {
    const DoubleDouble tau = DoubleDouble::product(c_[i], h);
    put_words({tau.high, tau.low + c_low_[i] * h}, tau_, i);
  }
  encke_kernels().orbits(rows_.data(), std::ssize(rows_), tau_);
  for (std::size_t m = 0; m < bodies_.size(); ++m) {
    if (rows_[m].missed == 0) continue;
    if (auto failure = find_orbits(bodies_[m], rows_[m], h)) return failure;
  }
  if (!beside_) return {};
  for (Index k = 0; k < 3; ++k) {
    mean_.x[k] = center_[0][k];
    mean_.v[k] = center_[0][k + 3];
    for (std::size_t m = 0; m < bodies_.size(); ++m) {
      mean_.x[k] += bodies_[m].share.high * rows_[m].x0[k];
      mean_.v[k] += bodies_[m].share.high * rows_[m].v0[k];
    }
  }
  return {};
}

/// Orbits at the stages that lanes have missed.
std::optional<Failure> EnckeGauss::find_orbits(const Body& body, EnckeBody& rows, double h) const {
  const Vec3<double> x0 = vector_of(rows.x0), v0 = vector_of(rows.v0);
  for (std::size_t i = 0; i < stages; ++i) {
    if ((rows.missed >> i & 1U) == 0) continue;
    const double tau = tau_[0][i];
    const KeplerArc<double> arc = kepler_arc(x0, v0, rows.mu, tau);
    if (arc.status != KeplerStatus::converged) return no_arc(body, h);
    const KeplerTangent tangent(x0, v0, rows.mu, tau, arc.s);
    const std::array<double, 8> upper = tangent.upper();
    for (std::size_t k = 0; k < upper.size(); ++k) rows.upper[k][i] = upper[k];
    const Vec3<double> x = x0 + arc.dx;
    const double r2 = norm2(x);
    for (std::size_t k = 0; k < 3; ++k) rows.orbit[k][i] = x[static_cast<Index>(k)];
    rows.inverse_r2[i] = 1 / r2;
    rows.mu_r3[i] = rows.mu / (r2 * std::sqrt(r2));
    if (i + 1 < stages) continue;
    rows.last_s = arc.s;
    rows.last_r = std::sqrt(r2);
    rows.last_eta = dot(x, Vec3<double>(v0 + arc.dv));
  }
  return {};
}

/// Perturbations as the polynomial of the last step has them in this one.
void EnckeGauss::predict() { encke_kernels().predict(rows_.data(), std::ssize(rows_), ahead_.data()); }

/// Forces that are not gravity of points, at all stages; positions alone count, relative to the centre of mass and its
/// even motion.
void EnckeGauss::add_forces_beside(VectorField<double>& f, double t) {
  for (std::size_t i = 0; i < stages; ++i) {
    Vec3<double> x = mean_.x + tau_[0][i] * mean_.v;
    for (std::size_t m = 0; m < bodies_.size(); ++m) {
      for (std::size_t k = 0; k < 3; ++k) x[static_cast<Index>(k)] -= bodies_[m].share.high * rows_[m].place[k][i];
    }
    for (Index k = 0; k < 3; ++k) stage_[k * n_ + primary_] = x[k];
    for (std::size_t m = 0; m < bodies_.size(); ++m) {
      for (Index k = 0; k < 3; ++k)
        stage_[k * n_ + bodies_[m].particle] = x[k] + rows_[m].place[static_cast<std::size_t>(k)][i];
    }
    f.accelerations_beside_gravity(t + tau_[0][i], stage_, stage_push_);
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

/// @return why perturbations do not stand still, if they do not
std::optional<Failure> EnckeGauss::sweep(VectorField<double>& f, double t, double h) {
  double before = std::numeric_limits<double>::infinity();
  for (int round = 1; round <= most_departure_sweeps; ++round) {
    encke_kernels().depart(rows_.data(), std::ssize(rows_), a_.data(), h);
    strongest_ = encke_kernels().attract(rows_.data(), std::ssize(rows_));
    f.evaluations().force += stages;
    if (beside_) add_forces_beside(f, t);
    if (beside_ && f.failure()) return f.failure();
    const EnckeChange change = encke_kernels().take(rows_.data(), std::ssize(rows_), round == 1);
    const double relative = std::sqrt(change.relative2);
    if (!std::isfinite(relative)) break;
    const double shrinks = round > 1 ? relative / before : 1;
    if (relative * std::min(shrinks, 1.0) <= settled_departures) return {};
    if (round > 2 && shrinks >= 1) {
      if (h * h * std::sqrt(change.moves2) <= departures_may_round) return {};
      if (round > patient_departures) break;
    }
    before = relative;
  }
  return Failure{
      Outcome::Kind::solver_failure, -1, "departures",
      fmt::format("the departures from Kepler orbits do not converge with a step of {:.6g}; {}", h, ways_out)};
}

/// Sums over the stages, for the end. @return a failure if a polynomial of degree 7 does not follow the
/// perturbations, unless these are too small to matter
std::optional<Failure> EnckeGauss::end_stages(double h) {
  constexpr double negligible = 1e-14 * 1e-14, rough = rough_perturbations * rough_perturbations;
  for (std::size_t e = 0; e < eights_.size(); ++e) {
    EnckeEight& eight = eights_[e];
    std::array<const EnckeBody*, stages> bodies{};
    for (std::size_t lane = 0; lane < stages; ++lane) {
      const EnckeBody& rows = rows_[in_lane(e * stages + lane)];
      bodies[lane] = &rows;
      eight.last_s[lane] = rows.last_s;
      eight.last_r[lane] = rows.last_r;
      eight.last_eta[lane] = rows.last_eta;
    }
    encke_word_kernels().sum(bodies.data(), weights_, eight);
    for (std::size_t lane = 0; lane < stages; ++lane) {
      const double last2 = eight.last2[lane];
      const bool matters = h * h * h * h * last2 * eight.nearest[lane] > negligible;
      if (!matters || last2 <= rough * eight.largest2[lane]) continue;
      return Failure{
          Outcome::Kind::solver_failure, bodies_[in_lane(e * stages + lane)].particle, "departure",
          fmt::format("perturbations change too fast to be followed with a step of {:.6g}; {}", h, ways_out)};
    }
  }
  return {};
}

/// The arcs in double-double, the departures at the end, and the centre of mass.
std::optional<Failure> EnckeGauss::close(Vector<double>& y, double h) {
  for (std::size_t e = 0; e < eights_.size(); ++e) {
    const unsigned missed = encke_word_kernels().advance(eights_[e], h, tau_[0][stages - 1]);
    for (std::size_t m = e * stages; m < std::min((e + 1) * stages, bodies_.size()); ++m) {
      if ((missed >> m % stages & 1U) != 0 && !advance_one(m, h)) return no_arc(bodies_[m], h);
    }
  }
  alignas(64) std::array<double, stages> push{};
  for (std::size_t k = 0; k < 3 && beside_; ++k) {
    double way = 0, speed = 0;
    for (std::size_t i = 0; i < stages; ++i) {
      way += twice_[0][i] * drift_[k][i] + twice_[1][i] * drift_[k][i];
      speed += weights_.end[0][i] * drift_[k][i] + weights_.end[1][i] * drift_[k][i];
    }
    push[k] = h * h * way;
    push[k + 3] = h * speed;
  }
  encke_word_kernels().place(eights_.data(), std::ssize(eights_), center_, push.data(), h);
  scatter(y);
  return {};
}

/// How far a body moves, where lanes have missed its arc. @return whether there is one
bool EnckeGauss::advance_one(std::size_t body, double h) {
  EnckeEight& eight = eights_[body / stages];
  const std::size_t lane = body % stages;
  Vec3<DoubleDouble> x, v;
  KeplerChange sum, low;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Index>(k);
    x[axis] = words_at(eight.own[k], lane);
    v[axis] = words_at(eight.own[k + 3], lane);
    sum.x[axis] = eight.sums[k][0][lane];
    sum.v[axis] = eight.sums[k + 3][0][lane];
    low.x[axis] = eight.sums[k][1][lane];
    low.v[axis] = eight.sums[k + 3][1][lane];
  }
  const KeplerArc<DoubleDouble> arc = kepler_arc(x, v, bodies_[body].mu, DoubleDouble(h));
  if (arc.status != KeplerStatus::converged) return false;
  const EnckeBody& rows = rows_[body];
  const KeplerTangent tangent(vector_of(rows.x0), vector_of(rows.v0), rows.mu, h, arc.s.high);
  const Vec3<double> away = h * tangent.position(sum), faster = h * tangent.velocity(sum),
                     away_low = h * tangent.position(low), faster_low = h * tangent.velocity(low);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Index>(k);
    put_words(arc.dx[axis] + DoubleDouble(away[axis], away_low[axis]), eight.moved[k], lane);
    put_words(arc.dv[axis] + DoubleDouble(faster[axis], faster_low[axis]), eight.moved[k + 3], lane);
  }
  return true;
}

/// A step from where the last one began, whose sweeps begin with the polynomial of its perturbations.
void EnckeGauss::interpolate(VectorField<double>& f, const double& theta, Vector<double>& y) {
  y = start_;
  inside_low_ = start_low_;
  if (theta == 0) return;
  EnckeGauss part(*this);
  const auto inside = inner_polynomial(c_, theta);
  for (std::size_t i = 0; i < stages; ++i) {
    for (std::size_t j = 0; j < stages; ++j) part.ahead_[stages * j + i] = inside[i][j];
  }
  part.low_ = start_low_;
  part.h_ = theta * h_;
  if (part.step(f, t_, y, part.h_).failure) y.setConstant(std::numeric_limits<double>::quiet_NaN());
  inside_low_ = part.low_;
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
