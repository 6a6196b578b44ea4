#pragma once
/// Y' = A(t) Y on SO(n): frames that turn at a given rate.

#include "engine/signature.hpp"
#include "integrators/classical.hpp"
#include "integrators/lie/lie_field.hpp"

#include <fmt/format.h>

#include <concepts>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// The largest matrices of rotations.
inline constexpr Index most_dimensions = 8;

/// A matrix of few rows, which needs no memory of its own.
template <class Real>
using SmallMatrix =
    Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, most_dimensions, most_dimensions>;

/// What a field Y' = A(t) Y on SO(n) offers: n, and A above its diagonal; below it stands the negative of that.
///
///     struct Frame : RotationMatrix<3> {
///       template <class Real> void rates(const Real& t, SmallMatrix<Real>& A) const {
///         A(0, 1) = -Real(0.5) * t;   // the frame turns about its third axis, faster and faster
///       }
///     };
///
/// A is 0 before the call.
template <class S, class Real>
concept LinearRotation = requires(const S& system, const Real& t, SmallMatrix<Real>& A) {
  { S::dimension } -> std::convertible_to<Index>;
  system.rates(t, A);
};

/// The variables of such a field, Y row by row, from the unit matrix on.
template <Index n>
  requires(n >= 2 && n <= most_dimensions)
struct RotationMatrix {
  static constexpr Index dimension = n;

  Index size() const { return n * n; }
  std::vector<double> start() const {
    std::vector<double> unit(static_cast<std::size_t>(n * n), 0.0);
    for (Index i = 0; i < n; ++i) unit[static_cast<std::size_t>(i * (n + 1))] = 1;
    return unit;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (Index i = 1; i <= n; ++i) {
      for (Index k = 1; k <= n; ++k) all.push_back(fmt::format("Y{}{}", i, k));
    }
    return all;
  }
};

/// The exponential of a skew matrix of n rows, a rotation but for rounding: a diagonal approximant of Pade, squared.
/// @cost some 20 n^3 products
template <class Real> void exponential_of_skew(const SmallMatrix<Real>& A, SmallMatrix<Real>& out);
extern template void exponential_of_skew(const SmallMatrix<double>&, SmallMatrix<double>&);
extern template void exponential_of_skew(const SmallMatrix<Quad>&, SmallMatrix<Quad>&);

/// SO(n) acting on matrices of n rows from the left: elements are skew matrices, of which the numbers above the
/// diagonal are kept, row by row.
template <class Real> class RotationField : public LieField<Real> {
 public:
  explicit RotationField(Index n) : n_(n), A_(n, n), B_(n, n), C_(n, n), Y_(n, n) {}

  Index size() const override { return n_ * n_; }
  Index algebra() const override { return n_ * (n_ - 1) / 2; }
  bool linear() const override { return true; }
  void act(const Vector<Real>& u, const Vector<Real>& y, Vector<Real>& out) override;
  void bracket(const Vector<Real>& u, const Vector<Real>& v, Vector<Real>& out) override;
  void sizes(const Vector<Real>& /*y*/, const Vector<Real>& /*y1*/, double /*h*/, Vector<double>& out) const override {
    out.setOnes(algebra());
  }
  void bind(const ParticleSystem<Real>& s) override;
  void check_start(const ParticleSystem<Real>& s) const override;
  void gather(const ParticleSystem<Real>& s, Vector<Real>& y) const override;
  void scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const override;
  EnergyTerms<Real> energy(const ParticleSystem<Real>& /*s*/) override { return {}; }
  void accelerations(const ParticleSystem<Real>& /*s*/, VectorColumn<Real>& /*a*/) override {}

 protected:
  /// Writes A above its diagonal into a matrix of zeros.
  virtual void rates(const Real& t, SmallMatrix<Real>& A) = 0;
  void find_velocity(const Real& t, const Vector<Real>& y, Vector<Real>& a) override;
  void evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) override;

 private:
  Index n_;
  SmallMatrix<Real> A_, B_, C_, Y_;  ///< work
  Vector<Real> a_;
};

extern template class RotationField<double>;
extern template class RotationField<Quad>;

/// A system of a user as such a field.
template <class S, class Real> class LinearRotationField final : public RotationField<Real> {
 public:
  explicit LinearRotationField(S system) : RotationField<Real>(S::dimension), system_(std::move(system)) {}

  std::unique_ptr<VectorField<Real>> clone() const override { return std::make_unique<LinearRotationField>(*this); }
  FieldClaims claims() const override {
    return {.name = detail::name_of(system_), .variables = true, .time_dependent = true};
  }
  std::string signature() const override { return detail::signature_of(system_); }

 protected:
  void rates(const Real& t, SmallMatrix<Real>& A) override { system_.rates(t, A); }

 private:
  S system_;
};

/// A field of a function that writes A(t) above its diagonal:
/// `lie(linear_rotation<5>([](const auto& t, auto& A) { A(0, 1) = t; }), method("magnus_6"))`.
template <Index n, class F> struct RotationBy : RotationMatrix<n> {
  F function;

  std::string name() const { return "linear_rotation"; }
  template <class Real> void rates(const Real& t, SmallMatrix<Real>& A) const { function(t, A); }
};
template <Index n, class F> RotationBy<n, F> linear_rotation(F function) { return {{}, std::move(function)}; }

/// A method on groups, or for y' = f, over such a field.
/// @throws Error  see `make_method`
template <class S>
  requires LinearRotation<S, double> Classical<double> lie(S system, const MethodChoice& choice) {
    return Classical<double>(std::make_unique<LinearRotationField<S, double>>(std::move(system)), choice);
  }

}  // namespace noether
