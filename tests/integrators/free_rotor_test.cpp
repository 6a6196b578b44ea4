/// The free turn of a rigid body, against closed forms and against itself in 113 bits.

#include "integrators/free_rotor.hpp"
#include "numbers/elliptic.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/rigid_bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace noether {
namespace {

struct FreeBody {
  Vec3<double> inertia, spin;
  Quaternion<double> q;
  double h;
};

template <class Real> Vec3<Real> widened(const Vec3<double>& v) {
  return Vec3<Real>(Real(v[0]), Real(v[1]), Real(v[2]));
}
Quaternion<Quad> unit_quad(const Quaternion<double>& q) {
  Quaternion<Quad> wide = q.cast<Quad>();
  const Quad length = sqrt(norm_defect(wide) + Quad(1));
  for (int k = 0; k < 4; ++k) wide[k] /= length;
  return wide;
}
Quaternion<Quad> in_quad(const FreeBody& b, const Quaternion<Quad>& q, const Quad& h) {
  return turn_exactly<Quad>(q, widened<Quad>(b.spin), widened<Quad>(b.inertia), h).orientation;
}
template <class A, class B> double apart(const A& a, const B& b) {
  double most = 0;
  for (int k = 0; k < 4; ++k) {
    const double d = std::abs(static_cast<double>(Quad(a[k]) - Quad(b[k])));
    if (!(d <= most)) most = d;
  }
  return most;
}
/// Turns within the time: the angle, to which rounding is in proportion.
double angle_of(const FreeBody& b) { return std::abs(b.h) * b.spin.norm() / b.inertia.minCoeff(); }

/// Bodies of all shapes: different moments, two and three equal ones, needles and discs, near and on principal axes.
std::vector<FreeBody> bodies(int count) {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::vector<FreeBody> all;
  for (int k = 0; k < count; ++k) {
    FreeBody b;
    for (int c = 0; c < 3; ++c) {
      b.inertia[c] = std::exp((k % 3 == 0 ? 5 : 1) * normal(generator));
      b.spin[c] = normal(generator);
    }
    if (k % 17 == 0) b.inertia[1] = b.inertia[0] * (1 + 1e-9 * normal(generator));
    if (k % 19 == 0) b.inertia[2] = b.inertia[1];
    if (k % 23 == 0) b.inertia[1] = b.inertia[2] = b.inertia[0];
    if (k % 7 == 0) {  // nearly about an axis
      b.spin *= 1e-9;
      b.spin[k / 7 % 3] = 1;
    }
    if (k % 29 == 0) b.spin = Vec3<double>::Unit(k / 29 % 3);
    for (int c = 0; c < 4; ++c) b.q[c] = normal(generator);
    b.q /= b.q.norm();
    if (k % 2 == 0) b.q = Quaternion<double>(1, 0, 0, 0);
    b.h = (k % 4 == 0 ? 60 : 3) * (k % 5 == 0 ? -1 : 1) * uniform(generator) * b.inertia.minCoeff() / b.spin.norm();
    if (k % 7 == 0 || k % 29 == 0) b.h /= 20;  // about the middle axis errors grow as the motion does
    all.push_back(b);
  }
  return all;
}

}  // namespace

