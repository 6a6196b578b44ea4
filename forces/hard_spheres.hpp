#pragma once
/// Hard spheres: what happens where two of them touch.

#include "engine/any_force.hpp"
#include "engine/columns.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "engine/signature.hpp"
#include "engine/sphere_columns.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace noether {

/// Smooth hard spheres, with a law of restitution for the speed of approach v along the line of centres:
///
///     v' = max(epsilon(v) v, minimum_rebound),   epsilon(v) = min(1, restitution
///     (v/restitution_speed)^restitution_exponent)
///
/// The impulse along that line is equal and opposite; between two spheres without mass it is shared alike. An exponent
/// of 0 is a constant coefficient; ice of Bridges1984 has 0.32, -0.234 and 1 cm/s. Spheres that gravity or inelastic
/// contacts press together would touch infinitely often in a finite time: the minimum of the rebound ends that.
/// @source Bridges1984, Salo1995
struct HardSpheres {
  double restitution = 1;                        ///< 0 to 1
  double restitution_exponent = 0;               ///< 0 or less
  std::optional<double> restitution_speed = {};  ///< at which the coefficient is `restitution` [length/time]
  std::optional<double> minimum_rebound = {};    ///< [length/time]; default: Omega (r_i + r_j)/2000

  static constexpr auto describe() {
    return part<HardSpheres>(
        "hard_spheres", "spheres of a shearing sheet that touch and rebound: contacts within the epicycles A",
        formula(
            "v' = max(min(1, restitution (v/restitution_speed)^restitution_exponent) v, minimum_rebound)  along the "
            "line of centres"),
        source("Bridges1984, Salo1995"),
        field<&HardSpheres::restitution>("restitution", "1", "coefficient of normal restitution, 0 to 1")
            .required("0.5"),
        field<&HardSpheres::restitution_exponent>("restitution_exponent", "1",
                                                  "power of the speed of approach; -0.234 for ice of Bridges 1984"),
        field<&HardSpheres::restitution_speed>("restitution_speed", "length/time",
                                               "at which the coefficient is restitution"),
        field<&HardSpheres::minimum_rebound>("minimum_rebound", "length/time",
                                             "slowest rebound; default: Omega (r_i + r_j)/2000"));
  }
  using columns = ColumnList<BodyRadius, ContactCount, ContactTransport, ContactHeat>;
  /// Why it does not stand twice in a scene.
  static constexpr std::string_view only_once = "so every contact would be met twice; take one of them out";

  /// @throws Error  for a restitution outside 0 to 1, a positive exponent, speeds that are none
  void check() const;
  /// @throws Error  for a negative radius, and where no particle has one
  template <class Real> void check(const ParticleSystem<Real>& s) const;

  /// Whether contacts cost energy.
  bool dissipates() const { return restitution < 1 || restitution_exponent != 0; }
  /// The speed of rebound for a speed of approach, 0 or more. @param least  where `minimum_rebound` is not given
  double rebound(double approach, double least) const;
};

/// Hard spheres for methods that do not split, which cannot stop where two of them meet.
struct SphereForce {
  HardSpheres spheres;

  std::string name() const { return "hard_spheres"; }
  std::string signature() const { return detail::signature_of(spheres); }
  ForceClaims claims() const {
    return {.energy = true,
            .velocity_dependent = true,
            .dissipative = spheres.dissipates(),
            .periodic = true,
            .charges = false,
            .exclusions = false};
  }
  template <class Real> void check(const ParticleSystem<Real>& s) const { spheres.check(s); }
  /// @throws SchemeMismatch  always: rates of change know no impulses
  template <class Real> void bind(const ParticleSystem<Real>& /*s*/) const {
    throw Error(
        "hard spheres meet between two kicks, which no method for y' = f knows; use a splitting, such as "
        "'verlet_aba'");
  }
  /// Nothing: until they touch, spheres feel nothing of each other.
  template <class Real> void add_to(ForceSink<Real>& /*out*/, const ParticleSystem<Real>& /*s*/) const {}
};

/// What methods that do not split are told.
inline SphereForce as_force(const HardSpheres& spheres) { return {spheres}; }

}  // namespace noether
