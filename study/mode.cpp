#include "study/mode.hpp"

namespace noether {

Mode mode_of(const Scene& scene, const Spectrum& spectrum) {
  if (scene.system) return {.omega = 0, .rate = 0, .lambda = spectrum.stiffest};
  return {.omega = spectrum.fastest, .rate = drag_of(scene), .lambda = {}};
}

double next_z(double z) { return z < 10 ? z + z_step : 1.02 * z; }

}  // namespace noether