TEST_CASE("a free body turns as its closed form says", "[integrators][free_rotor]") {
  const Vec3<double> inertia(2, 1, 2. / 3), start(std::cos(1.1), 0, std::sin(1.1));
  const Quaternion<double> unturned(1, 0, 0, 0);
  const auto in_body = [&](double t, int steps) {
    Quaternion<double> q = unturned;
    for (int k = 0; k < steps; ++k) q = turn_exactly<double>(q, start, inertia, t / steps).orientation;
    return spin_in_body<double>(q, start);
  };
  for (const int steps : {1, 7, 100}) {  // at any step
    CAPTURE(steps);
    const Vec3<double> at_10(0.40706613658804081085, 0.28300742681284407600, 0.86844916766156164371);
    const Vec3<double> at_100(-0.1773483138749739591, -0.5904185243334271686, 0.78737128579193309914);
    CHECK((in_body(10, steps) - at_10).cwiseAbs().maxCoeff() < 3e-15);
    CHECK((in_body(100, steps) - at_100).cwiseAbs().maxCoeff() < 3e-14);
  }
  Mat3<double> r;
  r << 0.45102003223858705510, -0.7091091829583614598, 0.54198256167853680013, 0.86311043237615296754,
      0.19194772370812527745, -0.4671150317499100526, 0.22720323950805404113, 0.67846903982966993937,
      0.69861180204005398457;
  const Mat3<double> turned = rotation_matrix<double>(turn_exactly<double>(unturned, start, inertia, 10).orientation);
  CHECK((turned - r).cwiseAbs().maxCoeff() < 1e-14);
  // The period of Pi is 4 K/lambda.
  const double period = 10.7314652348828038338;
  CHECK((in_body(period, 1) - start).cwiseAbs().maxCoeff() < 5e-15);
}

TEST_CASE("free turns are one group with the generator of Euler's equations", "[integrators][free_rotor]") {
  double worst = 0;
  for (const FreeBody& b : bodies(2000)) {
    const Quaternion<Quad> q = unit_quad(b.q);
    const Quad h(b.h), part = h * Quad(0.375);
    const Quaternion<Quad> whole = in_quad(b, q, h), twice = in_quad(b, in_quad(b, q, part), h - part);
    worst = std::max(worst, apart(whole, twice) / (1 + angle_of(b)));  // signs too: quaternions turn twice as slowly
  }
  CHECK(worst < 1e-30);
  // q' = q (0, Pi/I)/2 by a central difference of fourth order.
  worst = 0;
  for (const FreeBody& b : bodies(200)) {
    const Quaternion<Quad> q = unit_quad(b.q);
    const Quad e = Quad(1e-7) * Quad(b.inertia.minCoeff() / b.spin.norm());
    const Vec3<Quad> pi = spin_in_body<Quad>(q, widened<Quad>(b.spin));
    const Vec3<Quad> rate(pi[0] / Quad(b.inertia[0]), pi[1] / Quad(b.inertia[1]), pi[2] / Quad(b.inertia[2]));
    const Quaternion<Quad> slope = quaternion_product<Quad>(q, quaternion<Quad>(Quad(0), rate));
    const auto difference = [&](const Quad& by) {
      const Quaternion<Quad> up = in_quad(b, q, by), down = in_quad(b, q, -by);
      return Quaternion<Quad>(up[0] - down[0], up[1] - down[1], up[2] - down[2], up[3] - down[3]);
    };
    const Quaternion<Quad> near = difference(e), far = difference(Quad(2) * e);
    Quaternion<Quad> found;
    for (int k = 0; k < 4; ++k) found[k] = (Quad(8) * near[k] - far[k]) / (Quad(6) * e);
    const double size = b.spin.norm() / b.inertia.minCoeff();
    worst = std::max(worst, apart(found, slope) / size);
  }
  CHECK(worst < 1e-24);
}

TEST_CASE("free turns in doubles are right to the rounding of the angle", "[integrators][free_rotor]") {
  double worst = 0;
  for (const FreeBody& b : bodies(4000)) {
    const Quaternion<double> turned = turn_exactly<double>(b.q, b.spin, b.inertia, b.h).orientation;
    worst = std::max(worst, apart(turned, in_quad(b, unit_quad(b.q), Quad(b.h))) / (4 + angle_of(b)));
    CHECK(std::abs(norm_defect(turned)) < 1e-15);
  }
  CHECK(worst < 3e-15);
}

