/// Jacobians: exact by dual numbers, by differences, in columns found together, and the systems solved with them.

#include "integrators/methods/jacobian.hpp"

#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/oblateness.hpp"
#include "forces/springs.hpp"
#include "forces/sum.hpp"
#include "integrators/force_motion.hpp"
#include "tests/methods/stiff_problems.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/problems.hpp"

using namespace noether;
using namespace noether::test;

namespace {

/// a = -|v| v / 10 + x cos(t): depends on everything a force can depend on.
struct Wind {
  static std::string_view name() { return "wind"; }
  static ForceClaims claims() {
    return {.energy = false, .virial = false, .velocity_dependent = true, .time_dependent = true, .dissipative = true};
  }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    using std::cos, std::sqrt;
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> v = s.velocities()[i];
      const Real drag = -sqrt(norm2(v)) / Real(10), push = cos(s.time());
      out.acceleration(i, Vec3<Real>(drag * v + push * s.positions()[i]));
    }
  }
};

/// The same for doubles only.
struct WindInDouble {
  static std::string_view name() { return "wind_in_double"; }
  static ForceClaims claims() { return Wind::claims(); }
  void add_to(ForceSink<double>& out, const ParticleSystem<double>& s) const { Wind{}.add_to(out, s); }
};

struct HeatInDouble : Heat {
  void rates(const double& t, const Vector<double>& y, Vector<double>& dy) const { Heat::rates(t, y, dy); }
};

/// Largest difference of elements of two Jacobians of one point, relative to the largest element.
template <class A, class B> double jacobians_apart(A& a, B& b, double t, const Vector<double>& y) {
  Jacobian<double> first, second;
  first.bind(a);
  second.bind(b);
  first.evaluate(a, t, y);
  second.evaluate(b, t, y);
  double worst = 0, size = 0;
  for (Index j = 0; j < y.size(); ++j) {
    for (Index i = 0; i < y.size(); ++i) {
      worst = std::max(worst, std::abs(first(i, j) - second(i, j)));
      size = std::max(size, std::abs(first(i, j)));
    }
  }
  return worst / size;
}

template <class F> std::unique_ptr<VectorField<double>> motion(F forces, const ParticleSystem<double>& s) {
  auto field = std::make_unique<ForceMotion<F, double>>(std::move(forces));
  field->bind(s);
  return field;
}

Vector<double> gathered(const VectorField<double>& field, const ParticleSystem<double>& s) {
  Vector<double> y;
  field.gather(s, y);
  return y;
}

}  // namespace

TEST_CASE("a Jacobian by dual numbers is that by differences") {
  const auto s = four_bodies();
  SECTION("of a system of first order") {
    const Vector<double> y = Smooth::solution<double>(0.7);
    const auto exact = field_of(Smooth{}, y), found = field_of(SmoothInDouble{}, y);
    CHECK(exact->has_derivative());
    CHECK_FALSE(found->has_derivative());
    CHECK(jacobians_apart(*exact, *found, 0.7, y) < 1e-9);
  }
  SECTION("of particles under a force that depends on everything") {
    const auto exact = motion(Wind{}, s), found = motion(WindInDouble{}, s);
    CHECK(exact->has_derivative());
    CHECK_FALSE(found->has_derivative());
    CHECK(jacobians_apart(*exact, *found, 0.7, gathered(*exact, s)) < 1e-9);
  }
  SECTION("of gravity and an oblate planet, written down and erased") {
    const Oblateness j2{.J2 = 0.01, .radius = 0.2};
    ForceField<double> erased;
    erased.add(Gravity{.G = 1}).add(j2);
    const auto exact = motion(Sum(Gravity{.G = 1}, j2), s), same = motion(erased, s);
    CHECK(jacobians_apart(*exact, *same, 0, gathered(*exact, s)) == 0);
    erased.add(WindInDouble{});
    const auto found = motion(erased, s), all = motion(Sum(Gravity{.G = 1}, j2, Wind{}), s);
    CHECK_FALSE(found->has_derivative());
    CHECK(jacobians_apart(*all, *found, 0, gathered(*exact, s)) < 1e-9);
  }
}

TEST_CASE("a derivative in time is the slope of the rates in time") {
  const auto s = four_bodies();
  const auto exact = motion(Wind{}, s), found = motion(WindInDouble{}, s);
  const Vector<double> y = gathered(*exact, s);
  Jacobian<double> first, second;
  first.bind(*exact);
  second.bind(*found);
  Vector<double> slope, differences;
  first.time_derivative(*exact, 0.7, y, 0.1, slope);
  second.time_derivative(*found, 0.7, y, 0.1, differences);
  CHECK(apart(slope, differences) < 1e-9);
  CHECK(slope[12] == -std::sin(0.7) * y[0]);
}

TEST_CASE("columns that share no row are found together") {
  for (const Index n : {5, 50}) {
    const HeatInDouble heat{{.n = n}};
    const Vector<double> y = heat.start();
    const auto field = field_of(heat, y);
    Jacobian<double> jacobian;
    jacobian.bind(*field);
    jacobian.evaluate(*field, 0, y);
    CHECK(jacobian.form() == JacobianForm::sparse);
    CHECK(field->evaluations().force == 6);  // three groups of a tridiagonal matrix, up and down
    CHECK(field->evaluations().jacobian == 1);
    const auto exact = field_of(Heat{.n = n}, y);
    CHECK(jacobians_apart(*exact, *field, 0, y) < 1e-9);
  }
}

