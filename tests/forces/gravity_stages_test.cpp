/// Gravity at eight stages at once: against the plain pair loop, at every SIMD level, with and without optimization.

#include "forces/gravity.hpp"
#include "forces/gravity_stages_simd.hpp"
#include "numbers/pack.hpp"
#include "numbers/simd.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/planets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace noether::base_at_O0 {
extern const AttractInStages attract_in_stages;
}
#if NOETHER_SIMD_LEVELS
namespace noether::avx2_at_O0 {
extern const AttractInStages attract_in_stages;
}
namespace noether::avx512_at_O0 {
extern const AttractInStages attract_in_stages;
}
#endif

namespace noether {
namespace {

constexpr std::size_t stages = Pack::lanes;

/// n bodies at eight stages, every third one a tracer, two of the tracers in one place.
struct StageSample {
  explicit StageSample(std::size_t n) : x(n * stages), y(n * stages), z(n * stages), m(n * stages) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < stages; ++k) {
        const double at = static_cast<double>(i == 5 ? 2 : i), t = 0.1 * static_cast<double>(k);
        x[i * stages + k] = std::cos(2.4 * at + t) * (1 + at);
        y[i * stages + k] = std::sin(2.4 * at + t) * (1 + at);
        z[i * stages + k] = 0.1 * std::cos(5 * at - t);
        m[i * stages + k] = i % 3 == 2 ? 0.0 : 1.0 / static_cast<double>(i + 1);
      }
    }
  }
  AlignedVector<double> x, y, z, m;

  std::size_t bodies() const { return m.size() / stages; }

  /// All accelerations, x before y before z.
  AlignedVector<double> attracted(AttractInStages kernel, double softening2) const {
    AlignedVector<double> a(3 * x.size(), 0.0);
    attract(kernel, softening2, a, true);
    return a;
  }
  /// The same, where accelerations hold anything.
  AlignedVector<double> attracted_anew(AttractInStages kernel, double softening2) const {
    AlignedVector<double> a(3 * x.size(), std::numeric_limits<double>::quiet_NaN());
    attract(kernel, softening2, a, false);
    return a;
  }
  void attract(AttractInStages kernel, double softening2, AlignedVector<double>& a, bool has_sums) const {
    kernel({x.data(), y.data(), z.data(), m.data(), a.data(), a.data() + x.size(), a.data() + 2 * x.size(),
            static_cast<std::ptrdiff_t>(bodies()), has_sums},
           1, softening2);
  }
  /// The same bodies, the first as heavy as this.
  StageSample with_first(double mass) const {
    StageSample other = *this;
    std::fill_n(other.m.begin(), stages, mass);
    return other;
  }
  /// Stage k as particles of their own.
  ParticleSystem<double> particles(std::size_t k) const {
    ParticleSystem<double> s;
    for (std::size_t i = 0; i < bodies(); ++i) {
      s.add("", m[i * stages], {x[i * stages + k], y[i * stages + k], z[i * stages + k]}, {0, 0, 0});
    }
    return s;
  }
};

struct StageLevel {
  SimdLevel level;
  AttractInStages optimized, at_O0;
};

std::vector<StageLevel> stage_levels() {
  std::vector<StageLevel> all{{SimdLevel::base, base::attract_in_stages, base_at_O0::attract_in_stages}};
#if NOETHER_SIMD_LEVELS
  if (has_simd_level(SimdLevel::avx2)) {
    all.push_back({SimdLevel::avx2, avx2::attract_in_stages, avx2_at_O0::attract_in_stages});
  }
  if (has_simd_level(SimdLevel::avx512)) {
    all.push_back({SimdLevel::avx512, avx512::attract_in_stages, avx512_at_O0::attract_in_stages});
  }
#endif
  return all;
}

}  // namespace

TEST_CASE("eight stages in lanes feel what each feels alone, tracers in one place too", "[lanes]") {
  for (const std::size_t n : {1U, 2U, 3U, 6U, 9U, 17U}) {
    const StageSample sample(n);
    for (const double softening : {0.0, 0.3}) {
      for (const StageLevel& level : stage_levels()) {
        const auto a = sample.attracted(level.optimized, softening * softening);
        CHECK(a == sample.attracted(level.at_O0, softening * softening));
        for (std::size_t k = 0; k < stages; ++k) {
          const ParticleSystem<Quad> alone = sample.particles(k).as<Quad>();
          VectorColumn<Quad> exact(alone.size());
          ForceSink<Quad> sink(exact, alone, {});
          Gravity{.G = 1, .softening = softening}.add_to(sink, alone);
          for (std::size_t i = 0; i < n; ++i) {
            CAPTURE(n, softening, static_cast<int>(level.level), k, i);
            const Vec3<Quad> e = exact[static_cast<Index>(i)];
            const double scale = std::sqrt(static_cast<double>(norm2(e)));
            for (std::size_t c = 0; c < 3; ++c) {
              const double got = a[c * n * stages + i * stages + k];
              CHECK(std::abs(got - static_cast<double>(e[static_cast<Index>(c)])) <= 1e-14 * scale);
            }
          }
        }
      }
    }
  }
}

