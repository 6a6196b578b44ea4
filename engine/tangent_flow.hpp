#pragma once
/// Small changes of a state that move along with a run: what indicators of chaos stand on.

#include "engine/outcome.hpp"
#include "engine/particle_system.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

namespace noether {

/// The derivative of the steps of a run: states, and changes of them in the limit of small ones.
///
/// A state of particles is y = (x, v), all x, then all y, then all z, then the velocities likewise; of a system it is
/// its variables. Changes have the same layout, one in each column.
/// @source ReinTamayo2016
template <class Real> class TangentFlow {
 public:
  using State = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  using Changes = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

  virtual ~TangentFlow() = default;
  virtual std::unique_ptr<TangentFlow> clone() const = 0;
  /// Length of a state.
  virtual Index size() const = 0;
  /// The state of a run as others see it. @pre it has the particles or the variables that this was made for
  virtual void gather(const ParticleSystem<Real>& now, State& y) const = 0;
  /// Goes on from a state, where the clock of the run says.
  /// @param changes  shape (size, as many as this was made for)
  virtual void begin(const Clock<Real>& clock, const State& y, const Changes& changes) = 0;
  /// Makes so many steps. @return why it could not
  virtual std::optional<Failure> advance(std::int64_t steps) = 0;
  /// Where the steps have led.
  virtual void read(State& y, Changes& changes) = 0;

  /// Told before `begin` to flows that go along with the run itself, and so measure the only change on its way: every
  /// `stride` steps, by |c|^2 = |dx|^2 + scale^2 |dv|^2.
  virtual void measure_along(std::int64_t /*stride*/, const Real& /*scale*/) {}
  /// What such a flow has measured since `begin` or the last time, up to where the run is shown.
  /// @param grown  takes steps, and by how much ln |c| grew in them, one stride after the other
  /// @return whether it is one; else steps are to be made
  virtual bool tell_growth(const std::function<void(std::int64_t steps, const Real& growth)>& /*grown*/) {
    return false;
  }
};

/// How a monitor gets the tangent flow of its run, for as many changes as it follows.
template <class Real> struct TangentFlows {
  /// @throws Error  naming the part of the run that has no derivative
  std::function<std::unique_ptr<TangentFlow<Real>>(Index changes)> make;
};

/// A tangent flow as a member of what can be copied; null before it is made.
template <class Real> class OwnTangentFlow {
 public:
  OwnTangentFlow() = default;
  explicit OwnTangentFlow(std::unique_ptr<TangentFlow<Real>> flow) : flow_(std::move(flow)) {}
  OwnTangentFlow(const OwnTangentFlow& other) : flow_(other.flow_ ? other.flow_->clone() : nullptr) {}
  OwnTangentFlow(OwnTangentFlow&&) noexcept = default;
  OwnTangentFlow& operator=(const OwnTangentFlow& other) { return *this = OwnTangentFlow(other); }
  OwnTangentFlow& operator=(OwnTangentFlow&&) noexcept = default;
  ~OwnTangentFlow() = default;

  explicit operator bool() const { return flow_ != nullptr; }
  TangentFlow<Real>* operator->() const { return flow_.get(); }

 private:
  std::unique_ptr<TangentFlow<Real>> flow_;
};

}  // namespace noether
