// Orders by Taylor series: every scheme, of every class, against the exact flow of random quartic Hamiltonians.

#include "tests/support/jet.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "tests/support/catch.hpp"

#include <string>

namespace noether::test {
namespace {

/// Above what printed digits leave in any table (yoshida_8_c: 2e-12), below every first error (srkn14a: 4e-6).
constexpr double tolerance = 1e-10;

TEST_CASE("in its class every scheme departs from the exact flow at the power after its order", "[schemes]") {
  for (const Scheme* scheme : schemes::all()) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      CAPTURE(std::string(scheme->name), seed);
      const auto error = local_error(scheme->word, QuarticModel(seed));
      CHECK(order_of(error, Quad(tolerance)) == scheme->order.classical);
    }
  }
}

TEST_CASE("where the kinetic energy is not quadratic only schemes outside their class lose order", "[schemes]") {
  for (const Scheme* scheme : schemes::all()) {
    CAPTURE(std::string(scheme->name));
    const auto error = local_error(scheme->word, QuarticModel(4, 0.25));
    CHECK(order_of(error, Quad(tolerance)) == scheme->order.any_splitting());
  }
}

/// The random quartic potential as a force on one particle in the plane, in the unit of time h: a = -h^2 U'(x).
class QuarticForce {
 public:
  explicit QuarticForce(std::uint64_t seed) : model_(seed) {}

  template <class Real> void add_to(ForceSink<Real>& sink, const ParticleSystem<Real>& s) const {
    const Vec3<Real> x = s.positions()[0];
    const auto f = model_.force(std::array<Real, 2>{x[0], x[1]});
    const Real h2 = Real::variable() * Real::variable();
    sink.acceleration(0, Vec3<Real>(h2 * f[0], h2 * f[1], Real(0)));
  }

 private:
  QuarticModel model_;
};

TEST_CASE("the composition that runs simulations departs from the exact flow at the power after its order",
          "[schemes]") {
  using J = Jet<jet_degree>;
  const auto start = generic_start<J>();
  const auto exact = taylor_flow(QuarticModel(5), start);
  for (const Scheme* scheme : schemes::all()) {
    CAPTURE(std::string(scheme->name));
    ParticleSystem<J> s;
    const J h = J::variable();
    s.add("one", J(1), Vec3<J>(start.q[0], start.q[1], J(0)), Vec3<J>(h * start.p[0], h * start.p[1], J(0)));
    s.clock() = Clock<J>::fixed(0, 1);
    Composition composition(KineticPotential<QuarticForce, J>(QuarticForce(5)), *scheme);
    composition.bind(s);
    composition.advance(s, {.steps = 2});
    ParticleSystem<J> settled = s;
    composition.settle(s, settled, {}, {}, true);
    std::array<Quad, jet_degree + 1> error{};
    Quad power = 1;  // the exact flow over 2 h
    for (std::size_t k = 0; k <= jet_degree; ++k, power *= 2) {
      for (const std::size_t i : {0U, 1U}) {
        const auto axis = static_cast<Index>(i);
        error[k] = std::max(error[k], abs(settled.positions()[0][axis][k] - power * exact.q[i][k]));
        if (k == jet_degree) continue;  // v = h p: the last power of p is lost
        error[k] = std::max(error[k], abs(settled.velocities()[0][axis][k + 1] - power * exact.p[i][k]));
      }
    }
    CHECK(order_of(error, Quad(1e3 * tolerance)) == scheme->order.classical);
  }
}

TEST_CASE("jets obey the rules of power series", "[schemes]") {
  using J = Jet<6>;
  const J h = J::variable();
  const J x = 2 + 3 * h - h * h * Quad(0.5);
  CHECK((x / x) == J(1));
  CHECK((x - x) == J(0));
  const J geometric = 1 / (1 - h);
  for (std::size_t k = 0; k < J::terms; ++k) CHECK(geometric[k] == Quad(1));
  const J root = sqrt(1 + h);  // binomial series
  const double binomial[] = {1, 0.5, -0.125, 0.0625, -0.0390625, 0.02734375, -0.0205078125};
  for (std::size_t k = 0; k < J::terms; ++k) CHECK(root[k] == Quad(binomial[k]));
  CHECK(root * root == 1 + h);
  CHECK(integral(geometric)[5] == Quad(1) / Quad(5));
}

}  // namespace
}  // namespace noether::test
