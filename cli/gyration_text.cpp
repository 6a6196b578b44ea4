#include "cli/gyration_text.hpp"

#include "scene/gyration.hpp"
#include "scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

namespace noether {

std::string gyration_text(const Scene& scene) {
  const std::vector<double> rates = gyration_rates(scene, scene.integrator.start);
  if (rates.empty()) return "";
  const auto fastest = std::max_element(rates.begin(), rates.end());
  const double most = *fastest;
  const std::string& name = scene.particles.name(fastest - rates.begin());
  const std::string unit = scene.units->is_reduced() ? "" : " " + std::string(scene.units->time);
  if (!(most > 0)) return "gyration: no charge turns at the start";
  const double turn = 2 * std::numbers::pi / most;
  if (scene.integrator.adaptive()) {
    return fmt::format("gyration: '{}' turns once in {:.4g}{} at the start", name, turn, unit);
  }
  const double angle = most * scene.integrator.step;
  return fmt::format("gyration: '{}' turns by {:.3g} rad a step at the start, {:.3g} steps a turn", name, angle,
                     turn / scene.integrator.step);
}

}  // namespace noether
