#include "tests/integrators/kepler_orbits.hpp"

#include <limits>

using namespace noether;
using namespace noether::kepler_test;

namespace {

/// Two places on one orbit whose time apart is known in closed form.
void check_closed_form(const Quads& from, const Quads& to, Quad mu, Quad h) {
  const Quads end = advanced(from, mu, h);
  CHECK(roundings(end, to, condition(from, mu, h), quad_unit) < few);
  if (norm2(to.x) < Quad(1e-8)) return;  // rounded, a place so near the center has no digits
  CHECK(error_by_condition(narrow(from), static_cast<double>(mu), static_cast<double>(h)) < few);
}

}  // namespace

TEST_CASE("an ellipse ends where Kepler's equation says", "[kepler]") {
  Random random(1);
  const Quad mu(1.75), a(2.5);
  for (const double e : {0.0, 1e-9, 0.1, 0.6, 0.95, 0.999999, 1 - 1e-15}) {
    const Turn turn(random);
    for (int n = 0; n < 12; ++n) {
      const Quad first(random(-3.2, 3.2)), last = first + Quad(random(-6.2, 6.2));
      const Quad h = ellipse_time(mu, a, Quad(e), last) - ellipse_time(mu, a, Quad(e), first);
      CAPTURE(e, static_cast<double>(first), static_cast<double>(last));
      check_closed_form(on_ellipse(turn, mu, a, Quad(e), first), on_ellipse(turn, mu, a, Quad(e), last), mu, h);
    }
  }
}

TEST_CASE("a hyperbola ends where its Kepler equation says", "[kepler]") {
  Random random(2);
  const Quad mu(0.75), a(1.25);
  for (const double e : {1 + 1e-15, 1.000001, 1.05, 2.0, 30.0, 1e6}) {
    const Turn turn(random);
    for (int n = 0; n < 12; ++n) {
      const Quad first(random(-8, 4)), last = first + Quad(random(-6, 12));
      const Quad h = hyperbola_time(mu, a, Quad(e), last) - hyperbola_time(mu, a, Quad(e), first);
      CAPTURE(e, static_cast<double>(first), static_cast<double>(last));
      check_closed_form(on_hyperbola(turn, mu, a, Quad(e), first), on_hyperbola(turn, mu, a, Quad(e), last), mu, h);
    }
  }
}

TEST_CASE("a parabola ends where Barker's equation says", "[kepler]") {
  Random random(4);
  const Quad mu(3), q(0.5);
  for (int n = 0; n < 30; ++n) {
    const Turn turn(random);
    const Quad first(random(-9, 3)), last = first + Quad(random(-10, 20));
    const Quad h = parabola_time(mu, q, last) - parabola_time(mu, q, first);
    CAPTURE(static_cast<double>(first), static_cast<double>(last));
    check_closed_form(on_parabola(turn, mu, q, first), on_parabola(turn, mu, q, last), mu, h);
  }
}

TEST_CASE("a body on a line through the center bounces there", "[kepler]") {
  Random random(6);
  const Quad mu(1), a(1), one(1);
  const Turn turn(random);
  for (int n = 0; n < 30; ++n) {
    // Anomalies on both sides of the collision at 0, up to a whole period apart.
    const Quad first(random(-3.1, -0.2)), last(random(0.2, 3.1));
    CAPTURE(static_cast<double>(first), static_cast<double>(last));
    const Quad bound = ellipse_time(mu, a, one, last) - ellipse_time(mu, a, one, first);
    check_closed_form(on_ellipse(turn, mu, a, one, first), on_ellipse(turn, mu, a, one, last), mu, bound);
    const Quad free = hyperbola_time(mu, a, one, last) - hyperbola_time(mu, a, one, first);
    check_closed_form(on_hyperbola(turn, mu, a, one, first), on_hyperbola(turn, mu, a, one, last), mu, free);
  }
  const Vec3<double> x(1, 0, 0), at_rest(0, 0, 0);
  const KeplerArc<double> fall = kepler_arc(x, at_rest, 1.0, 1.5);  // the collision is at pi / 2^1.5 = 1.11
  CHECK(fall.status == KeplerStatus::converged);
  CHECK(fall.dx[0] > -1);
  CHECK(fall.dv[0] > 0);
  CHECK(fall.dx[1] == 0);
  CHECK(fall.dv[2] == 0);
}

