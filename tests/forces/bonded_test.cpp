// Bonded terms: against derivatives by dual numbers, closed forms, symmetries, and another program.

#include "forces/bonded.hpp"
#include "engine/erasure.hpp"
#include "forces/check_gradient.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/settings.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace noether {
namespace {

constexpr double pi = 3.14159265358979323846;

/// One kind of each family, or none.
struct Kinds {
  std::vector<TermKind> bonds, angles, dihedrals, impropers;
};

/// A chain 0 - 1 - 2 - ... with terms of the given kinds everywhere along it.
std::shared_ptr<const Topology> chain(Index n, const Kinds& kinds) {
  auto topology = std::make_shared<Topology>();
  topology->bond_kinds = kinds.bonds;
  topology->angle_kinds = kinds.angles;
  topology->dihedral_kinds = kinds.dihedrals;
  topology->improper_kinds = kinds.impropers;
  const auto along = [n](auto& terms, const std::vector<TermKind>& of, auto one) {
    const auto size = static_cast<Index>(one.particles.size());
    for (std::size_t type = 0; type < of.size(); ++type) {
      for (Index i = 0; i + size <= n; ++i) {
        for (Index k = 0; k < size; ++k) one.particles[static_cast<std::size_t>(k)] = i + k;
        one.type = static_cast<int>(type);
        terms.push_back(one);
      }
    }
  };
  along(topology->bonds, kinds.bonds, BondedTerm<2>{});
  along(topology->angles, kinds.angles, BondedTerm<3>{});
  along(topology->dihedrals, kinds.dihedrals, BondedTerm<4>{});
  along(topology->impropers, kinds.impropers, BondedTerm<4>{});
  return topology;
}

const std::vector<TermKind> bond_kinds = {
    {"harmonic", {250, 1.1}}, {"harmonic", {20, 0}}, {"morse", {3.5, 1.7, 0.9}}, {"fene", {30, 2.5, 1.2, 1.1}}};
const std::vector<TermKind> angle_kinds = {
    {"harmonic", {40, 1.9}},       {"harmonic", {40, pi}},       {"harmonic", {3, 0}},          {"cosine", {7}},
    {"cosine_squared", {12, 2.1}}, {"cosine_squared", {12, pi}}, {"urey_bradley", {4, 2, 3, 1}}};
const std::vector<TermKind> dihedral_kinds = {{"periodic", {2.5, 3, 1}},
                                              {"ryckaert_bellemans", {9.28, 12.16, -13.12, -3.06, 26.24, -31.5}},
                                              {"one_four", {0.4, 1.2, -0.7}}};
const std::vector<TermKind> improper_kinds = {
    {"harmonic", {5, 0}}, {"harmonic", {5, 0.6}}, {"harmonic", {4, pi}}, {"periodic", {1.5, 2, pi}}};

const Kinds every_kind = {bond_kinds, angle_kinds, dihedral_kinds, improper_kinds};

/// Every kind alone.
std::vector<Kinds> one_by_one() {
  std::vector<Kinds> result;
  for (const TermKind& kind : bond_kinds) result.push_back({{kind}, {}, {}, {}});
  for (const TermKind& kind : angle_kinds) result.push_back({{}, {kind}, {}, {}});
  for (const TermKind& kind : dihedral_kinds) result.push_back({{}, {}, {kind}, {}});
  for (const TermKind& kind : improper_kinds) result.push_back({{}, {}, {}, {kind}});
  return result;
}

/// Numbers in (-1, 1), the same everywhere.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed) {}
  double next() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state_ >> 11U) * 0x1p-52 - 1;
  }
  Vec3<double> vector() { return Vec3<double>(next(), next(), next()); }

 private:
  std::uint64_t state_;
};

