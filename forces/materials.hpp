#pragma once
/// Materials that keep the energy of their deformation: an energy of C = F^T F, from which the stress follows.

#include "engine/description.hpp"
#include "numbers/dual.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace noether {

/// A symmetric tensor of 3 x 3 numbers.
template <class Real> struct Symmetric {
  Real xx, yy, zz, xy, xz, yz;

  /// a : b, the sum of the products of all nine.
  friend Real contract(const Symmetric& a, const Symmetric& b) {
    const Real outer = a.xy * b.xy + a.xz * b.xz + a.yz * b.yz;
    return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + (outer + outer);
  }
  friend Symmetric operator+(const Symmetric& a, const Symmetric& b) {
    return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
  }
  friend Symmetric operator*(const Real& f, const Symmetric& a) {
    return {f * a.xx, f * a.yy, f * a.zz, f * a.xy, f * a.xz, f * a.yz};
  }
};

/// The determinant times the inverse.
template <class Real> Symmetric<Real> adjugate(const Symmetric<Real>& c) {
  return {c.yy * c.zz - c.yz * c.yz, c.xx * c.zz - c.xz * c.xz, c.xx * c.yy - c.xy * c.xy,
          c.xz * c.yz - c.xy * c.zz, c.xy * c.yz - c.xz * c.yy, c.xy * c.xz - c.yz * c.xx};
}
template <class Real> Real determinant(const Symmetric<Real>& c) {
  const Symmetric<Real> a = adjugate(c);
  return c.xx * a.xx + c.xy * a.xy + c.xz * a.xz;
}

/// A material: `energy(C)` per volume at rest, templated on the number type, of the right Cauchy-Green tensor C = F^T
/// F.
///
///     struct Ogden {
///       double mu = 0;  // [pressure]
///       static constexpr auto describe() { return part<Ogden>("ogden", ..., field<&Ogden::mu>("mu", "pressure")); }
///       template <class Real> Real energy(const Symmetric<Real>& C) const;
///     };
///
/// Whatever is made of C alone turns with the body. It is 0 in the body at rest, C = 1, and should be least there. A
/// material may bring its second Piola-Kirchhoff stress S = 2 dW/dC as `stress(C)`; without, dual numbers find it.
template <class M, class Real>
concept ElasticMaterial = requires(const M& material, const Symmetric<Real>& c) {
  { material.energy(c) } -> std::convertible_to<Real>;
};

/// The second Piola-Kirchhoff stress of a material, S = 2 dW/dC [pressure].
/// @cost without a `stress` of the material, the energy with six derivatives
template <class Real, class M> Symmetric<Real> stress_of(const M& material, const Symmetric<Real>& c) {
  if constexpr (requires { material.stress(c); }) {
    return material.stress(c);
  } else {
    using D = Dual<Real, 6>;
    const Symmetric<D> along = {D::variable(c.xx, 0), D::variable(c.yy, 1), D::variable(c.zz, 2),
                                D::variable(c.xy, 3), D::variable(c.xz, 4), D::variable(c.yz, 5)};
    const D w = material.energy(along);
    const Real two(2);  // of xy, xz, yz each stands for two of the nine numbers
    return {two * w.slope[0], two * w.slope[1], two * w.slope[2], w.slope[3], w.slope[4], w.slope[5]};
  }
}

/// How energy grows with deformation.
enum class ElasticLaw : std::uint8_t {
  saint_venant_kirchhoff,  ///< W = lambda (tr E)^2/2 + mu E:E with E = (C - 1)/2
  neo_hookean              ///< W = mu (tr C - 3)/2 - mu ln J + lambda (ln J)^2/2 with J^2 = det C
};

template <> struct EnumNames<ElasticLaw> {
  static constexpr std::array<std::pair<ElasticLaw, std::string_view>, 2> values = {
      {{ElasticLaw::saint_venant_kirchhoff, "saint_venant_kirchhoff"}, {ElasticLaw::neo_hookean, "neo_hookean"}}};
};

