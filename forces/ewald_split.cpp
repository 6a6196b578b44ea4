#include "forces/ewald_split.hpp"

#include "numbers/simd_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

namespace noether::detail {

namespace {

constexpr std::size_t nodes = 64;

/// Where Chebyshev's polynomial T_64 is 0.
long double node(std::size_t m) {
  return std::cos(std::numbers::pi_v<long double> * (static_cast<long double>(m) + 0.5L) / nodes);
}

/// A polynomial of t from -1 to 1 through values at the nodes of Chebyshev, without the terms that an error leaves out.
/// @return how many terms; 0: more than there is room for
int fit(const std::array<long double, nodes>& values, long double error, double* coefficients) {
  std::array<long double, nodes> chebyshev{};
  for (std::size_t m = 0; m < nodes; ++m) {
    const long double t = node(m);
    long double here = 1, next = t;
    for (long double& one : chebyshev) {
      one += values[m] * here * (2.0L / nodes);
      here = std::exchange(next, 2 * t * next - here);
    }
  }
  chebyshev[0] /= 2;
  std::size_t terms = nodes;  // coefficients fall faster than any power: the first that is left out is the error
  while (terms > 2 && std::abs(chebyshev[terms - 1]) <= error / 2) --terms;
  if (terms > ChargeSeries::most_terms) return 0;
  // By powers of t, whose numbers are those of a sum of exp(-a t) and no larger.
  std::array<long double, nodes + 1> sum{}, before{}, here{};
  before[0] = 1;  // T_0, T_1, ...
  here[1] = 1;
  for (std::size_t j = 0; j < terms; ++j) {
    std::array<long double, nodes + 1> after{};
    for (std::size_t k = 0; k < terms; ++k) {
      sum[k] += chebyshev[j] * before[k];
      after[k + 1] += 2 * here[k];
      after[k] -= before[k];
    }
    before = std::exchange(here, after);
  }
  for (std::size_t k = 0; k < terms; ++k) coefficients[k] = static_cast<double>(sum[k]);
  return static_cast<int>(terms);
}

}  // namespace

const ChargeSeries& screened_series(double alpha, double range, double error) {
  struct Known {
    double alpha = 0, range = 0, error = 0;
    ChargeSeries series;
  };
  thread_local Known known;
  if (known.alpha == alpha && known.range == range && known.error == error) return known.series;
  known = {alpha, range, error, {}};
  ChargeSeries& series = known.series;
  series.range2 = range * range;
  series.scale = 2 / series.range2;
  series.offset = -1;
  std::array<long double, nodes> energies{}, forces{};
  for (std::size_t m = 0; m < nodes; ++m) {
    const PairTerms<long double> smooth = smooth_terms<long double>(alpha, (node(m) + 1) * range * range / 2);
    energies[m] = -smooth.energy;
    forces[m] = -smooth.force;
  }
  const PairTerms<long double> largest = smooth_terms<long double>(alpha, 0.0L);
  constexpr double rounding = 4e-16;
  series.energy_terms = fit(energies, rounding * largest.energy, series.energy);
  series.force_terms = fit(forces, std::max(rounding, error) * largest.force, series.force);
  return series;
}

double SplitErrors::near(double alpha, double cutoff) const {
  return 2 * std::sqrt(a_ / cutoff) * std::exp(-alpha * alpha * cutoff * cutoff);
}

double SplitErrors::waves(double alpha, double k) const {
  return alpha * std::sqrt(8 * a_ / k) * std::exp(-k * k / (4 * alpha * alpha));
}

double SplitErrors::alpha_for(double error, double cutoff) const {
  const double largest = near(0, cutoff);
  return std::sqrt(std::max(1.0, std::log(largest / error))) / cutoff;
}

double SplitErrors::wave_number_for(double error, double alpha) const {
  double below = 0.1 * alpha, above = 100 * alpha;
  while (true) {
    const double middle = below + (above - below) / 2;
    if (!(middle > below && middle < above)) return above;
    (waves(alpha, middle) > error ? below : above) = middle;
  }
}

void check_lattice(bool periodic, bool charges, std::string_view name) {
  if (!periodic) {
    throw Error(
        fmt::format("the force '{}' sums over the images of a periodic box, but this space is open; give a box", name));
  }
  check_charges(charges, name);
}

void check_split(double cutoff, double relative_error, const std::optional<double>& alpha) {
  if (!(cutoff > 0 && cutoff < 1e100))
    refuse_field("cutoff", cutoff, "is not a valid cutoff; a length above 0 is expected");
  if (!(relative_error >= 1e-15 && relative_error <= 0.1))
    refuse_field("relative_error", relative_error, "is not a valid error of forces; 1e-15 to 0.1 is expected");
  if (alpha && !(*alpha > 0 && *alpha < 1e100))
    refuse_field("alpha", *alpha, "is not a valid inverse width; a number above 0 is expected");
}

std::string kicks_of_split(const std::optional<std::string>& wave_kick) { return "B" + wave_kick.value_or(""); }

void check_wave_kick(const std::optional<std::string>& wave_kick) {
  if (!wave_kick || (wave_kick->size() == 1 && wave_kick->front() >= 'C' && wave_kick->front() <= 'Z')) return;
  refuse_field("wave_kick", "\"" + *wave_kick + "\"",
               "is not a letter of slow kicks; one from C to Z is expected, such as \"C\"");
}

namespace {

/// sums[i] = sum_k coefficients[k] t[i]^k.
inline void add_up_series(const double* coefficients, int terms, const double* t, Index count, double* sums) {
  for (Index i = 0; i < count; ++i) sums[i] = coefficients[terms - 1];
  for (int k = terms - 2; k >= 0; --k) {
    const double one = coefficients[k];
#if !defined(__clang__)
#pragma GCC ivdep
#endif
    for (Index i = 0; i < count; ++i) sums[i] = sums[i] * t[i] + one;
  }
}

/// What is to be taken out for a pair, in whole units, and where they are.
struct SmoothPairCounted {
  Index i, j;
  std::array<std::int64_t, 3> force;
  std::int64_t energy;
  std::array<std::int64_t, 9> virial;
};

/// Some of the pairs that the topology excludes or scales, whose terms go in lanes.
class SmoothPairBlock {
 public:
  SmoothPairBlock(const ParticleSystem<double>& s, const ScreenedCharges& near, const ChargeSeries& series)
      : s_(s), near_(near), series_(series) {}