/// A crooked chain with steps of about 1; `bend` is how far from straight it may be.
ParticleSystem<double> crooked(Index n, std::uint64_t seed, double bend = 1) {
  Numbers numbers(seed);
  ParticleSystem<double> s;
  Vec3<double> x = numbers.vector();
  for (Index i = 0; i < n; ++i) {
    s.add("p" + std::to_string(i), 1 + 0.25 * static_cast<double>(i % 5), x, numbers.vector());
    x += Vec3<double>(1, 0.25, -0.25) + bend * Vec3<double>(0.25, 0.5, 0.5).cwiseProduct(numbers.vector());
  }
  return s;
}

template <class Real> struct Evaluated {
  VectorColumn<Real> force;
  Real energy;
  Mat3<Real> virial;
  std::optional<Failure> failure;
};

template <class Real>
Evaluated<Real> evaluate(const Bonded& bonded, const ParticleSystem<Real>& s, Request wanted = {true, true, false}) {
  VectorColumn<Real> a(s.size());
  ForceSink<Real> sink(a, s, wanted);
  bonded.add_to(sink, s);
  for (Index i = 0; i < s.size(); ++i) a.set(i, s.masses()[i] * std::as_const(a)[i]);
  return {std::move(a), sink.potential(), sink.virial(), sink.failure()};
}

template <class Real> Real largest(const VectorColumn<Real>& column) {
  using std::abs;
  Real most(0);
  for (Index i = 0; i < column.size(); ++i) {
    for (int k = 0; k < 3; ++k) most = std::max(most, Real(abs(column.component(k)[i])));
  }
  return most;
}

template <class Real> Real difference(const VectorColumn<Real>& one, const VectorColumn<Real>& other) {
  VectorColumn<Real> rest = one;
  rest.add_scaled(Real(-1), other);
  return largest(rest);
}

/// Minus the derivatives of the energy, each by one direction of a dual number.
VectorColumn<Quad> by_dual_numbers(const Bonded& bonded, const ParticleSystem<Quad>& s) {
  using Number = Dual<Quad, 1>;
  VectorColumn<Quad> force(s.size());
  auto moved = s.as<Number>();
  for (Index i = 0; i < s.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      moved.positions().component(k)[i].slope[0] = Quad(1);
      force.component(k)[i] = -evaluate(bonded, moved).energy.slope[0];
      moved.positions().component(k)[i].slope[0] = Quad(0);
    }
  }
  return force;
}

TEST_CASE("every bonded term is minus the derivative of its energy, near straight lines too", "[bonded]") {
  // Normals of nearly parallel arms lose as many digits as the arms agree in; derivatives by duals lose them twice.
  for (const auto& [bend, allowed] : {std::pair{1.0, 1e-30}, {1e-3, 1e-26}, {1e-6, 1e-20}}) {
    for (const Kinds& kinds : one_by_one()) {
      for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        auto s = crooked(5, seed, bend);
        s.set_topology(chain(5, kinds));
        const auto wide = s.as<Quad>();
        const auto force = evaluate(Bonded{}, wide).force, expected = by_dual_numbers(Bonded{}, wide);
        CHECK(largest(force) > Quad(0));
        CHECK(static_cast<double>(difference(force, expected) / largest(force)) < allowed);
      }
    }
  }
}

TEST_CASE("bonded forces pass the test that users' forces pass", "[bonded]") {
  auto s = crooked(6, 3);
  s.set_topology(chain(6, every_kind));
  CHECK(gradient_error(Bonded{}, s) < 1e-18);
}

