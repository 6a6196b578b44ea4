#pragma once
/// A charge on a mesh, for code in lanes too.

namespace noether {

struct MeshPlace {
  double x, y, z;  ///< in points of the mesh, at least 0 and below n
  double charge;
};

}  // namespace noether
