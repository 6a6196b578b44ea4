#pragma once
/// Forces on the surfaces of bodies that deform.

#include "engine/any_force.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "engine/mesh.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace noether {

namespace detail {

/// The corners of a surface, with their shares of its area, of the last topology that a force has seen.
class KnownSurface {
 public:
  struct Corner {
    Index particle;
    double area;  ///< a third of the triangles about it [length^2]
  };
  /// @param n  number of particles
  /// @throws Error  without a mesh, without that surface, or for a mesh of other particles
  const std::vector<Corner>& of(const std::shared_ptr<const Topology>& topology, Index n,
                                const std::string& surface) const;

 private:
  mutable std::shared_ptr<const Topology> topology_;
  mutable std::string surface_;
  mutable std::vector<Corner> corners_;
};

}  // namespace detail

/// A surface of a mesh is pulled, with a force per area at rest that keeps its direction while the body turns.
///
///     U = - sum over its triangles A t . (x_1 + x_2 + x_3)/3
///
/// Each corner gets a third of the force on a triangle. What pulls is outside, so the momentum is not kept, and there
/// is no virial.
/// @cost O(corners of the surface)
struct Traction {
  std::string surface = {};                    ///< by its name in the mesh
  std::array<double, 3> traction = {0, 0, 0};  ///< t [pressure]
  detail::KnownSurface known = {};             ///< what has been found of the mesh: nothing to be given

  static constexpr auto describe() {
    return part<Traction>("traction", "a force per area on a surface of a mesh",
                          formula("U = - sum over triangles A t . (x_1 + x_2 + x_3)/3"),
                          field<&Traction::surface>("surface", "1", "the surface, by its name").required("\"x_high\""),
                          field<&Traction::traction>("traction", "pressure", "t, force per area at rest, as [x, y, z]")
                              .required("[\"1 Pa\", \"0 Pa\", \"0 Pa\"]"));
  }
  static ForceClaims claims() {
    return {.virial = false,
            .keeps_momentum = false,
            .keeps_angular_momentum = false,
            .meshed = true,
            .charges = false,
            .exclusions = false,
            .tangent = TangentPattern::sparse};
  }
  /// @throws Error  without a mesh, or without this surface
  template <class Real> void check(const ParticleSystem<Real>& s) const {
    known.of(s.shared_topology(), s.size(), surface);
  }

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const Vec3<Real> t = {Real(traction[0]), Real(traction[1]), Real(traction[2])};
    for (const auto& [i, area] : known.of(s.shared_topology(), s.size(), surface)) {
      const Vec3<Real> force = Real(area) * t;
      out.force(i, force);
      if (out.wants_energy() && s.masses()[i] != Real(0)) out.energy(-dot(force, s.positions()[i]));
    }
  }
  /// Its secants between two states: the force itself.
  template <class Real>
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& /*from*/, const ParticleSystem<Real>& to) const {
    add_to(out, to);
  }
};

namespace detail {  // compiled once, in traction.cpp

extern template struct ForceModel<Traction, double>;
extern template struct ForceModel<Traction, Quad>;

}  // namespace detail

}  // namespace noether