TEST_CASE("a body on an axis of symmetry feels nothing off it, to the last bit", "[lanes]") {
  // Pairs on either side of the z axis, and a body on it, heavy or a tracer, before them or after them.
  for (const bool before : {false, true}) {
    for (const double mass : {0.0, 0.7}) {
      StageSample sample(7);
      const std::size_t own = before ? 0 : 6, first = before ? 1 : 0;
      for (std::size_t k = 0; k < stages; ++k) {
        sample.x[own * stages + k] = sample.y[own * stages + k] = 0;
        sample.m[own * stages + k] = mass;
        for (std::size_t i = first; i < first + 6; i += 2) {
          const std::size_t one = i * stages + k, other = one + stages;
          sample.x[other] = -sample.x[one];
          sample.y[other] = -sample.y[one];
          sample.z[other] = sample.z[one];
          sample.m[one] = sample.m[other] = 0.3 + 0.1 * static_cast<double>(i);
        }
      }
      for (const StageLevel& level : stage_levels()) {
        const auto a = sample.attracted(level.optimized, 0);
        for (std::size_t k = 0; k < stages; ++k) {
          CAPTURE(before, mass, static_cast<int>(level.level), k);
          CHECK(a[own * stages + k] == 0);
          CHECK(a[(7 + own) * stages + k] == 0);
          CHECK(a[(14 + own) * stages + k] != 0);
        }
      }
    }
  }
}

TEST_CASE("pulls are the same whether they are added or written, whoever comes first", "[lanes]") {
  for (const std::size_t n : {1U, 2U, 3U, 6U, 9U}) {
    for (const StageSample& sample : {StageSample(n), StageSample(n).with_first(0)}) {
      for (const StageLevel& level : stage_levels()) {
        CAPTURE(n, static_cast<int>(level.level));
        CHECK(sample.attracted_anew(level.optimized, 0.09) == sample.attracted(level.optimized, 0.09));
        CHECK(sample.attracted_anew(level.at_O0, 0.09) == sample.attracted(level.at_O0, 0.09));
      }
    }
  }
}

TEST_CASE("the cube of a reciprocal distance is rounded once", "[lanes]") {
  for (const StageLevel& level : stage_levels()) {
    double worst = 0;
    for (std::size_t sample = 0; sample < 4000; ++sample) {
      StageSample pair(2);
      for (std::size_t k = 0; k < stages; ++k) {
        pair.x[k] = pair.y[k] = pair.z[k] = pair.y[stages + k] = pair.z[stages + k] = 0;
        const double spread = static_cast<double>((stages * sample + k) * 524287 % 50331653);
        pair.x[stages + k] = std::ldexp(0x1p24 + spread, -24);  // 1 to 4, of 26 bits: squares are exact
        pair.m[stages + k] = 1;
      }
      const auto a = pair.attracted(level.optimized, 0);
      for (std::size_t k = 0; k < stages; ++k) {
        const double x = pair.x[stages + k];
        const Quad exact = Quad(1) / (Quad(x) * Quad(x));
        worst = std::max(worst, std::abs(static_cast<double>((Quad(a[k]) - exact) / exact)));
      }
    }
    CAPTURE(static_cast<int>(level.level), worst * 0x1p53);
    // The cube, times x, each rounded by half an ulp at most; without fused operations root, product and quotient.
    CHECK(worst < (level.level == SimdLevel::base ? 4 : 2.01) * 0x1p-53);
  }
}

TEST_CASE("a force over Pack gives each lane the bits of that lane alone", "[lanes]") {
  const StageSample sample(7);
  ParticleSystem<Pack> packs = sample.particles(0).as<Pack>();
  for (Index i = 0; i < packs.size(); ++i) {
    const std::size_t at = static_cast<std::size_t>(i) * stages;
    packs.positions().set(i, {Pack::load(&sample.x[at]), Pack::load(&sample.y[at]), Pack::load(&sample.z[at])});
  }
  const auto force = [](auto& out, const auto& s) {
    using Real = std::decay_t<decltype(s.masses()[0])>;
    using std::sqrt, std::exp, std::sin;
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> x = s.positions()[i];
      const Real r2 = norm2(x);
      out.acceleration(i, Vec3<Real>(-x / (r2 * sqrt(r2)) + exp(-r2) * sin(x[0]) * x));
    }
  };
  VectorColumn<Pack> a(packs.size());
  ForceSink<Pack> sink(a, packs, {});
  force(sink, packs);
  for (std::size_t k = 0; k < stages; ++k) {
    const ParticleSystem<double> alone = sample.particles(k);
    VectorColumn<double> b(alone.size());
    ForceSink<double> one(b, alone, {});
    force(one, alone);
    for (Index i = 0; i < alone.size(); ++i) {
      for (int c = 0; c < 3; ++c) CHECK(a.component(c)[i].lane[k] == b.component(c)[i]);
    }
  }
}

}  // namespace noether