  void add(Index i, Index j, double taken) {
    const auto& q = s_.column<Charge>();
    const Vec3<double> d = s_.box().minimum_image(Vec3<double>(s_.positions()[i] - s_.positions()[j]));
    const auto k = static_cast<std::size_t>(count_++);
    pairs_[k] = {i, j};
    d_[k] = d;
    r2_[k] = norm2(d);
    t_[k] = r2_[k] * series_.scale + series_.offset;
    product_[k] = taken * s_.units().coulomb_constant * q[i] * q[j];
  }
  /// @param energies  whether they and virials are asked for
  void finish(bool energies, double force_unit, double energy_unit, SmoothPairCounted* found) {
    const auto sum = simd_loop<add_up_series>();
    if (series_.force_terms > 0) sum(series_.force, series_.force_terms, t_.data(), count_, force_.data());
    if (energies && series_.energy_terms > 0)
      sum(series_.energy, series_.energy_terms, t_.data(), count_, energy_.data());
    for (std::size_t k = 0; k < static_cast<std::size_t>(count_); ++k, ++found) {
      if (!(r2_[k] < series_.range2 && series_.force_terms > 0 && series_.energy_terms > 0)) {
        const PairTerms<double> terms = smooth_terms(near_.alpha, r2_[k]);
        force_[k] = -terms.force;
        energy_[k] = -terms.energy;
      }
      found->i = pairs_[k].first;
      found->j = pairs_[k].second;
      const Vec3<double> force = (product_[k] * force_[k]) * d_[k];
      for (std::size_t axis = 0; axis < 3; ++axis)
        found->force[axis] = std::llrint(force[static_cast<Index>(axis)] / force_unit);
      if (!energies) continue;
      found->energy = std::llrint(product_[k] * energy_[k] / energy_unit);
      for (std::size_t w = 0; w < 9; ++w) {
        const auto row = static_cast<Index>(w / 3), column = static_cast<Index>(w % 3);
        found->virial[w] = std::llrint(force[row] * d_[k][column] / energy_unit);
      }
    }
  }

