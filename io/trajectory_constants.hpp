#pragma once
/// What stands once in run.h5: what the file is, and what its particles have that never changes.

#include "engine/particle_system.hpp"
#include "io/hdf5_file.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace noether::io {

/// Writes what the file is: /h5md, the attributes of /noether, and the effective scene.
void write_header(const Hdf5File& file, const UnitSystem& units, const std::string& scene_toml);

/// Writes what particles have once: ids, masses, names, the boundary of the box, columns that do not move, types,
/// molecules and bonded terms (io/trajectory_topology.hpp), and what bodies are made of (io/trajectory_bodies.hpp),
/// where there are any.
/// @param order  indices of the particles in the order of their ids
void write_constants(const Hdf5File& file, const ParticleSystem<double>& state, const std::vector<Index>& order);

/// Names a unit as the module `units` of H5MD does, "nm ps-1" or "kg m+2 s-1"; empty where H5MD has no word for one of
/// its factors, as for au, and for numbers without a unit.
/// @param dimension  in words, such as "charge" or "mass length^2/time"
/// @source DeBuyl2014
std::string h5md_unit(std::string_view dimension, const UnitSystem& units);

/// Gives a dataset its unit: the attribute `unit` where H5MD has a word for it, else `noether_unit`.
void set_unit(const Hdf5File& file, const std::string& path, std::string_view dimension, const UnitSystem& units);

/// The same for what MDAnalysis reads, positions, velocities and their times: it opens no file with a unit that it does
/// not know, and knows no metre. `unit` stands where both have a word.
void set_unit_of_motion(const Hdf5File& file, const std::string& path, std::string_view dimension,
                        const UnitSystem& units);

}  // namespace noether::io
