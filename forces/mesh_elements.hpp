#pragma once
/// The tetrahedra of a mesh, ready to be evaluated: shapes at rest, and where each particle takes part.

#include "engine/column.hpp"
#include "engine/topology.hpp"
#include "numbers/dual.hpp"
#include "numbers/real.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace noether::detail {

/// The number type in which a mesh at rest is known where forces are computed in `Real`: doubles or Quad.
template <class Real> struct AtRest { using type = std::conditional_t<std::is_same_v<Real, Quad>, Quad, double>; };
template <class Real, std::size_t n> struct AtRest<Dual<Real, n>> : AtRest<Real> {};

/// Tetrahedra of one region, in groups of eight, and for each particle its places among their forces.
///
/// Forces of an element k stand in slots: those on its particles 1, 2, 3 and 0 as 12 numbers, eight elements side by
/// side. Particles sum their slots in the order of elements, so that no thread changes a bit.
/// @cost of memory, for each tetrahedron: 80 bytes of shape, 16 of particles, 16 of places; of a thread, 96 of slots
template <class Number> class MeshElements {
 public:
  static constexpr Index group = 8;         ///< elements side by side
  static constexpr Index shape_width = 10;  ///< the inverse of (X1 - X0, X2 - X0, X3 - X0) row by row, and the volume
  static constexpr Index slot_width = 12;   ///< x, y, z of particle 1, of 2, of 3, of 0

  /// @param n  number of particles
  /// @param region  only tetrahedra of this one; empty: all
  /// @throws Error  without a mesh, for a region that is not there, flat elements and particles that are not there
  MeshElements(std::shared_ptr<const Topology> topology, Index n, const std::string& region);

  /// Whether these are the elements of that region of that topology and so many particles.
  bool belong_to(const Topology* topology, Index n, const std::string& region) const {
    return topology == origin_.get() && n == particles() && region == region_;
  }

  Index particles() const { return static_cast<Index>(first_.size()) - 1; }
  Index size() const { return static_cast<Index>(number_.size()); }
  /// Elements with those that fill the last group: copies of the first one without volume.
  Index padded() const { return (size() + group - 1) / group * group; }
  /// Number of element k within the mesh, with those of other regions.
  Index number(Index k) const { return number_[static_cast<std::size_t>(k)]; }

  /// Particle `corner` of element k.
  Index particle(Index k, Index corner) const { return corners_[at(k, corner, 4)]; }
  const Number& shape(Index k, Index which) const { return shapes_[at(k, which, shape_width)]; }
  const std::int32_t* corners() const { return corners_.data(); }  ///< shape (padded/8, 4, 8)
  const Number* shapes() const { return shapes_.data(); }          ///< shape (padded/8, 10, 8)
  /// Where number `which` of element k stands among so many of each.
  static std::size_t at(Index k, Index which, Index width) {
    return static_cast<std::size_t>((k / group * width + which) * group + k % group);
  }

  /// Where x of each force on particle i stands among the slots, from first()[i] to first()[i + 1].
  const std::uint32_t* first() const { return first_.data(); }
  const std::uint32_t* places() const { return places_.data(); }

 private:
  /// Puts the shape of element `of` in the place of element k.
  void add_shape(Index k, Index of);
  void find_places(Index n);

  std::shared_ptr<const Topology> origin_;
  std::string region_;
  std::vector<std::int32_t> corners_, number_;
  AlignedVector<Number> shapes_;
  std::vector<std::uint32_t> first_, places_;
};

extern template class MeshElements<double>;
extern template class MeshElements<Quad>;

/// The elements of the last topology that a force has seen, in doubles and in Quad.
class KnownElements {
 public:
  /// @throws Error  as those of `MeshElements` at their first call for a topology
  template <class Number>
  const MeshElements<Number>& of(const std::shared_ptr<const Topology>& topology, Index n,
                                 const std::string& region) const {
    std::shared_ptr<const MeshElements<Number>>& known = kept<Number>();
    if (known == nullptr || !known->belong_to(topology.get(), n, region)) {
      known = std::make_shared<const MeshElements<Number>>(topology, n, region);
    }
    return *known;
  }

 private:
  template <class Number> std::shared_ptr<const MeshElements<Number>>& kept() const {
    if constexpr (std::is_same_v<Number, Quad>) {
      return wide_;
    } else {
      return narrow_;
    }
  }
  mutable std::shared_ptr<const MeshElements<double>> narrow_;
  mutable std::shared_ptr<const MeshElements<Quad>> wide_;
};

}  // namespace noether::detail
