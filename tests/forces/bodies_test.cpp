/// Forces on rigid bodies: on their sites, by their moments, against mass points and references.

#include "engine/charge.hpp"
#include "forces/check_gradient.hpp"
#include "forces/gravity.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/pair_potentials.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/rigid_bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace noether {
namespace {

using test::on_sites, test::turning;

/// What a sum of forces does to bodies at a moment.
struct BodyForces {
  VectorColumn<double> a, torque;
  double energy;
  Mat3<double> virial;
};
template <class F> BodyForces body_forces(const F& force, const ParticleSystem<double>& s) {
  BodyForces e{VectorColumn<double>(s.size()), VectorColumn<double>(s.size()), 0, Mat3<double>::Zero()};
  ForceSink<double> sink(e.a, s, {.energy = true, .virial = true});
  sink.set_torques(e.torque);
  force.add_to(sink, s);
  e.energy = sink.potential();
  e.virial = sink.virial();
  return e;
}

std::vector<BodySite> octahedron(double mass, const Vec3<double>& half_axes) {
  std::vector<BodySite> sites;
  for (int k = 0; k < 3; ++k) {
    for (const int sign : {1, -1}) {
      BodySite site{.mass = mass / 6};
      site.place[k] = sign * half_axes[k];
      sites.push_back(site);
    }
  }
  return sites;
}

/// Two octahedra of mass points about each other. Reference by extrapolation in 28 to 40 digits
ParticleSystem<double> two_octahedra() {
  ParticleSystem<double> s(unit_system("reduced"));
  add_body(s, body_of_sites("a", octahedron(1, {0.5, 0.4, 0.3})),
           {.x = {-0.2, 0, 0}, .v = {0, -0.0655, 0.01}, .spin = Vec3<double>(0.01, 0.02, 0.05)});
  add_body(s, body_of_sites("b", octahedron(0.1, {0.2, 0.15, 0.1})),
           {.x = {2, 0, 0}, .v = {0, 0.655, -0.1}, .spin = Vec3<double>(0.0002, -0.0001, 0.0008)});
  return s;
}

/// The two bodies of the reference of second degree.
ParticleSystem<double> two_bodies(double scale = 1, double distance = 1) {
  ParticleSystem<double> s(unit_system("reduced"));
  const double s2 = scale * scale;
  add_body(s, body_of_inertia("one", 2, s2 * Vec3<double>(0.3, 0.4, 0.5)), {.orientation = {1, 0.2, -0.3, 0.1}});
  add_body(s, body_of_inertia("two", 0.5, s2 * Vec3<double>(0.02, 0.03, 0.04)),
           {.x = distance * Vec3<double>(3, -0.4, 0.8), .orientation = {0.5, 0.1, 0.7, -0.2}});
  return s;
}

/// A dipole along the third axis of each body in a field along z: U = - k b_z.
struct Dipoles {
  double k = 1;
  double sense = 1;  ///< -1: a torque that is not its slope

  static ForceClaims claims() { return {.on_bodies = true}; }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) {
      const Mat3<Real> r = rotation_matrix<Real>(s.template column<BodyOrientation>()[i]);
      const Vec3<Real> along(r(0, 2), r(1, 2), r(2, 2)), up(Real(0), Real(0), Real(k));
      out.torque(i, Real(sense) * cross<Real>(along, up));
      out.energy(-dot(along, up));
    }
  }
};

}  // namespace

TEST_CASE("torques are asked against the slopes of the energy as bodies turn", "[forces][bodies]") {
  const ParticleSystem<double> s = two_bodies(), sites = two_octahedra();
  CHECK_NOTHROW(check_gradient(GravityOfBodies{}, s));
  CHECK_NOTHROW(check_gradient(GravityOfBodies{.degree = Figure::sites}, sites));
  CHECK_NOTHROW(check_gradient(OnSites<double>(ForceField<double>().add(HarmonicField{.k = 2})), sites));
  CHECK_NOTHROW(check_gradient(Dipoles{}, s));
  CHECK_THROWS_WITH(check_gradient(Dipoles{.k = 1e-20, .sense = 0}, s), Catch::Contains("torques of the force"));
  CHECK_THROWS_WITH(check_gradient(Dipoles{.sense = -1}, s), Catch::Contains("torques of the force are not minus"));
  CHECK(std::abs(gradient_error(AnyForce<double>(Dipoles{.sense = 0.5}), s) - 0.5) < 1e-9);
}

