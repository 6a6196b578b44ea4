#pragma once
/// Molecules side by side in lanes: what the kernels of constraints work on.

#include "constraints/elimination_row.hpp"
#include "constraints/preconditioner_row.hpp"

#include <cstddef>
#include <cstdint>

namespace noether {

/// Coordinates of particles, x, y and z. Position stages take `x` from where free motion ends onto the constraints, in
/// a periodic box what particles have moved from `start`; velocity stages have `x` null.
struct MoleculeColumns {
  const double* start[3];  ///< positions to which gradients belong
  double *x[3], *v[3];
  double edge[3];   ///< of a periodic box; 0 in open space
  double magic[3];  ///< adding and subtracting it rounds to the grid of the box
};

/// What is constant of eight rigid molecules of three sites side by side: bonds r1 from atom 0 to 1 and r2 from 0 to 2.
/// Their masses are the same, their lengths need not be.
struct RigidTriangles {
  static constexpr int lanes = 8;
  using Lanes = double[lanes];

  alignas(64) Lanes c11, c12, c22;  ///< r_i . r_j
  Lanes inverse_c11;                ///< 1 / c11
  Lanes inverse[6];                 ///< of the matrix of the bonds 0-1, 0-2, 1-2: 11 12 13 22 23 33
  /// Of isosceles ones: from the centre of mass to atom 0, and to the middle of the others, and half their distance.
  Lanes apex, inverse_apex, base, half_base;
  double inverse_mass[3];
  double part1, part2;  ///< of isosceles ones: masses of atoms 1 and 2 over all
};

/// Molecules whose bonds form one path: bond k leads from atom[k] to atom[k + 1].
struct BondPathRow {
  int bonds;
  const int* atom;             ///< shape (bonds + 1)
  const double* inverse_mass;  ///< of these atoms
};

/// A long path whose segments stand in the lanes of a pack, one atom and one bond of each at a time.
struct BondSegmentsRow {
  int bonds;                   ///< of the path
  const double* inverse_mass;  ///< of atom a in lane l: [lanes a + l]
};

/// Some molecules of one kind, as many as there are lanes: where a kind has fewer, the last one stands several times.
struct MoleculePack {
  int lanes;      ///< 8 or 16
  unsigned live;  ///< a bit for each lane that stands for a molecule of its own
  const EliminationLists* kind;
  const std::int32_t* atoms;                  ///< particle of atom a in lane l: [lanes a + l]
  bool side_by_side;                          ///< atoms of each molecule follow each other in the columns
  bool in_a_row;                              ///< and molecules do
  const RigidTriangles* triangles;            ///< of rigid molecules of three sites; else null
  const BondPathRow* path;                    ///< of molecules solved by kernels for paths; else null
  const BondSegmentsRow* segments;            ///< of a molecule that fills a pack by itself; else null
  const TreeCenter* tree;                     ///< of molecules solved by kernels for trees: shape (centers); else null
  const PreconditionerLists* preconditioner;  ///< for those who need one
  const double* lengths2;  ///< squared, in the order of elimination (along a path), then 1 / squared, shape (2,
                           ///< constraints, lanes)
  int passes;              ///< of a velocity stage of Newton's method
  double* scratch;         ///< of the thread: doubles a lane, `molecule_scratch` and what the kernels ask for
};

/// Doubles a lane that all kernels need beside a pack.
constexpr std::size_t molecule_scratch(const EliminationLists& kind) {
  return static_cast<std::size_t>(9 * kind.constraints + kind.entries + 3 * kind.centers + kind.longest_row +
                                  4 * kind.atoms + 8);
}

/// What a stage is asked for.
struct MoleculeTask {
  double h;          ///< duration of free motion [time]
  double tolerance;  ///< of methods that have one: largest relative violation that is left
  int iterations;    ///< of these, the most; of methods of a fixed order, how often lengths are corrected
  int order;         ///< of these, powers of a series
};

/// How a stage went.
struct MoleculeReport {
  unsigned open = 0;  ///< a bit for each lane that is not solved; it is left where it was
  int sweeps = 0;
  /// The largest relative violation that the first of these met, and that the last one left; 0: nobody has looked.
  double before = 0, after = 0;
};

/// The stages of a solver in lanes.
struct MoleculeKernels {
  MoleculeReport (*solve_positions)(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask& task);
  /// Takes from velocities what is along gradients at `start`.
  MoleculeReport (*project_velocities)(const MoleculePack& pack, const MoleculeColumns& columns,
                                       const MoleculeTask& task);
  /// Doubles a lane of scratch that this solver needs besides; null: none.
  int (*slots)(const EliminationLists& kind) = nullptr;
  int most_of_sixteen = 32;    ///< constraints of which a pack of sixteen molecules stays in the first-level cache
  int most_constraints = 256;  ///< larger molecules are left to the solver of the whole set
};

}  // namespace noether
