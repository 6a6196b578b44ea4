#include "forces/mesh_elements.hpp"

#include "engine/mesh.hpp"
#include "numbers/error.hpp"

#include <fmt/format.h>

#include <limits>
#include <utility>

namespace noether::detail {

template <class Number>
MeshElements<Number>::MeshElements(std::shared_ptr<const Topology> topology, Index n, const std::string& region)
    : origin_(std::move(topology)), region_(region) {
  const Mesh* mesh = origin_ != nullptr ? origin_->mesh.get() : nullptr;
  if (mesh == nullptr || mesh->tetrahedra.empty()) {
    throw Error(
        "force 'hyperelastic' has nothing to act on: the particles have no tetrahedra; give a block or a mesh, or take "
        "the force out");
  }
  mesh->check(n);
  const int only = region.empty() ? -1 : mesh->region(region);
  for (std::size_t k = 0; k < mesh->tetrahedra.size(); ++k) {
    if (only < 0 || mesh->tetrahedra[k].type == only) number_.push_back(static_cast<std::int32_t>(k));
  }
  if (number_.empty()) throw Error(fmt::format("the region '{}' of the mesh has no tetrahedra", region));
  const auto slots = static_cast<std::size_t>(padded()) * slot_width;
  if (slots > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(fmt::format("the mesh has {} tetrahedra; at most 357 million are expected", number_.size()));
  }
  corners_.assign(static_cast<std::size_t>(padded()) * 4, static_cast<std::int32_t>(0));
  shapes_.assign(static_cast<std::size_t>(padded()) * shape_width, Number(0));
  for (Index k = 0; k < size(); ++k) add_shape(k, k);
  for (Index k = size(); k < padded(); ++k) {
    add_shape(k, 0);
    shapes_[at(k, 9, shape_width)] = Number(0);
  }
  find_places(n);
}

template <class Number> void MeshElements<Number>::add_shape(Index k, Index of) {
  const Mesh& mesh = *origin_->mesh;
  const auto& particles = mesh.tetrahedra[static_cast<std::size_t>(number(of))].particles;
  std::array<Vec3<Number>, 4> x;
  for (std::size_t c = 0; c < 4; ++c) {
    corners_[at(k, static_cast<Index>(c), 4)] = static_cast<std::int32_t>(particles[c]);
    const Vec3<double>& rest = mesh.rest[static_cast<std::size_t>(particles[c])];
    x[c] = Vec3<Number>(Number(rest[0]), Number(rest[1]), Number(rest[2]));
  }
  const Vec3<Number> a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
  const std::array<Vec3<Number>, 3> rows = {cross(b, c), cross(c, a), cross(a, b)};
  const Number sixfold = dot(a, rows[0]);
  for (Index r = 0; r < 3; ++r) {
    for (Index j = 0; j < 3; ++j) {
      shapes_[at(k, 3 * r + j, shape_width)] = rows[static_cast<std::size_t>(r)][j] / sixfold;
    }
  }
  shapes_[at(k, 9, shape_width)] = sixfold / Number(6);
}

template <class Number> void MeshElements<Number>::find_places(Index n) {
  first_.assign(static_cast<std::size_t>(n) + 1, 0);
  for (Index k = 0; k < size(); ++k) {
    for (Index c = 0; c < 4; ++c) ++first_[static_cast<std::size_t>(particle(k, c)) + 1];
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) first_[i + 1] += first_[i];
  places_.resize(static_cast<std::size_t>(size()) * 4);
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (Index k = 0; k < size(); ++k) {
    for (Index c = 0; c < 4; ++c) {
      const Index slot = c == 0 ? 3 : c - 1;
      places_[next[static_cast<std::size_t>(particle(k, c))]++] =
          static_cast<std::uint32_t>(at(k, 3 * slot, slot_width));
    }
  }
}

template class MeshElements<double>;
template class MeshElements<Quad>;

}  // namespace noether::detail
