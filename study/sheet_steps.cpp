#include "study/sheet_steps.hpp"

#include "engine/sphere_columns.hpp"
#include "forces/hard_spheres.hpp"
#include "forces/hill_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace noether {

namespace {

void keep_shorter(double time, const std::string& name, double& shortest, std::string& of) {
  if (!std::isfinite(time) || !(time > 0) || (shortest > 0 && shortest <= time)) return;
  shortest = time;
  of = name;
}

/// Times of the spheres of a sheet. @param G  0 without gravity
void look_at_spheres(const ParticleSystem<double>& s, double Omega, double G, SheetSteps& found) {
  const auto& radii = s.column<BodyRadius>();
  for (Index i = 0; i < s.size(); ++i) {
    const double r = radii[i], mu = G * s.masses()[i];
    if (mu > 0) {
      keep_shorter(2 * std::numbers::pi * std::sqrt(r * r * r / mu), s.name(i), found.surface, found.surface_of);
    }
    Vec3<double> u = s.velocities()[i];
    u[1] += 1.5 * Omega * s.unwrapped(i)[0];
    keep_shorter(2 * r / u.norm(), s.name(i), found.crossing, found.crossing_of);
  }
}

}  // namespace

std::optional<double> SheetSteps::recommended() const {
  if (!kicks) return {};
  double step = turn / 100;
  if (surface > 0) step = std::min(step, surface / 20);
  if (crossing > 0) step = std::min(step, crossing / 2);
  return step;
}

std::string SheetSteps::reason() const {
  if (const auto step = recommended()) {
    if (surface > 0 && *step == surface / 20)
      return fmt::format("a twentieth of a turn about {} at its surface", surface_of);
    if (crossing > 0 && *step == crossing / 2) return fmt::format("in which {} goes as far as its radius", crossing_of);
    return "a hundredth of a turn of the frame";
  }
  return "no force acts, and epicycles and contacts are exact at any step";
}

std::optional<SheetSteps> sheet_steps(const Scene& scene) {
  SheetSteps found;
  double Omega = 0;
  bool spheres = false;
  for (const SceneForce& term : scene.hamiltonian.terms()) {
    if (const auto* frame = term.force.as<HillFrame>()) {
      Omega = frame->Omega;
    } else {
      found.kicks = true;
    }
  }
  for (const SceneForce& force : scene.hamiltonian.forces)
    spheres = spheres || force.force.as<SphereForce>() != nullptr;
  if (!(Omega > 0)) return {};
  found.turn = 2 * std::numbers::pi / Omega;
  const double G = scene.hamiltonian.is_keplerian() ? scene.hamiltonian.G.value_or(scene.units->G) : 0;
  if (spheres && scene.particles.has<BodyRadius>()) look_at_spheres(scene.particles, Omega, G, found);
  return found;
}

}  // namespace noether