TEST_CASE("gravity of second degree has its energy, force and torques", "[forces][bodies]") {
  const BodyForces e = body_forces(GravityOfBodies{}, two_bodies());
  const auto near = [](const Vec3<double>& found, const Vec3<double>& wanted) {
    return (found - wanted).cwiseAbs().maxCoeff() < 1e-16;
  };
  CHECK(std::abs(e.energy + 0.3210950902668630421) < 2e-16);
  CHECK(near(0.5 * e.a[1], {-0.0995980942866202560, 0.01360299435204308619, -0.0252165314999640132}));
  CHECK(near(e.torque[0], {0.00040053200988619394, 0.00241859713662047881, -0.0002926964687629878}));
  CHECK(near(e.torque[1], {0.00039525087176266972, 0.00161028379278368634, -0.0006770488727181682}));
  // Both forces and their couple: momentum and angular momentum stay.
  const ParticleSystem<double> s = two_bodies();
  const Vec3<double> force = 2 * Vec3<double>(e.a[0]) + 0.5 * Vec3<double>(e.a[1]);
  CHECK(force.cwiseAbs().maxCoeff() < 1e-17);
  const Vec3<double> couple = cross<double>(s.positions()[1] - s.positions()[0], 0.5 * Vec3<double>(e.a[1]));
  CHECK((couple + e.torque[0] + e.torque[1]).cwiseAbs().maxCoeff() < 2e-17);
}

TEST_CASE("gravity of second degree is the slope of its energy", "[forces][bodies]") {
  const BodyForces e = body_forces(GravityOfBodies{}, two_bodies());
  const auto energy_at = [](const Vec3<double>& shift, const Vec3<double>& turn) {
    ParticleSystem<double> s = two_bodies();
    s.positions().add(1, shift);
    const Quaternion<double> q = std::as_const(s).column<BodyOrientation>()[1];
    Quaternion<double> by = quaternion<double>(1, turn / 2);
    by /= std::sqrt(norm_defect(by) + 1);
    s.column<BodyOrientation>().set(1, quaternion_product<double>(by, q));
    return body_forces(GravityOfBodies{}, s).energy;
  };
  for (int k = 0; k < 3; ++k) {
    const Vec3<double> d = 1e-4 * Vec3<double>::Unit(k), none = Vec3<double>::Zero();
    const auto slope = [](double up, double down) { return (up - down) / 2e-4; };
    CHECK(std::abs(slope(energy_at(d, none), energy_at(-d, none)) + 0.5 * e.a[1][k]) < 1e-9);
    CHECK(std::abs(slope(energy_at(none, d), energy_at(none, -d)) + e.torque[1][k]) < 1e-10);
  }
}

TEST_CASE("what the second degree leaves out falls as the fifth power of the distance", "[forces][bodies]") {
  const auto difference = [](double distance) {
    ParticleSystem<double> s(unit_system("reduced"));
    add_body(s, body_of_sites("a", octahedron(1, {0.5, 0.4, 0.3})), {.orientation = {1, 0.2, -0.3, 0.1}});
    add_body(s, body_of_sites("b", octahedron(0.1, {0.2, 0.15, 0.1})),
             {.x = distance * Vec3<double>(0.6, -0.48, 0.64), .orientation = {0.5, 0.1, 0.7, -0.2}});
    return body_forces(GravityOfBodies{.degree = Figure::sites}, s).energy - body_forces(GravityOfBodies{}, s).energy;
  };
  CHECK(std::abs(std::log2(difference(10) / difference(20)) - 5) < 0.05);
}