TEST_CASE("extreme bodies turn right, or not at all", "[integrators][free_rotor]") {
  const Quaternion<double> q(0.5, -0.5, 0.5, 0.5);
  const auto error = [&](const FreeBody& b) {
    return apart(turn_exactly<double>(b.q, b.spin, b.inertia, b.h).orientation, in_quad(b, unit_quad(b.q), Quad(b.h)));
  };
  SECTION("needles and discs") {
    CHECK(error({{1e-6, 1, 1.0000001}, {0.3, 1, -0.2}, q, 1e-5}) < 1e-14);
    const FreeBody fast{{1e-6, 1, 2}, {1e-6, 1, -0.2}, q, 3};
    CHECK(error(fast) < 3e-16 * angle_of(fast));
    CHECK(error({{1, 1.5, 1e6}, {0.3, 1, -0.2}, q, 2}) < 1e-14);
  }
  SECTION("beside the separatrix") {
    for (const double beside : {1e-12, -1e-12, 1e-15, 0.}) {
      // Pi_1^2 d21/I1 = Pi_3^2 d32/I3 is the separatrix: I = (1, 2, 3), Pi_1 = Pi_3/sqrt 3.
      const FreeBody b{{1, 2, 3}, {(1 + beside) / std::sqrt(3.0), 0.1, 1}, {1, 0, 0, 0}, 1.5};
      CAPTURE(beside);
      CHECK(error(b) < 3e-15);
    }
  }
  SECTION("on the separatrix, where rounding may cross it") {
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> uniform;
    for (int k = 0; k < 4000; ++k) {
      const double middle = 1 + uniform(generator), high = middle + uniform(generator);
      const std::array<double, 3> inertia = {1, middle, high};
      const std::array<double, 3> spin = {std::sqrt((high - middle) / high / (middle - 1)) * (k % 2 == 0 ? 1 : -1),
                                          uniform(generator), 1};
      FreeBody b{{}, {}, {1, 0, 0, 0}, (k % 7 == 0 ? 700 : 2) * uniform(generator)};
      for (int c = 0; c < 3; ++c) {  // in every order of axes, right-handed or not
        const auto from = static_cast<std::size_t>(k % 3 < 2 ? (c + k) % 3 : 2 - c);
        b.inertia[c] = inertia[from];
        b.spin[c] = spin[from];
      }
      const Quaternion<double> turned = turn_exactly<double>(b.q, b.spin, b.inertia, b.h).orientation;
      CHECK(std::abs(norm_defect(turned)) < 1e-15);
    }
  }
  SECTION("long beside the separatrix: where it is cannot be told, but it is somewhere") {
    for (const double h : {20., 60., 2000.}) {
      const Quaternion<double> turned =
          turn_exactly<double>({1, 0, 0, 0}, {2e-9, 1, 9e-10}, {1.1, 1.9, 12.2}, h).orientation;
      CHECK(std::abs(norm_defect(turned)) < 1e-13);
    }
    const Quaternion<double> steady = turn_exactly<double>({1, 0, 0, 0}, {0, 1, 0}, {1.1, 1.9, 12.2}, 60).orientation;
    CHECK(std::abs(norm_defect(steady)) < 1e-13);
  }
  SECTION("ten thousand turns in a step") {
    const FreeBody b{{0.7, 1.1, 1.9}, {0.4, 0.9, -0.7}, q, 6e4};
    CHECK(error(b) < 1e-16 * angle_of(b) * 3);
  }
  SECTION("without spin, as a point, in a line") {
    CHECK(turn_exactly<double>(q, {0, 0, 0}, {1, 2, 3}, 5).orientation == q);
    CHECK(turn_exactly<double>(q, {0, 0, 0}, {0, 0, 0}, 5).orientation == q);
    // A body in a line along z, spin across it: about the spin by L h/I.
    const Quaternion<double> turned =
        turn_exactly<double>(Quaternion<double>(1, 0, 0, 0), {0, 2, 0}, {4, 4, 0}, 0.6).orientation;
    CHECK(std::abs(turned[0] - std::cos(0.15)) < 1e-16);
    CHECK(std::abs(turned[2] - std::sin(0.15)) < 1e-16);
  }
  SECTION("what is not a number stays visible") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(std::isnan(turn_exactly<double>(q, {nan, 1, 0}, {1, 2, 3}, 1).orientation.sum()));
    CHECK(std::isnan(turn_by_axes<double>(q, {nan, 1, 0}, {1, 2, 3}, 1, {0, 1, 2}).orientation.sum()));
  }
}

