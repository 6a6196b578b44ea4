#pragma once
/// Structures: particles with their box, types and bonds, from LAMMPS data files, extended XYZ, GROMACS files and
/// meshes of Gmsh.

#include "engine/particle_system.hpp"
#include "io/structure_options.hpp"

#include <filesystem>

namespace noether::io {

/// Reads particles, and with them box, types, charges, molecules and bonds; the format follows from the extension.
///
/// `.data`, `.lmp`, `.lammps`, `.lmpdat`, `data.NAME`: LAMMPS data, orthogonal boxes. Sections Masses, Atoms,
/// Velocities, Bonds, Angles, Dihedrals, Impropers, labels of types, and the Coeffs of these and of pairs (lj/cut and
/// what is lj/cut or lj/charmm with charges; bonds harmonic, morse, fene; angles harmonic, cosine, cosine/squared,
/// charmm; dihedrals charmm, harmonic, fourier, multi/harmonic, opls; impropers harmonic, cvff), or the same in
/// `coefficients`. The style of a section stands behind its name, `Bond Coeffs # harmonic`. A cutoff behind epsilon and
/// sigma of a pair is `Topology::stated_cutoff`, and moves nothing: the cutoff is the force's; all of them must agree.
/// Particles stand in the order of their ids and keep them; types are named by their labels, or "1", "2", ...; the
/// lower corner of the box becomes the origin. Coefficients become those of noether's kinds (forces/bonded.hpp).
///
/// `.xyz`, `.extxyz`: one frame of XYZ, extended or plain; positions in angstrom, `velo` or `vel` in angstrom/fs or as
/// `file_units` say, `velocities` as they say, `momenta` in sqrt(eV u), as ASE writes them, `charge` or
/// `initial_charges` in e, `mass` or `masses` in u; other properties are told in `notes`. A `Temperature` of the
/// comment is compared with the velocities. Types are the species; an element that is given no mass has its standard
/// atomic weight.
///
/// `.msh`: a mesh of Gmsh, 2.2 or 4.1 in ASCII: nodes of tetrahedra of first order, with masses by `densities`;
/// physical volumes are its regions, physical surfaces its surfaces. Lengths are in `file_units`.
///
/// `.gro`: one frame; types are atom names, molecules are residues; masses come from `types`.
/// @throws FileError if it cannot be read or is no text; SceneError for what is wrong in it, with file and line; Error
///   with a key for options that do not fit it
/// @cost O(bytes)
/// @source Codata2018, Meija2016
ParticleSystem<double> read_structure(const std::filesystem::path& file, const StructureOptions& options = {});

}  // namespace noether::io
