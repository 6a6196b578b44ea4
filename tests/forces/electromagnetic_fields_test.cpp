/// Fields of charges: Maxwell's equations by dual numbers, and closed forms.

#include "numbers/dual.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/charges.hpp"

#include <algorithm>

namespace noether {
namespace {

using Four = Dual<double, 4>;  // derivatives by t, x, y, z

struct Residuals {
  double divergence, rotation, electric, induction;
};

/// How far a field is from div B = 0, B = rot A, E = - grad phi - dA/dt and rot E = - dB/dt, relative to its size.
template <class Field> Residuals residuals(const Field& field, double t, const Vec3<double>& x) {
  const Vec3<Four> at(Four::variable(x[0], 1), Four::variable(x[1], 2), Four::variable(x[2], 3));
  FieldValues<Four> f;
  field.at(Four::variable(t, 0), at, f);
  const auto rot = [](const Vec3<Four>& v) {
    return Vec3<double>(v[2].slope[2] - v[1].slope[3], v[0].slope[3] - v[2].slope[1], v[1].slope[1] - v[0].slope[2]);
  };
  const auto value = [](const Vec3<Four>& v) { return Vec3<double>(v[0].value, v[1].value, v[2].value); };
  const auto by_time = [](const Vec3<Four>& v) { return Vec3<double>(v[0].slope[0], v[1].slope[0], v[2].slope[0]); };
  const Vec3<double> gradient(f.phi.slope[1], f.phi.slope[2], f.phi.slope[3]);
  double slopes = 1e-300;
  for (int k = 0; k < 3; ++k) {
    for (const double slope : f.B[k].slope) slopes = std::max(slopes, std::abs(slope));
  }
  const double B = std::max(value(f.B).norm(), 1e-300), E = std::max(value(f.E).norm(), 1e-300);
  return {std::abs(f.B[0].slope[1] + f.B[1].slope[2] + f.B[2].slope[3]) / slopes, (rot(f.A) - value(f.B)).norm() / B,
          (value(f.E) + gradient + by_time(f.A)).norm() / E, (rot(f.E) + by_time(f.B)).norm() / slopes};
}

template <class Field> void check_field(const Field& field, const std::vector<Vec3<double>>& places) {
  for (const Vec3<double>& x : places) {
    CAPTURE(x);
    const Residuals r = residuals(field, 0.3, x);
    CHECK(r.divergence < 1e-12);
    CHECK(r.rotation < 1e-12);
    if (field.claims().time_dependent || r.electric > 0) CHECK(r.electric < 1e-12);
  }
}

template <class Field> FieldValues<double> at(const Field& field, const Vec3<double>& x, double t = 0) {
  FieldValues<double> values;
  field.at(t, x, values);
  return values;
}

const std::vector<Vec3<double>> about = {{0.3, -0.2, 0.4}, {1.1, 0.7, -0.6}, {-0.9, 0.1, 0.05}, {0.02, 1.3, 2.0}};

}  // namespace

TEST_CASE("fields are those of their potentials, and their lines have no ends", "[forces][fields]") {
  check_field(InField(UniformElectromagnetic{.E = {0.1, -0.2, 0.3}, .B = {0.5, 0.7, -0.4}}), about);
  check_field(InField(GradientField{.B0 = 1, .gradient = 0.1}), about);
  check_field(InField(MagneticMirror{.B0 = 2, .radius = 0.8, .distance = 1.5}), about);
  check_field(InField(MagneticDipole{.moment = {0.1, 0.2, -3}}), about);
  check_field(InField(Tokamak{.B0 = 1.5, .R0 = 1.2, .safety = 1.7}), about);
  check_field(InField(PenningTrap{.B0 = 5, .gradient = 2}), about);
  check_field(InField(PlaneWave{.E0 = {0, 0.3, 0.4}, .direction = {2, 0, 0}, .omega = 3, .c = 2}), about);
  check_field(InField(test::RingField{}), about);
}

TEST_CASE("a wave and a gap obey the law of induction", "[forces][fields]") {
  const PlaneWave wave{.E0 = {0, 0.3, 0.4}, .direction = {2, 0, 0}, .omega = 3, .c = 2, .phase = 0.2};
  for (const Vec3<double>& x : about) CHECK(residuals(wave, 0.7, x).induction < 1e-12);
  // To first order in the distance from the axis: a tenth of it, a hundredth of the error.
  const RadioFrequencyGap gap{.E0 = 2, .length = 0.5, .omega = 3, .c = 2, .phase = 0.2};
  const double near = residuals(gap, 0.7, {1e-3, 0, 0.2}).induction,
               far = residuals(gap, 0.7, {1e-2, 0, 0.2}).induction;
  CHECK(std::abs(far / near / 10 - 1) <= 0.05);
  CHECK(near < 0.01);
  CHECK(residuals(gap, 0.7, {1e-3, 2e-3, 0.2}).divergence < 1e-12);
}

TEST_CASE("a loop of current: its axis, its far field, the edge of its wire", "[forces][fields]") {
  // Two loops in one place are one of twice the current.
  const MagneticMirror loop{.B0 = 0.5, .radius = 0.8, .distance = 0};
  for (const double z : {0.0, 0.3, -2.0}) {
    const FieldValues<double> f = at(loop, {0, 0, z});
    CHECK(std::abs(f.B[2] * std::pow(0.64 + z * z, 1.5) / std::pow(0.8, 3) - 1) <= 1e-14);
    CHECK(f.B[0] == 0);
  }
  // Far away a dipole of B0 a^3/2.
  const MagneticDipole dipole{.moment = {0, 0, std::pow(0.8, 3) / 2}};
  const Vec3<double> far(60, -30, 80);
  CHECK((at(loop, far).B - at(dipole, far).B).norm() < 3e-4 * at(dipole, far).B.norm());
  // Beside the wire that of a straight one: B = mu_0 I/2 pi d = B0 a/pi d.
  const double d = 1e-6;
  CHECK(std::abs(std::abs(at(loop, {0.8 + d, 0, 0}).B[2]) * std::acos(-1.0) * d / 0.8 - 1) <= 1e-4);
}

TEST_CASE("a tokamak's field is that of the literature", "[forces][fields]") {
  // QinEtAl2013, R0 = B0 = 1, q = 2: B = (-(2y + xz), 2x - yz, R (R - 1))/2R^2
  const Vec3<double> x(0.9, 0.4, -0.2);
  const double R2 = x[0] * x[0] + x[1] * x[1], R = std::sqrt(R2);
  const Vec3<double> expected(-(2 * x[1] + x[0] * x[2]) / (2 * R2), (2 * x[0] - x[1] * x[2]) / (2 * R2),
                              (R - 1) / (2 * R));
  CHECK((at(Tokamak{}, x).B - expected).norm() < 1e-15);
  CHECK(std::abs(at(MagneticDipole{.moment = {0, 0, 1000}}, {5, 0, 0}).B[2] / -8 - 1) <= 1e-15);
}

TEST_CASE("a field is a force on charges: E and v x B, energies, and nothing on what has none", "[forces][fields]") {
  const InField field(UniformElectromagnetic{.E = {0.1, -0.2, 0.3}, .B = {0.5, 0.7, -0.4}});
  ParticleSystem<double> s = test::one_charge({1, 2, 3}, {0.3, -0.4, 0.5}, -2, 4);
  s.add("neutral", 1, {1, 0, 0}, {1, 1, 1});
  s.add("tracer", 0, {1, 0, 0}, {1, 1, 1});
  s.column<Charge>()[2] = 1;
  VectorColumn<double> a(3), rate(3);
  const Vec3<double> v(0.3, -0.4, 0.5), E(0.1, -0.2, 0.3), B(0.5, 0.7, -0.4);
  {
    ForceSink<double> sink(a, s, {.energy = true});
    field.add_to(sink, s);
    CHECK((Vec3<double>(a[0]) - Vec3<double>(-0.5 * (E + cross<double>(v, B)))).norm() < 1e-16);
    CHECK(std::abs(sink.potential() / (2 * dot(E, Vec3<double>(1, 2, 3))) - 1) <= 1e-15);
  }
  ForceSink<double> sink(a, s, {});
  sink.set_gyrations(rate);
  field.add_to(sink, s);
  CHECK((Vec3<double>(a[0]) + 0.5 * E).norm() < 1e-16);
  CHECK((Vec3<double>(rate[0]) + 0.5 * B).norm() < 1e-16);
  for (const Index i : {1, 2}) {
    CHECK(Vec3<double>(a[i]).norm() == 0);
    CHECK(Vec3<double>(rate[i]).norm() == 0);
  }
  ParticleSystem<double> none(unit_system("reduced"));
  none.add("a", 1, {0, 0, 0}, {0, 0, 0});
  CHECK_THROWS_WITH(field.check(none), Catch::Contains("acts on charges"));
}

}  // namespace noether
