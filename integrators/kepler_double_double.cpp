#include "integrators/kepler_double_double.hpp"

#include "integrators/kepler_impl.hpp"

#include <array>
#include <cmath>

namespace noether::detail {

template <> constexpr DoubleDouble kepler_constant<DoubleDouble>(Quad x) { return DoubleDouble(x); }

/// The series of double-doubles: terms below 1e-17 are summed in doubles, whose rounding does not reach 1e-33.
template <> struct StumpffSeries<DoubleDouble> {
  static constexpr std::size_t wide = 9, all = 17;
  std::array<DoubleDouble, wide> first{};
  std::array<double, all - wide> rest{};

  explicit constexpr StumpffSeries(int n) {
    Quad term(1);
    for (std::size_t k = 0; k < all; ++k) {
      if (k < wide) first[k] = DoubleDouble(term);
      if (k >= wide) rest[k - wide] = static_cast<double>(term);
      const int j = 2 * static_cast<int>(k) + n;
      term /= -Quad(j + 1) * Quad(j + 2);
    }
  }

  DoubleDouble operator()(const DoubleDouble& z) const {
    double small = rest.back();
    for (std::size_t k = rest.size() - 1; k-- > 0;) small = rest[k] + z.high * small;
    DoubleDouble sum = small;
    for (std::size_t k = wide; k-- > 0;) sum = first[k] + z * sum;
    return sum;
  }
};

template <> struct WiderType<DoubleDouble> { using type = Quad; };

namespace {

Vec3<double> high_vector(const Vec3<DoubleDouble>& a) { return {a[0].high, a[1].high, a[2].high}; }

/// The rest of a step that is a rounding error of doubles long: its products need no low words.
void shift_slightly(UniversalFunctions<DoubleDouble>& g, double beta, double d) {
  const double half = 0.5 * d, g0 = g.g0.high, g1 = g.g1.high, g2 = g.g2.high;
  g.g3 += d * (g2 + half * g1);
  g.g2 += d * (g1 + half * g0);
  g.g1 += d * (g0 - half * beta * g1);
  g.g0 += -d * beta * (g1 + half * g0);
}

/// The arc from the s of doubles. @return whether it was good enough
bool arc_from_doubles(const Vec3<DoubleDouble>& x, const Vec3<DoubleDouble>& v, const DoubleDouble& mu,
                      const DoubleDouble& h, KeplerArc<DoubleDouble>& arc) {
  const KeplerArc<double> rough = kepler_arc(high_vector(x), high_vector(v), mu.high, h.high);
  if (rough.status != KeplerStatus::converged || rough.s == 0) return false;
  const DoubleDouble r0 = sqrt(norm2(x)), inverse = 1.0 / r0, eta0 = dot(x, v), v2 = norm2(v);
  const DoubleDouble twice = mu * inverse, beta = 2.0 * twice - v2, zeta0 = r0 * v2 - mu;
  // Beyond a half turn, and on long hyperbolas, other forms of the sums lose less.
  const double z = beta.high * rough.s * rough.s;
  if (!(z < 9.8 && z > -1)) return false;
  UniversalFunctions<DoubleDouble> g(beta, rough.s);
  const DoubleDouble missing = (h - rough.s * r0) - (eta0 * g.g2 + zeta0 * g.g3);
  const DoubleDouble r = r0 + (eta0 * g.g1 + zeta0 * g.g2), eta = eta0 * g.g0 + zeta0 * g.g1;
  const double first = missing.high / r.high, d = first - 0.5 * eta.high / r.high * first * first;
  constexpr double slight = 0x1p-46;
  if (!(std::abs(d) < slight * std::abs(rough.s) && std::abs(eta.high * d) < slight * r.high)) return false;
  shift_slightly(g, beta.high, d);
  const DoubleDouble zeta = mu - beta * r;
  const DoubleDouble end = r + d * (eta.high + 0.5 * d * zeta.high);
  const DoubleDouble delay = mu * g.g3, along = r0 * g.g1, across = eta0 * g.g2;
  const bool early = std::abs(delay.high) <= std::abs(along.high) + std::abs(across.high);
  const DoubleDouble advance = early ? h - delay : along + across, pull = -(mu / end);
  arc.dx = -(twice * g.g2) * x + advance * v;
  arc.dv = (pull * (g.g1 * inverse)) * x + (pull * g.g2) * v;
  arc.s = DoubleDouble::sum(rough.s, d);
  arc.iterations = 1;
  arc.status = KeplerStatus::converged;
  return all_finite(arc);
}

}  // namespace

}  // namespace noether::detail

namespace noether {

template <>
KeplerArc<DoubleDouble> kepler_arc(const Vec3<DoubleDouble>& x, const Vec3<DoubleDouble>& v, DoubleDouble mu,
                                   DoubleDouble h) {
  const double most = 1e30, least = 1e-30, longest = 1e20, r2 = norm2(detail::high_vector(x));
  const bool ordinary = r2 > least && r2 < most && norm2(detail::high_vector(v)) < most && std::abs(mu.high) < most &&
                        std::abs(h.high) < longest;
  if (!ordinary) return detail::scaled_arc(x, v, mu, h);
  KeplerArc<DoubleDouble> arc;
  if (mu.high > 0 && detail::arc_from_doubles(x, v, mu, h, arc)) return arc;
  return detail::arc_in_range(x, v, mu, h);
}

}  // namespace noether
