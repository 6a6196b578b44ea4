/// Implicit methods whose linear systems are solved with products J v only: no matrix is formed.

#include "integrators/force_motion.hpp"
#include "integrators/methods/jacobian.hpp"
#include "tests/methods/restarts.hpp"
#include "tests/methods/stiff_problems.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/planets.hpp"

#include <limits>

using namespace noether;
using namespace noether::test;

namespace {

constexpr auto dense = JacobianForm::dense, sparse = JacobianForm::sparse, matrix_free = JacobianForm::matrix_free;

/// A method that keeps its Jacobian in a form.
MethodChoice in_form(MethodChoice choice, JacobianForm form) {
  choice.options.jacobian = form;
  return choice;
}

/// Stiff springs of length 1 from particle to particle, more particles than one cycle of GMRES has directions, and a
/// drag, so that forces depend on velocities.
struct Chain {
  double k = 1e5, drag = 0;
  static std::string_view name() { return "chain"; }
  ForceClaims claims() const {
    return {.energy = false, .virial = false, .velocity_dependent = drag != 0, .dissipative = drag != 0};
  }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    using std::sqrt;
    for (Index i = 0; i < s.size(); ++i) {
      if (drag != 0) out.acceleration(i, Vec3<Real>(Real(-drag) * s.velocities()[i]));
      if (i == 0) continue;
      const Vec3<Real> d = s.positions()[i] - s.positions()[i - 1];
      const Real length = sqrt(norm2(d)), pull = Real(k) * (length - Real(1)) / length;
      out.acceleration(i, Vec3<Real>(-pull * d));
      out.acceleration(i - 1, Vec3<Real>(pull * d));
    }
  }
};

/// The same for doubles only.
struct ChainInDouble : Chain {
  void add_to(ForceSink<double>& out, const ParticleSystem<double>& s) const { Chain::add_to(out, s); }
};

ParticleSystem<double> bent_chain(int n) {
  ParticleSystem<double> s;
  for (int i = 0; i < n; ++i) {
    const double x = i, bend = 0.2 * std::sin(0.3 * x);
    s.add("", 1, Vec3<double>(x, bend, 0.1 * bend), Vec3<double>(0, 0.1 * std::cos(0.5 * x), 0.05));
  }
  return s;
}

template <class F> Vector<double> chain_by(const F& force, const MethodChoice& choice) {
  const auto s = bent_chain(20);
  ForceMotion<ForceField<double>, double> field(field_of(force));
  field.bind(s);
  Vector<double> y;
  field.gather(s, y);
  const auto reached = march<double>(field, choice, y, 0.02, 10);
  REQUIRE_FALSE(reached.failure);
  return reached.y;
}

/// Prothero and Robinson's problem for 40 variables, each pulled by its neighbor too, of different rates.
struct StiffPulls {
  static std::string_view name() { return "stiff_pulls"; }
  static Index size() { return 40; }
  template <class Real> void rates(const Real& t, const Vector<Real>& y, Vector<Real>& dy) const {
    using std::cos, std::sin;
    const Real phi = sin(t + Real(0.25)), slope = cos(t + Real(0.25));
    double lambda = -1e6;
    for (Index i = 0; i < size(); ++i, lambda *= 0.98) {
      const Real off = y[i] - phi, next = i + 1 < size() ? y[i + 1] - phi : Real(0);
      dy[i] = Real(lambda) * (off + Real(0.1) * next) + slope;
    }
  }
};

/// |M x - b| / |b|
double residual_of(const LinearMap<double>& map, const Vector<double>& x, const Vector<double>& b) {
  Vector<double> back(b.size());
  map(x, back);
  return (back - b).norm() / b.norm();
}

LinearMap<double> diffusion(double strength) {
  return [strength](const Vector<double>& v, Vector<double>& out) {
    const Index n = v.size();
    for (Index i = 0; i < n; ++i) {
      out[i] = v[i] + strength * (2 * v[i] - (i > 0 ? v[i - 1] : 0) - (i + 1 < n ? v[i + 1] : 0));
    }
  };
}

/// I - h J of pairs of variables that turn about each other, at frequencies from 0 to `most` / h.
LinearMap<double> rotations(double most) {
  return [most](const Vector<double>& v, Vector<double>& out) {
    for (Index i = 0; i + 1 < v.size(); i += 2) {
      const double z = most * static_cast<double>(i) / static_cast<double>(v.size());
      out[i] = v[i] - z * v[i + 1];
      out[i + 1] = v[i + 1] + z * v[i];
    }
  };
}