TEST_CASE("doubles keep their digits in an angle that is almost straight", "[bonded]") {
  for (const TermKind& kind : {angle_kinds[1], angle_kinds[3], angle_kinds[5]}) {
    for (double bend = 0.1; bend > 1e-12; bend /= 10) {
      ParticleSystem<double> s;
      s.add("one", 1, {-1, 0, 0}, {0, 0, 0});
      s.add("vertex", 1, {0, 0, 0}, {0, 0, 0});
      s.add("other", 1, {1.5, bend, bend / 3}, {0, 0, 0});
      s.set_topology(chain(3, {{}, {kind}, {}, {}}));
      const auto rounded = evaluate(Bonded{}, s);
      const auto wide = evaluate(Bonded{}, s.as<Quad>());
      CHECK(std::abs(rounded.energy / static_cast<double>(wide.energy) - 1) < 2e-15);
      for (const Index i : {0, 2}) {  // the vertex feels the difference of the two
        for (const int k : {1, 2}) {
          const double expected = static_cast<double>(std::as_const(wide.force).component(k)[i]);
          CHECK(std::abs(rounded.force.component(k)[i] / expected - 1) < 2e-15);
        }
      }
    }
  }
}

TEST_CASE("an angle that is exactly straight at rest has neither force nor energy, and a smooth neighborhood",
          "[bonded]") {
  ParticleSystem<double> s;
  for (const double x : {-1.0, 0.0, 2.0}) s.add("p", 1, {x, 0, 0}, {0, 0, 0});
  for (const TermKind& kind : {angle_kinds[1], angle_kinds[3], angle_kinds[5]}) {
    s.set_topology(chain(3, {{}, {kind}, {}, {}}));
    const auto at_rest = evaluate(Bonded{}, s);
    CHECK(at_rest.energy == 0);
    CHECK(largest(at_rest.force) == 0);
    CHECK(largest(by_dual_numbers(Bonded{}, s.as<Quad>())) == Quad(0));
  }
  // Elsewhere there is a tip, and no direction.
  s.set_topology(chain(3, {{}, {angle_kinds[0]}, {}, {}}));
  CHECK(evaluate(Bonded{}, s).energy == 40 * (pi - 1.9) * (pi - 1.9) / 2);
  CHECK(largest(evaluate(Bonded{}, s).force) == 0);
}

TEST_CASE("a dihedral of three particles in line exerts no force", "[bonded]") {
  ParticleSystem<double> s;
  for (const double x : {-1.0, 0.0, 2.0}) s.add("p", 1, {x, 0, 0}, {0, 0, 0});
  s.add("p", 1, {2, 1, 0}, {0, 0, 0});
  for (const TermKind& kind : dihedral_kinds) {
    s.set_topology(chain(4, {{}, {}, {kind}, {}}));
    CHECK((largest(evaluate(Bonded{}, s).force) == 0) == (kind.potential != "one_four"));  // which knows no angle
  }
}

/// Four particles with right angles and a dihedral of phi.
ParticleSystem<double> staircase(double phi) {
  ParticleSystem<double> s;
  s.add("one", 1, {1, 0, 0}, {0, 0, 0});
  s.add("two", 1, {0, 0, 0}, {0, 0, 0});
  s.add("three", 1, {0, 0, 1.25}, {0, 0, 0});
  s.add("four", 1, {std::cos(phi), std::sin(phi), 1.25}, {0, 0, 0});
  return s;
}

double energy_of(ParticleSystem<double> s, const Kinds& kinds) {
  s.set_topology(chain(s.size(), kinds));
  return evaluate(Bonded{}, s).energy;
}

TEST_CASE("dihedrals are 0 in cis, 180 degrees in trans, and positive clockwise", "[bonded]") {
  for (const double degrees : {-179.0, -120.0, -90.0, -31.0, 0.0, 17.0, 60.0, 90.0, 135.0, 180.0}) {
    const double phi = degrees * pi / 180, z = std::cos(phi - pi);
    const auto s = staircase(phi);
    CHECK(std::abs(energy_of(s, {{}, {}, {{"periodic", {2, 1, 0.5}}}, {}}) - 2 * (1 + std::cos(phi - 0.5))) < 1e-15);
    CHECK(std::abs(energy_of(s, {{}, {}, {{"periodic", {2, 3, 0.5}}}, {}}) - 2 * (1 + std::cos(3 * phi - 0.5))) <
          4e-15);
    const std::vector<double> c = {9.28, 12.16, -13.12, -3.06, 26.24, -31.5};
    double expected = 0;
    for (std::size_t n = 0; n < 6; ++n) expected += c[n] * std::pow(z, static_cast<double>(n));
    CHECK(std::abs(energy_of(s, {{}, {}, {{"ryckaert_bellemans", c}}, {}}) - expected) < 1e-13);
    CHECK(std::abs(energy_of(s, {{}, {}, {}, {{"harmonic", {5, 0.6}}}}) - 2.5 * std::pow(std::abs(phi) - 0.6, 2)) <
          1e-14);
  }
}

