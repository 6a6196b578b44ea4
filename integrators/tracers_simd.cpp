#include "integrators/tracers_simd.hpp"

#include "integrators/kepler_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

NOETHER_EIGHT_INLINE Eights all_lanes(const double* v) { return {Eight(v[0]), Eight(v[1]), Eight(v[2])}; }

/// Notes the pairs that are near, one by one; `x` relative to the star.
[[gnu::noinline, gnu::cold]] void note_near(const TracerTask& task, const PathLetter& kick, const ArcRow& row,
                                            const Eights& x, std::ptrdiff_t first) {
  alignas(64) double own[3][8];
  store_eights(x, own);
  const double* planet = task.numbers + kick.numbers;
  for (std::ptrdiff_t j = 0; j < task.planets; ++j, planet += 3) {
    const double planet2 = (planet[0] * planet[0] + planet[1] * planet[1]) + planet[2] * planet[2];
    for (int k = 0; k < 8; ++k) {
      const double d[3] = {planet[0] - own[0][k], planet[1] - own[1][k], planet[2] - own[2][k]};
      const double r2 = (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2];
      const double own2 = (own[0][k] * own[0][k] + own[1][k] * own[1][k]) + own[2][k] * own[2][k];
      if (row.moves[k] == 0 || !(r2 < task.near[j] * own2)) continue;
      task.note(task.watch, first + k, j, r2, own2 < planet2 ? own2 : planet2, kick.time);
    }
  }
}

/// Accelerations by the planets of tracers at x relative to the star, and by its general relativity.
NOETHER_EIGHT_INLINE Eights pulls(const TracerTask& task, const PathLetter& kick, const ArcRow& row, const Eights& x,
                                  const Eight& r2_of_star, std::ptrdiff_t first) {
  const double* planet = task.numbers + kick.numbers;
  Eights sum{0.0, 0.0, 0.0};
  Eight least = 0.0;
  for (std::ptrdiff_t j = 0; j < task.planets; ++j, planet += 3) {
    const Eights d = all_lanes(planet) - x;
    const Eight r2 = dot(d, d);
    sum = sum + (Eight(task.attraction[j]) / (r2 * square_root(r2))) * d;
    least = smaller(least, r2 - Eight(task.near[j]) * r2_of_star);
  }
  if (__builtin_expect(kick.noting && exceeding(Eight(0.0), least) != 0, 0)) note_near(task, kick, row, x, first);
  if (task.relativity != 0) sum = sum - (Eight(task.relativity) / (r2_of_star * r2_of_star)) * x;
  return sum;
}

/// Jacobi coordinates: accelerations relative to the center that the arcs go round, and what they have done already.
template <bool compensated>
NOETHER_EIGHT_INLINE void kick_jacobi(const TracerTask& task, const PathLetter& kick, ArcRow& row, int level,
                                      std::ptrdiff_t first) {
  const double* const of_level = task.numbers + kick.numbers + 3 * task.planets + 6 * level;
  const Eights x = load_eights(row.x);
  const Eights from_star = level == 0 ? x : x + all_lanes(of_level);
  const Eight r2 = dot(from_star, from_star);
  Eights a = pulls(task, kick, row, from_star, r2, first) - all_lanes(of_level + 3);
  if (level > 0) {  // else the arc has it all
    const Eight inverse = load_eight(row.r_inverse);
    const Eight arc = load_eight(row.mu) * (inverse * (inverse * inverse));
    a = a + (arc * x - (Eight(task.star) / (r2 * square_root(r2))) * from_star);
  }
  store_eights(add_change<compensated>(load_eights(row.v), (Eight(kick.h) * load_eight(row.moves)) * a, row.v_low),
               row.v);
}

/// Democratic coordinates: half a jump, the kick, half a jump.
template <bool compensated>
NOETHER_EIGHT_INLINE void kick_democratic(const TracerTask& task, const PathLetter& kick, ArcRow& row,
                                          std::ptrdiff_t first) {
  const double* const jumps = task.numbers + kick.numbers + 3 * task.planets;
  const Eight moves = load_eight(row.moves);
  const Eights from_star = load_eights(row.x) + moves * all_lanes(jumps);
  const Eights a = pulls(task, kick, row, from_star, dot(from_star, from_star), first);
  store_eights(add_change<compensated>(load_eights(row.v), (Eight(kick.h) * moves) * a, row.v_low), row.v);
  const Eights x = add_change<compensated>(load_eights(row.x), moves * all_lanes(jumps + 3), row.x_low);
  store_eights(x, row.x);
  const Eight before = load_eight(row.r), inverse = set_distance(x, row);
  if (kick.predicted) store_eight((before * load_eight(row.s)) * inverse, row.s);
}

template <bool compensated>
TracerReport follow_all(const TracerTask& task, ArcRow* rows, const int* levels, std::ptrdiff_t count,
                        std::ptrdiff_t first) {
  TracerReport report;
  for (std::ptrdiff_t n = 0; n < task.count; ++n) {
    const PathLetter& letter = task.letters[n];
    if (letter.letter == 'A') {
      const ArcTask arc{.h = letter.h, .predicted = letter.predicted, .predict = letter.predict};
      for (std::ptrdiff_t k = 0; k < count; ++k) {
        report.arcs.failed = -1;
        advance_arcs<compensated>({arc, task.exact, first + 8 * k}, rows[k], report.arcs);
        if (report.arcs.failed >= 0 && report.lost_at < 0) report.lost_at = n, report.lost = report.arcs.failed;
      }
    } else if (task.jacobi) {
      for (std::ptrdiff_t k = 0; k < count; ++k)
        kick_jacobi<compensated>(task, letter, rows[k], levels[k], first + 8 * k);
    } else {
      for (std::ptrdiff_t k = 0; k < count; ++k) kick_democratic<compensated>(task, letter, rows[k], first + 8 * k);
    }
  }
  return report;
}

TracerReport follow(const TracerTask& task, ArcRow* rows, const int* levels, std::ptrdiff_t count,
                    std::ptrdiff_t first) {
  return task.compensated ? follow_all<true>(task, rows, levels, count, first)
                          : follow_all<false>(task, rows, levels, count, first);
}

void prepare(ArcRow* rows, std::ptrdiff_t count) {
  for (std::ptrdiff_t k = 0; k < count; ++k) set_distance(load_eights(rows[k].x), rows[k]);
}

}  // namespace

extern const TracerKernels tracer_kernels;
const TracerKernels tracer_kernels{prepare, follow};

}  // namespace noether::NOETHER_SIMD_LEVEL
