#include "cli/gyration_text.hpp"

#include "engine/proper_velocity.hpp"
#include "forces/electromagnetic_field.hpp"
#include "scene/scene.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace noether {

std::string gyration_text(const Scene& scene) {
  const ForceField<double> fields = fields_among(forces_of(scene));
  if (fields.terms().empty()) return "";
  ParticleSystem<double> s = scene.particles;
  s.clock() = Clock<double>::fixed(scene.integrator.start, scene.integrator.step);
  VectorColumn<double> a(s.size()), rates(s.size());
  ForceSink<double> sink(a, s, {});
  sink.set_gyrations(rates);
  fields.add_to(sink, s);
  Index fastest = 0;
  double most = -1;
  for (Index i = 0; i < s.size(); ++i) {
    double rate = Vec3<double>(std::as_const(rates)[i]).norm();
    if (const auto& c = scene.hamiltonian.splitting.c) {
      rate /= static_cast<double>(gamma_of_velocity(whole_velocity(s, i), Quad(*c)));
    }
    if (rate <= most) continue;
    most = rate;
    fastest = i;
  }
  const std::string unit = scene.units->is_reduced() ? "" : " " + std::string(scene.units->time);
  if (!(most > 0)) return "gyration: no charge turns at the start";
  const double turn = 2 * std::numbers::pi / most;
  if (scene.integrator.adaptive()) {
    return fmt::format("gyration: '{}' turns once in {:.4g}{} at the start", s.name(fastest), turn, unit);
  }
  const double angle = most * scene.integrator.step;
  return fmt::format("gyration: '{}' turns by {:.3g} rad a step at the start, {:.3g} steps a turn", s.name(fastest),
                     angle, turn / scene.integrator.step);
}

}  // namespace noether
