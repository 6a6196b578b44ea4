#include "integrators/wisdom_holman_lanes.hpp"

#include "integrators/kepler.hpp"
#include "integrators/wisdom_holman_simd.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace noether {

namespace {

constexpr std::size_t lanes = 8;
constexpr std::size_t most_kept = 32;  // rows of which constants of all pairs are kept: below a megabyte

}  // namespace

bool exact_arc(const double* x, const double* v, double mu, double h, double* dx, double* dv, double* s) {
  const KeplerArc<double> arc = kepler_arc(Vec3<double>(x[0], x[1], x[2]), Vec3<double>(v[0], v[1], v[2]), mu, h);
  for (int c = 0; c < 3; ++c) dx[c] = arc.dx[c], dv[c] = arc.dv[c];
  *s = arc.s;
  return arc.status == KeplerStatus::converged;
}

bool PlanetLanes::can_take(const PlanetSystem& system) {
  constexpr double least = 1e-60, most = 1e60;
  const double star = system.masses[0], mu = system.G * star;
  if (system.order.size() < 2) return false;
  if (!(mu > least && mu < most) || !(system.size > least && system.size < most)) return false;
  return std::all_of(system.order.begin() + 1, system.order.end(), [&](std::int64_t i) {
    const double m = system.masses[static_cast<std::size_t>(i)] / star;
    return m > least && m < most;
  });
}

void PlanetLanes::bind(const PlanetSystem& system) {
  order_.assign(system.order.begin() + 1, system.order.end());
  jacobi_ = system.jacobi;
  relativity_ = system.bend.has_value();
  const std::size_t n = order_.size(), rows = (n + lanes - 1) / lanes;
  row_.assign(rows, PlanetRow{});
  of_own_alone_ = rows > most_kept;
  pairs_.assign(of_own_alone_ ? rows : rows * (rows + 1) / 2, PlanetPairs{});
  const double star = system.masses[0], mu = system.G * star, far = 1e3 * system.size;
  const double bend = system.bend.value_or(0);
  star_mu_ = mu;
  double interior = star;
  for (std::size_t k = 0; k < rows * lanes; ++k) {
    PlanetRow& row = row_[k / lanes];
    const std::size_t lane = k % lanes;
    if (k >= n) {
      for (int c = 0; c < 3; ++c) row.x[c][lane] = far * static_cast<double>(k + 2) / (c + 1);
      row.rest[lane] = 1;
      continue;
    }
    const double mass = system.masses[static_cast<std::size_t>(order_[k])], m = mass / star, total = interior + mass;
    row.mu[lane] = system.G * (jacobi_ ? total : star);
    row.share[lane] = jacobi_ ? mass / total : m;
    row.rest[lane] = 1 - row.share[lane];
    row.one_over_m[lane] = 1 / m;
    row.one_over_M[lane] = star / interior;
    row.star[lane] = k > 0 ? mu * m : 0;
    row.without_arc[lane] = k > 0 ? row.mu[lane] : 0;
    row.relativity[lane] = bend * m;
    row.attracts[lane] = mu * m;
    row.mass[lane] = m;
    row.moves[lane] = 1;
    interior = total;
    for (std::size_t j = first_kept(k); j < k; ++j) {
      const double other = system.masses[static_cast<std::size_t>(order_[j])] / star;
      for_places(j, k, [&](PlanetPairs& pairs, std::size_t away, std::size_t at) {
        pairs.attraction[away][at] = mu * other * m;
      });
    }
  }
  second_passes_ = exact_arcs_ = 0;
  forget();
}

PlanetPairs& PlanetLanes::pair_constants(std::size_t first_row, std::size_t second_row) {
  if (of_own_alone_) return pairs_[first_row];
  const std::size_t before = first_row * row_.size() - first_row * (first_row + 1) / 2 + first_row;
  return pairs_[before + second_row - first_row];
}

/// Where kernels look up the constants of a pair.
template <class Set> void PlanetLanes::for_places(std::size_t inner, std::size_t outer, const Set& set) {
  const std::size_t a = inner / lanes, b = outer / lanes, i = inner % lanes, j = outer % lanes;
  const std::size_t away = (j + lanes - i) % lanes, back = lanes - away;
  PlanetPairs& pairs = pair_constants(a, b);
  if (a != b || away <= 4) set(pairs, away, i);
  if (a == b && back <= 4) set(pairs, back, j);
}

void PlanetLanes::set_near(std::size_t inner, std::size_t outer, double ratio2) {
  for_places(inner, outer,
             [&](PlanetPairs& pairs, std::size_t away, std::size_t at) { pairs.near[away][at] = ratio2; });
}

/// The cube root of a sum of two masses is at most the sum of theirs: with equal ones, 2^(1/3) times one of them.
void PlanetLanes::set_reach(std::size_t k, double ratio2_of_equals) {
  row_[k / lanes].reach[k % lanes] = std::sqrt(ratio2_of_equals) / std::cbrt(2.0) * (1 + 1e-12);
}

