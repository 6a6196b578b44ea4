/// The shearing sheet in a box: images that slide, gravity through them, and bits that know no place of the cut.

#include "integrators/sheared_box.hpp"
#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/shearing_sheet.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/sheets.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace noether {
namespace {

const Vec3<double> edges(3, 2, 8);

/// Stones of several masses, a tracer among them, no two of them half an edge apart; all numbers have few digits, so
/// that w is exact wherever they stand.
/// @param cut  those with x below it stand in the next cell along x, and below half of it in the next along y
ParticleSystem<double> stones(double cut = 0, int count = 40) {
  ParticleSystem<double> s(unit_system("reduced"));
  s.set_box(Box::periodic(edges));
  const auto place = [](int k, int factor, double edge) { return edge * ((k * factor) % 64 + k / 64.0) / 64; };
  for (int k = 0; k < count; ++k) {
    Vec3<double> x(place(k, 27, edges[0]), place(k, 11, edges[1]), 0.125 * ((k % 5) - 2));
    Vec3<double> v(0.0625 * ((k * 5) % 7 - 3), 0.0625 * ((k * 3) % 5 - 2) - 1.5 * x[0], 0.03125 * (k % 3 - 1));
    if (x[0] < cut) {
      x[0] += edges[0];
      v[1] -= 1.5 * edges[0];
    }
    if (x[1] < cut / 2) x[1] += edges[1];
    s.add("", k % 8 == 7 ? 0 : 0.001 * (1 + k % 4), x, v);
  }
  return s;
}

/// The nearest of the images of a length.
Quad reduced(Quad d, double edge) { return d - Quad(edge) * detail::nearest_whole(Quad(d / Quad(edge))); }

}  // namespace

TEST_CASE("a free particle in a sheared box is where its epicycle is", "[integrators][shearing_sheet]") {
  // Far out on an epicycle that crosses both edges in x, and drifts through the cell along y hundreds of times.
  const ShearingSheetOptions frame{.Omega = 0.75, .Omega_z = 1.5};
  for (const Scheme* scheme : {&schemes::verlet, &schemes::verlet_aba, &schemes::yoshida_4, &schemes::aba_8_6_4}) {
    for (const double h : {0.125, 5.0}) {  // the second one beyond half a turn
      INFO(scheme->name << " with steps of " << h);
      ParticleSystem<double> open(unit_system("reduced"));
      open.add("stone", 1, {1, 0.5, 0.25}, {1.5, 0.25, -0.5});
      open.add("stone", 1, {-4, 0.5, 0.25}, {1.5, 4, -0.5});
      ParticleSystem<double> boxed = open;
      boxed.set_box(Box::periodic(edges));
      const int steps = 800;
      const auto exact = test::run(test::sheet<Quad>(frame), *scheme, open.as<Quad>(), h, steps);
      const auto found = test::run(test::sheet<double>(frame), *scheme, boxed, h, steps);
      int crossings = 0;
      for (Index i = 0; i < found.size(); ++i) {
        const Vec3<double> x = found.unwrapped(i), v = found.velocities()[i], in_cell = found.positions()[i];
        const Vec3<Quad> at = exact.positions()[i], velocity = exact.velocities()[i];
        CHECK(std::abs(static_cast<double>(Quad(x[0]) - at[0])) <= 1e-11);
        CHECK(std::abs(static_cast<double>(Quad(x[2]) - at[2])) <= 1e-11);
        for (int k = 0; k < 3; ++k) CHECK(std::abs(static_cast<double>(Quad(v[k]) - velocity[k])) <= 1e-11);
        // The image in the cell has slid as often as the particle has crossed it.
        const int cells = found.images().component(0)[i];
        const Quad slid = Quad(1.5 * frame.Omega) * Quad(h) * Quad(steps) * Quad(edges[0]) * Quad(cells);
        CHECK(std::abs(static_cast<double>(reduced(at[1] + slid - Quad(in_cell[1]), edges[1]))) <= 1e-8 * h);
        CHECK((in_cell[0] >= 0 && in_cell[0] < edges[0] && in_cell[1] >= 0 && in_cell[1] < edges[1]));
        crossings += std::abs(cells);
      }
      CHECK(crossings > 0);
    }
  }
}

