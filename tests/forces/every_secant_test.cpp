/// What secants promise, for every force that has them.

#include "forces/anharmonic_chain.hpp"
#include "forces/bonded.hpp"
#include "forces/coulomb.hpp"
#include "forces/external_fields.hpp"
#include "forces/fermi_pasta_ulam.hpp"
#include "forces/gr_potential.hpp"
#include "forces/gravity.hpp"
#include "forces/henon_heiles.hpp"
#include "forces/hyperelastic.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/oblateness.hpp"
#include "forces/pair_potentials.hpp"
#include "forces/secant_tangent.hpp"
#include "forces/springs.hpp"
#include "forces/sum.hpp"
#include "forces/traction.hpp"
#include "integrators/force_motion.hpp"
#include "scene/parts.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace noether {
namespace {

constexpr double half_turn = 3.14159265358979323846;

struct NamedForce {
  std::string name;
  AnyForce<double> force;
  std::vector<TermKind> bonds = {}, angles = {}, dihedrals = {}, impropers = {};
};

/// Every force that has secants, its variants, and for `bonded` every potential alone.
std::vector<NamedForce> forces_with_secants() {
  std::vector<NamedForce> all;
  const auto add = [&](const AnyForce<double>& force) { all.push_back({force.name(), force}); };
  add(Gravity{.G = 0.7});
  add(Gravity{.G = 1, .softening = 0.3});
  add(GrPotential{.c = 3, .G = 1});
  add(Oblateness{.J2 = 0.3, .J4 = -0.1, .radius = 0.8, .axis = {0.2, 0.3, 1}, .G = 1});
  add(UniformField{{0.3, -0.2, 0.5}});
  add(HarmonicField{0.8});
  add(HenonHeiles{1.1, 3});
  add(FermiPastaUlam{.k = 20, .quartic = 1.5});
  add(AnharmonicChain{.k = 3, .cubic = 0.8, .quartic = 1.5});
  for (const Cutoff style :
       {Cutoff::plain, Cutoff::shifted, Cutoff::shifted_force, Cutoff::switch_c2, Cutoff::switch_c4,
        Cutoff::potential_switch, Cutoff::charmm_switch, Cutoff::force_switch}) {
    add(LennardJonesForce{.cutoff = 2.4, .cutoff_style = style, .epsilon = 1.3, .sigma = 1.1});
    add(MorseForce{{.depth = 1, .a = 1.5, .length = 1}, 2.4, style});
  }
  add(WcaForce{{.epsilon = 1.5, .sigma = 1.5}});
  add(BuckinghamForce{{.A = 300, .rho = 0.3, .C = 0.5}, 2.4});
  add(ReactionFieldForce{{2.4, 78.3}});
  add(Coulomb{});
  add(ReactionFieldForce{{.radius = 2.4, .dielectric = 78.3, .answers_excluded = true}});
  add(HarmonicBond{.k = 25, .length = 1.2, .tied = {{0, 1}, {1, 2}, {3, 6}}});
  add(HarmonicBond{.k = 25, .tied = {{0, 1}, {2, 5}}});
  add(Tether{.point = {0.1, 0.2, 0.3}, .k = 4, .length = 1, .tied = {{1}, {4}}});
  add(HyperelasticForce{{.lambda = 3, .mu = 2}});
  add(HyperelasticForce{{.material = ElasticLaw::neo_hookean, .young_modulus = 7, .poisson_ratio = 0.3}});
  add(Traction{.surface = "side", .traction = {1, 0.5, -2}});
  for (const TermKind& kind : std::vector<TermKind>{
           {"harmonic", {250, 1.1}}, {"harmonic", {20, 0}}, {"morse", {3.5, 1.7, 0.9}}, {"fene", {30, 2.5, 1.2, 1.6}}})
    all.push_back({"bonded", Bonded{}, {kind}});
  for (const TermKind& kind : std::vector<TermKind>{{"harmonic", {40, 1.9}},
                                                    {"harmonic", {40, half_turn}},
                                                    {"cosine", {7}},
                                                    {"cosine_squared", {12, 2.1}},
                                                    {"urey_bradley", {4, 2, 3, 1}}})
    all.push_back({"bonded", Bonded{}, {}, {kind}});
  for (const TermKind& kind : std::vector<TermKind>{{"periodic", {2.5, 3, 1}},
                                                    {"ryckaert_bellemans", {9.28, 12.16, -13.12, -3.06, 26.24, -31.5}},
                                                    {"one_four", {0.4, 1.2, -0.7}}})
    all.push_back({"bonded", Bonded{}, {}, {}, {kind}});
  for (const TermKind& kind : std::vector<TermKind>{{"harmonic", {5, 0.6}}, {"periodic", {1.5, 2, half_turn}}})
    all.push_back({"bonded", Bonded{}, {}, {}, {}, {kind}});
  return all;
}

/// Tetrahedra of four particles in a row, which were elsewhere at rest, and one triangle.
std::shared_ptr<const Mesh> mesh_along(const ParticleSystem<double>& s) {
  auto mesh = std::make_shared<Mesh>();
  for (Index i = 0; i < s.size(); ++i) {
    const auto k = static_cast<double>(i);
    mesh->rest.emplace_back(s.positions()[i] + 0.1 * Vec3<double>(std::cos(3 * k), std::sin(5 * k), std::cos(7 * k)));
  }
  for (Index i = 0; i + 3 < s.size(); ++i) mesh->tetrahedra.push_back({{i, i + 1, i + 2, i + 3}, 0});
  mesh->turn_outside_in();
  mesh->triangles = {{{0, 2, 4}, 0}};
  mesh->surfaces = {"side"};
  return mesh;
}

/// A charged_helix of seven charges, bonded along its way as a force wants it.
ParticleSystem<double> charged_helix(const NamedForce& of) {
  ParticleSystem<double> s(unit_system("reduced"));
  const Index n = 7;
  for (Index k = 0; k < n; ++k) {
    const auto i = static_cast<double>(k);
    s.add("p" + std::to_string(k), 1 + 0.5 * i, Vec3<double>(1.2 * std::cos(1.3 * i), 1.2 * std::sin(1.3 * i), 0.6 * i),
          Vec3<double>::Zero());
  }
  auto& q = s.add_column<Charge>();
  for (Index k = 0; k < n; ++k) q[k] = k % 2 == 0 ? 1.5 : -0.7;
  auto topology = std::make_shared<Topology>();
  topology->bond_kinds = of.bonds;
  topology->angle_kinds = of.angles;
  topology->dihedral_kinds = of.dihedrals;
  topology->improper_kinds = of.impropers;
  for (Index k = 0; k + 1 < n && !of.bonds.empty(); ++k) topology->bonds.push_back({{k, k + 1}, 0});
  for (Index k = 0; k + 2 < n && !of.angles.empty(); ++k) topology->angles.push_back({{k, k + 1, k + 2}, 0});
  for (Index k = 0; k + 3 < n && !of.dihedrals.empty(); ++k)
    topology->dihedrals.push_back({{k, k + 1, k + 2, k + 3}, 0});
  for (Index k = 0; k + 3 < n && !of.impropers.empty(); ++k)
    topology->impropers.push_back({{k, k + 1, k + 2, k + 3}, 0});
  topology->mesh = mesh_along(s);
  s.set_topology(topology);
  return s;
}

/// The same particles later: each elsewhere by `size`, all turned by four times that and carried on.
ParticleSystem<double> one_step_later(const ParticleSystem<double>& from, double size) {
  ParticleSystem<double> to = from;
  const double c = std::cos(4 * size), s = std::sin(4 * size);
  for (Index i = 0; i < to.size(); ++i) {
    const auto k = static_cast<double>(i);
    const Vec3<double> x = from.positions()[i];
    const Vec3<double> turned(x[0], c * x[1] - s * x[2], s * x[1] + c * x[2]);
    const Vec3<double> own(std::sin(5 * k), std::cos(7 * k), std::sin(11 * k + 1));
    to.shift(i, Vec3<double>(turned - x + size * (own + Vec3<double>(1, -2, 3))), Vec3<double>::Zero());
  }
  to.moved();
  return to;
}

template <class Real> Real potential_of(const AnyForce<Real>& force, const ParticleSystem<Real>& s) {
  VectorColumn<Real> a(s.size());
  ForceSink<Real> sink(a, s, {.energy = true});
  force.add_to(sink, s);
  return sink.potential();
}
template <class Real>
VectorColumn<Real> secants_of(const AnyForce<Real>& force, const ParticleSystem<Real>& from,
                              const ParticleSystem<Real>& to) {
  VectorColumn<Real> a(to.size());
  ForceSink<Real> sink(a, to, {});
  force.add_secant_to(sink, from, to);
  REQUIRE_FALSE(sink.failure());
  return a;
}
template <class Real>
Real work_done_by(const VectorColumn<Real>& a, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) {
  Real work(0);
  for (Index i = 0; i < to.size(); ++i) {
    work += to.masses()[i] * dot(a[i], Vec3<Real>(to.unwrapped(i) - from.unwrapped(i)));
  }
  return work;
}
double most_of(const VectorColumn<double>& a) { return a.all().cwiseAbs().maxCoeff(); }
double most_apart(const VectorColumn<double>& a, const VectorColumn<double>& b) {
  return (a.all() - b.all()).cwiseAbs().maxCoeff();
}

constexpr double step_sizes[] = {1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.03, 0.1};

}  // namespace

