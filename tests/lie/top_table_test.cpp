/// The tables of two heavy tops: errors, slopes, energy, vertical spin and R^T R of methods on their group, with as
/// many brackets as the order needs and with fewer. References by extrapolation in 28 to 40 digits.

#include "integrators/first_order_system.hpp"
#include "integrators/lie/body_motion.hpp"
#include "integrators/lie/rkmk.hpp"
#include "tests/lie/top_errors.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace noether {
namespace {

/// A top at the end of its run, as its oracle has it.
struct OracleTop {
  Vec3<double> inertia, center;
  double weight, mass;  ///< g, and m
  Vec3<double> pi_start, pi_end;
  Mat3<double> r_end;
  double duration;

  ParticleSystem<double> start() const {
    ParticleSystem<double> s(unit_system("reduced"));
    add_body(s, top("top", mass, inertia, center), {.spin = pi_start});
    return s;
  }
  double energy(const Mat3<double>& r, const Vec3<double>& pi) const {
    double sum = mass * weight * (r * center)[2];
    for (int k = 0; k < 3; ++k) sum += pi[k] * pi[k] / (2 * inertia[k]);
    return sum;
  }
};

Mat3<double> matrix(const std::array<double, 9>& rows) {
  Mat3<double> r;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) r(i, k) = rows[static_cast<std::size_t>(3 * i + k)];
  }
  return r;
}

/// I = (2, 1, 2/3), m g = 1.
const OracleTop& top_a() {
  static const OracleTop made{.inertia = {2, 1, 2. / 3},
                              .center = {0.2, 0.3, 0.5},
                              .weight = 1,
                              .mass = 1,
                              .pi_start = {0.6, -0.4, 0.9},
                              .pi_end = {0.22808129162272360413, -0.5258554584300771690, 1.09631904314062503078},
                              .r_end = matrix({0.63061869068486407790, 0.41148720346445770423, -0.6580261000476407484,
                                               0.13793808901625566150, 0.77494456231452710831, 0.61679332757228295161,
                                               0.76373630957121009037, -0.4797282634201845721, 0.43193476673961167427}),
                              .duration = 10};
  return made;
}

/// That of Bruels and Cardona, which turns about an axis across its weight, 150 rad in a unit of time.
const OracleTop& top_b() {
  static const OracleTop made{.inertia = {15.234375, 0.46875, 15.234375},
                              .center = {0, 1, 0},
                              .weight = 9.81,
                              .mass = 15,
                              .pi_start = {0, 0.46875 * 150, 15.234375 * -4.61538},
                              .pi_end = {-12.523846080322450700, 70.3125, -90.237641631475043459},
                              .r_end = matrix({0.22929964080360759365, 0.17334396409838604259, 0.95779619170155087135,
                                               -0.7653407422046809422, 0.64008859207056878286, 0.06738058045687271853,
                                               -0.6013943989171537362, -0.7484907911335813094, 0.27943928238402867045}),
                              .duration = 1};
  return made;
}

/// What comes of a run: the larger error of R and Pi, the latter relative to the start; the largest relative error of
/// the energy, change of the vertical spin and defect of R on the way; that defect at the end.
struct TopFigures {
  double error, energy, vertical, defect, left;
};

/// A walk of steps of h: R and Pi after each of them, or at the end alone.
using TopLook = std::function<void(const Mat3<double>&, const Vec3<double>&)>;
using TopWalk = std::function<void(double h, bool each, const TopLook& look)>;

TopFigures figures_of(const OracleTop& top, double h, const TopWalk& walk, bool each = true) {
  const double before = top.energy(Mat3<double>::Identity(), top.pi_start), vertical = top.pi_start[2];
  TopFigures made{};
  walk(h, each, [&](const Mat3<double>& r, const Vec3<double>& pi) {
    made.error = std::max((r - top.r_end).cwiseAbs().maxCoeff(),
                          (pi - top.pi_end).cwiseAbs().maxCoeff() / top.pi_start.cwiseAbs().maxCoeff());
    made.energy = std::max(made.energy, std::abs(top.energy(r, pi) / before - 1));
    made.vertical = std::max(made.vertical, std::abs((r * pi)[2] - vertical));
    made.left = (r.transpose() * r - Mat3<double>::Identity()).cwiseAbs().maxCoeff();
    made.defect = std::max(made.defect, made.left);
  });
  return made;
}

TopWalk walk_of(const OracleTop& top, AnyIntegrator<double> integrator) {
  return [=](double h, bool each, const TopLook& look) {
    Simulation sim(top.start(), integrator, h);
    const long all = std::lround(top.duration / h), looks = each ? all : 1;
    for (long n = 0; n < looks; ++n) {
      REQUIRE(sim.run(all / looks).ok());
      look(test::matrix_of(sim.particles()), test::in_body_of(sim.particles()));
    }
  };
}

