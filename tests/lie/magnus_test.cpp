/// Y' = A(t) Y on rotations: Magnus's methods and others, against a reference of 28 digits; systems of users.

#include "integrators/lie/graded_brackets.hpp"
#include "integrators/lie/group_system.hpp"
#include "integrators/lie/linear_rotation.hpp"
#include "integrators/methods/explicit_tableaus.hpp"
#include "integrators/systems/turning_frame.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace noether {
namespace {

/// A = hat(a) with a = (0.5 + sin t, cos 2t, 0.3 t).
struct RollingFrame : RotationMatrix<3> {
  template <class Real> void rates(const Real& t, SmallMatrix<Real>& A) const {
    using std::cos, std::sin;
    A(0, 1) = -Real(0.3) * t;
    A(0, 2) = cos(Real(2) * t);
    A(1, 2) = -(Real(0.5) + sin(t));
  }
};

double frame_error(const std::string& name, double h) {
  MethodOptions options;
  if (methods::find(name)->adaptive) options.adaptive = false;
  Simulation sim(initial_state(RollingFrame{}), lie(RollingFrame{}, method(name, options)), h);
  REQUIRE(sim.run(std::lround(5 / h)).ok());
  // By extrapolation in 28 digits; error bar 2.3e-27.
  const double exact[] = {-0.0643538234534449079, 0.98455127917995009068, 0.16284153055055340882,
                          0.97688073216734749873, 0.09548862924164270887, -0.1912745586996325521,
                          -0.2038691259781871089, 0.14676750440978436175, -0.9679342328496363300};
  double worst = 0;
  for (std::size_t i = 0; i < 9; ++i) worst = std::max(worst, std::abs(sim.particles().variables()[i] - exact[i]));
  return worst;
}

/// Largest element of Y^T Y - 1.
double matrix_defect(const std::vector<double>& y, std::size_t n) {
  double worst = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      double sum = i == k ? -1 : 0;
      for (std::size_t j = 0; j < n; ++j) sum += y[n * j + i] * y[n * j + k];
      worst = std::max(worst, std::abs(sum));
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("Magnus's methods have their errors and orders on a frame that rolls", "[lie]") {
  struct Row {
    const char* name;
    double error, slope;
  };
  for (const auto& [name, error, slope] : {Row{"magnus_2", 3.753e-3, 2},
                                           {"magnus_4", 1.405e-5, 4},
                                           {"magnus_cf_4", 2.693e-6, 4},
                                           {"magnus_6", 6.836e-9, 6},
                                           {"rkmk_rk4", 2.892e-6, 4},
                                           {"commutator_free_4", 1.119e-5, 4}}) {
    CAPTURE(name);
    const double coarse = frame_error(name, 0.125), fine = frame_error(name, 0.0625);
    CHECK(std::abs(coarse / error - 1) < 0.02);
    CHECK(std::abs(std::log2(coarse / fine) - slope) < 0.08);
  }
  CHECK(std::abs(std::log2(frame_error("rk4", 0.0625) / frame_error("rk4", 0.03125)) - 4) < 0.3);
}

TEST_CASE("frames of 2 to 8 dimensions stay rotations, and methods agree there", "[lie]") {
  const auto end = [](const std::string& name, double h) {
    const auto frame = linear_rotation<8>([](const auto& t, auto& A) {
      for (Index i = 0; i < 8; ++i) {
        for (Index k = i + 1; k < 8; ++k) A(i, k) = double(i + 1) / double(k + 1) * t - 0.1 * double(k - i);
      }
    });
    Simulation sim(initial_state(frame, frame.start()), lie(frame, method(name, MethodOptions{})), h);
    REQUIRE(sim.run(std::lround(1 / h)).ok());
    CHECK(matrix_defect({sim.particles().variables().begin(), sim.particles().variables().end()}, 8) < 4e-15);
    return std::vector<double>(sim.particles().variables().begin(), sim.particles().variables().end());
  };
  const std::vector<double> truth = end("magnus_6", 1. / 64);
  for (const auto& [name, bound] : {std::pair{"magnus_4", 1e-3}, {"magnus_cf_4", 1e-3}, {"magnus_6", 1e-5}}) {
    CAPTURE(name);
    const std::vector<double> found = end(name, 1. / 8);
    double worst = 0;
    for (std::size_t i = 0; i < 64; ++i) worst = std::max(worst, std::abs(found[i] - truth[i]));
    CHECK(worst < bound);
    CHECK(worst > 0);
  }
}

TEST_CASE("exponentials of skew matrices are those of their closed form, small and large", "[lie]") {
  for (const double angle : {1e-9, 0.1, 3., 100.}) {
    SmallMatrix<double> A = SmallMatrix<double>::Zero(3, 3), E(3, 3);
    const Vec3<double> n(2. / 3, -1. / 3, 2. / 3);
    A << 0, -n[2], n[1], n[2], 0, -n[0], -n[1], n[0], 0;
    const SmallMatrix<double> square = A * A;
    const SmallMatrix<double> closed =
        SmallMatrix<double>::Identity(3, 3) + std::sin(angle) * A + (1 - std::cos(angle)) * square;
    exponential_of_skew<double>(angle * A, E);
    CHECK((E - closed).cwiseAbs().maxCoeff() < 1e-15 * std::max(1., 4 * angle));
  }
}

namespace {

/// A heavy top as a user writes it, on SO(3) x R^3.
struct UsersTop {
  Index rotations() const { return 1; }
  Index motions() const { return 0; }
  Index numbers() const { return 3; }
  Index size() const { return 7; }
  template <class Real> void velocity(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& a) const {
    const Vec3<Real> pi = triple_at<Real>(y, 4), rate(pi[0] / Real(2), pi[1], pi[2] * Real(1.5));
    const Vec3<Real> down =
        to_body<Real>(rotation_matrix<Real>(quaternion_at<Real>(y, 0)), Vec3<Real>(Real(0), Real(0), Real(-1)));
    const Vec3<Real> twist = cross<Real>(pi, rate) + cross<Real>(Vec3<Real>(Real(0.2), Real(0.3), Real(0.5)), down);
    for (Index k = 0; k < 3; ++k) {
      a[k] = rate[k];
      a[3 + k] = twist[k];
    }
  }
};

/// A rigid motion of constant velocities in its own axes: a screw, which one exponential follows.
struct Screw {
  Index rotations() const { return 0; }
  Index motions() const { return 1; }
  Index numbers() const { return 0; }
  Index size() const { return 7; }
  template <class Real> void velocity(const Real& /*t*/, const Vector<Real>& /*y*/, Vector<Real>& a) const {
    a << Real(0), Real(0), Real(2), Real(1), Real(0), Real(0.25);
  }
};

}  // namespace

TEST_CASE("a user's top on SO(3) x R^3 has the errors of the reference", "[lie]") {
  const auto run = [](const std::string& name) {
    Simulation sim(initial_state(UsersTop{}, {1, 0, 0, 0, 0.6, -0.4, 0.9}), lie(UsersTop{}, method(name)), 0.1);
    REQUIRE(sim.run(100).ok());
    const auto& y = sim.particles().variables();
    return std::abs(y[4] - 0.22808129162272360413);
  };
  CHECK(run("rkmk_rk4") < 2.63e-5);
  CHECK(run("commutator_free_4") < 3.3e-5);
}

TEST_CASE("pairs of methods choose the steps of a user's field on a group, to their tolerance", "[lie]") {
  for (const char* name : {"rkmk_dormand_prince_5", "rkmk_cash_karp_5", "rkmk_dop853"}) {
    double before = 1;
    for (const double rtol : {1e-5, 1e-7, 1e-9}) {
      CAPTURE(name, rtol);
      Simulation sim(initial_state(UsersTop{}, {1, 0, 0, 0, 0.6, -0.4, 0.9}),
                     lie(UsersTop{}, method(name, {.rtol = rtol, .atol = rtol / 100})));
      REQUIRE(sim.run_until(10).ok());
      const std::vector<double>& y = sim.particles().variables();
      const double error = std::abs(y[4] - 0.22808129162272360413);
      CHECK(error < 300 * rtol);
      CHECK(error < before / 3);
      CHECK(std::abs(y[0] * y[0] + y[1] * y[1] + y[2] * y[2] + y[3] * y[3] - 1) < 1e-15);
      before = error;
    }
  }
}

TEST_CASE("a screw is followed exactly on SE(3), by steps of any length", "[lie]") {
  Simulation sim(initial_state(Screw{}, {1, 0, 0, 0, 0, 0, 0}), lie(Screw{}, method("rkmk_euler")), 0.5);
  REQUIRE(sim.run(4).ok());
  const auto& y = sim.particles().variables();
  const double angle = 4;  // a circle of radius 1/2, and 0.25 along the axis in a unit of time
  CHECK(std::abs(y[0] - std::cos(angle / 2)) < 1e-15);
  CHECK(std::abs(y[4] - std::sin(angle) / 2) < 2e-15);
  CHECK(std::abs(y[5] - (1 - std::cos(angle)) / 2) < 2e-15);
  CHECK(std::abs(y[6] - 0.5) < 2e-15);
}

TEST_CASE("a start beside the group is refused by methods on it, and by no others", "[lie]") {
  std::vector<double> y = TurningFrame{}.start();
  y[1] = 1e-4;
  CHECK_THROWS_WITH(
      Simulation(initial_state(TurningFrame{}, y), lie(TurningFrame{}, method("magnus_4")), 0.1),
      "the matrix Y of system 'turning_frame' is not a rotation: |Y^T Y - 1| is 0.0001, but at most 1e-09 "
      "is expected of a method on rotations");
  CHECK_NOTHROW(Simulation(initial_state(TurningFrame{}, y), lie(TurningFrame{}, method("rk4")), 0.1));
  CHECK_THROWS_WITH(
      Simulation(initial_state(UsersTop{}, {1.5, 0, 0, 0, 0, 0, 0}), lie(UsersTop{}, method("rkmk_rk4")), 0.1),
      Catch::Contains("is not a rotation: |q|^2 - 1 is 1.25, but at most 1e-09 is expected"));
  CHECK_THROWS_AS(Simulation(initial_state(Screw{}, {NAN, 0, 0, 0, 0, 0, 0}), lie(Screw{}, method("rkmk_euler")), 0.5),
                  Error);
}

TEST_CASE("what a step on a group takes is counted, plain and with brackets reduced", "[lie]") {
  const auto work = [](const std::string& name) {
    const MethodInfo& info = *methods::find(name);
    return info.group_work(info, {});
  };
  struct Row {
    const char* name;
    int evaluations, exponentials, commutators, least;
  };
  for (const auto& [name, evaluations, exponentials, commutators, least] :
       {Row{"rkmk_euler", 1, 1, 0, 0}, Row{"rkmk_heun", 2, 2, 0, 0}, Row{"rkmk_rk4", 4, 4, 6, 2},
        Row{"rkmk_dormand_prince_5", 6, 6, 12, 5}, Row{"rkmk_cash_karp_5", 6, 6, 10, 5},
        Row{"rkmk_dop853", 12, 12, 72, 31}, Row{"crouch_grossman_3", 3, 6, 0, -1},
        Row{"crouch_grossman_4", 5, 15, 0, -1}, Row{"commutator_free_3", 3, 3, 0, -1},
        Row{"commutator_free_4", 4, 5, 0, -1}, Row{"magnus_2", 1, 1, 0, -1}, Row{"magnus_4", 2, 1, 1, -1},
        Row{"magnus_6", 3, 1, 3, -1}, Row{"magnus_cf_4", 2, 2, 0, -1}}) {
    CAPTURE(name);
    const GroupWork found = work(name);
    CHECK(found.evaluations == evaluations);
    CHECK(found.exponentials == exponentials);
    CHECK(found.commutators == commutators);
    CHECK(found.least_commutators == least);
  }
}

}  // namespace noether