TEST_CASE("the work of the secants of every force is the difference of its energies", "[forces][secant]") {
  for (const NamedForce& one : forces_with_secants()) {
    REQUIRE(one.force.has_secant());
    const ParticleSystem<double> from = charged_helix(one);
    const AnyForce<Quad> wide = *one.force.in_quad();
    const ParticleSystem<Quad> wide_from = from.as<Quad>();
    double most = 0;
    for (const double size : step_sizes) {
      INFO(one.name << ", " << size);
      const ParticleSystem<double> to = one_step_later(from, size);
      const ParticleSystem<Quad> wide_to = to.as<Quad>();
      const Quad before = potential_of(wide, wide_from), after = potential_of(wide, wide_to);
      const double scale = 1 + std::abs(static_cast<double>(before)) + std::abs(static_cast<double>(after));
      const double work = work_done_by(secants_of(one.force, from, to), from, to);
      CHECK(std::abs(work - static_cast<double>(before - after)) < 1e-12 * scale);
      const Quad wide_work = work_done_by(secants_of(wide, wide_from, wide_to), wide_from, wide_to);
      CHECK(std::abs(static_cast<double>(wide_work - (before - after))) < 1e-31 * scale);
      most = std::max(most, std::abs(work) / size);
    }
    CHECK(most > 0.01);
  }
}

