#pragma once
/// The integrator of the classical methods: one loop over y' = f(t, y) for all of them.

#include "engine/simulation.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/force_motion.hpp"
#include "integrators/method.hpp"

#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace noether {

/// Advances a vector field by a classical method, with fixed steps or with steps of the method's own choice.
///
/// An adaptive run is shown at times of its choice from dense output, or, where the method has none as good as itself,
/// by steps that end there, made on a copy: the run never shortens a step. One of fixed steps is shown at times between
/// them where the method has dense output, of a step that a copy makes.
/// @cost the evaluations of the method, and one copy of y in and out each time the run is cut
template <class Real> class Classical {
 public:
  using real = Real;

  /// @throws Error  see `make_method`
  Classical(std::unique_ptr<VectorField<Real>> field, const MethodChoice& choice)
      : field_(std::move(field)), method_(make_method<Real>(*choice.info, choice.options)), choice_(choice) {}
  Classical(const Classical& other)
      : field_(other.field_->clone()), method_(other.method_->clone()), choice_(other.choice_), y_(other.y_) {}
  Classical(Classical&&) noexcept = default;
  Classical& operator=(const Classical& other) { return *this = Classical(other); }
  Classical& operator=(Classical&&) noexcept = default;
  ~Classical() = default;

  IntegratorClaims claims() const;
  const Method<Real>& method() const { return *method_; }
  /// @throws SchemeMismatch  if the method cannot serve the field
  void bind(ParticleSystem<Real>& s);
  Advance advance(ParticleSystem<Real>& s, const Span& span);
  bool has_action() const;
  Advance advance_with_action(ParticleSystem<Real>& s, const Span& span, Real& action);
  Real settle(const ParticleSystem<Real>& raw, ParticleSystem<Real>& out, Request wanted, std::optional<double> at,
              bool corrected);
  /// @throws LogicError  for a method whose memory is immovable
  void go_on_from(const ParticleSystem<Real>& now, ParticleSystem<Real>& raw);
  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) { return field_->energy(s); }
  /// With all digits of particles that keep second words; empty for others.
  std::optional<EnergyTerms<Quad>> wide_energy(const ParticleSystem<Real>& s) { return field_->wide_energy(s); }
  std::optional<Mat3<Real>> virial(const ParticleSystem<Real>& s) { return field_->virial(s); }
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) { field_->accelerations(s, a); }
  Evaluations evaluations() const { return field_->evaluations(); }

  void save(SavedState& saved, const std::string& prefix) const;
  /// @throws Error  if the saved run was made by another method, with other tolerances, or over another field
  void load(const SavedState& saved, const std::string& prefix);

 private:
  std::string signature() const;
  double longest_step(const Clock<Real>& clock) const;
  void look_ahead(const ParticleSystem<Real>& raw, double at);

  /// A copy of the method on its way past the last whole step of the run, for observers.
  struct Ahead {
    std::unique_ptr<Method<Real>> method;
    std::int64_t from = 0;   ///< step of the run it started at
    Clock<Real> begin, end;  ///< of its last step
    double h = 0;            ///< the length of that [time]; 0: there was none
    Vector<Real> y;          ///< at its end
  };

  std::unique_ptr<VectorField<Real>> field_;
  std::unique_ptr<Method<Real>> method_;
  MethodChoice choice_;
  Vector<Real> y_, before_;  ///< now, and where the last step began if its action is wanted
  std::optional<Ahead> ahead_;
  std::optional<Failure> failure_;
};

extern template class Classical<double>;
extern template class Classical<Quad>;
extern template struct detail::IntegratorModel<Classical<double>>;
extern template struct detail::IntegratorModel<Classical<Quad>>;

/// A classical method over forces: `classical(Gravity{}, method("rk4"))`. Velocity-dependent forces are welcome.
template <class F>
  requires Force<F, double> Classical<double> classical(F forces, const MethodChoice& choice) {
    return Classical<double>(std::make_unique<ForceMotion<F, double>>(std::move(forces)), choice);
  }

/// The same over the forces of a Hamiltonian: `classical(KineticPotential(Gravity{}), method("gauss_8"))`.
template <class F, class Real>
Classical<Real> classical(const KineticPotential<F, Real>& hamiltonian, const MethodChoice& choice) {
  return Classical<Real>(std::make_unique<ForceMotion<F, Real>>(hamiltonian.forces()), choice);
}

}  // namespace noether
