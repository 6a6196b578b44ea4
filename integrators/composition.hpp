#pragma once
/// The composition: one loop that walks every scheme over every split Hamiltonian.

#include "engine/concepts.hpp"
#include "engine/erasure.hpp"
#include "integrators/scheme.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace noether {

struct CompositionOptions {
  bool compensated = false;  ///< keep the rounding errors of x and v and add them back (Kahan, Neumaier)
};

/// One stage as the loop does it.
template <class Real> struct TimedStage {
  char letter;
  Real weight;
  Real fraction;  ///< part of the step that the drifts have covered when the stage begins
};

/// The word a scheme becomes over a Hamiltonian: irreversible letters added where the scheme has none.
///
/// A word without a D gets half a D at both ends; a word of two stages (`symplectic_euler_a`, `_b`) one D between them.
/// @throws SchemeMismatch  naming the scheme and what it lacks: a letter, an exact part, quadratic kinetic energy,
///         forward steps
Word fitted_word(const Scheme& scheme, const HamiltonianClaims& claims, const std::string& hamiltonian);

/// Advances a split Hamiltonian along a scheme.
///
/// One step is the product of flows  phi_{p1}(w1 h), ..., phi_{pk}(wk h), first stage first. Where the first and the
/// last letter agree they are merged across steps: after `advance` the last stage is *pending*, and `settle` completes
/// it on a copy. Neighbours of one letter are merged, stages of weight 0 dropped. Every stage sees the time that the
/// drifts (A) before it have reached.
/// @cost the flows of the word, nothing else: no allocation, no validation
/// @source HairerLubichWanner2006
template <SplitHamiltonian H> class Composition {
 public:
  using real = typename H::real;

  /// @throws SchemeMismatch  see `fitted_word`
  Composition(H hamiltonian, const Scheme& scheme, CompositionOptions options = {})
      : hamiltonian_(std::move(hamiltonian)), options_(options), name_(scheme.name), order_(scheme.order.classical) {
    const HamiltonianClaims claims = hamiltonian_.claims();
    const Word word = fitted_word(scheme, claims, detail::name_of(hamiltonian_));
    const auto weights = rounded_weights<real>(word);
    real fraction(0);
    for (std::size_t k = 0; k < word.size(); ++k) {
      stages_.push_back({word[k].letter, weights[k], fraction});
      if (word[k].letter == 'A') fraction += weights[k];
    }
    for (const Stage& stage : scheme.before) before_.push_back({stage.letter, real(stage.weight), real(0)});
    for (const Stage& stage : scheme.after) after_.push_back({stage.letter, real(stage.weight), real(0)});
    merges_ = stages_.size() > 1 && stages_.front().letter == stages_.back().letter;
    if (merges_) merged_ = stages_.back().weight + stages_.front().weight;
  }

  IntegratorClaims claims() const {
    const HamiltonianClaims claims = hamiltonian_.claims();
    return {.method = name_,
            .hamiltonian = detail::name_of(hamiltonian_),
            .order = order_,
            .symplectic = !claims.dissipative,
            .energy = claims.energy,
            .dissipative = claims.dissipative,
            .time_dependent = claims.time_dependent};
  }
  const std::vector<TimedStage<real>>& stages() const { return stages_; }
  H& hamiltonian() { return hamiltonian_; }

  void bind(ParticleSystem<real>& s) {
    s.keep_low_words(options_.compensated);
    hamiltonian_.bind(s);
  }

  Advanced advance(ParticleSystem<real>& s, const Span& span) {
    const real dt(s.clock().dt());
    if (!s.phase().opened) open(s, dt);
    for (std::int64_t n = 0; n < span.steps; ++n) {
      step(s, dt);
      if (hamiltonian_.failure()) return {n + 1, false, hamiltonian_.failure()};
      if (span.stop != nullptr && span.stop->load(std::memory_order_relaxed)) return {n + 1, false, std::nullopt};
    }
    return {span.steps, false, std::nullopt};
  }

  /// Completes a copy: pending stage, word after the run (if `corrected`), inertial coordinates.
  void settle(const ParticleSystem<real>& raw, ParticleSystem<real>& out, Wanted wanted, std::optional<double> at,
              bool corrected) {
    NOETHER_EXPECTS(!at, "a composition stands at whole steps only");
    out.assign_state(raw);
    if (!raw.phase().opened) return;
    const real dt(raw.clock().dt());
    hamiltonian_.observe(wanted);
    if (raw.phase().pending) hamiltonian_.flow(stages_.back().letter, out, stages_.back().weight * dt);
    if (corrected) walk(after_, out, dt);
    hamiltonian_.close(out);
    hamiltonian_.observe({});
    out.phase() = Phase{};
  }

  EnergyTerms<real> energy(const ParticleSystem<real>& settled) { return hamiltonian_.energy(settled); }
  void accelerations(const ParticleSystem<real>& settled, VectorColumn<real>& a) {
    hamiltonian_.accelerations(settled, a);
  }
  Evaluations evaluations() const { return hamiltonian_.evaluations(); }

  void save(SavedState& saved, const std::string& prefix) const {
    save_value(saved, prefix + "method", name_);
    save_value(saved, prefix + "compensated", options_.compensated);
    detail::save_any(saved, prefix + "hamiltonian/", hamiltonian_);
  }
  /// @throws Error  if the saved run was made by another scheme, or with other rounding
  void load(const SavedState& saved, const std::string& prefix) {
    std::string method;
    load_value(saved, prefix + "method", method);
    if (method != name_)
      throw Error("the saved run was made by method '" + method + "', this one uses '" + name_ + "'");
    bool compensated = false;
    load_value(saved, prefix + "compensated", compensated);
    if (compensated != options_.compensated) {
      throw Error(compensated ? "the saved run sums with compensation, this one without"
                              : "the saved run sums without compensation, this one with it");
    }
    detail::load_any(saved, prefix + "hamiltonian/", hamiltonian_);
  }

 private:
  void open(ParticleSystem<real>& s, const real& dt) {
    hamiltonian_.open(s);
    s.phase().opened = true;
    walk(before_, s, dt);
  }
  void step(ParticleSystem<real>& s, const real& dt) {
    const bool pending = s.phase().pending;
    const std::size_t last = stages_.size() - (merges_ ? 1 : 0);
    for (std::size_t k = 0; k < last; ++k) {
      const TimedStage<real>& stage = stages_[k];
      s.clock().set_fraction(stage.fraction);
      hamiltonian_.flow(stage.letter, s, (k == 0 && pending ? merged_ : stage.weight) * dt);
    }
    s.phase().pending = merges_;
    s.clock().tick(real(0));
  }
  void walk(const std::vector<TimedStage<real>>& stages, ParticleSystem<real>& s, const real& dt) {
    for (const auto& stage : stages) hamiltonian_.flow(stage.letter, s, stage.weight * dt);
  }

  H hamiltonian_;
  CompositionOptions options_;
  std::string name_;
  int order_;
  std::vector<TimedStage<real>> stages_, before_, after_;
  bool merges_ = false;
  real merged_ = real(0);
};

/// The integrator of a Hamiltonian and a scheme: `compose(WisdomHolman({.G = G}), schemes::aba_10_6_4)`.
/// @throws SchemeMismatch
template <SplitHamiltonian H>
Composition<H> compose(H hamiltonian, const Scheme& scheme, CompositionOptions options = {}) {
  return Composition<H>(std::move(hamiltonian), scheme, options);
}

}  // namespace noether
