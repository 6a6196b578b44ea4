#include "integrators/kepler_tangent.hpp"

#include "integrators/universal_functions.hpp"

#include <cmath>

namespace noether {

namespace {

/// G_0 to G_5 at s, by halving and doubling as `UniversalFunctions`; the last two are what derivatives by beta ask for.
template <class Real> struct SixFunctions {
  Real g0, g1, g2, g3, g4, g5;

  SixFunctions(const Real& beta, const Real& s) {
    using std::abs;
    constexpr int most_halvings = 15;
    int halvings = 0;
    Real part = s, z = beta * s * s;
    for (; !(abs(z) <= Real(1)) && halvings < most_halvings; ++halvings) {
      part *= Real(0.5);
      z *= Real(0.25);
    }
    const Real square = part * part;
    g4 = square * square * detail::stumpff_4<Real>(z) / Real(24);
    g5 = part * square * square * detail::stumpff_5<Real>(z) / Real(120);
    g2 = square / Real(2) - beta * g4;
    g3 = part * square / Real(6) - beta * g5;
    g1 = part - beta * g3;
    g0 = Real(1) - beta * g2;
    for (; halvings > 0; --halvings) {
      g5 = Real(2) * (g5 + part * g4 + g2 * g3);
      g4 = Real(2) * (part + g1) * g3;
      g3 = Real(2) * (g3 + g1 * g2);
      g2 = Real(2) * g1 * g1;
      g1 = Real(2) * g0 * g1;
      g0 = Real(1) - beta * g2;
      part *= Real(2);
    }
  }
};

/// Derivatives by r0, by eta0 = x0 . v0 and by beta, which are what an arc depends on beside mu and h.
template <class Real> struct SlopesOf { Real r, eta, beta; };

}  // namespace

template <class Real>
KeplerTangentOf<Real>::KeplerTangentOf(const Vec3<Real>& x0, const Vec3<Real>& v0, const Real& mu, const Real& h,
                                       const Real& s)
    : x0_(x0), v0_(v0) {
  using Slopes = SlopesOf<Real>;
  using std::sqrt;
  const Real two(2);
  const Real r0 = sqrt(norm2(x0)), eta0 = dot(x0, v0), v2 = norm2(v0);
  const Real beta = two * mu / r0 - v2, zeta0 = r0 * v2 - mu;
  const SixFunctions<Real> g(beta, s);
  const Real r = r0 + (eta0 * g.g1 + zeta0 * g.g2), eta = eta0 * g.g0 + zeta0 * g.g1;
  const Real g1_beta = (g.g3 - s * g.g2) / two, g2_beta = g.g4 - s * g.g3 / two,
             g3_beta = (Real(3) * g.g5 - s * g.g4) / two;
  // From t(s) = r0 s + eta0 G2 + zeta0 G3 = h and r = dt/ds, where zeta0 = mu - beta r0.
  const Slopes s_by{-g.g1 / r, -g.g2 / r, -(eta0 * g2_beta + zeta0 * g3_beta - r0 * g.g3) / r};
  const Slopes r_by{g.g0 + eta * s_by.r, g.g1 + eta * s_by.eta,
                    eta0 * g1_beta + zeta0 * g2_beta - r0 * g.g2 + eta * s_by.beta};
  const auto by = [&](const Real& along_s, const Real& by_beta) {
    return Slopes{along_s * s_by.r, along_s * s_by.eta, along_s * s_by.beta + by_beta};
  };
  const Slopes g1_by = by(g.g0, g1_beta), g2_by = by(g.g1, g2_beta), g3_by = by(g.g2, g3_beta);
  // f = 1 - mu G2 / r0,  g = h - mu G3,  f' = -mu G1 / (r r0),  g' = 1 - mu G2 / r
  const auto over = [](const Real& value, const Slopes& top, const Real& bottom, const Slopes& of_bottom) {
    const Real part = value / bottom;
    return Slopes{(top.r - part * of_bottom.r) / bottom, (top.eta - part * of_bottom.eta) / bottom,
                  (top.beta - part * of_bottom.beta) / bottom};
  };
  const Slopes r_r0{r + r0 * r_by.r, r0 * r_by.eta, r0 * r_by.beta};
  const auto put = [&](const Real& value, const Slopes& slopes, Real& out, Real& x, Real& of_eta, Real& v) {
    out = value;
    x = -mu * (slopes.r - two * mu / (r0 * r0) * slopes.beta) / r0;
    of_eta = -mu * slopes.eta;
    v = two * mu * slopes.beta;
  };
  put(Real(1) - mu * g.g2 / r0, over(g.g2, g2_by, r0, {Real(1), Real(0), Real(0)}), upper_.f, upper_.f_x, upper_.f_eta,
      upper_.f_v);
  put(h - mu * g.g3, g3_by, upper_.g, upper_.g_x, upper_.g_eta, upper_.g_v);
  put(-mu * g.g1 / (r * r0), over(g.g1, g1_by, r * r0, r_r0), lower_.f, lower_.f_x, lower_.f_eta, lower_.f_v);
  put(Real(1) - mu * g.g2 / r, over(g.g2, g2_by, r, r_by), lower_.g, lower_.g_x, lower_.g_eta, lower_.g_v);
}

template <class Real>
Vec3<Real> KeplerTangentOf<Real>::Half::turned(const KeplerChangeOf<Real>& start, const Vec3<Real>& x0,
                                               const Vec3<Real>& v0) const {
  const Real xx = dot(x0, start.x), vx = dot(v0, start.x), xv = dot(x0, start.v), vv = dot(v0, start.v);
  const Real of_f = f_x * xx + f_eta * (vx + xv) + f_v * vv, of_g = g_x * xx + g_eta * (vx + xv) + g_v * vv;
  return (f * start.x + g * start.v) + (of_f * x0 + of_g * v0);
}

/// Phi is symplectic, so Phi^-1 (0, a) = (-Q^T a, P^T a) with the blocks P = dx1/dx0 and Q = dx1/dv0.
template <class Real> KeplerChangeOf<Real> KeplerTangentOf<Real>::start_of(const Vec3<Real>& a) const {
  const Half& h = upper_;
  const Real ax = dot(x0_, a), av = dot(v0_, a);
  const Real along_x = h.f_x * ax + h.g_x * av, across = h.f_eta * ax + h.g_eta * av, along_v = h.f_v * ax + h.g_v * av;
  return {-(h.g * a + (across * x0_ + along_v * v0_)), h.f * a + (along_x * x0_ + across * v0_)};
}

template class KeplerTangentOf<double>;
template class KeplerTangentOf<Quad>;

}  // namespace noether
