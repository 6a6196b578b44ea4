#include "scene/block.hpp"

#include "engine/mesh.hpp"
#include "scene/builder_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

namespace noether {

namespace {

/// Numbers of the corners of a box of cells, the last axis first.
class BlockGrid {
 public:
  explicit BlockGrid(const std::vector<std::int64_t>& cells) : cells_{cells[0], cells[1], cells[2]} {}

  Index size() const { return (cells_[0] + 1) * (cells_[1] + 1) * (cells_[2] + 1); }
  Index number(const std::array<std::int64_t, 3>& corner) const {
    return (corner[0] * (cells_[1] + 1) + corner[1]) * (cells_[2] + 1) + corner[2];
  }
  std::int64_t cells(std::size_t axis) const { return cells_[axis]; }
  template <class Visit> void for_each_corner(const Visit& visit) const { walk(1, visit); }
  template <class Visit> void for_each_cell(const Visit& visit) const { walk(0, visit); }

 private:
  template <class Visit> void walk(std::int64_t more, const Visit& visit) const {
    for (std::int64_t i = 0; i < cells_[0] + more; ++i) {
      for (std::int64_t j = 0; j < cells_[1] + more; ++j) {
        for (std::int64_t k = 0; k < cells_[2] + more; ++k) visit(std::array<std::int64_t, 3>{i, j, k});
      }
    }
  }
  std::array<std::int64_t, 3> cells_;
};

/// The six tetrahedra of a cell: one for each way from its lowest corner to its highest along three edges.
void add_cell(Mesh& mesh, const BlockGrid& grid, const std::array<std::int64_t, 3>& lowest) {
  std::array<std::size_t, 3> axes = {0, 1, 2};
  do {
    std::array<std::int64_t, 3> corner = lowest;
    BondedTerm<4> element;
    element.particles[0] = grid.number(corner);
    for (std::size_t step = 0; step < 3; ++step) {
      ++corner[axes[step]];
      element.particles[step + 1] = grid.number(corner);
    }
    mesh.tetrahedra.push_back(element);
  } while (std::next_permutation(axes.begin(), axes.end()));
}

/// The two triangles of a square on the surface, as its tetrahedron has them, anticlockwise as seen from outside.
void add_square(Mesh& mesh, const BlockGrid& grid, std::array<std::int64_t, 3> lowest, std::size_t axis, bool high) {
  const std::size_t first = (axis + 1) % 3, second = (axis + 2) % 3;
  const int type = static_cast<int>(2 * axis) + (high ? 1 : 0);
  if (high) ++lowest[axis];
  std::array<std::int64_t, 3> along = lowest, across = lowest, far = lowest;
  ++along[first];
  ++across[second];
  ++far[first];
  ++far[second];
  const Index a = grid.number(lowest), b = grid.number(along), c = grid.number(far), d = grid.number(across);
  for (BondedTerm<3> triangle : {BondedTerm<3>{{a, b, c}, type}, BondedTerm<3>{{a, c, d}, type}}) {
    if (!high) std::swap(triangle.particles[1], triangle.particles[2]);
    mesh.triangles.push_back(triangle);
  }
}

Mesh mesh_of(const Block& block, const BlockGrid& grid) {
  Mesh mesh;
  grid.for_each_corner([&](const std::array<std::int64_t, 3>& corner) {
    Vec3<double> place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double part = static_cast<double>(corner[axis]) / static_cast<double>(grid.cells(axis));
      place[static_cast<Index>(axis)] = (part - 0.5) * block.size[axis];
    }
    mesh.rest.push_back(place);
  });
  grid.for_each_cell([&](const std::array<std::int64_t, 3>& cell) {
    add_cell(mesh, grid, cell);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (cell[axis] == 0) add_square(mesh, grid, cell, axis, false);
      if (cell[axis] + 1 == grid.cells(axis)) add_square(mesh, grid, cell, axis, true);
    }
  });
  mesh.turn_outside_in();
  mesh.regions = {"block"};
  mesh.surfaces = {"x_low", "x_high", "y_low", "y_high", "z_low", "z_high"};
  return mesh;
}

/// Where a point of the box at rest is at the start, from the centre.
Vec3<double> start_of(const Block& block, const Vec3<double>& rest) {
  Vec3<double> x;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    x[static_cast<Index>(axis)] = rest[static_cast<Index>(axis)] * block.stretch[axis];
  }
  if (block.bend == 0) return x;
  const double radius = block.size[0] * block.stretch[0] / block.bend, angle = x[0] / radius, out = radius - x[2];
  return Vec3<double>(out * std::sin(angle), x[1], radius - out * std::cos(angle));
}

Vec3<double> vector_of(const std::array<double, 3>& v) { return Vec3<double>(v[0], v[1], v[2]); }

}  // namespace

void Block::check() const {
  if (cells.size() != 3) {
    refuse_field("cells", fmt::format("[{}]", fmt::join(cells, ", ")), "is not three numbers, along x, y and z");
  }
  for (const std::int64_t one : cells) detail::check_count("cells", one, 1, detail::most_built / 6);
  const double all = static_cast<double>(cells[0]) * static_cast<double>(cells[1]) * static_cast<double>(cells[2]);
  if (all > static_cast<double>(detail::most_built / 6)) {
    refuse_field("cells", fmt::format("[{}]", fmt::join(cells, ", ")),
                 fmt::format("are {:.0f} cells; at most {} are expected", all, detail::most_built / 6));
  }
  for (const double edge : size) {
    if (!(edge > 0)) refuse_field("size", size, "has an edge that is not above 0; three lengths above 0 are expected");
  }
  detail::check_above_zero("density", density, "density");
  for (const double factor : stretch) {
    if (!(factor > 0)) refuse_field("stretch", stretch, "turns the box inside out; three factors above 0 are expected");
  }
  const double radius = bend == 0 ? 0 : size[0] * stretch[0] / std::abs(bend);
  if (bend != 0 && !(radius > size[2] * stretch[2] / 2)) {
    refuse_field("bend", bend, "bends the box so far that its inside is turned out; a smaller angle is expected");
  }
}

ParticleSystem<double> Block::build(const UnitSystem& units) const {
  check();
  const BlockGrid grid(cells);
  auto mesh = std::make_shared<Mesh>(mesh_of(*this, grid));
  const std::vector<double> masses = mesh->lumped_masses({density});
  ParticleSystem<double> s(units);
  grid.for_each_corner([&](const std::array<std::int64_t, 3>& corner) {
    const auto at = static_cast<std::size_t>(grid.number(corner));
    const Vec3<double> x = start_of(*this, mesh->rest[at]);
    const Vec3<double> v = vector_of(velocity) + cross(vector_of(angular_velocity), x);
    s.add(fmt::format("node_{}_{}_{}", corner[0], corner[1], corner[2]), masses[at], x + vector_of(center), v);
  });
  s.trim();
  std::vector<std::int64_t> ids(static_cast<std::size_t>(s.size()));
  std::iota(ids.begin(), ids.end(), 1);
  s.restore_ids(ids);
  auto topology = std::make_shared<Topology>();
  topology->mesh = std::move(mesh);
  s.set_topology(std::move(topology));
  return s;
}

}  // namespace noether