TEST_CASE("gravity in a sheared box is that of nine images", "[integrators][shearing_sheet]") {
  // A plain sum over images in 113 bits, each from its own place.
  const ShearingSheetOptions frame{.Omega = 0.75, .Omega_z = 0};
  const Gravity gravity{.G = 1, .softening = 0.01};
  for (const double time : {0.0, 0.7, 250.3}) {
    auto s = stones();
    s.clock() = Clock<double>::fixed(time, 0.1);
    auto hamiltonian = test::sheet<double>(frame, gravity);
    hamiltonian.bind(s);
    VectorColumn<double> a(s.size());
    hamiltonian.accelerations(s, a);
    const double potential = hamiltonian.energy(s).potential;
    Quad energy(0);
    double worst = 0, largest = 0;
    Vec3<double> momentum = Vec3<double>::Zero();
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<double> xi = std::as_const(s).positions()[i];
      Vec3<Quad> sum = HillFrame{frame.Omega, 0}.acceleration(
          s.unwrapped(i).cast<Quad>().eval(), Vec3<double>(std::as_const(s).velocities()[i]).cast<Quad>().eval());
      Vec3<double> pull = a[i];
      for (Index j = 0; j < s.size(); ++j) {
        if (i == j) continue;
        const Vec3<double> xj = std::as_const(s).positions()[j];
        const Quad near = reduced(Quad(xj[0]) - Quad(xi[0]), edges[0]),
                   cells = (near - Quad(xj[0]) + Quad(xi[0])) / Quad(edges[0]);
        for (int across = -1; across <= 1; ++across) {
          const Quad x = near + Quad(across * edges[0]), slid = Quad(1.5 * frame.Omega) * Quad(time) * Quad(edges[0]);
          const Quad y0 = reduced(Quad(xj[1]) - Quad(xi[1]) - slid * (cells + Quad(across)), edges[1]);
          for (int along = -1; along <= 1; ++along) {
            const Vec3<Quad> d(x, y0 + Quad(along * edges[1]), Quad(s.unwrapped(j)[2] - s.unwrapped(i)[2]));
            const Quad r2 = norm2(d) + Quad(1e-4), r = sqrt(r2);
            sum += Quad(s.masses()[j]) / (r2 * r) * d;
            energy -= Quad(s.masses()[i] * s.masses()[j]) / r / Quad(2);
          }
        }
      }
      for (int k = 0; k < 3; ++k) {
        worst = std::max(worst, std::abs(static_cast<double>(sum[k] - Quad(pull[k]))));
        largest = std::max(largest, std::abs(static_cast<double>(sum[k])));
      }
      energy += Quad(s.masses()[i]) * HillFrame{frame.Omega, 0}.potential(s.unwrapped(i).cast<Quad>().eval());
      momentum += s.masses()[i] * (pull - HillFrame{frame.Omega, 0}.acceleration(
                                              s.unwrapped(i), Vec3<double>(std::as_const(s).velocities()[i])));
    }
    INFO("at time " << time);
    CHECK(worst <= (time < 10 ? 1e-12 : 1e-10) * largest);
    CHECK(std::abs(static_cast<double>(Quad(potential) - energy)) <= 1e-11 * std::abs(static_cast<double>(energy)));
    CHECK(momentum.cwiseAbs().maxCoeff() <= 1e-15);
  }
}

TEST_CASE("where a sheared box is cut does not change a bit", "[integrators][shearing_sheet]") {
  // The same stones, some of them given by their images: in x with the velocity of the image, in y.
  const Gravity gravity{.G = 1, .softening = 0.01};
  for (const Scheme* scheme : {&schemes::verlet, &schemes::yoshida_4}) {
    const auto whole = test::run(test::sheet<double>({}, gravity), *scheme, stones(), 0.0625, 400);
    int moved = 0;
    for (const double cut : {1.0, 2.5}) {
      const auto other = test::run(test::sheet<double>({}, gravity), *scheme, stones(cut), 0.0625, 400);
      CHECK((whole.positions().all() == other.positions().all()));
      for (Index i = 0; i < whole.size(); ++i) {
        const Vec3<double> v = whole.velocities()[i], w = other.velocities()[i];
        CHECK(v[0] == w[0]);
        CHECK(v[2] == w[2]);
        const int cells = other.images().component(0)[i] - whole.images().component(0)[i];
        CHECK(std::abs(v[1] - (w[1] + 1.5 * edges[0] * cells)) <= 1e-14);
        moved += cells;
      }
    }
    CHECK(moved > 20);
  }
}

