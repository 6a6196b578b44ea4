#include "engine/mesh.hpp"

#include "numbers/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

int number_of(std::string_view name, const std::vector<std::string>& names, const char* what) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  if (names.empty()) throw Error(fmt::format("there is no {} '{}': the mesh has none with names", what, name));
  throw Error(fmt::format("there is no {} '{}' in the mesh, which has {}", what, name, fmt::join(names, ", ")));
}

template <std::size_t n> void check_particles(const BondedTerm<n>& term, Index particles, const char* what, Index k) {
  for (const Index i : term.particles) {
    if (i >= 0 && i < particles) continue;
    throw Error(fmt::format("{} {} of the mesh names particle {}, but there are {}", what, k, i, particles));
  }
}

}  // namespace

double Mesh::sixfold_volume(const BondedTerm<4>& element) const {
  const auto place = [&](std::size_t k) { return rest[static_cast<std::size_t>(element.particles[k])]; };
  const Vec3<double> a = place(1) - place(0), b = place(2) - place(0), c = place(3) - place(0);
  return dot(a, cross(b, c));
}

double Mesh::area(const BondedTerm<3>& triangle) const {
  const auto place = [&](std::size_t k) { return rest[static_cast<std::size_t>(triangle.particles[k])]; };
  const Vec3<double> a = place(1) - place(0), b = place(2) - place(0);
  return std::sqrt(norm2(cross(a, b))) / 2;
}

int Mesh::region(std::string_view name) const { return number_of(name, regions, "region"); }
int Mesh::surface(std::string_view name) const { return number_of(name, surfaces, "surface"); }

std::vector<Index> Mesh::particles_of(int surface) const {
  std::vector<Index> all;
  for (const BondedTerm<3>& triangle : triangles) {
    if (triangle.type == surface) all.insert(all.end(), triangle.particles.begin(), triangle.particles.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

std::vector<std::pair<Index, Index>> Mesh::edges() const {
  std::vector<std::pair<Index, Index>> all;
  all.reserve(6 * tetrahedra.size());
  for (const BondedTerm<4>& element : tetrahedra) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) all.push_back(std::minmax(element.particles[a], element.particles[b]));
    }
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

std::vector<double> Mesh::lumped_masses(const std::vector<double>& densities) const {
  std::vector<double> masses(rest.size(), 0.0);
  for (const BondedTerm<4>& element : tetrahedra) {
    const double quarter = densities[static_cast<std::size_t>(element.type)] * sixfold_volume(element) / 24;
    for (const Index i : element.particles) masses[static_cast<std::size_t>(i)] += quarter;
  }
  return masses;
}

Index Mesh::turn_outside_in() {
  Index turned = 0;
  for (BondedTerm<4>& element : tetrahedra) {
    if (!(sixfold_volume(element) < 0)) continue;
    std::swap(element.particles[2], element.particles[3]);
    ++turned;
  }
  return turned;
}

void Mesh::check(Index n) const {
  if (static_cast<Index>(rest.size()) != n) {
    throw Error(fmt::format("the mesh has {} places at rest for {} particles", rest.size(), n));
  }
  Index k = 0;
  for (const BondedTerm<3>& triangle : triangles) check_particles(triangle, n, "triangle", k++);
  k = 0;
  for (const BondedTerm<4>& element : tetrahedra) {
    check_particles(element, n, "element", k);
    double longest2 = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        longest2 = std::max(longest2, norm2(Vec3<double>(rest[static_cast<std::size_t>(element.particles[a])] -
                                                         rest[static_cast<std::size_t>(element.particles[b])])));
      }
    }
    const double sixfold = sixfold_volume(element), flat = flattest_element * longest2 * std::sqrt(longest2);
    if (!(std::abs(sixfold) > flat)) {
      throw Error(
          fmt::format("element {} of the mesh is flat: its volume is {:.6g} where its longest edge is {:.6g}; "
                      "take it out or make the mesh anew",
                      k, sixfold / 6, std::sqrt(longest2)));
    }
    if (sixfold < 0) {
      throw Error(
          fmt::format("element {} of the mesh is inside out at rest: its volume is {:.6g}; exchange two of its "
                      "particles",
                      k, sixfold / 6));
    }
    ++k;
  }
}

}  // namespace noether