TEST_CASE("a hundred million turns by n steps are off by the root of n, and leave every bit of the spin",
          "[integrators][free_rotor]") {
  // Each step's rounding moves the energy by chance, and the rate with it: what it does to the angle at the end, which
  // is the same for all n, grows as a random walk does. One step is off by the rounding of the angle, 6.7e8 rad.
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  const double total = 0x1.4p29;
  const Vec3<double> inertia(2, 1, 2. / 3);
  ParticleSystem<double> start(unit_system("reduced"));
  Bodies kinds;
  std::vector<Quaternion<Quad>> exact;
  double turns = 0;
  const int count = 100;
  for (int k = 0; k < count; ++k) {
    FreeBody b{inertia, {normal(generator), normal(generator), normal(generator)}, {}, total};
    b.spin /= b.spin.norm();
    for (int c = 0; c < 4; ++c) b.q[c] = normal(generator);
    add_body(start, kinds, body_of_inertia("body", 1, inertia), {.orientation = b.q, .spin = b.spin});
    b.q = start.column<BodyOrientation>()[k];
    exact.push_back(in_quad(b, unit_quad(b.q), Quad(total)));
    turns += std::sqrt(norm2(angular_velocity<double>(b.q, b.spin, inertia))) * total / (2 * std::acos(-1.0)) / count;
  }
  CHECK(turns > 1e8);
  start.set_bodies(std::make_shared<const Bodies>(std::move(kinds)));
  const auto error = [&](int steps) {
    Simulation sim(start, compose(test::turning(ForceField<double>{}), schemes::verlet), total / steps);
    REQUIRE(sim.run(steps).ok());
    CHECK(sim.time() == total);
    double squares = 0;
    for (Index i = 0; i < count; ++i) {
      CHECK(sim.particles().column<BodySpin>()[i] == start.column<BodySpin>()[i]);
      const Quaternion<double> found = sim.particles().column<BodyOrientation>()[i];
      const auto& q = exact[static_cast<std::size_t>(i)];
      const Quaternion<Quad> wide = found.cast<Quad>();
      const Quad cosine = wide[0] * q[0] + wide[1] * q[1] + wide[2] * q[2] + wide[3] * q[3];  // of half the angle
      squares += static_cast<double>(Quad(8) * (Quad(1) - abs(cosine))) / count;
    }
    return std::sqrt(squares);
  };
  const double one = error(1), few = error(16), some = error(256), many = error(4096);
  CAPTURE(one, few, some, many);
  CHECK(one < 1e-15 * total);
  CHECK(many < 1e-15 * total * 64);
  // By least squares over the three factors of 16, each known to some 10 %.
  const double slope = (3 * std::log2(many / one) + std::log2(some / few)) / 40;
  CAPTURE(slope);
  CHECK(std::abs(slope - 0.5) < 0.1);
}

TEST_CASE("the energy of a free turn moves by chance, not one way", "[integrators][free_rotor]") {
  // A walk of n roundings of 1e-16 to 2e-16; 5e-18 in the same sense each time would come to 12e-16 sqrt(n) here.
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  const Vec3<double> inertia(1.3, 2.1, 0.9);
  const int steps = 60'000, count = 8;
  for (const double h : {0.01, 0.1, 1.}) {
    double squares = 0;
    for (int k = 0; k < count; ++k) {
      const Vec3<double> spin = Vec3<double>(normal(generator), normal(generator), normal(generator)).normalized();
      Quaternion<double> q(normal(generator), normal(generator), normal(generator), normal(generator));
      q /= q.norm();
      const auto energy = [&] { return turning_energy<double>(spin_in_body<double>(q, spin), inertia); };
      const double before = energy();
      for (int n = 0; n < steps; ++n) q = turn_exactly<double>(q, spin, inertia, h).orientation;
      squares += std::pow(energy() / before - 1, 2) / count;
    }
    CAPTURE(h, std::sqrt(squares / steps) * 1e16);
    CHECK(std::sqrt(squares / steps) < 4e-16);
  }
}

