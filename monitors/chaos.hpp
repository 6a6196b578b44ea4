#pragma once
/// The monitors of chaos: MEGNO and Lyapunov exponents.

#include "engine/monitor.hpp"
#include "engine/tangent_flow.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// Sums of the mean exponential growth factor of nearby orbits, after steps of one length h at t = n h:
///
///     Y(t) = 2/t int_0^t t' d ln|c(t')|,   <Y>(t) = 1/t int_0^t Y dt'
///
/// `Real` may be eight systems side by side.
/// @source CincottaSimo2000
template <class Real> struct MegnoSums {
  Real weighted = Real(0);  ///< sum of n ln(|c_n|/|c_{n-1}|), each at the middle of its step
  Real value = Real(0);     ///< Y
  Real integral = Real(0);  ///< of Y by the trapezoidal rule, in steps
  std::int64_t steps = 0;

  /// @param growth  of ln |c| in one more step
  void add(const Real& growth) {
    weighted += growth * Real(static_cast<double>(steps) + 0.5);
    ++steps;
    const Real next = weighted * Real(2.0 / static_cast<double>(steps));
    integral += (value + next) * Real(0.5);
    value = next;
  }
  /// <Y>
  Real mean() const { return steps == 0 ? Real(0) : integral * Real(1.0 / static_cast<double>(steps)); }
};

/// Small changes of the state that go along with a run, and are rescaled without end: what monitors of chaos share.
///
/// From look to look the steps of the run are made once more, by the same scheme or method, with the changes beside
/// them, from the state that others see. Lengths are those of c = (dx, tau dv), tau a time.
template <class Real> class NearbyOrbits {
 public:
  /// How the changes go along; scenes take it from their Hamiltonian and integrator.
  /// @throws Error  naming what has no derivative
  void watch(const TangentFlows<Real>& flows) {
    flow_ = OwnTangentFlow<Real>(flows.make(count_));
    missing_ = false;
  }
  /// The same of a program.
  void follow_by(std::unique_ptr<TangentFlow<Real>> flow) {
    flow_ = OwnTangentFlow<Real>(std::move(flow));
    missing_ = false;
  }

 protected:
  using State = typename TangentFlow<Real>::State;
  using Changes = typename TangentFlow<Real>::Changes;

  /// Takes normal deviates for `count` changes, of length 1 and at right angles to each other.
  /// @param stride  steps at once
  void begin(const Snapshot<Real>& now, std::int64_t seed, const std::optional<double>& time_scale,
             std::int64_t stride);
  bool begun() const { return begun_; }
  /// Why changes are not followed any further; empty while they are.
  const std::string& ended() const { return ended_; }
  void end(const std::string& reason) {
    if (begun_ && ended_.empty()) ended_ = reason;
  }
  /// Goes on to this moment, a stride at once. @param grown  takes the steps, and by how much the logarithm of
  /// each length grew in them
  template <class Grown> void follow(const Snapshot<Real>& now, std::int64_t stride, const Grown& grown);
  void set_count(Index count) { count_ = count; }
  Index count() const { return count_; }
  bool missing() const { return missing_; }
  double start() const { return start_; }
  const std::string& time_unit() const { return time_unit_; }
  /// Time that changes of velocities are multiplied by [time]; 1 for systems.
  double time_scale() const { return scale_; }

  void save_changes(SavedState& saved, const std::string& prefix) const;
  void load_changes(const SavedState& saved, const std::string& prefix);

 private:
  /// Whether the flow goes along with the run itself, and has told what became of the change.
  template <class Grown> bool was_told(const Grown& grown);
  Real length(Index k) const;
  Real product(Index j, Index k) const;
  std::vector<Real> orthonormalize();

  OwnTangentFlow<Real> flow_;
  bool missing_ = true, begun_ = false;
  Index count_ = 1;
  State y_;  ///< at the last look
  Changes changes_;
  std::vector<Real> lengths_;  ///< at the last step
  std::int64_t step_ = 0;
  double start_ = 0, scale_ = 1;
  std::string ended_, time_unit_;
};

