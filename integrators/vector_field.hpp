#pragma once
/// Motion as the classical methods see it: y' = f(t, y), one vector and one rate.

#include "engine/concepts.hpp"
#include "engine/description.hpp"
#include "engine/sums.hpp"
#include "integrators/particle_scales.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace noether {

template <class Real> using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
template <class Real> using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

/// Where df_i/dy_j can be other than 0: for each j, the rows i, in order.
using Sparsity = std::vector<std::vector<Index>>;

/// Lanes of an evaluation in lanes: the stages of an implicit step, side by side.
inline constexpr int lane_count = 8;

/// States at several stages: variable i of stage k stands at [8 i + k].
template <class Real> struct StageStates {
  const Real* t;               ///< shape (8)
  const Real* q;               ///< y; for second order its first half, positions; shape (n, 8)
  const Real* v = nullptr;     ///< velocities, where the field depends on them; shape (n, 8)
  int stages = lane_count;     ///< that count; lanes beyond them hold the state of the first
  bool second_order = false;   ///< q are positions
  std::uint8_t wanted = 0xff;  ///< a bit for each stage; of the others `out` holds the rates from the call before

  /// Gives n variables in lanes beyond the stages the rates of the first stage, whose state these hold.
  void fill_lanes(Index n, Real* rates) const {
    if (stages == lane_count) return;
    for (Real* of = rates; of < rates + lane_count * n; of += lane_count)
      std::fill(of + stages, of + lane_count, of[0]);
  }
  bool wants(int stage) const { return (wanted >> static_cast<unsigned>(stage) & 1U) != 0; }
};

/// What a vector field says of itself.
struct FieldClaims {
  std::string name;                ///< of the Hamiltonian or the system
  bool variables = false;          ///< y stands in `ParticleSystem::variables`: a system of first order
  bool second_order = false;       ///< y = (q, v) and q' = v
  bool canonical = false;          ///< y = (q, p), q' = dH/dp and p' = -dH/dq
  bool velocity_dependent = true;  ///< for second order: v' depends on v
  bool gyrates = false;            ///< as v' = a + v x rate alone, which `acceleration_and_rate` tells apart
  bool time_dependent = false;
  bool energy = false;  ///< an energy exists
  bool dissipative = false;
  bool any_origin = false;  ///< it is the same about any origin that moves evenly: only differences of positions count
  bool symplectic = true;   ///< the exact motion is; of particles under forces of a potential it is
  std::string_view no_action = "";  ///< why no action tells the motion; empty: the Lagrangian gives one
  bool keeps_momentum = false;
  bool keeps_angular_momentum = false;
};

/// What a motion keeps, as its gradient at y, shape (size).
template <class Real> struct FieldInvariant {
  std::string name;
  std::function<void(const Vector<Real>& y, Vector<Real>& gradient)> gradient;
};

template <class Real> class LieField;
template <class Real> class SecantTangent;