TEST_CASE("bonds and angles have their energies in closed form", "[bonded]") {
  ParticleSystem<double> s;
  s.add("one", 1, {2, 0, 0}, {0, 0, 0});
  s.add("two", 1, {0, 0, 0}, {0, 0, 0});
  CHECK(energy_of(s, {{{"harmonic", {3, 0.5}}}, {}, {}, {}}) == 3 * 1.5 * 1.5 / 2);
  CHECK(energy_of(s, {{{"morse", {3, 1.5, 2}}}, {}, {}, {}}) == 0);
  CHECK(std::abs(energy_of(s, {{{"morse", {3, 1.5, 1}}}, {}, {}, {}}) - 3 * std::pow(1 - std::exp(-1.5), 2)) < 1e-15);
  // Above 2^(1/6) sigma there is the spring alone; at r = sigma the repulsion is epsilon.
  CHECK(std::abs(energy_of(s, {{{"fene", {3, 4, 1.5, 1.7}}}, {}, {}, {}}) + 24 * std::log(0.75)) < 1e-14);
  CHECK(std::abs(energy_of(s, {{{"fene", {3, 4, 1.5, 2}}}, {}, {}, {}}) + 24 * std::log(0.75) - 1.5) < 1e-14);
  s.add("three", 1, {0, 0.5, 0}, {0, 0, 0});
  CHECK(energy_of(s, {{}, {{"cosine", {7}}}, {}, {}}) == 7);
  CHECK(std::abs(energy_of(s, {{}, {{"harmonic", {7, pi / 3}}}, {}, {}}) - 7 * pi * pi / 72) < 1e-15);
  CHECK(std::abs(energy_of(s, {{}, {{"cosine_squared", {7, pi / 3}}}, {}, {}}) - 7 * 0.125) < 1e-15);
}

TEST_CASE("bonded terms neither push nor turn the whole, and turn with it", "[bonded]") {
  for (const Kinds& kinds : one_by_one()) {
    auto start = crooked(6, 11);
    start.set_topology(chain(6, kinds));
    const auto s = start.as<Quad>();
    const auto here = evaluate(Bonded{}, s);
    Vec3<Quad> push = Vec3<Quad>::Zero(), turn = Vec3<Quad>::Zero();
    for (Index i = 0; i < s.size(); ++i) {
      push += here.force[i];
      turn += cross(s.positions()[i], here.force[i]);
    }
    const Quad scale = largest(here.force);
    CHECK(static_cast<double>(sqrt(norm2(push)) / scale) < 1e-32);
    CHECK(static_cast<double>(sqrt(norm2(turn)) / scale) < 1e-31);
    // By a turn with rational numbers, and a shift.
    Mat3<Quad> turned;
    turned << Quad(2), Quad(-1), Quad(2), Quad(2), Quad(2), Quad(-1), Quad(-1), Quad(2), Quad(2);
    turned /= Quad(3);
    auto other = s;
    for (Index i = 0; i < s.size(); ++i) {
      other.positions().set(i, turned * s.positions()[i] + Vec3<Quad>(Quad(1), Quad(-2), Quad(3)));
    }
    const auto there = evaluate(Bonded{}, other);
    CHECK(static_cast<double>(abs(there.energy - here.energy) / (Quad(1) + abs(here.energy))) < 1e-31);
    VectorColumn<Quad> expected(s.size());
    for (Index i = 0; i < s.size(); ++i) expected.set(i, turned * std::as_const(here.force)[i]);
    CHECK(static_cast<double>(difference(there.force, expected) / scale) < 1e-30);
  }
}

