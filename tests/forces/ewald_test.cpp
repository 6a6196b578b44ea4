/// Ewald's sum: Madelung's and Wigner's constants, water of NIST, what is asked of its error, bits.

#include "forces/ewald.hpp"
#include "forces/check_gradient.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/charged_liquid.hpp"
#include "tests/support/pair_forces.hpp"
#include "tests/support/refusal.hpp"

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

namespace noether {
namespace {

test::Evaluated narrow(const Ewald& force, const ParticleSystem<double>& s) {
  return test::evaluated<double>(AnyForce<double>(force), s);
}
test::Evaluated wide(const Ewald& force, const ParticleSystem<double>& s) {
  return test::evaluated<Quad>(*AnyForce<double>(force).in_quad(), s);
}

struct Ion {
  Vec3<double> x;
  double q;
};
/// Ions at places of a cubic cell of edge 1, enlarged. @param cells  along each axis
ParticleSystem<double> crystal(const std::vector<Ion>& cell, double edge, int cells) {
  ParticleSystem<double> s(unit_system("reduced"));
  s.set_box(Box::periodic(Vec3<double>::Constant(cells * edge)));
  std::vector<double> charges;
  for (int k = 0; k < cells * cells * cells; ++k) {
    for (const Ion& ion : cell) {
      s.add("", 1, edge * (Vec3<double>(k % cells, k / cells % cells, k / cells / cells) + ion.x), {0, 0, 0});
      charges.push_back(ion.q);
    }
  }
  auto& q = s.add_column<Charge>();
  for (Index i = 0; i < s.size(); ++i) q[i] = charges[static_cast<std::size_t>(i)];
  return s;
}
std::vector<Ion> face_centred(const Vec3<double>& other) {
  std::vector<Ion> cell;
  for (const Vec3<double>& at :
       {Vec3<double>(0, 0, 0), Vec3<double>(0.5, 0.5, 0), Vec3<double>(0.5, 0, 0.5), Vec3<double>(0, 0.5, 0.5)}) {
    cell.push_back({at, 1});
    Vec3<double> x = at + other;
    for (int k = 0; k < 3; ++k) x[k] -= std::floor(x[k]);
    cell.push_back({x, -1});
  }
  return cell;
}

double relative(double value, double expected) { return std::abs(value / expected - 1); }

}  // namespace

TEST_CASE("erfc of doubles is that of 113 bits", "[ewald]") {
  for (int k = 0; k <= 7000; ++k) {
    const double x = k * 1e-3;
    const double exact = static_cast<double>(erfc(Quad(x)));
    const double bell = 2 * x * x * 0x1p-53;  // of the rounding of x^2
    REQUIRE(std::abs(detail::erfc_terms(x).erfc / exact - 1) <= 1.5e-15 + bell);
  }
  CHECK(detail::erfc_terms(30.0).erfc < 1e-280);
  for (const double r : {0.0, 1e-9, 1e-3, 0.1, 0.4, 0.5, 0.6, 1.0, 5.0}) {
    const PairTerms<double> one = detail::smooth_terms<double>(1.4, r * r);
    const PairTerms<Quad> exact = detail::smooth_terms<Quad>(1.4, Quad(r) * Quad(r));
    CHECK(std::abs(one.energy / static_cast<double>(exact.energy) - 1) <= 2e-15);
    CHECK(std::abs(one.force / static_cast<double>(exact.force) - 1) <= 1e-14);
  }
}

TEST_CASE("crystals have Madelung's constants", "[ewald]") {
  // Constants by nearest distance, as Borwein, Glasser, McPhedran, Wan and Zucker's "Lattice Sums" has them.
  struct Lattice {
    std::vector<Ion> cell;
    double nearest, constant;
  };
  const std::vector<Lattice> lattices = {{face_centred({0.5, 0, 0}), 0.5, 1.7475645946331822},
                                         {{{{0, 0, 0}, 1}, {{0.5, 0.5, 0.5}, -1}}, std::sqrt(0.75), 1.7626747730709884},
                                         {face_centred({0.25, 0.25, 0.25}), std::sqrt(3.0) / 4, 1.6380550533887894}};
  for (const Lattice& one : lattices) {
    for (const double cutoff : {1.5, 2.6}) {
      const ParticleSystem<double> s = crystal(one.cell, 2, 1);
      const double per_ion = -s.units().coulomb_constant * one.constant / (2 * one.nearest) / 2;
      const Ewald force{.cutoff = cutoff, .relative_error = 1e-14};
      for (const test::Evaluated& all : {narrow(force, s), wide(force, s)}) {
        CHECK(relative(all.energy, per_ion * static_cast<double>(s.size())) < 1e-10);
        CHECK(relative(all.virial.trace(), all.energy) < 1e-10);
        CHECK(all.a.all().cwiseAbs().maxCoeff() < 1e-10);
      }
    }
  }
}

TEST_CASE("one charge among its images and a background has Wigner's constant", "[ewald]") {
  ParticleSystem<double> s(unit_system("reduced"));
  s.set_box(Box::periodic({3, 3, 3}));
  s.add("one", 1, {0.3, 1.2, 2.9}, {0, 0, 0});
  s.add_column<Charge>()[0] = 1.5;
  const double expected = -s.units().coulomb_constant * 1.5 * 1.5 * 2.8372974794806196 / (2 * 3.0);
  for (const double alpha : {1.0, 2.0}) {
    const Ewald force{.cutoff = 6 / alpha, .relative_error = 1e-14, .alpha = alpha};
    const test::Evaluated one = narrow(force, s);
    CHECK(relative(one.energy, expected) < 1e-11);
    CHECK(relative(one.virial.trace(), expected) < 1e-11);
    CHECK(one.a.all().cwiseAbs().maxCoeff() < 1e-12);
  }
}

TEST_CASE("a hundred waters have the energies that NIST lists", "[ewald]") {
  // SPC/E water of NIST's reference calculations, configuration 1, in kJ/mol with the factor of Coulomb's law below.
  std::ifstream file(std::string(NOETHER_SOURCE_DIR) + "/../shared/cases/molecules/nist_spce_1.gro");
  if (!file) {
    WARN("skipped: the file of NIST's configuration is not there");
    return;
  }
  ParticleSystem<double> s(unit_system("molecular"));
  s.set_box(Box::periodic({2, 2, 2}));
  std::string line;
  std::getline(file, line);
  std::getline(file, line);
  const Index n = std::stol(line);
  REQUIRE(n == 300);
  std::vector<double> charges;
  for (Index i = 0; i < n; ++i) {
    std::string molecule, name, number;
    Vec3<double> x;
    std::getline(file, line);
    std::istringstream(line) >> molecule >> name >> number >> x[0] >> x[1] >> x[2];
    for (int k = 0; k < 3; ++k) x[k] -= 2 * std::floor(x[k] / 2);
    s.add("", name[0] == 'O' ? 15.9994 : 1.008, x, {0, 0, 0});
    charges.push_back(name[0] == 'O' ? -0.8476 : 0.4238);
  }
  auto& q = s.add_column<Charge>();
  for (Index i = 0; i < n; ++i) q[i] = charges[static_cast<std::size_t>(i)];
  auto topology = std::make_shared<Topology>();
  for (Index i = 0; i < n; i += 3) {
    for (const Topology::Pair& pair :
         {Topology::Pair{i, i + 1}, Topology::Pair{i, i + 2}, Topology::Pair{i + 1, i + 2}})
      topology->exclusions.push_back(pair);
  }
  s.set_topology(topology);
  const double ours = s.units().coulomb_constant / 138.93545764498225;
  const double kmax = 3.14159265358979 * std::sqrt(26.5);  // n^2 < 27
  const Ewald all{.cutoff = 1, .alpha = 2.8, .kmax = kmax}, near{.cutoff = 1, .alpha = 2.8, .kmax = 0},
      remainder_only{.cutoff = 1e-3, .alpha = 2.8, .kmax = 0};
  const double real = -4646.860760109, fourier = 52.132457342, self_and_excluded = -23652.080370607 + 23363.573741967;
  const double exact[] = {wide(all, s).energy / ours, wide(near, s).energy / ours,
                          wide(remainder_only, s).energy / ours};
  CHECK(std::abs(exact[2] - self_and_excluded) < 3e-9);
  CHECK(std::abs(exact[1] - exact[2] - real) < 3e-9);
  CHECK(std::abs(exact[0] - exact[1] - fourier) < 3e-9);
  CHECK(std::abs(narrow(all, s).energy / ours - exact[0]) < 1e-7);  // grains of sums over 50 000 pairs
}

TEST_CASE("lanes give what 113 bits give, with pairs left out, a net charge, and the box small", "[ewald]") {
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    for (const auto& s : {test::charged_liquid(2), test::with_special_pairs(test::charged_liquid(2, 0.75)),
                          test::with_special_pairs(test::charged_liquid(1))}) {
      CAPTURE(name(level), s.size());
      const Ewald force{.cutoff = 1.9, .alpha = 1.3, .kmax = 7};
      const test::Evaluated lanes = narrow(force, s), exact = wide(force, s);
      REQUIRE_FALSE(lanes.failure);
      CHECK(test::largest_difference(lanes.a, exact.a) < 2e-12 * exact.a.all().cwiseAbs().maxCoeff());
      const double scale = static_cast<double>(s.size()) * s.units().coulomb_constant;
      CHECK(std::abs(lanes.energy - exact.energy) < 1e-12 * scale);
      CHECK((lanes.virial - exact.virial).cwiseAbs().maxCoeff() < 1e-11 * scale);
    }
  }
}

