#pragma once
/// A classical method: how to get from y(t) to y(t + h) when y' = f(t, y).

#include "engine/saved_state.hpp"
#include "integrators/method_options.hpp"
#include "integrators/vector_field.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// What a method says of itself; tests measure every word of it.
struct MethodClaims {
  std::string_view name;
  int order = 0;
  bool adaptive = false;
  bool symplectic = false;              ///< its map is, with fixed steps, for Hamiltonian fields
  bool reversible = false;              ///< a step of -h undoes a step of h
  bool keeps_momentum = true;           ///< where the field does
  bool keeps_angular_momentum = false;  ///< where the field does; all but energy-exact methods then every quadratic
                                        ///< invariant
  bool second_order_only = false;       ///< serves q'' = a only
  bool of_lagrangian = false;           ///< and Lagrangians, without telling an action
  bool positions_only = false;          ///< serves q'' = a(t, q) only, no velocity-dependent forces
  bool turns_only = false;              ///< of velocity-dependent forces it serves those that turn velocities alone
  bool gravity_only = false;            ///< serves masses of no size that attract each other, and what acts beside that
  bool energy_exact = false;            ///< keeps the energy of every field that it serves to rounding, at any step
  int exact_degree = 0;                 ///< keeps energies that are polynomials of at most this degree to rounding
  bool conservative_only = false;       ///< serves fields with an energy that is conserved, without velocity-dependent
                                        ///< forces of particles
  bool second_words = false;            ///< its state is `low_words` too
  bool of_momenta = false;              ///< of charges in fields it serves the motion by x and m v + q A only
};

/// A step that was made, or why none was.
struct StepResult {
  double h = 0;               ///< how far it went [time]
  std::int64_t rejected = 0;  ///< trials before it that were thrown away
  std::optional<Failure> failure = {};
};

/// One classical method over one number type.
///
/// A method of fixed steps makes exactly the step it is asked for; an adaptive one chooses its step, at most so long
/// and of the same sign: below 0 it goes back in time. The sign stays from `bind` to `bind`. What it keeps from step to
/// step (history, predictors, error controllers, rounding errors) is state: `save` and `load` carry it bit for bit.
/// `bind` forgets all of it.
template <class Real> class Method {
 public:
  virtual ~Method() = default;
  virtual std::unique_ptr<Method> clone() const = 0;
  virtual MethodClaims claims() const = 0;
  /// Sizes work arrays for `f` and forgets the past: `step` allocates nothing afterwards.
  /// @throws SchemeMismatch  if the method cannot serve the field
  virtual void bind(const VectorField<Real>& f) = 0;

  /// Adaptive methods: the step that `step` will try next if it is asked for `h` [time].
  virtual double next_step(VectorField<Real>& /*f*/, const Real& /*t*/, const Vector<Real>& /*y*/, double /*h*/) {
    throw LogicError("a method of fixed steps has no step of its own");
  }
  /// Goes from y(t) to y(t + h) in place. On failure y and the method's state are void.
  virtual StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) = 0;

  /// What it goes on from beside y, where that is moved between two steps. Most remember no more than guesses.
  virtual Memory memory() const { return Memory::immovable; }
  /// y was moved at time t, after a step: what is kept of the old one (rates, rounding errors, differences) becomes
  /// that of the new one; lengths of steps and earlier states stay.
  /// @throws LogicError  where memory is immovable
  virtual void moved(VectorField<Real>& /*f*/, const Real& /*t*/, const Vector<Real>& /*y*/) {
    if (memory() == Memory::immovable) throw LogicError("a state was moved under a method that does not know how");
  }

  /// Second words of y, which particles keep beside the first ones from step to step (`ParticleSystem::LowWords`); null
  /// for a method whose state is y alone, with whatever else it saves.
  virtual Vector<Real>* low_words() { return nullptr; }

  /// Whether `interpolate` knows the solution inside the last step as well as the method itself does.
  virtual bool dense() const { return false; }
  /// y at t + theta h of the last step, theta in [0, 1].
  virtual void interpolate(VectorField<Real>& /*f*/, const Real& /*theta*/, Vector<Real>& /*y*/) {
    throw LogicError("dense output was requested from a method that has none");
  }
  /// Second words of what `interpolate` told last; null for a method without `low_words`.
  virtual const Vector<Real>* interpolated_low_words() const { return nullptr; }

  /// Whether `action` knows what a step is the stationary point of: a symplectic method over particles may.
  virtual bool has_action() const { return false; }
  /// The integral of the Lagrangian over the last step, which began at y(t), as the method itself approximates it.
  /// @cost as many evaluations, not counted, as the method has stages
  virtual Real action(VectorField<Real>& /*f*/, const Real& /*t*/, const Vector<Real>& /*y*/) {
    throw LogicError("the action was requested from a method that does not compute it");
  }

  virtual void save(SavedState& saved, const std::string& prefix) const = 0;
  virtual void load(const SavedState& saved, const std::string& prefix) = 0;
};

