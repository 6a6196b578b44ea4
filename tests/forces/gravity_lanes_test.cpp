/// Direct gravity in lanes, at every SIMD level that this processor has: against 113 bits, with and without energy,
/// with and without optimization.

#include "forces/gravity.hpp"
#include "forces/gravity_simd.hpp"
#include "numbers/simd.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/settings.hpp"

#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

namespace noether::base_at_O0 {
extern const GravityKernels gravity_kernels;
}
#if NOETHER_SIMD_LEVELS
namespace noether::avx2_at_O0 {
extern const GravityKernels gravity_kernels;
}
namespace noether::avx512_at_O0 {
extern const GravityKernels gravity_kernels;
}
#endif

namespace noether {
namespace {

struct Level {
  SimdLevel level;
  int lanes;  ///< at least; Highway before 1.1 has one at the base level
  const GravityKernels *optimized, *at_O0;
};

/// The levels of this processor.
std::vector<Level> levels() {
  std::vector<Level> all{{SimdLevel::base, 1, &base::gravity_kernels, &base_at_O0::gravity_kernels}};
#if NOETHER_SIMD_LEVELS
  all.push_back({SimdLevel::avx2, 4, &avx2::gravity_kernels, &avx2_at_O0::gravity_kernels});
  all.push_back({SimdLevel::avx512, 8, &avx512::gravity_kernels, &avx512_at_O0::gravity_kernels});
#endif
  std::vector<Level> here;
  for (const Level& level : all) {
    if (has_simd_level(level.level)) here.push_back(level);
  }
  return here;
}

/// Rows and bodies for a kernel: the rows are the first particles, of which every one is a body.
struct LaneSample {
  std::vector<double> x, y, z, m, row;

  void add(double px, double py, double pz, double mass) {
    x.push_back(px), y.push_back(py), z.push_back(pz), m.push_back(mass);
    row.push_back(static_cast<double>(row.size()));
    for (auto* column : {&x, &y, &z, &m, &row}) column->reserve(column->size() + 8);  // kernels load whole registers
  }
  AttractingBodies bodies() const {
    return {x.data(), y.data(), z.data(), m.data(), row.data(), static_cast<Index>(m.size())};
  }
};

struct Result {
  std::vector<double> ax, ay, az, phi;

  bool operator==(const Result& other) const { return bits() == other.bits(); }
  std::vector<std::uint64_t> bits() const {
    std::vector<std::uint64_t> all;
    for (const auto* column : {&ax, &ay, &az, &phi}) {
      for (const double value : *column) {
        all.emplace_back();
        std::memcpy(&all.back(), &value, sizeof value);
      }
    }
    return all;
  }
};

Result attract(AttractRows kernel, const LaneSample& sample, Index rows, double softening2 = 0) {
  const std::vector<double> zeros(static_cast<std::size_t>((rows + 7) / 8 * 8));
  Result r{zeros, zeros, zeros, zeros};
  const AttractedRows attracted{
      sample.x.data(), sample.y.data(), sample.z.data(), r.ax.data(), r.ay.data(), r.az.data(), r.phi.data(), 0, rows};
  kernel(attracted, sample.bodies(), 0, static_cast<Index>(sample.m.size()), softening2);
  for (auto* column : {&r.ax, &r.ay, &r.az, &r.phi}) column->resize(static_cast<std::size_t>(rows));
  return r;
}

/// Numbers in [-1, 1) that every machine makes alike.
struct Random {
  std::uint64_t state = 1;
  double operator()() {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(static_cast<std::int64_t>(state)) / 9223372036854775808.0;
  }
};

LaneSample lane_cloud(int n) {
  LaneSample sample;
  Random random;
  for (int i = 0; i < n; ++i) {
    const double x = random(), y = random(), z = random();
    sample.add(x, y, z, 1.5 + random());
  }
  return sample;
}

}  // namespace

TEST_CASE("every level has the lanes it should have", "[lanes]") {
  for (const Level& level : levels()) {
    CAPTURE(name(level.level));
    if (level.level == SimdLevel::base) {
      CHECK(level.optimized->lanes >= level.lanes);
    } else {
      CHECK(level.optimized->lanes == level.lanes);
    }
    CHECK(level.at_O0->lanes == level.optimized->lanes);
    const test::AtLevel at(level.level);
    CHECK(&gravity_kernels() == level.optimized);
  }
  if (!has_simd_level(SimdLevel::avx512)) WARN("skipped: this processor has no avx512");
}

TEST_CASE("lanes give the same bits with and without energy, and without optimization", "[lanes]") {
  const LaneSample sample = lane_cloud(203);
  for (const Level& level : levels()) {
    for (const Index rows : {1, 7, 8, 61, 64}) {
      CAPTURE(name(level.level), rows);
      const GravityKernels &fast = *level.optimized, &plain = *level.at_O0;
      const Result with_phi = attract(fast.among_with_phi, sample, rows, 1e-4);
      Result without = attract(fast.among, sample, rows, 1e-4);
      CHECK(without.phi == std::vector<double>(static_cast<std::size_t>(rows)));
      CHECK(attract(plain.among_with_phi, sample, rows, 1e-4) == with_phi);
      CHECK(attract(plain.among, sample, rows, 1e-4) == without);
      without.phi = with_phi.phi;
      CHECK(without == with_phi);
      CHECK(attract(plain.others, sample, rows, 1e-4) == attract(fast.others, sample, rows, 1e-4));
      CHECK(attract(plain.others_with_phi, sample, rows, 1e-4) == attract(fast.others_with_phi, sample, rows, 1e-4));
    }
  }
}

TEST_CASE("a pair in lanes is right to 3e-15 for r^2 from 1e-200 to 1e200", "[lanes]") {
  for (const Level& level : levels()) {
    double worst = 0;
    Random random;
    for (int exponent = -1000; exponent <= 1000; ++exponent) {
      const double r = std::pow(10.0, exponent / 10.0) * (1.5 + random() / 2);
      LaneSample sample;
      sample.add(r * random(), r, r * random(), 1);
      sample.add(0, 0, 0, 1.25);
      const Quad x = sample.x[0], y = sample.y[0], z = sample.z[0], r2 = x * x + y * y + z * z;
      const Quad expected = -Quad(1.25) * y / (r2 * sqrt(r2)), potential = Quad(1.25) / sqrt(r2);
      const Result found = attract(level.optimized->among_with_phi, sample, 1);
      worst = std::max({worst, std::abs(static_cast<double>(Quad(found.ay[0]) / expected - Quad(1))),
                        std::abs(static_cast<double>(Quad(found.phi[0]) / potential - Quad(1)))});
    }
    INFO(name(level.level) << ": relative error " << worst);
    CHECK(worst < 3e-15);
    CHECK(worst > 1e-17);
  }
}

TEST_CASE("two bodies in one place are not passed over silently", "[lanes]") {
  LaneSample sample = lane_cloud(20);
  sample.add(sample.x[3], sample.y[3], sample.z[3], 1);
  for (const Level& level : levels()) {
    const Result found = attract(level.optimized->among, sample, 8);
    for (std::size_t i = 0; i < 8; ++i) CHECK(std::isfinite(found.ax[i]) == (i != 3));
    CHECK(std::isfinite(attract(level.optimized->among, sample, 8, 1e-6).ax[3]));
  }
}

namespace {

/// Accelerations, energy and virial in 113 bits, and for every particle the sum of |a_ij|, shape (n).
struct Exact {
  ParticleSystem<Quad> particles;
  VectorColumn<Quad> a;
  std::vector<Quad> absolute;
  Quad energy;
  Mat3<Quad> virial;

