#pragma once
/// The monitors of conserved quantities: energy, momentum, angular momentum, centre of mass.

#include "engine/monitor.hpp"
#include "engine/statistics.hpp"
#include "numbers/double_double.hpp"

#include <string>
#include <vector>

namespace noether {

struct WideSums;

/// Watches the energy: total, kinetic, potential and the relative error
///
///     (E - E0) / max(|E0|, 1e-3 (T0 + |U0|))
///
/// `worst()` and `rms()` are of the relative error, `slope()` its drift per time with an error from block means. A run
/// that is dissipative or driven has an energy, but no error of it: these figures stay empty, with the reason. Where a
/// bath counts the heat that it gives, E is the energy less that heat, which is conserved, in all figures but `total`.
/// @cost O(n) and one force evaluation, shared with the next kick
class Energy {
 public:
  static constexpr auto describe() {
    return part<Energy>(
        "energy", "total energy and its relative error", formula("(E - E0) / max(|E0|, 1e-3 (T0 + |U0|))"),
        source("HairerLubichWanner2006"),
        quantities(
            "total, kinetic, potential [energy], relative_error [1]; with a bath that counts its heat: conserved "
            "[energy]"),
        state<&Energy::begun_>("begun"), state<&Energy::reference_>("reference"), state<&Energy::scale_>("scale"),
        state<&Energy::first_>("first"), state<&Energy::now_>("now"), state<&Energy::finite_>("finite"),
        state<&Energy::errors_>("errors"), state<&Energy::why_not_>("why_not"), state<&Energy::time_unit_>("time_unit"),
        state<&Energy::atoms_>("atoms"), state<&Energy::freedom_>("freedom"),
        state<&Energy::kinetic_sum_>("kinetic_sum"));
  }

  static Request wanted() { return {.energy = true}; }
  /// What errors are measured from: the start, where a list of times looks later; else the first look.
  template <class Real> void at_start(const Snapshot<Real>& start);
  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  std::optional<double> scale() const { return scale_; }
  MonitorReport report() const;

  /// Largest relative error so far; NaN where the energy is not conserved by the equations themselves.
  double worst() const { return why_not_.empty() ? errors_.worst() : std::numeric_limits<double>::quiet_NaN(); }
  double rms() const { return why_not_.empty() ? errors_.rms() : std::numeric_limits<double>::quiet_NaN(); }
  /// Drift of the relative error [1/time]; 0 before two samples.
  double slope() const { return errors_.slope().value_or(0); }
  /// Total energy at the last look [energy].
  double total() const { return now_[0]; }
  /// The same less the heat that a bath has given, where it counts it [energy].
  double conserved() const { return now_[0] - heat_; }

  void save(SavedState& saved, const std::string& prefix) const;
  void load(const SavedState& saved, const std::string& prefix);

 private:
  /// The drift in the terms of molecular dynamics, with its error from 20 blocks on; not of other runs, nor before two
  /// samples.
  void fill_drift(MonitorReport& report) const;

  bool begun_ = false;
  Quad reference_ = 0;
  double scale_ = 0, first_ = 0;
  std::array<double, 4> now_{};  ///< total, kinetic, potential, relative error
  bool finite_ = true;           ///< every total so far
  SeriesStatistics errors_;
  std::string why_not_, time_unit_;
  std::int64_t atoms_ = 0;    ///< particles with mass in a run of molecules; else 0
  std::int64_t freedom_ = 0;  ///< degrees of freedom; 0 in reduced units, where energies are told by themselves
  double kinetic_sum_ = 0;    ///< over all looks [energy]
  bool counts_heat_ = false;  ///< a bath does
  double heat_ = 0;           ///< given until the last look [energy]
};

/// Watches a vector that the flow keeps: its value and the relative error |value - value0| / scale.
class VectorInvariant {
 public:
  std::vector<Series> series() const;
  std::optional<double> scale() const { return scale_; }
  MonitorReport report() const;
  /// Largest relative error so far.
  double worst() const { return errors_.worst(); }
  double slope() const { return errors_.slope().value_or(0); }
  const std::array<double, 3>& value() const { return value_; }
  /// Largest angle between value and value0 [rad]; 0 where the vector is too short to have a direction.
  double worst_direction() const { return worst_direction_; }

 protected:
  VectorInvariant(std::string dimension, bool with_direction)
      : dimension_(std::move(dimension)), with_direction_(with_direction) {}
  bool begun() const { return begun_; }
  /// The first value. @param scale  what errors are relative to; @param kept  by the equations of motion themselves
  void begin(const Vec3<Quad>& value, const Quad& scale, bool kept);
  void add(double time, const WideSums& value);
  void add(double time, const Vec3<Quad>& value);
  void save_series(SavedState& saved, const std::string& prefix) const;
  void load_series(const SavedState& saved, const std::string& prefix);
  std::string time_unit_;