TEST_CASE("the sparse Jacobian of forces whose secants have derivatives is the dense one, and solves the same",
          "[jacobian]") {
  const auto s = four_bodies();
  const HarmonicBond springs{.k = 3, .length = 0.7, .tied = {{0, 1}, {1, 2}, {0, 3}}};
  const Sum forces(springs, UniformField{{0, 0, -1}}, Tether{.k = 2, .length = 0.3, .tied = {{3}}});
  const auto field = motion(forces, s);
  const Vector<double> y = gathered(*field, s);
  Jacobian<double> dense, sparse;
  dense.bind(*field);
  sparse.bind(*field, {.form = JacobianForm::sparse});
  CHECK(dense.form() == JacobianForm::dense);
  dense.evaluate(*field, 0, y);
  sparse.evaluate(*field, 0, y);
  CHECK(sparse.elements().nonZeros() < 12 * 12);
  for (Index j = 0; j < y.size(); ++j) {
    for (Index i = 0; i < y.size(); ++i) CHECK(std::abs(sparse(i, j) - dense(i, j)) < 1e-9);
  }
  REQUIRE(dense.factorize(1, 0.3));
  REQUIRE(sparse.factorize(1, 0.3));
  Vector<double> x = y, other = y;
  REQUIRE(dense.solve(*field, x));
  REQUIRE(sparse.solve(*field, other));
  CHECK(apart(x, other) < 1e-10);
  // Read back, and in a copy, its factors are made again, the same ones.
  SavedState saved;
  sparse.save(saved, "j/");
  Jacobian<double> read, copy = sparse;
  read.bind(*field, {.form = JacobianForm::sparse});
  read.load(saved, "j/");
  Vector<double> once_more = y, of_copy = y;
  REQUIRE(read.solve(*field, once_more));
  REQUIRE(copy.solve(*field, of_copy));
  CHECK(once_more == other);
  CHECK(of_copy == other);
}

TEST_CASE("a sparse Jacobian of forces without derivatives of secants is refused by their names", "[jacobian]") {
  const auto s = four_bodies();
  const auto field = motion(Sum(Gravity{.G = 1}, Oblateness{.J2 = 0.01, .radius = 0.2}), s);
  Jacobian<double> jacobian;
  CHECK_THROWS_WITH(jacobian.bind(*field, {.form = JacobianForm::sparse}),
                    "a sparse Jacobian needs derivatives of the secants of every force, but 'oblateness' has none; use "
                    "jacobian = \"matrix_free\" or \"dense\"");
}

TEST_CASE("a dense Jacobian and a sparse one are the same and solve the same") {
  const Heat sparse{.n = 40}, dense{.n = 40, .tell_sparsity = false};
  const Vector<double> y = sparse.start();
  const auto a = field_of(sparse, y), b = field_of(dense, y);
  CHECK(jacobians_apart(*a, *b, 0, y) == 0);
  Jacobian<double> first, second;
  first.bind(*a);
  second.bind(*b);
  CHECK(first.form() == JacobianForm::sparse);
  CHECK(second.form() == JacobianForm::dense);
  first.evaluate(*a, 0, y);
  second.evaluate(*b, 0, y);
  REQUIRE(first.factorize(1, 0.01));
  REQUIRE(second.factorize(1, 0.01));
  Vector<double> u = y, w = y;
  first.solve(*a, u);
  second.solve(*b, w);
  CHECK(apart(u, w) < 1e-15);
  // The modes of the start are eigenvectors, so one of them is solved in closed form.
  const double pi = std::acos(-1.0), mode = 41.0 * 41.0 * 2 * (std::cos(pi / 41) - 1);
  Vector<double> sine(40);
  for (Index i = 0; i < 40; ++i) sine[i] = std::sin(pi * static_cast<double>(i + 1) / 41);
  w = sine;
  first.solve(*a, w);
  for (Index i = 0; i < 40; ++i) CHECK(std::abs(w[i] - sine[i] / (1 - 0.01 * mode)) < 1e-14);
}

TEST_CASE("particles are solved by systems of half the size") {
  const auto s = four_bodies();
  const auto field = motion(Sum(Gravity{.G = 1}, Wind{}), s);
  const Vector<double> y = gathered(*field, s);
  Jacobian<double> jacobian;
  jacobian.bind(*field);
  jacobian.evaluate(*field, 0.3, y);
  REQUIRE(jacobian.factorize(3, 0.2));
  Vector<double> x = y;
  jacobian.solve(*field, x);
  for (Index i = 0; i < y.size(); ++i) {
    double residual = 3 * x[i] - y[i];
    for (Index j = 0; j < y.size(); ++j) residual -= 0.2 * jacobian(i, j) * x[j];
    CHECK(std::abs(residual) < 1e-14);
  }
}

TEST_CASE("a copy of a Jacobian solves with factors of its own, to the same bits") {
  const Heat heat{.n = 30};
  const Vector<double> y = heat.start();
  const auto field = field_of(heat, y);
  Jacobian<double> jacobian;
  jacobian.bind(*field);
  jacobian.evaluate(*field, 0, y);
  REQUIRE(jacobian.factorize(1, 0.02));
  Jacobian<double> copy = jacobian, loaded;
  SavedState saved;
  jacobian.save(saved, "");
  loaded.bind(*field);
  loaded.load(saved, "");
  Vector<double> a = y, b = y, c = y;
  jacobian.solve(*field, a);
  copy.solve(*field, b);
  loaded.solve(*field, c);
  CHECK(a == b);
  CHECK(a == c);
}

TEST_CASE("a matrix without inverse is told") {
  const Vector<double> y = Vector<double>::Ones(1);
  const auto field = field_of(Linear{.lambda = 1}, y);
  Jacobian<double> jacobian;
  jacobian.bind(*field);
  jacobian.evaluate(*field, 0, y);
  CHECK_FALSE(jacobian.factorize(1, 1));
  CHECK(jacobian.factorize(1, 0.5));
}