TEST_CASE("a million periods and a bit lose no more digits than the bit", "[kepler]") {
  Random random(7);
  for (const double e : {0.0, 0.3, 0.9, 0.999}) {
    for (const double periods : {1.25, 1e3 + 0.4, 1e6 + 0.3, -1e6 - 0.45, 1e9 + 0.2}) {
      const Quad mu(2), a(1.5), first(random(0, 6));
      const Turn turn(random);
      const Quad part(random(-3, 3)), period = two_pi * sqrt(a * a * a / mu), whole = round(Quad(periods));
      const Quads from = on_ellipse(turn, mu, a, Quad(e), first);
      const Quad bit = ellipse_time(mu, a, Quad(e), first + part) - ellipse_time(mu, a, Quad(e), first);
      const KeplerArc<Quad> arc = kepler_arc(from.x, from.v, mu, Quad(bit + whole * period));
      const Quads end{from.x + arc.dx, from.v + arc.dv}, expected = on_ellipse(turn, mu, a, Quad(e), first + part);
      CAPTURE(e, periods);
      CHECK(roundings(end, expected, condition(from, mu, bit + whole * period), quad_unit) < few);
      // The universal variable counts the periods too: s = (E1 - E0) sqrt(a / mu).
      const Quad s = sqrt(a / mu) * (part + two_pi * whole);
      CHECK(static_cast<double>(abs(arc.s / s - Quad(1))) < 64 / (1 - e) * 0x1p-112);

      const Doubles d = narrow(from);
      const double h = static_cast<double>(bit + whole * period);
      const KeplerArc<double> rough = kepler_arc(d.x, d.v, 2.0, h);
      const Quads start = widen(d);
      const KeplerArc<Quad> truth = kepler_arc(start.x, start.v, mu, Quad(h));
      // Conditioned like the remainder, not like the whole time.
      const Quad alpha = Quad(2) / length(start.x) - norm2(start.v) / mu;
      const Quad own_period = two_pi / sqrt(mu * alpha * alpha * alpha);
      const Condition left = condition(start, mu, Quad(h) - round(Quad(h) / own_period) * own_period);
      const Quads rough_change{rough.dx.cast<Quad>(), rough.dv.cast<Quad>()}, change{truth.dx, truth.dv};
      CHECK(roundings(rough_change, change, left, unit) < few);
      CHECK(std::abs(rough.s - static_cast<double>(truth.s)) < 64 / (1 - e) * unit * std::abs(rough.s));
    }
  }
}

TEST_CASE("an arc backwards undoes it and two arcs make one", "[kepler]") {
  Random random(8);
  for (int n = 0; n < 300; ++n) {
    const Case c = random_case(random);
    const Quads s = widen(c.state);
    const Quad mu(c.mu), h = Quad(c.h) * Quad(1e-3), more = h * Quad(random(-2, 2));
    const Quads there = advanced(s, mu, h), back = advanced(there, mu, -h);
    CAPTURE(n, c.e);
    CHECK(roundings(back, s, condition(there, mu, -h), quad_unit) < few);
    const Quads twice = advanced(there, mu, more), once = advanced(s, mu, h + more);
    const Condition second = condition(there, mu, more), whole = condition(s, mu, h + more);
    CHECK(roundings(twice, once, {second.x + whole.x, second.v + whole.v}, quad_unit) < few);
  }
}

TEST_CASE("reversing velocity and time gives the same arc bit for bit", "[kepler]") {
  Random random(9);
  for (int n = 0; n < 2000; ++n) {
    const Case c = random_case(random);
    const KeplerArc<double> there = kepler_arc(c.state.x, c.state.v, c.mu, c.h);
    const KeplerArc<double> mirror = kepler_arc<double>(c.state.x, -c.state.v, c.mu, -c.h);
    CAPTURE(n, c.e);
    CHECK(mirror.dx == there.dx);
    CHECK(mirror.dv == -there.dv);
    CHECK(mirror.s == -there.s);
  }
}

TEST_CASE("orbits pass smoothly through the parabola", "[kepler]") {
  for (const double direction : {-0.9, -0.3, 0.0, 0.5, 1.0}) {
    const auto end = [&](Quad alpha, Quad h) {
      const Quad speed = sqrt(Quad(2) - alpha), radial(direction);
      const Quads s{Vec3<Quad>(1, 0, 0), speed * Vec3<Quad>(radial, sqrt(Quad(1) - radial * radial), 0)};
      CHECK(error_by_condition(narrow(s), 1, static_cast<double>(h)) < few);
      return advanced(s, Quad(1), h);
    };
    for (const double h : {1e-3, 1.0, 20.0}) {
      const Quads middle = end(Quad(0), Quad(h));
      Quad last(0);
      for (int power = 20; power >= 2; --power) {
        const Quad alpha = Quad(1) / pow(Quad(10), Quad(power));
        CAPTURE(direction, h, power);
        const Quad above = length<Quad>(end(alpha, Quad(h)).x - middle.x) / alpha;
        const Quad below = length<Quad>(end(-alpha, Quad(h)).x - middle.x) / alpha;
        // The derivative by alpha: the same on both sides, and the same for all alpha up to terms of order alpha.
        if (last == Quad(0)) last = above;
        CHECK(static_cast<double>(abs(above / below - Quad(1))) < 1e3 * static_cast<double>(alpha) + 1e-10);
        CHECK(static_cast<double>(abs(above / last - Quad(1))) < 1e3 * static_cast<double>(alpha) + 1e-10);
      }
    }
  }
}

