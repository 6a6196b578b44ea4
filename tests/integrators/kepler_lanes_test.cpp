/// Kepler arcs in lanes against the solver of single arcs, and the drift of energy over many of them.

#include "integrators/kepler.hpp"
#include "integrators/tracers_simd.hpp"
#include "integrators/wisdom_holman_simd.hpp"
#include "numbers/real.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/settings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <utility>
#include <vector>

// The same code with constants of 28 bits.
#define NOETHER_SIMD_LEVEL with_short_constants
#define NOETHER_SERIES_BITS 28
#include "integrators/kepler_simd.hpp"

namespace noether::base_at_O0 {
extern const PlanetKernels planet_kernels;
extern const TracerKernels tracer_kernels;
}  // namespace noether::base_at_O0
#if NOETHER_SIMD_LEVELS
namespace noether::avx2_at_O0 {
extern const PlanetKernels planet_kernels;
extern const TracerKernels tracer_kernels;
}  // namespace noether::avx2_at_O0
namespace noether::avx512_at_O0 {
extern const PlanetKernels planet_kernels;
extern const TracerKernels tracer_kernels;
}  // namespace noether::avx512_at_O0
#endif

namespace noether {
namespace {

bool solved_exactly(const double* x, const double* v, double mu, double h, double* dx, double* dv, double* s) {
  const KeplerArc<double> arc = kepler_arc(Vec3<double>(x[0], x[1], x[2]), Vec3<double>(v[0], v[1], v[2]), mu, h);
  for (int c = 0; c < 3; ++c) dx[c] = arc.dx[c], dv[c] = arc.dv[c];
  *s = arc.s;
  return arc.status == KeplerStatus::converged;
}

double uniform(std::mt19937_64& random) { return std::uniform_real_distribution<double>(0, 1)(random); }

/// A planet of semi-major axis a and eccentricity e, mu = 1, anywhere on its orbit.
void place(ArcRow& row, int lane, double a, double e, std::mt19937_64& random) {
  const double E = 2 * std::numbers::pi * uniform(random), w = 2 * std::numbers::pi * uniform(random),
               tilt = 0.3 * uniform(random);
  const double rate = std::sqrt(1 / (a * a * a)) / (1 - e * std::cos(E)), flat = std::sqrt(1 - e * e);
  const double x = a * (std::cos(E) - e), y = a * flat * std::sin(E), u = -a * rate * std::sin(E),
               v = a * flat * rate * std::cos(E);
  const auto turn = [&](double p, double q, double(*to)[8]) {
    const double up = std::sin(w) * p + std::cos(w) * q;
    to[0][lane] = std::cos(w) * p - std::sin(w) * q;
    to[1][lane] = up * std::cos(tilt);
    to[2][lane] = up * std::sin(tilt);
  };
  turn(x, y, row.x);
  turn(u, v, row.v);
  row.mu[lane] = 1;
  row.moves[lane] = 1;
}

Vec3<double> vector_of(const double (*of)[8], int lane) { return {of[0][lane], of[1][lane], of[2][lane]}; }

Quad energy_of(const PlanetRow& row, int lane) {
  Quad speed2(0), r2(0);
  for (int c = 0; c < 3; ++c) {
    const Quad x = Quad(row.x[c][lane]) + Quad(row.x_low[c][lane]), v = Quad(row.v[c][lane]) + Quad(row.v_low[c][lane]);
    speed2 += v * v;
    r2 += x * x;
  }
  return speed2 / Quad(2) - Quad(1) / sqrt(r2);
}

PlanetRows rows_of(PlanetRow& row, bool compensated) {
  return {.row = &row,
          .rows = 1,
          .pairs = nullptr,
          .jacobi = true,
          .compensated = compensated,
          .relativity = false,
          .exact = solved_exactly};
}

ArcReport drift(const PlanetRows& planets, const ArcTask& task) { return planet_kernels().drift(planets, task); }
ArcReport drift_with_short_constants(const PlanetRows& planets, const ArcTask& task) {
  ArcReport report;
  with_short_constants::advance_arcs<false>({task, planets.exact, 0}, *planets.row, report);
  return report;
}

/// Change of the energy in an arc, relative, of orbits that are only drifted: mean and its standard error [1e-19], and
/// its growth in units of 2^-53 times the square root of the number of arcs.
struct EnergyDrift {
  double mean, error, growth;
};
template <class Drift>
EnergyDrift energy_drift(const Drift& drift, double e, double h, bool compensated, int starts, int arcs) {
  std::mt19937_64 random(11);
  double sum = 0, squares = 0;
  for (int start = 0; start < starts; ++start) {
    const auto row = std::make_unique<PlanetRow>();
    std::array<Quad, 8> before;
    for (int lane = 0; lane < 8; ++lane) {
      place(*row, lane, 1 + 1e-3 * uniform(random), e, random);
      before[static_cast<std::size_t>(lane)] = energy_of(*row, lane);
    }
    const PlanetRows planets = rows_of(*row, compensated);
    planet_kernels().prepare(planets);
    for (int k = 0; k < arcs; ++k) drift(planets, {.h = h, .predicted = k > 1, .predict = k > 0});
    for (int lane = 0; lane < 8; ++lane) {
      const double change =
          static_cast<double>(energy_of(*row, lane) / before[static_cast<std::size_t>(lane)] - Quad(1));
      sum += change;
      squares += change * change;
    }
  }
  const double n = 8.0 * starts, mean = sum / n, variance = (squares / n - mean * mean) / n;
  return {1e19 * mean / arcs, 1e19 * std::sqrt(variance) / arcs, std::sqrt(squares / n / arcs) * 0x1p53};
}

}  // namespace

TEST_CASE("arcs in lanes are those of the solver of single arcs, of any shape and length", "[kepler]") {
  std::mt19937_64 random(7);
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    std::int64_t second = 0, exact = 0;
    double sum = 0;
    int count = 0;
    for (int trial = 0; trial < 1500; ++trial) {
      const auto row = std::make_unique<PlanetRow>();
      for (int lane = 0; lane < 8; ++lane) {
        const double shape = uniform(random), e = shape < 0.3   ? 0.1 * shape
                                                  : shape < 0.6 ? 0.95
                                                                : 0.95 * uniform(random);
        place(*row, lane, std::exp(4 * uniform(random) - 2), e, random);
        if (trial % 50 == 0) row->v[0][lane] += 2;  // many are hyperbolas
      }
      const double h = std::exp(6 * uniform(random) - 5) * (uniform(random) < 0.3 ? -1 : 1);
      const PlanetRow start = *row;
      const PlanetRows planets = rows_of(*row, false);
      planet_kernels().prepare(planets);
      const ArcReport report = drift(planets, {.h = h, .predicted = false, .predict = false});
      CHECK(report.failed == -1);
      second += report.second;
      exact += report.exact;
      for (int lane = 0; lane < 8; ++lane) {
        const Vec3<double> x = vector_of(start.x, lane), v = vector_of(start.v, lane);
        const auto ends_of = [&](double size, double speed) {
          const Vec3<Quad> from = x.cast<Quad>() * Quad(size), velocity = v.cast<Quad>() * Quad(speed);
          const KeplerArc<Quad> arc = kepler_arc<Quad>(from, velocity, Quad(1), Quad(h));
          return std::pair<Vec3<Quad>, Vec3<Quad>>(from + arc.dx, velocity + arc.dv);
        };
        // What a change by one rounding of all of x, or of v, does to the end of the arc.
        const auto truth = ends_of(1, 1), longer = ends_of(1 + 0x1p-52, 1), faster = ends_of(1, 1 + 0x1p-52);
        const auto size = [](const Vec3<Quad>& d) { return std::sqrt(static_cast<double>(norm2(d))); };
        const double unit_x =
            size(longer.first - truth.first) + size(faster.first - truth.first) + 0x1p-53 * size(truth.first);
        const double unit_v =
            size(longer.second - truth.second) + size(faster.second - truth.second) + 0x1p-53 * size(truth.second);
        const double error_x = size(vector_of(row->x, lane).cast<Quad>() - truth.first) / unit_x;
        const double error_v = size(vector_of(row->v, lane).cast<Quad>() - truth.second) / unit_v;
        const double error = std::max(error_x, error_v);
        if (!(error < 300)) {
          CAPTURE(name(level), trial, lane, h, error_x, error_v, report.second, report.exact);
          CHECK(error < 300);
        }
        sum += error;
        ++count;
      }
    }
    CAPTURE(name(level), second, exact, sum / count);
    CHECK(sum / count < 1);
    CHECK(second > 100);
    CHECK(exact > 100);
    CHECK(exact < 1500 * 4);
  }
}

