#pragma once
/// The average vector field of order 4.

#include "integrators/methods/dense_factors.hpp"
#include "integrators/methods/jacobian.hpp"
#include "integrators/methods/line_table.hpp"
#include "integrators/methods/newton.hpp"

#include <algorithm>
#include <string_view>

namespace noether {

/// The average of f along the straight line to y1, and a correction that keeps the energy too:
///
///     y1 = y + h (1 - h^2 J^2 / 12) F,   F = int_0^1 f(y + c (y1 - y)) dc
///
/// with f = S grad H, so that J = S H'' at the middle of the line gives J^2 F = S H'' S H'' S int grad H: what stands
/// before the gradient is skew, and H is kept. The average takes 8, 16, ... or 64 nodes, as many as the line asks for.
/// @cost 6 to 12 sweeps of 8 evaluations and two products with J; by Newton's iteration one dense Jacobian and the
///       factors of a matrix of all rows of y, whose cost is n^3
/// @source QuispelMcLaren2008
template <class Real> class AverageField4 final : public Method<Real> {
 public:
  AverageField4(const MethodInfo& info, const MethodOptions& options);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<AverageField4>(*this); }
  MethodClaims claims() const override;
  /// @throws SchemeMismatch  for forces without exact derivatives
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::none; }
  void moved(VectorField<Real>& /*f*/, const Real& /*t*/, const Vector<Real>& /*y*/) override {
    std::fill(low_.begin(), low_.end(), Real(0));
  }
  void save(SavedState& saved, const std::string& prefix) const override;
  void load(const SavedState& saved, const std::string& prefix) override;

 private:
  /// The slope (y1 - y) / h that the present one leads to. @return its change, as a part of the largest, of the half of
  /// y, positions or momenta, where that is most
  double improve(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h);
  void average(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h);
  bool sweep(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h);
  bool iterate(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h);
  bool has_enough_nodes() const;
  bool has_enough_nodes(Index begin, Index end) const;

  std::string_view name_;
  const LineTable<Real>* table_ = nullptr;
  bool second_order_ = false;
  Index rated_ = 0;  ///< variables whose rates are evaluated
  StageArithmetic<Real> sums_;
  AlignedVector<Real> line_, states_, rates_;  ///< the slope in lane 0; eight nodes; rates of all nodes
  Vector<Real> slope_, fresh_, average_, middle_, product_, update_;
  AlignedVector<Real> low_;  ///< rounding errors of y
  Matrix<Real> J_, matrix_;
  DenseFactors<Real> factors_;
};

extern template class AverageField4<double>;
extern template class AverageField4<Quad>;

}  // namespace noether