TEST_CASE("schemes keep their order in a sheared box", "[integrators][shearing_sheet]") {
  // Three bodies of which none comes to where another image of a pair becomes the nearest one.
  ParticleSystem<double> s(unit_system("reduced"));
  s.set_box(Box::periodic({8, 16, 8}));
  s.add("a", 0.5, {3.5, 4, 0.25}, {0.125, -0.65625, 0});
  s.add("b", 0.25, {4.25, 4.5, 0}, {0, -0.796875, 0.125});
  s.add("c", 0.25, {4, 3.25, -0.125}, {-0.25, -0.75, 0});
  const auto end = [&](const Scheme& scheme, int steps) {
    return test::run(test::sheet<Quad>({.Omega = 0.125}, Gravity{.G = 1, .softening = 0.25}), scheme, s.as<Quad>(),
                     1.5 / steps, steps);
  };
  const auto exact = end(schemes::sofroniou_spaletta_10_s35, 128);
  const auto order = [&](const Scheme& scheme, int steps = 48) {
    return std::log2(test::distance(end(scheme, steps), exact) / test::distance(end(scheme, 2 * steps), exact));
  };
  CHECK(std::abs(order(schemes::verlet) - 2) <= 0.1);
  CHECK(std::abs(order(schemes::verlet_aba) - 2) <= 0.1);
  CHECK(std::abs(order(schemes::yoshida_4) - 4) <= 0.15);
  CHECK(std::abs(order(*schemes::find("yoshida_6"), 64) - 6) <= 0.15);
  CHECK(std::abs(order(*schemes::find("blanes_moan_s10"), 64) - 6) <= 0.15);
  // Doubles follow: positions on the grid of the box, velocities rounded.
  const auto in_doubles = test::run(test::sheet<double>({.Omega = 0.125}, Gravity{.G = 1, .softening = 0.25}),
                                    schemes::verlet, s, 1.5 / 96, 96);
  CHECK(test::distance(in_doubles.as<Quad>(), end(schemes::verlet, 96)) <= 1e-13);
}

TEST_CASE("in a sheared box: threads, cadences, and a save in between", "[integrators][shearing_sheet]") {
  const auto start = [] {
    return Simulation<double>(stones(0, 700),
                              compose(test::sheet<double>({}, Gravity{.G = 1, .softening = 0.02}), schemes::verlet_aba),
                              0.0625);
  };
  const int before = thread_count();
  set_thread_count(1);
  auto alone = start();
  REQUIRE(alone.run(8).ok());
  const auto expected = alone.particles();
  CHECK(alone.evaluations().force == 8);
  for (const int threads : {2, 3}) {
    set_thread_count(threads);
    auto sim = start();
    for (const int piece : {1, 3, 4}) {
      REQUIRE(sim.run(piece).ok());
      const auto seen = sim.particles();  // a settled copy
      const SavedRun saved = sim.save();
      sim = start();
      sim.restore(saved);
    }
    CHECK((sim.particles().positions().all() == expected.positions().all()));
    CHECK((sim.particles().velocities().all() == expected.velocities().all()));
  }
  set_thread_count(before);
}

TEST_CASE("what a sheared box does not know is refused", "[integrators][shearing_sheet]") {
  auto s = stones();
  auto spring = test::sheet<double>({}, HarmonicField{.k = 1});
  CHECK_THROWS_WITH(spring.bind(s),
                    "in the box of a shearing sheet images slide, which gravity alone knows of the forces; take the "
                    "others out, or the box");
  auto both = test::sheet<double>({}, Gravity{}, HarmonicField{.k = 1});
  CHECK_THROWS_WITH(both.bind(s),
                    "in the box of a shearing sheet images slide, which gravity alone knows of the forces; take the "
                    "others out, or the box");
  auto dragged = test::damped(test::sheet<double>({}), LinearDrag{.rate = 0.1});
  CHECK_THROWS_WITH(test::run(dragged, schemes::verlet, s, 0.1, 1),
                    "in the box of a shearing sheet there are no letters beside A and B; take drag and baths out");
}

}  // namespace noether
