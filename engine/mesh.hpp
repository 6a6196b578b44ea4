#pragma once
/// Bodies that deform, divided into tetrahedra. The mesh belongs to the particles once and for all, as the topology
/// does that holds it: its nodes are the particles.

#include "engine/topology.hpp"
#include "numbers/types.hpp"

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace noether {

/// Tetrahedra between particles, and triangles of their surfaces.
///
/// The type of a tetrahedron is its region, that of a triangle its surface; both may have names.
struct Mesh {
  std::vector<Vec3<double>> rest;         ///< where each particle is in the bodies at rest, shape (n) [length]
  std::vector<BondedTerm<4>> tetrahedra;  ///< of positive volume at rest: the fourth sees the others anticlockwise
  std::vector<BondedTerm<3>> triangles;   ///< of surfaces that are held or pulled
  std::vector<std::string> regions;       ///< names, by type of the tetrahedron
  std::vector<std::string> surfaces;      ///< names, by type of the triangle

  /// Six times the volume of a tetrahedron at rest; below 0 where it is inside out [length^3].
  double sixfold_volume(const BondedTerm<4>& element) const;
  /// The area of a triangle at rest [length^2].
  double area(const BondedTerm<3>& triangle) const;
  /// The number of a region or a surface by its name. @throws Error  where there is none of that name
  int region(std::string_view name) const;
  int surface(std::string_view name) const;
  /// The particles of a surface, each once, in the order of their indices. @cost O(triangles)
  std::vector<Index> particles_of(int surface) const;
  /// The edges of all tetrahedra, the smaller index first, each once, sorted. @cost O(tetrahedra log tetrahedra)
  std::vector<std::pair<Index, Index>> edges() const;
  /// What each particle gets of its tetrahedra, a quarter of the mass of each.
  /// @param densities  of the regions [mass/length^3]
  std::vector<double> lumped_masses(const std::vector<double>& densities) const;
  /// Exchanges two particles of each tetrahedron that is inside out. @return how many these were
  Index turn_outside_in();

  /// @throws Error  for a particle that is not there, and for a tetrahedron that is flat or inside out at rest
  void check(Index n) const;
};

/// How flat a tetrahedron may be: six times its volume over the cube of its longest edge, which is 0.7 of a regular
/// one.
inline constexpr double flattest_element = 1e-10;

}  // namespace noether
