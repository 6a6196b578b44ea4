/// What rounding does to Wisdom-Holman in lanes over many steps: 64 starts of the Solar System beside the same map in
/// double-double (tests/data/wisdom_holman). Means must be zero within their errors and spreads grow as those of
/// chance.

#include "engine/orbital_elements.hpp"
#include "engine/simulation.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/wisdom_holman.hpp"
#include "integrators/wisdom_holman_simd.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

// Kernels that are wrong: `with_short_constants` has 28 bits of 1/4! and 1/5!, `without_low_parts` 53 bits of them and
// of 1/3! and no more.
namespace noether::base_with_short_constants {
extern const PlanetKernels planet_kernels;
}
namespace noether::base_without_low_parts {
extern const PlanetKernels planet_kernels;
}
#if NOETHER_SIMD_LEVELS
namespace noether::avx2_with_short_constants {
extern const PlanetKernels planet_kernels;
}
namespace noether::avx512_with_short_constants {
extern const PlanetKernels planet_kernels;
}
namespace noether::avx2_without_low_parts {
extern const PlanetKernels planet_kernels;
}
namespace noether::avx512_without_low_parts {
extern const PlanetKernels planet_kernels;
}
#endif

namespace noether {
namespace {

constexpr int start_count = 64;
constexpr std::size_t planet_count = 8;

/// Mercury about the Sun.
struct MercuryState {
  Vec3<Quad> x, v;
};
/// Where a start is after some steps.
struct KnownEnd {
  double energy = 0;  ///< its relative change
  MercuryState mercury;
};

/// tests/data/wisdom_holman/starts.txt
struct Oracle {
  double step = 0, G = 0;
  double bodies[planet_count + 1][7];
  std::map<std::pair<int, std::int64_t>, KnownEnd> truths;  ///< by start and steps

  Oracle() {
    std::ifstream file(std::string(NOETHER_SOURCE_DIR) + "/tests/data/wisdom_holman/starts.txt");
    std::string text, line;
    while (std::getline(file, line)) {
      if (line[0] != '#') text += line + '\n';
    }
    std::istringstream in(text);
    in >> step >> G;
    for (auto& body : bodies) {
      for (double& one : body) in >> one;
    }
    int start = 0;
    std::int64_t steps = 0;
    REQUIRE(in);
    while (in >> start >> steps) {
      KnownEnd& truth = truths[{start, steps}];
      in >> truth.energy;
      for (Vec3<Quad>* vector : {&truth.mercury.x, &truth.mercury.v}) {
        for (int c = 0; c < 3; ++c) {
          double high = 0, low = 0;
          in >> high >> low;
          (*vector)[c] = Quad(high) + Quad(low);
        }
      }
      REQUIRE(in);
    }
  }
  /// How many starts, from 0 on, are followed as far.
  int count(std::int64_t steps) const {
    int n = 0;
    while (truths.contains({n, steps})) ++n;
    return n;
  }
  /// Start 0 is the system; of the others all coordinates and velocities are multiplied by 1 + 1e-12 u, u from -1 to 1.
  ParticleSystem<double> start(int number) const {
    std::uint64_t state = 88172645463325252ULL + static_cast<std::uint64_t>(number);
    const auto draw = [&] {
      state ^= state << 13;
      state ^= state >> 7;
      state ^= state << 17;
      return static_cast<double>(state >> 11) / 9007199254740992.0 * 2 - 1;
    };
    for (int k = 0; k < 20; ++k) draw();
    ParticleSystem<double> s(unit_system("solar"));
    for (const auto& body : bodies) {
      double moved[6];
      for (int c = 0; c < 6; ++c) moved[c] = body[1 + c] * (number == 0 ? 1 : 1 + 1e-12 * draw());
      s.add("body " + std::to_string(s.size()), body[0], {moved[0], moved[1], moved[2]},
            {moved[3], moved[4], moved[5]});
    }
    return s;
  }
};

MercuryState mercury_of(const ParticleSystem<Quad>& s) {
  return {s.positions()[1] - s.positions()[0], s.velocities()[1] - s.velocities()[0]};
}

/// With what rounding took, where that is kept.
ParticleSystem<Quad> with_low_words(const ParticleSystem<double>& s) {
  auto particles = s.as<Quad>();
  if (const auto* low = s.low_words()) {
    for (Index i = 0; i < s.size(); ++i) {
      particles.positions().add(i, Vec3<double>(low->x[i]).cast<Quad>());
      particles.velocities().add(i, Vec3<double>(low->v[i]).cast<Quad>());
    }
  }
  return particles;
}

/// Energy about the center of mass.
Quad inner_energy(const ParticleSystem<Quad>& s, const Quad& G) {
  Vec3<Quad> momentum = Vec3<Quad>::Zero();
  Quad mass(0), energy(0);
  for (Index i = 0; i < s.size(); ++i) {
    const Quad m = s.masses()[i];
    mass += m;
    momentum += m * s.velocities()[i];
    energy += m * norm2(s.velocities()[i]) / Quad(2);
    for (Index j = 0; j < i; ++j) energy -= G * m * s.masses()[j] / sqrt(norm2(s.positions()[i] - s.positions()[j]));
  }
  return energy - norm2(momentum) / (Quad(2) * mass);
}

/// Mean longitude.
Quad longitude_of(const MercuryState& orbit, const Quad& mu) {
  const OrbitalElements<Quad> o = elements_from_state(orbit.x, orbit.v, mu);
  return o.Omega + o.omega + o.M;
}

struct Statistics {
  double mean = 0, error = 0;  ///< error: the standard one of the mean
  double spread = 0;
  double median = 0;  ///< of sizes

