// Diffusion: closed forms of free flight, oscillators and Brownian motion; saved runs; who looks.

#include "monitors/time_correlation.hpp"

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/langevin.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/refusal.hpp"

#include <cmath>
#include <numbers>
#include <string>

namespace noether {
namespace {

/// Two pairs that fly apart in a small box, and drift together.
ParticleSystem<double> flight() {
  ParticleSystem<double> s;
  s.set_box(Box::periodic({1, 2, 4}));
  auto topology = std::make_shared<Topology>();
  topology->type_names = {"slow", "fast"};
  topology->types = {0, 0, 1, 1};
  const Vec3<double> drift(0.5, -0.25, 8);
  s.add("", 1, {0.25, 0.5, 0.75}, drift + Vec3<double>(1, 0, 0));
  s.add("", 1, {0.75, 0.5, 0.75}, drift - Vec3<double>(1, 0, 0));
  s.add("", 2, {0.25, 1.5, 0.75}, drift + Vec3<double>(0, 3, 4));
  s.add("", 2, {0.5, 1.5, 0.75}, drift - Vec3<double>(0, 3, 4));
  s.set_topology(topology);
  return s;
}

template <class Real = double> Simulation<Real> flying(double dt = 0.125) {
  return Simulation<Real>(flight().as<Real>(), compose(test::kinetic_potential<Real>(), schemes::verlet), dt);
}

/// Free particles in a bath at kT = 0.5: D = kT / (m friction), C(t) = 3 kT / m exp(-friction t).
Simulation<double> brownian(Index n) {
  ParticleSystem<double> s;
  for (Index i = 0; i < n; ++i) s.add("", 2, {0, 0, 0}, {0, 0, 0});
  return Simulation<double>(
      std::move(s),
      compose(test::in_bath(test::field_of(), {.temperature = 0.5, .friction = 4, .seed = 3}), word("BAOAB")), 0.05);
}

}  // namespace

TEMPLATE_TEST_CASE("in free flight the mean square displacement is v^2 t^2, across the box and without its drift",
                   "[time_correlation]", double, Quad) {
  auto sim = flying<TestType>();
  auto& msd = sim.every(2, MeanSquareDisplacement(8, 3));
  REQUIRE(sim.run(100).ok());
  const std::vector<double> values = msd.values(), lags = msd.lags();
  REQUIRE(values.size() == 9);
  for (std::size_t k = 0; k < 9; ++k) {
    const double t = 0.25 * static_cast<double>(k);
    CHECK(std::abs(lags[k] - t) < 1e-14);
    CHECK(std::abs(values[k] - (1 + 1 + 25 + 25) / 4.0 * t * t) < 1e-12);
  }
  CHECK(std::abs(msd.since_start() - 13 * 12.5 * 12.5) < 1e-9);
  // A straight line through 13 t^2 at t = 1, 1.25, ..., 2 has the slope 2 * 13 * 1.5.
  CHECK(std::abs(*msd.diffusion_coefficient() - 39 / 6.0) < 1e-12);
  // 51 looks: origins 0, 3, ..., 42 have been followed for 8, and all say the same.
  const MonitorReport report = msd.report();
  CHECK(report.samples == 51);
  CHECK(std::abs(*report.slope - 39) < 1e-11);
  CHECK(*report.slope_error < 1e-12);
  CHECK(report.note.find("D = 6.5 +- ") == 0);
  CHECK(report.note.find(" from slope / 6 of 15 origins") != std::string::npos);
}

TEST_CASE("lags are as long where time falls", "[time_correlation]") {
  auto sim = flying(-0.125);
  auto& msd = sim.every(2, MeanSquareDisplacement(8, 3));
  auto& vacf = sim.every(2, VelocityAutocorrelation(8, 3));
  REQUIRE(sim.run(100).ok());
  for (std::size_t k = 0; k < 9; ++k) CHECK(std::abs(msd.lags()[k] - 0.25 * static_cast<double>(k)) < 1e-14);
  CHECK(std::abs(*msd.diffusion_coefficient() - 39 / 6.0) < 1e-12);
  CHECK(std::abs(*vacf.diffusion_coefficient() - 13 * 2 / 3.0) < 1e-12);  // C(t) = 13 to t = 2
}

TEST_CASE("displacements are averaged over the types that are asked for", "[time_correlation]") {
  auto sim = flying();
  auto& slow = sim.every(1, MeanSquareDisplacement(4, 1, {"slow"}));
  auto& fast = sim.every(1, MeanSquareDisplacement(4, 1, {"fast"}));
  REQUIRE(sim.run(10).ok());
  CHECK(std::abs(slow.values()[4] - 0.25) < 1e-14);
  CHECK(std::abs(fast.values()[4] - 6.25) < 1e-13);
}

TEST_CASE("the velocity autocorrelation of oscillators is their cosine, and its integral their sine",
          "[time_correlation]") {
  // Two that start in the origin with opposite velocities: C(t) = v^2 cos(w t) from the one origin of time.
  ParticleSystem<double> s;
  s.add("", 1, {0, 0, 0}, {3, 0, 4});
  s.add("", 1, {0, 0, 0}, {-3, 0, -4});
  Simulation<double> sim(s, compose(test::kinetic_potential(HarmonicField{.k = 4}), schemes::yoshida_8), 0.01);
  auto& vacf = sim.every(1, VelocityAutocorrelation(100, 1000));
  REQUIRE(sim.run(150).ok());
  const std::vector<double> C = vacf.values();
  for (std::size_t k = 0; k <= 100; ++k) {
    CHECK(std::abs(C[k] - 25 * std::cos(2 * 0.01 * static_cast<double>(k))) < 1e-12);
  }
  // Trapezoids of a cosine: its integral times (w h / 2) / tan(w h / 2).
  CHECK(std::abs(*vacf.diffusion_coefficient() - 25 * std::sin(2.0) / 2 / 3 * 0.01 / std::tan(0.01)) < 1e-12);
  CHECK_FALSE(vacf.diffusion_error());
  CHECK(*vacf.report().first == 25);
  CHECK(vacf.report().note.find("D = 3.78") == 0);
}

TEST_CASE("Brownian motion has the diffusion coefficient of Einstein, both ways, within the errors told",
          "[time_correlation]") {
  auto sim = brownian(200);
  REQUIRE(sim.run(100).ok());  // until it has forgotten the start
  auto& msd = sim.every(4, MeanSquareDisplacement(50, 10));
  auto& vacf = sim.every(1, VelocityAutocorrelation(60, 20));
  REQUIRE(sim.run(2000).ok());
  const double D = 0.5 / (2 * 4), n = 200;
  for (const TimeCorrelation* one : {static_cast<TimeCorrelation*>(&msd), static_cast<TimeCorrelation*>(&vacf)}) {
    REQUIRE(one->diffusion_error());
    const double error = *one->diffusion_error();
    CAPTURE(*one->diffusion_coefficient(), error);
    CHECK(error < 0.1 * D);
    CHECK(error > 0.001 * D);
    CHECK(std::abs(*one->diffusion_coefficient() - D * (n - 1) / n) < 4 * error + 0.01 * D);
  }
  const std::vector<double> C = vacf.values();
  for (const std::size_t k : {0U, 2U, 5U, 10U}) {
    CAPTURE(k);
    CHECK(std::abs(C[k] - 0.75 * (n - 1) / n * std::exp(-4 * 0.05 * static_cast<double>(k))) < 0.02);
  }
}

TEST_CASE("correlations are those of all origins, one by one", "[time_correlation]") {
  // Velocities of a noisy run, kept by hand.
  auto sim = brownian(20);
  auto& vacf = sim.every(1, VelocityAutocorrelation(7, 3));
  auto& msd = sim.every(1, MeanSquareDisplacement(7, 3));
  std::vector<VectorColumn<double>> v, x;
  for (int n = 0; n <= 50; ++n) {
    REQUIRE(sim.run(n == 0 ? 0 : 1).ok());
    const ParticleSystem<double>& s = sim.particles();
    v.push_back(s.velocities());
    x.push_back(s.positions());
    Vec3<double> mean_v = Vec3<double>::Zero(), mean_x = Vec3<double>::Zero();
    for (Index i = 0; i < 20; ++i) {
      mean_v += s.velocities()[i] / 20;
      mean_x += s.positions()[i] / 20;
    }
    for (Index i = 0; i < 20; ++i) {
      v.back().add(i, -mean_v);
      x.back().add(i, -mean_x);
    }
  }
  for (std::size_t lag = 0; lag <= 7; ++lag) {
    double C = 0, square = 0;
    int origins = 0;
    for (std::size_t t0 = 0; t0 + lag <= 50; t0 += 3, ++origins) {
      C += v[t0].all().cwiseProduct(v[t0 + lag].all()).sum() / 20;
      square += (x[t0].all() - x[t0 + lag].all()).squaredNorm() / 20;
    }
    CAPTURE(lag);
    CHECK(std::abs(vacf.values()[lag] - C / origins) < 1e-13);
    CHECK(std::abs(msd.values()[lag] - square / origins) < 1e-13);
  }
}

TEST_CASE("correlations go on from a saved run bit for bit", "[time_correlation][restart]") {
  for (const std::int64_t half : {0, 5, 23, 40}) {
    CAPTURE(half);
    auto whole = brownian(10), first = brownian(10), second = brownian(10);
    auto& msd = whole.every(2, MeanSquareDisplacement(6, 4));
    auto& vacf = whole.every(1, VelocityAutocorrelation(9, 2));
    first.every(2, MeanSquareDisplacement(6, 4));
    first.every(1, VelocityAutocorrelation(9, 2));
    auto& msd_again = second.every(2, MeanSquareDisplacement(6, 4));
    auto& vacf_again = second.every(1, VelocityAutocorrelation(9, 2));
    REQUIRE(whole.run(80).ok());
    REQUIRE(first.run(half).ok());
    second.restore(first.save());
    REQUIRE(second.run(80 - half).ok());
    CHECK(msd.values() == msd_again.values());
    CHECK(msd.lags() == msd_again.lags());
    CHECK(msd.since_start() == msd_again.since_start());
    CHECK(msd.report().note == msd_again.report().note);
    CHECK(vacf.values() == vacf_again.values());
    CHECK(vacf.diffusion_coefficient() == vacf_again.diffusion_coefficient());
    CHECK(vacf.diffusion_error() == vacf_again.diffusion_error());
  }
}

TEST_CASE("what was saved of correlations must fit", "[time_correlation][restart]") {
  auto sim = brownian(3);
  auto& msd = sim.every(1, MeanSquareDisplacement(6, 4));
  REQUIRE(sim.run(9).ok());
  SavedState saved;
  detail::save_any(saved, "m", msd);
  const auto loads = [&](SavedState state) {
    MeanSquareDisplacement other = MeanSquareDisplacement(6, 4);
    return test::refusal_of([&] { other.load(state, "m"); });
  };
  CHECK(loads(saved).empty());
  SavedState shorter = saved;
  shorter["m/sums"] = std::vector<double>(3);
  CHECK(loads(shorter) == "the saved origins of a time correlation are inconsistent");
  SavedState later = saved;
  later["m/looks"] = std::vector<std::int64_t>{1000};
  CHECK(loads(later) == "the saved origins of a time correlation are inconsistent");
}

TEST_CASE("before an origin has been followed to the end there is no diffusion coefficient", "[time_correlation]") {
  auto sim = flying();
  auto& msd = sim.every(1, MeanSquareDisplacement(20, 5));
  REQUIRE(sim.run(10).ok());
  CHECK_FALSE(msd.diffusion_coefficient());
  CHECK(msd.report().reason == "no diffusion coefficient: no origin has been followed for 20 samples");
  CHECK(std::isnan(msd.values()[11]));
  CHECK(msd.values()[10] > 0);
  const std::vector<Series> series = msd.series();
  CHECK(series[0].name == "lag");
  CHECK(series[1].shape == std::vector<Index>{21});
  CHECK(std::isnan(series[2].values[0]));
  CHECK(series[3].values[0] == msd.since_start());
}

TEST_CASE("an edit of the particles begins anew", "[time_correlation]") {
  auto sim = brownian(4);
  auto& msd = sim.every(1, MeanSquareDisplacement(6, 2));
  REQUIRE(sim.run(4).ok());
  sim.edit([](ParticleSystem<double>& s) { s.remove(0); });
  REQUIRE(sim.run(10).ok());
  CHECK(msd.report().samples == 15);
}

TEST_CASE("correlations of nobody, or to no lag, are refused", "[time_correlation][messages]") {
  const auto refusal = [](const MeanSquareDisplacement& asked) {
    return test::refusal_of([&] { flying().every(1, asked); });
  };
  CHECK(refusal(MeanSquareDisplacement(1, 1)) ==
        "length = 1 is not a valid longest lag; 2 to 1000000 samples are expected");
  CHECK(refusal(MeanSquareDisplacement(5, 0)) ==
        "origins = 0 is not a valid number of samples between origins; at least 1 is expected");
  CHECK(refusal(MeanSquareDisplacement(5, 1, {"fats"})) == "unknown type 'fats' to average over; did you mean 'fast'?");
}

}  // namespace noether
