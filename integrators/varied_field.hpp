#pragma once
/// A vector field with its variational equations.

#include "integrators/vector_field.hpp"

#include <memory>
#include <string>

namespace noether {

/// y' = f(t, y) and c' = (df/dy) c for some changes c of y, as one field of first or second order.
///
/// Its y are variables: all q, that of the state before those of the changes, and then all v or p likewise, where the
/// field has them; else whole states one after the other. A Runge-Kutta method over it makes the derivative of its own
/// step: both are linear in the rates.
/// @cost one rate and one `derivative` a change
/// @source ReinTamayo2016
template <class Real> class VariedField final : public VectorField<Real> {
 public:
  /// @param field  bound already; it has derivatives
  VariedField(std::unique_ptr<VectorField<Real>> field, Index changes)
      : field_(std::move(field)), changes_(changes), halves_(has_halves(field_->claims())) {}
  VariedField(const VariedField& other)
      : VectorField<Real>(other), field_(other.field_->clone()), changes_(other.changes_), halves_(other.halves_) {}

  std::unique_ptr<VectorField<Real>> clone() const override { return std::make_unique<VariedField>(*this); }
  FieldClaims claims() const override;
  std::string signature() const override { return "varied " + field_->signature(); }
  void bind(const ParticleSystem<Real>& s) override;
  Index size() const override { return (1 + changes_) * field_->size(); }
  void gather(const ParticleSystem<Real>& s, Vector<Real>& y) const override;
  void scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const override;
  EnergyTerms<Real> energy(const ParticleSystem<Real>& /*s*/) override { return {}; }
  void accelerations(const ParticleSystem<Real>& /*s*/, VectorColumn<Real>& /*a*/) override {}

  /// Takes the state (0) or change k (k) out of all variables.
  void take(const Vector<Real>& all, Index k, Vector<Real>& one) const;
  /// The inverse.
  void put(const Vector<Real>& one, Index k, Vector<Real>& all) const;

 protected:
  void evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) override;
  void accelerate(const Real& t, const Vector<Real>& y, Vector<Real>& a) override;

 private:
  static bool has_halves(const FieldClaims& claims) { return claims.second_order || claims.canonical; }

  std::unique_ptr<VectorField<Real>> field_;
  Index changes_;
  bool halves_;  ///< y = (q, v) or (q, p)
  Vector<Real> state_, change_, rate_;
};

extern template class VariedField<double>;
extern template class VariedField<Quad>;

}  // namespace noether