/// The right-hand side of y' = f(t, y), erased: classical methods are compiled once for each number type.
///
/// It also knows how a ParticleSystem carries y: particles as y = (x, v), component by component, each of n values; a
/// first-order system as the variables of an otherwise empty ParticleSystem.
/// @cost one virtual call per evaluation
template <class Real> class VectorField {
 public:
  virtual ~VectorField() = default;
  virtual std::unique_ptr<VectorField> clone() const = 0;
  virtual FieldClaims claims() const = 0;
  /// What it was made with, for saved runs.
  virtual std::string signature() const = 0;

  /// Takes masses, units and sizes from a system. @throws Error  if it cannot serve it
  virtual void bind(const ParticleSystem<Real>& s) = 0;
  /// Length of y.
  virtual Index size() const = 0;
  /// How many particles q is made of, all x before all y before all z; 0: none.
  virtual Index particles() const { return 0; }
  virtual void gather(const ParticleSystem<Real>& s, Vector<Real>& y) const = 0;
  virtual void scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const = 0;

  /// dy = f(t, y), counted.
  void rate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) {
    ++evaluations_.force;
    evaluate(t, y, dy);
  }
  /// a = v'(t, q, v) for y = (q, v), counted; shape (size / 2).
  void acceleration(const Real& t, const Vector<Real>& y, Vector<Real>& a) {
    ++evaluations_.force;
    accelerate(t, y, a);
  }
  /// a and rate at y = (q, v), counted once, for v' = a + v x rate; each of shape (size / 2), `rate` of zeros where
  /// nothing gyrates. @throws LogicError  where v' depends on v otherwise
  void acceleration_and_rate(const Real& t, const Vector<Real>& y, Vector<Real>& a, Vector<Real>& rate) {
    ++evaluations_.force;
    accelerate_apart(t, y, a, rate);
  }
  /// Rates (for second order: accelerations) at all stages, in the layout of the states, those that are wanted counted;
  /// lanes beyond the stages hold the rates of the first.
  /// @return where they are: in `out`, or in the field's own place until it is asked again
  const Real* rates(const StageStates<Real>& states, Real* out) {
    evaluations_.force += std::popcount(states.wanted & ((1U << static_cast<unsigned>(states.stages)) - 1));
    return evaluate_stages(states, out);
  }
  /// The field as one on a Lie group (integrators/lie/lie_field.hpp), where y does not go along straight lines; else
  /// null.
  virtual LieField<Real>* on_group() { return nullptr; }
  /// Whether stages are evaluated one after the other, so that it saves something not to want them all.
  virtual bool stages_in_turn() const { return true; }
  /// Where the q of the states may be formed, so that nobody has to copy them; null where there is no such place.
  virtual Real* place_of_stages() { return nullptr; }
  /// Whether f is known over dual numbers, so that `derivative` and `jacobian` are exact.
  virtual bool has_derivative() const { return false; }
  /// out = df/dt dt + df/dy dy, exact, not counted. @throws LogicError  where `has_derivative` is false
  virtual void derivative(const Real& /*t*/, const Vector<Real>& /*y*/, const Real& /*dt*/, const Vector<Real>& /*dy*/,
                          Vector<Real>& /*out*/) {
    throw LogicError("derivatives were requested from a vector field that has none");
  }
  /// J = df/dy, shape (size, size), not counted; false where it has to be found by differences.
  /// @cost `derivative` for each column, unless a field knows better
  virtual bool jacobian(const Real& t, const Vector<Real>& y, Matrix<Real>& J);
  /// Where J can be other than 0; empty: anywhere.
  virtual Sparsity sparsity() const { return {}; }

  virtual EnergyTerms<Real> energy(const ParticleSystem<Real>& s) = 0;
  /// The virial of its forces [energy]; empty where it has none, or they do not tell.
  virtual std::optional<Mat3<Real>> virial(const ParticleSystem<Real>& /*s*/) { return {}; }
  virtual void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) = 0;
  /// Whether v' = - M^-1 dU/dq with masses and a potential that it gives: what `lagrangian`, `potential` and `masses`
  /// stand on.
  virtual bool has_potential() const { return false; }
  /// U(t, q) at y = (q, v), not counted [energy]. @throws LogicError  where `has_potential` is false
  virtual Real potential(const Real& /*t*/, const Vector<Real>& /*y*/) {
    throw LogicError("the potential was requested from a vector field that has none");
  }
  /// The mass of each q, shape (size / 2) [mass]. @throws LogicError  as `potential`
  virtual Vector<Real> masses() const { throw LogicError("masses were requested from a vector field that has none"); }
  /// Kinetic less potential energy at y = (q, v), not counted [energy]. @throws LogicError  as `potential`
  virtual Real lagrangian(const Real& t, const Vector<Real>& y) { return kinetic(y) - potential(t, y); }
  /// Whether `hamiltonian` is known. By default where `has_potential`.
  virtual bool has_hamiltonian() const { return has_potential(); }
  /// H(t, y) at y = (q, v) of particles or y = (q, p), not counted [energy]. @throws LogicError  as `potential`
  virtual Real hamiltonian(const Real& t, const Vector<Real>& y) {
    const Real potential_energy = potential(t, y);
    return kinetic(y) + potential_energy;
  }
  /// What its motion keeps beside the energy and the momenta, as far as it names that.
  virtual std::vector<FieldInvariant<Real>> invariants() const { return {}; }
  /// Newton's constant, where masses of no size attract each other [length^3/mass/time^2]; empty where they do not.
  virtual std::optional<double> gravity_of_points() const { return {}; }
  /// Whether anything else acts on them.
  virtual bool has_forces_beside_gravity() const { return false; }
  /// Accelerations by what acts beside that gravity, shape (size / 2), not counted. @throws LogicError  where nothing
  /// does
  virtual void accelerations_beside_gravity(const Real& /*t*/, const Vector<Real>& /*y*/, Vector<Real>& /*a*/) {
    throw LogicError("forces beside gravity were requested from a vector field that has none");
  }
  /// The energy of particles with all digits that their second words have, empty where a force is in doubles only
  /// [energy]. @cost that of 113 bits
  virtual std::optional<EnergyTerms<Quad>> wide_energy(const ParticleSystem<Real>& /*s*/) { return {}; }
  /// Whether all forces know their secants (engine/force_sink.hpp).
  virtual bool has_secant() const { return false; }
  /// Names of the forces that do not, as messages list them.
  virtual std::string forces_without_secant() const { return {}; }
  /// Accelerations a, shape (size / 2), for which m a . (q1 - q0) = U(t, q0) - U(t, q1) to rounding, counted.
  /// @throws LogicError  where `has_secant` is false
  virtual void secant(const Real& /*t*/, const Vector<Real>& /*y0*/, const Vector<Real>& /*y1*/, Vector<Real>& /*a*/) {
    throw LogicError("secants were requested from a vector field that has none");
  }
  /// How many pairs of particles the derivatives of its secants have elements for, if it has them.
  virtual TangentPattern tangent_pattern() const { return TangentPattern::none; }
  /// Names of the forces whose secants have no derivatives, as messages list them.
  virtual std::string forces_without_tangent() const { return {}; }
  /// The derivatives of the accelerations that `secant` gives with respect to q1, not counted.
  /// @throws LogicError  where `tangent_pattern` is none
  virtual void secant_tangent(const Real& /*t*/, const Vector<Real>& /*y0*/, const Vector<Real>& /*y1*/,
                              SecantTangent<Real>& /*tangent*/) {
    throw LogicError("derivatives of secants were requested from a vector field that has none");
  }

  /// What of it is to be checked when a saved run goes on, beside its signature.
  virtual void save(SavedState& /*saved*/, const std::string& /*prefix*/) const {}
  /// @throws Error  if the saved run was made by another field
  virtual void load(const SavedState& /*saved*/, const std::string& /*prefix*/) {}

  /// Why forces could not be computed, the first time since this was forgotten; their rates were no numbers.
  const std::optional<Failure>& failure() const { return failure_; }
  void forget_failure() { failure_.reset(); }

  /// What errors of particles are measured by in a step from y, without particles for any other field; found anew where
  /// y or `rtol` is not that of the call before.
  const ParticleScales& scales(const Vector<Real>& y, double rtol) {
    const bool known = measured_.size() == y.size() && measured_ == y && measured_for_ == rtol;
    if (particles() == 0 || known) return scales_;
    measure_particles(y, rtol, scales_);
    measured_ = y;
    measured_for_ = rtol;
    return scales_;
  }

  Evaluations& evaluations() { return evaluations_; }
  const Evaluations& evaluations() const { return evaluations_; }

 protected:
  virtual void evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) = 0;
  virtual void accelerate(const Real& /*t*/, const Vector<Real>& /*y*/, Vector<Real>& /*a*/) {
    throw LogicError("a system of first order has no acceleration");
  }
  virtual void accelerate_apart(const Real& t, const Vector<Real>& y, Vector<Real>& a, Vector<Real>& rate) {
    if (claims().velocity_dependent) throw LogicError("accelerations depend on velocities in a way that is not known");
    accelerate(t, y, a);
    rate.setZero(a.size());
  }
  /// One stage after the other, unless a field knows better.
  virtual const Real* evaluate_stages(const StageStates<Real>& states, Real* out);
  virtual void measure_particles(const Vector<Real>& /*y*/, double /*rtol*/, ParticleScales& /*scales*/) {
    throw LogicError("a vector field of particles does not measure them");
  }
  /// To be called by `bind`: other masses make other scales.
  void forget_scales() { measured_.resize(0); }
  void note(const std::optional<Failure>& failure) {
    if (failure && !failure_) failure_ = failure;
  }

 private:
  Real kinetic(const Vector<Real>& y) const {
    const Vector<Real> m = masses();
    return sum_over<Real>(m.size(), [&](Index i) { return m[i] * y[m.size() + i] * y[m.size() + i] / Real(2); });
  }

  Evaluations evaluations_;
  std::optional<Failure> failure_;
  ParticleScales scales_;
  Vector<Real> measured_;
  double measured_for_ = 0;
  Vector<Real> stage_, stage_rate_;
  Vector<Real> direction_, column_;  ///< work of `jacobian`
};

