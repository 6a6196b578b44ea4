#pragma once
/// Spectral deferred corrections of Boris's step.

#include "integrators/method.hpp"

#include <cstdint>
#include <vector>

namespace noether {

/// How far the steps of deferred corrections go.
struct BorisSdcOptions {
  std::int64_t nodes = 5;   ///< of Lobatto, both ends of a step among them
  std::int64_t sweeps = 3;  ///< corrections of the first pass

  static constexpr auto describe() {
    return part<BorisSdcOptions>(
        "boris_sdc", "nodes and sweeps of deferred corrections",
        field<&BorisSdcOptions::nodes>("nodes", "1", "Lobatto nodes in a step, 3 to 9: at most order 2 nodes - 2"),
        field<&BorisSdcOptions::sweeps>(
            "sweeps", "1",
            "corrections of Boris's steps between them, 1 to 32; each adds two orders, in a "
            "magnetic field the first, the third and so on"));
  }
  /// @throws Error  out of these ranges
  void check() const;
};

/// Boris's step between the nodes of Lobatto, corrected sweep by sweep towards their collocation method, for
/// q'' = a(t, q) + v x rate(t, q).
///
///     x_m' = x_0 + h c_m v_0 + h^2 (sum_l Q^2_ml f_l + sum_(l<m) X_ml (f_l' - f_l))
///     v_m' = v_(m-1)' + d_m (f_(m-1)' + f_m' - f_(m-1) - f_m)/2 + h sum_l (Q_ml - Q_(m-1)l) f_l,   f = a + v x rate
///
/// with f of the sweep before, f' of this one, steps d_m between the nodes c_m, the collocation matrix Q, and X_ml what
/// velocity Verlet between nodes makes of f_l. Only the velocity in f_m' is unknown: a turn by Cayley's formula. The
/// first pass has f = 0, and is Boris's step. Each sweep adds two orders, every other one where a field turns
/// velocities, up to 2 nodes - 2. It is neither symplectic nor reversible until the sweeps have converged. `claims` of
/// the order are those of the field once it is bound.
/// @cost 1 + (sweeps + 1)(nodes - 1) evaluations
/// @source WinkelSpeckRuprecht2015
template <class Real> class BorisSdc final : public Method<Real> {
 public:
  BorisSdc(const MethodInfo& info, const MethodOptions& options);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<BorisSdc>(*this); }
  MethodClaims claims() const override;
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::none; }
  void save(SavedState& /*saved*/, const std::string& /*prefix*/) const override {}
  void load(const SavedState& /*saved*/, const std::string& /*prefix*/) override {}

 private:
  using Row = std::vector<Real>;
  /// A node of a step: what acts there, and by how much v has changed.
  struct Node {
    Vector<Real> a, rate;      ///< f = a + v x rate
    Vector<Real> f, f_before;  ///< of this sweep and the one before
    Vector<Real> change;       ///< of the velocity since the step began
  };

  void place(std::size_t m, const Vector<Real>& y, const Real& h);
  void push(std::size_t m, const Vector<Real>& y, const Real& h);
  void finish(Node& node) const;

  std::string_view name_;
  BorisSdcOptions options_;
  bool turns_ = false;                               ///< the field has rates
  std::vector<Real> c_;                              ///< nodes
  std::vector<Row> to_positions_, of_news_, along_;  ///< Q^2, X and the differences of Q, by node
  std::vector<Node> nodes_;
  Vector<Real> here_;  ///< (q, v) at a node
};

extern template class BorisSdc<double>;
extern template class BorisSdc<Quad>;

}  // namespace noether
