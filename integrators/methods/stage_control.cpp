#include "integrators/methods/stage_control.hpp"

#include "integrators/methods/collocation_simd.hpp"
#include "integrators/methods/gravity_gauss_simd.hpp"
#include "integrators/methods/step_ladder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace noether {

namespace {

constexpr std::size_t control_stages = 8;

/// Value, first and second derivative at t of the Lagrange polynomial of node j.
std::array<Quad, 3> derivatives_of(const CollocationTable& table, std::size_t j, const Quad& t) {
  Quad value = 1, first = 0, second = 0;
  for (std::size_t k = 0; k < table.stages(); ++k) {
    if (k == j) continue;
    const Quad scale = Quad(1) / (table.c[j] - table.c[k]), factor = (t - table.c[k]) * scale;
    second = second * factor + Quad(2) * first * scale;
    first = first * factor + value * scale;
    value = value * factor;
  }
  return {value, first, second};
}

/// Parts of the timescale, and sizes of the last coefficient relative to the rate, with which methods end at rounding
/// level on the systems of tests/data/orbits. What Radau's nodes cut off is of one order lower and a drift, so that
/// their steps are shorter than those of eight stages of Gauss.
struct Targets {
  double eta, last;
};
constexpr Targets targets_of(int order) {
  switch (order) {
    case 12:
      return {0.24, 4e-9};
    case 14:
      return {0.36, 2e-9};
    case 15:
      return {0.30, 3e-10};
    default:
      return {0.47, 1e-9};
  }
}

}  // namespace

StageControl::StageControl(const CollocationTable& table, bool mirrored, double rtol)
    : mirrored_(mirrored), degree_(static_cast<int>(table.stages()) - 1) {
  const double wider = std::pow(std::max(rtol, 1e-16) / 1e-16, 1.0 / table.order);
  const Targets targets = targets_of(table.order);
  eta_ = targets.eta * wider;
  target_ = targets.last * std::pow(wider, degree_);
  weights_.assign(6 * control_stages, 0);
  last_.assign(control_stages, 0);
  const std::vector<Quad> legendre = table.last_coefficient();
  for (std::size_t j = 0; j < table.stages(); ++j) {
    const std::array<Quad, 3> middle = derivatives_of(table, j, Quad(0.5)), end = derivatives_of(table, j, Quad(1));
    for (std::size_t q = 0; q < 3; ++q) {
      weights_[control_stages * q + j] = static_cast<double>(middle[q]);
      weights_[control_stages * (3 + q) + j] = static_cast<double>(end[q]);
    }
    last_[j] = static_cast<double>(legendre[j]);
  }
}

void StageControl::bind(const std::vector<double>& masses) {
  n_ = static_cast<Index>(masses.size());
  heaviest_ = static_cast<std::size_t>(std::max_element(masses.begin(), masses.end()) - masses.begin());
  mass2_.clear();
  for (const double m : masses) mass2_.push_back(m / masses[heaviest_] * (m / masses[heaviest_]));
  stride_ = static_cast<std::size_t>((3 * n_ + 7) / 8 * 8);
  rows_.assign(6 * stride_, 0);
  sums_.assign(stride_, 0);
  largest_.assign(stride_, 0);
}

StageControl::Lengths StageControl::lengths(const double* rates, double h, double at_hand) {
  const Lengths first = by_timescale(rates, h);
  const double second = by_last_coefficient(rates, h), most = farther * second;
  const double least = first.next >= at_hand && first.made >= kept * h ? 0 : second;
  return {std::clamp(first.made, least, most), std::clamp(first.next, least, most)};
}

StageControl::Lengths StageControl::by_timescale(const double* rates, double h) {
  gravity_gauss_kernels().derivatives(3 * n_, rates, weights_.data(), mirrored_, rows_.data(),
                                      static_cast<std::ptrdiff_t>(stride_));
  const double middle = timescale(0), end = timescale(3);
  // What the timescale has lost since the middle of the step, it may lose again.
  const double trend = middle > 0 && std::isfinite(middle) ? std::clamp(end / middle, 0.3, 1.0) : 1;
  return {eta_ * h * std::min(middle, end), eta_ * h * end * trend};
}

/// The shortest one of all bodies, in steps; infinity where no rate changes.
double StageControl::timescale(std::size_t row) const {
  const auto n = static_cast<std::size_t>(n_);
  const auto square = [&](std::size_t derivative, std::size_t i) {
    const double* const p = rows_.data() + (row + derivative) * stride_ + i;
    return p[0] * p[0] + p[n] * p[n] + p[2 * n] * p[2 * n];
  };
  double most = 0, pulled = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double a2 = square(0, i);
    most = std::max(most, a2);
    if (i != heaviest_) pulled = std::max(pulled, a2 * mass2_[i]);
  }
  double fastest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    // Where forces cancel to rounding, the timescale would be that of rounding errors.
    const double a2 = std::max({square(0, i), 1e-22 * most, i == heaviest_ ? pulled : 0.0});
    if (a2 > 0) fastest = std::max(fastest, (square(1, i) + std::sqrt(square(2, i) * a2)) / (a2 + a2));
  }
  return fastest > 0 ? 1 / std::sqrt(fastest) : std::numeric_limits<double>::infinity();
}

double StageControl::by_last_coefficient(const double* rates, double h) {
  collocation_kernels().coefficient(3 * n_, rates, last_.data(), sums_.data(), largest_.data());
  const auto n = static_cast<std::size_t>(n_);
  const auto square = [&](const AlignedVector<double>& of, std::size_t i) {
    return of[i] * of[i] + of[n + i] * of[n + i] + of[2 * n + i] * of[2 * n + i];
  };
  double pulled = 0, worst = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (i != heaviest_) pulled = std::max(pulled, square(largest_, i) * mass2_[i]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double size2 = i == heaviest_ ? std::max(square(largest_, i), pulled) : square(largest_, i);
    const double last2 = square(sums_, i);
    if (last2 > worst * size2) worst = last2 / size2;
  }
  return h * near_root(std::clamp(target_ / std::sqrt(worst), 1e-300, 1e300), degree_);
}

}  // namespace noether
