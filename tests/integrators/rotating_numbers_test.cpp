// Rigid bodies over packs are eight systems at once, and over dual numbers the tangent map of one.

#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/oblateness.hpp"
#include "numbers/dual.hpp"
#include "numbers/pack.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/rigid_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace noether::test {
namespace {

using WideTangent = Dual<Quad, 1>;

RigidBody rock(const char* name, double mass, double a, double b, double c) {
  std::vector<BodySite> sites;
  for (const double side : {-1., 1.}) {
    sites.push_back({.place = {side * a, 0.02, 0}, .mass = mass / 6});
    sites.push_back({.place = {0, side * b, 0.03}, .mass = mass / 6});
    sites.push_back({.place = {0.01, 0, side * c}, .mass = mass / 6});
  }
  return body_of_sites(name, sites);
}

/// Two rocks about each other, a line and a point beside them; each of eight systems begins elsewhere.
ParticleSystem<double> rocks(double lane = 0, double spin = 1) {
  ParticleSystem<double> s(unit_system("reduced"));
  Bodies bodies;
  const auto add = [&](const RigidBody& body, const BodyState& state) { add_body(s, bodies, body, state); };
  add(rock("one", 1, 0.5, 0.4, 0.3), {.x = {-0.1, 0, 0.01 * lane},
                                      .v = {0, 0.05, 0},
                                      .orientation = {0.9, 0.1 * lane, 0.2, -0.3},
                                      .angular_velocity = Vec3<double>(spin * (0.3 + 0.1 * lane), 0.4, -spin)});
  add(rock("two", 0.1, 0.2, 0.15, 0.1), {.x = {1.6, 0.05 * lane, 0},
                                         .v = {0, 0.7, 0.1},
                                         .orientation = {0.5, -0.5, 0.5, 0.4},
                                         .angular_velocity = Vec3<double>(0.9, -0.2 * spin, 0.7)});
  s.add("point", 0.01, {0, -2.5, 0.3 + 0.02 * lane}, {0.6, 0, 0});
  add(body_of_sites("line", {{.place = {0, 0, 0.2}, .mass = 0.03}, {.place = {0, 0, -0.1}, .mass = 0.02}}, true),
      {.x = {0.2, 3, 0.4}, .v = {-0.5, 0, 0.01 * lane}, .angular_velocity = Vec3<double>(2, 1, 0)});
  s.set_bodies(std::make_shared<const Bodies>(std::move(bodies)));
  return s;
}

/// Of the first rock, about an axis of its own.
const Oblateness oblate{.J2 = 0.05, .J4 = -0.02, .radius = 0.5, .axis = {0.2, -0.1, 1}, .frame = AxisFrame::body};

template <class Base, class... Fs> ForceField<Base> field_on_sites(const Fs&... forces) {
  ForceField<Base> sum, outer;
  (sum.add(forces), ...);
  outer.add(OnSites<Base>(std::move(sum)));
  return outer;
}

/// The state after some steps; `set(s)` may change the start in the working number type.
template <class Real, class Base, class Set>
ParticleSystem<Real> after(const ForceField<Base>& forces, const RotatingOptions& options, const Scheme& scheme,
                           const ParticleSystem<double>& start, int steps, const Set& set) {
  using H = Rotating<KineticPotential<ForceField<Base>, Real>>;
  ParticleSystem<Real> s = start.as<Real>();
  s.clock() = Clock<Real>::fixed(0, 0.05);
  set(s);
  Composition<H> integrator(H(KineticPotential<ForceField<Base>, Real>(forces), options), scheme);
  integrator.bind(s);
  ParticleSystem<Real> settled = s;
  integrator.advance(s, {.steps = steps});
  integrator.settle(s, settled, {}, {}, true);
  return settled;
}

/// Each column of each lane against the run of that system alone. @param spin  of lane k
template <class Spin>
void check_lanes(const ForceField<double>& forces, const RotatingOptions& options, const Scheme& scheme,
                 const Spin& spin) {
  const auto start = [&](std::size_t k) { return rocks(static_cast<double>(k), spin(k)); };
  const auto each_column = [](auto& a, const auto& b, const auto& visit) {
    visit(a.positions(), b.positions());
    visit(a.velocities(), b.velocities());
    visit(a.template column<BodyOrientation>(), b.template column<BodyOrientation>());
    visit(a.template column<BodySpin>(), b.template column<BodySpin>());
  };
  const auto each_number = [](auto& a, const auto& b, const auto& visit) {
    for (int c = 0; c < a.width; ++c) {
      for (Index i = 0; i < a.size(); ++i) visit(a.component(c)[i], b.component(c)[i]);
    }
  };
  const auto eight = after<Pack>(forces, options, scheme, start(0), 20, [&](ParticleSystem<Pack>& s) {
    for (std::size_t k = 0; k < Pack::lanes; ++k) {
      const auto one = start(k);
      each_column(s, one, [&](auto& to, const auto& from) {
        each_number(to, from, [&](Pack& number, double of_one) { number.lane[k] = of_one; });
      });
    }
  });
  int differing = 0;
  for (std::size_t k = 0; k < Pack::lanes; ++k) {
    const auto alone = after<double>(forces, options, scheme, start(k), 20, [](ParticleSystem<double>&) {});
    each_column(eight, alone, [&](const auto& lanes, const auto& one) {
      each_number(lanes, one,
                  [&](const Pack& number, double of_one) { differing += number.lane[k] == of_one ? 0 : 1; });
    });
  }
  CHECK(differing == 0);
}

/// A derivative of the state of a body along its run, in variables that may be added.
struct Along {
  std::vector<Quad> q, p;
};

/// How many directions a body has: of its place and its motion, of its orientation and its spin.
constexpr std::size_t directions = 12;

/// Moves body `d / 12` in its direction `d % 12`, by the slope.
void seed(ParticleSystem<WideTangent>& s, std::size_t d) {
  const auto i = static_cast<Index>(d / directions);
  const int k = static_cast<int>(d % 3), kind = static_cast<int>(d % directions / 3);
  if (kind == 0) s.positions().component(k)[i].slope[0] = Quad(1);
  if (kind == 1) s.velocities().component(k)[i].slope[0] = Quad(1);
  if (kind == 3) s.column<BodySpin>().component(k)[i].slope[0] = Quad(1);
  if (kind != 2) return;
  auto& q = s.column<BodyOrientation>();
  Quaternion<Quad> now, unit = Quaternion<Quad>::Zero();
  for (int c = 0; c < 4; ++c) now[c] = q.component(c)[i].value;
  unit[1 + k] = Quad(0.5);
  const Quaternion<Quad> moved = quaternion_product<Quad>(now, unit);
  for (int c = 0; c < 4; ++c) q.component(c)[i].slope[0] = moved[c];
}

/// x and q, m v and p = 2 (0, S) q, of all bodies: their slopes.
Along along(const ParticleSystem<WideTangent>& s) {
  Along all;
  for (Index i = 0; i < s.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      all.q.push_back(s.positions().component(k)[i].slope[0]);
      all.p.push_back(s.masses()[i].value * s.velocities().component(k)[i].slope[0]);
    }
    const Vec3<WideTangent> spin = s.column<BodySpin>()[i];
    const Quaternion<WideTangent> q = s.column<BodyOrientation>()[i],
                                  p = quaternion_product<WideTangent>(quaternion<WideTangent>(WideTangent(0), spin), q);
    for (int c = 0; c < 4; ++c) {
      all.q.push_back(q[c].slope[0]);
      all.p.push_back(Quad(2) * p[c].slope[0]);
    }
  }
  return all;
}