/// Kutta's method of order 3, which is none of the house.
const Tableau& kutta_3() {
  static const Tableau table = [] {
    Tableau made{.a = rows({"", "1/2", "-1 2"}), .b = coefficients("1/6 2/3 1/6"), .c = {}, .order = 3};
    made.c = row_sums(made.a);
    return made;
  }();
  return table;
}

/// A method of Munthe-Kaas with any number of brackets, as many as it needs or not.
template <const Tableau& (*table)(), int terms> const MethodInfo& with_brackets() {
  static const MethodInfo made = [] {
    MethodInfo info = *methods::find("rkmk_rk4");
    info.make = [](const MethodInfo& own, const MethodOptions&) -> std::unique_ptr<Method<double>> {
      return std::make_unique<Rkmk<double>>(own, MethodOptions{.adaptive = false}, tableaus::NamedTableau{"rk4", table},
                                            terms);
    };
    return info;
  }();
  return made;
}

AnyIntegrator<double> on_group_of(const OracleTop& top, const MethodChoice& choice) {
  return lie(test::weight_on_sites(top.weight), choice);
}
AnyIntegrator<double> named(const OracleTop& top, const std::string& name, std::optional<std::int64_t> terms = {}) {
  const MethodInfo& info = *methods::find(name);
  MethodOptions options;
  if (info.adaptive) options.adaptive = false;
  if (terms) options.own = RkmkOptions{.dexp_terms = *terms};
  return on_group_of(top, {&info, options});
}

/// A row of the table: the errors at two steps, the slope from the second to its half, and what is kept at the first.
struct TopRow {
  std::string name;
  AnyIntegrator<double> integrator;
  double coarse, fine, slope, energy, vertical;
};

void check_row(const OracleTop& top, const TopRow& row, double h) {
  CAPTURE(row.name);
  const TopWalk walk = walk_of(top, row.integrator);
  const TopFigures coarse = figures_of(top, h, walk), fine = figures_of(top, h / 2, walk, false),
                   finer = figures_of(top, h / 4, walk, false);
  CHECK(std::abs(coarse.error / row.coarse - 1) < 0.02);
  CHECK(std::abs(fine.error / row.fine - 1) < 0.02);
  CHECK(std::abs(std::log2(fine.error / finer.error) / row.slope - 1) < 0.02);
  CHECK(std::abs(coarse.energy / row.energy - 1) < 0.05);
  if (row.vertical > 0) CHECK(std::abs(coarse.vertical / row.vertical - 1) < 0.05);
  if (row.vertical == 0) CHECK(coarse.vertical < 2e-13);  // to rounding
  CHECK(coarse.defect < 1e-14);
}

}  // namespace

TEST_CASE("heavy top A: every row of its table, errors and slopes to 2 %, energy and vertical spin to 5 %", "[lie]") {
  using namespace tableaus;
  const OracleTop& top = top_a();
  const auto bracketed = [&](const MethodInfo& info) { return on_group_of(top, {&info, {}}); };
  const RotatingOptions by_action{.rotor = Rotor::variational};
  for (const TopRow& row : {
           TopRow{"heun", named(top, "rkmk_heun"), 1.730e-2, 4.449e-3, 1.98, 2.21e-3, 2.24e-3},
           {"heun, 1 bracket", bracketed(with_brackets<heun, 1>()), 4.498e-2, 1.227e-2, 1.942, 1.43e-3, 8.45e-3},
           {"kutta 3, none", bracketed(with_brackets<kutta_3, 0>()), 1.227e-2, 3.202e-3, 1.973, 6.15e-4, 2.67e-3},
           {"kutta 3, 1", bracketed(with_brackets<kutta_3, 1>()), 5.616e-3, 6.904e-4, 3.015, 6.64e-4, 1.18e-3},
           {"kutta 3, 2", bracketed(with_brackets<kutta_3, 2>()), 5.144e-3, 6.298e-4, 3.019, 6.16e-4, 1.09e-3},
           {"rk4, 1", bracketed(with_brackets<rk4, 1>()), 7.184e-4, 9.200e-5, 2.98, 7.10e-5, 1.47e-4},
           {"rk4", named(top, "rkmk_rk4"), 2.628e-5, 2.033e-6, 3.872, 1.47e-6, 6.37e-6},
           {"dp5, 1", bracketed(with_brackets<dormand_prince_5, 1>()), 7.431e-4, 9.387e-5, 2.993, 7.16e-5, 1.51e-4},
           {"dp5", named(top, "rkmk_dormand_prince_5"), 6.331e-7, 2.074e-8, 4.97, 5.92e-8, 1.15e-7},
           {"dp5, 4", named(top, "rkmk_dormand_prince_5", 4), 3.649e-7, 1.225e-8, 4.955, 3.53e-8, 6.41e-8},
           {"cg3", named(top, "crouch_grossman_3"), 3.417e-3, 4.277e-4, 2.999, 2.10e-4, 7.09e-4},
           {"cg4", named(top, "crouch_grossman_4"), 2.195e-5, 1.418e-6, 3.979, 4.90e-6, 7.81e-6},
           {"cf3", named(top, "commutator_free_3"), 2.502e-3, 3.060e-4, 3.019, 3.58e-4, 5.39e-4},
           {"cf4", named(top, "commutator_free_4"), 3.226e-5, 2.219e-6, 3.938, 8.91e-7, 5.36e-6},
           {"lgvi", compose(test::turning(test::weight_on_sites(), by_action), schemes::lie_group_variational),
            4.833e-2, 1.173e-2, 2.011, 2.91e-3, 0},
       })
    check_row(top, row, 0.1);
}

