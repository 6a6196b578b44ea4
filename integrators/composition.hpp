#pragma once
/// The composition: one loop that walks every scheme over every split Hamiltonian.

#include "engine/concepts.hpp"
#include "engine/erasure.hpp"
#include "engine/word.hpp"
#include "integrators/composition_options.hpp"
#include "integrators/processing.hpp"
#include "integrators/scheme.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace noether {

/// The stages of one step as a scheme has them over a Hamiltonian.
struct FittedWord {
  std::vector<Stage> stages;
  bool joins = true;  ///< the last stage is one with the first of the next step where their letters agree
};

/// What a scheme becomes over a Hamiltonian: the sub-steps of a composition as steps of its basic word, and
/// irreversible letters added where the scheme has none. Of a nested scheme the basic word is that of multiple time
/// steps: C (B A B) (B A B) C with two steps of B in one of C.
///
/// Where sub-steps of a composition meet, their outer letters are joined if these are exact flows, and never if they
/// are not: of a map of order 2 two halves are no whole. (From step to step a scheme of order 2 may join them: it stays
/// one.) A word without a D gets half a D at both ends; a word of two stages
/// (`symplectic_euler_a`, `_b`) one D between them.
/// @param options  those that made the scheme what it is (`processed`)
/// @throws SchemeMismatch  naming the scheme and what it lacks: a letter, an exact part, quadratic kinetic energy,
///         forward steps, Kepler arcs, a number of inner steps
FittedWord fitted_word(const Scheme& scheme, const HamiltonianClaims& claims, const std::string& hamiltonian,
                       const CompositionOptions& options = {});

/// The order that is left of a scheme's over a Hamiltonian: some have theirs for quadratic kinetic energies only, and
/// where a map of order 2 stands for a flow the weights of its letter must do for more.
Order order_over(const Scheme& scheme, const HamiltonianClaims& claims);

namespace detail {
/// @throws SchemeMismatch  for rigid bodies under a Hamiltonian that does not turn them
void expect_turns(bool bodies, bool turns, const std::string& hamiltonian);
}  // namespace detail