  Exact(const ParticleSystem<double>& s, const Gravity& gravity) : particles(s.as<Quad>()), a(s.size()) {
    ForceSink<Quad> sink(a, particles, {.energy = true, .virial = true});
    gravity.add_to(sink, particles);
    energy = sink.potential();
    virial = sink.virial();
    const auto& x = std::as_const(particles).positions();
    for (Index i = 0; i < s.size(); ++i) {
      absolute.emplace_back(0);
      for (Index j = 0; j < s.size(); ++j) {
        if (j == i) continue;
        const Quad r2 = norm2(Vec3<Quad>(x[i] - x[j])) + Quad(gravity.softening) * Quad(gravity.softening);
        absolute.back() += gravity.constant(particles) * std::as_const(particles).masses()[j] / r2;
      }
    }
  }

  /// Largest error of an acceleration, relative to the sum over j of |a_ij|.
  double worst(const VectorColumn<double>& found) const {
    double largest = 0;
    for (Index i = 0; i < found.size(); ++i) {
      const Vec3<double> mine = found[i];
      const Vec3<Quad> error = Vec3<Quad>(Quad(mine[0]), Quad(mine[1]), Quad(mine[2])) - a[i];
      largest = std::max(largest, static_cast<double>(sqrt(norm2(error)) / absolute[static_cast<std::size_t>(i)]));
    }
    return largest;
  }
};

}  // namespace

TEST_CASE("forces on many particles agree with 113 bits, tracers among them, for any number", "[lanes][gravity]") {
  for (const int n : {16, 17, 63, 64, 65, 130, 513}) {
    auto s = test::cloud(n);
    for (Index i = 0; i < n; i += 3) s.masses()[i] = 0;
    const Gravity gravity{.G = 1.5, .softening = n % 2 == 0 ? 0.0 : 0.05};
    const Exact exact(s, gravity);
    for (const Level& level : levels()) {
      const test::AtLevel at(level.level);
      CAPTURE(name(level.level), n);
      VectorColumn<double> a(n), silent(n);
      ForceSink<double> sink(a, s, {.energy = true, .virial = true}), quiet(silent, s, {});
      gravity.add_to(sink, s);
      gravity.add_to(quiet, s);
      const auto bytes = sizeof(double) * static_cast<std::size_t>(3 * a.stride());
      CHECK(std::memcmp(a.component(0), silent.component(0), bytes) == 0);
      CHECK(exact.worst(a) < 1e-15);
      CHECK(std::abs(static_cast<double>(Quad(sink.potential()) / exact.energy - Quad(1))) < 2e-15);
      for (int k = 0; k < 9; ++k) {
        CHECK(std::abs(sink.virial()(k) - static_cast<double>(exact.virial(k))) < 2e-15 * std::abs(sink.potential()));
      }
    }
  }
}

}  // namespace noether