/// A law with its two constants, those of Lame [pressure].
struct IsotropicLaw {
  ElasticLaw kind;
  double lambda, mu;
};

/// The built-in materials, by the constants of Lame or by Young's modulus and Poisson's ratio.
///
///     saint_venant_kirchhoff   W = lambda (tr E)^2/2 + mu E:E,  E = (C - 1)/2
///     neo_hookean              W = mu (tr C - 3)/2 - mu ln J + lambda (ln J)^2/2,  J^2 = det C
///
/// Both are Hooke's law where deformations are small. The first one is the simplest that turns with the body; it has
/// little to set against being pressed flat, where neo-Hookean energy grows without bound.
/// @source SimoTarnow1992, Gonzalez2000
struct IsotropicMaterial {
  ElasticLaw material = ElasticLaw::saint_venant_kirchhoff;
  std::optional<double> lambda = {}, mu = {};                    ///< [pressure]
  std::optional<double> young_modulus = {}, poisson_ratio = {};  ///< instead of them [pressure], [1]

  static constexpr auto describe() {
    return part<IsotropicMaterial>(
        "hyperelastic", "bodies that deform: tetrahedra of a mesh, of an elastic material",
        formula("U = sum over tetrahedra V W(C), C = F^T F, F = dx/dX"), source("SimoTarnow1992, Gonzalez2000"),
        field<&IsotropicMaterial::material>("material", "1", "how energy grows with deformation"),
        field<&IsotropicMaterial::lambda>("lambda", "pressure", "Lame's first constant"),
        field<&IsotropicMaterial::mu>("mu", "pressure", "Lame's second constant, the shear modulus"),
        field<&IsotropicMaterial::young_modulus>("young_modulus", "pressure", "instead of lambda and mu"),
        field<&IsotropicMaterial::poisson_ratio>("poisson_ratio", "1", "instead of lambda and mu"));
  }
  /// @throws Error  unless it is given by two constants of one kind, those of a stable material
  void check() const;
  /// @throws never; constants that are not given are 0
  IsotropicLaw law() const;

  template <class Real> Real energy(const Symmetric<Real>& c) const {
    const auto [kind, l, m] = law();
    const Real half_lambda(l / 2), half_mu(m / 2), one(1);
    if (kind == ElasticLaw::saint_venant_kirchhoff) {
      const Symmetric<Real> e = {c.xx - one, c.yy - one, c.zz - one, c.xy, c.xz, c.yz};  // 2 E
      const Real trace = e.xx + e.yy + e.zz, quarter(0.25);
      return quarter * (half_lambda * trace * trace + Real(m) * contract(e, e));
    }
    using std::log;
    const Real twice = log(determinant(c)), quarter(0.25);  // 2 ln J
    const Real trace = (c.xx - one) + (c.yy - one) + (c.zz - one);
    return half_mu * (trace - twice) + quarter * half_lambda * twice * twice;
  }
  template <class Real> Symmetric<Real> stress(const Symmetric<Real>& c) const {
    const auto [kind, l, m] = law();
    if (kind == ElasticLaw::saint_venant_kirchhoff) return kirchhoff(c, Real(l / 2), Real(m));
    using std::log;
    const Real j2 = determinant(c), one(1);
    const Symmetric<Real> inverse = (one / j2) * adjugate(c);
    const Real by_inverse = Real(l / 2) * log(j2) - Real(m);
    Symmetric<Real> s = by_inverse * inverse;
    s.xx += Real(m);
    s.yy += Real(m);
    s.zz += Real(m);
    return s;
  }
  /// That of Saint-Venant and Kirchhoff, S = lambda tr E + 2 mu E.
  template <class Real>
  static Symmetric<Real> kirchhoff(const Symmetric<Real>& c, const Real& half_lambda, const Real& mu) {
    const Real one(1), xx = c.xx - one, yy = c.yy - one, zz = c.zz - one;
    const Real p = half_lambda * ((xx + yy) + zz);
    return {p + mu * xx, p + mu * yy, p + mu * zz, mu * c.xy, mu * c.xz, mu * c.yz};
  }
};

}  // namespace noether