/// Advances a split Hamiltonian along a scheme.
///
/// One step is the product of flows  phi_{p1}(w1 h), ..., phi_{pk}(wk h), first stage first. Where the first and the
/// last letter agree and may be joined they are merged across steps: after `advance` the last stage is *pending*, and
/// `settle` completes it on a copy. Stages of weight 0 are dropped. Every stage sees the time that the letters that
/// carry time before it have reached.
/// @cost the flows of the word, nothing else: no allocation, no validation
/// @source HairerLubichWanner2006
template <SplitHamiltonian H> class Composition {
 public:
  using real = typename H::real;

  /// @throws SchemeMismatch  see `fitted_word` and `processed`
  Composition(H hamiltonian, const Scheme& scheme, CompositionOptions options = {})
      : Composition(options, std::move(hamiltonian), processed(scheme, options)) {}

  IntegratorClaims claims() const {
    const HamiltonianClaims claims = hamiltonian_.claims();
    return {.method = name_,
            .hamiltonian = detail::name_of(hamiltonian_),
            .order = order_,
            .symplectic = claims.symplectic && !claims.dissipative && !lazy_,
            .no_action =
                lazy_ ? "its lazy kernel is symplectic only nearly, so the motion has no action" : claims.no_action,
            .reversible = symmetric_ && !claims.dissipative,
            .energy = claims.energy,
            .dissipative = claims.dissipative,
            .counts_heat = claims.counts_heat,
            .time_dependent = claims.time_dependent,
            .keeps_momentum = claims.keeps_momentum,
            .keeps_angular_momentum = claims.keeps_angular_momentum,
            .momentum = claims.keeps_momentum,
            .angular_momentum = claims.keeps_angular_momentum,
            .constraints = claims.constraints,
            .constraint_tolerance = claims.constraint_tolerance,
            .steps_at_once = claims.steps_at_once};
  }
  const std::vector<TimedStage<real>>& stages() const { return word_.stages(); }
  H& hamiltonian() { return hamiltonian_; }

  void bind(ParticleSystem<real>& s) {
    s.keep_low_words(options_.compensated);
    detail::expect_turns(s.bodies() != nullptr, hamiltonian_.claims().turns, detail::name_of(hamiltonian_));
    hamiltonian_.bind(s);
    const HamiltonianClaims claims = hamiltonian_.claims();
    if (s.phase().coordinates != 0 && s.phase().coordinates != claims.coordinates) {
      throw Error("the particles are in the coordinates of another Hamiltonian than '" + detail::name_of(hamiltonian_) +
                  "'; start with inertial coordinates");
    }
    if constexpr (std::is_same_v<real, double>) {
      double longest = 0;
      for (const char letter : claims.kicks) longest = std::max(longest, word_.longest(letter));
      detail::expect_kicks(hamiltonian_, longest * std::abs(s.clock().dt()));
    }
  }

  Advance advance(ParticleSystem<real>& s, const Span& span) {
    if (!s.phase().opened) open(s, real(s.clock().dt()));
    return walk(hamiltonian_, word_, s, span);
  }
  Advance advance_with_action(ParticleSystem<real>& s, const Span& span, real& action) {
    if (!s.phase().opened) open(s, real(s.clock().dt()));
    return walk_with_action(hamiltonian_, word_, s, span, action);
  }

  /// Completes a copy: pending stage, word after the run (if `corrected`), inertial coordinates. Not corrected, it
  /// stands where the composed map stands, at the start too: behind the word before the run, and if the action is
  /// wanted, with p/m in the place of velocities where a Hamiltonian has other momenta than m v.
  /// @return the action of the pending stage, if wanted of a copy that is not corrected
  real settle(const ParticleSystem<real>& raw, ParticleSystem<real>& out, Request wanted, std::optional<double> at,
              bool corrected) {
    NOETHER_EXPECTS(!at, "a composition can stop at whole steps only");
    out.assign_state(raw);
    real action(0);
    wanted.action = wanted.action && !corrected;
    if (!raw.phase().opened && corrected) return action;
    if (!raw.phase().opened && before_.empty() && !(wanted.action && hamiltonian_.claims().inertial)) return action;
    const real dt(raw.clock().dt());
    hamiltonian_.observe(wanted);
    if (!raw.phase().opened) open(out, dt);
    if (raw.phase().pending) {
      const TimedStage<real>& last = stages().back();
      if (wanted.action) {
        action = hamiltonian_.flow_with_action(last.letter, out, last.weight * dt);
      } else {
        flow(last, out, dt);
      }
    }
    if (corrected) flow_all(after_, out, dt);
    hamiltonian_.close(out);
    hamiltonian_.observe({});
    out.phase() = Phase{};
    return action;
  }

  EnergyTerms<real> energy(const ParticleSystem<real>& settled) { return hamiltonian_.energy(settled); }
  std::optional<Mat3<real>> virial(const ParticleSystem<real>& settled) {
    return detail::virial_of(hamiltonian_, settled);
  }
  void accelerations(const ParticleSystem<real>& settled, VectorColumn<real>& a) {
    hamiltonian_.accelerations(settled, a);
  }
  Evaluations evaluations() const { return hamiltonian_.evaluations(); }

  void save(SavedState& saved, const std::string& prefix) const {
    save_value(saved, prefix + "method", name_);
    save_value(saved, prefix + "compensated", options_.compensated);
    save_value(saved, prefix + "processing", options_.processing_text());
    detail::save_any(saved, prefix + "hamiltonian/", hamiltonian_);
  }
  /// @throws Error  if the saved run was made by another scheme, or with other rounding
  void load(const SavedState& saved, const std::string& prefix) {
    std::string method;
    load_value(saved, prefix + "method", method);
    if (method != name_)
      throw Error("the saved run was made by method '" + method + "', but this one uses '" + name_ + "'");
    bool compensated = false;
    load_value(saved, prefix + "compensated", compensated);
    if (compensated != options_.compensated) {
      throw Error(compensated ? "the saved run sums with compensation, but this one without"
                              : "the saved run sums without compensation, but this one with it");
    }
    std::string processing;
    if (saved.contains(prefix + "processing")) load_value(saved, prefix + "processing", processing);
    if (processing != options_.processing_text()) {
      const std::string now = options_.processing_text();
      throw Error("the saved run has " + (processing.empty() ? "no corrector or kernel" : processing) +
                  ", but this one has " + (now.empty() ? "no corrector or kernel" : now));
    }
    detail::load_any(saved, prefix + "hamiltonian/", hamiltonian_);
  }

 private:
  Composition(const CompositionOptions& options, H hamiltonian, const Scheme& scheme)
      : hamiltonian_(std::move(hamiltonian)),
        options_(options),
        name_(scheme.name),
        order_(order_over(scheme, hamiltonian_.claims()).classical),
        word_(timed(fitted_word(scheme, hamiltonian_.claims(), detail::name_of(hamiltonian_), options_),
                    hamiltonian_.claims().timed)) {
    symmetric_ = scheme.is_symmetric() && scheme.before.size() == 0 && is_palindrome(word_.stages());
    const HamiltonianClaims claims = hamiltonian_.claims();
    before_ = around(scheme.before, claims.timed);
    after_ = around(scheme.after, claims.timed);
    for (const Stage& stage : scheme.word) lazy_ = lazy_ || claims.lazy.find(stage.letter) != std::string_view::npos;
  }

  /// The word before or after the run; after it the time that letters carry comes back to where it was.
  static std::vector<TimedStage<real>> around(const Word& word, std::string_view with_time) {
    std::vector<TimedStage<real>> stages;
    real fraction(0);
    for (const Stage& stage : word) {
      stages.push_back({stage.letter, detail::weight_in<real>(stage.weight), fraction});
      if (with_time.find(stage.letter) != std::string_view::npos) fraction += stages.back().weight;
    }
    return stages;
  }
  /// The word in the weights of `real`, each stage with the time at which it begins.
  static TimedWord<real> timed(const FittedWord& fitted, std::string_view with_time) {
    const std::vector<Stage>& word = fitted.stages;
    const auto weights = rounded_weights<real>(std::span<const Stage>(word));
    std::vector<TimedStage<real>> stages;
    real fraction(0);
    for (std::size_t k = 0; k < word.size(); ++k) {
      stages.push_back({word[k].letter, weights[k], fraction});
      if (with_time.find(word[k].letter) != std::string_view::npos) fraction += weights[k];
    }
    return TimedWord<real>(std::move(stages), fitted.joins);
  }
  static bool is_palindrome(const std::vector<TimedStage<real>>& stages) {
    return std::equal(stages.begin(), stages.begin() + static_cast<std::ptrdiff_t>(stages.size() / 2), stages.rbegin(),
                      [](const auto& a, const auto& b) { return a.letter == b.letter && a.weight == b.weight; });
  }
  void open(ParticleSystem<real>& s, const real& dt) {
    hamiltonian_.open(s);
    flow_all(before_, s, dt);
    s.phase().opened = true;
  }
  void flow(const TimedStage<real>& stage, ParticleSystem<real>& s, const real& dt) {
    hamiltonian_.flow(stage.letter, s, stage.weight * dt);
  }
  void flow_all(const std::vector<TimedStage<real>>& stages, ParticleSystem<real>& s, const real& dt) {
    if (stages.empty()) return;
    const real at = s.clock().fraction();
    for (const TimedStage<real>& stage : stages) {
      s.clock().set_fraction(at + stage.fraction);
      flow(stage, s, dt);
    }
    s.clock().set_fraction(at);
  }

  H hamiltonian_;
  CompositionOptions options_;
  std::string name_;
  int order_;
  bool symmetric_ = false;
  bool lazy_ = false;  ///< a letter of the word is symplectic only nearly
  TimedWord<real> word_;
  std::vector<TimedStage<real>> before_, after_;
};

/// The integrator of a Hamiltonian and a scheme: `compose(WisdomHolman({.G = G}), schemes::aba_10_6_4)`.
/// @throws SchemeMismatch
template <SplitHamiltonian H>
Composition<H> compose(H hamiltonian, const Scheme& scheme, CompositionOptions options = {}) {
  return Composition<H>(std::move(hamiltonian), scheme, options);
}

// Any Hamiltonian along a scheme, compiled once.
extern template class Composition<AnyHamiltonian<double>>;
extern template class Composition<AnyHamiltonian<Quad>>;
extern template struct detail::IntegratorModel<Composition<AnyHamiltonian<double>>>;
extern template struct detail::IntegratorModel<Composition<AnyHamiltonian<Quad>>>;

}  // namespace noether
