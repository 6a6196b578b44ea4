#pragma once
/// H = Kepler + interaction: planets on Kepler arcs, kicked by each other.

#include "engine/bodies.hpp"
#include "engine/concepts.hpp"
#include "engine/signature.hpp"
#include "engine/word.hpp"
#include "forces/gr_potential.hpp"
#include "forces/gravity.hpp"
#include "forces/primary.hpp"
#include "forces/sum.hpp"
#include "integrators/encounters.hpp"
#include "integrators/jacobi_derivatives.hpp"
#include "integrators/kepler.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/planet_path.hpp"
#include "integrators/tracer_lanes.hpp"
#include "integrators/wisdom_holman_coordinates.hpp"
#include "integrators/wisdom_holman_lanes.hpp"
#include "numbers/dual.hpp"
#include "numbers/parallel.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace noether {

/// Parameters of a Wisdom-Holman splitting.
struct WisdomHolmanOptions {
  std::optional<double> G = {};                   ///< [length^3/mass/time^2]; default: the unit system's own
  Coordinates coordinates = Coordinates::jacobi;  ///< in which H is split

  static constexpr auto describe() {
    return part<WisdomHolmanOptions>(
        "wisdom_holman", "Kepler arcs A about particle 0 and kicks B by the interaction",
        formula("H = sum [p'^2/2m' - G m' M/r'] + [sum G m' M/r' - sum G m_i m_j/r_ij]"), source("WisdomHolman1991"),
        letter('A', "Kepler arcs of every body"), letter('B', "kicks by the interaction"),
        letter('G', "kicks by the gradient of the square of that of B, for kernels"),
        letter('L', "kicks by the interaction a little further along itself, for kernels"),
        field<&WisdomHolmanOptions::G>("G", "length^3/mass/time^2", "default: the unit system's own"),
        field<&WisdomHolmanOptions::coordinates>("coordinates", "1",
                                                 "in which H is split; democratic and whds are heliocentric"));
  }

  /// What it has in itself, beside the motion p^2/2m: methods that do not split take it as a force.
  std::tuple<Gravity> forces() const { return {Gravity{.G = G}}; }
  /// The splitting with other forces beside, for scenes.
  template <class Real> AnyHamiltonian<Real> split(ForceField<Real> others) const;
};

