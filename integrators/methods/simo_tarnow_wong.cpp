#include "integrators/methods/simo_tarnow_wong.hpp"

#include "integrators/all_methods.hpp"

#include <limits>

namespace noether {

template <class Real> MethodClaims SimoTarnowWong<Real>::claims() const {
  return {.name = name_,
          .order = 2,
          .reversible = true,
          .keeps_angular_momentum = true,
          .second_order_only = true,
          .positions_only = true,
          .energy_exact = true,
          .conservative_only = true};
}

template <class Real> void SimoTarnowWong<Real>::bind(const VectorField<Real>& f) {
  if (!f.has_secant()) {
    throw SchemeMismatch(fmt::format(
        "method '{}' needs secants of every force, but {} has none; use 'gonzalez', which keeps the energy without",
        name_, f.forces_without_secant()));
  }
  const TangentPattern tangent = f.tangent_pattern();
  if (form_ == JacobianForm::sparse && tangent == TangentPattern::none) {
    throw SchemeMismatch(
        fmt::format("jacobian = \"sparse\" needs derivatives of the secants of every force, but {} has "
                    "none; use jacobian = \"matrix_free\" or \"dense\"",
                    f.forces_without_tangent()),
        {.key = "jacobian"});
  }
  step_.bind(f, form_, tangent);
}

namespace {

/// The secants of a field.
template <class Real> class SecantsOfField final : public MeanForce<Real> {
 public:
  SecantsOfField(VectorField<Real>& f, const Real& t, SecantTangent<Real>& tangent) : f_(f), t_(t), tangent_(tangent) {}
  void between(const Vector<Real>& y0, const Vector<Real>& y1, Vector<Real>& a) override { f_.secant(t_, y0, y1, a); }
  const Eigen::SparseMatrix<Real>& tangent(const Vector<Real>& y0, const Vector<Real>& y1) override {
    f_.secant_tangent(t_, y0, y1, tangent_);
    return tangent_.matrix();
  }

 private:
  VectorField<Real>& f_;
  const Real& t_;
  SecantTangent<Real>& tangent_;
};

}  // namespace

template <class Real>
StepResult SimoTarnowWong<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  SecantsOfField<Real> secants(f, t, tangent_);
  return {.h = h, .failure = step_.make(secants, y, h, f.evaluations())};
}

template class SimoTarnowWong<double>;
template class SimoTarnowWong<Quad>;

namespace {
template <class Real>
std::unique_ptr<Method<Real>> make_simo_tarnow_wong(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<SimoTarnowWong<Real>>(info, options);
}
}  // namespace

std::span<const MethodInfo> methods::simo_tarnow_wong_list() {
  static const MethodInfo list[] = {
      {.name = "simo_tarnow_wong",
       .aliases = "energy_momentum",
       .summary = "secant forces, pair by pair: energy, momentum and angular momentum exact at any step",
       .use = "stiff springs and deformable blocks that must not gain energy, over long times",
       .source = "SimoTarnowWong1992",
       .family = "energy",
       .options = {linear_solver},
       .order = 2,
       .stability_limit = std::numeric_limits<double>::infinity(),
       .make = make_simo_tarnow_wong<double>,
       .make_quad = make_simo_tarnow_wong<Quad>},
  };
  return list;
}

}  // namespace noether