std::vector<std::string> methods_with_a_jacobian() {
  std::vector<std::string> names;
  for (const MethodInfo* info : methods::all()) {
    if (info->family == "line integral") continue;  // not under drag: tests/methods/energy_exact_test.cpp
    if (info->takes(*linear_solver)) names.emplace_back(info->name);
  }
  return names;
}

}  // namespace

TEST_CASE("Krylov spaces solve systems small and large, of decay and of rotation") {
  for (const Index n : {1, 2, 3, 30, 31, 400}) {
    Vector<double> b(n), x;
    for (Index i = 0; i < n; ++i) b[i] = std::sin(1.7 * static_cast<double>(i + 1));
    for (const double scale : {1.0, 1e-250, 1e250}) {
      const Vector<double> right = scale * b;
      INFO(n << " " << scale);
      REQUIRE(solve_by_krylov(diffusion(1e4), right, {.residual = 1e-12}, x));
      CHECK(residual_of(diffusion(1e4), x / scale, b) < 1e-9);  // the condition number is 4e4
    }
    if (n % 2 == 0) {
      REQUIRE(solve_by_krylov(rotations(10), b, {.residual = 1e-12}, x));
      CHECK(residual_of(rotations(10), x, b) < 1e-11);
    }
  }
  Vector<double> x;
  REQUIRE(solve_by_krylov(diffusion(1), Vector<double>(Vector<double>::Zero(5)), {}, x));
  CHECK(x == Vector<double>::Zero(5));
}

TEST_CASE("what Krylov spaces cannot solve is told: no solution, no numbers") {
  const LinearMap<double> nothing = [](const Vector<double>&, Vector<double>& out) { out.setZero(); };
  const LinearMap<double> half = [](const Vector<double>& v, Vector<double>& out) {
    for (Index i = 0; i < v.size(); ++i) out[i] = i % 2 == 0 ? v[i] : 0;
  };
  const LinearMap<double> no_number = [](const Vector<double>&, Vector<double>& out) {
    out.setConstant(std::numeric_limits<double>::quiet_NaN());
  };
  const Vector<double> b = Vector<double>::Ones(50);
  Vector<double> x, bad = b;
  CHECK_FALSE(solve_by_krylov(nothing, b, {}, x));
  CHECK_FALSE(solve_by_krylov(half, b, {}, x));
  CHECK_FALSE(solve_by_krylov(no_number, b, {}, x));
  bad[7] = std::numeric_limits<double>::infinity();
  CHECK_FALSE(solve_by_krylov(diffusion(1), bad, {}, x));
}

TEST_CASE("a matrix-free Jacobian solves what a dense one solves, by dual numbers and by differences") {
  const auto s = bent_chain(20);
  const auto check = [&](VectorField<double>& field, double tolerance) {
    field.bind(s);
    Vector<double> y;
    field.gather(s, y);
    Jacobian<double> first, second;
    first.bind(field, {.form = dense});
    second.bind(field, {.form = matrix_free, .tolerance = Tolerance(1e-6, 1e-9), .rounding = true});
    for (Jacobian<double>* J : {&first, &second}) {
      J->evaluate(field, 0.3, y);
      REQUIRE(J->factorize(2, 0.03));
    }
    CHECK(second.form() == matrix_free);
    Vector<double> u = y, w = y;
    REQUIRE(first.solve(field, u));
    REQUIRE(second.solve(field, w));
    CHECK(apart(u, w) < tolerance * y.cwiseAbs().maxCoeff());
    for (Jacobian<double>* J : {&first, &second}) REQUIRE(J->factorize_half(1, 0.02, 3e-4));
    u = w = y.head(y.size() / 2);
    REQUIRE(first.solve_half(field, u));
    REQUIRE(second.solve_half(field, w));
    CHECK(apart(u, w) < tolerance * y.cwiseAbs().maxCoeff());
  };
  for (const double drag : {0.0, 40.0}) {
    INFO(drag);
    ForceMotion<ForceField<double>, double> exact(field_of(Chain{.drag = drag}));
    ForceMotion<ForceField<double>, double> found(field_of(ChainInDouble{{.drag = drag}}));
    check(exact, 1e-10);
    CHECK_FALSE(found.has_derivative());
    check(found, 1e-7);
  }
}

