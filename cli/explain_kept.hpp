#pragma once
/// What `explain` tells of methods that keep the energy.

#include "engine/concepts.hpp"
#include "scene/scene.hpp"

#include <string>

namespace noether {

/// "keeps E and p; L not, because of henon_heiles"; empty where the energy is not kept at any step, but that of
/// polynomials by some methods.
std::string kept_text(const Scene& scene, const IntegratorClaims& claims);

/// Of bodies and of systems with an energy: whether `shadow_hamiltonian` can watch the run, or why not.
std::string shadow_text(const Scene& scene, const AnyIntegrator<double>& integrator);

}  // namespace noether