TEST_CASE("planets in lanes have the same bits without optimization", "[kepler]") {
  struct Level {
    SimdLevel level;
    const PlanetKernels& at_O0;
  };
  std::vector<Level> levels{{SimdLevel::base, base_at_O0::planet_kernels}};
#if NOETHER_SIMD_LEVELS
  if (has_simd_level(SimdLevel::avx2)) levels.push_back({SimdLevel::avx2, avx2_at_O0::planet_kernels});
  if (has_simd_level(SimdLevel::avx512)) levels.push_back({SimdLevel::avx512, avx512_at_O0::planet_kernels});
#endif
  const auto numbers_after = [](const PlanetKernels& kernels, bool jacobi, bool compensated) {
    std::mt19937_64 random(29);
    std::vector<PlanetRow> row(2);
    std::vector<PlanetPairs> pairs(3);
    for (int k = 0; k < 16; ++k) {
      PlanetRow& own = row[static_cast<std::size_t>(k / 8)];
      place(own, k % 8, std::exp(0.4 * k), k % 3 == 0 ? 0.5 : 0.1, random);
      for (auto* constant : {own.share, own.star, own.without_arc, own.relativity})
        constant[k % 8] = 1e-4 * uniform(random);
      for (auto* constant : {own.rest, own.one_over_m, own.one_over_M, own.moves}) constant[k % 8] = 1;
    }
    for (PlanetPairs& of : pairs) {
      for (auto& line : of.attraction) {
        for (double& one : line) one = 1e-5 * uniform(random);
      }
      for (int k = 0; k < 4; ++k) of.attraction[4][k + 4] = of.attraction[4][k];  // the same pairs
    }
    const PlanetRows planets{.row = row.data(),
                             .rows = 2,
                             .pairs = pairs.data(),
                             .jacobi = jacobi,
                             .compensated = compensated,
                             .relativity = compensated,
                             .exact = solved_exactly};
    kernels.prepare(planets);
    for (int k = 0; k < 30; ++k) {
      kernels.kick(planets, 0.5, k > 2);
      kernels.drift(planets, {.h = 0.5, .predicted = k > 1, .predict = k > 0});
    }
    std::vector<double> numbers;
    for (const PlanetRow& own : row) {
      for (int c = 0; c < 3; ++c) {
        numbers.insert(numbers.end(), own.x[c], own.x[c] + 8);
        numbers.insert(numbers.end(), own.v[c], own.v[c] + 8);
        numbers.insert(numbers.end(), own.x_low[c], own.x_low[c] + 8);
      }
      numbers.insert(numbers.end(), own.s, own.s + 8);
    }
    return numbers;
  };
  for (const bool jacobi : {false, true}) {
    for (const bool compensated : {false, true}) {
      std::optional<std::vector<double>> first;
      for (const Level& level : levels) {
        const test::AtLevel at(level.level);
        const auto numbers = numbers_after(planet_kernels(), jacobi, compensated);
        if (!first) first = numbers;
        CAPTURE(name(level.level), jacobi, compensated);
        CHECK(std::isfinite(numbers[0]));
        CHECK(numbers == *first);
        CHECK(numbers == numbers_after(level.at_O0, jacobi, compensated));
      }
    }
  }
}

