#pragma once
/// What rigid bodies are made of, in run.h5.
///
/// | path | what | shape |
/// |---|---|---|
/// | /noether/bodies/kind | the kind of each particle, in the order of their ids; -1: a point | (n) |
/// | /noether/bodies/held | whether a fixed point holds the bodies of a kind | (kinds) |
/// | /noether/bodies/site_kind | the kind that each site belongs to; sites of a kind stand in their order | (m) |
/// | /noether/bodies/site_place | in the principal axes, from the centre or the fixed point | (m, 3) |
/// | /noether/bodies/site_mass, site_charge | | (m) |
/// | /noether/bodies/site_type, site_name | its type, from 0, and its name | (m) |
///
/// Orientation, spin and moments of inertia are columns of the particles.

#include "engine/bodies.hpp"
#include "io/hdf5_file.hpp"

#include <memory>
#include <string>
#include <vector>

namespace noether::io {

inline const std::string bodies_path = "/noether/bodies";

/// Writes it where some particles are bodies. @param order  indices of the particles in the order of their ids
void write_rigid_bodies(const Hdf5File& file, const ParticleSystem<double>& state, const std::vector<Index>& order);

/// Which particles are bodies, in the order of the run; null where the file does not say.
/// @param order  the row of the file where each particle stands
/// @throws FileError  for what does not fit together
std::shared_ptr<const Bodies> read_rigid_bodies(const Hdf5File& file, const std::vector<Index>& order);

}  // namespace noether::io
