#include "integrators/planet_path.hpp"

#include <cmath>

namespace noether {

namespace {

constexpr std::size_t in_row = 8;

PlanetPath::Vector of(const double (&from)[3][in_row], std::size_t lane) {
  return {from[0][lane], from[1][lane], from[2][lane]};
}
void add_product(PlanetPath::Vector& sum, double a, const PlanetPath::Vector& b) {
  for (std::size_t c = 0; c < 3; ++c) sum[c] += a * b[c];
}

/// What moves all heliocentric positions in a jump over h.
PlanetPath::Vector jump_of(const PlanetRows& rows, std::size_t planets, double h) {
  PlanetPath::Vector sum{};
  for (std::size_t k = 0; k < planets; ++k) {
    const PlanetRow& row = rows.row[k / in_row];
    add_product(sum, row.share[k % in_row], of(row.v, k % in_row));
  }
  return {h * sum[0], h * sum[1], h * sum[2]};
}

}  // namespace

void PlanetPath::add_arc(const ArcTask& task) {
  letters_.push_back({.letter = 'A',
                      .predicted = task.predicted,
                      .predict = task.predict,
                      .noting = false,
                      .h = task.h,
                      .time = 0,
                      .step = step_,
                      .numbers = 0});
}

void PlanetPath::begin_kick(const PlanetRows& rows, std::size_t planets, double h, double time, bool predicted,
                            bool noting) {
  letters_.push_back({.letter = 'B',
                      .predicted = predicted,
                      .predict = false,
                      .noting = noting,
                      .h = h,
                      .time = time,
                      .step = step_,
                      .numbers = static_cast<std::ptrdiff_t>(numbers_.size())});
  if (!rows.jacobi) jump_ = jump_of(rows, planets, 0.5 * h);
}

void PlanetPath::end_kick(const PlanetRows& rows, std::size_t planets, double star_mu) {
  for (std::size_t k = 0; k < planets; ++k) add(of(rows.row[k / in_row].y, k % in_row));
  if (rows.jacobi) {
    add_levels(rows, planets, star_mu);
    return;
  }
  Vector both = jump_;
  add_product(both, 1, rows.relativity ? jump_of(rows, planets, 0.5 * letters_.back().h) : jump_);
  add(jump_);
  add(both);
}

/// Forces inside a level cancel, so that it is moved by minus what the planets outside feel.
void PlanetPath::add_levels(const PlanetRows& rows, std::size_t planets, double star_mu) {
  levels_.assign(planets + 1, Vector{});
  Vector outer{};
  for (std::size_t k = planets; k-- > 0;) {
    const PlanetRow& row = rows.row[k / in_row];
    add_product(outer, 1, of(row.force, k % in_row));
    add_product(levels_[k], -row.one_over_M[k % in_row], outer);
  }
  // The star's part of the innermost arc, which moves no center but that of level 0.
  const PlanetRow& inner = rows.row[0];
  const Vector y = of(inner.y, 0);
  const double r2 = (y[0] * y[0] + y[1] * y[1]) + y[2] * y[2];
  add_product(levels_[0], star_mu / (inner.one_over_m[0] * (r2 * std::sqrt(r2))), y);
  Vector center{};
  for (std::size_t w = 0; w <= planets; ++w) {
    if (w > 0) {
      const PlanetRow& row = rows.row[(w - 1) / in_row];
      add_product(center, row.share[(w - 1) % in_row], of(row.x, (w - 1) % in_row));
    }
    add(center);
    add(levels_[w]);
  }
}

}  // namespace noether
