#pragma once
/// Types, molecules and bonded terms in run.h5, as other programs find them, and to the bit as a run had them.
///
/// | path | what | shape |
/// |---|---|---|
/// | /particles/system/species | the type of each particle, from 1: "1", "2" of LAMMPS are 1, 2 | (n) |
/// | /connectivity/bonds, angles, dihedrals, impropers | ids of the particles of each term | (m, 2), (m, 3), (m, 4) |
/// | /connectivity/tetrahedra, triangles | ids of the corners of elements, and of surfaces of a mesh | (m, 4), (m, 3) |
/// | /noether/topology/region_name, surface_name | names of the kinds of these | (kinds) |
/// | /noether/topology/rest | where each particle is in the bodies at rest | (n, 3) |
/// | /parameters/vmd_structure/bond_from, bond_to | rows of the ends of each edge of a mesh, from 1, as VMD draws them
/// | (e)| | /noether/topology/type_name | names of the types: species k is called by the text k - 1 | (types) | |
/// /noether/topology/molecule | the molecule of each particle | (n) | | /noether/topology/bonds_kind, ... | which kind
/// each term is of, from 0 | (m) | | /noether/topology/bonds_potential, ... | the potential of each kind | (kinds) | |
/// /noether/topology/bonds_parameter_count, ..._parameters | how many parameters it has, and all of them in a row | |
/// | /noether/topology/pair_kinds | epsilon and sigma of each type | (types, 2) |
/// | /noether/topology/pair_types, pair_parameters | pairs of types, from 0, that are not mixed | (p, 2), (p, 2) |
/// | /noether/topology/mixing, stated_cutoff | how the others are mixed; the cutoff that a file named | |
/// | /noether/topology/excluded, scaled, scaled_factor | ids of pairs without force, or with a part of it | (e, 2), (s,
/// 2), (s) | | /noether/topology/order | where the particles do not stand in the order of their ids: the row of each |
/// (n) |
///
/// What a run does not have is left out. Terms stand in the order of the run, because its bits depend on it.

#include "engine/particle_system.hpp"
#include "io/hdf5_file.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace noether::io {

inline const std::string topology_path = "/noether/topology";
inline const std::string connectivity_path = "/connectivity";
inline const std::string vmd_structure_path = "/parameters/vmd_structure";

/// Writes what there is of it. @param order  indices of the particles in the order of their ids
void write_topology(const Hdf5File& file, const ParticleSystem<double>& state, const std::vector<Index>& order);

/// The name of each row's type; empty where particles have none, as in a file from before there were any.
/// @param rows  particles of the file
/// @throws FileError  for what does not fit together
std::vector<std::string> read_type_names(const Hdf5File& file, Index rows);

/// For each particle of the run the row of the file where it stands. @throws FileError unless each row is named once
std::vector<Index> read_order(const Hdf5File& file, Index rows);

/// Types, molecules and bonded terms as the run had them; null where the file has none.
/// @param ids  by row
/// @param order  as read_order() gives it
/// @throws FileError  for what does not fit together
std::shared_ptr<const Topology> read_topology(const Hdf5File& file, const std::vector<std::int64_t>& ids,
                                              const std::vector<Index>& order);

}  // namespace noether::io
