#pragma once
/// Methods in extended phase space: explicit steps of energies that no splitting divides.

#include "integrators/method.hpp"
#include "integrators/methods/continued_root.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// Two copies of a state, (q, p) and (x, y), under H(q, y) + H(x, p): each half moves the other one, and in each of
/// them nothing moves that its rates depend on. From equal copies both are the motion under H.
///
///     A:  x' = dH/dp(q, y),  p' = -dH/dq(q, y)        B:  q' = dH/dp(x, p),  y' = -dH/dq(x, p)
///
/// Of particles under forces p stands for velocities.
/// @source Pihajoki2015, Tao2016
template <class Real> class TwinStates {
 public:
  void resize(Index size);
  /// Both copies become y = (q, p).
  void set(const Vector<Real>& y) { first = second = y; }
  /// The flows of A and B over a time tau; H is that of time t. @cost an evaluation
  void move_second_positions(VectorField<Real>& f, const Real& t, const Real& tau);  ///< A
  void move_first_positions(VectorField<Real>& f, const Real& t, const Real& tau);   ///< B
  /// Turns the difference of the copies, (q - x, (p - y)/scale), by an angle; their mean stays. A scale for each q.
  void turn_difference(const Real& angle, const Vector<Real>& scales);

  Vector<Real> first, second;  ///< (q, p) and (x, y)

 private:
  Vector<Real> mixed_, rates_;
};

extern template class TwinStates<double>;
extern template class TwinStates<Quad>;

/// The symmetric composition that a method in extended phase space takes its steps by.
struct SemiexplicitOptions {
  std::string composition = "";  ///< empty: verlet, yoshida_4, kahan_li_6_s9 or kahan_li_8_s17, as the order is

  static constexpr auto describe() {
    return part<SemiexplicitOptions>(
        "semiexplicit", "the composition of a step in extended phase space",
        field<&SemiexplicitOptions::composition>(
            "composition", "1",
            "symmetric composition of the method's order; default: verlet, yoshida_4, kahan_li_6_s9, kahan_li_8_s17"));
  }
  void check() const;
};
/// How strongly the copies are bound to each other.
struct TaoOptions {
  std::optional<double> omega = {};  ///< [1/time]

  static constexpr auto describe() {
    return part<TaoOptions>(
        "tao", "how the copies of extended phase space are bound",
        field<&TaoOptions::omega>("omega", "1/time",
                                  "the copies turn about each other at twice this rate; default: twice the largest "
                                  "second derivative of H at the start, of particles 8 times the fastest rate"));
  }
  void check() const;
};

/// Tao's explicit method: the copies are bound by a spring, so that the energy that is added to H
///
///     C = omega (|q - x|^2 + |p - y|^2)/2,      of particles m (omega^2 |q - x|^2 + |v - w|^2)/2
///
/// and of charges by momenta p = m v + q A the same with p/m for v, and half of the fastest rate for omega in the sum.
///
/// keeps them together. The basic word is A B C B A over half steps of A and B. It is symplectic in twice the
/// dimensions, and of the order of its composition; what users see is (q, p). Second
/// derivatives of H have to be small beside omega, or the copies part: where they are a tenth of the state apart the
/// run ends by name.
/// @cost 3 s + 1 evaluations for a composition of s sub-steps
/// @source Tao2016
template <class Real> class TaoMethod final : public Method<Real> {
 public:
  TaoMethod(const MethodInfo& info, const MethodOptions& options);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<TaoMethod>(*this); }
  MethodClaims claims() const override;
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::history; }
  void moved(VectorField<Real>& f, const Real& t, const Vector<Real>& y) override;
  void save(SavedState& saved, const std::string& prefix) const override;
  void load(const SavedState& saved, const std::string& prefix) override;

 private:
  void begin(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h);
  void scale_momenta();
  std::optional<Failure> watch();

  std::string_view name_;
  int order_;
  std::vector<Real> substeps_;
  std::optional<double> given_omega_;
  bool second_order_ = false, of_particles_ = false, of_momenta_ = false, begun_ = false;
  Real omega_ = Real(0), stretch_ = Real(0);
  Vector<Real> masses_, scales_;      ///< of each q; 1 where there are no particles
  std::array<Real, 2> largest_ = {};  ///< |q| and |p| so far
  Vector<Real> apart_;                ///< the second copy less the first one
  TwinStates<Real> twins_;
};

/// A semiexplicit method: from one state, parted by a multiplier mu, through a step of both copies to one state again.
///
///     (q + mu, p + nu; q - mu, p - nu) -> step of A B A -> (q1 - mu, p1 - nu; q1 + mu, p1 + nu)
///
/// The multiplier before and after the step makes it symmetric, and symplectic in the space of (q, p) itself; it keeps
/// quadratic invariants of H, as angular momentum. Only mu and nu are solved for, to rounding.
/// @cost 2 s + 1 evaluations for a composition of s sub-steps, times some six iterations
/// @source JayawardanaOhsawa2023, Ohsawa2023
template <class Real> class SemiexplicitMethod final : public Method<Real> {
 public:
  SemiexplicitMethod(const MethodInfo& info, const MethodOptions& options);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<SemiexplicitMethod>(*this); }
  MethodClaims claims() const override;
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::none; }
  void save(SavedState& /*saved*/, const std::string& /*prefix*/) const override {}
  void load(const SavedState& /*saved*/, const std::string& /*prefix*/) override {}

 private:
  std::string_view name_;
  int order_;
  std::vector<Real> substeps_;
  TwinStates<Real> twins_;
  ContinuedRoot<Real> root_;
  Vector<Real> multiplier_, rate_;
};

extern template class TaoMethod<double>;
extern template class TaoMethod<Quad>;
extern template class SemiexplicitMethod<double>;
extern template class SemiexplicitMethod<Quad>;

}  // namespace noether