TEST_CASE("turns axis by axis are a symmetric map of order 2", "[integrators][free_rotor]") {
  const Vec3<double> inertia(1.3, 2.1, 0.9), spin(1, 0.2, -0.5);
  const Quaternion<double> q(0.5, -0.5, 0.5, 0.5);
  const auto error = [&](double h) {
    Quaternion<double> turned = q;
    for (int k = 0; k < std::lround(2 / h); ++k)
      turned = turn_by_axes<double>(turned, spin, inertia, h, {0, 1, 2}).orientation;
    return apart(turned, turn_exactly<double>(q, spin, inertia, 2).orientation);
  };
  CHECK(std::abs(std::log2(error(0.05) / error(0.025)) - 2) < 0.02);
  const Turned<double> there = turn_by_axes<double>(q, spin, inertia, 0.3, {2, 0, 1});
  CHECK(apart(turn_by_axes<double>(there.orientation, spin, inertia, -0.3, {2, 0, 1}).orientation, q) < 3e-16);
  // About one axis both are the turn by h Pi/I.
  const Quaternion<double> about =
      turn_by_axes<double>(Quaternion<double>(1, 0, 0, 0), {0, 0, 2}, inertia, 0.3, {0, 1, 2}).orientation;
  CHECK(std::abs(about[3] - std::sin(0.3 / 0.9)) < 1e-16);
  CHECK(axis_order("zxy") == AxisOrder{2, 0, 1});
  CHECK_THROWS_WITH(axis_order("xy"), Catch::Matchers::Contains("\"xy\" is not an order of three axes"));
  CHECK_THROWS_WITH(axis_order("xyy"), Catch::Matchers::Contains("\"xyy\" is not an order of three axes"));
}

TEST_CASE("elliptic functions hold their identities in doubles and in 113 bits", "[integrators][free_rotor]") {
  for (const double m1 : {1., 0.9, 0.3, 1e-3, 1e-9, 1e-15}) {
    CAPTURE(m1);
    for (const double u : {1e-9, 0.2, 0.9, 1.4, -1.1}) {
      const auto f = jacobi_functions<double>(u, m1);
      CHECK(std::abs(f.sn * f.sn + f.cn * f.cn - 1) < 6e-16);
      CHECK(std::abs(f.dn * f.dn - (m1 + (1 - m1) * f.cn * f.cn)) < 6e-16);
      const auto wide = jacobi_functions<Quad>(Quad(u), Quad(m1));
      CHECK(std::abs(f.sn - static_cast<double>(wide.sn)) < 3e-16);
      CHECK(std::abs(static_cast<double>(wide.sn * wide.sn + wide.cn * wide.cn - Quad(1))) < 1e-32);
      // int dn^2... of the third kind: d/du = 1/(1 - n sn^2), by a difference in 113 bits.
      const Quad e(1e-8), n(-2.5);
      const auto at = [&](const Quad& x) { return third_elliptic<Quad>(x, n, jacobi_functions<Quad>(x, Quad(m1))); };
      const Quad slope = (at(Quad(u) + e) - at(Quad(u) - e)) / (Quad(2) * e);
      CHECK(std::abs(static_cast<double>(slope * (Quad(1) - n * wide.sn * wide.sn) - Quad(1))) < 1e-14);
    }
    const Quad quarter = complete_elliptic<Quad>(Quad(m1));
    CHECK(std::abs(static_cast<double>(jacobi_functions<Quad>(quarter, Quad(m1)).cn)) < 1e-30 / std::sqrt(m1));
  }
  CHECK(std::abs(complete_elliptic(0.5) - 1.85407467730137191843) < 4e-16);
  // Carlson's own check value: R_J(2, 3, 4, 5) = 0.14297579667156753833; homogeneous of degree -3/2.
  CHECK(std::abs(carlson_rj(0.5, 0.75, 1.25) / 8 - 0.14297579667156753833) < 1e-16);
}

}  // namespace noether