TEST_CASE("the virial of bonded terms is the sum of places times forces", "[bonded]") {
  for (const Kinds& kinds : one_by_one()) {
    auto start = crooked(6, 12);
    start.set_topology(chain(6, kinds));
    const auto s = start.as<Quad>();
    const auto here = evaluate(Bonded{}, s);
    Mat3<Quad> expected = Mat3<Quad>::Zero();
    for (Index i = 0; i < s.size(); ++i) expected += s.positions()[i] * Vec3<Quad>(here.force[i]).transpose();
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        CHECK(static_cast<double>(abs(expected(r, c) - here.virial(r, c)) / largest(here.force)) < 1e-30);
      }
    }
  }
}

TEST_CASE("bonds reach across the faces of a periodic box", "[bonded]") {
  auto open = crooked(8, 5);
  for (Index i = 0; i < open.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      double& x = open.positions().component(k)[i];
      x = std::nearbyint(x * 0x1p20) * 0x1p-20;  // exact on the grid of the box
    }
  }
  open.set_topology(chain(8, every_kind));
  auto cut = open;
  cut.set_box(Box::periodic({7, 5, 6}));
  CHECK(norm2(Vec3<double>(cut.unwrapped(7) - open.unwrapped(7))) == 0);
  CHECK(difference(std::as_const(cut).positions(), std::as_const(open).positions()) > 4);
  const auto here = evaluate(Bonded{}, open), there = evaluate(Bonded{}, cut);
  CHECK(here.energy == there.energy);
  CHECK(here.virial == there.virial);
  CHECK(difference(here.force, there.force) == 0);
  CHECK(claims_of(Bonded{}).periodic);
}

namespace {
VectorColumn<double> in_doubles(const VectorColumn<Quad>& from) {
  VectorColumn<double> to(from.size());
  for (Index i = 0; i < from.size(); ++i) to.set(i, Vec3<Quad>(from[i]).cast<double>());
  return to;
}
}  // namespace

TEST_CASE("bonded forces in double agree with extended precision to rounding", "[bonded]") {
  for (const Kinds& kinds : one_by_one()) {
    for (std::uint64_t seed = 20; seed < 30; ++seed) {
      auto s = crooked(12, seed);
      s.set_topology(chain(12, kinds));
      const auto rounded = evaluate(Bonded{}, s);
      const auto wide = evaluate(Bonded{}, s.as<Quad>());
      CHECK(difference(rounded.force, in_doubles(wide.force)) < 4e-14 * largest(rounded.force));
      CHECK(std::abs(rounded.energy - static_cast<double>(wide.energy)) < 1e-14 * (1 + std::abs(rounded.energy)));
    }
  }
}

TEST_CASE("bonded forces have the same bits on any number of threads, with and without energy", "[bonded]") {
  auto s = crooked(400, 7);
  s.set_topology(chain(400, every_kind));
  const auto one = [&] {
    const test::Threads alone(1);
    return evaluate(Bonded{}, s);
  }();
  for (const int threads : {1, 2, 3, 8}) {
    const test::Threads some(threads);
    const auto many = evaluate(Bonded{}, s);
    CHECK(many.energy == one.energy);
    CHECK(many.virial == one.virial);
    CHECK(difference(many.force, one.force) == 0);
    CHECK(difference(evaluate(Bonded{}, s, {}).force, one.force) == 0);
  }
}