TEST_CASE("the secants of every force are the same for both directions, and forces for short steps",
          "[forces][secant]") {
  for (const NamedForce& one : forces_with_secants()) {
    const ParticleSystem<double> from = charged_helix(one);
    VectorColumn<double> force(from.size());
    ForceSink<double> sink(force, from, {});
    one.force.add_to(sink, from);
    for (const double size : step_sizes) {
      INFO(one.name << ", " << size);
      const ParticleSystem<double> to = one_step_later(from, size);
      const VectorColumn<double> there = secants_of(one.force, from, to), back = secants_of(one.force, to, from);
      CHECK(most_apart(there, back) < 1e-7 * most_of(there));
      if (size < 1e-5) CHECK(most_apart(there, force) < (1e-6 + 300 * size) * (1 + most_of(force)));
    }
    const VectorColumn<double> nowhere = secants_of(one.force, from, from);
    CHECK(most_apart(nowhere, force) < 1e-12 * (1 + most_of(force)));
  }
}

TEST_CASE("secants keep momentum and angular momentum where their forces do", "[forces][secant]") {
  int kept = 0;
  for (const NamedForce& one : forces_with_secants()) {
    const ParticleSystem<double> from = charged_helix(one), to = one_step_later(from, 0.05);
    const VectorColumn<double> a = secants_of(one.force, from, to);
    Vec3<double> force = Vec3<double>::Zero(), torque = force;
    double size = 0;
    for (Index i = 0; i < to.size(); ++i) {
      const Vec3<double> f = to.masses()[i] * a[i], middle = (from.positions()[i] + to.positions()[i]) / 2;
      force += f;
      torque += cross(middle, f);
      size += std::sqrt(norm2(f) * norm2(middle));
    }
    INFO(one.name);
    if (one.force.claims().keeps_momentum) CHECK(std::sqrt(norm2(force)) < 1e-13 * size);
    if (!one.force.claims().keeps_angular_momentum) continue;
    ++kept;
    CHECK(std::sqrt(norm2(torque)) < 1e-13 * size);
  }
  CHECK(kept > 20);
}

/// The derivative of secants along a motion of the second state, by their tangent.
template <class Real>
Vector<Real> slope_along(const AnyForce<Real>& force, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to,
                         const Vector<Real>& way) {
  SecantTangent<Real> tangent;
  VectorColumn<Real> a(to.size());
  do {
    tangent.begin(to.masses());
    ForceSink<Real> sink(a, to, {});
    sink.set_tangent(&tangent);
    force.add_secant_to(sink, from, to);
  } while (!tangent.end());
  return tangent.matrix() * way;
}

/// The same by a difference of the secants themselves.
Vector<Quad> difference_along(const AnyForce<Quad>& force, const ParticleSystem<Quad>& from,
                              const ParticleSystem<Quad>& to, const Vector<Quad>& way) {
  const Index n = to.size();
  const auto at = [&](const Quad& part) {
    ParticleSystem<Quad> moved = to;
    for (Index i = 0; i < n; ++i) {
      moved.shift(i, Vec3<Quad>(part * Vec3<Quad>(way[i], way[n + i], way[2 * n + i])), Vec3<Quad>::Zero());
    }
    moved.moved();
    return secants_of(force, from, moved);
  };
  const Quad part(1e-12);
  const VectorColumn<Quad> up = at(part), down = at(-part);
  Vector<Quad> slope(3 * n);
  for (Index i = 0; i < n; ++i) {
    for (Index k = 0; k < 3; ++k) slope[k * n + i] = (up[i][k] - down[i][k]) / (part + part);
  }
  return slope;
}

