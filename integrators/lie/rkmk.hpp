#pragma once
/// Methods of Munthe-Kaas: any explicit Runge-Kutta method, on a Lie group.

#include "integrators/lie/dexp.hpp"
#include "integrators/methods/explicit_tableaus.hpp"
#include "integrators/step_control.hpp"

#include <memory>
#include <string_view>
#include <vector>

namespace noether {

/// y(t + h) = exp(u) y(t), where an explicit Runge-Kutta method makes u from 0:
///
///     u_i = h sum_j a_ij k_j,   A_i = A(t + c_i h, exp(u_i) y),   k_i = dexp^-1_(u_i) A_i,   u = h sum_i b_i k_i
///
/// with dexp^-1 to as many brackets as the order needs. Estimates of pairs are elements of the algebra, angles of turns
/// among them. On a field without a group this is the Runge-Kutta method itself, to the bit.
/// @cost the stages of the table, one less where the last is the first of the next step; an exponential a stage
/// @source MuntheKaas1999
template <class Real> class Rkmk final : public Method<Real> {
 public:
  /// @param terms  brackets in dexp^-1; not checked here against what the order needs
  Rkmk(const MethodInfo& info, const MethodOptions& options, const tableaus::NamedTableau& table, int terms);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<Rkmk>(*this); }
  MethodClaims claims() const override { return {.name = name_, .order = order_, .adaptive = adaptive_}; }
  void bind(const VectorField<Real>& f) override;
  double next_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  bool dense() const override { return !d_.empty(); }
  void interpolate(VectorField<Real>& f, const Real& theta, Vector<Real>& y) override;
  Memory memory() const override { return Memory::none; }
  void moved(VectorField<Real>& /*f*/, const Real& /*t*/, const Vector<Real>& /*y*/) override { have_first_ = false; }
  void save(SavedState& saved, const std::string& prefix) const override;
  void load(const SavedState& saved, const std::string& prefix) override;

 private:
  void combine(const std::vector<Real>& w, double h, Vector<Real>& out) const;
  void trial(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h);
  double error(VectorField<Real>& f, double h, const Vector<Real>& y);

  std::string_view name_;
  int order_;
  bool adaptive_, first_same_as_last_;
  Tolerance tolerance_;
  double first_;
  std::vector<std::vector<Real>> a_;
  std::vector<Real> b_, c_, e_, e3_, d_;  ///< e3: of a second estimate; d: of dense output
  StepController control_;
  InverseDexp<Real> inverse_dexp_;
  std::vector<Vector<Real>> k_;
  Vector<Real> u_, velocity_, error_, begin_;  ///< elements: the last trial's, work, and k_1 of the last step
  Vector<Real> y0_, y1_;                       ///< begin and end of the last step
  Vector<double> sizes_;
  double h_ = 0;
  bool have_first_ = false;  ///< k_[0] is A at the present point
};

extern template class Rkmk<double>;
extern template class Rkmk<Quad>;

/// Nested commutators in dexp^-1 of a stage, as the options have them or the order needs; -1 for methods of other
/// kinds.
int dexp_terms_of(const MethodInfo& info, const MethodOptions& options);

}  // namespace noether