TEST_CASE("bonds many at a time have the bits of bonds one by one, at every SIMD level", "[bonded]") {
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel here(level);
    for (const Index n : {2, 9, 64, 65, 200}) {
      auto s = crooked(n, 8);
      auto topology = std::make_shared<Topology>(*chain(n, {bond_kinds, {}, {}, {}}));
      for (int order = 0; order < 2; ++order) {
        s.set_topology(std::make_shared<const Topology>(*topology));
        const auto one_by_one = evaluate(Bonded{}, s, {.energy = true}), many = evaluate(Bonded{}, s, {});
        CHECK(largest(many.force) > 0);
        CHECK(difference(many.force, one_by_one.force) == 0);
        // Kinds in turn: runs of one bond each.
        std::stable_sort(topology->bonds.begin(), topology->bonds.end(),
                         [](const auto& a, const auto& b) { return a.particles < b.particles; });
      }
    }
  }
}

TEST_CASE("bonds in step along a chain have the bits that they have in any numbering of the particles", "[bonded]") {
  const Index n = 600;
  for (const bool periodic : {false, true}) {
    auto s = crooked(n, 8);
    for (Index i = 0; i < n; ++i) s.masses()[i] = 1;
    if (periodic) s.set_box(Box::periodic({9, 7, 8}));
    auto topology = std::make_shared<Topology>(*chain(n, {bond_kinds, {}, {}, {}}));
    std::erase_if(topology->bonds, [](const auto& bond) { return bond.particles[0] % 150 == 149; });  // four chains
    std::vector<Index> number(static_cast<std::size_t>(n));
    std::iota(number.begin(), number.end(), Index{0});
    std::shuffle(number.begin(), number.end(), std::mt19937(3));
    ParticleSystem<double> other = s;
    auto shuffled = std::make_shared<Topology>(*topology);
    for (Index i = 0; i < n; ++i) {
      other.positions().set(number[static_cast<std::size_t>(i)], std::as_const(s).positions()[i]);
    }
    for (auto& bond : shuffled->bonds) {
      for (Index& i : bond.particles) i = number[static_cast<std::size_t>(i)];
    }
    s.set_topology(topology);
    other.set_topology(shuffled);
    for (const SimdLevel level : test::all_levels()) {
      const test::AtLevel here(level);
      const auto in_step = evaluate(Bonded{}, s, {}), mixed = evaluate(Bonded{}, other, {});
      CHECK(largest(in_step.force) > 0);
      bool same = true;
      for (Index i = 0; i < n; ++i) {
        same = same && in_step.force[i] == mixed.force[number[static_cast<std::size_t>(i)]];
      }
      CHECK(same);
    }
  }
}

TEST_CASE("each lane of a pack has the bits of double", "[bonded]") {
  std::vector<ParticleSystem<double>> systems;
  for (std::uint64_t seed = 0; seed < Pack::lanes; ++seed) systems.push_back(crooked(7, 40 + seed));
  auto packed = systems[0].as<Pack>();
  for (std::size_t lane = 0; lane < Pack::lanes; ++lane) {
    for (Index i = 0; i < 7; ++i) {
      for (int k = 0; k < 3; ++k) {
        packed.positions().component(k)[i].lane[lane] = std::as_const(systems[lane]).positions().component(k)[i];
      }
    }
  }
  packed.set_topology(chain(7, every_kind));
  const auto together = evaluate(Bonded{}, packed);
  for (std::size_t lane = 0; lane < Pack::lanes; ++lane) {
    systems[lane].set_topology(packed.shared_topology());
    const auto alone = evaluate(Bonded{}, systems[lane]);
    CHECK(together.energy.lane[lane] == alone.energy);
    for (Index i = 0; i < 7; ++i) {
      for (int k = 0; k < 3; ++k) {
        CHECK(std::as_const(together.force).component(k)[i].lane[lane] == alone.force.component(k)[i]);
      }
    }
  }
}

