#pragma once
/// The monitor of pressure.

#include "engine/monitor.hpp"
#include "engine/statistics.hpp"

#include <array>
#include <string>
#include <vector>

namespace noether {

/// The pressure tensor of a periodic box from velocities and the virial, sum x (x) f [pressure].
template <class Real> Mat3<Real> pressure_tensor(const ParticleSystem<Real>& s, const Mat3<Real>& virial);

/// Watches the pressure of a periodic box and its tensor,
///
///     P_ab = (sum_i m_i v_ia v_ib + W_ab) / V,   W = sum x (x) f,   P = (P_xx + P_yy + P_zz) / 3
///
/// W has the forces of constraints too: for rigid molecules P is that of their centres. Velocities are taken as they
/// are, as LAMMPS takes them: where the centre of mass is at rest, sum m v^2 is (3 N - 3) k_B T with the temperature of
/// 3 N - 3 degrees of freedom; where it moves, its motion counts.
/// @throws Error  when attached to a run without a periodic box, or with a force or a constraint that tells no virial
/// @cost O(n) and one force evaluation, shared with the next kick
/// @source Allen2017
class Pressure {
 public:
  static constexpr bool needs_particles = true;

  static constexpr auto describe() {
    return part<Pressure>(
        "pressure", "pressure of a periodic box and its tensor, from velocities and the virial of the forces",
        formula("P_ab = (sum_i m_i v_ia v_ib + W_ab) / V,  W = sum x (x) f;  value = (P_xx + P_yy + P_zz) / 3"),
        quantities("value, tensor[3][3] [pressure]"), source("Allen2017"), state<&Pressure::now_>("now"),
        state<&Pressure::values_>("values"), state<&Pressure::unit_>("unit"),
        state<&Pressure::slope_unit_>("slope_unit"), state<&Pressure::in_bar_>("in_bar"));
  }

  /// @throws Error  in open space
  template <class Real> void check(const ParticleSystem<Real>& s) const { check_box(s.box()); }

  static Request wanted() { return {.virial = true}; }
  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;
  /// At the last look [pressure].
  double value() const { return (now_[0] + now_[4] + now_[8]) / 3; }
  /// At the last look, row by row [pressure].
  const std::array<double, 9>& tensor() const { return now_; }
  /// Mean of all looks [pressure].
  double mean() const { return values_.mean(); }

 private:
  static void check_box(const Box& box);

  std::array<double, 9> now_{};
  SeriesStatistics values_;
  std::string unit_, slope_unit_;
  double in_bar_ = 0;  ///< of one unit of pressure; 0 in the reduced system
};

namespace detail {  // compiled once, in pressure.cpp

extern template struct MonitorModel<Pressure, double>;
extern template struct MonitorModel<Pressure, Quad>;

}  // namespace detail

}  // namespace noether