/// The Wisdom-Holman splitting in Jacobi coordinates, or in others that know no order of the bodies.
///
/// Particle 0 is the primary; massive bodies come before tracers. Jacobi coordinates take the bodies by semi-major axis
/// at the start, and a tracer goes round those whose orbits are smaller than its own; that order is state. With M_k the
/// mass of the first k + 1 bodies in it, m'_k = m_k M_{k-1}/M_k:
///
///     jacobi      A = P^2/2M + sum_k [p'_k^2/2m'_k - G m'_k M_k/r'_k]
///                 B = sum_{k>1} G m'_k M_k/r'_k - sum_{pairs but the innermost} G m_i m_j/r_ij (+ other forces)
///     democratic  A = P^2/2M + sum_i [p_i^2/2m_i - G m_0 m_i/Q_i],   Q_i = x_i - x_0, p_i = m_i (v_i - V)
///                 B = J/2 K J/2 with J = |sum p_i|^2/2m_0 and K = - sum_{0<i<j} G m_i m_j/Q_ij (+ other forces)
///     whds        A = P^2/2M + sum_i [p_i^2 (m_0 + m_i)/2m_0 m_i - G m_0 m_i/Q_i],   J = sum_{i<j} p_i p_j/m_0
///     barycentric A = P^2/2M + sum_i [p_i^2 (M - m_i)/2M m_i - G m_0^2 m_i/(m_0 + m_i)R_i],  J = - sum_{i<j} p_i p_j/M
///                 with R_i = x_i - X, p_i = m_i (v_i - v_0), and K = U - (the potential in A)
///
/// Both parts of the first two are exact. J does not commute with other forces, nor with K in the last two: B is then a
/// symmetric map of order 2. Two bodies alone are followed exactly in all but the democratic ones. Where other forces
/// depend on velocities, B is a step of the implicit midpoint rule over fixed positions, a symmetric map of order 2
/// that is not symplectic and has no action. Kicks pass torques of other forces on to the spins of rigid bodies, which
/// `Rotating` turns: with it A is exact for bodies that turn too (Touma and Wisdom). Action increments: Kepler arc h E
/// + 2 mu s times the reduced mass (s the universal variable), free motion h T, jump h J, kick - h U.
/// @cost one Kepler arc per body and A, one sum over pairs per B; no allocation after `bind`
/// @source WisdomHolman1991, DuncanLevisonLee1998, ReinTamayo2015, HernandezDehnen2017, ToumaWisdom1994
template <class Real = double, class F = Sum<>> class WisdomHolman : private detail::AboutPrimary<Real> {
 public:
  using real = Real;
  /// Whether forces of this type leave the planets to lanes: none, or `gr_potential` alone, and no others in a field.
  static constexpr bool may_have_lanes =
      std::is_same_v<Real, double> && (std::is_same_v<F, Sum<>> || std::is_same_v<F, GrPotential> ||
                                       std::is_same_v<F, Sum<GrPotential>> || std::is_same_v<F, ForceField<double>>);

  explicit WisdomHolman(WisdomHolmanOptions options, F forces = F())
      : Base(options.coordinates),
        options_(options),
        forces_(std::move(forces)),
        velocity_dependent_(claims_of(forces_).velocity_dependent) {}

  std::string name() const { return "wisdom_holman"; }
  HamiltonianClaims claims() const;

  /// @throws Error  if particle 0 has no mass or is not that of the first call, or a tracer stands before a massive
  /// body
  void bind(ParticleSystem<Real>& s);
  void open(ParticleSystem<Real>& s);
  void close(ParticleSystem<Real>& s);
  void flow(char letter, ParticleSystem<Real>& s, const Real& h);
  Real flow_with_action(char letter, ParticleSystem<Real>& s, const Real& h);
  Advance run(const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span);

  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) {
    return {kinetic_energy(s), newton(s, scratch_, {.energy = true})};
  }
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) { newton(s, a, {}); }

  void observe(std::optional<Request> wanted) {
    observing_ = wanted.has_value();
    pulled_.reset();
  }
  const std::optional<Failure>& failure() const { return failure_; }
  Evaluations evaluations() const {
    Evaluations all = evaluations_;
    all.encounter = encounters_.closest();
    return all;
  }
  void save(SavedState& saved, const std::string& prefix) const {
    detail::save_signature(saved, prefix + "options/", options_);
    detail::save_signature(saved, prefix + "forces/", forces_);
    save_value(saved, prefix + "order", order_);
    save_value(saved, prefix + "within", within_);
    save_value(saved, prefix + "kicks", evaluations_.force);
    save_value(saved, prefix + "arcs", evaluations_.kepler);
    encounters_.save(saved, prefix + "encounter/");
    if constexpr (may_have_lanes) {
      lanes_.save(saved, prefix + "lanes/");
      if (!tracers_.empty()) tracers_.save(saved, prefix + "lanes/tracers/", lanes_.predicted());
    }
  }
  void load(const SavedState& saved, const std::string& prefix) {
    detail::check_signature(saved, prefix + "options/", options_);
    detail::check_signature(saved, prefix + "forces/", forces_);
    load_order(saved, prefix);
    load_value(saved, prefix + "kicks", evaluations_.force);
    load_value(saved, prefix + "arcs", evaluations_.kepler);
    encounters_.load(saved, prefix + "encounter/");
    failure_.reset();
    gather_masses();
    load_within(saved, prefix);
    gather_arcs();
    if constexpr (may_have_lanes) {
      bind_lanes();
      if (lanes_.bound()) lanes_.load(saved, prefix + "lanes/");
      if (lanes_.predicted() && !tracers_.empty() && !tracers_.load(saved, prefix + "lanes/tracers/", lanes_.last()))
        lanes_.forget();  // saved when tracers went letter by letter
    }
  }
  /// Once it is bound: its coordinates and masses, by particle the mass that its arc goes round and the mass that makes
  /// its velocity a momentum, and Newton's constant.
  const detail::AboutPrimary<Real>& about() const { return *this; }
  const std::vector<Real>& circled() const { return circled_; }
  const std::vector<Real>& reduced() const { return reduced_; }
  const Real& constant() const { return g_; }
  /// The forces beside gravity.
  const F& forces() const { return forces_; }

  /// Particles in the order of Jacobi coordinates, massive bodies first.
  const std::vector<std::int64_t>& order() const { return order_; }

  /// The planets in lanes; not bound where all bodies go letter by letter. And the tracers.
  const auto& lanes() const { return lanes_; }
  const auto& tracers() const { return tracers_; }

 private:
  using Base = detail::AboutPrimary<Real>;
  using Base::at, Base::barycentric, Base::from_jacobi, Base::gather_masses, Base::has_tracers;
  using Base::half_jump, Base::load_order, Base::load_within, Base::within;
  using Base::inertial_positions, Base::jacobi, Base::massive, Base::place_within, Base::scale, Base::scaled;
  using Base::interior_, Base::masses_, Base::order_, Base::scale_, Base::within_;
  using Base::to_jacobi, Base::from_democratic, Base::to_democratic, Base::from_barycentric, Base::to_barycentric;

  static constexpr bool has_forces = !std::is_same_v<F, Sum<>>;
  /// Of a million tracers, which do not stay in the cache, a step by itself costs 1.5 times as much.
  static constexpr std::int64_t steps_of_tracers = 16;
  void gather_arcs();
  void bind_spins(const ParticleSystem<Real>& s);

  void inertial_velocities(const VectorColumn<Real>& from, VectorColumn<Real>& to) const;
  bool forces_in_lanes(const ParticleSystem<Real>& s);
  void bind_lanes();
  /// Whether lanes have a letter: those of kernels where there are no tracers.
  bool letter_in_lanes(char letter) const {
    return letter == 'A' || letter == 'B' || (!has_tracers() && (letter == 'G' || letter == 'L'));
  }
  void watch_for_encounters();
  // Templates, so that an explicit instantiation of a class without lanes leaves them out: clang 14 takes no heed of
  // `requires` there.
  template <class = void> void flow_of_lanes(char letter, ParticleSystem<Real>& s, const Real& h);
  template <class = void> void kernel_of_lanes(char letter, ParticleSystem<Real>& s, const Real& h);
  template <class = void> void note_near();
  template <class = void> void flow_in_lanes(char letter, ParticleSystem<Real>& s, const Real& h);
  template <class = void> Real action_in_lanes(char letter, ParticleSystem<Real>& s, const Real& h);
  template <class = void> Advance run_in_lanes(const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span);
  template <class = void> void follow_planets(ParticleSystem<Real>& s, const std::optional<TracerLanes::Lost>& lost);
  template <class = void> void keep_before_steps(const ParticleSystem<Real>& s);
  template <class = void> void go_back(ParticleSystem<Real>& s);
  const VectorColumn<Real>& middle_of_kick(const ParticleSystem<Real>& s, const Real& h);

  Real arcs(ParticleSystem<Real>& s, const Real& h, bool action);
  void fail(const ParticleSystem<Real>& s, Index i);
  Real kick(ParticleSystem<Real>& s, const Real& h, bool action);
  Real gradient_kick(ParticleSystem<Real>& s, const Real& h, bool action);
  void lazy_kick(ParticleSystem<Real>& s, const Real& h);
  void velocity_kick(ParticleSystem<Real>& s, const Real& h);
  void add_force_derivatives(const Clock<Real>& clock);
  std::string no_kernel() const;
  /// Encounters are noted where a run goes, not on the way through the word before it.
  void begin_kick(const ParticleSystem<Real>& s) {
    noting_ = !observing_ && s.phase().opened;
    if constexpr (has_forces) {
      if (twists_) {
        inertial_->template column<BodyOrientation>().assign(std::as_const(s).template column<BodyOrientation>());
      }
    }
    backward_ = s.clock().direction() == Direction::backward;
  }
  void note_failure(const std::optional<Failure>& failure) {
    if (failure && !failure_ && !observing_) failure_ = failure;
  }
  Real accelerate(const VectorColumn<Real>& x, const Clock<Real>& clock, bool energy);
  Real jump(ParticleSystem<Real>& s, const Real& h);
  Real interaction(const VectorColumn<Real>& x, bool skip_inner, Index first, bool energy);
  Real indirect(const VectorColumn<Real>& x, bool energy);
  Real without_arcs(const VectorColumn<Real>& x, bool energy);
  void about_center(VectorColumn<Real>& column) const;
  Real other_forces(const VectorColumn<Real>& x, const Clock<Real>& clock, bool energy);
  Real newton(const ParticleSystem<Real>& s, VectorColumn<Real>& a, Request wanted);

  /// A moment of a run at which something stands still.
  struct Place {
    std::uint64_t version;
    std::int64_t step;
    Real fraction;
    bool operator==(const Place&) const = default;
  };
  /// The particles on their way along a direction, under other forces.
  struct Along {
    explicit Along(const ParticleSystem<Real>& s) : particles(s.template as<Dual<Real, 1>>()), a(s.size()) {
      particles.clock() = Clock<Dual<Real, 1>>::free(0);
    }
    ParticleSystem<Dual<Real, 1>> particles;
    VectorColumn<Dual<Real, 1>> a;
  };

  WisdomHolmanOptions options_;
  F forces_;
  bool velocity_dependent_ = false;
  bool twists_ = false;  ///< whether particles have spins, which kicks by other forces turn
  Real g_ = Real(0);
  std::vector<Real> circled_;  ///< by particle, the mass that its Kepler arc goes round
  std::vector<Real> reduced_;  ///< by particle, the mass that makes its velocity a momentum
  double moment_ = 0;          ///< time of the kick
  VectorColumn<Real> scratch_, positions_, acceleration_, other_, along_;
  VectorColumn<Real> torque_;                     ///< by other forces, of particles with spins; else empty
  std::optional<ParticleSystem<Real>> inertial_;  ///< for other forces
  std::optional<Along> forces_along_;             ///< where forces have derivatives and kernels ask for them
  std::optional<Place> pulled_;                   ///< where `acceleration_` is that of B
  Workspace workspace_;                           ///< of other forces: no list of neighbors in it
  Primary primary_;
  std::optional<Failure> failure_;
  Evaluations evaluations_;
  EncounterWatch encounters_;
  bool observing_ = false, noting_ = false, backward_ = false;
  PlanetSystem planets_;            ///< as the lanes have them
  bool lanes_have_forces_ = false;  ///< all of those beside gravity
  std::conditional_t<may_have_lanes, PlanetLanes, std::monostate> lanes_;
  std::conditional_t<may_have_lanes, TracerLanes, std::monostate> tracers_;
  PlanetPath path_;  ///< for tracers, of the steps that planets are ahead
  /// What some steps change, beside the particles; for a run that has to go back to where they began.
  struct BeforeSteps {
    Clock<Real> clock = Clock<Real>::fixed(0, 0);
    Phase phase = {};
    Evaluations evaluations = {};
    std::optional<Encounter> closest = {};
    std::optional<Failure> failure = {};
    PlanetLanes::Predictions predictions = {};
  } before_;
};

template <class Real> AnyHamiltonian<Real> WisdomHolmanOptions::split(ForceField<Real> others) const {
  if (others.terms().empty()) return WisdomHolman<Real>(*this);
  return WisdomHolman<Real, ForceField<Real>>(*this, std::move(others));
}

extern template class WisdomHolman<double>;
extern template class WisdomHolman<Quad>;
extern template class WisdomHolman<double, ForceField<double>>;
extern template class WisdomHolman<Quad, ForceField<Quad>>;
extern template struct detail::HamiltonianModel<WisdomHolman<double>>;
extern template struct detail::HamiltonianModel<WisdomHolman<double, ForceField<double>>>;
extern template struct detail::HamiltonianModel<WisdomHolman<Quad>>;
extern template struct detail::HamiltonianModel<WisdomHolman<Quad, ForceField<Quad>>>;

}  // namespace noether

#include "integrators/wisdom_holman_impl.hpp"        // IWYU pragma: keep
#include "integrators/wisdom_holman_impl_kicks.hpp"  // IWYU pragma: keep
#include "integrators/wisdom_holman_impl_lanes.hpp"  // IWYU pragma: keep
