#include "forces/ewald_split.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace noether::detail {

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

template <> void add_smooth_pairs(ForceSink<double>& out, const ParticleSystem<double>& s, double alpha) {
  if (s.topology() == nullptr) return;
  constexpr int bits = 48;  // below the largest force of a pair: 2^15 pairs of a particle are safe
  const double most = strongest_product(s);
  const double force_unit = std::ldexp(1.0, std::ilogb(most * alpha * alpha) + 1 - bits);
  const double energy_unit = std::ldexp(1.0, std::ilogb(most * alpha) + 2 - bits);
  thread_local std::vector<std::array<std::int64_t, 3>> memory;
  std::vector<std::array<std::int64_t, 3>>& forces = memory;  // this thread's, read by all
  forces.assign(static_cast<std::size_t>(s.size()), {});
  ExactSum energy;
  std::array<ExactSum, 9> virial;
  for (const SmoothPair<double>& one : smooth_pairs(s, alpha)) {
    energy += std::llrint(one.energy / energy_unit);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Index>(k);
      const std::int64_t f = std::llrint(one.force[axis] / force_unit);
      forces[static_cast<std::size_t>(one.i)][k] += f;
      forces[static_cast<std::size_t>(one.j)][k] -= f;
      for (std::size_t l = 0; l < 3; ++l)
        virial[3 * k + l] += std::llrint(one.force[axis] * one.d[static_cast<Index>(l)] / energy_unit);
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
  out.energy(energy.times(energy_unit));
  Mat3<double> w;
  for (Index k = 0; k < 9; ++k) w(k / 3, k % 3) = virial[static_cast<std::size_t>(k)].times(energy_unit);
  out.virial(w);
}

}  // namespace noether::detail
