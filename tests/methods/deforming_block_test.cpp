/// Blocks that deform under methods that keep their energy and under others, against recorded figures.

#include "forces/hyperelastic.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "numbers/parallel.hpp"
#include "scene/block.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"

#include <algorithm>
#include <cmath>

namespace noether {
namespace {

using namespace noether::test;

constexpr double rounding = 1.1102230246251565e-16;  // 2^-53

ParticleSystem<double> turning_cube(const std::array<double, 3>& stretch) {
  return Block{.cells = {1, 1, 1}, .size = {1, 1, 1}, .density = 1, .stretch = stretch, .angular_velocity = {1, 0.3, 2}}
      .build();
}

Vec3<double> angular_momentum_of(const ParticleSystem<double>& s) {
  Vec3<double> l = Vec3<double>::Zero();
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> x = s.positions()[i], v = s.velocities()[i];
    l += s.masses()[i] * cross(x, v);
  }
  return l;
}

struct Kept {
  double energy = 0, angular_momentum = 0;                  ///< largest changes, relative
  double energy_by_root = 0, angular_momentum_by_root = 0;  ///< the same over the root of the steps until then
  std::int64_t steps = 0;
  std::optional<Failure> failure = {};
  ParticleSystem<double> end;
};

/// Follows a body, looking after every step.
template <class I> Kept follow(I integrator, ParticleSystem<double> s, double h, std::int64_t steps) {
  s.clock() = Clock<double>::fixed(0, h);
  integrator.bind(s);
  auto settled = s;
  Kept kept;
  const double first = integrator.energy(s).total();
  const Vec3<double> turning = angular_momentum_of(s);
  for (; kept.steps < steps; ++kept.steps) {
    const Advance done = integrator.advance(s, {.steps = 1});
    if (done.failure != nullptr) kept.failure = *done.failure;
    if (kept.failure) break;
    integrator.settle(s, settled, {}, std::nullopt, true);
    const double energy = std::abs(integrator.energy(settled).total() / first - 1);
    const Vec3<double> change = angular_momentum_of(settled) - turning;
    const double turned = std::sqrt(norm2(change) / norm2(turning)),
                 root = std::sqrt(static_cast<double>(kept.steps + 1));
    kept.energy = std::max(kept.energy, energy);
    kept.angular_momentum = std::max(kept.angular_momentum, turned);
    kept.energy_by_root = std::max(kept.energy_by_root, energy / root);
    kept.angular_momentum_by_root = std::max(kept.angular_momentum_by_root, turned / root);
  }
  kept.end = settled;
  return kept;
}

double farthest(const ParticleSystem<double>& a, const ParticleSystem<double>& b) {
  double most = 0;
  for (Index i = 0; i < a.size(); ++i) {
    most = std::max(most, Vec3<double>(a.positions()[i] - b.positions()[i]).cwiseAbs().maxCoeff());
  }
  return most;
}

const HyperelasticForce soft{{.lambda = 1, .mu = 0.8}}, stiff{{.lambda = 1000, .mu = 800}};

TEST_CASE("the tumbling cube: errors, slopes and what is kept, by the recorded figures", "[hyperelastic][energy]") {
  const auto cube = turning_cube({1.2, 0.9, 1.05});
  const auto truth = run(kinetic_potential(soft), schemes::srkn14a, cube, 0.01, 400);
  struct Row {
    const char* method;
    double coarse, fine, slope, energy, angular_momentum;
  };
  for (const Row& row : {Row{"simo_tarnow_wong", 0.05664, 0.01442, 1.97, 9e-15, 5e-15},
                         Row{"implicit_midpoint", 0.06907, 0.01739, 1.99, 0.0092, 1e-14}}) {
    INFO(row.method);
    const Kept coarse = follow(classical_over(soft, method(row.method)), cube, 0.1, 40);
    const Kept fine = follow(classical_over(soft, method(row.method)), cube, 0.05, 80);
    const double error = farthest(coarse.end, truth), half = farthest(fine.end, truth);
    CHECK(std::abs(error / row.coarse - 1) < 0.02);
    CHECK(std::abs(half / row.fine - 1) < 0.02);
    CHECK(std::abs(std::log2(error / half) - row.slope) < 0.1);
    CHECK(coarse.energy < 1.05 * row.energy);
    CHECK(coarse.angular_momentum < row.angular_momentum);
  }
  const auto verlet = [&](double h) {
    return farthest(run(kinetic_potential(soft), schemes::verlet, cube, h, std::llround(4 / h)), truth);
  };
  CHECK(std::abs(verlet(0.1) / 0.03731 - 1) < 0.02);
  CHECK(std::abs(verlet(0.05) / 0.009317 - 1) < 0.02);
  const Kept verlet_kept = follow(compose(kinetic_potential(soft), schemes::verlet), cube, 0.1, 40);
  CHECK(std::abs(verlet_kept.energy / 0.0043 - 1) < 0.3);
  CHECK(verlet_kept.angular_momentum < 1e-14);
}

TEST_CASE("a stiff cube at h omega = 8: energy and angular momentum are kept, lost by midpoint and Newmark",
          "[hyperelastic][energy]") {
  const auto cube = turning_cube({1.05, 0.97, 1.02});
  const Kept exact = follow(classical_over(stiff, method("simo_tarnow_wong")), cube, 0.05, 60);
  CHECK_FALSE(exact.failure);
  CHECK(exact.energy < 1e-14);
  CHECK(exact.angular_momentum < 7e-15);
  const Kept midpoint = follow(classical_over(stiff, method("implicit_midpoint")), cube, 0.05, 60);
  CHECK_FALSE(midpoint.failure);
  CHECK(std::abs(midpoint.energy / 0.137 - 1) < 0.1);
  const Kept newmark = follow(classical_over(stiff, method("newmark")), cube, 0.05, 60);
  INFO((newmark.failure ? newmark.failure->message : std::string("no failure")) << " at step " << newmark.steps);
  CHECK_FALSE(newmark.failure);
  CHECK(std::abs(newmark.energy / 0.623 - 1) < 0.1);
  CHECK(std::abs(newmark.angular_momentum / 0.61 - 1) < 0.1);
}

TEST_CASE("a stiff cube far from the origin keeps its energy, however its places are rounded",
          "[hyperelastic][energy]") {
  const auto cube = Block{
      .cells = {1, 1, 1},
      .size = {1, 1, 1},
      .density = 1,
      .stretch = {1.05, 0.97, 1.02},
      .center = {1000, 0, 0},
      .angular_velocity = {
          1, 0.3, 2}}.build();
  for (const char* name : {"simo_tarnow_wong", "gonzalez"}) {
    INFO(name);
    const Kept kept = follow(classical_over(stiff, method(name)), cube, 0.05, 60);
    CHECK_FALSE(kept.failure);
    CHECK(kept.energy < 2e-14);  // places as they are rounded change it by 5e-12 where nothing makes up for it
    // The angular momentum about the origin is rounded as places are; that of `gonzalez` is not kept.
    if (std::string_view(name) == "simo_tarnow_wong") CHECK(kept.angular_momentum_by_root < 8 * 1000 * rounding);
  }
}

/// The largest frequency of small motions, by the power method on differences of accelerations.
double fastest_of(const HyperelasticForce& force, const ParticleSystem<double>& s) {
  const Index n = s.size();
  const auto accelerations = [&](double sign, const VectorColumn<double>& way) {
    ParticleSystem<double> moved = s;
    for (Index i = 0; i < n; ++i) moved.positions().set(i, s.positions()[i] + sign * way[i]);
    VectorColumn<double> a(n);
    ForceSink<double> sink(a, moved, {});
    force.add_to(sink, moved);
    return a;
  };
  VectorColumn<double> way(n);
  for (Index i = 0; i < n; ++i) way.set(i, Vec3<double>(std::sin(3.0 * i), std::sin(5.0 * i), std::cos(7.0 * i)));
  double square = 0;
  for (int k = 0; k < 200; ++k) {
    way.all() *= 1e-5 / way.all().norm();
    VectorColumn<double> change = accelerations(1, way);
    change.all() -= accelerations(-1, way).all();
    square = change.all().norm() / (2 * way.all().norm());
    way = change;
  }
  return std::sqrt(square);
}

const Block bent_bar{.cells = {8, 2, 2}, .size = {4, 1, 1}, .density = 1, .bend = 0.3, .angular_velocity = {0.5, 0, 1}};

/// Follows the bar at h omega = 16; there is no oracle of it: what it keeps is known beforehand, after every step. Its
/// center of mass is off the center that it is turned about, so it goes away, and its places are rounded ever more.
Kept follow_bar(const MethodOptions& options, std::int64_t steps) {
  const double h = 16 / fastest_of(stiff, bent_bar.build());
  Kept kept = follow(classical_over(stiff, method("simo_tarnow_wong", options)), bent_bar.build(), h, steps);
  INFO((kept.failure ? kept.failure->message : std::string("no failure")) << " at step " << kept.steps);
  CHECK_FALSE(kept.failure);
  CHECK(kept.steps == steps);
  CHECK(kept.energy_by_root < 8 * rounding * 10);
  CHECK(kept.angular_momentum_by_root < 8 * rounding * 10);
  return kept;
}

TEST_CASE("a bent bar at h omega = 16 keeps energy and angular momentum, by sparse factors as by dense ones",
          "[hyperelastic][energy]") {
  const Kept kept = follow_bar({}, 12), sparse = follow_bar({.jacobian = JacobianForm::sparse}, 12);
  CHECK(farthest(kept.end, sparse.end) == 0);  // sparse by itself: 243 unknowns
  CHECK(farthest(kept.end, follow_bar({.jacobian = JacobianForm::dense}, 12).end) < 1e-12);
  CHECK(farthest(kept.end, bent_bar.build()) > 0.5);
}

TEST_CASE("a stiff block has the same steps for any number of threads", "[hyperelastic][energy]") {
  const auto block = Block{.cells = {6, 4, 2}, .size = {3, 2, 1}, .density = 1, .bend = 0.3}.build();
  const int before = thread_count();
  const auto by = [&](int threads) {
    set_thread_count(threads);
    return follow(classical_over(stiff, method("simo_tarnow_wong")), block, 0.05, 1).end;
  };
  const auto one = by(1), three = by(3);
  set_thread_count(before);
  CHECK(farthest(one, three) == 0);
  CHECK(farthest(one, block) > 0.01);
}

TEST_CASE("a bent bar at h omega = 16 keeps energy and angular momentum over 100000 steps",
          "[hyperelastic][energy][.nightly]") {
  const Kept kept = follow_bar({}, 100000);
  // A walk of roundings: far below what the steps would add up to.
  CHECK(kept.energy < 1e-12);
  CHECK(farthest(kept.end, bent_bar.build()) > 100);
}

TEST_CASE("implicit methods step a block by sparse factors as by dense ones", "[hyperelastic]") {
  const auto cube = turning_cube({1.05, 0.97, 1.02});
  for (const char* name : {"implicit_midpoint", "gauss_2", "newmark", "backward_euler", "bdf_2"}) {
    INFO(name);
    const auto by = [&](JacobianForm form) {
      MethodOptions options{.jacobian = form};
      if (methods::find(name)->adaptive) options.adaptive = false;
      return follow(classical_over(stiff, method(name, options)), cube, 0.02, 8);
    };
    const Kept dense = by(JacobianForm::dense), sparse = by(JacobianForm::sparse);
    CHECK_FALSE((dense.failure || sparse.failure));
    CHECK(farthest(dense.end, cube) > 0.05);
    CHECK(farthest(dense.end, sparse.end) < 1e-10);
  }
}

}  // namespace
}  // namespace noether