TEST_CASE("the derivatives of secants are those that differences of 113 bits find, for steps of any size",
          "[forces][secant]") {
  int known = 0;
  for (const NamedForce& one : forces_with_secants()) {
    if (one.force.claims().tangent == TangentPattern::none) continue;
    ++known;
    // The work that a middle misses is rounded, and divided by the step; so are products of the constants of a pair.
    const bool has_middle =
        one.name == "hyperelastic" || one.angles.size() + one.dihedrals.size() + one.impropers.size();
    const double bound = has_middle ? 1e-4 : 1e-8;
    const double wide_bound = one.name == "lennard_jones" ? 1e-6 : has_middle ? 1e-8 : 1e-13;
    const ParticleSystem<double> from = charged_helix(one);
    const AnyForce<Quad> wide = *one.force.in_quad();
    for (const double size : {0.0, 1e-9, 1e-6, 1e-4, 1e-2, 0.1}) {
      INFO(one.name << ", " << size);
      const ParticleSystem<double> to = one_step_later(from, size);
      Vector<double> way(3 * to.size());
      for (Index k = 0; k < way.size(); ++k) way[k] = std::sin(3.0 + 5.0 * static_cast<double>(k));
      const ParticleSystem<Quad> wide_from = from.as<Quad>(), wide_to = to.as<Quad>();
      const Vector<Quad> wide_way = way.cast<Quad>();
      const Vector<Quad> expected = difference_along(wide, wide_from, wide_to, wide_way);
      const double most = static_cast<double>(expected.cwiseAbs().maxCoeff());
      const Vector<Quad> narrow_error = slope_along(one.force, from, to, way).cast<Quad>() - expected;
      CHECK(static_cast<double>(narrow_error.cwiseAbs().maxCoeff()) <= bound * most);
      const Vector<Quad> wide_error = slope_along(wide, wide_from, wide_to, wide_way) - expected;
      CHECK(static_cast<double>(wide_error.cwiseAbs().maxCoeff()) <= wide_bound * most);
    }
  }
  CHECK(known == 46);
}

TEST_CASE("all forces of points with an energy have secants, but for one that depends on time", "[forces][secant]") {
  std::set<std::string> have = {"oscillating_field"};
  const std::set<std::string> of_lattices = {"ewald", "particle_mesh_ewald"};  // energies that are not of pairs
  for (const NamedForce& one : forces_with_secants()) have.insert(one.name);
  const Parts parts = standard_parts();
  for (const Parts::ForceKind& kind : parts.forces()) {
    INFO(kind.info.name);
    const bool of_points = !kind.claims.velocity_dependent && !kind.claims.on_bodies &&
                           of_lattices.count(std::string(kind.info.name)) == 0;
    CHECK((kind.claims.energy && of_points) == (have.count(std::string(kind.info.name)) == 1));
  }
  const AnyForce<double> none = OscillatingField{{1, 0, 0}, 2, 0};
  CHECK_FALSE(none.has_secant());
  const ParticleSystem<double> s = charged_helix({"", none});
  VectorColumn<double> a(s.size());
  ForceSink<double> sink(a, s, {});
  CHECK_THROWS_WITH(none.add_secant_to(sink, s, s), Catch::Contains("'oscillating_field', which has none"));
}

TEST_CASE("sums of forces have secants if all of them do", "[forces][secant]") {
  const Gravity gravity{.G = 1};
  const HarmonicBond spring{.k = 25, .length = 1.2, .tied = {{0, 1}, {1, 2}}};
  const Sum sum(gravity, spring);
  const ParticleSystem<double> from = charged_helix({"", gravity}), to = one_step_later(from, 0.05);
  REQUIRE(sum.has_secant());
  VectorColumn<double> expected = secants_of<double>(gravity, from, to);
  expected.all() += secants_of<double>(spring, from, to).all();
  CHECK(most_apart(secants_of<double>(sum, from, to), expected) < 1e-14 * most_of(expected));
  CHECK_FALSE(Sum(gravity, OscillatingField{}).has_secant());
  CHECK(Sum(spring, UniformField{}).claims().tangent == TangentPattern::sparse);
  CHECK(sum.claims().tangent == TangentPattern::full);
  CHECK(Sum(gravity, HenonHeiles{}).claims().tangent == TangentPattern::none);
}

}  // namespace noether
