/// Smooth particle mesh Ewald against Ewald's sum, against its own energy, and against what is asked of its error.

#include "forces/particle_mesh_ewald.hpp"
#include "forces/charge_mesh.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/charged_liquid.hpp"
#include "tests/support/pair_forces.hpp"
#include "tests/support/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

namespace noether {
namespace {

test::Evaluated by_mesh(const ParticleMeshEwald& force, const ParticleSystem<double>& s) {
  return test::evaluated<double>(AnyForce<double>(force), s);
}
test::Evaluated by_waves(const Ewald& force, const ParticleSystem<double>& s) {
  return test::evaluated<double>(AnyForce<double>(force), s);
}
double rms(const VectorColumn<double>& a, const VectorColumn<double>& b) {
  return std::sqrt((a.all() - b.all()).squaredNorm() / static_cast<double>(a.size()));
}

}  // namespace

TEST_CASE("splines of every order add up to 1, have their slopes, and their middle where it belongs", "[mesh]") {
  for (int order = detail::least_order; order <= detail::largest_order; ++order) {
    for (const double w : {0.0, 0.1, 0.5, 0.9375, 1.0}) {
      CAPTURE(order, w);
      const detail::SplineWeights here(w, order);
      double sum = 0, slopes = 0, middle = 0;
      for (int j = 0; j < order; ++j) {
        const auto k = static_cast<std::size_t>(j);
        sum += here.value[k];
        slopes += here.slope[k];
        middle += j * here.value[k];
        CHECK(here.value[k] >= 0);
      }
      CHECK(std::abs(sum - 1) <= 1e-15);
      CHECK(std::abs(slopes) <= 1e-15);
      CHECK(std::abs(middle - (order / 2.0 - 1 + w)) <= 4e-15);  // the mean of a B-spline
      if (w > 0.05 && w < 0.95) {
        const double h = 1e-6;
        const detail::SplineWeights up(w + h, order), down(w - h, order);
        for (std::size_t k = 0; k < static_cast<std::size_t>(order); ++k)
          CHECK(std::abs((up.value[k] - down.value[k]) / (2 * h) - here.slope[k]) < 1e-9);
      }
    }
  }
  for (const auto& [asked, quick] : {std::pair<int, int>{1, 1}, {11, 12}, {13, 14}, {61, 63}, {97, 98}, {101, 105}})
    CHECK(detail::quick_size(asked) == quick);
}

TEST_CASE("a fine mesh gives Ewald's sum: forces, energy, virial, with pairs left out and a net charge", "[mesh]") {
  for (const auto& s : {test::charged_liquid(3), test::with_special_pairs(test::charged_liquid(2, 0.75)),
                        test::with_special_pairs(test::charged_liquid(1))}) {
    CAPTURE(s.size());
    const test::Evaluated mesh = by_mesh({.cutoff = 2.4, .relative_error = 1e-10, .order = 8}, s);
    const test::Evaluated waves = by_waves({.cutoff = 2.4, .relative_error = 1e-13}, s);
    const double scale = s.units().coulomb_constant * static_cast<double>(s.size());
    CHECK(rms(mesh.a, waves.a) < 1e-9);
    CHECK(std::abs(mesh.energy - waves.energy) < 1e-10 * scale);
    CHECK((mesh.virial - waves.virial).cwiseAbs().maxCoeff() < 1e-9 * scale);
  }
}

TEST_CASE("the error that is asked of the mesh is the error that it has, at every order", "[mesh]") {
  const ParticleSystem<double> s = test::charged_liquid(3);
  const test::Evaluated exact = by_waves({.cutoff = 2.5, .relative_error = 1e-13}, s);
  const double scale = s.units().coulomb_constant * std::pow(0.8, 2.0 / 3);  // C <q^2> (n/V)^(2/3)
  for (const auto& [cutoff, order, error] : {std::tuple<double, int, double>{1.5, 4, 1e-2},
                                             {2.0, 4, 1e-3},
                                             {2.2, 5, 1e-4},
                                             {1.5, 6, 1e-4},
                                             {2.2, 6, 1e-5},
                                             {2.2, 7, 1e-6},
                                             {1.8, 8, 1e-6},
                                             {2.5, 8, 1e-8}}) {
    const double reached =
        rms(by_mesh({.cutoff = cutoff, .relative_error = error, .order = order}, s).a, exact.a) / scale;
    CAPTURE(cutoff, order, error, reached);
    CHECK(reached < 2 * error);
    CHECK(reached > error / 2);
  }
}

TEST_CASE("forces of the mesh are slopes of its energy, and its virial is the change with the box", "[mesh]") {
  const ParticleSystem<double> s = test::with_special_pairs(test::charged_liquid(2, 0.5));
  const double edge = s.box().edges()[0];
  for (const std::int64_t order : {4, 5, 6, 7, 8}) {
    CAPTURE(order);
    // So coarse that it is far from Ewald's sum; 14 points along each axis however the box is stretched.
    const ParticleMeshEwald force{.cutoff = 1.4, .order = order, .alpha = 2.4, .mesh_spacing = edge / 13.5};
    const test::Evaluated all = by_mesh(force, s);
    const double h = 1e-5;
    for (const Index i : {0, 7}) {
      for (int k = 0; k < 3; ++k) {
        const auto moved = [&](double by) {
          ParticleSystem<double> other = s;
          Vec3<double> x = s.positions()[i];
          x[k] += by;
          other.positions().set(i, x);
          other.moved();
          return by_mesh(force, other).energy;
        };
        CHECK(std::abs(all.a.component(k)[i] + (moved(h) - moved(-h)) / (2 * h)) < 1e-6);
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double up = by_mesh(force, test::stretched(s, axis, 1 + h)).energy;
      const double down = by_mesh(force, test::stretched(s, axis, 1 - h)).energy;
      CHECK(std::abs(all.virial(axis, axis) + (up - down) / (2 * h)) < 1e-5 * std::abs(all.energy));
    }
  }
}

TEST_CASE("bits of the mesh depend on no list, no thread, and on no order of particles", "[mesh][determinism]") {
  ParticleSystem<double> s = test::with_special_pairs(test::charged_liquid(5, 0.25));
  const ParticleMeshEwald force{.cutoff = 1.4, .relative_error = 1e-3};
  test::check_bits_of_lists(AnyForce<double>(force), s, 1.4);
  const ParticleSystem<double> back = test::backwards(s);
  const test::Evaluated one = by_mesh(force, s), other = by_mesh(force, back);
  CHECK(one.energy == other.energy);
  CHECK(one.virial == other.virial);
  for (Index i = 0; i < s.size(); ++i) {
    for (int k = 0; k < 3; ++k) REQUIRE(one.a.component(k)[i] == other.a.component(k)[s.size() - 1 - i]);
  }
}

TEST_CASE("charges on points and faces of the mesh, two of them, one, and none", "[mesh]") {
  ParticleSystem<double> s(unit_system("reduced"));
  s.set_box(Box::periodic({3, 3, 3}));
  s.add("one", 1, {0, 1.5, std::nextafter(3.0, 0.0)}, {0, 0, 0});
  s.add_column<Charge>()[0] = 1.5;
  const ParticleMeshEwald force{.cutoff = 2.5, .relative_error = 1e-9, .order = 8};
  const double expected = -s.units().coulomb_constant * 1.5 * 1.5 * 2.8372974794806196 / (2 * 3.0);  // Wigner's
  CHECK(std::abs(by_mesh(force, s).energy / expected - 1) < 1e-8);
  s.add("two", 1, {0.25, 1.5, 0}, {0, 0, 0});
  s.column<Charge>()[1] = -1.5;
  const test::Evaluated mesh = by_mesh(force, s), waves = by_waves({.cutoff = 2.5, .relative_error = 1e-13}, s);
  CHECK(std::abs(mesh.energy - waves.energy) < 1e-8);
  CHECK(test::largest_difference(mesh.a, waves.a) < 1e-7);
  for (Index i = 0; i < 2; ++i) s.column<Charge>()[i] = 0;
  CHECK(by_mesh(force, s).energy == 0);
}

TEST_CASE("boxes of one to a thousand cutoffs: Ewald's sum, or one line that names the memory", "[mesh]") {
  for (const double edge : {1.0, 2.5, 10.0}) {
    CAPTURE(edge);
    ParticleSystem<double> s(unit_system("reduced"));
    s.set_box(Box::periodic({edge, edge, edge}));
    s.add("", 1, {0.2, 0.1, 0.3}, {0, 0, 0});
    s.add("", 1, {0.5, 0.9, 0.7}, {0, 0, 0});
    s.add_column<Charge>()[0] = 1;
    s.column<Charge>()[1] = -1;
    const test::Evaluated mesh = by_mesh({.cutoff = 1, .relative_error = 1e-4}, s);
    const test::Evaluated waves = by_waves({.cutoff = 1, .relative_error = 1e-10}, s);
    // The error that is asked is that of charges in no order; two near each other have the larger one of their force.
    CHECK(test::largest_difference(mesh.a, waves.a) < 3e-4 * std::max(waves.a[0].norm(), std::pow(edge, -2)));
    CHECK(std::abs(mesh.energy - waves.energy) < 1e-3 * std::abs(waves.energy));
  }
  ParticleSystem<double> s(unit_system("reduced"));
  s.set_box(Box::periodic({1000, 1000, 1000}));
  s.add("", 1, {0, 0, 0}, {0, 0, 0});
  s.add_column<Charge>()[0] = 1;
  const std::string refusal = test::refusal_of([&] { AnyForce<double>(ParticleMeshEwald{.cutoff = 1}).check(s); });
  CHECK(refusal.starts_with("the force 'particle_mesh_ewald' would have a mesh of "));
  CHECK(refusal.ends_with(" GB of memory; take a longer cutoff or a larger relative_error"));
}

TEST_CASE("charges of 1e-6 to 1e3 side by side have the error that is asked, of the force between typical ones",
          "[mesh]") {
  ParticleSystem<double> s = test::charged_liquid(3);
  auto& q = s.column<Charge>();
  double squares = 0;
  for (Index i = 0; i < s.size(); ++i) q[i] *= std::pow(10.0, static_cast<double>(i * 7 % 19) / 2 - 6);
  for (Index i = 0; i < s.size(); ++i) squares += q[i] * q[i];
  const double n = static_cast<double>(s.size()), typical = squares / n * std::pow(0.8, 2.0 / 3);
  const test::Evaluated exact = by_waves({.cutoff = 2.2, .relative_error = 1e-12}, s);
  for (const PairPrecision precision : {PairPrecision::full, PairPrecision::mixed}) {
    const test::Evaluated mesh = by_mesh({.cutoff = 2.2, .relative_error = 1e-4, .precision = precision}, s);
    const double reached = rms(mesh.a, exact.a) / typical;
    CAPTURE(reached);
    CHECK(reached < 2e-4);
    CHECK(reached > 5e-6);
  }
}

TEST_CASE("of the orders that have the error, the mesh takes one that costs less than others", "[mesh]") {
  const ParticleSystem<double> s = test::charged_liquid(4);
  std::vector<int> orders;
  for (const double error : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10}) {
    CAPTURE(error);
    const ChosenMesh chosen = *ParticleMeshEwald{.cutoff = 2.4, .relative_error = error}.chosen_for(s);
    const auto work = [&](const ChosenMesh& mesh) {
      const double points = static_cast<double>(mesh.points[0] * mesh.points[1] * mesh.points[2]);
      return detail::mesh_work(static_cast<double>(s.size()), points, mesh.order);
    };
    CHECK(chosen.error <= 1.02 * error / std::sqrt(2.0));  // the spacing is interpolated
    for (const std::int64_t order : {4, 5, 6, 7, 8}) {
      const ChosenMesh other = *ParticleMeshEwald{.cutoff = 2.4, .relative_error = error, .order = order}.chosen_for(s);
      CHECK(other.order == order);
      CHECK(work(chosen) <= work(other));
    }
    orders.push_back(chosen.order);
  }
  CHECK(std::is_sorted(orders.begin(), orders.end()));
  CHECK(orders.front() < orders.back());
  // A spacing that is given takes the lowest order that is good enough, and the highest where none is.
  CHECK(ParticleMeshEwald{.cutoff = 2.4, .relative_error = 1e-2, .mesh_spacing = 0.4}.chosen_for(s)->order == 4);
  CHECK(ParticleMeshEwald{.cutoff = 2.4, .relative_error = 1e-9, .mesh_spacing = 0.4}.chosen_for(s)->order == 8);
}

TEST_CASE("a mesh that makes no sense is refused by name, and its truth is Ewald's sum", "[mesh][messages]") {
  const ParticleSystem<double> s = test::charged_liquid(2);
  const auto refusal = [&](const ParticleMeshEwald& force) {
    return test::refusal_of([&] { AnyForce<double>(force).check(s); });
  };
  CHECK(refusal({.cutoff = 1.5}).empty());
  CHECK(refusal({.cutoff = 1.5, .order = 3}) == "order = 3 is not a valid order of splines; 4 to 8 is expected");
  CHECK(refusal({.cutoff = 1.5, .order = 9}) == "order = 9 is not a valid order of splines; 4 to 8 is expected");
  CHECK(refusal({.cutoff = 1.5, .mesh_spacing = 0.0}) ==
        "mesh_spacing = 0 is not a valid length; a length above 0 is expected");
  CHECK(
      refusal({.cutoff = 1.5, .mesh_spacing = 1e-4}).starts_with("the force 'particle_mesh_ewald' would have a mesh"));
  CHECK(refusal({.cutoff = -1}) == "cutoff = -1 is not a valid cutoff; a length above 0 is expected");
  CHECK(refusal({.cutoff = 1.5, .relative_error = 1e-4, .precision = PairPrecision::mixed}).empty());
  CHECK(refusal({.cutoff = 1.5, .relative_error = 1e-9, .precision = PairPrecision::mixed})
            .starts_with("relative_error = 1e-09 is finer than forces in mixed precision are; "));
  const auto wide = AnyForce<double>(ParticleMeshEwald{.cutoff = 1.5}).in_quad();
  REQUIRE(wide);
  CHECK(wide->name() == "ewald");
}

}  // namespace noether