/// What a step of a method on a Lie group takes, counted by an algebra that counts.
struct GroupWork {
  int evaluations = 0, exponentials = 0, commutators = 0;
  /// With commutators of stages combined so that each is of the highest power of h that it can be, and those beyond the
  /// order left out; -1: the method has none that could be.
  int least_commutators = -1;
};

/// A method as lists show it, and how to make one.
struct MethodInfo {
  std::string_view name;
  std::string_view aliases = "";  ///< parted by blanks
  std::string_view summary = "";
  std::string_view use = "";                       ///< what it is best for, in a few words
  std::string_view source = "";                    ///< keys of docs/references.bib
  std::string_view family = "";                    ///< "runge-kutta", "multistep", ...
  std::array<const OptionGroup*, 2> options = {};  ///< that it takes beside step and error control; the rest is null
  int order = 0;
  int evaluations = 0;                  ///< forces a fixed step, after the start; 0: it iterates, so it depends
  int printed_digits = 34;              ///< significant digits of the shortest coefficient in the source
  bool fixed = true, adaptive = false;  ///< what it can do; adaptive wins where both are possible
  bool gravity_only = false;            ///< see `MethodClaims`
  bool on_groups = false;               ///< it steps fields on Lie groups, such as rigid bodies, as such
  bool linear_only = false;             ///< it serves Y' = A(t) Y on a group of rotations only
  double rtol = 1e-6, atol = 1e-9;      ///< defaults; the second of systems of first order
  /// First h omega on the oscillator that is unstable with fixed steps; 0: every one is, infinity: none is, NaN: it
  /// does not say.
  double stability_limit = std::numeric_limits<double>::quiet_NaN();
  std::unique_ptr<Method<double>> (*make)(const MethodInfo&, const MethodOptions&) = nullptr;
  std::unique_ptr<Method<Quad>> (*make_quad)(const MethodInfo&, const MethodOptions&) = nullptr;  ///< null: double only
  GroupWork (*group_work)(const MethodInfo&, const MethodOptions&) = nullptr;  ///< of those on groups

  /// All options it takes: of error control where it can choose its steps, then others.
  std::vector<const OptionGroup*> option_groups() const;
  /// Whether it takes options of a group.
  bool takes(const OptionGroup& group) const;
  /// Options with the defaults of this method in the place of what is not said; what it does not look at is left out.
  /// (The default of atol is that of a system of first order; of particles it is 0.)
  MethodOptions resolved(const MethodOptions& options_given) const;
  /// Whether it runs with adaptive steps when asked like this.
  bool is_adaptive(const MethodOptions& options_given) const {
    return adaptive && options_given.adaptive.value_or(true);
  }
};

/// Makes a method over `Real`. @throws Error  for options it does not take, tolerances out of range, or a number type
/// it does not know
template <class Real> std::unique_ptr<Method<Real>> make_method(const MethodInfo& info, const MethodOptions& options);
template <> std::unique_ptr<Method<double>> make_method(const MethodInfo& info, const MethodOptions& options);
template <> std::unique_ptr<Method<Quad>> make_method(const MethodInfo& info, const MethodOptions& options);

/// A method and what was set of it: `method("dormand_prince_5", {.rtol = 1e-10})`.
struct MethodChoice {
  const MethodInfo* info = nullptr;
  MethodOptions options = {};

  /// See `MethodInfo::resolved`.
  MethodOptions resolved() const { return info->resolved(options); }
};

}  // namespace noether
