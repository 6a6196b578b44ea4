/// One kick of a charge, by every pusher, against 40 digits (mpmath; docs/theory/fields.md).

#include "integrators/gyration.hpp"
#include "numbers/dual.hpp"
#include "tests/support/catch.hpp"

#include <Eigen/LU>

#include <array>
#include <cmath>
#include <vector>

namespace noether {
namespace {

using V = Vec3<double>;

enum class Push { boris, vay, higuera_cary };

template <class Real>
Vec3<Real> push(Push by, const Vec3<Real>& u, const Vec3<Real>& a, const Vec3<Real>& rate, const Real& c,
                const Real& h) {
  if (by == Push::boris) return u + boris_push(u, a, rate, c, h);
  if (by == Push::vay) return u + vay_push(u, a, rate, c, h);
  return u + higuera_cary_push(u, a, rate, c, h);
}

double determinant(Push by, const V& u, const V& a, const V& rate) {
  using D = Dual<double, 3>;
  const auto constant = [](const V& v) { return Vec3<D>(D(v[0]), D(v[1]), D(v[2])); };
  Vec3<D> at;
  for (int k = 0; k < 3; ++k) at[k] = D::variable(u[k], static_cast<std::size_t>(k));
  const Vec3<D> after = push<D>(by, at, constant(a), constant(rate), D(1), D(1));
  Mat3<double> J;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) J(i, k) = after[i].slope[static_cast<std::size_t>(k)];
  }
  return J.determinant();
}

double angle_a_step(const GyrationAngle<double>& turn, double h) {
  const V rate(0, 0, 1), v = V(1, 0, 0) + turned<double>(V(1, 0, 0), V(0, 0, 0), rate, turn, h);
  return std::atan2(-v[1], v[0]);
}

}  // namespace

TEST_CASE("relativistic pushers: one step, and whether they keep the volume", "[integrators][charges]") {
  struct Case {
    V u, E, B;
    double strength;
    std::array<V, 3> after;  // boris, vay, higuera_cary
    double vay_volume;
  };
  const std::vector<Case> cases = {{{1, 2, 3},
                                    {0.1, -0.2, 0.3},
                                    {0.5, 0.7, -0.4},
                                    1,
                                    {V(0.34037254480314289739, 2.25660170296262610928, 3.14951866118852431298),
                                     V(0.33872292041588976185, 2.25819775446506043026, 3.15024972083371795528),
                                     V(0.33535899053803670094, 2.25926234534997347965, 3.14790784253499946556)},
                                    4.49569e-4},
                                   {{-12, 0.5, 4},
                                    {0.9, 0.1, -0.3},
                                    {-0.2, 2.5, 1.1},
                                    0.7,
                                    {V(-11.747706019807446863, 1.27453031718993174120, 2.12012091187607388573),
                                     V(-11.743742589827522587, 1.27488310703234939329, 2.12003974041238363572),
                                     V(-11.748372954255729632, 1.27657058188386452218, 2.11536268585381160739)},
                                    -6.35251e-5}};
  for (const Case& one : cases) {
    const V a = one.strength * one.E, rate = one.strength * one.B;
    for (const Push by : {Push::boris, Push::vay, Push::higuera_cary}) {
      const auto k = static_cast<std::size_t>(by);
      CAPTURE(k);
      CHECK((push<double>(by, one.u, a, rate, 1, 1) - one.after[k]).norm() < 1e-14 * one.u.norm());
      const double volume = determinant(by, one.u, a, rate) - 1;
      if (by == Push::vay) CHECK(std::abs(volume / one.vay_volume - 1) <= 1e-3);
      if (by != Push::vay) CHECK(std::abs(volume) < 1e-14);
      // Time symmetric: the step back undoes it.
      const V there = push<double>(by, one.u, a, rate, 1, 0.3);
      CHECK((push<double>(by, there, a, rate, 1, -0.3) - one.u).norm() < 1e-14 * one.u.norm());
    }
  }
}

TEST_CASE("relativistic pushers at speeds and turns beyond all measure", "[integrators][charges]") {
  for (const double gamma : {1.0, 20.0, 1e6}) {
    for (const double turn : {1e-9, 1.0, 1e3, 1e9}) {
      CAPTURE(gamma, turn);
      const V u(0.3 * gamma, -0.8 * gamma, 0.5 * gamma), rate = turn * gamma * V(0.3, 0.2, 0.9);
      for (const Push by : {Push::boris, Push::vay, Push::higuera_cary}) {
        // Without an electric field the speed stays, and the part along B. Vay's step goes by way of u + v x Omega h/2,
        // in which large angles take the digits of u.
        const double rounding = by == Push::vay ? 1e-15 * std::max(1.0, turn) : 1e-15;
        const V after = push<double>(by, u, V(0, 0, 0), rate, 1, 1);
        CHECK(std::abs(after.norm() / u.norm() - 1) <= 10 * rounding);
        CHECK(std::abs(dot(after, rate) / dot(u, rate) - 1) <= 10 * rounding);
      }
    }
  }
  // E above c B: nothing turns back, and all three agree in what E gives.
  const V u(0, 0, 0), E(5, 0, 0), B(0, 0, 1);
  for (const Push by : {Push::boris, Push::vay, Push::higuera_cary}) {
    const V after = push<double>(by, u, E, B, 1, 1e-3);
    CHECK(std::abs(after[0] / 5e-3 - 1) <= 1e-5);
    CHECK(std::abs(after[1]) < 3e-6);
  }
}

