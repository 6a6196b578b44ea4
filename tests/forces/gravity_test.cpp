#include "forces/gravity.hpp"

#include "forces/check_gradient.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace noether {
namespace {

/// Numbers in [-1, 1) from a multiplicative congruence: the same on every machine.
class Numbers {
 public:
  double next() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state_ >> 11U) * 0x1p-52 - 1;
  }

 private:
  std::uint64_t state_ = 1;
};

/// `n` particles in a cube; every fifth is a tracer.
ParticleSystem<double> cloud(Index n) {
  Numbers numbers;
  ParticleSystem<double> s;
  for (Index i = 0; i < n; ++i) {
    const Vec3<double> x(numbers.next(), numbers.next(), numbers.next());
    const double m = i % 5 == 4 ? 0 : 1 + 0.5 * numbers.next();
    s.add("p" + std::to_string(i), m, x, Vec3<double>::Zero());
  }
  return s;
}

struct Evaluation {
  VectorColumn<Quad> a;
  Quad energy{}, scale{};
  Mat3<Quad> virial = Mat3<Quad>::Zero();
};

/// The definition, term by term, in extended precision.
Evaluation naive(const ParticleSystem<double>& s, double G, double softening) {
  Evaluation sum{VectorColumn<Quad>(s.size())};
  const auto wide = s.as<Quad>();
  for (Index i = 0; i < s.size(); ++i) {
    for (Index j = 0; j < s.size(); ++j) {
      if (i == j) continue;
      const Vec3<Quad> d = wide.positions()[i] - wide.positions()[j];
      const Quad r = sqrt(norm2(d) + Quad(softening) * Quad(softening));
      const Vec3<Quad> a = -Quad(G) * wide.masses()[j] / (r * r * r) * d;
      sum.a.add(i, a);
      if (j > i) continue;
      const Quad u = Quad(G) * wide.masses()[i] * wide.masses()[j] / r;
      sum.energy -= u;
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) sum.virial(row, column) += wide.masses()[i] * d[row] * a[column];
      }
    }
    for (int k = 0; k < 3; ++k) sum.scale = std::max(sum.scale, Quad(abs(std::as_const(sum.a)[i][k])));
  }
  return sum;
}

template <class Real, class F> Evaluation evaluate(const F& force, const ParticleSystem<Real>& s, Request wanted) {
  VectorColumn<Real> a(s.size());
  ForceSink<Real> sink(a, s, wanted);
  force.add_to(sink, s);
  Evaluation result{VectorColumn<Quad>(s.size())};
  for (Index i = 0; i < s.size(); ++i) {
    for (int k = 0; k < 3; ++k) result.a[i][k] = Quad(a[i][k]);
  }
  result.energy = Quad(sink.potential());
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) result.virial(r, c) = Quad(sink.virial()(r, c));
  }
  return result;
}

/// Largest difference of accelerations over the largest acceleration.
double difference(const Evaluation& a, const Evaluation& b) {
  Quad worst(0);
  for (Index i = 0; i < a.a.size(); ++i) {
    for (int k = 0; k < 3; ++k) worst = std::max(worst, Quad(abs(a.a[i][k] - b.a[i][k])));
  }
  return static_cast<double>(worst / b.scale);
}

double relative(const Quad& a, const Quad& b) { return std::fabs(static_cast<double>((a - b) / b)); }

constexpr double ulp = 0x1p-53;

TEST_CASE("gravity is the sum over all pairs, below and above the size where loops change", "[gravity]") {
  for (const Index n : {2, 7, 255, 256, 301}) {
    for (const double softening : {0.0, 0.05}) {
      const auto s = cloud(n);
      const Gravity gravity{.G = 0.7, .softening = softening};
      const Evaluation exact = naive(s, 0.7, softening);
      const Evaluation got = evaluate(gravity, s, {.energy = true, .virial = true});
      const double allowed = 8 * std::sqrt(static_cast<double>(n)) * ulp;
      INFO("n " << n << " softening " << softening);
      CHECK(difference(got, exact) < allowed);
      CHECK(relative(got.energy, exact.energy) < allowed);
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
          CHECK(static_cast<double>(abs(got.virial(r, c) - exact.virial(r, c)) / abs(exact.virial.trace())) < allowed);
        }
      }
    }
  }
}

