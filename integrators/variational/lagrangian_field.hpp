#pragma once
/// Motion by a Lagrangian, as variational methods see it: momenta and forces at any (t, q, q').

#include "integrators/methods/dense_factors.hpp"
#include "integrators/vector_field.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace noether {

/// What the equations of motion d/dt m = f are made of, at one (t, q, q').
template <class Real> struct LagrangianTerms {
  Vector<Real> momentum;  ///< m = dL/dq', shape (n)
  Vector<Real> force;     ///< dL/dq and what acts beside the Lagrangian, shape (n)
};

/// Their derivatives, rows by components, columns by coordinates or velocities; shape (n, n) each.
template <class Real> struct LagrangianTangent { Matrix<Real> momentum_q, momentum_v, force_q, force_v; };

/// The vector field y = (q, p) of a Lagrangian L(t, q, q') of n coordinates, erased:
///
///     q' = v(t, q, p),   p' = dL/dq(t, q, v) + f(t, q, v),   v from p = dL/dq'(t, q, v)
///
/// Classical methods for y' = f take it as it is; variational methods ask for the Lagrangian itself.
template <class Real> class LagrangianField : public VectorField<Real> {
 public:
  /// The Lagrangian behind a field; null where there is none.
  static LagrangianField* behind(VectorField<Real>& f) { return dynamic_cast<LagrangianField*>(&f); }
  static const LagrangianField* behind(const VectorField<Real>& f) { return dynamic_cast<const LagrangianField*>(&f); }

  /// n, half the length of y.
  Index coordinates() const { return this->size() / 2; }
  /// L(t, q, v), not counted [energy].
  virtual Real action_density(const Real& t, const Vector<Real>& q, const Vector<Real>& v) = 0;
  /// Momenta and forces, counted as one evaluation.
  void terms(const Real& t, const Vector<Real>& q, const Vector<Real>& v, LagrangianTerms<Real>& out) {
    ++this->evaluations().force;
    find_terms(t, q, v, out);
  }
  /// Their derivatives by q and v, exact, counted as one Jacobian.
  void tangent(const Real& t, const Vector<Real>& q, const Vector<Real>& v, LagrangianTangent<Real>& out) {
    ++this->evaluations().jacobian;
    find_tangent(t, q, v, out);
  }
  /// Their derivatives along (dt, dq, dv), exact, not counted.
  virtual void terms_along(const Real& t, const Vector<Real>& q, const Vector<Real>& v, const Real& dt,
                           const Vector<Real>& dq, const Vector<Real>& dv, LagrangianTerms<Real>& out) = 0;

  /// v(t, q, p), the root of p = dL/dq' that continues from rest, by Newton's iteration to rounding; not counted. At
  /// rest d^2L/dq'^2 has as many negative eigenvalues as it had first since `bind`: a motion does not go through 0.
  /// @return why there is none
  /// @cost nothing where it was asked last
  std::optional<Failure> velocity(const Real& t, const Vector<Real>& q, const Vector<Real>& p, Vector<Real>& v);
  /// Why y = (q, p), where a step has ended, has no velocity.
  std::optional<Failure> check_velocity(const Real& t, const Vector<Real>& y);
  /// q'' = a(t, q, v), counted as one evaluation, from L_vv a = f - L_vq v - L_vt.
  /// @param renew  whether the masses L_vv are those of another place than in the call before
  /// @return why there is none, as for `velocity`
  std::optional<Failure> solve_acceleration(const Real& t, const Vector<Real>& q, const Vector<Real>& v, bool renew,
                                            Vector<Real>& a);

  /// How many second derivatives w its force contains, such as r'' of each pair; 0: it does not tell that.
  virtual Index second_rates() const { return 0; }
  /// w at (q, v) for q'' = a, shape (second_rates). @throws LogicError  where there are none
  virtual void find_second_rates(const Vector<Real>& q, const Vector<Real>& v, const Vector<Real>& a, Vector<Real>& w);
  /// q'' for given w, shape (n): what the force with w in it makes of constant masses, not counted. @throws LogicError
  /// where there are none
  virtual void acceleration_with(const Real& t, const Vector<Real>& q, const Vector<Real>& v, const Vector<Real>& w,
                                 Vector<Real>& a);

 protected:
  /// To be called by `bind`.
  void forget_signs() {
    negative_.reset();
    known_v_.resize(0);
  }
  virtual void find_terms(const Real& t, const Vector<Real>& q, const Vector<Real>& v, LagrangianTerms<Real>& out) = 0;
  virtual void find_tangent(const Real& t, const Vector<Real>& q, const Vector<Real>& v,
                            LagrangianTangent<Real>& out) = 0;
  /// y' in `dy`; no numbers where the momenta belong to no velocities.
  void evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) override;

 private:
  std::optional<Failure> find_velocity(const Real& t, const Vector<Real>& q, const Vector<Real>& p, Vector<Real>& v);
  bool correct_velocity(const Real& t, const Vector<Real>& q, const Vector<Real>& p, bool renew, Vector<Real>& v);
  bool keeps_signs();
  Failure changed_signs(const Vector<Real>& q) const;

  LagrangianTerms<Real> terms_;
  LagrangianTangent<Real> tangent_;
  DenseFactors<Real> factors_;
  std::optional<Index> negative_;  ///< eigenvalues of d^2L/dq'^2, since `bind`
  Matrix<Real> eliminated_;        ///< work of their count
  Vector<Real> q_, p_, v_, off_, update_, tried_, still_;
  Real known_t_ = Real(0);  ///< of the last velocity that was found
  Vector<Real> known_q_, known_p_, known_v_;
};

extern template class LagrangianField<double>;
extern template class LagrangianField<Quad>;

/// "q = (0.25, -1.5)", the first four of them.
template <class Real> std::string place_text(const Vector<Real>& q);

}  // namespace noether
