#include "forces/ewald.hpp"

#include "numbers/simd_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

constexpr double most_waves = 1e7;

}  // namespace

namespace detail {

template <> WaveLoops<double> wave_loops() {
  return {simd_loop<add_up_wave<double>>(), simd_loop<add_wave_fields<double>>()};
}

std::vector<Wave> waves_up_to(double wave_number, const Vec3<double>& edges) {
  constexpr double turn = 6.283185307179586;
  std::array<int, 3> most{};
  for (std::size_t k = 0; k < 3; ++k) most[k] = static_cast<int>(wave_number * edges[static_cast<Index>(k)] / turn);
  std::vector<Wave> waves;
  for (int x = 0; x <= most[0]; ++x) {
    for (int y = x == 0 ? 0 : -most[1]; y <= most[1]; ++y) {
      for (int z = x == 0 && y == 0 ? 1 : -most[2]; z <= most[2]; ++z) {
        const Vec3<double> k(turn * x / edges[0], turn * y / edges[1], turn * z / edges[2]);
        if (norm2(k) <= wave_number * wave_number) waves.push_back({x, y, z});
      }
    }
  }
  return waves;
}

double wave_count(double wave_number, double volume) {  // half a ball, of which each wave has (2 pi)^3 / V
  return wave_number * wave_number * wave_number * volume * (2 * 3.141592653589793 / 3) / 248.05021344239853;
}

}  // namespace detail

void Ewald::check() const {
  detail::check_split(cutoff, relative_error, alpha);
  detail::check_wave_kick(wave_kick);
  if (kmax && !(*kmax >= 0 && *kmax < 1e100))
    refuse_field("kmax", *kmax, "is not a valid wave number; 0 or more is expected");
}

void Ewald::check_waves(const Box& box, Index charged) const {
  if (charged == 0) return;
  const double count = detail::wave_count(*chosen_for(box, charged).kmax, box.volume());
  if (count <= most_waves) return;
  throw Error(
      fmt::format("the force '{}' would sum {:.2g} waves, more than {:.0e}; take a longer cutoff or a larger "
                  "relative_error",
                  describe().name, count, most_waves));
}

Ewald Ewald::chosen_for(const Box& box, Index charged) const {
  const detail::SplitErrors errors(box.volume(), charged);
  const double each = relative_error / std::sqrt(2.0);  // near part and waves have independent errors
  Ewald chosen = *this;
  if (!alpha) chosen.alpha = errors.alpha_for(each, cutoff);
  if (!kmax) chosen.kmax = errors.wave_number_for(each, *chosen.alpha);
  return chosen;
}

Ewald Ewald::reference() const {
  Ewald exact = *this;
  if (!alpha && !kmax) exact.relative_error = std::min(relative_error, 1e-13);
  return exact;
}

template struct detail::ForceModel<Ewald, double>;
template struct detail::ForceModel<Ewald, Quad>;

}  // namespace noether