TEST_CASE("matrix-free methods go the way of dense ones on stiff springs") {
  for (const std::string& name : methods_with_a_jacobian()) {
    if (name == "bdf") continue;  // chooses its steps
    INFO(name);
    const auto choice = with_fixed_steps(name);
    const Chain springs{.drag = 3};
    const Vector<double> by_dense = chain_by(springs, in_form(choice, dense));
    CHECK(apart(by_dense, chain_by(springs, in_form(choice, matrix_free))) < 1e-9);
    CHECK(apart(by_dense, chain_by(ChainInDouble{springs}, in_form(choice, matrix_free))) < 1e-6);
  }
}

// Values at 1e11 from the test set of Mazzia and Magherini (2008).
TEST_CASE("matrix-free methods take Robertson's kinetics to t = 1e11, in the steps of dense ones") {
  Vector<double> published(3), start(3);
  published << 0.2083340149701255e-7, 0.8333360770334713e-13, 0.9999999791665050;
  start << 1, 0, 0;
  for (const auto& [name, relative] :
       {std::pair("rodas_4", 3e-7), std::pair("rodas_5p", 3e-7), std::pair("bdf", 1e-4)}) {
    INFO(name);
    const auto choice = method(name, {.rtol = 1e-7, .atol = 1e-14});
    const auto reached = march_to<double>(Kinetics{}, in_form(choice, matrix_free), start, 1e11);
    const auto by_dense = march_to<double>(Kinetics{}, in_form(choice, dense), start, 1e11);
    REQUIRE_FALSE(reached.failure);
    for (Index i = 0; i < 3; ++i) CHECK(std::abs(reached.y[i] / published[i] - 1) < relative);
    CHECK(std::abs(static_cast<double>(reached.steps) / static_cast<double>(by_dense.steps) - 1) < 0.05);
  }
}

TEST_CASE("matrix-free methods have the orders of dense ones on Prothero and Robinson's problem") {
  for (const auto& [name, slope] : std::vector<std::pair<std::string, double>>{
           {"backward_euler", 1}, {"trapezoidal", 2}, {"sdirk_4", 1}, {"rodas_5p", 3}, {"bdf_3", 3}}) {
    const auto choice = with_fixed_steps(name);
    Vector<Quad> start(40);
    start.setConstant(sin(Quad(0.25)));
    std::vector<ErrorPoint> points, by_dense;
    for (const long n : {16, 32}) {
      const double h = 1.0 / static_cast<double>(n);
      const auto error = [&](JacobianForm form) {
        const auto reached = march<Quad>(StiffPulls{}, in_form(choice, form), start, h, n);
        REQUIRE_FALSE(reached.failure);
        Quad worst(0);
        for (Index i = 0; i < 40; ++i) worst = std::max<Quad>(worst, abs(reached.y[i] - sin(Quad(1.25))));
        return static_cast<double>(worst);
      };
      points.push_back({h, error(matrix_free)});
      by_dense.push_back({h, error(dense)});
      CHECK(std::abs(points.back().error / by_dense.back().error - 1) < 1e-6);
    }
    INFO(name << "\n" << to_text(points) << to_text(by_dense));
    CHECK(std::abs(fitted_slope(points) - fitted_slope(by_dense)) < 1e-6);
    CHECK(fitted_slope(points) > slope - 0.7);
  }
}

namespace {
/// A type of this file's own, so that what is compiled for it is not that of a test without optimization.
struct LongLine : Heat {};
}  // namespace

TEST_CASE("a hundred thousand variables need no matrix, and products grow as the square root of the stiffness") {
  // Two matrices of them would take 160 GB.
  constexpr Index n = 100000;
  const LongLine heat{{.n = n, .tell_sparsity = false}};
  Vector<double> y(n);
  for (Index i = 0; i < n; ++i) y[i] = i % 2000 < 1000 ? 1 : 0;
  std::vector<ErrorPoint> products;
  for (const double h : {1e-9, 4e-8}) {  // the condition number is 4e10 h
    const auto reached = march<double>(heat, in_form(method("backward_euler"), matrix_free), y, h, 1);
    REQUIRE_FALSE(reached.failure);
    CHECK(reached.y.minCoeff() > -1e-12);
    CHECK(reached.y.maxCoeff() < 1 + 1e-12);
    CHECK(std::abs(reached.y.sum() / y.sum() - 1) < 1e-3);
    products.push_back({h, static_cast<double>(reached.evaluations.force)});
    CHECK(reached.evaluations.jacobian == 1);
  }
  INFO(to_text(products));
  CHECK(fitted_slope(products) > 0.3);
  CHECK(fitted_slope(products) < 0.7);
}

