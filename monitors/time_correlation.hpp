#pragma once
/// The monitors of diffusion: mean square displacement and velocity autocorrelation.

#include "engine/monitor.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// Averages over particles and origins of time of something that two moments of a particle give.
///
/// A look is an origin when its number is a multiple of `origins`; it is followed for `length` looks, then it has a
/// diffusion coefficient and is forgotten. The error of their mean counts origins whose spans of time overlap as the
/// number of spans side by side; there is one from 5 spans on.
/// @source Allen2017
class TimeCorrelation {
 public:
  std::int64_t length = 100;            ///< longest lag, in looks
  std::int64_t origins = 10;            ///< looks from one origin to the next
  std::vector<std::string> types = {};  ///< of the particles that are averaged over; empty: all

  TimeCorrelation() = default;
  explicit TimeCorrelation(std::int64_t longest, std::int64_t between = 10, std::vector<std::string> of = {})
      : length(longest), origins(between), types(std::move(of)) {}

  static constexpr bool needs_particles = true;
  static constexpr bool needs_equal_intervals = true;

  /// @throws Error  for a length below 2, more than a million, or origins below 1
  void check() const;
  /// @throws Error  for a type that is not there
  template <class Real> void check(const ParticleSystem<Real>& s) const { check_types(s.topology()); }
  /// Particles have been edited: what began before is not followed any further.
  void forget();
  /// @throws Error if parts of the saved state do not fit
  void check_loaded() const;

  /// Averages by lag, shape (length + 1); NaN for lags that no origin has reached.
  std::vector<double> values() const { return averages(sums_); }
  /// Times from the origins on, shape (length + 1) [time].
  std::vector<double> lags() const { return averages(times_); }
  /// Mean over the origins that have been followed to the end [length^2/time]; empty before the first.
  std::optional<double> diffusion_coefficient() const;
  /// Standard error of that mean; empty below 5 spans.
  std::optional<double> diffusion_error() const;

 protected:
  /// What is averaged, and how D follows from it.
  enum class Kind : std::uint8_t {
    displacement,  ///< |r(t) - r(0)|^2; D is a sixth of its slope from half of the longest lag on
    velocity,      ///< v(0) . v(t); D is a third of its integral
  };

  /// Takes a moment: positions or velocities of the particles about the centre of mass, shape (n, 3).
  void look(double time, const std::vector<double>& now, Kind kind);
  /// What is chosen of a state, about the centre of mass, shape (n, 3).
  template <class Real> std::vector<double> chosen(const ParticleSystem<Real>& s, Kind kind) const;
  std::string diffusion_note(const char* from) const;
  /// Series of lags and averages, and D.
  std::vector<Series> table(const char* dimension) const;
  static double average(const std::vector<double>& now, const double* then, Kind kind);

  // Of the origins that are being followed, in order.
  std::vector<std::int64_t> begun_;     ///< numbers of their looks
  std::vector<double> begun_at_;        ///< [time]
  std::vector<double> held_;            ///< what was there, shape (origins, n, 3)
  std::vector<double> fits_;            ///< running sums of each, shape (origins, 5)
  std::vector<double> sums_, times_;    ///< of values and of times, by lag
  std::vector<std::int64_t> counts_;    ///< by lag
  std::int64_t looks_ = 0, ended_ = 0;  ///< looks, and origins followed to the end
  double mean_ = 0, squares_ = 0;       ///< of their coefficients, and squares about the mean
  std::string unit_, slope_unit_;       ///< of D with a blank before, and of a slope

 private:
  void check_types(const Topology* topology) const;
  std::vector<double> averages(const std::vector<double>& sums) const;
  void begin_origin(double time, const std::vector<double>& now);
  void follow(std::size_t origin, double t, double value, std::int64_t lag, Kind kind);
  void end_origin(Kind kind);
};