TEST_CASE("a force-free field: Boris drifts, the others do not", "[integrators][charges]") {
  for (const auto& [gamma, expected] : {std::pair{2.0, 0.16024}, std::pair{20.0, 0.207925}}) {
    const double v = std::sqrt(1 - 1 / (gamma * gamma));
    const V u0(0, gamma * v, 0), B(0, 0, 1), E = -cross<double>(V(u0 / gamma), B);
    for (const Push by : {Push::boris, Push::vay, Push::higuera_cary}) {
      V u = u0;
      double worst = 0;
      for (int step = 0; step < 1000; ++step) {
        u = push<double>(by, u, E, B, 1, 1);
        worst = std::max(worst, (u - u0).norm() / gamma);
      }
      if (by == Push::boris) CHECK(std::abs(worst / expected - 1) <= 1e-3);
      if (by != Push::boris) CHECK(worst < 1e-13);
    }
  }
}

TEST_CASE("the angle of a step of Boris's, corrected and in cycles", "[integrators][charges]") {
  struct Row {
    std::int64_t cycles, order;
    double at_small, at_half, at_two;
  };
  for (const Row& row : {Row{1, 2, 0.09991679144388552835, 0.48995732625372830834, 1.57079632679489661923},
                         Row{1, 4, 0.09999991679062621938, 0.49974916968061454753, 1.85459043600322446485},
                         Row{1, 6, 0.09999999991579994587, 0.49999365460250815197, 1.94475486663271881456},
                         Row{2, 2, 0.09997917447568064355, 0.49741997818704574012, 1.85459043600322446485},
                         Row{4, 2, 0.09999479215489343316, 0.49935047996765878779, 1.95982930501491323337}}) {
    CAPTURE(row.cycles, row.order);
    const GyrationAngle<double> turn(row.cycles, row.order);
    CHECK(std::abs(angle_a_step(turn, 0.1) / row.at_small - 1) <= 2e-15);
    CHECK(std::abs(angle_a_step(turn, 0.5) / row.at_half - 1) <= 2e-15);
    CHECK(std::abs(angle_a_step(turn, 2) / row.at_two - 1) <= 2e-15);
  }
  // Slopes of the error of the angle, order by order.
  for (const std::int64_t order : {2, 4, 6, 8}) {
    const GyrationAngle<Quad> turn(2, order);
    const auto error = [&](double h) {
      const Vec3<Quad> rate(0, 0, 1), v = turned<Quad>({1, 0, 0}, {0, 0, 0}, rate, turn, Quad(h));
      const TurnCoefficients<Quad> exact = GyrationAngle<Quad>().over(Quad(h), Quad(1));
      return static_cast<double>(abs(-v[1] - exact.sine));
    };
    const double slope = std::log2(error(0.2) / error(0.1));
    CHECK(std::abs(slope / (static_cast<double>(order) + 1) - 1) <= 0.03);
  }
}

TEST_CASE("cycles in closed form are so many of Boris's steps", "[integrators][charges]") {
  const V v(0.3, -0.4, 0.5), E(0.1, -0.2, 0.3), B(0.5, 0.7, -0.4);
  const auto after = [&](std::int64_t cycles) {
    return V(v + turned<double>(v, E, B, GyrationAngle<double>(cycles, 2), 1.5));
  };
  CHECK((after(1) - V(-0.2704356846473029045, -0.0747925311203319502, 1.14356846473029045643)).norm() < 1e-14);
  CHECK((after(3) - V(-0.3666633121385163572, -0.0056903484268799531, 1.14421275007981463530)).norm() < 1e-14);
  // Boris's own formula, cycle by cycle.
  V stepwise = v;
  for (int cycle = 0; cycle < 3; ++cycle) {
    const V minus = stepwise + 0.25 * E, t = 0.25 * B, prime = minus + cross<double>(minus, t);
    stepwise = minus + 2 / (1 + norm2(t)) * cross<double>(prime, t) + 0.25 * E;
  }
  CHECK((after(3) - stepwise).norm() < 1e-15);
}

TEST_CASE("the exact helix: any angle, none, and no field", "[integrators][charges]") {
  const GyrationAngle<Quad> turn;
  const Vec3<Quad> v(Quad(3) / 10, Quad(-4) / 10, Quad(1) / 2), E(Quad(1) / 10, Quad(-2) / 10, Quad(3) / 10);
  for (const double strength : {0.0, 1e-200, 1e-9, 1.0, 1e3, 1e6}) {
    CAPTURE(strength);
    const V rate = strength * V(0.5, 0.7, -0.4);
    const Vec3<Quad> wide = rate.cast<Quad>();
    // Two halves are the whole, and doubles are 113 bits to rounding of the angle.
    const Vec3<Quad> half = v + turned<Quad>(v, E, wide, turn, Quad(0.75));
    const Vec3<Quad> whole = v + turned<Quad>(v, E, wide, turn, Quad(1.5));
    CHECK(static_cast<double>((half + turned<Quad>(half, E, wide, turn, Quad(0.75)) - whole).norm()) < 1e-26);
    const V narrow =
        V(0.3, -0.4, 0.5) + turned<double>(V(0.3, -0.4, 0.5), V(0.1, -0.2, 0.3), rate, GyrationAngle<double>(), 1.5);
    for (int k = 0; k < 3; ++k) CHECK(std::abs(narrow[k] - static_cast<double>(whole[k])) < 1e-15 + 3e-16 * strength);
  }
}

}  // namespace noether