/// Watches the mean exponential growth factor of nearby orbits. For regular motion <Y> tends to 2, and for chaotic
/// motion it grows as lambda t / 2, lambda the largest Lyapunov exponent.
/// @cost the run once more with one change beside it
/// @source CincottaSimo2000
template <class Real = double> class Megno : public NearbyOrbits<Real> {
 public:
  std::int64_t seed = 1;                  ///< of the change at the start
  std::optional<double> time_scale = {};  ///< [time]

  Megno() = default;
  explicit Megno(std::unique_ptr<TangentFlow<Real>> flow) { this->follow_by(std::move(flow)); }

  static constexpr auto describe() {
    return part<Megno>(
        "megno", "mean exponential growth factor of nearby orbits: 2 for regular motion",
        formula("Y = 2/t int_0^t t' d ln|c|, <Y> = 1/t int_0^t Y dt', |c|^2 = |dx|^2 + tau^2 |dv|^2"),
        quantities("value, mean [1]"), source("CincottaSimo2000"),
        field<&Megno::seed>("seed", "1", "of the change at the start"),
        field<&Megno::time_scale>("time_scale", "time", "tau; default: rms distance over rms speed at the start"));
  }

  /// @throws Error  for a time scale that is not above 0, a seed below 0, and a run whose steps have no known
  /// derivative
  void check() const;
  template <class S> void check(const ParticleSystem<S>& /*s*/) const { check_run(); }
  void at_start(const Snapshot<Real>& start);
  void observe(const Snapshot<Real>& now);
  void forget() { this->end("the run was edited"); }
  std::vector<Series> series() const;
  MonitorReport report() const;
  std::string cost(Index coordinates, std::int64_t cadence) const;

  /// Y now, and <Y>.
  double value() const { return static_cast<double>(sums_.value); }
  double mean() const { return static_cast<double>(sums_.mean()); }

  void save(SavedState& saved, const std::string& prefix) const;
  void load(const SavedState& saved, const std::string& prefix);

 private:
  void check_run() const;

  MegnoSums<Real> sums_;
  std::int64_t samples_ = 0;
  double time_ = 0;  ///< since the start [time]
};

/// Watches the largest Lyapunov exponents, as many as changes are followed: lambda_k = 1/t ln of how the k-th axis of a
/// small ball of states has grown. Changes are made orthogonal again and again.
/// @cost the run once more with `vectors` changes beside it, and their products of each other
/// @source BenettinGalganiGiorgilliStrelcyn1980
template <class Real = double> class Lyapunov : public NearbyOrbits<Real> {
 public:
  std::int64_t vectors = 1;               ///< how many exponents
  std::int64_t seed = 1;                  ///< of the changes at the start
  std::optional<double> time_scale = {};  ///< [time]

  Lyapunov() = default;
  /// @param flow  of as many changes
  explicit Lyapunov(std::unique_ptr<TangentFlow<Real>> flow, std::int64_t exponents = 1) : vectors(exponents) {
    this->set_count(exponents);
    this->follow_by(std::move(flow));
  }

  static constexpr auto describe() {
    return part<Lyapunov>(
        "lyapunov", "largest Lyapunov exponents: how fast nearby orbits part",
        formula("lambda_k = 1/t ln(|c_k(t)|/|c_k(0)|), c_k orthogonal, |c|^2 = |dx|^2 + tau^2 |dv|^2"),
        quantities("exponent[k] [1/time]"), source("BenettinGalganiGiorgilliStrelcyn1980"),
        field<&Lyapunov::vectors>("vectors", "1", "how many exponents, the largest first"),
        field<&Lyapunov::seed>("seed", "1", "of the changes at the start"),
        field<&Lyapunov::time_scale>("time_scale", "time", "tau; default: rms distance over rms speed at the start"));
  }

  void watch(const TangentFlows<Real>& flows) {
    this->set_count(vectors);
    NearbyOrbits<Real>::watch(flows);
  }
  /// @throws Error  as of Megno; for fewer vectors than 1, or more than a state has numbers
  void check() const;
  template <class S> void check(const ParticleSystem<S>& s) const {
    const auto variables = static_cast<std::int64_t>(s.variables().size());
    check_run(variables > 0 ? variables : 6 * static_cast<std::int64_t>(s.size()));
  }
  void at_start(const Snapshot<Real>& start);
  void observe(const Snapshot<Real>& now);
  void forget() { this->end("the run was edited"); }
  std::vector<Series> series() const;
  MonitorReport report() const;
  std::string cost(Index coordinates, std::int64_t cadence) const;

  /// The exponents so far [1/time]; NaN before the first step.
  std::vector<double> exponents() const;

  void save(SavedState& saved, const std::string& prefix) const;
  void load(const SavedState& saved, const std::string& prefix);

 private:
  void check_run(std::int64_t numbers) const;
  std::int64_t stride() const;

  std::vector<Real> grown_;  ///< ln of the growth of each
  std::int64_t samples_ = 0;
  double time_ = 0;  ///< since the start [time]
};

extern template class NearbyOrbits<double>;
extern template class NearbyOrbits<Quad>;
extern template class Megno<double>;
extern template class Megno<Quad>;
extern template class Lyapunov<double>;
extern template class Lyapunov<Quad>;

namespace detail {  // compiled once, in chaos.cpp

extern template struct MonitorModel<Megno<double>, double>;
extern template struct MonitorModel<Megno<Quad>, Quad>;
extern template struct MonitorModel<Lyapunov<double>, double>;
extern template struct MonitorModel<Lyapunov<Quad>, Quad>;

}  // namespace detail

}  // namespace noether