TEST_CASE("forces are slopes of the energy, the virial its change with the box, and alpha changes nothing", "[ewald]") {
  CHECK(gradient_error(Ewald{.cutoff = 1.2, .alpha = 1.5, .kmax = 6},
                       test::with_special_pairs(test::charged_liquid(1, 0.5))) < 1e-15);
  const ParticleSystem<double> s = test::with_special_pairs(test::charged_liquid(2, 0.5));
  const Ewald force{.cutoff = 2.4, .relative_error = 1e-13};
  const test::Evaluated all = narrow(force, s);
  CHECK(relative(all.virial.trace(), all.energy) < 1e-10);  // of degree -1
  const test::Evaluated other = narrow({.cutoff = 3.1, .relative_error = 1e-13}, s);
  CHECK(relative(other.energy, all.energy) < 1e-11);
  CHECK(test::largest_difference(other.a, all.a) < 1e-10);
  for (int axis = 0; axis < 3; ++axis) {
    const auto stretched = [&](double by) { return narrow(force, test::stretched(s, axis, by)).energy; };
    const double h = 1e-4, slope = (stretched(1 + h) - stretched(1 - h)) / (2 * h);
    CHECK(std::abs(all.virial(axis, axis) + slope) < 1e-6 * std::abs(all.energy));
  }
}

