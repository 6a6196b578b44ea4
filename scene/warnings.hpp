#pragma once
/// What can be run, but is hardly meant.

#include "scene/scene.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// One line for each kind of thing that is in the scene and does nothing, that contradicts another, or that no step of
/// this length can follow: bonds of a structure that shake their particles apart; and for a constant of gravitation
/// that is not the one of the units.
/// @cost O(bonds)
std::vector<std::string> warnings_of(const Scene& scene);

/// What a run under a splitting about a primary says of bodies that came too near to each other for it.
/// @param hamiltonian  its name
std::string warning_of(const Encounter& encounter, const std::string& hamiltonian,
                       const ParticleSystem<double>& particles, const UnitSystem& units);

/// What a run says of steps whose errors are above those that its method is for.
std::string warning_of(const Evaluations& evaluations, std::string_view method);

/// Tells notes on stderr, one line each: what of a scene was taken otherwise than written (`Scene::notes`).
void tell_notes(const std::vector<std::string>& notes);

/// Tells the notes of a scene on stderr, and its warnings: for questions about a scene whose reports do not have them.
void tell_notes_and_warnings(const Scene& scene);

}  // namespace noether
