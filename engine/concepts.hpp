#pragma once
/// The seams of the engine as concepts: what a Hamiltonian, an integrator and a monitor must offer.

#include "engine/force_sink.hpp"
#include "engine/neighbor_options.hpp"
#include "engine/outcome.hpp"

#include <atomic>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace noether {

/// Energy of a system, in its unit system [energy].
template <class Real> struct EnergyTerms {
  Real kinetic = Real(0), potential = Real(0);
  Real heat = Real(0);  ///< that a bath has given since the start of the run, where it counts it
  Real total() const { return kinetic + potential; }
  /// What the equations of motion keep, with a bath that counts its heat too.
  Real conserved() const { return total() - heat; }
};

/// Two bodies nearer to each other than a splitting about a primary allows.
struct Encounter {
  std::int64_t first = 0, second = 0;  ///< ids
  double hill_radii = 0;               ///< the smallest distance seen, in mutual Hill radii about the primary
  double time = 0;                     ///< when it was seen
  double since = 0;                    ///< when an encounter was seen for the first time in the run
};

/// What solvers of constraints have done so far.
struct ConstraintWork {
  std::int64_t iterations = 0;  ///< or sweeps over all constraints
  std::int64_t measured = 0;    ///< of these, in position stages of which the violation before and after is known
  double log = 0;               ///< sum of ln(after / before) of these stages

  /// What one of the measured iterations leaves of the violation; 0 where none is.
  double contraction() const { return measured > 0 ? std::exp(log / static_cast<double>(measured)) : 0; }
};

/// What projections have done so far.
struct ProjectionWork {
  std::int64_t steps = 0;       ///< that were looked at
  std::int64_t iterations = 0;  ///< for all of them together; a state that is near enough takes none

  double mean() const { return steps > 0 ? static_cast<double>(iterations) / static_cast<double>(steps) : 0; }
};

/// Work done so far, counted where it is done.
struct Evaluations {
  std::int64_t force = 0, kepler = 0, jacobian = 0;
  ConstraintWork constraint = {};
  std::int64_t rejected = 0;                         ///< trial steps that an error controller threw away
  std::int64_t unsettled = 0;                        ///< steps that have errors above those that their method is for
  std::optional<NeighborStatistics> neighbors = {};  ///< of this process, where some force has a range
  std::optional<Encounter> encounter = {};           ///< the closest one that the splitting should not have met
  ProjectionWork projection = {};
};

/// What a split Hamiltonian says of its parts; tests verify it, `Composition` refuses by it.
struct HamiltonianClaims {
  std::string alphabet;           ///< letters `flow` accepts
  std::string_view inexact = "";  ///< letters whose map is symmetric of order 2 instead of the exact flow
  std::string irreversible = "";  ///< letters that only run forward (drag, noise)
  std::string_view timed = "A";   ///< letters that carry time: stages see what these have covered of a step
  std::string basic = "BAB";      ///< palindrome of order 2 that symmetric compositions are made of
  std::string kicks = "B";        ///< letters that evaluate the forces
  std::string_view kernels = "";  ///< letters of kernels only; they evaluate the forces twice
  std::string no_kernel = "";     ///< why it lacks some of these, where it knows kernels
  std::string_view lazy = "";     ///< letters whose maps are symplectic only nearly, by finite differences
  bool quadratic_kinetic = true;  ///< {B,{B,{B,A}}} = 0: Runge-Kutta-Nystroem tables keep their order
  bool symplectic = true;         ///< every flow is
  bool energy = true;             ///< every force reports its potential
  bool time_dependent = false;    ///< the energy is not conserved by the exact flow
  bool dissipative = false;
  bool counts_heat = false;  ///< dissipative, but `EnergyTerms::heat` has all of it: energy less heat is conserved
  std::string_view no_action = "";  ///< why no action tells the motion; empty: the flows give theirs
  bool columns = false;             ///< it moves columns beyond position and velocity
  bool twists = false;              ///< its kicks pass the torques of forces on to the spins of bodies
  bool turns = false;               ///< it turns rigid bodies
  std::string_view rotor = "";      ///< how it turns them
  std::uint8_t coordinates = 0;     ///< of the position and velocity columns while a run goes on; 0: inertial
  bool inertial = true;             ///< flows meet x and v as users see them, so that letters of velocities may join
  bool velocity_forces = false;     ///< its kicks take forces that depend on velocities, as symmetric maps of order 2
  bool kepler = false;              ///< two bodies alone are followed exactly, along Kepler arcs
  bool periodic = false;            ///< it knows periodic boxes
  bool neighbors = false;           ///< it looks for neighbors as `NeighborOptions` say
  bool keeps_momentum = true;
  bool keeps_angular_momentum = true;
  Index constraints = 0;            ///< degrees of freedom they take
  double constraint_tolerance = 0;  ///< relative violation that is left on purpose; 0: rounding
  std::int64_t steps_at_once = 1;   ///< where nobody looks, so many steps cost less each than one
};