/// The largest change of the symplectic form dp ^ dq of any two directions.
double form_defect(const ForceField<Quad>& forces, const RotatingOptions& options, const Scheme& scheme,
                   const ParticleSystem<double>& start, int steps) {
  std::vector<Along> first, last;
  for (std::size_t d = 0; d < directions * static_cast<std::size_t>(start.size()); ++d) {
    const auto set = [&](ParticleSystem<WideTangent>& s) {
      // Of unit length to the last bit of Quad, so that the flows find it as they leave it.
      auto& q = s.column<BodyOrientation>();
      for (Index i = 0; i < s.size(); ++i) q.set(i, renormalized<WideTangent>(std::as_const(q)[i]));
      for (Index i = 0; i < s.size(); ++i) q.set(i, renormalized<WideTangent>(std::as_const(q)[i]));
      seed(s, d);
      first.push_back(along(s));
    };
    last.push_back(along(after<WideTangent>(forces, options, scheme, start, steps, set)));
  }
  Quad worst(0);
  const auto form = [](const Along& a, const Along& b) {
    Quad sum(0);
    for (std::size_t k = 0; k < a.q.size(); ++k) sum += a.p[k] * b.q[k] - b.p[k] * a.q[k];
    return sum;
  };
  for (std::size_t a = 0; a < first.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b)
      worst = std::max(worst, Quad(abs(form(first[a], first[b]) - form(last[a], last[b]))));
  }
  return static_cast<double>(worst);
}

