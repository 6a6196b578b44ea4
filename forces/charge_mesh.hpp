#pragma once
/// Charges on a mesh: spread by B-splines, and back.

#include "engine/particle_system.hpp"
#include "forces/charge_tiles.hpp"
#include "forces/mesh_splines.hpp"
#include "numbers/types.hpp"

#include <array>
#include <cstdint>
#include <memory>

namespace noether::detail {

/// How a mesh is laid.
struct MeshLayout {
  std::array<std::int64_t, 3> points{};
  int order = 0;
  double alpha = 0;  ///< [1/length]
  Vec3<double> edges = Vec3<double>::Zero();

  bool operator==(const MeshLayout&) const = default;
};

/// What waves add to the energy and to the virial.
struct MeshSums {
  double energy = 0;                           ///< [energy]
  Mat3<double> virial = Mat3<double>::Zero();  ///< [energy]
};

/// The mesh of one evaluation after the other, in double or in single precision.
///
/// Charges are counted in whole units, so fine that nothing is lost, and so many of them that the sum at no point can
/// be too large: both follow from the strongest charge, and from how many can meet at a point.
template <class T> class ChargeMesh {
 public:
  ChargeMesh();
  ChargeMesh(ChargeMesh&& other) noexcept;
  ChargeMesh& operator=(ChargeMesh&& other) noexcept;
  ~ChargeMesh();

  /// Lays it anew where anything differs.
  void lay(const MeshLayout& layout);
  /// The potential of charges at the points of the mesh.
  /// @param strongest  no charge is stronger; above 0
  /// @param sums  what to fill in where it is asked for; nothing in single precision
  void solve(const ChargeTiles& tiles, double strongest, double coulomb_constant, MeshSums* sums);
  /// Adds what the charges feel of it.
  void add_accelerations(VectorColumn<double>& a, const ParticleSystem<double>& s, const ChargeTiles& tiles);

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

extern template class ChargeMesh<double>;
extern template class ChargeMesh<float>;

}  // namespace noether::detail
