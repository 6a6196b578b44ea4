/// Direct gravity: pair interactions per second (n^2 counting) by size, threads and SIMD level, the largest error of a
/// force on a uniform sphere against 113 bits, and a leapfrog step of six bodies.
///
/// Protocol: one warm-up, then medians of 7 repeats of about 0.2 s each (of the largest size 20 s) in wall time, sizes
/// and numbers of threads in turn; a step is the median of 50 slices of 20 000 steps in processor time.

#include "bench/planets.hpp"

#include <utility>

using namespace noether;

namespace {

/// A uniform sphere of radius 1 and mass 1.
ParticleSystem<double> sphere(Index n) {
  ParticleSystem<double> s;
  std::uint64_t state = 1;
  const auto random = [&] {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(static_cast<std::int64_t>(state)) / 9223372036854775808.0;
  };
  while (s.size() < n) {
    const Vec3<double> x(random(), random(), random());
    if (norm2(x) <= 1) s.add("", 1.0 / static_cast<double>(n), x, Vec3<double>::Zero());
  }
  return s;
}

double interactions_per_s(const ParticleSystem<double>& s, VectorColumn<double>& a) {
  const double pairs = static_cast<double>(s.size()) * static_cast<double>(s.size());
  const int calls = static_cast<int>(std::max(1.0, 1.5e8 / pairs));
  const double seconds = bench::seconds_of([&] {
    for (int k = 0; k < calls; ++k) {
      ForceSink<double> sink(a, s, {});
      Gravity{}.add_to(sink, s);
    }
  });
  return calls * pairs / seconds;
}

/// Largest error of a force, relative to the sum over j of |f_ij|, over every 64th particle.
double force_error(const ParticleSystem<double>& s) {
  VectorColumn<double> a(s.size());
  ForceSink<double> sink(a, s, {});
  Gravity{}.add_to(sink, s);
  double worst = 0;
  for (Index i = 0; i < s.size(); i += 64) {
    Vec3<Quad> exact = Vec3<Quad>::Zero();
    Quad absolute(0);
    const Vec3<double> at = s.positions()[i];
    for (Index j = 0; j < s.size(); ++j) {
      if (j == i) continue;
      const Vec3<double> from = s.positions()[j];
      const Vec3<Quad> d = from.cast<Quad>() - at.cast<Quad>();
      const Quad r2 = norm2(d), pull = Quad(s.masses()[j]) / r2;
      exact += pull / sqrt(r2) * d;
      absolute += pull;
    }
    const Vec3<double> mine = std::as_const(a)[i];
    const Vec3<Quad> error = mine.cast<Quad>() - exact;
    worst = std::max(worst, static_cast<double>(sqrt(norm2(error)) / absolute));
  }
  return worst;
}

/// Rates of all sizes, by one thread and by all, in turn: what disturbs the machine disturbs them alike.
void measure_sizes(const bench::Rows& rows, const std::vector<Index>& sizes, int threads) {
  constexpr int repeats = 7;
  const auto rate = [](const ParticleSystem<double>& s, int by) {
    set_thread_count(by);
    VectorColumn<double> a(s.size());
    return interactions_per_s(s, a);
  };
  std::vector<ParticleSystem<double>> spheres;
  for (const Index n : sizes) spheres.push_back(sphere(n));
  std::vector<std::vector<double>> alone(sizes.size()), together(sizes.size()), speedup(sizes.size());
  for (int repeat = 0; repeat <= repeats; ++repeat) {
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      const double one = rate(spheres[k], 1), all = threads > 1 ? rate(spheres[k], threads) : one;
      if (repeat == 0) continue;  // warm-up
      alone[k].push_back(one);
      together[k].push_back(all);
      speedup[k].push_back(all / one);
    }
  }
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    set_thread_count(1);
    rows.add("sphere", "interactions_per_s", bench::Measured(alone[k]), "1/s", sizes[k]);
    if (threads == 1) continue;
    set_thread_count(threads);
    rows.add("sphere", "interactions_per_s", bench::Measured(together[k]), "1/s", sizes[k]);
    rows.add("sphere", "speedup", bench::Measured(speedup[k]), "1", sizes[k]);
  }
  set_thread_count(1);
}

void measure_leapfrog(const bench::Rows& rows) {
  Simulation<double> run = bench::leapfrog6();
  std::vector<double> times;
  for (int slice = 0; slice <= 50; ++slice) {
    const double time = bench::step_ns(run, 20'000);
    if (slice > 0) times.push_back(time);
  }
  rows.add("leapfrog6", "step_ns", bench::Measured(times), "ns", 6);
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("gravity_direct", count, arguments);
  const int threads = thread_count();
  const SimdLevel highest = simd_level();
  for (const SimdLevel level : {SimdLevel::base, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!has_simd_level(level)) continue;
    set_simd_level(level);
    // Lower levels are measured at one size: the largest takes them minutes.
    const std::vector<Index> sizes =
        level == highest ? std::vector<Index>{2048, 16384, 131072} : std::vector<Index>{16384};
    measure_sizes(rows, sizes, threads);
    rows.add("sphere", "force_error_max", bench::Measured({force_error(sphere(16384))}), "1", 16384);
  }
  set_thread_count(1);
  measure_leapfrog(rows);
}
