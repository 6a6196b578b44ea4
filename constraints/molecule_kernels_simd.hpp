#pragma once
/// Solvers of constraints in lanes, each in the `*_lanes_simd.cpp` of its name.

#include "constraints/molecule_row.hpp"
#include "numbers/kernels_simd.hpp"

namespace noether {

/// Newton's method with chord steps, to rounding.
NOETHER_KERNELS(MoleculeKernels, newton_lanes)
/// The same for molecules whose bonds form one path.
NOETHER_KERNELS(MoleculeKernels, path_lanes)
/// The same for one long path, whose segments are side by side; packs of sixteen lanes.
NOETHER_KERNELS(MoleculeKernels, segment_lanes)
/// The same for trees of bonds with at most four an atom, on more than one; packs of eight.
NOETHER_KERNELS(MoleculeKernels, tree_lanes)
/// Constraint after constraint in sweeps, to a tolerance: SHAKE and RATTLE.
NOETHER_KERNELS(MoleculeKernels, sweep_lanes)
/// Newton's method with a dense matrix of the moment, to rounding.
NOETHER_KERNELS(MoleculeKernels, m_shake_lanes)
/// Sweeps of all constraints at once by a matrix that is constant, to a tolerance.
NOETHER_KERNELS(MoleculeKernels, p_shake_lanes)
/// A series for the matrix, and corrections of lengths, as many as are asked for.
NOETHER_KERNELS(MoleculeKernels, lincs_lanes)
/// Newton's method for rigid molecules of three sites, whose violation is quadratic in three multipliers; packs of
/// eight.
NOETHER_KERNELS(MoleculeKernels, triangle_lanes)
/// The closed form for those of two equal sites; packs of eight.
NOETHER_KERNELS(MoleculeKernels, settle_lanes)

}  // namespace noether
