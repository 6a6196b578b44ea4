#include "scene/gyration.hpp"

#include "engine/proper_velocity.hpp"
#include "forces/electromagnetic_field.hpp"
#include "numbers/suggest.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

namespace noether {

std::vector<double> gyration_rates(const Scene& scene, double time) {
  const auto gyrates = [](const SceneForce& force) { return force.force.claims().gyrates; };
  const auto any = [&](const std::vector<SceneForce>& forces) {
    return std::any_of(forces.begin(), forces.end(), gyrates);
  };
  if (!any(scene.hamiltonian.forces) && !any(scene.hamiltonian.splitting.own))
    return {};  // most scenes: nothing is copied
  const ForceField<double> fields = fields_among(forces_of(scene));
  ParticleSystem<double> s = scene.particles;
  s.clock() = Clock<double>::free(time);
  VectorColumn<double> a(s.size()), turns(s.size());
  ForceSink<double> sink(a, s, {});
  sink.set_gyrations(turns);
  fields.add_to(sink, s);
  std::vector<double> rates;
  for (Index i = 0; i < s.size(); ++i) {
    double rate = Vec3<double>(std::as_const(turns)[i]).norm();
    if (const auto& c = scene.hamiltonian.splitting.c) {
      rate /= static_cast<double>(gamma_of_velocity(whole_velocity(s, i), Quad(*c)));
    }
    rates.push_back(rate);
  }
  return rates;
}

std::optional<double> first_gyration(const Scene& scene, double time) {
  const std::vector<double> rates = gyration_rates(scene, time);
  const auto first = std::find_if(rates.begin(), rates.end(), [](double rate) { return rate > 0; });
  if (first == rates.end()) return {};
  return 2 * std::numbers::pi / *first;
}

std::string misspelt_gyration(const std::string& step) {
  const std::string word = "gyration", last = step.substr(step.find_last_of(" 0123456789.") + 1);
  return last == word || suggest(last, {word}).empty() ? "" : last;
}

}  // namespace noether