TEST_CASE("heavy top B, which turns 0.3 rad a step: rows of its table", "[lie]") {
  const OracleTop& top = top_b();
  const RotatingOptions by_action{.rotor = Rotor::variational};
  for (const TopRow& row : {
           TopRow{"rk4", named(top, "rkmk_rk4"), 9.671e-3, 5.917e-4, 4.025, 1.67e-4, 0.181},
           {"dp5", named(top, "rkmk_dormand_prince_5"), 1.035e-4, 3.757e-6, 4.928, 6.15e-6, 2.42e-3},
           {"dp5, 4", named(top, "rkmk_dormand_prince_5", 4), 1.039e-4, 3.771e-6, 4.928, 6.17e-6, 2.43e-3},
           {"cg3", named(top, "crouch_grossman_3"), 0.1944, 2.861e-2, 2.955, 1.05e-2, 4.76},
           {"cg4", named(top, "crouch_grossman_4"), 1.619e-2, 9.843e-4, 4.031, 3.63e-4, 0.329},
           {"cf3", named(top, "commutator_free_3"), 0.1914, 2.814e-2, 2.955, 1.04e-2, 4.60},
           {"cf4", named(top, "commutator_free_4"), 9.680e-3, 5.923e-4, 4.025, 1.68e-4, 0.180},
           {"lgvi", compose(test::turning(test::weight_on_sites(9.81), by_action), schemes::lie_group_variational),
            2.057, 0.7192, 1.981, 2.02e-5, 0},
       })
    check_row(top, row, 0.002);
}

namespace {

/// The heavy top A as a matrix that is no group to its method.
struct MatrixOfTop {
  Index size() const { return 12; }
  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const {
    const Vec3<Real> pi(y[9], y[10], y[11]), rate(pi[0] / Real(2), pi[1], pi[2] * Real(1.5));
    for (Index i = 0; i < 3; ++i) {
      const Vec3<Real> moved = cross<Real>(Vec3<Real>(y[3 * i], y[3 * i + 1], y[3 * i + 2]), rate);
      for (Index k = 0; k < 3; ++k) dy[3 * i + k] = moved[k];
    }
    const Vec3<Real> down(-y[6], -y[7], -y[8]);
    const Vec3<Real> twist = cross<Real>(pi, rate) + cross<Real>(Vec3<Real>(Real(0.2), Real(0.3), Real(0.5)), down);
    for (Index k = 0; k < 3; ++k) dy[9 + k] = twist[k];
  }
};

}  // namespace

TEST_CASE("Kutta's method on the matrix of heavy top A leaves the group, as its table has it", "[lie]") {
  const OracleTop& top = top_a();
  const TopWalk walk = [&](double h, bool /*each*/, const TopLook& look) {
    Simulation sim(initial_state(MatrixOfTop{}, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0.6, -0.4, 0.9}),
                   classical(MatrixOfTop{}, method("rk4")), h);
    for (long n = std::lround(top.duration / h); n > 0; --n) {
      REQUIRE(sim.run(1).ok());
      const std::vector<double>& y = sim.particles().variables();
      look(matrix({y[0], y[1], y[2], y[3], y[4], y[5], y[6], y[7], y[8]}), Vec3<double>(y[9], y[10], y[11]));
    }
  };
  const TopFigures coarse = figures_of(top, 0.1, walk), fine = figures_of(top, 0.05, walk),
                   finer = figures_of(top, 0.025, walk);
  CHECK(std::abs(coarse.error / 1.547e-4 - 1) < 0.02);
  CHECK(std::abs(fine.error / 8.962e-6 - 1) < 0.02);
  CHECK(std::abs(std::log2(fine.error / finer.error) / 4.062 - 1) < 0.02);
  CHECK(std::abs(coarse.energy / 5.64e-6 - 1) < 0.05);
  CHECK(std::abs(coarse.vertical / 1.32e-5 - 1) < 0.05);
  CHECK(std::abs(coarse.left / 3.42e-5 - 1) < 0.05);
}

}  // namespace noether
