#pragma once
/// Classical methods of fixed steps over eight systems at once.

#include "integrators/lane_field.hpp"
#include "integrators/lane_run.hpp"
#include "integrators/method.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace noether {

/// A method as `Method`, of steps of one length, for q'' = a(t, q, v) of eight systems side by side, and of the small
/// changes that its field carries: y = (q, v), shape (2 n, 8), n the size of the field.
///
/// No lane takes anything from another one. Where lanes need different numbers of iterations, those that are done wait,
/// and what they hold stays. A system has the same bits with changes beside it and without.
class LaneMethod {
 public:
  virtual ~LaneMethod() = default;
  /// What it remembers from step to step beside y, of shapes (., 8): sized by `begin`.
  virtual std::vector<LaneNumbers*> memory() { return {}; }
  /// What it remembers of a change of one lane becomes longer by a power of 2, as the change does.
  virtual void scale_change(std::size_t /*lane*/, std::size_t /*change*/, double /*factor*/) {}
  /// Whether it goes on from earlier steps, as changes of a state do not: none go along then.
  virtual bool goes_on_from_steps() const { return false; }
  /// Before the first step, of length h, from y(t).
  virtual void begin(LaneField& f, double t, double h, const LaneNumbers& y) = 0;
  /// Goes from y(t) to y(t + h) in place, h always that of `begin`.
  /// @return why it could not, in one lane at least; failures of the field are told there
  virtual std::optional<Failure> step(LaneField& f, double t, LaneNumbers& y) = 0;
};

/// What a method is in lanes; null for one that has none, and for steps of the method's own choice.
std::unique_ptr<LaneMethod> method_in_lanes(const MethodChoice& choice);

/// Eight runs at once, by a method over systems under forces.
/// @param like  one of the systems; all have its size and its ids
/// @throws Error  for forces that have no lanes, or cannot act on these particles
std::unique_ptr<LaneRun> run_in_lanes(std::unique_ptr<LaneMethod> method, ForceField<double> forces,
                                      const ParticleSystem<double>& like, const Clock<double>& clock);

namespace lane_methods {
// The families, each in a file of its own; null for a method of another one.
std::unique_ptr<LaneMethod> runge_kutta(const MethodChoice& choice);
std::unique_ptr<LaneMethod> nystrom(const MethodChoice& choice);
std::unique_ptr<LaneMethod> collocation(const MethodChoice& choice);
std::unique_ptr<LaneMethod> multistep(const MethodChoice& choice);
}  // namespace lane_methods

}  // namespace noether