/// The top and a body under gravity: every kind of turn and force in few directions.
ParticleSystem<double> two_rocks() {
  ParticleSystem<double> s(unit_system("reduced"));
  Bodies bodies;
  add_body(s, bodies, rock("one", 1, 0.5, 0.4, 0.3),
           {.orientation = {0.9, 0.1, 0.2, -0.3}, .angular_velocity = Vec3<double>(0.3, 0.4, -1)});
  add_body(s, bodies, rock("two", 0.1, 0.2, 0.15, 0.1),
           {.x = {1.6, 0, 0.2}, .v = {0, 0.7, 0}, .angular_velocity = Vec3<double>(0.9, -0.2, 0.7)});
  s.set_bodies(std::make_shared<const Bodies>(std::move(bodies)));
  return s;
}

}  // namespace

TEST_CASE("eight systems of rigid bodies in lanes have the bits of each run alone", "[rotating][numbers]") {
  const ForceField<double> figures = ForceField<double>().add(GravityOfBodies{}),
                           sites = ForceField<double>().add(GravityOfBodies{.degree = Figure::sites}),
                           fields = field_on_sites<double>(HarmonicField{0.3}, UniformField{{0, 0.1, -1}}),
                           flattened = ForceField<double>().add(oblate);
  const auto slow = [](std::size_t) { return 1.; };
  check_lanes(figures, {.rotor = Rotor::exact}, schemes::srkn14a, slow);
  check_lanes(sites, {.rotor = Rotor::exact}, schemes::verlet, slow);
  check_lanes(fields, {.rotor = Rotor::axes, .axes = "zxy"}, schemes::yoshida_4, slow);
  check_lanes(flattened, {.rotor = Rotor::exact}, schemes::blanes_moan_s6, slow);
  // Systems that turn about other axes, and one that turns too far for the lanes of turns by axes.
  const auto wild = [](std::size_t k) { return k == 5 ? 40. : k == 3 ? 0. : k % 2 == 0 ? 3. : -0.1; };
  check_lanes(figures, {.rotor = Rotor::exact}, schemes::verlet, wild);
  check_lanes(figures, {.rotor = Rotor::axes}, schemes::verlet, wild);
}

TEST_CASE("lanes in which a body is a line here and none there are refused", "[rotating][numbers]") {
  const auto start = [](ParticleSystem<Pack>& s) { s.column<BodyInertia>().component(0)[0].lane[3] = 0; };
  const ForceField<double> none;
  try {
    after<Pack>(none, {}, schemes::verlet, rocks(), 1, start);
    FAIL("lanes that differ in what a body is were taken");
  } catch (const Error& error) {
    CHECK(std::string(error.what()).find("'one' has a moment of inertia that is 0 in some lanes") != std::string::npos);
  }
}

TEST_CASE("steps of rigid bodies are symplectic in q and p = 2 (0, S) q", "[rotating][numbers][symplectic]") {
  const auto figures = ForceField<Quad>().add(GravityOfBodies{}),
             sites = ForceField<Quad>().add(GravityOfBodies{.degree = Figure::sites}),
             flattened = ForceField<Quad>().add(Gravity{}).add(oblate);
  CHECK(form_defect(flattened, {.rotor = Rotor::exact}, schemes::verlet, two_rocks(), 2) < 1e-28);
  CHECK(form_defect(figures, {.rotor = Rotor::exact}, schemes::srkn14a, two_rocks(), 1) < 1e-28);
  CHECK(form_defect(sites, {.rotor = Rotor::exact}, schemes::verlet, two_rocks(), 2) < 1e-28);
  CHECK(form_defect(figures, {.rotor = Rotor::axes}, schemes::verlet, two_rocks(), 2) < 1e-28);
  CHECK(form_defect(field_on_sites<Quad>(HarmonicField{0.3}), {.rotor = Rotor::axes}, schemes::verlet, two_rocks(), 2) <
        1e-28);
}

