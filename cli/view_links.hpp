#pragma once
/// What holds particles together in a picture: bonds of a structure, rods of a scene.

#include "cli/view_data.hpp"
#include "io/frames.hpp"
#include "io/hdf5_file.hpp"
#include "numbers/units.hpp"

#include <vector>

namespace noether {

/// Fills `links` and `anchors`: bonds of the file, and of the scene's constraints those that keep two particles at a
/// distance (`distance`) or one at the end of a rod (`on_sphere`).
/// @param rows  particles of the file that are shown
void read_links(ViewData& data, const io::Hdf5File& file, const SceneValue& scene, const UnitSystem& units,
                const io::Frames& shared, const std::vector<std::size_t>& rows);

/// Whether bodies of a scene attract each other as masses do.
bool has_gravity(const SceneValue& scene);

/// G of a scene; `of_units` where it gives none.
double constant_of_gravity(const SceneValue& scene, double of_units);

}  // namespace noether
