#pragma once
/// A Hamiltonian with tides as one more letter.

#include "engine/description.hpp"
#include "engine/erasure.hpp"
#include "forces/tides.hpp"
#include "integrators/wrapped.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace noether {

/// Adds the letter `T`, tides with a constant time lag, to a split Hamiltonian of bodies that turn.
///
///     T:  v -> v + h a(x, v', S'),  S -> S + h torque(x, v', S'),  v' and S' halfway: the implicit midpoint rule
///
/// a symmetric map of order 2 that keeps momentum and angular momentum to rounding. It is irreversible: schemes with
/// negative steps are refused. A word without a T gets half a T at both ends. Under coordinates of its own (those of
/// `wisdom_holman`) velocities change by what these make of the change of inertial ones.
/// @cost three or four evaluations of the tides for each T, and in other coordinates two changes of them
/// @source Mignard1979, HairerLubichWanner2006
template <SplitHamiltonian H> class Tidal : public Wrapped<H> {
 public:
  using real = typename H::real;
  static_assert(std::numeric_limits<real>::is_specialized,
                "the letter T of tides repeats until velocities settle, each system after its own number of rounds: "
                "systems in lanes run one by one, and dual numbers have no such steps");

  Tidal(H hamiltonian, Tides tides) : Wrapped<H>(std::move(hamiltonian)), tides_(std::move(tides)) { tides_.check(); }

  HamiltonianClaims claims() const {
    HamiltonianClaims claims = Wrapped<H>::claims();
    claims.alphabet += 'T';
    claims.irreversible.insert(claims.irreversible.begin(), 'T');
    claims.dissipative = true;
    claims.counts_heat = false;
    claims.symplectic = false;
    return claims;
  }
  /// @throws Error  for bodies that cannot have tides, and where none has
  void bind(ParticleSystem<real>& s) {
    check_force(tides_, s);
    Wrapped<H>::bind(s);
    before_ = middle_ = s;
    acceleration_ = torque_ = VectorColumn<real>(s.size());
    failure_.reset();
  }
  void flow(char letter, ParticleSystem<real>& s, const real& h) {
    if (letter != 'T') return Wrapped<H>::flow(letter, s, h);
    before_->assign_state(s);
    const bool own_coordinates = s.phase().coordinates != 0;
    if (own_coordinates) this->hamiltonian_.close(*before_);
    if (!find_middle(h)) return;
    s.template column<BodySpin>().add_scaled(h, torque_);
    if (!own_coordinates) return s.advance_velocities(h, acceleration_);
    middle_->assign_state(*before_);
    middle_->velocities().all() = acceleration_.all();
    // In an observer's place: what the run remembers of its arcs stays.
    if (!observing_) this->hamiltonian_.observe(Request{});
    this->hamiltonian_.open(*middle_);
    if (!observing_) this->hamiltonian_.observe({});
    s.advance_velocities(h, std::as_const(*middle_).velocities());
  }
  /// @throws LogicError  for T: a dissipative flow has no action
  real flow_with_action(char letter, ParticleSystem<real>& s, const real& h) {
    NOETHER_EXPECTS(letter != 'T', "the dissipative flow T has no action increment");
    return Wrapped<H>::flow_with_action(letter, s, h);
  }
  EnergyTerms<real> energy(const ParticleSystem<real>& s) {
    EnergyTerms<real> terms = Wrapped<H>::energy(s);
    ForceSink<real> sink(acceleration_, s, {.energy = true});
    tides_.add_to(sink, s);
    terms.potential += sink.potential();
    return terms;
  }
  void accelerations(const ParticleSystem<real>& s, VectorColumn<real>& a) {
    Wrapped<H>::accelerations(s, a);
    ForceSink<real> sink(acceleration_, s, {});
    tides_.add_to(sink, s);
    a.all() += acceleration_.all();
  }
  void observe(std::optional<Request> wanted) {
    observing_ = wanted.has_value();
    Wrapped<H>::observe(wanted);
  }
  const std::optional<Failure>& failure() const { return failure_ ? failure_ : Wrapped<H>::failure(); }
  void save(SavedState& saved, const std::string& prefix) const {
    detail::save_signature(saved, prefix + "tides/", tides_);
    detail::save_any(saved, prefix, this->hamiltonian_);
  }
  void load(const SavedState& saved, const std::string& prefix) {
    detail::check_signature(saved, prefix + "tides/", tides_);
    failure_.reset();
    detail::load_any(saved, prefix, this->hamiltonian_);
  }

 private:
  /// Accelerations and torques at velocities and spins halfway, from those of `before_`. @return whether they settle
  bool find_middle(const real& h) {
    static constexpr int most_rounds = 100;
    middle_->assign_state(*before_);
    for (int round = 0; round < most_rounds; ++round) {
      ForceSink<real> sink(acceleration_, *middle_, {});
      sink.set_torques(torque_);
      tides_.add_to(sink, *middle_);
      bool settled = go_halfway(h, std::as_const(*before_).velocities(), acceleration_, middle_->velocities());
      settled = go_halfway(h, std::as_const(*before_).template column<BodySpin>(), torque_,
                           middle_->template column<BodySpin>()) &&
                settled;
      if (settled) return true;
    }
    if (!observing_) {
      failure_ = Failure{Outcome::Kind::solver_failure, -1, "velocity",
                         "a step of the tides did not converge; take a smaller step"};
    }
    return false;
  }
  /// Puts what is halfway into `to`. @return whether each row was there already, to rounding of its own size
  static bool go_halfway(const real& h, const VectorColumn<real>& from, const VectorColumn<real>& rate,
                         VectorColumn<real>& to) {
    using std::isfinite;
    const real rounding(16 * std::numeric_limits<real>::epsilon() * std::numeric_limits<real>::epsilon());
    bool settled = true;
    for (Index i = 0; i < from.size(); ++i) {
      const Vec3<real> change = h / real(2) * rate[i], middle = from[i] + change;
      const real moved2 = norm2(Vec3<real>(middle - std::as_const(to)[i])), size2 = norm2(middle) + norm2(change);
      settled = settled && moved2 <= rounding * size2 && isfinite(size2);  // what is not a number is never settled
      to.set(i, middle);
    }
    return settled;
  }

  Tides tides_;
  std::optional<ParticleSystem<real>> before_, middle_;  ///< in inertial coordinates
  VectorColumn<real> acceleration_, torque_;
  std::optional<Failure> failure_;
  bool observing_ = false;
};

/// Tides as a letter, for scenes: what `[[hamiltonian.force]] type = "tides"` adds to a splitting.
template <SplitHamiltonian H> Tidal<H> with_letter(const Tides& tides, H hamiltonian) {
  return Tidal<H>(std::move(hamiltonian), tides);
}

extern template class Tidal<AnyHamiltonian<double>>;
extern template struct detail::HamiltonianModel<Tidal<AnyHamiltonian<double>>>;

}  // namespace noether