  explicit Statistics(std::vector<double> values) {
    const auto n = static_cast<double>(values.size());
    for (const double one : values) mean += one / n;
    for (const double one : values) spread += (one - mean) * (one - mean) / (n - 1);
    spread = std::sqrt(spread);
    error = spread / std::sqrt(n);
    for (double& one : values) one = std::fabs(one);
    std::sort(values.begin(), values.end());
    median = (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
  }
};

/// What runs have beyond the truth after some steps.
struct RoundOff {
  Statistics energy, longitude;
};

class Stepped {
 public:
  Stepped(const Oracle& oracle, int number, bool compensated)
      : run_(oracle.start(number),
             Composition<AnyHamiltonian<double>>(test::wisdom_holman({.G = oracle.G}), schemes::verlet_aba,
                                                 {.compensated = compensated}),
             oracle.step) {}
  ParticleSystem<double> after(std::int64_t steps) {
    REQUIRE(run_.run(steps - done_).ok());
    done_ = steps;
    return run_.particles();
  }

 private:
  Simulation<double> run_;
  std::int64_t done_ = 0;
};

/// The same map over given kernels, as `PlanetLanes` binds them: the test's own way to kernels that are wrong.
class OverKernels {
 public:
  OverKernels(const Oracle& oracle, int number, const PlanetKernels& kernels)
      : kernels_(kernels), step_(oracle.step), s_(oracle.start(number)), splitting_({.G = oracle.G}) {
    splitting_.bind(s_);
    splitting_.open(s_);
    double star = oracle.bodies[0][0], interior = star;
    const double mu = oracle.G * star;
    for (std::size_t k = 0; k < planet_count; ++k) {
      const double mass = oracle.bodies[k + 1][0], m = mass / star, total = interior + mass;
      row_.mu[k] = oracle.G * total;
      row_.share[k] = mass / total;
      row_.rest[k] = 1 - mass / total;
      row_.one_over_m[k] = 1 / m;
      row_.one_over_M[k] = star / interior;
      row_.star[k] = k > 0 ? mu * m : 0;
      row_.without_arc[k] = k > 0 ? row_.mu[k] : 0;
      row_.moves[k] = 1;
      interior = total;
      for (std::size_t j = 0; j < planet_count; ++j) {
        const std::size_t away = (j + planet_count - k) % planet_count;
        if (j != k && away <= 4)
          pairs_.attraction[away][k] =
              mu * (oracle.bodies[std::min(j, k) + 1][0] / star) * (oracle.bodies[std::max(j, k) + 1][0] / star);
      }
      for (int c = 0; c < 3; ++c) {
        row_.x[c][k] = std::as_const(s_).positions()[static_cast<Index>(k + 1)][c];
        row_.v[c][k] = std::as_const(s_).velocities()[static_cast<Index>(k + 1)][c];
      }
    }
    kernels_.prepare(rows());
    drift(s_, {.h = step_ / 2, .predicted = false, .predict = false});
  }
  ParticleSystem<double> after(std::int64_t steps) {
    for (; done_ < steps; ++done_) {
      if (done_ > 0) drift(s_, {.h = step_, .predicted = done_ > 2, .predict = done_ > 1});
      kernels_.kick(rows(), step_, false);
    }
    const PlanetRow kept = row_;
    auto s = s_;
    drift(s, {.h = step_ / 2, .predicted = false, .predict = false});
    for (std::size_t k = 0; k < planet_count; ++k) {
      const auto vector = [&](const double(&of)[3][8]) { return Vec3<double>(of[0][k], of[1][k], of[2][k]); };
      s.positions().set(static_cast<Index>(k + 1), vector(row_.x));
      s.velocities().set(static_cast<Index>(k + 1), vector(row_.v));
    }
    splitting_.close(s);
    row_ = kept;
    return s;
  }