TEST_CASE("gravity in Quad is the same sum with 113 bits", "[gravity]") {
  const auto s = cloud(60);
  const Evaluation exact = naive(s, 0.7, 0.05);
  const Evaluation got = evaluate(Gravity{.G = 0.7, .softening = 0.05}, s.as<Quad>(), {.energy = true});
  CHECK(difference(got, exact) < 0x1p-105);
  CHECK(relative(got.energy, exact.energy) < 0x1p-105);
}

TEST_CASE("the bits of gravity are the same with and without energy and virial", "[gravity][determinism]") {
  for (const Index n : {40, 300}) {
    const auto s = cloud(n);
    const Gravity gravity{.G = 0.7};
    const Evaluation bare = evaluate(gravity, s, {});
    for (const Request wanted : {Request{true, false}, Request{false, true}, Request{true, true}}) {
      const Evaluation full = evaluate(gravity, s, wanted);
      CHECK((bare.a.all() == full.a.all()));
    }
    CHECK(bare.energy == Quad(0));
    CHECK((bare.virial == Mat3<Quad>::Zero()));
  }
}

TEST_CASE("the virial of a homogeneous potential of degree -1 has the energy as its trace", "[gravity]") {
  for (const Index n : {40, 300}) {
    const Evaluation got = evaluate(Gravity{.G = 1.0}, cloud(n), {.energy = true, .virial = true});
    CHECK(relative(got.virial.trace(), got.energy) < 64 * ulp);
    CHECK(got.energy < Quad(0));
  }
}

TEST_CASE("tracers feel gravity and exert none", "[gravity]") {
  for (const Index n : {9, 300}) {
    auto with = cloud(n);
    auto without = with;
    for (Index i = with.size() - 1; i >= 0; --i) {
      if (std::as_const(with).masses()[i] == 0) without.remove(i);
    }
    const Evaluation all = evaluate(Gravity{.G = 1.0}, with, {.energy = true});
    const Evaluation massive = evaluate(Gravity{.G = 1.0}, without, {.energy = true});
    const double allowed = 8 * std::sqrt(static_cast<double>(n)) * ulp;
    CHECK(relative(all.energy, massive.energy) < allowed);
    Index k = 0;
    for (Index i = 0; i < with.size(); ++i) {
      if (std::as_const(with).masses()[i] == 0) {
        CHECK(std::as_const(all.a)[i].norm() > Quad(0));
        continue;
      }
      CHECK((std::as_const(all.a)[i] - std::as_const(massive.a)[k]).norm() <= Quad(allowed) * all.a[i].norm());
      ++k;
    }
  }
}

TEST_CASE("gravity without a constant takes that of the unit system", "[gravity]") {
  ParticleSystem<double> s(unit_system("solar"));
  s.add("a", 1.0, {0, 0, 0}, {0, 0, 0});
  s.add("b", 0.0, {2, 0, 0}, {0, 0, 0});
  const Evaluation got = evaluate(Gravity{}, s, {});
  CHECK(std::as_const(got.a)[1][0] == Quad(-units::solar::G / 4));
  const Evaluation given = evaluate(Gravity{.G = 4.0}, s, {});
  CHECK(std::as_const(given.a)[1][0] == Quad(-1));
}

TEST_CASE("gravity is minus the gradient of its energy, softened or not", "[gravity]") {
  CHECK_NOTHROW(check_gradient(Gravity{.G = 1.0}, cloud(6)));
  CHECK_NOTHROW(check_gradient(Gravity{.G = 1.0, .softening = 0.3}, cloud(6)));
  CHECK(gradient_error(Gravity{.G = 1.0, .softening = 0.3}, cloud(6)) < 1e-18);
}

/// Gravity with its sign or its factor wrong.
struct Wrong {
  double factor;
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    Gravity{.G = 1.0}.add_to(out, s);
    out.energy((Real(factor) - Real(1)) * out.potential());
  }
};

TEST_CASE("a wrong sign or factor of a force is found by its gradient", "[gravity]") {
  CHECK_NOTHROW(check_gradient(Wrong{1}, cloud(4)));
  CHECK_THROWS_AS(check_gradient(Wrong{-1}, cloud(4)), Error);
  CHECK_THROWS_AS(check_gradient(Wrong{1 + 1e-10}, cloud(4)), Error);
}

}  // namespace
}  // namespace noether