TEST_CASE("gravity by sites is that of all mass points, gathered", "[forces][bodies]") {
  const ParticleSystem<double> s = two_octahedra();
  const BodyForces e = body_forces(GravityOfBodies{.degree = Figure::sites}, s);
  const Sites<double> sites(s);
  const ParticleSystem<double>& points = sites.particles();
  VectorColumn<double> a(points.size());
  ForceSink<double> sink(a, points, {.energy = true});
  Gravity{}.add_to(sink, points);
  double within = 0;  // what sites of one body have of each other, which the force leaves out
  std::array<Vec3<double>, 2> force, torque;
  for (Index i = 0; i < 2; ++i) {
    const auto at = static_cast<std::size_t>(i);
    force[at] = torque[at] = Vec3<double>::Zero();
    for (Index k = sites.first(i); k < sites.first(i + 1); ++k) {
      const Vec3<double> f = points.masses()[k] * Vec3<double>(std::as_const(a)[k]);
      force[at] += f;
      torque[at] += cross<double>(sites.arm(k), f);
      for (Index l = k + 1; l < sites.first(i + 1); ++l) {
        within -= points.masses()[k] * points.masses()[l] / (points.positions()[k] - points.positions()[l]).norm();
      }
    }
    CHECK((force[at] - s.masses()[i] * Vec3<double>(e.a[i])).norm() < 1e-15);
    CHECK((torque[at] - Vec3<double>(e.torque[i])).norm() < 1e-15);
  }
  CHECK(std::abs(sink.potential() - within - e.energy) < 1e-14);
}

TEST_CASE("two bodies of mass points have the errors and orders of their methods", "[forces][bodies]") {
  struct Run {
    double error, energy, angular_momentum;
  };
  const auto run = [](const std::string& scheme, double h, Rotor rotor = Rotor::exact) {
    ForceField<double> forces;
    forces.add(GravityOfBodies{.degree = Figure::sites});
    Simulation sim(two_octahedra(), compose(turning(forces, {.rotor = rotor}), *schemes::find(scheme)), h);
    auto& momentum = sim.every(1, AngularMomentum{});
    auto& energy = sim.every(1, Energy{});
    REQUIRE(sim.run(std::lround(20 / h)).ok());
    const Vec3<double> a(-0.1737055453955793531, 0.1569383430404929028, -0.02578407384173554506);
    const Vec3<double> b(1.7370554539557935308, -1.5693834304049290279, 0.25784073841735545061);
    const auto& x = sim.particles().positions();
    return Run{std::max((x[0] - a).cwiseAbs().maxCoeff(), (x[1] - b).cwiseAbs().maxCoeff()), energy.worst(),
               momentum.report().worst.value()};
  };
  const auto near = [](double found, double figure) { return std::abs(found / figure - 1) < 0.03; };
  struct Row {
    const char* scheme;
    double h, finer, error, slope, energy;
    Rotor rotor = Rotor::exact;
  };
  for (const Row& row : {Row{"verlet", 1. / 20, 1. / 40, 7.586e-4, 2.00, 3.47e-5},
                         Row{"verlet", 1. / 20, 1. / 40, 7.503e-4, 2.00, 3.02e-5, Rotor::axes},
                         Row{"blanes_moan_s6", 1. / 6, 1. / 12, 9.896e-8, 4.00, 2.91e-9},
                         Row{"srkn14a", 1. / 3, 2. / 9, 4.893e-11, 5.99, 1.41e-12}}) {
    CAPTURE(row.scheme, static_cast<int>(row.rotor));
    const Run at = run(row.scheme, row.h, row.rotor), finer = run(row.scheme, row.finer, row.rotor);
    CHECK(near(at.error, row.error));
    CHECK(near(at.energy, row.energy));
    CHECK(std::abs(std::log(at.error / finer.error) / std::log(row.h / row.finer) - row.slope) < 0.05);
    // In units of sum m |x| |v| = 0.1458: of 1e-15 by itself.
    CHECK(at.angular_momentum * 0.1458 < 1e-15);
    CHECK(finer.angular_momentum * 0.1458 < 1e-15);
  }
}