TEST_CASE("units of length and time do not matter, from 1e-100 to 1e100", "[kepler]") {
  Random random(10);
  for (int n = 0; n < 200; ++n) {
    const double e = random(0, 0.4);
    const Doubles s = narrow(on_ellipse(Turn(random), Quad(1), Quad(1), Quad(e), Quad(random(0, 6.3))));
    const KeplerArc<double> plain = kepler_arc(s.x, s.v, 1.0, 0.4);
    for (const double x : {0x1p-332, 0x1p-90, 0x1p-7, 0x1p41, 0x1p332}) {
      for (const double v : {0x1p-120, 1.0, 0x1p120}) {
        const KeplerArc<double> arc = kepler_arc<double>(s.x * x, s.v * v, x * v * v, 0.4 * x / v);
        CHECK(arc.status == KeplerStatus::converged);
        CHECK(arc.dx == plain.dx * x);
        CHECK(arc.dv == plain.dv * v);
        CHECK(arc.s == plain.s / v);
      }
    }
    CHECK(error_by_condition({s.x * 1e-100, s.v * 1e50}, 1, 0.4e-150) < few);
    CHECK(error_by_condition({s.x * 1e100, s.v * 1e-50}, 1, 0.4e150) < few);
    CHECK(error_by_condition({s.x * 1e100, s.v * 1e100}, 1e300, 0.4) < few);
  }
}

TEST_CASE("without attraction the path is straight", "[kepler]") {
  const Vec3<double> x(3, -1, 2), v(-0.5, 0.25, 1);
  const KeplerArc<double> arc = kepler_arc(x, v, 0.0, 8.0);
  CHECK(arc.status == KeplerStatus::converged);
  CHECK(arc.dx == 8 * v);
  CHECK(arc.dv == Vec3<double>::Zero());
  const KeplerArc<Quad> weak = kepler_arc<Quad>(x.cast<Quad>(), v.cast<Quad>(), Quad(1e-25), Quad(8));
  CHECK(std::abs(arc.s / static_cast<double>(weak.s) - 1) < 8 * unit);
  const KeplerArc<double> through = kepler_arc<double>(x, -x, 0.0, 2.0);
  CHECK(through.status == KeplerStatus::converged);
  CHECK(through.s == 0);
  CHECK(kepler_arc<double>(x, Vec3<double>::Zero(), 0.0, 2.0).s == 2 / length(x));
}

TEST_CASE("a repelled body keeps energy and angular momentum", "[kepler]") {
  const Quads s{Vec3<Quad>(-4, 0.25, 0), Vec3<Quad>(2, 0, 0.5)};
  const Quad mu(-1.5);
  for (const double h : {0.5, 2.0, 9.0}) {
    const Quads end = advanced(s, mu, Quad(h));
    const Quad before = norm2(s.v) / Quad(2) - mu / length(s.x), after = norm2(end.v) / Quad(2) - mu / length(end.x);
    CHECK(static_cast<double>(abs(after / before - Quad(1))) < 0x1p-107);
    const Quad turning = length<Quad>(cross(end.x, end.v) - cross(s.x, s.v)) / (length(end.x) * length(end.v));
    CHECK(static_cast<double>(turning) < 0x1p-109);
    CHECK(error_by_condition(narrow(s), -1.5, h) < few);
  }
}

TEST_CASE("no time, no arc", "[kepler]") {
  const KeplerArc<double> arc = kepler_arc<double>({1, 0, 0}, {0, 1, 0}, 1.0, 0.0);
  CHECK(arc.status == KeplerStatus::converged);
  CHECK(arc.dx == Vec3<double>::Zero());
  CHECK(arc.dv == Vec3<double>::Zero());
  CHECK(arc.s == 0);
}

TEST_CASE("what has no answer is named and leaves no NaN", "[kepler]") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const Vec3<double> x(1, 0, 0), v(0, 1, 0);
  const auto check = [](const KeplerArc<double>& arc) {
    CHECK(arc.status == KeplerStatus::not_finite);
    CHECK(arc.dx == Vec3<double>::Zero());
    CHECK(arc.dv == Vec3<double>::Zero());
    CHECK(arc.s == 0);
  };
  for (const double bad : {nan, infinite, -infinite}) {
    check(kepler_arc<double>({bad, 0, 0}, v, 1.0, 0.1));
    check(kepler_arc<double>({1, 0, bad}, v, 1.0, 0.1));
    check(kepler_arc<double>(x, {0, bad, 0}, 1.0, 0.1));
    check(kepler_arc(x, v, bad, 0.1));
    check(kepler_arc(x, v, 1.0, bad));
  }
  check(kepler_arc<double>({0, 0, 0}, v, 1.0, 0.1));
  check(kepler_arc<double>({1, 0, 0}, {1e300, 0, 0}, 1.0, 1e300));
}

TEST_CASE("nothing hangs and nothing is silently infinite, whatever the numbers", "[kepler]") {
  Random random(13);
  const auto any = [&] { return random(-1, 1) * std::pow(10.0, random(-300, 300)); };
  for (int n = 0; n < 20000; ++n) {
    const Vec3<double> x(any(), any(), any()), v(any(), any(), any());
    const KeplerArc<double> arc = kepler_arc(x, v, any(), any());
    REQUIRE(arc.iterations <= 400);
    REQUIRE(std::isfinite(arc.dx[0] + arc.dv[0] + arc.s));
  }
}