TEST_CASE("a fene bond of its greatest length is overstretched, and its particles and length are named", "[bonded]") {
  ParticleSystem<double> s;
  s.add("one", 1, {0, 0, 0}, {0, 0, 0});
  s.add("two", 1, {1, 0, 0}, {0, 0, 0});
  s.add("", 1, {2.5, 0, 0}, {0, 0, 0});
  s.set_topology(chain(3, {{{"fene", {30, 1.5, 1, 1}}}, {}, {}, {}}));
  const auto broken = evaluate(Bonded{}, s);
  REQUIRE(broken.failure.has_value());
  CHECK(broken.failure->kind == Outcome::Kind::overstretch);
  CHECK(broken.failure->particle == 1);
  CHECK(broken.failure->quantity == "bond");
  CHECK(broken.failure->message.find(
            "the bond of 'two' and particle 2 is 1.5 long, but a fene bond must be shorter than 1.5") == 0);
  s.positions().set(2, {2.499, 0, 0});
  CHECK_FALSE(evaluate(Bonded{}, s).failure.has_value());

  auto many = crooked(100, 9);  // where forces alone are asked for, and bonds go many at a time
  many.set_topology(chain(100, {{{"fene", {30, 2.5, 1, 1}}}, {}, {}, {}}));
  CHECK_FALSE(evaluate(Bonded{}, many, {}).failure.has_value());
  many.positions().set(70, many.positions()[69] + Vec3<double>(0, 3, 0));
  many.positions().set(40, many.positions()[39] + Vec3<double>(0, 3, 0));
  const auto two = evaluate(Bonded{}, many, {});
  REQUIRE(two.failure.has_value());
  CHECK(two.failure->particle == 39);
  CHECK(std::isnan(two.force.component(1)[70]));
}

std::string refusal_of(const Topology& topology, Index n) {
  ParticleSystem<double> s;
  for (Index i = 0; i < n; ++i) s.add("p", 1, {static_cast<double>(i), 0, 0}, {0, 0, 0});
  s.set_topology(std::make_shared<Topology>(topology));
  return test::refusal_of([&] { Bonded{}.check(s); });
}

TEST_CASE("bonded terms of unknown kinds, wrong parameters or particles are refused by name", "[bonded]") {
  const auto bonds = [](TermKind kind, BondedTerm<2> term = {{0, 1}, 0}) {
    Topology topology;
    topology.bond_kinds = {std::move(kind)};
    topology.bonds = {term};
    return topology;
  };
  CHECK(refusal_of(bonds({"harmonic", {1, 1}}), 2).empty());
  CHECK(refusal_of(bonds({"harmonc", {1, 1}}), 2)
            .find("unknown potential 'harmonc' of bonds; did you mean 'harmonic'?") == 0);
  CHECK(refusal_of(bonds({"morse", {1, 1}}), 2) ==
        "potential 'morse' of bonds has 2 parameters; 3 are expected: depth, a, length");
  CHECK(refusal_of(bonds({"harmonic", {1, -1}}), 2) ==
        "length = -1 in potential 'harmonic' of bonds: 0 or more is expected");
  CHECK(refusal_of(bonds({"fene", {1, 0, 1, 1}}), 2) ==
        "longest = 0 in potential 'fene' of bonds: a number above 0 is expected");
  CHECK(refusal_of(bonds({"harmonic", {NAN, 1}}), 2) ==
        "k = nan in potential 'harmonic' of bonds: a finite number is expected");
  CHECK(refusal_of(bonds({"harmonic", {1, 1}}, {{0, 2}, 0}), 2) == "a bond is of particle 2, but there are 2");
  CHECK(refusal_of(bonds({"harmonic", {1, 1}}, {{1, 1}, 0}), 2) ==
        "a bond has particle 1 twice; different ones are expected");
  CHECK(refusal_of(bonds({"harmonic", {1, 1}}, {{0, 1}, 1}), 2) == "a bond is of kind 1, but there are 1 kinds");
  CHECK(refusal_of(Topology{}, 2).find("force 'bonded' has nothing to act on") == 0);
  Topology dihedrals;
  dihedrals.dihedral_kinds = {{"periodic", {1, 1.5, 0}}};
  dihedrals.dihedrals = {{{0, 1, 2, 3}, 0}};
  CHECK(refusal_of(dihedrals, 4) ==
        "n = 1.5 in potential 'periodic' of dihedrals: a whole number, 0 or more, is expected");
  ParticleSystem<double> bare;
  CHECK_THROWS_AS(Bonded{}.check(bare), Error);
}