template <class Real> const Real* VectorField<Real>::evaluate_stages(const StageStates<Real>& states, Real* out) {
  const bool second = states.second_order;
  const Index n = second ? size() / 2 : size();
  stage_.resize(size());
  for (int k = 0; k < states.stages; ++k) {
    if (!states.wants(k)) continue;
    for (Index i = 0; i < n; ++i) {
      stage_[i] = states.q[lane_count * i + k];
      if (second) stage_[n + i] = states.v != nullptr ? states.v[lane_count * i + k] : Real(0);
    }
    if (second) {
      accelerate(states.t[k], stage_, stage_rate_);
    } else {
      evaluate(states.t[k], stage_, stage_rate_);
    }
    for (Index i = 0; i < n; ++i) out[lane_count * i + k] = stage_rate_[i];
  }
  states.fill_lanes(n, out);
  return out;
}

template <class Real> bool VectorField<Real>::jacobian(const Real& t, const Vector<Real>& y, Matrix<Real>& J) {
  if (!has_derivative()) return false;
  const Index n = y.size();
  J.resize(n, n);
  direction_.setZero(n);
  for (Index j = 0; j < n; ++j) {
    direction_[j] = Real(1);
    derivative(t, y, Real(0), direction_, column_);
    direction_[j] = Real(0);
    for (Index i = 0; i < n; ++i) J(i, j) = column_[i];
  }
  return true;
}

}  // namespace noether