namespace {

/// A torque that is no slope of an energy.
struct WrongTorque {
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const Vec3<Real> axis = rotation_matrix<Real>(s.template column<BodyOrientation>()[0]).col(2);
    out.torque(0, Vec3<Real>(Real(1e-6) * axis[0], Real(0), Real(0)));
  }
  static ForceClaims claims() { return {.on_bodies = true}; }
};

template <class Real> Vec3<Real> widened(const Vec3<double>& v) {
  return Vec3<Real>{Real(Quad(v[0])), Real(Quad(v[1])), Real(Quad(v[2]))};
}

/// The free turn from one orientation. @param d, by  what is changed: the spin in the body, or the time
template <class Real>
Turned<Real> turned(const Vec3<double>& moments, const Vec3<double>& in_body, double time, bool exact, int d,
                    const Real& by) {
  Quaternion<Real> q{Real(0.7), Real(-0.1), Real(0.5), Real(0.5)};  // of unit length
  Vec3<Real> m = widened<Real>(in_body);
  Real h = Real(Quad(time));
  (d < 3 ? m[d] : h) += by;
  const Vec3<Real> spin = to_space<Real>(rotation_matrix<Real>(renormalized<Real>(q)), m);
  q = renormalized<Real>(renormalized<Real>(q));
  if (exact) return turn_exactly<Real>(q, spin, widened<Real>(moments), h);
  return turn_by_axes<Real>(q, spin, widened<Real>(moments), h, {0, 1, 2});
}

/// Largest difference of the derivatives of a free turn from central differences, over that of the turn itself.
double derivative_error(const Vec3<double>& moments, const Vec3<double>& in_body, double time, bool exact) {
  Quad worst(0), largest(0);
  for (int d = 0; d < 4; ++d) {
    const auto at = [&](const auto& by) { return turned(moments, in_body, time, exact, d, by); };
    const Quad step(1e-11);
    const Turned<Quad> more = at(step), less = at(Quad(-step));
    const Turned<WideTangent> slope = at(WideTangent::variable(Quad(0), 0));
    for (int c = 0; c < 4; ++c) {
      const Quad difference = (more.orientation[c] - less.orientation[c]) / (step + step);
      worst = std::max(worst, Quad(abs(slope.orientation[c].slope[0] - difference)));
      largest = std::max(largest, Quad(abs(difference)));
    }
    worst = std::max(worst, Quad(abs(slope.action.slope[0] - (more.action - less.action) / (step + step))));
  }
  return static_cast<double>(worst / largest);
}

}  // namespace

TEST_CASE("a torque that is no slope is found by the symplectic form", "[rotating][numbers][symplectic]") {
  const auto forces = ForceField<Quad>().add(WrongTorque{});
  CHECK(form_defect(forces, {.rotor = Rotor::exact}, schemes::verlet, two_rocks(), 2) > 1e-9);
}

TEST_CASE("dual numbers carry the derivatives of free turns of all kinds", "[rotating][numbers]") {
  const Vec3<double> odd(2, 1, 2. / 3);
  for (const double time : {0.3, -1.7, 25.}) {
    CAPTURE(time);
    for (const Vec3<double>& spin :
         {Vec3<double>(0.6, -0.4, 0.9), Vec3<double>(1, 0.2, 0.1), Vec3<double>(0.1, 0.3, -1), Vec3<double>(0.9, 0, 0),
          Vec3<double>(0, 0, -0.7), Vec3<double>(0, 0, 0)}) {
      CAPTURE(spin.transpose());
      CHECK(derivative_error(odd, spin, time, true) < 1e-17);
      if (time < 1) CHECK(derivative_error(odd, spin, time, false) < 1e-17);
    }
    for (const Vec3<double>& moments : {Vec3<double>(1, 1, 2), Vec3<double>(2, 1, 2), Vec3<double>(0.5, 2, 2),
                                        Vec3<double>(1, 1, 1), Vec3<double>(1, 0, 1)}) {
      CAPTURE(moments.transpose());
      // Of moments that are equal to the bit: derivatives in the spin alone.
      const Vec3<double> spin(0.6, moments[1] > 0 ? -0.4 : 0, 0.9);
      CHECK(derivative_error(moments, spin, time, true) < 1e-17);
    }
  }
  // About the middle axis, from where it leaves as e^t, and beside the separatrix.
  CHECK(derivative_error(odd, {0, 0.8, 0}, 1.3, true) < 1e-17);
  CHECK(derivative_error(odd, {0.5, 0.8, 0.5 + 1e-9}, 1.3, true) < 1e-17);
}

}  // namespace noether::test
