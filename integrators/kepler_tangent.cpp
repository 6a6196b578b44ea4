#include "integrators/kepler_tangent.hpp"

#include "integrators/universal_functions.hpp"

#include <cmath>

namespace noether {

namespace {

/// G_0 to G_5 at s, by halving and doubling as `UniversalFunctions`; the last two are what derivatives by beta ask for.
struct SixFunctions {
  double g0, g1, g2, g3, g4, g5;

  SixFunctions(double beta, double s) {
    constexpr int most_halvings = 15;
    int halvings = 0;
    double part = s, z = beta * s * s;
    for (; !(std::abs(z) <= 1) && halvings < most_halvings; ++halvings) {
      part *= 0.5;
      z *= 0.25;
    }
    const double square = part * part;
    g4 = square * square * detail::stumpff_4<double>(z) / 24;
    g5 = part * square * square * detail::stumpff_5<double>(z) / 120;
    g2 = square / 2 - beta * g4;
    g3 = part * square / 6 - beta * g5;
    g1 = part - beta * g3;
    g0 = 1 - beta * g2;
    for (; halvings > 0; --halvings) {
      g5 = 2 * (g5 + part * g4 + g2 * g3);
      g4 = 2 * (part + g1) * g3;
      g3 = 2 * (g3 + g1 * g2);
      g2 = 2 * g1 * g1;
      g1 = 2 * g0 * g1;
      g0 = 1 - beta * g2;
      part *= 2;
    }
  }
};

/// Derivatives by r0, by eta0 = x0 . v0 and by beta, which are what an arc depends on beside mu and h.
struct Slopes {
  double r, eta, beta;
};

}  // namespace

KeplerTangent::KeplerTangent(const Vec3<double>& x0, const Vec3<double>& v0, double mu, double h, double s)
    : x0_(x0), v0_(v0) {
  const double r0 = std::sqrt(norm2(x0)), eta0 = dot(x0, v0), v2 = norm2(v0);
  const double beta = 2 * mu / r0 - v2, zeta0 = r0 * v2 - mu;
  const SixFunctions g(beta, s);
  const double r = r0 + (eta0 * g.g1 + zeta0 * g.g2), eta = eta0 * g.g0 + zeta0 * g.g1;
  const double g1_beta = (g.g3 - s * g.g2) / 2, g2_beta = g.g4 - s * g.g3 / 2, g3_beta = (3 * g.g5 - s * g.g4) / 2;
  // From t(s) = r0 s + eta0 G2 + zeta0 G3 = h and r = dt/ds, where zeta0 = mu - beta r0.
  const Slopes s_by{-g.g1 / r, -g.g2 / r, -(eta0 * g2_beta + zeta0 * g3_beta - r0 * g.g3) / r};
  const Slopes r_by{g.g0 + eta * s_by.r, g.g1 + eta * s_by.eta,
                    eta0 * g1_beta + zeta0 * g2_beta - r0 * g.g2 + eta * s_by.beta};
  const auto by = [&](double along_s, double by_beta) {
    return Slopes{along_s * s_by.r, along_s * s_by.eta, along_s * s_by.beta + by_beta};
  };
  const Slopes g1_by = by(g.g0, g1_beta), g2_by = by(g.g1, g2_beta), g3_by = by(g.g2, g3_beta);
  // f = 1 - mu G2 / r0,  g = h - mu G3,  f' = -mu G1 / (r r0),  g' = 1 - mu G2 / r
  const auto over = [](double value, const Slopes& top, double bottom, const Slopes& of_bottom) {
    const double part = value / bottom;
    return Slopes{(top.r - part * of_bottom.r) / bottom, (top.eta - part * of_bottom.eta) / bottom,
                  (top.beta - part * of_bottom.beta) / bottom};
  };
  const Slopes r_r0{r + r0 * r_by.r, r0 * r_by.eta, r0 * r_by.beta};
  const auto put = [&](double value, const Slopes& slopes, double& out, double& x, double& of_eta, double& v) {
    out = value;
    x = -mu * (slopes.r - 2 * mu / (r0 * r0) * slopes.beta) / r0;
    of_eta = -mu * slopes.eta;
    v = 2 * mu * slopes.beta;
  };
  put(1 - mu * g.g2 / r0, over(g.g2, g2_by, r0, {1, 0, 0}), upper_.f, upper_.f_x, upper_.f_eta, upper_.f_v);
  put(h - mu * g.g3, g3_by, upper_.g, upper_.g_x, upper_.g_eta, upper_.g_v);
  put(-mu * g.g1 / (r * r0), over(g.g1, g1_by, r * r0, r_r0), lower_.f, lower_.f_x, lower_.f_eta, lower_.f_v);
  put(1 - mu * g.g2 / r, over(g.g2, g2_by, r, r_by), lower_.g, lower_.g_x, lower_.g_eta, lower_.g_v);
}

Vec3<double> KeplerTangent::Half::turned(const KeplerChange& start, const Vec3<double>& x0,
                                         const Vec3<double>& v0) const {
  const double xx = dot(x0, start.x), vx = dot(v0, start.x), xv = dot(x0, start.v), vv = dot(v0, start.v);
  const double of_f = f_x * xx + f_eta * (vx + xv) + f_v * vv, of_g = g_x * xx + g_eta * (vx + xv) + g_v * vv;
  return (f * start.x + g * start.v) + (of_f * x0 + of_g * v0);
}

/// Phi is symplectic, so Phi^-1 (0, a) = (-Q^T a, P^T a) with the blocks P = dx1/dx0 and Q = dx1/dv0.
KeplerChange KeplerTangent::start_of(const Vec3<double>& a) const {
  const Half& h = upper_;
  const double ax = dot(x0_, a), av = dot(v0_, a);
  const double along_x = h.f_x * ax + h.g_x * av, across = h.f_eta * ax + h.g_eta * av,
               along_v = h.f_v * ax + h.g_v * av;
  return {-(h.g * a + (across * x0_ + along_v * v0_)), h.f * a + (along_x * x0_ + across * v0_)};
}

}  // namespace noether
