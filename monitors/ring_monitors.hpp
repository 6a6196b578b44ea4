#pragma once
/// Monitors of a patch of a ring: how its particles move about the shear, how full it is, what it transports, and its
/// wakes.

#include "engine/monitor.hpp"
#include "engine/statistics.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace noether {

struct ForceClaims;

/// Watches the velocities of particles about the shear of a sheet, all alike whatever their masses:
///
///     c_k^2 = <(u_k - <u_k>)^2>,   u = (v_x, v_y + 3 Omega x/2, v_z),   value^2 = c_x^2 + c_y^2 + c_z^2
///
/// @cost O(n), no force evaluation
/// @source WisdomTremaine1988
class VelocityDispersion {
 public:
  static constexpr bool needs_particles = true;

  std::optional<double> Omega = {};  ///< of the sheet [1/time]

  VelocityDispersion() = default;
  explicit VelocityDispersion(double rate) : Omega(rate) {}

  static constexpr auto describe() {
    return part<VelocityDispersion>(
        "velocity_dispersion", "velocities of the particles of a sheet about its shear",
        formula("c_k^2 = <(u_k - <u_k>)^2>,  u = (v_x, v_y + 3 Omega x/2, v_z);  value^2 = c_x^2 + c_y^2 + c_z^2"),
        quantities("value, components[3] [length/time]"), source("WisdomTremaine1988"),
        field<&VelocityDispersion::Omega>("Omega", "1/time", "angular velocity; default: that of the shearing sheet"),
        state<&VelocityDispersion::now_>("now"), state<&VelocityDispersion::values_>("values"),
        state<&VelocityDispersion::slope_unit_>("slope_unit"));
  }
  /// @throws Error  without an Omega, or for one that is not above 0
  void check() const;

  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;
  /// At the last look [length/time].
  double value() const;
  const std::array<double, 3>& components() const { return now_; }
  /// Mean of all looks [length/time].
  double mean() const { return values_.mean(); }

 private:
  std::array<double, 3> now_{};
  SeriesStatistics values_;
  std::string slope_unit_;
};

/// Watches how full the middle of a layer of spheres is:
///
///     value = sum pi max(0, r_i^2 - z_i^2)/(L_x L_y)
///
/// the share of the plane z = 0 that lies inside spheres.
/// @throws Error  when attached to a run without a periodic box, or of particles without radii
/// @cost O(n), no force evaluation
/// @source WisdomTremaine1988, Salo1995
class FillingFactor {
 public:
  static constexpr bool needs_particles = true;

  static constexpr auto describe() {
    return part<FillingFactor>("filling_factor", "share of the middle plane of a sheet that lies inside spheres",
                               formula("value = sum pi max(0, r_i^2 - z_i^2)/(L_x L_y)"), quantities("value [1]"),
                               source("WisdomTremaine1988, Salo1995"), state<&FillingFactor::now_>("now"),
                               state<&FillingFactor::values_>("values"),
                               state<&FillingFactor::slope_unit_>("slope_unit"));
  }
  /// @throws Error  in open space, and without radii
  template <class Real> void check(const ParticleSystem<Real>& s) const;

  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const { return {{"value", "1", {}, {now_}}}; }
  MonitorReport report() const;
  /// At the last look.
  double value() const { return now_; }
  /// Mean of all looks.
  double mean() const { return values_.mean(); }

 private:
  double now_ = 0;
  SeriesStatistics values_;
  std::string slope_unit_;
};

/// Watches the viscosity of a sheet, the transport of momentum along y outwards along x, in its three parts:
///
///     nu = 2/(3 Omega M) (sum_i m_i v_x u_y + d/dt sum of contacts dx dp_y + sum_{i<j} dx F_y),   u_y = v_y + 3 Omega
///     x/2
///
/// carried by particles (local), at contacts from centre to centre (since the look before), and by the pull through the
/// nine nearest images of each pair, dx outwards, dp_y and F_y on the outer one. The mass is that of all.
/// @throws Error  when attached to a run without a periodic box
/// @cost O(n); with a G O(9 n^2)
/// @source WisdomTremaine1988, Daisaka2001
class Viscosity {
 public:
  static constexpr bool needs_particles = true;

  std::optional<double> Omega = {};      ///< of the sheet [1/time]
  std::optional<double> G = {};          ///< [length^3/mass/time^2]; none: no gravitational part
  std::optional<double> softening = {};  ///< of gravity [length]; none: 0

  Viscosity() = default;
  explicit Viscosity(double rate, std::optional<double> constant = {}, std::optional<double> softened = {})
      : Omega(rate), G(constant), softening(softened) {}

