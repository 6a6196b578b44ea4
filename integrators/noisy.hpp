#pragma once
/// A Hamiltonian with noise as one more letter, whose noise is a function of the step and of its place in the word.

#include "engine/erasure.hpp"
#include "engine/word.hpp"
#include "integrators/wrapped.hpp"

#include <cstdint>
#include <string>
#include <utility>

namespace noether {

/// Around a Hamiltonian: finds out which noise each flow of the letter `letter` takes. A bath derives from it, and has
///
///     void mix(ParticleSystem<real>& s, const real& h, std::int64_t step, std::uint32_t stage);
///
/// its flow for the time h with the noise of a step and a place in the word, 0 to 127. Where the last such flow of a
/// step is joined with the first of the next both are done, one after the other, so that a copy completed for an
/// observer has the noise of the run.
template <class Bath, SplitHamiltonian H, char letter> class Noisy : public Wrapped<H> {
 public:
  using real = typename H::real;
  using Wrapped<H>::Wrapped;

  /// @throws Error  for particles without mass, which no bath can warm, for steps backwards, and coordinates that are
  /// not inertial
  void bind(ParticleSystem<real>& s) {
    for (Index i = 0; i < s.size(); ++i) {
      if (s.masses()[i] != real(0)) continue;
      throw Error("'" + s.name(i) +
                  "' has no mass, so it has no temperature; give it a mass, or take the thermostat out");
    }
    if (s.clock().dt() < 0) throw Error("a thermostat cannot go back in time; a step above 0 is expected");
    hamiltonian_.bind(s);
    if (!hamiltonian_.claims().inertial) {
      throw Error("'" + detail::name_of(hamiltonian_) +
                  "' uses its own coordinates, where noise is not that of particles; put the thermostat around "
                  "kinetic_potential");
    }
  }
  /// Whole steps; only here the place of a letter in the word is known.
  Advance run(const TimedWord<real>& word, ParticleSystem<real>& s, const Span& span) {
    const real dt(s.clock().dt());
    std::int64_t step = -1;
    std::uint32_t place = 0;
    return walk_letters(bath(), word, s, span, [&](char now_letter, const real& h) {
      const std::int64_t now = s.clock().step();
      if (std::exchange(step, now) != now) place = 0;
      const std::uint32_t stage = place++;
      if (now_letter != letter) return hamiltonian_.flow(now_letter, s, h);
      if (stage != 0 || !s.phase().pending) return bath().mix(s, h, now, stage);
      bath().mix(s, word.stages().back().weight * dt, now - 1, last_stage);
      bath().mix(s, word.stages().front().weight * dt, now, 0);
    });
  }
  /// A letter by itself: of those with noise the pending one, which completes the last step.
  void flow(char one, ParticleSystem<real>& s, const real& h) {
    if (one != letter) return hamiltonian_.flow(one, s, h);
    NOETHER_EXPECTS(s.phase().pending, "noise is drawn by whole steps: it is not known which of its step this is");
    bath().mix(s, h, s.clock().step() - 1, last_stage);
  }
  /// @throws LogicError  for the letter of the noise, which has no action
  real flow_with_action(char one, ParticleSystem<real>& s, const real& h) {
    NOETHER_EXPECTS(one != letter, "the irreversible flow of a bath has no action increment");
    return hamiltonian_.flow_with_action(one, s, h);
  }

 protected:
  using Wrapped<H>::hamiltonian_;
  /// Place of a flow that ends a step and is joined with the next; above that of any other.
  static constexpr std::uint32_t last_stage = 127;

  /// What every bath says of the motion.
  HamiltonianClaims claims_in_bath() const {
    HamiltonianClaims claims = hamiltonian_.claims();
    claims.alphabet += letter;
    claims.irreversible += letter;
    claims.dissipative = true;
    claims.counts_heat = false;
    claims.symplectic = false;
    claims.no_action = "a thermostat exchanges energy with the particles, so the motion has no action";
    claims.keeps_angular_momentum = false;
    return claims;
  }

 private:
  Bath& bath() { return static_cast<Bath&>(*this); }
};

}  // namespace noether