/// A Hamiltonian written as parts whose flows can be computed. Parts are letters.
///
/// `flow` advances by one part's flow; `flow_with_action` does the same (bit for bit) and returns the action increment
/// of the flow, the integral of p dq - H dt, for which dS = p1 dq1 - p0 dq0. Between `observe(wanted)` and
/// `observe({})` flows serve an observer on a copy: they sum what is wanted and leave no trace in `evaluations` (what
/// the run itself needs) and `failure` (why the last flow could not be done).
///
/// A Hamiltonian may offer `Advance run(const TimedWord<Real>&, s, span)` (engine/word.hpp): a fused walk of whole
/// steps, with the bits of the letters one by one.
template <class H>
concept SplitHamiltonian = requires(H& h, const H& c, ParticleSystem<typename H::real>& s,
                                    const ParticleSystem<typename H::real>& settled, char letter,
                                    const typename H::real& tau, VectorColumn<typename H::real>& column,
                                    std::optional<Request> wanted) {
  { c.claims() } -> std::convertible_to<HamiltonianClaims>;
  h.bind(s);
  h.open(s);
  h.close(s);
  h.flow(letter, s, tau);
  { h.flow_with_action(letter, s, tau) } -> std::convertible_to<typename H::real>;
  { h.energy(settled) } -> std::convertible_to<EnergyTerms<typename H::real>>;
  h.accelerations(settled, column);
  h.observe(wanted);
  { c.evaluations() } -> std::convertible_to<Evaluations>;
  { c.failure() } -> std::convertible_to<const std::optional<Failure>&>;
};

/// What a method goes on from beside the state, where that is moved between two steps, as projections do.
enum class Memory : std::uint8_t {
  none,       ///< nothing: its steps are maps of the state, to rounding
  history,    ///< earlier states, which stay; what it keeps of the last one becomes that of the moved one
  immovable,  ///< what it remembers cannot be moved
};

/// What an integrator says of the runs it makes.
struct IntegratorClaims {
  std::string method;       ///< name of the scheme or method
  std::string hamiltonian;  ///< name of the Hamiltonian
  int order = 0;
  ClockMode clock = ClockMode::fixed;
  bool symplectic = false;
  std::string_view no_action = "";  ///< why no action tells the motion, where a part of it says so
  bool reversible = false;          ///< backward steps undo forward ones
  bool backward = false;            ///< free clock: it also goes the way of a clock whose time falls
  bool energy_exact = false;  ///< the energy is kept at any step; no symplectic method that keeps momenta can do that
  bool energy = true;         ///< an energy exists
  bool dissipative = false;
  bool counts_heat = false;  ///< dissipative, but `EnergyTerms::heat` has all of it: energy less heat is conserved
  bool time_dependent = false;
  bool keeps_momentum = true;
  bool keeps_angular_momentum = true;
  bool momentum = true, angular_momentum = true;  ///< the equations of motion keep them, whatever the method does
  Memory memory = Memory::none;
  Index constraints = 0;            ///< degrees of freedom they take
  double constraint_tolerance = 0;  ///< relative violation that is left on purpose; 0: rounding
  std::int64_t steps_at_once = 1;   ///< where nobody looks, so many steps cost less each than one
  bool variables = false;           ///< it advances the variables of a first-order system, not particles
  bool second_words = false;        ///< of settled particles they are further digits of x and v
  bool between_steps = false;       ///< fixed clock: it settles at times between two steps too
};

/// How far to go: so many steps, and with a free clock not past `limit` [time], which lies on the way of that clock.
struct Span {
  std::int64_t steps = 0;
  double limit = std::numeric_limits<double>::infinity();
  const std::atomic<bool>* stop = nullptr;  ///< looked at after every step, or after `steps_at_once` of them

  bool asked_to_stop() const { return stop != nullptr && stop->load(std::memory_order_relaxed); }
};

/// How far it went.
struct Advance {
  std::int64_t steps = 0;
  bool at_limit = false;             ///< free clock: the next whole step would pass `limit`
  const Failure* failure = nullptr;  ///< why the last step could not be done; the integrator's, until it is used again
};

/// A method that advances a system by whole steps. `settle` completes a copy for observers: the copy is inertial, and
/// with a free clock it is reached at time `at` by one shortened step, and its clock moved there without counting a
/// step; the run itself never shortens a step. With a fixed clock `at` is given to integrators alone that claim
/// `between_steps`. `bind` comes before `load` and may see working coordinates then.
///
/// A method whose steps are symplectic may offer `Advance advance_with_action(s, span, action)`: the same bits as
/// `advance`, and the action increments of its flows, the integral of p dq - H dt, added to `action`. Its `settle` then
/// returns the action of the flows that complete the copy, correctors left out, where `wanted.action` asks for it. One
/// that gives the action at times only says so by `has_action()`.
///
/// It may offer `go_on_from(now, raw)`: the state was moved a little at a whole step, and the run goes on from `now`,
/// which is settled; lengths of steps and histories stay. Others are bound anew, as after an edit.
template <class I>
concept Integrator = requires(I& i, const I& c, ParticleSystem<typename I::real>& s,
                              const ParticleSystem<typename I::real>& raw, const Span& span, Request wanted,
                              std::optional<double> at, bool corrected, VectorColumn<typename I::real>& column) {
  { c.claims() } -> std::convertible_to<IntegratorClaims>;
  i.bind(s);
  { i.advance(s, span) } -> std::convertible_to<Advance>;
  i.settle(raw, s, wanted, at, corrected);
  { i.energy(raw) } -> std::convertible_to<EnergyTerms<typename I::real>>;
  i.accelerations(raw, column);
  { c.evaluations() } -> std::convertible_to<Evaluations>;
};

}  // namespace noether