namespace {

/// Letters of 30 steps, and their numbers.
struct RandomPath {
  static constexpr std::ptrdiff_t planets = 3;
  std::vector<PathLetter> letters;
  std::vector<double> numbers;

  explicit RandomPath(std::mt19937_64& random) {
    for (int k = 0; k < 30; ++k) {
      const auto begin = static_cast<std::ptrdiff_t>(numbers.size());
      const PathLetter kick{.letter = 'B',
                            .predicted = k > 2,
                            .predict = false,
                            .noting = true,
                            .h = 0.5,
                            .time = 0,
                            .step = k,
                            .numbers = begin};
      PathLetter arc = kick;
      arc.letter = 'A', arc.predicted = k > 1, arc.predict = k > 0;
      letters.insert(letters.end(), {kick, arc});
      for (int n = 0; n < 3 * planets; ++n) numbers.push_back(5 + uniform(random));
      for (int n = 0; n < 6 * (planets + 1); ++n) numbers.push_back(1e-4 * uniform(random));
    }
  }
};

/// Places of tracers behind such a path.
std::vector<double> numbers_behind(const TracerKernels& kernels, bool jacobi, bool compensated) {
  std::mt19937_64 random(31);
  const RandomPath path(random);
  std::vector<ArcRow> row(2);
  for (int k = 0; k < 16; ++k) {
    ArcRow& own = row[static_cast<std::size_t>(k / 8)];
    place(own, k % 8, std::exp(0.3 * k), k % 3 == 0 ? 0.5 : 0.1, random);
    own.mu[k % 8] = own.moves[k % 8] = 1;
  }
  const double attraction[] = {1e-3, 2e-4, 1e-5}, near[] = {1e-4, 1e-4, 1e-4};
  const int levels[] = {0, 2};
  const TracerTask task{.letters = path.letters.data(),
                        .count = static_cast<std::ptrdiff_t>(path.letters.size()),
                        .numbers = path.numbers.data(),
                        .planets = RandomPath::planets,
                        .attraction = attraction,
                        .near = near,
                        .star = 1,
                        .relativity = compensated ? 1e-6 : 0,
                        .jacobi = jacobi,
                        .compensated = compensated,
                        .exact = solved_exactly,
                        .note = [](void*, std::ptrdiff_t, std::ptrdiff_t, double, double, double) {},
                        .watch = nullptr};
  kernels.prepare(row.data(), 2);
  kernels.follow(task, row.data(), levels, 2, 0);
  std::vector<double> numbers;
  for (const ArcRow& own : row) {
    for (const auto* vectors : {&own.x, &own.v, &own.x_low}) {
      for (const auto& line : *vectors) numbers.insert(numbers.end(), line, line + 8);
    }
    numbers.insert(numbers.end(), own.s, own.s + 8);
  }
  return numbers;
}

}  // namespace