TEST_CASE("forces on sites act on bodies as on the atoms that they are made of", "[forces][bodies]") {
  // Two three-site molecules and a free point between them, with charges and Lennard-Jones.
  Topology types;
  types.type_names = {"O", "H"};
  types.pair_kinds = {{0.65, 0.3165}, {0, 1}};
  ParticleSystem<double> s(unit_system("molecular"));
  const auto water = [] {
    std::vector<BodySite> sites(3);
    sites[0] = {.place = {0, 0, 0}, .mass = 15.9994, .charge = -0.8476, .type = 0};
    sites[1] = {.place = {0.08165, 0.05774, 0}, .mass = 1.00794, .charge = 0.4238, .type = 1};
    sites[2] = {.place = {-0.08165, 0.05774, 0}, .mass = 1.00794, .charge = 0.4238, .type = 1};
    return body_of_sites("water", sites);
  };
  s.add_column<Charge>();
  add_body(s, water(), {.x = {0.1, 0.1, 0.1}, .orientation = {1, 0.2, -0.3, 0.1}});
  const Index ion = s.add("ion", 23, {0.42, 0.1, 1.95}, {0, 0, 0});
  add_body(s, water(), {.x = {0.7, 0.2, 0.0}, .orientation = {0.5, 0.1, 0.7, -0.2}});
  s.column<Charge>()[ion] = 1;
  types.types = {0, 0, 0};
  s.set_topology(std::make_shared<const Topology>(types));
  s.set_box(Box::periodic({2, 2, 2}));
  ForceField<double> all;
  LennardJonesForce lj;
  lj.cutoff = 0.8;
  all.add(lj).add(ReactionFieldForce{{.radius = 0.8}});
  all.bind(Sites<double>(s).particles());
  const BodyForces e = body_forces(OnSites<double>(all), s);
  // The energy falls as bodies move and turn along forces and torques.
  const auto energy_at = [&](Index i, const Vec3<double>& shift, const Vec3<double>& turn) {
    ParticleSystem<double> moved = s;
    moved.shift(i, shift, Vec3<double>::Zero());
    moved.moved();
    const Quaternion<double> q = std::as_const(moved).column<BodyOrientation>()[i];
    Quaternion<double> by = quaternion<double>(1, turn / 2);
    by /= std::sqrt(norm_defect(by) + 1);
    moved.column<BodyOrientation>().set(i, quaternion_product<double>(by, q));
    return body_forces(OnSites<double>(all), moved).energy;
  };
  const double h = 1e-5;
  for (const Index i : {Index(0), ion, Index(2)}) {
    for (int k = 0; k < 3; ++k) {
      const Vec3<double> d = h * Vec3<double>::Unit(k), none = Vec3<double>::Zero();
      CAPTURE(i, k);
      const double force = s.masses()[i] * e.a[i][k];
      CHECK(std::abs((energy_at(i, d, none) - energy_at(i, -d, none)) / (2 * h) + force) <
            1e-5 * (1 + std::abs(force)));
      const double torque = e.torque[i][k];
      CHECK(std::abs((energy_at(i, none, d) - energy_at(i, none, -d)) / (2 * h) + torque) <
            1e-5 * (1 + std::abs(torque)));
    }
  }
  CHECK(Vec3<double>(e.torque[ion]) == Vec3<double>::Zero());
  // The virial is that of the centres: dU/d(log of the box) with bodies of fixed size, of forces between near ones.
  const auto stretched = [&](double by) {
    ParticleSystem<double> other = s;
    for (Index i = 0; i < s.size(); ++i) {
      // About the first body, all others by the minimum image.
      const Vec3<double> d = s.box().minimum_image(Vec3<double>(s.positions()[i] - s.positions()[0]));
      other.shift(i, by * d, Vec3<double>::Zero());
    }
    other.moved();
    return body_forces(OnSites<double>(all), other).energy;
  };
  const double slope = (stretched(h) - stretched(-h)) / (2 * h);
  CHECK(std::abs(slope + e.virial.trace()) < 1e-5 * (1 + std::abs(slope)));
}