  static constexpr auto describe() {
    return part<Viscosity>(
        "viscosity", "transport of momentum outwards in a sheet: by particles, at contacts, by gravity",
        formula("nu = 2/(3 Omega M) (sum m v_x u_y + d/dt sum dx dp_y of contacts + sum_{i<j} dx F_y),  u_y = v_y + 3 "
                "Omega x/2"),
        quantities("value, local, collisional, gravitational [length^2/time]"),
        source("WisdomTremaine1988, Daisaka2001"),
        field<&Viscosity::Omega>("Omega", "1/time", "angular velocity; default: that of the shearing sheet"),
        field<&Viscosity::G>("G", "length^3/mass/time^2",
                             "default: of the gravity that acts; without: no part by gravity"),
        field<&Viscosity::softening>("softening", "length", "default: of the gravity that acts"),
        state<&Viscosity::now_>("now"), state<&Viscosity::looked_>("looked"), state<&Viscosity::carried_>("carried"),
        state<&Viscosity::last_time_>("last_time"), state<&Viscosity::values_>("values"),
        state<&Viscosity::parts_>("parts"), state<&Viscosity::slope_unit_>("slope_unit"));
  }
  /// @throws Error  without an Omega, for an Omega or a G that is not above 0, or a negative softening
  void check() const;
  /// Takes G and the softening from what attracts all pairs, where they are not given.
  void watch(const ForceClaims& gravity);
  /// @throws Error  in open space, and without mass
  template <class Real> void check(const ParticleSystem<Real>& s) const;

  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;
  void forget() { looked_ = false; }
  /// At the last look, in three parts [length^2/time]; that of contacts is not a number at the first look.
  double local() const { return now_[0]; }
  double collisional() const { return now_[1]; }
  double gravitational() const { return now_[2]; }
  double value() const { return now_[0] + now_[1] + now_[2]; }
  /// Means of all looks but the first, in three parts [length^2/time].
  std::array<double, 3> means() const;

 private:
  std::array<double, 3> now_{};
  bool looked_ = false;
  double carried_ = 0, last_time_ = 0;  ///< of the contacts, at the look before
  SeriesStatistics values_;
  std::array<double, 3> parts_{};  ///< sums of all looks but the first
  std::string slope_unit_;
};

/// Watches the wakes of a sheet: waves of its surface density, longer than a shortest one, that its box has room for at
/// this time,
///
///     P(k) = |sum m_j exp(- i k.x_j)|^2/M^2 - sum m_j^2/M^2,   k = ((2 pi p + k_y S)/L_x, 2 pi q/L_y)
///
/// with S the length by which images have slid: the power spectrum without that of as many particles at random.
/// `contrast` is the root of the sum of all P but that of k = 0, the rms of the surface density about its mean, in
/// units of it, as far as waves of this length make it. `pitch` is the angle between the crests and the y axis,
/// positive where they trail, of the waves as P weights them: that of the mean of (k_x^2 - k_y^2, 2 k_x k_y)/k^2.
/// @throws Error  when attached to a run without a periodic box
/// @cost O(n) for each wave, of which there are 2 pi L_x L_y/shortest^2
/// @source Salo1995
class Wakes {
 public:
  static constexpr bool needs_particles = true;

  std::optional<double> Omega = {};  ///< of the sheet [1/time]
  double shortest = 0;               ///< wave that counts [length]

  Wakes() = default;
  Wakes(double rate, double length) : Omega(rate), shortest(length) {}

  static constexpr auto describe() {
    return part<Wakes>(
        "wakes", "contrast and pitch of the waves of the surface density of a sheet",
        formula("P(k) = |sum m_j exp(- i k.x_j)|^2/M^2 - sum m_j^2/M^2;  contrast^2 = sum P;  tan(2 pitch) = sum P 2 "
                "k_x k_y/k^2 / sum P (k_x^2 - k_y^2)/k^2"),
        quantities("contrast [1], pitch [angle]"), source("Salo1995"),
        field<&Wakes::Omega>("Omega", "1/time", "angular velocity; default: that of the shearing sheet"),
        field<&Wakes::shortest>("shortest", "length", "shortest wave that counts").required("\"20 m\""),
        state<&Wakes::contrast_>("contrast"), state<&Wakes::pitch_>("pitch"), state<&Wakes::values_>("values"),
        state<&Wakes::pitches_>("pitches"), state<&Wakes::slope_unit_>("slope_unit"));
  }
  /// @throws Error  without an Omega, or for an Omega or a length that is not above 0
  void check() const;
  /// @throws Error  in open space, and for more than 100 000 waves
  template <class Real> void check(const ParticleSystem<Real>& s) const;

  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;
  /// At the last look; 0 where there is less structure than at random.
  double contrast() const { return contrast_; }
  /// At the last look [radian], from - pi/2 to pi/2; not a number without contrast.
  double pitch() const { return pitch_; }

 private:
  double contrast_ = 0, pitch_ = 0;
  SeriesStatistics values_, pitches_;
  std::string slope_unit_;
};

namespace detail {  // compiled once, in ring_monitors.cpp

extern template struct MonitorModel<VelocityDispersion, double>;
extern template struct MonitorModel<VelocityDispersion, Quad>;
extern template struct MonitorModel<FillingFactor, double>;
extern template struct MonitorModel<FillingFactor, Quad>;
extern template struct MonitorModel<Viscosity, double>;
extern template struct MonitorModel<Viscosity, Quad>;
extern template struct MonitorModel<Wakes, double>;
extern template struct MonitorModel<Wakes, Quad>;

}  // namespace detail

}  // namespace noether
