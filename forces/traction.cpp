#include "forces/traction.hpp"

#include "numbers/error.hpp"

#include <map>

namespace noether {

const std::vector<detail::KnownSurface::Corner>& detail::KnownSurface::of(
    const std::shared_ptr<const Topology>& topology, Index n, const std::string& surface) const {
  if (topology_ != nullptr && topology == topology_ && surface == surface_) return corners_;
  const Mesh* mesh = topology != nullptr ? topology->mesh.get() : nullptr;
  if (mesh == nullptr) {
    throw Error(
        "force 'traction' has nothing to act on: the particles have no mesh; give a block or a mesh, or take the force "
        "out");
  }
  mesh->check(n);
  const int wanted = mesh->surface(surface);
  std::map<Index, double> areas;
  for (const BondedTerm<3>& triangle : mesh->triangles) {
    if (triangle.type != wanted) continue;
    for (const Index i : triangle.particles) areas[i] += mesh->area(triangle) / 3;
  }
  corners_.clear();
  for (const auto& [i, area] : areas) corners_.push_back({i, area});
  topology_ = topology;
  surface_ = surface;
  return corners_;
}

template struct detail::ForceModel<Traction, double>;
template struct detail::ForceModel<Traction, Quad>;

}  // namespace noether
