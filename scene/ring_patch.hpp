#pragma once
/// The builder of a patch of a ring.

#include "engine/description.hpp"
#include "engine/particle_system.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace noether {

/// Spheres of a ring in the box of a shearing sheet at t = 0, at random places without overlaps, with random velocities
/// about the shear that add up to no momentum there.
///
/// Radii from `smallest` to `largest` are drawn from n(r) ~ r^(- exponent) until the patch has its surface density,
/// its optical depth sum pi r^2/(L_x L_y), or its number of spheres. Large ones are placed first, at heights of a
/// normal distribution as wide as the dispersion makes it, dispersion/Omega; where there is no room left the layer is
/// made thicker.
/// @source Salo1995
struct RingPatch {
  std::array<double, 3> size = {0, 0, 0};  ///< edges of the box [length]
  std::optional<double> Omega = {};        ///< of the sheet [1/time]
  double smallest = 0;                     ///< radius [length]
  std::optional<double> largest = {};      ///< radius [length]; default: all are alike
  double exponent = 3;
  double density = 0;                          ///< of the material [mass/length^3]
  std::optional<double> surface_density = {};  ///< [mass/length^2]
  std::optional<double> optical_depth = {};
  std::optional<std::int64_t> particles = {};
  std::optional<double> dispersion = {};  ///< of each component of the velocity [length/time]
  std::int64_t seed = 1;

  static constexpr auto describe() {
    return part<RingPatch>(
        "ring_patch", "spheres of a ring in the box of a shearing sheet, without overlaps",
        formula("n(r) ~ r^(-exponent);  sum (4/3) pi r^3 density = surface_density L_x L_y"), source("Salo1995"),
        field<&RingPatch::size>("size", "length", "edges of the box along x, y and z")
            .required("[\"100 m\", \"100 m\", \"100 m\"]"),
        field<&RingPatch::Omega>("Omega", "1/time", "angular velocity; default: that of the shearing sheet"),
        field<&RingPatch::smallest>("smallest", "length", "smallest radius").required("\"1 m\""),
        field<&RingPatch::largest>("largest", "length", "largest radius; default: all are alike"),
        field<&RingPatch::exponent>("exponent", "1", "power of the distribution of radii"),
        field<&RingPatch::density>("density", "density", "mass per volume of the material").required("\"400 kg/m^3\""),
        field<&RingPatch::surface_density>("surface_density", "mass/length^2", "mass per area of the patch"),
        field<&RingPatch::optical_depth>("optical_depth", "1", "area of the spheres per area of the patch, instead"),
        field<&RingPatch::particles>("particles", "1", "number of spheres, instead"),
        field<&RingPatch::dispersion>("dispersion", "length/time",
                                      "dispersion of each component of the velocity; default: Omega largest"),
        field<&RingPatch::seed>("seed", "1", "seed of radii, places and velocities"));
  }
  void check() const;
  /// @throws Error  as `check`, and where the spheres do not fit into the box
  /// @cost O(n)
  ParticleSystem<double> build(const UnitSystem& units = unit_system("reduced")) const;
};

}  // namespace noether