PlanetRows PlanetLanes::rows() {
  return {.row = row_.data(),
          .rows = static_cast<std::ptrdiff_t>(row_.size()),
          .pairs = pairs_.data(),
          .of_own_alone = of_own_alone_,
          .jacobi = jacobi_,
          .compensated = compensated_,
          .relativity = relativity_,
          .exact = exact_arc};
}

void PlanetLanes::load(const ParticleSystem<double>& s) {
  const auto* low = s.low_words();
  compensated_ = low != nullptr;
  for (int c = 0; c < 3; ++c) {
    const double *x = s.positions().component(c), *v = s.velocities().component(c);
    const double* x_low = low != nullptr ? low->x.component(c) : nullptr;
    const double* v_low = low != nullptr ? low->v.component(c) : nullptr;
    for (std::size_t k = 0; k < order_.size(); ++k) {
      PlanetRow& row = row_[k / lanes];
      const std::size_t lane = k % lanes;
      const std::int64_t i = order_[k];
      row.x[c][lane] = x[i];
      row.v[c][lane] = v[i];
      if (!compensated_) continue;
      row.x_low[c][lane] = x_low[i];
      row.v_low[c][lane] = v_low[i];
    }
  }
  planet_kernels().prepare(rows());
  knows_forces_ = false;
}

void PlanetLanes::store(ParticleSystem<double>& s, bool positions) const {
  auto* low = s.low_words();
  for (int c = 0; c < 3; ++c) {
    double* x = positions ? s.positions().component(c) : nullptr;
    double* v = s.velocities().component(c);
    for (std::size_t k = 0; k < order_.size(); ++k) {
      const PlanetRow& row = row_[k / lanes];
      const std::size_t lane = k % lanes;
      const std::int64_t i = order_[k];
      if (positions) x[i] = row.x[c][lane];
      v[i] = row.v[c][lane];
      if (low == nullptr) continue;
      if (positions) low->x.component(c)[i] = row.x_low[c][lane];
      low->v.component(c)[i] = row.v_low[c][lane];
    }
  }
}

Index PlanetLanes::drift(double h, bool on_copy, PlanetPath* path) {
  const bool again = !on_copy && h == last_;
  const ArcTask task{.h = h, .predicted = again && predicted_, .predict = again};
  const ArcReport report = planet_kernels().drift(rows(), task);
  knows_forces_ = false;
  if (path != nullptr) path->add_arc(task);
  if (!on_copy) {
    predicted_ = again;
    last_ = h;
    second_passes_ += report.second;
    exact_arcs_ += report.exact;
  }
  return report.failed < 0 ? Index{-1} : static_cast<Index>(order_[static_cast<std::size_t>(report.failed)]);
}

bool PlanetLanes::kick(const Kick& kick, bool on_copy, PlanetPath* path) {
  const bool predicted = predicted_ && !on_copy;
  if (path != nullptr) path->begin_kick(rows(), order_.size(), kick.h, kick.time, predicted, kick.noting);
  const bool near = planet_kernels().kick(rows(), kick.h, predicted);
  if (path != nullptr) path->end_kick(rows(), order_.size(), star_mu_);
  knows_forces_ = jacobi_;
  return near;
}

bool PlanetLanes::accelerate(double h) {
  const bool near = planet_kernels().accelerate(rows(), h, knows_forces_);
  knows_forces_ = true;
  return near;
}

void PlanetLanes::kick_beside(double h) {
  planet_kernels().kick_beside(rows(), h);
  knows_forces_ = false;
}

void PlanetLanes::kick_by_gradient(double h) {
  planet_kernels().kick_by_gradient(rows(), h);
  knows_forces_ = false;
}

void PlanetLanes::give(Predictions& to) const {
  to.last = last_;
  to.s.clear();
  to.s.reserve(order_.size());
  for (std::size_t k = 0; predicted_ && k < order_.size(); ++k) to.s.push_back(row_[k / lanes].s[k % lanes]);
}

void PlanetLanes::take(const Predictions& from) {
  last_ = from.last;
  predicted_ = !from.s.empty();
  if (!predicted_) return;
  if (from.s.size() != order_.size()) throw Error("the saved predictions of Kepler arcs do not match these planets");
  for (std::size_t k = 0; k < row_.size() * lanes; ++k) {
    PlanetRow& row = row_[k / lanes];
    const std::size_t lane = k % lanes;
    const Vec3<double> at_rest(row.x[0][lane], row.x[1][lane], row.x[2][lane]);
    row.s[lane] = k < from.s.size() ? from.s[k] : last_ / std::sqrt(norm2(at_rest));
  }
}

void PlanetLanes::save(SavedState& saved, const std::string& prefix) const {
  Predictions now;
  give(now);
  save_value(saved, prefix + "last", now.last);
  save_value(saved, prefix + "predicted", now.s);
}

void PlanetLanes::load(const SavedState& saved, const std::string& prefix) {
  forget();
  if (!saved.contains(prefix + "last")) return;  // written when there were no lanes
  Predictions then;
  load_value(saved, prefix + "last", then.last);
  load_value(saved, prefix + "predicted", then.s);
  take(then);
}

}  // namespace noether
