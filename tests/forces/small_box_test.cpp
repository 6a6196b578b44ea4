/// Molecules in boxes smaller than twice the range: a cell has the energy, the forces and the virial that it has as one
/// of many. What is excluded or scaled is a pair of particles where it is nearest, and none of its copies.

#include "engine/charge.hpp"
#include "forces/fused_pair.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/pair_potentials.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/liquid.hpp"
#include "tests/support/pair_forces.hpp"
#include "tests/support/settings.hpp"

#include <cmath>
#include <memory>

namespace noether {
namespace {

constexpr double range = 2.5;

/// What is left of the force within a molecule of three, of neighbors and of its ends.
struct Special {
  double neighbors, ends;
};

Vec3<double> place_of(Index i) {
  const Vec3<double> places[] = {{0.2, 1, 1}, {1.2, 1.1, 1}, {1.6, 1.8, 1.3}};
  return places[i];
}

double charge_of(Index i) { return i == 1 ? -1 : 0.5; }

Vec3<double> cell_edges() { return {3, 3.25, 9}; }

/// So many cells in a row along x, each with a molecule of three particles.
ParticleSystem<double> molecules(Index cells, const Special& special) {
  ParticleSystem<double> s;
  auto topology = std::make_shared<Topology>();
  topology->type_names = {"A"};
  const auto add = [&](Index i, Index j, double factor) {
    if (factor == 0) topology->exclusions.push_back({i, j});
    if (factor != 0 && factor != 1) topology->scaled_pairs.push_back({{i, j}, factor});
  };
  for (Index k = 0; k < cells; ++k) {
    for (Index i = 0; i < 3; ++i) {
      s.add("", 1 + 0.5 * static_cast<double>(i), place_of(i) + Vec3<double>(3.0 * static_cast<double>(k), 0, 0),
            Vec3<double>::Zero());
      topology->types.push_back(0);
    }
    add(3 * k, 3 * k + 1, special.neighbors);
    add(3 * k, 3 * k + 2, special.ends);
    add(3 * k + 1, 3 * k + 2, special.neighbors);
  }
  auto& q = s.add_column<Charge>();
  for (Index i = 0; i < s.size(); ++i) q[i] = charge_of(i % 3);
  s.set_box(Box::periodic({3.0 * static_cast<double>(cells), 3.25, 9}));
  s.set_topology(topology);
  return s;
}

/// The energy of a cell by all pairs of its particles with all others of an endless lattice.
/// @param energy_of  (r, product of charges)
template <class Energy> double energy_of_cell(const Special& special, const Energy& energy_of) {
  long double sum = 0;
  const Vec3<double> edges = cell_edges();
  for (Index i = 0; i < 3; ++i) {
    for (Index j = 0; j < 3; ++j) {
      for (int a = -2; a <= 2; ++a) {
        for (int b = -2; b <= 2; ++b) {
          const bool here = a == 0 && b == 0;  // bonds are within the cell as it is written above
          if (i == j && here) continue;
          const Vec3<double> d = place_of(i) - place_of(j) + Vec3<double>(a * edges[0], b * edges[1], 0);
          const double factor = !here ? 1 : std::abs(static_cast<int>(i - j)) == 1 ? special.neighbors : special.ends;
          const long double r = std::sqrt(static_cast<long double>(norm2(d)));
          if (r < range) sum += factor * energy_of(r, charge_of(i) * charge_of(j)) / 2;
        }
      }
    }
  }
  return static_cast<double>(sum);
}

long double twelve_six(long double r, double) { return 4 * (std::pow(r, -12.0L) - std::pow(r, -6.0L)); }

constexpr Special all_special[] = {{0, 0}, {0, 0.5}, {0.5, 0}, {0.25, 0.5}, {0, 1}, {1, 1}};

/// One cell, two and three of them in a row, in doubles and in 113 bits.
template <class F, class Energy> void check_cells(const F& force, const Energy& energy_of) {
  for (const Special& special : all_special) {
    CAPTURE(special.neighbors, special.ends);
    const test::Evaluated exact = test::evaluated<Quad>(force, molecules(1, special));
    const double expected = energy_of_cell(special, energy_of);
    CHECK(std::abs(expected) > 1e-5);
    CHECK(std::abs(exact.energy - expected) < 1e-14 * (1 + std::abs(expected)));
    for (const Index cells : {1, 2, 3, 4}) {
      CAPTURE(cells);
      const auto s = molecules(cells, special);
      const test::Evaluated found = test::evaluated<double>(force, s);
      REQUIRE_FALSE(found.failure);
      const auto n = static_cast<double>(cells);
      const double size = 1 + exact.virial.cwiseAbs().maxCoeff();
      CHECK(std::abs(found.energy / n - exact.energy) < 1e-11 * size);
      CHECK((found.virial / n - exact.virial).cwiseAbs().maxCoeff() < 1e-11 * size);
      for (Index i = 0; i < s.size(); ++i) {
        CHECK((Vec3<double>(found.a[i]) - Vec3<double>(exact.a[i % 3])).cwiseAbs().maxCoeff() < 1e-11 * size);
      }
    }
  }
}

}  // namespace

TEST_CASE("bonded dimers in a row have the energy of what is not bonded", "[small_box]") {
  for (const Index cells : {1, 2, 3}) {
    ParticleSystem<double> s;
    auto topology = std::make_shared<Topology>();
    for (Index k = 0; k < cells; ++k) {
      s.add("", 1, {0.2 + 3.0 * static_cast<double>(k), 1, 1}, {0, 0, 0});
      s.add("", 1, {1.2 + 3.0 * static_cast<double>(k), 1, 1}, {0, 0, 0});
      topology->exclusions.push_back({2 * k, 2 * k + 1});
    }
    s.set_box(Box::periodic({3.0 * static_cast<double>(cells), 9, 9}));
    s.set_topology(topology);
    const LennardJonesForce force{.cutoff = range, .cutoff_style = Cutoff::plain, .epsilon = 1.0, .sigma = 1.0};
    const double expected = static_cast<double>(cells) * 4 * (0x1p-12 - 0x1p-6);  // at the distance of 2
    CHECK(std::abs(test::evaluated<double>(force, s).energy - expected) < 1e-13);
    CHECK(std::abs(test::evaluated<Quad>(force, s).energy - expected) < 1e-15);
  }
}

TEST_CASE("a cell has the energy, the forces and the virial of one of many, for every scaling", "[small_box]") {
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    check_cells(LennardJonesForce{.cutoff = range, .cutoff_style = Cutoff::plain, .epsilon = 1.0, .sigma = 1.0},
                twelve_six);
    check_cells(PairForce<LennardJonesPair>{{1.0, 1.0}, range, Cutoff::plain}, twelve_six);
    const double k = (78.3 - 1) / (2 * 78.3 + 1);
    check_cells(ReactionFieldForce{{range, 78.3}}, [&](long double r, double product) {
      return product * (1 / r + k * r * r / (range * range * range) - (1 + k) / range);
    });
  }
}