/// Watches the mean square displacement
///
///     msd(t) = < |r_i(t0 + t) - r_i(t0)|^2 >,   D = slope / 6
///
/// of unwrapped positions about the centre of mass, averaged over particles and origins t0, and that since the first
/// look. D is from a straight line through the second half of the lags of each origin, its error from their scatter.
/// @cost O(n length / origins) a look, and as much memory
/// @source Allen2017
class MeanSquareDisplacement : public TimeCorrelation {
 public:
  using TimeCorrelation::TimeCorrelation;
  static constexpr auto describe() {
    using Self = MeanSquareDisplacement;
    return part<Self>(
        "mean_square_displacement", "mean square displacement by lag, and the diffusion coefficient of its slope",
        formula("msd(t) = < |r_i(t0 + t) - r_i(t0)|^2 >, unwrapped, about the center of mass;  D = slope / 6"),
        quantities("lag[length + 1] [time], value[length + 1], since_start [length^2], diffusion_coefficient "
                   "[length^2/time]"),
        source("Allen2017"), field<&Self::length>("length", "1", "longest lag, in samples"),
        field<&Self::origins>("origins", "1", "samples from one time origin to the next"),
        field<&Self::types>("types", "1", "types of the particles that are averaged over; default: all"),
        state<&Self::begun_>("begun"), state<&Self::begun_at_>("begun_at"), state<&Self::held_>("held"),
        state<&Self::fits_>("fits"), state<&Self::sums_>("sums"), state<&Self::times_>("times"),
        state<&Self::counts_>("counts"), state<&Self::looks_>("looks"), state<&Self::ended_>("ended"),
        state<&Self::mean_>("mean"), state<&Self::squares_>("squares"), state<&Self::unit_>("unit"),
        state<&Self::slope_unit_>("slope_unit"), state<&Self::start_>("start"),
        state<&Self::since_start_>("since_start"));
  }

  template <class Real> void at_start(const Snapshot<Real>& start);
  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;
  void forget();
  void load(const SavedState& saved, const std::string& prefix);
  /// From the start (after an edit, the next look) to the last look [length^2].
  double since_start() const { return since_start_; }

 private:
  std::vector<double> start_;  ///< what since_start is from, shape (n, 3)
  double since_start_ = 0;
};

/// Watches the velocity autocorrelation
///
///     C(t) = < v_i(t0) . v_i(t0 + t) >,   D = integral from 0 to the longest lag of C(t) dt / 3
///
/// of velocities about that of the centre of mass, averaged over particles and origins t0. The integral is by
/// trapezoids from look to look, its error from the scatter of the origins: look often enough, and to a lag where C has
/// died out.
/// @cost O(n length / origins) a look, and as much memory
/// @source Allen2017
class VelocityAutocorrelation : public TimeCorrelation {
 public:
  using TimeCorrelation::TimeCorrelation;
  static constexpr auto describe() {
    using Self = VelocityAutocorrelation;
    return part<Self>(
        "velocity_autocorrelation", "velocity autocorrelation by lag, and the diffusion coefficient of its integral",
        formula("C(t) = < v_i(t0) . v_i(t0 + t) > about the center of mass;  D = integral of C(t) dt / 3"),
        quantities("lag[length + 1] [time], value[length + 1] [length^2/time^2], diffusion_coefficient "
                   "[length^2/time]"),
        source("Allen2017"), field<&Self::length>("length", "1", "longest lag, in samples"),
        field<&Self::origins>("origins", "1", "samples from one time origin to the next"),
        field<&Self::types>("types", "1", "types of the particles that are averaged over; default: all"),
        state<&Self::begun_>("begun"), state<&Self::begun_at_>("begun_at"), state<&Self::held_>("held"),
        state<&Self::fits_>("fits"), state<&Self::sums_>("sums"), state<&Self::times_>("times"),
        state<&Self::counts_>("counts"), state<&Self::looks_>("looks"), state<&Self::ended_>("ended"),
        state<&Self::mean_>("mean"), state<&Self::squares_>("squares"), state<&Self::unit_>("unit"),
        state<&Self::slope_unit_>("slope_unit"));
  }

  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const { return table("length^2/time^2"); }
  MonitorReport report() const;
  void load(const SavedState& saved, const std::string& prefix);
};

namespace detail {  // compiled once, in time_correlation.cpp

extern template struct MonitorModel<MeanSquareDisplacement, double>;
extern template struct MonitorModel<MeanSquareDisplacement, Quad>;
extern template struct MonitorModel<VelocityAutocorrelation, double>;
extern template struct MonitorModel<VelocityAutocorrelation, Quad>;

}  // namespace detail

}  // namespace noether