TEST_CASE("the error that is asked of Ewald's sum is the error that it has", "[ewald]") {
  const ParticleSystem<double> s = test::charged_liquid(3);
  const test::Evaluated exact = narrow({.cutoff = 2.5, .relative_error = 1e-13}, s);
  const double scale = s.units().coulomb_constant * std::pow(0.8, 2.0 / 3);  // C <q^2> (n/V)^(2/3)
  for (const double cutoff : {1.5, 2.2}) {
    for (const double error : {1e-2, 1e-4, 1e-6, 1e-8}) {
      const test::Evaluated one = narrow({.cutoff = cutoff, .relative_error = error}, s);
      const double reached =
          std::sqrt((one.a.all() - exact.a.all()).squaredNorm() / static_cast<double>(s.size())) / scale;
      CAPTURE(cutoff, error, reached);
      CHECK(reached < 2 * error);
      CHECK(reached > error / 2);
    }
  }
}

TEST_CASE("bits of Ewald's sum depend on no list, no thread, and on no order of particles", "[ewald][determinism]") {
  ParticleSystem<double> s = test::with_special_pairs(test::charged_liquid(5, 0.25));
  const Ewald force{.cutoff = 1.6, .relative_error = 1e-2};
  test::check_bits_of_lists(AnyForce<double>(force), s, 1.6);
  const ParticleSystem<double> back = test::backwards(s);
  const test::Evaluated one = narrow(force, s), other = narrow(force, back);
  CHECK(one.energy == other.energy);
  CHECK(one.virial == other.virial);
  for (Index i = 0; i < s.size(); ++i) {
    for (int k = 0; k < 3; ++k) REQUIRE(one.a.component(k)[i] == other.a.component(k)[s.size() - 1 - i]);
  }
}

TEST_CASE("without charges Ewald's sum is nothing, and what makes no sense is refused by name", "[ewald][messages]") {
  ParticleSystem<double> s = test::charged_liquid(1);
  for (Index i = 0; i < s.size(); ++i) s.column<Charge>()[i] = 0;
  const test::Evaluated nothing = narrow({.cutoff = 1.5}, s);
  CHECK(nothing.energy == 0);
  CHECK(nothing.a.all().cwiseAbs().maxCoeff() == 0);
  const auto refusal = [](const Ewald& force, const ParticleSystem<double>& particles) {
    return test::refusal_of([&] { AnyForce<double>(force).check(particles); });
  };
  CHECK(refusal({.cutoff = 1.5}, s).empty());
  CHECK(refusal({.cutoff = 0}, s) == "cutoff = 0 is not a valid cutoff; a length above 0 is expected");
  CHECK(refusal({.cutoff = 1.5, .relative_error = 0}, s) ==
        "relative_error = 0 is not a valid error of forces; 1e-15 to 0.1 is expected");
  CHECK(refusal({.cutoff = 1.5, .alpha = -1.0}, s) ==
        "alpha = -1 is not a valid inverse width; a number above 0 is expected");
  CHECK(refusal({.cutoff = 1.5, .kmax = -1.0}, s) == "kmax = -1 is not a valid wave number; 0 or more is expected");
  CHECK(refusal({.cutoff = 1e-3}, test::charged_liquid(2)).starts_with("the force 'ewald' would sum "));
  ParticleSystem<double> open(unit_system("reduced"));
  open.add("one", 1, {0, 0, 0}, {0, 0, 0});
  CHECK(refusal({.cutoff = 1.5}, open) ==
        "the force 'ewald' sums over the images of a periodic box, but this space is open; give a box");
  open.set_box(Box::periodic({3, 3, 3}));
  CHECK(refusal({.cutoff = 1.5}, open) ==
        "force 'ewald' acts between charges, but the particles have none; give charges, or take the force out");
}

}  // namespace noether
