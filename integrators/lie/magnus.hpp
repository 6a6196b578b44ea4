#pragma once
/// Magnus's methods for Y' = A(t) Y: one exponential, or two, of nodes of Gauss and their commutators.

#include "integrators/method.hpp"

#include <array>
#include <memory>
#include <string_view>

namespace noether {

/// The kinds of such methods.
enum class MagnusKind : std::uint8_t { order_2, order_4, order_6, commutator_free_4 };

/// Y(t + h) = exp(Omega) Y(t) with A_i = A(t + c_i h) at the nodes of Gauss:
///
///     2:  h A_1
///     4:  h (A_1 + A_2)/2 - sqrt(3) h^2 [A_1, A_2]/12
///     6:  a_1 + a_3/12 + [-20 a_1 - a_3 + C_1, a_2 + C_2]/240,   C_1 = [a_1, a_2],  C_2 = -[a_1, 2 a_3 + C_1]/60
///         a_1 = h A_2,  a_2 = sqrt(15) h (A_3 - A_1)/3,  a_3 = 10 h (A_3 - 2 A_2 + A_1)/3
///     without commutators, 4:  exp(h (b A_1 + a A_2)) exp(h (a A_1 + b A_2)),   a, b = 1/4 +- sqrt(3)/6
/// @cost 1, 2, 3 and 2 evaluations; 1, 1, 1 and 2 exponentials; 0, 1, 3 and 0 commutators
/// @source BlanesCasasRos2000, BlanesMoan2006
template <class Real> class Magnus final : public Method<Real> {
 public:
  Magnus(const MethodInfo& info, MagnusKind kind) : name_(info.name), order_(info.order), kind_(kind) {}

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<Magnus>(*this); }
  MethodClaims claims() const override {
    return {.name = name_, .order = order_, .symplectic = false, .reversible = true, .keeps_angular_momentum = true};
  }
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::none; }
  void save(SavedState& /*saved*/, const std::string& /*prefix*/) const override {}
  void load(const SavedState& /*saved*/, const std::string& /*prefix*/) override {}

 private:
  std::string_view name_;
  int order_;
  MagnusKind kind_;
  std::array<Vector<Real>, 3> a_;  ///< at the nodes, and what is made of them
  std::array<Vector<Real>, 3> c_;  ///< commutators and sums
  Vector<Real> omega_, y1_;
};

extern template class Magnus<double>;
extern template class Magnus<Quad>;

}  // namespace noether
