/// Kepler arcs in double-double against those in 113 bits.

#include "integrators/kepler_double_double.hpp"
#include "tests/integrators/kepler_orbits.hpp"

using namespace noether;
using namespace noether::kepler_test;

namespace {

using Pairs = kepler_test::State<DoubleDouble>;

constexpr double pair_unit = 0x1p-104;  // what sums of double-doubles are right to

Pairs as_pairs(const Quads& s) { return {s.x.cast<DoubleDouble>(), s.v.cast<DoubleDouble>()}; }
Quads widen(const Pairs& s) { return {s.x.cast<Quad>(), s.v.cast<Quad>()}; }

KeplerArc<Quad> truth_of(const Pairs& s, const DoubleDouble& mu, const DoubleDouble& h) {
  const Quads wide = widen(s);
  return kepler_arc(wide.x, wide.v, Quad(mu), Quad(h));
}

/// Largest errors of dx and dv relative to |x| and |v| at the start or at the end, whichever is larger.
struct Errors {
  double dx = 0, dv = 0;
  void add(const Pairs& s, const KeplerArc<DoubleDouble>& arc, const KeplerArc<Quad>& truth) {
    const Quads wide = widen(s);
    const auto relative = [](const Vec3<DoubleDouble>& found, const Vec3<Quad>& right, const Vec3<Quad>& start) {
      const Quad size = std::max(length(start), length<Quad>(start + right));
      return static_cast<double>(length<Quad>(found.cast<Quad>() - right) / size);
    };
    dx = std::max(dx, relative(arc.dx, truth.dx, wide.x));
    dv = std::max(dv, relative(arc.dv, truth.dv, wide.v));
  }
};

/// Arcs of a part of a period, from anywhere on ellipses of one eccentricity.
Errors planetary_errors(double e, double fraction, int cases) {
  Random random(7);
  Errors worst;
  for (int n = 0; n < cases; ++n) {
    const Quad a(random(1, 2)), mu(random(0.5, 2));
    const Quads start = on_ellipse(Turn(random), mu, a, Quad(e), Quad(random(0, 6.3)));
    const Pairs s = as_pairs(start);
    const DoubleDouble h(static_cast<double>(two_pi * sqrt(a * a * a / mu)) * fraction), m(mu);
    const KeplerArc<DoubleDouble> arc = kepler_arc(s.x, s.v, m, h);
    REQUIRE(arc.status == KeplerStatus::converged);
    CHECK(arc.iterations == 1);  // in double-double: the rest was found in doubles
    worst.add(s, arc, truth_of(s, m, h));
  }
  return worst;
}

}  // namespace

TEST_CASE("planetary arcs in double-double are right to 1e-30", "[kepler][double_double]") {
  for (const double fraction : {1 / 100.0, 1 / 20.0, 1 / 6.0, -1 / 12.0}) {
    for (const double e : {0.0, 0.05, 0.3}) {
      CAPTURE(e, fraction);
      const Errors worst = planetary_errors(e, fraction, 300);
      CHECK(worst.dx < 1e-30);
      CHECK(worst.dv < 1e-30);
    }
  }
  const Errors eccentric = planetary_errors(0.9, 1 / 40.0, 300);
  CHECK(eccentric.dx < 1e-29);
  CHECK(eccentric.dv < 1e-29);
}

TEST_CASE("any conic and any time in double-double: the error is what rounding the inputs would do",
          "[kepler][double_double]") {
  Random random(11);
  double worst = 0;
  for (int n = 0; n < 3000; ++n) {
    const Case c = random_case(random);
    const Pairs s{c.state.x.cast<DoubleDouble>(), c.state.v.cast<DoubleDouble>()};
    const DoubleDouble mu(c.mu), h(c.h);
    const KeplerArc<DoubleDouble> arc = kepler_arc(s.x, s.v, mu, h);
    const KeplerArc<Quad> truth = truth_of(s, mu, h);
    REQUIRE(arc.status == KeplerStatus::converged);
    const double error = roundings({arc.dx.cast<Quad>(), arc.dv.cast<Quad>()}, {truth.dx, truth.dv},
                                   condition(widen(s), Quad(mu), Quad(h)), pair_unit);
    if (error > 64) UNSCOPED_INFO("case " << n << ", e = " << c.e << ", error " << error);
    worst = std::max(worst, error);
  }
  CHECK(worst < 64);
}

TEST_CASE("low words of every input count", "[kepler][double_double]") {
  Random random(3);
  const Quads start = on_ellipse(Turn(random), Quad(1), Quad(1), Quad(0.2), Quad(1));
  const Pairs s = as_pairs(start);
  const DoubleDouble one(1.0), h(0.5), more(1.0, 0x1p-60), longer(0.5, 0x1p-61);
  for (const auto& [mu, time] : {std::pair(one, h), std::pair(more, h), std::pair(one, longer)}) {
    Errors errors;
    errors.add(s, kepler_arc(s.x, s.v, mu, time), truth_of(s, mu, time));
    CHECK(errors.dx < 1e-30);
    CHECK(errors.dv < 1e-30);
  }
}

TEST_CASE("reversing velocity and time gives the same arc in double-double, bit for bit", "[kepler][double_double]") {
  Random random(5);
  for (int n = 0; n < 200; ++n) {
    const Case c = random_case(random);
    const Pairs s{c.state.x.cast<DoubleDouble>(), c.state.v.cast<DoubleDouble>()};
    const DoubleDouble mu(c.mu), h(c.h);
    const KeplerArc<DoubleDouble> there = kepler_arc(s.x, s.v, mu, h),
                                  mirrored = kepler_arc(s.x, Vec3<DoubleDouble>(-s.v), mu, -h);
    for (int k = 0; k < 3; ++k) {
      CHECK(there.dx[k] == mirrored.dx[k]);
      CHECK(there.dv[k] == -mirrored.dv[k]);
    }
  }
}

TEST_CASE("a million arcs in double-double keep the energy of the orbit to 1e-27", "[kepler][double_double][slow]") {
  Random random(9);
  Pairs s = as_pairs(on_ellipse(Turn(random), Quad(1), Quad(1), Quad(0.2), Quad(0.7)));
  const auto energy = [&] {
    const Quads wide = widen(s);
    return norm2(wide.v) / Quad(2) - Quad(1) / length(wide.x);
  };
  const Quad start = energy();
  const DoubleDouble h(static_cast<double>(two_pi) / 17.3);
  for (int n = 0; n < 1000000; ++n) {
    const KeplerArc<DoubleDouble> arc = kepler_arc(s.x, s.v, DoubleDouble(1.0), h);
    s.x += arc.dx;
    s.v += arc.dv;
  }
  CHECK(std::abs(static_cast<double>((energy() - start) / start)) < 1e-27);
}
