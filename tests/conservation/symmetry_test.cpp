/// Discrete Noether: a map that commutes with rotations, translations and boosts keeps what belongs to them, and where
/// the start is turned, the whole run is.

#include "forces/oblateness.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/problems.hpp"

#include <cmath>

namespace noether {
namespace {

using namespace noether::test;

/// The rotation of a quaternion a + b i + c j + d k, whose squares and products are exact in doubles.
Mat3<Quad> rotation(double a, double b, double c, double d) {
  Mat3<Quad> m;
  m << a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c),  //
      2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b),   //
      2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d;
  return m / Quad(a * a + b * b + c * c + d * d);
}

Vec3<Quad> turned(const Mat3<Quad>& m, const Vec3<Quad>& v) {
  return Vec3<Quad>(m(0, 0) * v[0] + m(0, 1) * v[1] + m(0, 2) * v[2], m(1, 0) * v[0] + m(1, 1) * v[1] + m(1, 2) * v[2],
                    m(2, 0) * v[0] + m(2, 1) * v[1] + m(2, 2) * v[2]);
}

/// x -> R x + shift, v -> R v + boost.
struct Symmetry {
  Mat3<Quad> r = Mat3<Quad>::Identity();
  Vec3<Quad> shift = Vec3<Quad>::Zero(), boost = Vec3<Quad>::Zero();

  ParticleSystem<Quad> of(ParticleSystem<Quad> s, const Quad& time) const {
    const Vec3<Quad> moved = shift + time * boost;
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Quad> x = std::as_const(s).positions()[i], v = std::as_const(s).velocities()[i];
      s.positions().set(i, turned(r, x) + moved);
      s.velocities().set(i, turned(r, v) + boost);
    }
    return s;
  }
};

const Symmetry turn{rotation(1, 2, -3, 0.5)};
const Symmetry move{Mat3<Quad>::Identity(), Vec3<Quad>(Quad(3), Quad(-1), Quad(2)),
                    Vec3<Quad>(Quad(0.5), Quad(0.25), Quad(-0.125))};

/// How far the run of the changed start is from the changed run.
template <class H>
double departure(const H& hamiltonian, const Scheme& scheme, const ParticleSystem<double>& start,
                 const Symmetry& symmetry, double dt, long steps) {
  const auto wide = start.as<Quad>();
  const auto first = run(hamiltonian, scheme, symmetry.of(wide, Quad(0)), dt, steps);
  const auto then = symmetry.of(run(hamiltonian, scheme, wide, dt, steps), Quad(dt) * Quad(static_cast<double>(steps)));
  return distance(first, then);
}

/// Rounding in 113 bits, grown by what four bodies make of it.
constexpr double rounding = 1e-29;

TEST_CASE("a run of a turned, moved and boosted start is the run turned, moved and boosted",
          "[conservation][symmetry]") {
  const auto hamiltonian = kinetic_potential<Quad>(Gravity{.G = 1.0});
  for (const Scheme* scheme : schemes::all()) {
    CAPTURE(scheme->name);
    CHECK(departure(hamiltonian, *scheme, four_bodies(), turn, 0.02, 40) < rounding);
    CHECK(departure(hamiltonian, *scheme, four_bodies(), move, 0.02, 40) < rounding);
  }
}

TEST_CASE("so it is over Kepler arcs, in all coordinates", "[conservation][symmetry]") {
  for (const Coordinates coordinates :
       {Coordinates::jacobi, Coordinates::democratic, Coordinates::whds, Coordinates::barycentric}) {
    const auto hamiltonian = wisdom_holman<Quad>({.G = 1, .coordinates = coordinates});
    for (const Scheme* scheme : {&schemes::verlet, &schemes::verlet_aba, &schemes::yoshida_6, &schemes::abah_10_6_4}) {
      CAPTURE(scheme->name);
      CHECK(departure(hamiltonian, *scheme, planets(1e-3), turn, 0.05, 40) < rounding);
      CHECK(departure(hamiltonian, *scheme, planets(1e-3), move, 0.05, 40) < rounding);
    }
  }
}

TEST_CASE("an axis in space leaves the turns about itself, and no others", "[conservation][symmetry]") {
  const auto hamiltonian = kinetic_potential<Quad>(Gravity{.G = 1.0}, Oblateness{.J2 = 0.01, .radius = 0.5, .G = 1.0});
  const Symmetry about_axis{rotation(1, 0, 0, 0.5)};
  CHECK(departure(hamiltonian, schemes::verlet, four_bodies(), about_axis, 0.02, 40) < rounding);
  CHECK(departure(hamiltonian, schemes::verlet, four_bodies(), move, 0.02, 40) < rounding);
  CHECK(departure(hamiltonian, schemes::verlet, four_bodies(), turn, 0.02, 40) > 1e-6);
}

}  // namespace
}  // namespace noether
