#pragma once
/// Methods without commutators: products of exponentials of stages, as Crouch and Grossman began them.

#include "integrators/method.hpp"
#include "integrators/methods/tableau.hpp"

#include <memory>
#include <string_view>
#include <vector>

namespace noether {

/// A point as a product of exponentials that move an earlier one.
struct ExponentialProduct {
  int from = 0;                            ///< the stage that it starts from; 0 is y itself
  std::vector<std::vector<Quad>> weights;  ///< of the stages in each exponential, the first that acts first
  Quad c = 0;                              ///< its place in the step
};

/// Y_i = exp(h sum_j w_rj A_j) ... exp(h sum_j w_1j A_j) Y_from,   A_i = A(t + c_i h, Y_i)
struct ExponentialTableau {
  std::vector<ExponentialProduct> stages;  ///< those behind the first, which is y
  ExponentialProduct end;
  int order = 0;
};

namespace tableaus {

const ExponentialTableau& crouch_grossman_3();
const ExponentialTableau& crouch_grossman_4();
const ExponentialTableau& commutator_free_3();
const ExponentialTableau& commutator_free_4();
/// By the name of its method; null where there is none.
const ExponentialTableau* exponential_table(std::string_view name);

}  // namespace tableaus

/// Any such table.
///
/// Crouch and Grossman take one stage to each exponential, Celledoni, Marthinsen and Owren several, and so fewer of
/// them. On a field without a group both are Runge-Kutta methods.
/// @cost as many evaluations as stages, and an exponential for each row of a table
/// @source CrouchGrossman1993, CelledoniMarthinsenOwren2003
template <class Real> class ExponentialProducts final : public Method<Real> {
 public:
  ExponentialProducts(const MethodInfo& info, const ExponentialTableau& table);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<ExponentialProducts>(*this); }
  MethodClaims claims() const override { return {.name = name_, .order = order_}; }
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::none; }
  void save(SavedState& /*saved*/, const std::string& /*prefix*/) const override {}
  void load(const SavedState& /*saved*/, const std::string& /*prefix*/) override {}

 private:
  /// A point in the working type.
  struct Product {
    int from;
    std::vector<std::vector<Real>> weights;
    Real c;
  };
  static Product in_real(const ExponentialProduct& product);
  void go(VectorField<Real>& f, const Product& product, double h, const Vector<Real>& y, Vector<Real>& out);

  std::string_view name_;
  int order_;
  std::vector<Product> stages_;
  Product end_;
  std::vector<Vector<Real>> a_, places_;  ///< velocities; the stages behind y
  Vector<Real> u_, between_;
};

extern template class ExponentialProducts<double>;
extern template class ExponentialProducts<Quad>;

}  // namespace noether