/// One block of tests/data/bonded/lammps.txt.
struct Recorded {
  Kinds kinds;
  std::string name;
  double energy = 0;
  std::vector<double> virial;
  std::vector<Vec3<double>> forces;
};

std::pair<ParticleSystem<double>, std::vector<Recorded>> recorded() {
  std::ifstream file(std::string(NOETHER_SOURCE_DIR) + "/tests/data/bonded/lammps.txt");
  ParticleSystem<double> s;
  std::vector<Recorded> blocks;
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    Vec3<double> x;
    if (word == "box") {
      words >> x[0] >> x[1] >> x[2];
      s.set_box(Box::periodic(x));
    } else if (word == "particle") {
      words >> x[0] >> x[1] >> x[2];
      s.add("p", 1, x, {0, 0, 0});
    } else if (word == "energy") {
      words >> blocks.back().energy;
    } else if (word == "virial") {
      for (double w = 0; words >> w;) blocks.back().virial.push_back(w);
    } else if (word == "force") {
      words >> x[0] >> x[1] >> x[2];
      blocks.back().forces.push_back(x);
    } else {
      TermKind kind;
      std::size_t count = 0;
      words >> kind.potential >> count;
      for (double p = 0; words >> p;) kind.parameters.push_back(p);
      Recorded block;
      block.name = line;
      (word == "bond"       ? block.kinds.bonds
       : word == "angle"    ? block.kinds.angles
       : word == "dihedral" ? block.kinds.dihedrals
                            : block.kinds.impropers) = {kind};
      blocks.push_back(std::move(block));
    }
  }
  return {std::move(s), std::move(blocks)};
}

TEST_CASE("energies, forces and virials of every kind are those of another program", "[bonded]") {
  auto [s, blocks] = recorded();
  REQUIRE(blocks.size() == 12);
  for (const Recorded& block : blocks) {
    INFO(block.name);
    s.set_topology(chain(s.size(), block.kinds));
    const auto here = evaluate(Bonded{}, s);
    VectorColumn<double> expected(s.size());
    for (Index i = 0; i < s.size(); ++i) expected.set(i, block.forces[static_cast<std::size_t>(i)]);
    CHECK(std::abs(here.energy / block.energy - 1) < 1e-13);
    CHECK(difference(here.force, expected) < 1e-12 * largest(here.force));
    const std::vector<double> virial = {here.virial(0, 0), here.virial(1, 1), here.virial(2, 2),
                                        here.virial(0, 1), here.virial(0, 2), here.virial(1, 2)};
    for (std::size_t k = 0; k < 6; ++k) CHECK(std::abs(virial[k] - block.virial[k]) < 1e-11 * largest(here.force));
  }
}

TEST_CASE("a copy of the bonded terms serves other particles", "[bonded]") {
  auto s = crooked(5, 1), other = crooked(9, 2);
  s.set_topology(chain(5, every_kind));
  other.set_topology(chain(9, every_kind));
  const AnyForce<double> force(Bonded{});
  const auto energy = [](const AnyForce<double>& f, const ParticleSystem<double>& of) {
    VectorColumn<double> a(of.size());
    ForceSink<double> sink(a, of, {.energy = true});
    f.add_to(sink, of);
    return sink.potential();
  };
  const double one = energy(force, s), two = energy(force, other);
  CHECK(energy(AnyForce<double>(force), other) == two);
  CHECK(energy(force, s) == one);
  CHECK(force.has_lanes());
  CHECK(force.has_derivative());
  CHECK(force.in_quad().has_value());
}

}  // namespace
}  // namespace noether
