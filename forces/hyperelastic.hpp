#pragma once
/// Bodies that deform: finite elements, linear tetrahedra with the mass in their corners.

#include "engine/any_force.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "engine/mesh.hpp"
#include "forces/materials.hpp"
#include "forces/mesh_elements.hpp"
#include "forces/tetrahedron_loop.hpp"
#include "numbers/parallel.hpp"

#include <string>
#include <string_view>
#include <type_traits>

namespace noether {

/// The tetrahedra of a mesh, of a material `M` (forces/materials.hpp).
///
///     U = sum over tetrahedra V W(C),  C = F^T F,  F = sum_a x_a (x) grad N_a,  f_a = -V F S grad N_a,  S = 2 dW/dC
///
/// F is constant in each: edges of the tetrahedron as they are, times the inverse of those at rest. An element that is
/// turned inside out, det F <= 0, ends the run as `inverted_element`, but for trials of an iteration that pass there.
/// The secants between two states have the forces F' S' in place of F S, with the mean F' of the two F, and
///
///     S' = S(C') + 2 [W(C1) - W(C0) - S(C') : (C1 - C0)/2] (C1 - C0) / |C1 - C0|^2,  C' = (C0 + C1)/2
///
/// whose second term is 0 for Saint-Venant and Kirchhoff: that of Simo and Tarnow. They keep energy, momentum and
/// angular momentum. One object serves one thread at a time; a copy is another object.
/// @cost O(tetrahedra); see `detail::MeshElements` for its memory
/// @source SimoTarnow1992, Gonzalez2000
template <class M> struct Hyperelastic : M {
  std::string region = {};           ///< of the mesh; empty: all tetrahedra
  detail::KnownElements known = {};  ///< what has been found of the mesh: nothing to be given

  static constexpr auto describe() {
    return part<Hyperelastic>(
        M::describe(),
        field<&Hyperelastic::region>("region", "1", "part of the mesh of this material; all of it unless given"));
  }
  static ForceClaims claims() {
    return {.meshed = true, .charges = false, .exclusions = false, .tangent = TangentPattern::sparse};
  }

  /// @throws Error  as the material does for its own fields
  void check() const {
    if constexpr (requires(const M& material) { material.check(); }) M::check();
  }
  /// @throws Error  if the particles have no mesh, or one with a flat element, or without this region
  template <class Real> void check(const ParticleSystem<Real>& s) const {
    known.template of<typename detail::AtRest<Real>::type>(s.shared_topology(), s.size(), region);
  }

  /// @throws Error  as `check`, at the first call for a topology
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    using Number = typename detail::AtRest<Real>::type;
    const auto& elements = known.template of<Number>(s.shared_topology(), s.size(), region);
    detail::TetrahedronLoop<Real, M>(*this, elements, s).add_to(out);
  }
  /// Its secants between two states, of doubles and Quad.
  template <class Real>
    requires(std::is_same_v<Real, double> || std::is_same_v<Real, Quad>)
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const {
    const auto& elements = known.template of<Real>(to.shared_topology(), to.size(), region);
    detail::TetrahedronLoop<Real, M>(*this, elements, to, &from).add_to(out);
  }
};

using HyperelasticForce = Hyperelastic<IsotropicMaterial>;

namespace detail {  // compiled once, in hyperelastic.cpp

extern template struct ForceModel<HyperelasticForce, double>;
extern template struct ForceModel<HyperelasticForce, Quad>;

}  // namespace detail

}  // namespace noether