 private:
  void refer_to(const Vec3<Quad>& reference);
  /// @param change  of the value since the start
  void add_change(double time, const Vec3<double>& change);
  /// Angle between value and value0 [rad]; NaN where there is none.
  double direction_error() const;
  /// Whether the vector is long enough, beside its scale, to have a direction.
  bool has_direction() const { return with_direction_ && length_ > 1e-6 * scale_; }

  std::string dimension_;
  bool with_direction_;
  bool begun_ = false, kept_ = true;
  Vec3<Quad> reference_ = Vec3<Quad>::Zero();
  std::array<DoubleDouble, 3> near_reference_{};  ///< the same, for runs in doubles
  double length_ = 0, inverse_length_ = 0;        ///< of the reference
  Vec3<double> unit_ = Vec3<double>::Zero();      ///< its direction
  double scale_ = 0, inverse_scale_ = 0, error_ = 0;
  double sine2_ = 0, cosine_ = 1;  ///< of the angle between value and value0: the sine squared, and the cosine
  double worst_tangent2_ = 0, worst_direction_ = 0;
  std::array<double, 3> value_{};
  SeriesStatistics errors_;
};

/// Linear momentum P = sum m v; relative to sum m |v| at the start.
class Momentum : public VectorInvariant {
 public:
  Momentum() : VectorInvariant("mass length/time", false) {}
  static constexpr bool needs_particles = true;

  static constexpr auto describe() {
    return part<Momentum>("momentum", "linear momentum and its relative error",
                          formula("P = sum m_i v_i, error relative to sum m_i |v_i|"),
                          quantities("value[3] [mass length/time], relative_error [1]"),
                          source("HairerLubichWanner2006"));
  }
  /// What errors are measured from: the start, where a list of times looks later; else the first look.
  template <class Real> void at_start(const Snapshot<Real>& start);
  template <class Real> void observe(const Snapshot<Real>& now);
  void save(SavedState& saved, const std::string& prefix) const { save_series(saved, prefix); }
  void load(const SavedState& saved, const std::string& prefix) { load_series(saved, prefix); }
};

/// Angular momentum L = sum m x cross v about the origin, its direction; relative to sum m |x| |v| at the start.
class AngularMomentum : public VectorInvariant {
 public:
  AngularMomentum() : VectorInvariant("mass length^2/time", true) {}
  static constexpr bool needs_particles = true;

  static constexpr auto describe() {
    return part<AngularMomentum>("angular_momentum", "angular momentum, its relative error and its direction",
                                 formula("L = sum m_i x_i cross v_i, error relative to sum m_i |x_i| |v_i|"),
                                 quantities("value[3] [mass length^2/time], relative_error, direction_error [1]"),
                                 source("HairerLubichWanner2006"));
  }
  /// What errors are measured from: the start, where a list of times looks later; else the first look.
  template <class Real> void at_start(const Snapshot<Real>& start);
  template <class Real> void observe(const Snapshot<Real>& now);
  void save(SavedState& saved, const std::string& prefix) const { save_series(saved, prefix); }
  void load(const SavedState& saved, const std::string& prefix) { load_series(saved, prefix); }
};

/// Position and velocity of the centre of mass; `worst()` is how far it has left its straight line [length].
class CenterOfMass {
 public:
  static constexpr bool needs_particles = true;

  static constexpr auto describe() {
    return part<CenterOfMass>("center_of_mass", "position and velocity of the centre of mass",
                              formula("X = sum m_i x_i / sum m_i;  worst: largest |X(t) - X(0) - t V(0)|"),
                              quantities("position[3] [length], velocity[3] [length/time]"),
                              source("HairerLubichWanner2006"));
  }
  /// What errors are measured from: the start, where a list of times looks later; else the first look.
  template <class Real> void at_start(const Snapshot<Real>& start);
  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;
  double worst() const { return departures_.worst(); }
  void save(SavedState& saved, const std::string& prefix) const;
  void load(const SavedState& saved, const std::string& prefix);

 private:
  void refer_to_start();

  bool begun_ = false;
  std::array<Quad, 6> start_{};               ///< sum m x, sum m v at the start [mass length, mass length/time]
  std::array<DoubleDouble, 6> near_start_{};  ///< the same, for runs in doubles
  double start_time_ = 0;
  std::array<double, 6> moments_{};  ///< the same sums at the last look
  double mass_ = 0;
  SeriesStatistics departures_;
  std::string slope_unit_;
};

namespace detail {  // compiled once, in monitors.cpp

extern template struct MonitorModel<Energy, double>;
extern template struct MonitorModel<Energy, Quad>;
extern template struct MonitorModel<Momentum, double>;
extern template struct MonitorModel<Momentum, Quad>;
extern template struct MonitorModel<AngularMomentum, double>;
extern template struct MonitorModel<AngularMomentum, Quad>;
extern template struct MonitorModel<CenterOfMass, double>;
extern template struct MonitorModel<CenterOfMass, Quad>;

}  // namespace detail

}  // namespace noether