 private:
  /// Arcs of the planets, and the way of the center of mass.
  void drift(ParticleSystem<double>& s, const ArcTask& task) {
    s.shift(0, task.h * std::as_const(s).velocities()[0], Vec3<double>::Zero());
    kernels_.drift(rows(), task);
  }
  PlanetRows rows() {
    return {.row = &row_,
            .rows = 1,
            .pairs = &pairs_,
            .jacobi = true,
            .compensated = false,
            .relativity = false,
            .exact = exact_arc};
  }

  const PlanetKernels& kernels_;
  double step_;
  ParticleSystem<double> s_;
  WisdomHolman<double> splitting_;
  PlanetRow row_{};
  PlanetPairs pairs_{};
  std::int64_t done_ = 0;
};

/// Wrong kernels at the level in use.
#if NOETHER_SIMD_LEVELS
const PlanetKernels& kernels_with_short_constants() {
  return at_simd_level(base_with_short_constants::planet_kernels, avx2_with_short_constants::planet_kernels,
                       avx512_with_short_constants::planet_kernels);
}
const PlanetKernels& kernels_without_low_parts() {
  return at_simd_level(base_without_low_parts::planet_kernels, avx2_without_low_parts::planet_kernels,
                       avx512_without_low_parts::planet_kernels);
}
#else
const PlanetKernels& kernels_with_short_constants() { return base_with_short_constants::planet_kernels; }
const PlanetKernels& kernels_without_low_parts() { return base_without_low_parts::planet_kernels; }
#endif

/// Errors of runs from all starts whose truth is known, after each of these numbers of steps.
template <class Begin>
std::map<std::int64_t, RoundOff> errors_after(const Oracle& oracle, const std::vector<std::int64_t>& looks,
                                              const Begin& begin) {
  std::map<std::int64_t, std::vector<double>> energies, longitudes;
  const Quad G(oracle.G);
  const Quad mu = G * (Quad(oracle.bodies[0][0]) + Quad(oracle.bodies[1][0]));
  for (int k = 0; k < start_count; ++k) {
    auto run = begin(k);
    const Quad before = inner_energy(oracle.start(k).as<Quad>(), G);
    for (const std::int64_t steps : looks) {
      const auto end = with_low_words(run.after(steps));
      const double change = static_cast<double>(inner_energy(end, G) / before - Quad(1));
      const auto truth = oracle.truths.find({k, steps}), none = oracle.truths.end();
      // Starts are so near each other that what the map does to the energy is that of start 0.
      energies[steps].push_back(change - (truth != none ? truth->second : oracle.truths.at({0, steps})).energy);
      if (truth == none) continue;
      const Quad off = longitude_of(mercury_of(end), mu) - longitude_of(truth->second.mercury, mu);
      longitudes[steps].push_back(std::remainder(static_cast<double>(off), 2 * std::numbers::pi));
    }
  }
  std::map<std::int64_t, RoundOff> all;
  for (const std::int64_t steps : looks) {
    all.emplace(steps, RoundOff{Statistics(energies.at(steps)), Statistics(longitudes.at(steps))});
  }
  return all;
}

bool within_errors(const Statistics& sample) { return std::fabs(sample.mean) < 3 * sample.error; }

/// Exponent of the growth of a spread from one number of steps to another.
double exponent(const Statistics& from, const Statistics& to, double steps_from, double steps_to) {
  return std::log(to.spread / from.spread) / std::log(steps_to / steps_from);
}

/// What REBOUND says of WHFast512 5.1: a median error of the energy of 4e-11 over 80 runs of 1.1e11 steps, growing as
/// the square root of their number.
const double of_whfast512 = 4e-11 / std::sqrt(1.1e11);

std::string told(const RoundOff& errors) {
  const auto sample = [](const Statistics& one) {
    return fmt::format("{:.3e} +- {:.1e}, spread {:.3e}, median {:.3e}", one.mean, one.error, one.spread, one.median);
  };
  return "energy " + sample(errors.energy) + "; longitude " + sample(errors.longitude);
}

}  // namespace

TEST_CASE("the stored ends of the starts are those of 113 bits", "[wisdom_holman]") {
  const Oracle oracle;
  constexpr std::int64_t steps = 100;
  for (const int number : {0, 1, 63}) {
    const auto start = oracle.start(number).as<Quad>();
    Simulation<Quad> run(
        start, Composition<AnyHamiltonian<Quad>>(test::wisdom_holman<Quad>({.G = oracle.G}), schemes::verlet_aba),
        oracle.step);
    REQUIRE(run.run(steps).ok());
    const ParticleSystem<Quad> end = run.particles();
    const KnownEnd& truth = oracle.truths.at({number, steps});
    const MercuryState mercury = mercury_of(end);
    CHECK(std::sqrt(static_cast<double>(norm2(mercury.x - truth.mercury.x))) < 1e-21);
    CHECK(std::sqrt(static_cast<double>(norm2(mercury.v - truth.mercury.v))) < 1e-22);
    const double change =
        static_cast<double>(inner_energy(end, Quad(oracle.G)) / inner_energy(start, Quad(oracle.G)) - Quad(1));
    CHECK(std::fabs(change / truth.energy - 1) < 1e-8);
  }
}

TEST_CASE("rounding of 64 starts of 1e5 steps has no trend in the energy and in Mercury's longitude",
          "[wisdom_holman]") {
  const Oracle oracle;
  REQUIRE(oracle.count(100'000) == start_count);
  const auto found = errors_after(oracle, {10'000, 100'000}, [&](int k) { return Stepped(oracle, k, false); });
  const RoundOff &early = found.at(10'000), &late = found.at(100'000);
  CAPTURE(told(early), told(late));
  for (const RoundOff* errors : {&early, &late}) {
    CHECK(within_errors(errors->energy));
    CHECK(within_errors(errors->longitude));
  }
  CHECK(late.energy.error / 1e5 < 6e-20);
  CHECK(late.energy.median < of_whfast512 * std::sqrt(1e5));
  CHECK(std::fabs(exponent(early.energy, late.energy, 1e4, 1e5) - 0.5) < 0.17);
  CHECK(late.longitude.spread < 2e-9);
  CHECK(std::fabs(exponent(early.longitude, late.longitude, 1e4, 1e5) - 1.5) < 0.25);
}

TEST_CASE("constants of 28 bits in a correction of the arcs give 64 starts a trend within 1e4 steps",
          "[wisdom_holman]") {
  const Oracle oracle;
  // The test's own way to the kernels has the bits of a run, so that what follows is the constants' doing.
  Stepped run(oracle, 7, false);
  OverKernels same(oracle, 7, planet_kernels());
  for (const std::int64_t steps : {1, 2, 3, 300}) {
    const auto a = run.after(steps), b = same.after(steps);
    for (Index i = 0; i < a.size(); ++i) {
      CHECK(a.positions()[i] == b.positions()[i]);
      CHECK(a.velocities()[i] == b.velocities()[i]);
    }
  }
  const auto found =
      errors_after(oracle, {10'000}, [&](int k) { return OverKernels(oracle, k, kernels_with_short_constants()); });
  const RoundOff& errors = found.at(10'000);
  CAPTURE(told(errors));
  CHECK(std::fabs(errors.longitude.mean) > 20 * errors.longitude.error);
  CHECK(std::fabs(errors.energy.mean) > 20 * errors.energy.error);
}

TEST_CASE(
    "constants without what rounding took from them give Mercury's longitude a trend in 1e5 steps, not the energy",
    "[wisdom_holman][slow]") {
  // A trend of 7e-19 a step in Mercury's energy, which is a 520th of the whole.
  const Oracle oracle;
  const auto found =
      errors_after(oracle, {100'000}, [&](int k) { return OverKernels(oracle, k, kernels_without_low_parts()); });
  const RoundOff& errors = found.at(100'000);
  CAPTURE(told(errors));
  CHECK(std::fabs(errors.longitude.mean) > 5 * errors.longitude.error);
  CHECK(within_errors(errors.energy));
}

TEST_CASE("compensated sums leave a hundredth of the energy's rounding and half of the longitude's",
          "[wisdom_holman][slow]") {
  const Oracle oracle;
  const auto found = errors_after(oracle, {100'000}, [&](int k) { return Stepped(oracle, k, true); });
  const RoundOff& late = found.at(100'000);
  CAPTURE(told(late));
  CHECK(within_errors(late.energy));
  CHECK(within_errors(late.longitude));
  CHECK(late.energy.spread < 0.02 * of_whfast512 * std::sqrt(1e5));
  CHECK(late.longitude.spread < 1e-9);
}

TEST_CASE(
    "rounding of 64 starts of 1e7 steps has no trend in the energy, of 8 starts of 1e6 none in Mercury's longitude",
    "[wisdom_holman][nightly]") {
  const Oracle oracle;
  REQUIRE(oracle.count(1'000'000) >= 8);
  const auto found =
      errors_after(oracle, {100'000, 1'000'000, 10'000'000}, [&](int k) { return Stepped(oracle, k, false); });
  const RoundOff &early = found.at(100'000), &middle = found.at(1'000'000), &late = found.at(10'000'000);
  CAPTURE(told(early), told(middle), told(late));
  for (const RoundOff* errors : {&early, &middle, &late}) {
    CHECK(within_errors(errors->energy));
  }
  CHECK(std::fabs(middle.longitude.mean) < 3 * middle.longitude.error);
  CHECK(std::fabs(late.energy.mean) / 1e7 < 5e-20);
  CHECK(late.energy.error / 1e7 < 1e-20);
  CHECK(late.energy.median < of_whfast512 * std::sqrt(1e7));
  CHECK(std::fabs(exponent(early.energy, late.energy, 1e5, 1e7) - 0.5) < 0.12);
  CHECK(middle.longitude.spread < 7e-8);
}

}  // namespace noether