 private:
  static constexpr auto size = static_cast<std::size_t>(block_size);
  const ParticleSystem<double>& s_;
  const ScreenedCharges& near_;
  const ChargeSeries& series_;
  Index count_ = 0;
  std::array<Topology::Pair, size> pairs_;
  std::array<Vec3<double>, size> d_;
  std::array<double, size> r2_, t_, product_, force_, energy_;
};

/// Those that the topology excludes or scales.
const std::vector<SmoothPairCounted>& smooth_pairs_counted(const ParticleSystem<double>& s, const ScreenedCharges& near,
                                                           bool energies, double force_unit, double energy_unit) {
  thread_local std::vector<SmoothPairCounted> memory;
  std::vector<SmoothPairCounted>& found = memory;  // this thread's, written by all
  const std::vector<Topology::Pair>& excluded = s.topology()->exclusions;
  const std::vector<Topology::ScaledPair>& scaled = s.topology()->scaled_pairs;
  const ChargeSeries& series = near.series();
  found.resize(excluded.size() + scaled.size());
  for_blocks(static_cast<Index>(found.size()), [&](Index begin, Index end) {
    SmoothPairBlock block(s, near, series);
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      if (k < excluded.size()) {
        block.add(excluded[k].first, excluded[k].second, 1);
      } else {
        const Topology::ScaledPair& one = scaled[k - excluded.size()];
        block.add(one.pair.first, one.pair.second, 1 - one.factor);
      }
    }
    block.finish(energies, force_unit, energy_unit, found.data() + begin);
  });
  return found;
}

}  // namespace

template <>
void add_smooth_pairs(ForceSink<double>& out, const ParticleSystem<double>& s, const ScreenedCharges& near) {
  if (s.topology() == nullptr) return;
  constexpr int bits = 48;  // below the largest force of a pair: 2^15 pairs of a particle are safe
  const double most = strongest_product(s);
  const double force_unit = std::ldexp(1.0, std::ilogb(most * near.alpha * near.alpha) + 1 - bits);
  const double energy_unit = std::ldexp(1.0, std::ilogb(most * near.alpha) + 2 - bits);
  const bool energies = out.wants_energy() || out.wants_virial();
  const std::vector<SmoothPairCounted>& pairs = smooth_pairs_counted(s, near, energies, force_unit, energy_unit);
  if (pairs.empty()) return;
  thread_local std::vector<std::array<std::int64_t, 3>> memory;
  std::vector<std::array<std::int64_t, 3>>& forces = memory;  // this thread's, read by all
  forces.assign(static_cast<std::size_t>(s.size()), {});
  for (const SmoothPairCounted& one : pairs) {
    for (std::size_t k = 0; k < 3; ++k) {
      forces[static_cast<std::size_t>(one.i)][k] += one.force[k];
      forces[static_cast<std::size_t>(one.j)][k] -= one.force[k];
    }
  }
  VectorColumn<double>& a = out.accelerations();
  for_blocks(s.size(), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const std::array<std::int64_t, 3>& f = forces[static_cast<std::size_t>(i)];
      if (s.masses()[i] == 0 || (f[0] == 0 && f[1] == 0 && f[2] == 0)) continue;
      const double by = force_unit / s.masses()[i];
      a.add(i, by * Vec3<double>(static_cast<double>(f[0]), static_cast<double>(f[1]), static_cast<double>(f[2])));
    }
  });
  if (!energies) return;
  ExactSum energy;
  std::array<ExactSum, 9> virial;
  for (const SmoothPairCounted& one : pairs) {
    energy += one.energy;
    for (std::size_t w = 0; w < 9; ++w) virial[w] += one.virial[w];
  }
  out.energy(energy.times(energy_unit));
  Mat3<double> w;
  for (Index k = 0; k < 9; ++k) w(k / 3, k % 3) = virial[static_cast<std::size_t>(k)].times(energy_unit);
  out.virial(w);
}

}  // namespace noether::detail
