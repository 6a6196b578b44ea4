#pragma once
/// Runs whose particles keep second words, against 113 bits.

#include "engine/particle_system.hpp"
#include "integrators/classical.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"

#include <algorithm>
#include <cstdint>

namespace noether::test {

/// Positions and velocities of both words.
struct Words {
  Vec3<Quad> x, v;
};
inline Words words_of(const ParticleSystem<double>& s, Index i) {
  REQUIRE(s.low_words() != nullptr);
  const auto& low = *s.low_words();
  return {s.positions()[i].cast<Quad>() + low.x[i].cast<Quad>(),
          s.velocities()[i].cast<Quad>() + low.v[i].cast<Quad>()};
}

/// The same run in 113 bits, by steps of Gauss's method that are `parts` times shorter.
template <class... Fs>
ParticleSystem<Quad> truth_of(const ParticleSystem<double>& start, double h, int steps, int parts, Fs... forces) {
  auto gauss = classical_over(field_of<Quad>(std::move(forces)...), method("gauss_8", {.adaptive = false}));
  return run(gauss, start.as<Quad>(), h / parts, std::int64_t{steps} * parts);
}

/// Largest distance of a body from the truth, relative to where it is.
inline double worst_error(const ParticleSystem<double>& s, const ParticleSystem<Quad>& truth) {
  double worst = 0;
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<Quad> right = truth.positions()[i], off = words_of(s, i).x - right;
    worst = std::max(worst, static_cast<double>(sqrt(norm2(off) / norm2(right))));
  }
  return worst;
}

/// The energy of gravity in 113 bits, of both words.
inline Quad energy_of(const ParticleSystem<double>& s, double G) {
  Quad sum(0);
  for (Index i = 0; i < s.size(); ++i) {
    sum += Quad(s.masses()[i]) * norm2(words_of(s, i).v) / Quad(2);
    for (Index j = 0; j < i; ++j) {
      const Vec3<Quad> d = words_of(s, i).x - words_of(s, j).x;
      sum -= Quad(G) * Quad(s.masses()[i]) * Quad(s.masses()[j]) / sqrt(norm2(d));
    }
  }
  return sum;
}

/// A weak pull to the origin that cannot be computed beyond some time.
struct EndingField {
  double end = 0;

  static ForceClaims claims() {
    return {.energy = false, .time_dependent = true, .keeps_momentum = false, .keeps_angular_momentum = false};
  }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    if (s.time() > Real(end)) out.fail({Outcome::Kind::overlap, 1, "position", "the field has ended"});
    for (Index i = 0; i < s.size(); ++i) out.acceleration(i, Real(-1e-12) * Vec3<Real>(s.positions()[i]));
  }
};

}  // namespace noether::test