TEST_CASE("in a small box mixed precision leaves out what doubles do", "[small_box]") {
  for (const Special& special : all_special) {
    const auto s = molecules(1, special);
    LennardJonesForce force{.cutoff = range, .cutoff_style = Cutoff::plain, .epsilon = 1.0, .sigma = 1.0};
    const test::Evaluated doubles = test::evaluated<double>(force, s);
    force.precision = PairPrecision::mixed;
    const test::Evaluated mixed = test::evaluated<double>(force, s);
    CHECK(test::largest_difference(mixed.a, doubles.a) < 1e-4 * doubles.a.all().cwiseAbs().maxCoeff());
    CHECK(mixed.energy == doubles.energy);
  }
}

TEST_CASE("secants in a small box have the work of the energy", "[small_box][secant]") {
  for (const Special& special : all_special) {
    const auto from = molecules(1, special);
    ParticleSystem<double> to = from;
    for (Index i = 0; i < 3; ++i) {
      to.shift(i, {0.01 * static_cast<double>(i), 0.02, -0.01 * static_cast<double>(i)}, {0, 0, 0});
    }
    to.moved();
    const PairForce<LennardJonesPair> force{{1.0, 1.0}, range, Cutoff::shifted};
    VectorColumn<double> a(3);
    ForceSink<double> sink(a, to, {});
    force.add_secant_to(sink, from, to);
    double work = 0;
    for (Index i = 0; i < 3; ++i) {
      work += to.masses()[i] * dot(std::as_const(a)[i], Vec3<double>(to.unwrapped(i) - from.unwrapped(i)));
    }
    const double released = test::evaluated<Quad>(force, from).energy - test::evaluated<Quad>(force, to).energy;
    CHECK(std::abs(released) > 1e-4);
    CHECK(std::abs(work - released) < 1e-12 * (1 + std::abs(released)));
  }
}

}  // namespace noether