TEST_CASE("on a line of heat the three forms take the same steps to the same end") {
  const Heat heat{.n = 120};
  Vector<double> y(120);
  for (Index i = 0; i < 120; ++i) y[i] = i % 40 < 20 ? 1 : 0;
  for (const std::string name : {"rodas_4", "rodas_5p", "bdf"}) {
    INFO(name);
    const auto by = [&](JacobianForm form) {
      auto reached = march_to<double>(heat, in_form(method(name, {.rtol = 1e-5}), form), y, 0.01);
      REQUIRE_FALSE(reached.failure);
      return reached;
    };
    const auto first = by(dense), second = by(sparse), third = by(matrix_free);
    CHECK(apart(first.y, second.y) < 1e-10);
    CHECK(apart(first.y, third.y) < 1e-7);
    CHECK(std::abs(first.steps - third.steps) <= 2);
  }
}

TEST_CASE("matrix-free methods go on from a saved run with the same bits") {
  const Heat heat{.n = 60};
  const auto check = [](const Classical<double>& used, const ParticleSystem<double>& start) {
    for (const std::int64_t n : {1, 9}) check_goes_on(used, start, n, 0.001);
  };
  ParticleSystem<double> line;
  for (int i = 0; i < 60; ++i) line.variables().push_back(i % 20 < 10 ? 1 : 0);
  for (const std::string& name : methods_with_a_jacobian()) {
    INFO(name);
    const bool own = !methods::find(name)->fixed;
    const auto choice = in_form(own ? method(name, {.rtol = 1e-4}) : with_fixed_steps(name), matrix_free);
    if (name != "newmark") check(classical(heat, choice), line);
    check(classical_over(Chain{.drag = 1}, choice), bent_chain(20));
  }
  auto saved_by = [&](std::optional<JacobianForm> form) {
    auto made = classical(heat, method("bdf", {.jacobian = form}));
    auto s = line;
    s.clock() = Clock<double>::free(0);
    made.bind(s);
    SavedState saved;
    made.save(saved, "");
    return saved;
  };
  auto other = classical(heat, method("bdf", {.jacobian = matrix_free}));
  auto s = line;
  s.clock() = Clock<double>::free(0);
  other.bind(s);
  CHECK_NOTHROW(other.load(saved_by(matrix_free), ""));
  CHECK_THROWS_WITH(
      other.load(saved_by({}), ""),
      "the saved run was made with bdf(adaptive = true, rtol = default, atol = default, jacobian = default, "
      "first = default), but this one has bdf(adaptive = true, rtol = default, atol = default, jacobian = "
      "matrix_free, first = default)");
}

TEST_CASE("a system that is not solved is a failure with a name, or a shorter step") {
  const Linear growing{.lambda = 1};
  const Vector<double> y = Vector<double>::Ones(1);
  for (const std::string name : {"backward_euler", "trapezoidal", "rodas_4"}) {
    INFO(name);
    const auto choice = in_form(with_fixed_steps(name), matrix_free);
    // I - h g J = 0
    const double g = name == "trapezoidal" ? 0.5 : name == "rodas_4" ? 0.25 : 1;
    const Linear singular{.lambda = 1 / g};
    const auto reached = march<double>(singular, choice, y, 1, 1);
    REQUIRE(reached.failure);
    CHECK(reached.failure->kind == Outcome::Kind::solver_failure);
    CHECK(reached.failure->message.find("GMRES and BiCGSTAB did not solve") == 0);
  }
  const auto reached = march_to<double>(growing, in_form(method("rodas_4", {.first = 4.0}), matrix_free), y, 5);
  CHECK_FALSE(reached.failure);
  CHECK(reached.rejected > 0);
  CHECK(std::abs(reached.y[0] / std::exp(5.0) - 1) < 1e-4);
}

TEST_CASE("forms that a method or a field does not know are refused") {
  const auto refusal = [](const auto& make) -> std::string {
    try {
      make();
    } catch (const Error& error) {
      CHECK(error.key() == "jacobian");
      return error.message();
    }
    return "";
  };
  CHECK(refusal([] { classical(Kinetics{}, method("rk4", {.jacobian = matrix_free})); }) ==
        "method 'rk4' does not solve linear systems, so jacobian has no effect here; take it out");
  CHECK(refusal([] {
          ParticleSystem<double> s;
          s.variables() = {1, 0, 0};
          classical(Kinetics{}, method("bdf_2", {.jacobian = sparse})).bind(s);
        }) ==
        "'kinetics' does not declare where its Jacobian can be nonzero, so it has no sparse one; use jacobian = "
        "\"matrix_free\" or \"dense\"");
}
