#pragma once
/// The monitor of the shadow Hamiltonian: the energy that a symplectic method itself keeps.

#include "engine/bodies.hpp"
#include "engine/monitor.hpp"
#include "engine/statistics.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace noether {

/// (-1)^(b-a+1) C(k,a) C(k,b), a whole number: b - a times the weight of w(y_(n-a), y_(n-b)) in h C(2k,k) H_[2k].
double shadow_weight(std::int64_t k, std::int64_t a, std::int64_t b);

/// Watches the shadow Hamiltonian of a symplectic run to several orders 2k at once.
///
/// A symplectic method of step h follows, up to exponentially small terms, the exact flow of a Hamiltonian H_h of its
/// own. From the states of k + 1 steps in a row and the action between them
///
///     H_[2k] = 1/(h C(2k,k)) sum_{0<=a<b<=k} (-1)^(b-a+1) C(k,a) C(k,b)/(b-a) w(y_(n-a), y_(n-b))  =  H_h + O(h^2k)
///     w(y', y) = (q' - q) . (p' + p) - 2 S(y -> y'),   S = int p dq - H dt
///
/// (docs/theory/shadow.md). The value belongs to the middle of the k + 1 steps. It is orders of magnitude flatter than
/// the energy, so errors that hide in the energy's oscillation show: too large a step, loose constraints, a force that
/// is no gradient. Only differences of positions enter: no reference, no loss far from the origin. Of a system with
/// coordinates and momenta, q and p are its variables; of charges in magnetic fields p is m v + q A.
/// @cost k inner products of length 3 n a step, the energy of every kick; 6 n (k + 1) numbers. At a cadence longer than
///       k + 1 steps it looks at k + 1 steps in a row each time, and costs nothing between
/// @source SkeelHardy2001, EngleSkeelDrees2005
template <class Real = double> class ShadowHamiltonian {
 public:
  /// The orders 2k, ascending: even numbers from 2 to 40.
  std::vector<std::int64_t> orders = {4, 8, 12, 16, 20, 24};

  ShadowHamiltonian() = default;
  explicit ShadowHamiltonian(std::vector<std::int64_t> wanted_orders) : orders(std::move(wanted_orders)) { check(); }

  static constexpr auto describe() {
    return part<ShadowHamiltonian>(
        "shadow_hamiltonian", "the energy that a symplectic method itself conserves, to several orders",
        formula("H_[2k] = 1/(h C(2k,k)) sum (-1)^(b-a+1) C(k,a) C(k,b)/(b-a) w(y_(n-a), y_(n-b)),  "
                "w(y', y) = (q' - q).(p' + p) - 2 S"),
        source("SkeelHardy2001, EngleSkeelDrees2005"),
        quantities("value[K] [energy], fluctuation[K] [1], one for each order"),
        field<&ShadowHamiltonian::orders>("orders", "1", "even numbers, ascending, up to 40"));
  }

  /// @throws Error  for orders that are no even numbers from 2 to 40 in ascending order
  void check() const;

  static Request wanted() { return {.energy = true, .action = true}; }
  std::int64_t steps_in_a_row() const { return orders.back() / 2 + 1; }
  /// What it costs beside the run, in words, with so many coordinates.
  std::string cost(Index coordinates, std::int64_t cadence) const;
  void observe(const Snapshot<Real>& now);
  void forget() { points_.clear(); }

  std::vector<Series> series() const;
  std::optional<double> scale() const { return scale_; }
  MonitorReport report() const;
  /// @throws Error  if parts of the saved state do not fit
  void save(SavedState& saved, const std::string& prefix) const;
  void load(const SavedState& saved, const std::string& prefix);

  /// H_[2k] at the last look, one for each order [energy]; empty before the first k + 1 steps.
  const std::vector<Real>& values() const { return values_; }
  /// Root mean square about the mean, relative to the energy's scale, of the order at `at` in `orders`.
  double fluctuation(std::size_t at) const;
  /// Index of the order that fluctuates least.
  std::size_t best() const;
  /// Drift of the best order, relative to the energy's scale [1/time]; 0 before two samples.
  double slope() const { return samples_ == 0 ? 0 : figures_[best()].errors.slope().value_or(0); }
  /// What the fluctuations say about the run, in words.
  std::string verdict() const;

 private:
  /// One step of the window.
  struct Point {
    std::int64_t step = 0;
    VectorColumn<Real> x, v, x_low;
    RowColumn<Real, 4> turn, twist;  ///< of bodies: orientations q and their momenta 2 (0, S) q; else empty
    std::vector<Real> variables;     ///< of a system: q, then p; else empty
    Real action = Real(0);           ///< from the point before to this one
    std::vector<Real> products;      ///< w(this, the point m steps before) at m - 1
  };
  /// H_[2k] of one order over the whole run, as differences to its first value.
  struct Figures {
    Real first = Real(0), mean = Real(0), squares = Real(0);
    SeriesStatistics errors;  ///< relative to the energy's scale
  };

  const Point& aged(std::int64_t age) const { return points_[points_.size() - 1 - static_cast<std::size_t>(age)]; }
  void append(const Snapshot<Real>& now);
  Real difference(const Point& older, const Point& newer, const ScalarColumn<Real>& masses, const Real& action) const;
  void lay_out_weights();
  Real value(std::size_t at, const Real& h) const;
  void take(double time);
  std::vector<Real> turns() const;
  void load_turns(const std::vector<Real>& turns);
  void load_variables(const std::vector<Real>& values);
  void load_points(const std::vector<std::int64_t>& shape, const std::vector<Real>& numbers);
  void begin(const Snapshot<Real>& now);
  double rounding() const;
  void compare_force_and_energy(const Snapshot<Real>& now);

  std::vector<std::vector<Real>> weights_;  ///< of each order, by distance b - a from 1 on, then by a
  std::vector<Point> points_;               ///< oldest first
  std::vector<Real> values_;
  std::vector<Figures> figures_;
  std::int64_t samples_ = 0, first_step_ = 0;
  Real settling_ = Real(0);  ///< action of the flows that completed the last point
  double scale_ = 0;
  double noise_ = 0;           ///< what rounding alone does to a value, relative to the scale
  double wear_ = 0;            ///< what rounding does to the run, relative to the scale, times the root of the steps
  double gradient_error_ = 0;  ///< largest difference seen between force and gradient of the energy, relative
  double constraint_tolerance_ = 0;  ///< what a solver of constraints leaves on purpose, relative
  std::string time_unit_;
};

extern template class ShadowHamiltonian<double>;
extern template class ShadowHamiltonian<Quad>;

namespace detail {  // compiled once, in shadow_hamiltonian.cpp

extern template struct MonitorModel<ShadowHamiltonian<double>, double>;
extern template struct MonitorModel<ShadowHamiltonian<Quad>, Quad>;

}  // namespace detail

}  // namespace noether