TEST_CASE("tracers in lanes have the same bits without optimization", "[kepler]") {
  struct Level {
    SimdLevel level;
    const TracerKernels& at_O0;
  };
  std::vector<Level> levels{{SimdLevel::base, base_at_O0::tracer_kernels}};
#if NOETHER_SIMD_LEVELS
  if (has_simd_level(SimdLevel::avx2)) levels.push_back({SimdLevel::avx2, avx2_at_O0::tracer_kernels});
  if (has_simd_level(SimdLevel::avx512)) levels.push_back({SimdLevel::avx512, avx512_at_O0::tracer_kernels});
#endif
  for (const bool jacobi : {false, true}) {
    for (const bool compensated : {false, true}) {
      std::optional<std::vector<double>> first;
      for (const Level& level : levels) {
        const test::AtLevel at(level.level);
        const auto numbers = numbers_behind(tracer_kernels(), jacobi, compensated);
        if (!first) first = numbers;
        CAPTURE(name(level.level), jacobi, compensated);
        CHECK(std::isfinite(numbers[0]));
        CHECK(numbers == *first);
        CHECK(numbers == numbers_behind(level.at_O0, jacobi, compensated));
      }
    }
  }
}

TEST_CASE("short arcs need one pass, and predictions from the arc before make longer ones do with one", "[kepler]") {
  std::mt19937_64 random(3);
  PlanetRow row{};
  for (int lane = 0; lane < 8; ++lane) place(row, lane, 1, 0.2, random);
  const PlanetRows planets = rows_of(row, false);
  planet_kernels().prepare(planets);
  std::int64_t without = 0, with = 0;
  for (int k = 0; k < 200; ++k) without += drift(planets, {.h = 0.8, .predicted = false, .predict = false}).second;
  for (int k = 0; k < 200; ++k) {
    with += drift(planets, {.h = 0.6, .predicted = k > 1, .predict = k > 0}).second;
  }
  CHECK(without > 50);
  CHECK(with < 5);
}

TEST_CASE("drifts alone keep the energy without a trend, which constants of 28 bits would give it", "[kepler][slow]") {
  struct Orbit {
    double e, h;
    bool compensated;
  };
  for (const Orbit& orbit : {Orbit{0.2, 0.36, false}, Orbit{0.2, 0.36, true}, Orbit{0.01, 0.14, false},
                             Orbit{0.05, 0.45, false}, Orbit{0.4, 0.45, false}}) {
    const EnergyDrift found = energy_drift(drift, orbit.e, orbit.h, orbit.compensated, 16, 100000);
    CAPTURE(orbit.e, orbit.h, orbit.compensated, found.mean, found.error, found.growth);
    CHECK(std::fabs(found.mean) < 4 * found.error);
    CHECK(found.error < 1.5);
    CHECK(found.growth < (orbit.compensated ? 1.3 : 2.5));
  }
  const EnergyDrift control = energy_drift(drift_with_short_constants, 0.2, 0.36, false, 1, 1000);
  CAPTURE(control.mean, control.error);
  CHECK(std::fabs(control.mean) > 10 * control.error);
}

}  // namespace noether
