#pragma once
/// Eight systems of one make side by side, members of an ensemble, under a splitting method.

#include "engine/concepts.hpp"
#include "forces/sum.hpp"
#include "integrators/composition_options.hpp"
#include "integrators/lane_run.hpp"
#include "integrators/scheme.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace noether {

/// A flow that is to be, as `SystemLanes::flow` has it.
struct LaneFlow {
  char letter;
  double h, time;
};

/// The states of eight systems, and the flows of the Hamiltonian that they have in common but for masses.
///
/// What becomes of a lane depends on what was put into it, and on nothing else: no flow carries anything from one lane
/// to another. Between `show()` and `go_on()` flows move a copy, which can be taken; `keep()` keeps a state that
/// `go_back()` returns to.
class SystemLanes {
 public:
  static constexpr std::size_t lanes = 8;

  virtual ~SystemLanes() = default;
  virtual std::string name() const = 0;
  virtual HamiltonianClaims claims() const = 0;

  /// Puts inertial particles into a lane.
  virtual void put(std::size_t lane, const ParticleSystem<double>& s) = 0;
  /// Gives particles the inertial positions and velocities of a lane of the copy.
  virtual void take(std::size_t lane, ParticleSystem<double>& s) const = 0;
  /// A lane becomes a copy of another one, in the run.
  virtual void copy_lane(std::size_t from, std::size_t to) = 0;

  virtual void show() = 0;
  virtual void go_on() = 0;
  virtual void keep() = 0;
  virtual void go_back() = 0;

  virtual void flow(char letter, double h, double time) = 0;
  /// v *= factor for every particle, as drag does.
  virtual void scale_velocities(double factor) = 0;

  /// From now on small changes of each system go along with the flows of the run, by their derivatives; of length 0
  /// until they are put.
  /// @throws Error  naming a force that has no derivative
  virtual void carry(std::size_t changes) = 0;
  /// @param c  of inertial positions and velocities, laid out as a state of `TangentFlow`; before the run has begun
  virtual void put_change(std::size_t lane, std::size_t change, const double* c) = 0;
  virtual void scale_change(std::size_t lane, std::size_t change, double factor) = 0;
  /// |dx|^2 and |dv|^2 of a change where some flows would lead it from here, in inertial coordinates; shape (2, 8).
  virtual void measure(std::span<const LaneFlow> ahead, std::size_t change, double* squares) = 0;

  /// Why a flow of the run could not be done since `go_back()`, in one lane at least; the first time tells.
  virtual const std::optional<Failure>& failure() const = 0;
};

/// Systems under forces that depend on positions and time: p^2/2m + U.
/// @param like  one of them; all have its size and its ids
/// @param compensated  whether what rounding takes from sums is kept
/// @throws Error  for forces that have no lanes, or cannot act on these particles
std::unique_ptr<SystemLanes> systems_under_forces(const ForceField<double>& forces, const ParticleSystem<double>& like,
                                                  bool compensated);

/// The same systems with linear drag as the letter D (`Damped`).
/// @param rate  v' = - rate v [1/time]
std::unique_ptr<SystemLanes> with_drag(std::unique_ptr<SystemLanes> systems, double rate);

/// Eight runs at once by a splitting method over systems in lanes, and changes that go along.
class SplittingLanes final : public LaneRun {
 public:
  /// @throws SchemeMismatch
  SplittingLanes(std::unique_ptr<SystemLanes> systems, const Scheme& scheme, const CompositionOptions& options,
                 const Clock<double>& clock);
  ~SplittingLanes() override;
  SplittingLanes(const SplittingLanes&) = delete;
  SplittingLanes& operator=(const SplittingLanes&) = delete;
  SplittingLanes(SplittingLanes&&) noexcept;

  std::int64_t step() const override;
  void put(std::size_t lane, const ParticleSystem<double>& s) override { systems_->put(lane, s); }
  void copy_lane(std::size_t from, std::size_t to) override { systems_->copy_lane(from, to); }
  void carry(std::size_t changes) override { systems_->carry(changes); }
  void follow(std::size_t lane, std::size_t change, std::shared_ptr<LaneChange> by) override;
  void forget(std::size_t lane) override;
  bool advance(std::int64_t steps) override;
  const std::optional<Failure>& failure() const override { return systems_->failure(); }
  void settle() override;
  void take(std::size_t lane, ParticleSystem<double>& s) const override;
  void keep() override;
  void go_back() override;

 private:
  struct Walk;
  void measure(bool due);
  std::unique_ptr<SystemLanes> systems_;
  std::unique_ptr<Walk> walk_;
};

}  // namespace noether
