#pragma once
/// Explicit Runge-Kutta-Nystroem pairs for q'' = a(t, q).

#include "integrators/methods/nystrom_tableaus.hpp"
#include "integrators/step_control.hpp"

namespace noether {

/// Dormand, El-Mikkawy and Prince's 12(10), with fixed steps or with an error estimate of order 10.
/// @cost 17 evaluations a step, 16 for a trial after a rejected one
/// @source DormandElMikkawyPrince1987
template <class Real> class NystromPair final : public Method<Real> {
 public:
  NystromPair(const MethodInfo& info, const MethodOptions& options);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<NystromPair>(*this); }
  MethodClaims claims() const override {
    return {.name = name_, .order = order, .adaptive = adaptive_, .second_order_only = true, .positions_only = true};
  }
  void bind(const VectorField<Real>& f) override;
  double next_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::none; }
  void save(SavedState& saved, const std::string& prefix) const override { control_.save(saved, prefix + "control/"); }
  void load(const SavedState& saved, const std::string& prefix) override { control_.load(saved, prefix + "control/"); }

 private:
  static constexpr int order = 12, embedded_order = 10;

  Real sum(const std::vector<Real>& weights, Index i) const;
  void trial(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h);
  double error(const ParticleScales& scales, const Vector<Real>& y, double h);

  std::string_view name_;
  bool adaptive_;
  Tolerance tolerance_;
  double first_;
  std::vector<std::vector<Real>> a_;
  std::vector<Real> c_, b_q_, b_v_, e_q_, e_v_;
  StepController control_{embedded_order + 1, 6};
  std::vector<Vector<Real>> k_;
  Vector<Real> y1_, e_;
};

extern template class NystromPair<double>;
extern template class NystromPair<Quad>;

}  // namespace noether
