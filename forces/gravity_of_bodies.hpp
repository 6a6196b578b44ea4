#pragma once
/// Newtonian gravity of rigid bodies: by their moments of inertia, or by their sites.

#include "engine/any_force.hpp"
#include "engine/bodies.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

namespace noether {

/// How much of the figure of a body its gravity knows.
enum class Figure : std::uint8_t { second_degree, sites };

template <> struct EnumNames<Figure> {
  static constexpr std::array<std::pair<Figure, std::string_view>, 2> values = {
      {{Figure::second_degree, "2"}, {Figure::sites, "sites"}}};
};

/// Gravity between rigid bodies and points, with the torques on the bodies.
///
///     degree 2:   U = - sum_pairs [G m_i m_j/r + G (m_j (tr I_i - 3 n.I_i n) + m_i (tr I_j - 3 n.I_j n))/(2 r^3)]
///     sites:      U = - sum_pairs sum_{a in i, b in j} G m_a m_b/r_ab
///
/// with I_i in space. The first (MacCullagh's formula, for both bodies) leaves out what falls as r^-5; the second is
/// the full problem of bodies made of mass points. Forces are opposite to the bit, and the torques balance their
/// couples, so that the angular momentum is conserved to rounding. A tracer feels them and exerts nothing.
/// @cost O(n^2) pairs of bodies; of sites, all pairs of those
/// @source MurrayDermott1999, MacCullagh1855
struct GravityOfBodies {
  Figure degree = Figure::second_degree;
  bool point_masses = true;      ///< whether the attraction of the masses is among it
  std::optional<double> G = {};  ///< [length^3/mass/time^2]; default: the unit system's own

  static constexpr auto describe() {
    return part<GravityOfBodies>(
        "gravity_of_bodies", "Newtonian gravity of rigid bodies, with torques, by moments of inertia or by sites",
        formula("U = - sum [G m_i m_j/r + G m_j (tr I_i - 3 n.I_i n)/2r^3 + ...], or - sum G m_a m_b/r_ab"),
        source("MacCullagh1855, MurrayDermott1999"),
        field<&GravityOfBodies::degree>("degree", "1", "2: by moments of inertia, or sites"),
        field<&GravityOfBodies::point_masses>(
            "point_masses", "1", "whether masses attract each other in it; wisdom_holman has that in itself"),
        field<&GravityOfBodies::G>("G", "length^3/mass/time^2", "default: the unit system's own"));
  }
  static constexpr std::string_view masses_key = "point_masses";
  static constexpr std::string_view only_once = "so every pair would attract twice; take one of them out";

  /// @throws Error  for sites without their masses, or a G that is not above 0
  void check() const;
  /// @throws Error  for a body that a fixed point holds, and, by sites, for one that is no sphere but has one site
  template <class Real> void check(const ParticleSystem<Real>& s) const {
    check_bodies(s.bodies());
    if (degree != Figure::sites || !has_bodies(s)) return;
    for (Index i = 0; i < s.size(); ++i) {
      const BodyKind* kind = s.bodies()->kind(i);
      if (kind != nullptr && kind->sites.size() == 1 && !is_sphere(s, i)) refuse_one_site(s.name(i));
    }
  }

  /// Far from each other bodies go on Kepler orbits.
  ForceClaims claims() const {
    return {.kepler = point_masses,
            .turning_figures = true,
            .G = G,
            .on_bodies = true,
            .charges = false,
            .exclusions = false};
  }

  /// For double, Quad, eight systems side by side, and dual numbers.
  template <class Real>
    requires(std::is_same_v<Real, double> || std::is_same_v<Real, Quad> || std::is_same_v<Real, Pack> ||
             std::is_same_v<Real, Dual<double, 1>> || std::is_same_v<Real, Dual<Quad, 1>>)
  void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const;

 private:
  static void check_bodies(const Bodies* bodies);
  [[noreturn]] static void refuse_one_site(const std::string& body);
};

namespace detail {  // compiled once, in gravity_of_bodies.cpp

extern template struct ForceModel<GravityOfBodies, double>;
extern template struct ForceModel<GravityOfBodies, Quad>;

}  // namespace detail

}  // namespace noether
