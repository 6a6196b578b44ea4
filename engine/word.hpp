#pragma once
/// A word as it is walked: the flows of a step in turn, step after step.

#include "engine/concepts.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace noether {

/// One stage as the loop does it.
template <class Real> struct TimedStage {
  char letter;
  Real weight;
  Real fraction;  ///< part of the step that the letters that carry time have covered when the stage begins
};

/// The stages of one step. Where the first and the last letter agree, the last stage is left *pending* and done
/// together with the first of the next step.
template <class Real> class TimedWord {
 public:
  /// @param joins  whether a last and a first stage of one letter make one
  explicit TimedWord(std::vector<TimedStage<Real>> stages, bool joins = true) : stages_(std::move(stages)) {
    merges_ = joins && stages_.size() > 1 && stages_.front().letter == stages_.back().letter;
    if (merges_) merged_ = stages_.back().weight + stages_.front().weight;
  }

  const std::vector<TimedStage<Real>>& stages() const { return stages_; }

  /// The longest stage of a letter, as a part of a step; what is joined with the next step counts as one stage.
  Real longest(char letter) const {
    Real most(0);
    const auto compare = [&](const Real& weight) {
      const Real length = weight < Real(0) ? Real(-weight) : weight;
      if (length > most) most = length;
    };
    for (std::size_t k = merges_ ? 1 : 0; k + (merges_ ? 1 : 0) < stages_.size(); ++k) {
      if (stages_[k].letter == letter) compare(stages_[k].weight);
    }
    if (merges_ && stages_.front().letter == letter) compare(merged_);
    return most;
  }

  /// Does one step: calls `flow(letter, weight, fraction)` for each of its stages.
  template <class Flow> void step(Phase& phase, const Flow& flow) const {
    const TimedStage<Real>& first = stages_.front();
    flow(first.letter, phase.pending ? merged_ : first.weight, first.fraction);
    const std::size_t end = stages_.size() - (merges_ ? 1 : 0);
    for (std::size_t k = 1; k < end; ++k) flow(stages_[k].letter, stages_[k].weight, stages_[k].fraction);
    phase.pending = merges_;
  }

 private:
  std::vector<TimedStage<Real>> stages_;
  bool merges_ = false;
  Real merged_ = Real(0);
};

/// Advances by whole steps: `flow(letter, duration)` for each letter. Ends after a step that fails, or after which it
/// is asked to stop.
template <class H, class Real, class Flow>
Advance walk_letters(const H& hamiltonian, const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span,
                     const Flow& flow) {
  const Real dt(s.clock().dt());
  Advance done;
  while (done.steps < span.steps) {
    word.step(s.phase(), [&](char letter, const Real& weight, const Real& fraction) {
      s.clock().set_fraction(fraction);
      flow(letter, weight * dt);
    });
    s.clock().tick(Real(0));
    ++done.steps;
    if (const std::optional<Failure>& failure = hamiltonian.failure()) done.failure = &*failure;
    if (done.failure != nullptr || span.asked_to_stop()) break;
  }
  return done;
}

/// Advances by whole steps: by the Hamiltonian's own fused walk where it has one, else letter by letter.
template <class H, class Real>
Advance walk(H& hamiltonian, const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span) {
  if constexpr (requires { hamiltonian.run(word, s, span); }) {
    return hamiltonian.run(word, s, span);
  } else {
    return walk_letters(hamiltonian, word, s, span,
                        [&](char letter, const Real& h) { hamiltonian.flow(letter, s, h); });
  }
}

/// The same, with the same bits; adds the action increments of the flows to `action`.
template <class H, class Real>
Advance walk_with_action(H& hamiltonian, const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span,
                         Real& action) {
  return walk_letters(hamiltonian, word, s, span,
                      [&](char letter, const Real& h) { action += hamiltonian.flow_with_action(letter, s, h); });
}

}  // namespace noether
