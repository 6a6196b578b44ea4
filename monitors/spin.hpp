#pragma once
/// The monitor of how a rigid body turns.

#include "engine/monitor.hpp"
#include "engine/statistics.hpp"

#include <array>
#include <string>
#include <vector>

namespace noether {

/// Watches one rigid body: its spin in space and in its principal axes, its rate, how far its orientation has come from
/// unit length, and, where it has an orbit, its obliquity and the angle of a resonance of spin and orbit.
///
///     value[3] = S,   in_body[3] = Pi = R^T S,   rate[3] = Pi_k/I_k,   energy = sum Pi_k^2/2 I_k
///     obliquity = the angle of S and of the angular momentum of the orbit about `about`
///     angle = theta - (p/q) M in [-pi/2, pi/2): theta from the pericenter to the axis of the smallest moment, which
///     has no front, in the plane of the orbit, M the mean anomaly, p : q the `resonance`
///
/// @cost O(1), no force evaluation
/// @source GoldreichPeale1966
class Spin {
 public:
  std::string body = {};                         ///< its name; default: the first that turns
  std::string about = {};                        ///< name of the body that it goes round; default: the first other one
  std::vector<std::int64_t> resonance = {1, 1};  ///< p, q: turns in q orbits
  std::optional<double> G = {};                  ///< [length^3/mass/time^2]; default: the unit system's own

  Spin() = default;
  explicit Spin(std::string name) : body(std::move(name)) {}

  static constexpr bool needs_particles = true;

  static constexpr auto describe() {
    return part<Spin>(
        "spin", "how a rigid body turns: spin, rate, energy, obliquity, the angle of a resonance with its orbit",
        formula("Pi = R^T S,  rate_k = Pi_k/I_k;  angle = theta - (p/q) M, modulo pi"),
        quantities("value[3] [mass length^2/time], in_body[3] [mass length^2/time], rate[3] [1/time], energy [energy], "
                   "defect [1], obliquity [angle], angle [angle]"),
        source("GoldreichPeale1966"),
        field<&Spin::body>("body", "1", "name of the body; default: the first that turns"),
        field<&Spin::about>("about", "1", "name of the body that it goes round; default: the first other one"),
        field<&Spin::resonance>("resonance", "1", "p, q: turns in q orbits, for the angle of the resonance"),
        field<&Spin::G>("G", "length^3/mass/time^2", "default: the unit system's own"),
        state<&Spin::samples_>("samples"), state<&Spin::rates_>("rates"), state<&Spin::worst_defect_>("worst_defect"),
        state<&Spin::name_>("name"), state<&Spin::slope_unit_>("slope_unit"));
  }

  /// @throws Error  for a resonance that is not of two whole numbers, the second 1 or 2
  void check() const;
  /// @throws Error  for a body that is not there or does not turn
  template <class Real> void check(const ParticleSystem<Real>& s) const;

  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;

  /// At the last look.
  const std::array<double, 3>& value() const { return value_; }
  const std::array<double, 3>& in_body() const { return in_body_; }
  const std::array<double, 3>& rate() const { return rate_; }
  double energy() const { return energy_; }
  /// |q|^2 - 1, and the largest so far.
  double defect() const { return defect_; }
  double worst_defect() const { return worst_defect_; }
  /// NaN without an orbit.
  double obliquity() const { return obliquity_; }
  double angle() const { return angle_; }

 private:
  template <class Real> Index body_of(const ParticleSystem<Real>& s) const;
  template <class Real> Index center_of(const ParticleSystem<Real>& s, Index of) const;
  template <class Real> void look_at_orbit(const ParticleSystem<Real>& s, Index of);

  std::array<double, 3> value_{}, in_body_{}, rate_{};
  double energy_ = 0, defect_ = 0, worst_defect_ = 0;
  double obliquity_ = 0, angle_ = 0;
  std::int64_t samples_ = 0;
  SeriesStatistics rates_;  ///< of the length of the rate [1/time]
  std::string name_, slope_unit_;
};

namespace detail {  // compiled once, in spin.cpp

extern template struct MonitorModel<Spin, double>;
extern template struct MonitorModel<Spin, Quad>;

}  // namespace detail

}  // namespace noether