TEST_CASE("a site without mass hands its force on", "[forces][bodies]") {
  ParticleSystem<double> s(unit_system("reduced"));
  std::vector<BodySite> sites(4);
  sites[0] = {.place = {0, 0, 0}, .mass = 2};
  sites[1] = {.place = {1, 0, 0}, .mass = 1};
  sites[2] = {.place = {0, 1, 0}, .mass = 1};
  sites[3] = {.place = {0, 0, 1}, .charge = 1};
  add_body(s, body_of_sites("with a charge", sites), {.x = {0.3, 0, 0}});
  const BodyForces e = body_forces(on_sites(HarmonicField{.k = 2}), s);
  const Sites<double> all(s);
  Vec3<double> force = Vec3<double>::Zero(), torque = force;
  for (Index a = 0; a < 4; ++a) {
    const Vec3<double> f = -2 * Vec3<double>(all.particles().positions()[a]);
    force += f;
    torque += cross<double>(all.arm(a), f);
  }
  CHECK((4 * Vec3<double>(e.a[0]) - force).norm() < 1e-14);
  CHECK((Vec3<double>(e.torque[0]) - torque).norm() < 1e-14);
  CHECK(s.masses()[0] == 4);
}

TEST_CASE("molecules with a charge on a site without mass run in a box", "[forces][bodies]") {
  Topology types;
  types.type_names = {"O", "H", "M"};
  types.pair_kinds = {{0.65, 0.3154}, {0, 1}, {0, 1}};
  types.types = {0, 0};
  ParticleSystem<double> s(unit_system("molecular"));
  std::vector<BodySite> sites(4);  // as TIP4P has them
  sites[0] = {.place = {0, 0, 0}, .mass = 15.9994, .charge = 0, .type = 0};
  sites[1] = {.place = {0.0757, 0.0586, 0}, .mass = 1.008, .charge = 0.52, .type = 1};
  sites[2] = {.place = {-0.0757, 0.0586, 0}, .mass = 1.008, .charge = 0.52, .type = 1};
  sites[3] = {.place = {0, 0.015, 0}, .mass = 0, .charge = -1.04, .type = 2};
  const RigidBody water = body_of_sites("water", sites);
  add_body(s, water, {.x = {0.3, 0.3, 0.3}});
  add_body(s, water, {.x = {0.6, 0.35, 0.3}, .orientation = {0.5, 0.1, 0.7, -0.2}});
  s.set_topology(std::make_shared<const Topology>(types));
  s.set_box(Box::periodic({2, 2, 2}));
  LennardJonesForce lj;
  lj.cutoff = 0.8;
  lj.cutoff_style = Cutoff::switch_c4;
  ForceField<double> all;
  all.add(OnSites<double>(ForceField<double>().add(lj).add(ReactionFieldForce{{.radius = 0.8}})));
  const auto error = [&](double h) {
    Simulation sim(s, compose(turning(all), schemes::verlet), h);
    auto& energy = sim.every(1, Energy{});
    REQUIRE(sim.run(std::lround(0.2 / h)).ok());
    return energy.worst();
  };
  CHECK(error(0.001) / error(0.0005) > 3);
}

TEST_CASE("what cannot act on the sites of bodies is refused", "[forces][bodies]") {
  const auto refusal = [](const auto& make) {
    try {
      make();
    } catch (const Error& error) {
      return error.message();
    }
    return std::string("none");
  };
  CHECK(refusal([] { Simulation(two_octahedra(), compose(turning(on_sites(Gravity{})), schemes::verlet), 0.01); }) ==
        "'gravity' would act between the sites of a rigid body too; use gravity_of_bodies");
  CHECK(refusal([] {
          ParticleSystem<double> s = two_octahedra();
          Topology pairs;
          pairs.exclusions = {{0, 1}};
          s.set_topology(std::make_shared<const Topology>(pairs));
          Sites<double> sites(s);
        }).find("has several sites; take the pair out") != std::string::npos);
  CHECK(refusal([] {
          ParticleSystem<double> s = two_octahedra();
          s.masses()[0] = 2;
          Sites<double> sites(s);
        }) == "the mass of body 'a' is not that of its sites; change its sites too");
}

}  // namespace noether
