#pragma once
/// The monitor of what a symmetry of a system keeps, by Noether's theorem.

#include "engine/monitor.hpp"
#include "engine/statistics.hpp"
#include "engine/symmetry.hpp"

#include <concepts>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// Watches the momentum J = p . xi(q) of a symmetry q -> q + epsilon xi(q) of a system with coordinates and momenta.
///
///     J- = -D1 L_d(q0, q1) . xi(q0),   J+ = D2 L_d(q0, q1) . xi(q1)
///
/// are those of one step: the momentum that it begins with, and the one that it ends with. They are equal where the
/// discrete Lagrangian has the symmetry. It looks at two steps in a row, however long its cadence is.
///
/// `worst()` is the largest error of J relative to the start, `worst_step()` the largest |J+ - J-| of a step, to the
/// same scale.
/// @cost one generator
/// @source MarsdenWest2001
class MomentumMap {
 public:
  std::string symmetry;  ///< by name; empty: the first one

  MomentumMap() = default;
  /// Of a system that has `symmetries()`.
  template <class S>
    requires requires(const S& system) { system.symmetries(); }
  explicit MomentumMap(const S& system, std::string name = "") : symmetry(std::move(name)) {
    watch(system.symmetries());
  }

  static constexpr auto describe() {
    return part<MomentumMap>(
        "momentum_map", "the momentum that a symmetry of the system keeps, before and after a step",
        formula("J = p . xi(q); J- = -D1 L_d . xi(q0), J+ = D2 L_d . xi(q1)"),
        quantities("minus, plus, of the last step [1], relative_error [1]"), source("MarsdenWest2001"),
        field<&MomentumMap::symmetry>("symmetry", "1", "name of the symmetry; default: the first of the system"),
        state<&MomentumMap::begun_>("begun"), state<&MomentumMap::reference_>("reference"),
        state<&MomentumMap::scale_>("scale"), state<&MomentumMap::minus_>("minus"), state<&MomentumMap::plus_>("plus"),
        state<&MomentumMap::step_>("step"), state<&MomentumMap::worst_step_>("worst_step"),
        state<&MomentumMap::errors_>("errors"), state<&MomentumMap::time_unit_>("time_unit"));
  }

  /// What there is to watch; scenes take it from their system.
  void watch(std::vector<Symmetry> known) { known_ = std::move(known); }
  /// @throws Error  for a run of particles, a system without symmetries, and a name that none has
  template <class Real> void check(const ParticleSystem<Real>& s) const {
    static_cast<void>(chosen(static_cast<std::size_t>(s.variables().size())));
  }
  static std::int64_t steps_in_a_row() { return 2; }
  template <class Real> void observe(const Snapshot<Real>& now);
  void forget() { step_ = -1; }
  std::vector<Series> series() const;
  std::optional<double> scale() const { return scale_; }
  MonitorReport report() const;

  double worst() const { return errors_.worst(); }
  double worst_step() const { return worst_step_; }
  double last() const { return plus_; }

 private:
  const Symmetry& chosen(std::size_t variables) const;

  std::vector<Symmetry> known_;
  bool begun_ = false;
  double reference_ = 0, scale_ = 0;
  double minus_ = 0, plus_ = 0;
  std::int64_t step_ = -1;  ///< of the last look
  double worst_step_ = 0;
  SeriesStatistics errors_;
  std::string time_unit_;
};

namespace detail {  // compiled once, in momentum_map.cpp

extern template struct MonitorModel<MomentumMap, double>;
extern template struct MonitorModel<MomentumMap, Quad>;

}  // namespace detail

}  // namespace noether
