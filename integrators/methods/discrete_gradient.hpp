#pragma once
/// Discrete gradients: methods that keep any energy, of particles or of y' = J grad H.

#include "integrators/methods/continued_root.hpp"
#include "integrators/methods/mean_force_step.hpp"

namespace noether {

/// Gonzalez's discrete gradient with fixed steps: the gradient in the middle, and what is missing of the difference of
/// the energies along the displacement.
///
///     y1 = y + h J G(y, y1),   G = grad H(m) + (H(y1) - H(y) - grad H(m) . d) d / |d|^2,   m = (y + y1)/2, d = y1 - y
///
/// Of particles H is the potential: d is the displacement of all q about that of their center of mass where the forces
/// keep the momentum, and its square that of the masses, so no units matter. Energy and momentum are kept to rounding
/// at any step, angular momentum is not. Symmetric, of order 2. It needs no secants.
/// @cost as `ContinuedRoot`: an evaluation is one of the forces and one of the energy
/// @source Gonzalez1996
template <class Real> class GonzalezMethod final : public Method<Real> {
 public:
  GonzalezMethod(const MethodInfo& info, const MethodOptions& options) : name_(info.name), form_(options.jacobian) {}

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<GonzalezMethod>(*this); }
  MethodClaims claims() const override;
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::none; }
  void save(SavedState& /*saved*/, const std::string& /*prefix*/) const override {}
  void load(const SavedState& /*saved*/, const std::string& /*prefix*/) override {}

 private:
  std::string_view name_;
  std::optional<JacobianForm> form_;
  bool second_order_ = false, about_center_ = false;
  Vector<Real> masses_, middle_, way_, end_, rate_;
  MeanForceStep<Real> step_;
  ContinuedRoot<Real> root_;
};

/// The discrete gradient of Itoh and Abe with fixed steps, from values of the energy alone: coordinate by coordinate,
/// each changed from its old to its new value while those before it have their new ones, those after it the old.
///
///     q_i' = dH_i / dp_i,   p_i' = -dH_i / dq_i        as quotients of differences over the step; q_1, p_1, q_2, p_2,
///     ...
///
/// The energy is kept to rounding at any step; momentum and angular momentum are not, for the order of the coordinates
/// is no symmetry. Of order 1; with a half step in this order and one in the reversed order, which is its adjoint, the
/// method is symmetric and of order 2. Of particles the coordinates are all x, all y and all z, and each one has an
/// equation of its own.
/// @cost some eight energies for each coordinate; twice that for the symmetric composition
/// @source ItohAbe1988, McLachlanQuispelRobidoux1999
template <class Real> class ItohAbeMethod final : public Method<Real> {
 public:
  ItohAbeMethod(const MethodInfo& info, bool symmetric) : name_(info.name), symmetric_(symmetric) {}

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<ItohAbeMethod>(*this); }
  MethodClaims claims() const override;
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::none; }
  void save(SavedState& /*saved*/, const std::string& /*prefix*/) const override {}
  void load(const SavedState& /*saved*/, const std::string& /*prefix*/) override {}

 private:
  std::optional<Failure> sweep(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h, bool reversed);

  std::string_view name_;
  bool symmetric_, second_order_ = false;
  Vector<Real> masses_, unknown_;
  ContinuedRoot<Real> root_;
};

extern template class GonzalezMethod<double>;
extern template class GonzalezMethod<Quad>;
extern template class ItohAbeMethod<double>;
extern template class ItohAbeMethod<Quad>;

}  // namespace noether
