#pragma once
/// Molecules whose constraints are distances alone, those of one kind side by side in lanes.

#include "constraints/bond_path.hpp"
#include "constraints/constraint_method.hpp"
#include "constraints/constraint_set.hpp"
#include "constraints/elimination.hpp"
#include "constraints/molecule_row.hpp"
#include "constraints/preconditioner.hpp"
#include "engine/column.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace noether {

class Partition;

/// Solves the constraints of such molecules by the kernels of a solver. The order in which constraints are eliminated
/// is found once for each kind. Newton's method has kernels of their own for paths and trees of bonds; a path of more
/// than 256 bonds is laid in segments side by side.
///
/// Molecules are of one kind if they have as many atoms, of the same masses, and tie the same ones; lengths may differ
/// unless a solver wants them equal.
/// Nothing is kept from stage to stage. Bits depend neither on which molecules are side by side nor on threads.
/// @cost newton 15 to 20 ns a constraint and step, both stages, with AVX-512, long paths 25; no allocation after
///       `lay_out`
/// @source RyckaertCiccottiBerendsen1977, Davis2006
class MoleculeLanes {
 public:
  /// Takes the components of a set that consist of distances. @return what is left of the set
  /// @throws BadConstraints  for a constraint on a particle that is not there, or one that the solver does not serve
  ConstraintSet lay_out(const ConstraintSet& set, const ParticleSystem<double>& s);
  bool empty() const { return kinds_.empty(); }
  /// How many packs of molecules side by side there are.
  Index packs() const;

  struct Solved {
    std::int64_t sweeps = 0;       ///< the most that a molecule needed
    double before = 0, after = 0;  ///< the violation before and after these; both 0: nobody has looked
    std::vector<Index> open = {};  ///< molecules that are not solved: they are left where they were
  };
  /// The position stage. @param start  positions before free motion  @param x  where it ends; in a periodic box what
  /// particles have moved  @param h  its duration [time]  @param look  finds violations, where kernels see none
  Solved solve_positions(const ParticleSystem<double>& s, const VectorColumn<double>& start, VectorColumn<double>& x,
                         VectorColumn<double>& v, double h, bool look);
  /// The velocity stage. @param h  as ConstraintStages::project_velocities
  Solved project_velocities(ParticleSystem<double>& s, double h);

  /// The particles of a molecule, and its constraints, numbered by their places there.
  const std::vector<Index>& particles(Index molecule) const { return molecules_[at(molecule)].particles; }
  ConstraintSet constraints(Index molecule, const ParticleSystem<double>& alone) const;

 private:
  struct Molecule {
    std::vector<Index> particles;
    std::vector<Elimination::Pair> pairs;  ///< of places
    std::vector<double> lengths;           ///< of the pairs

    bool is_triangle() const { return particles.size() == 3 && pairs.size() == 3; }
  };
  /// Molecules side by side, and the kernels that know their shape.
  struct Kind {
    std::vector<Index> molecules;
    std::optional<Elimination> elimination = {};  ///< none of molecules in segments
    std::vector<RigidTriangles> triangles = {};   ///< of rigid molecules of three sites: shape (packs), or one if alike
    Preconditioner preconditioner = {};           ///< for those who need one
    std::optional<BondPath> path = {};
    std::vector<TreeCenter> tree = {};  ///< of molecules that kernels for trees solve
    MoleculeKernelsInUse* kernels = nullptr;
    int lanes = 8;
    int passes = 2;                             ///< of velocity stages of Newton's method
    bool in_segments = false;                   ///< each molecule fills the lanes of a pack
    AlignedVector<double> segment_masses = {};  ///< inverse masses, shape (atoms, lanes)
    std::vector<std::int32_t> atoms = {};       ///< shape (packs, atoms of a lane, lanes)
    AlignedVector<double> lengths2 = {};  ///< shape (packs, 2, constraints, lanes); (1, ...) where packs are alike
    bool side_by_side = true, alike = true;
    Index packs = 0, first_report = 0;

    /// What a lane of a pack has.
    EliminationLists lists() const;
    Index molecules_of_pack() const { return in_segments ? 1 : lanes; }
    /// Which of a molecule's pairs each constraint of the kernels is.
    const std::vector<int>& order() const { return path ? path->bonds : elimination->places(); }
  };

  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  static std::vector<double> inverse_masses(const Molecule& molecule, const ParticleSystem<double>& s);
  std::optional<Molecule> molecule_of(const ConstraintSet& set, const Partition& parts, Index component,
                                      const ParticleSystem<double>& s) const;
  /// Squared lengths of a molecule of three sites: of 0-1, 0-2 and 1-2.
  static std::array<double, 3> sides2(const Molecule& molecule);
  void add_kind(std::vector<Index> molecules, const ParticleSystem<double>& s);
  void choose_kernels(Kind& kind, const ParticleSystem<double>& s) const;
  void lay_side_by_side(Kind& kind) const;
  void lay_triangles(Kind& kind, const ParticleSystem<double>& s) const;
  void lay_in_segments(Kind& kind) const;
  /// Calls `work(kernels, pack, report)` for all packs, by threads.
  template <class Work> void for_packs(const Work& work);
  MoleculeTask task(double h) const;
  Solved solved() const;
  /// The largest relative violation of some bonds, not of all: @param start, x  as of a position stage
  double violation(const ParticleSystem<double>& s, const VectorColumn<double>& start,
                   const VectorColumn<double>& x) const;

  ConstraintOptions options_;
  std::vector<Molecule> molecules_;
  std::vector<Kind> kinds_;
  std::vector<MoleculeReport> reports_;
};

}  // namespace noether
