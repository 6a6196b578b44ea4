#pragma once
/// H = Kepler + interaction: planets on Kepler arcs, kicked by each other.

#include "engine/concepts.hpp"
#include "engine/signature.hpp"
#include "forces/gravity.hpp"
#include "forces/primary.hpp"
#include "forces/sum.hpp"
#include "integrators/encounters.hpp"
#include "integrators/jacobi_derivatives.hpp"
#include "integrators/kepler.hpp"
#include "integrators/kinetic_potential.hpp"
#include "numbers/parallel.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace noether {

/// What the position and velocity columns hold while the splitting runs; 0 is inertial, as everywhere.
enum class Coordinates : std::uint8_t {
  jacobi = 1,   ///< row 0: centre of mass; others relative to the centre of mass of all bodies further in
  democratic,   ///< row 0: centre of mass; positions relative to particle 0, velocities to the centre of mass
  whds,         ///< as democratic, velocities times (m_0 + m_i)/m_0
  barycentric,  ///< row 0: centre of mass; positions relative to it, velocities to particle 0 times (M - m_i)/M
};

template <> struct EnumNames<Coordinates> {
  static constexpr std::array<std::pair<Coordinates, std::string_view>, 4> values = {
      {{Coordinates::jacobi, "jacobi"},
       {Coordinates::democratic, "democratic"},
       {Coordinates::whds, "whds"},
       {Coordinates::barycentric, "barycentric"}}};
};

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
/// symmetric map of order 2. Two bodies alone are followed exactly in all but the democratic ones. Other forces must
/// depend on positions (and stage time) only. Action increments: Kepler arc h E + 2 mu s times the reduced mass (s the
/// universal variable), free motion h T, jump h J, kick - h U.
/// @cost one Kepler arc per body and A, one sum over pairs per B; no allocation after `bind`
/// @source WisdomHolman1991, DuncanLevisonLee1998, ReinTamayo2015, HernandezDehnen2017
template <class Real = double, class F = Sum<>> class WisdomHolman {
 public:
  using real = Real;

  explicit WisdomHolman(WisdomHolmanOptions options, F forces = F()) : options_(options), forces_(std::move(forces)) {
    if (claims_of(forces_).velocity_dependent) {
      throw SchemeMismatch("a force depends on velocities, so kicks by it are not an exact flow of wisdom_holman");
    }
  }

  std::string name() const { return "wisdom_holman"; }
  HamiltonianClaims claims() const;

  /// @throws Error  if particle 0 has no mass or is not that of the first call, or a tracer stands before a massive
  /// body
  void bind(ParticleSystem<Real>& s);
  void open(ParticleSystem<Real>& s);
  void close(ParticleSystem<Real>& s);
  void flow(char letter, ParticleSystem<Real>& s, const Real& h);
  Real flow_with_action(char letter, ParticleSystem<Real>& s, const Real& h);

  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) {
    return {kinetic_energy(s), newton(s, scratch_, {.energy = true})};
  }
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) { newton(s, a, {}); }

  void observe(std::optional<Request> wanted) { observing_ = wanted.has_value(); }
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
  }
  /// Particles in the order of Jacobi coordinates, massive bodies first.
  const std::vector<std::int64_t>& order() const { return order_; }

 private:
  bool jacobi() const { return options_.coordinates == Coordinates::jacobi; }
  bool barycentric() const { return options_.coordinates == Coordinates::barycentric; }
  /// Whether velocities are scaled: what each body has of |sum p_i|^2 is part of A, and J is what they have together.
  bool scaled() const { return options_.coordinates == Coordinates::whds || barycentric(); }
  static constexpr bool has_forces = !std::is_same_v<F, Sum<>>;
  void gather_masses();
  void place_within(const std::vector<double>& axis);
  void gather_arcs();
  void load_order(const SavedState& saved, const std::string& prefix);
  void load_within(const SavedState& saved, const std::string& prefix);
  std::size_t massive() const { return interior_.size(); }
  Index at(std::size_t k) const { return static_cast<Index>(order_[k]); }
  std::size_t within(Index i) const { return static_cast<std::size_t>(within_[static_cast<std::size_t>(i)]); }

  void to_jacobi(VectorColumn<Real>& column) const;
  void from_jacobi(const VectorColumn<Real>& from, VectorColumn<Real>& to, const Vec3<Real>& center) const;
  void to_democratic(ParticleSystem<Real>& s) const;
  void from_democratic(ParticleSystem<Real>& s) const;
  void to_barycentric(ParticleSystem<Real>& s) const;
  void from_barycentric(ParticleSystem<Real>& s) const;
  void scale(VectorColumn<Real>& column, bool back) const;
  void inertial_positions(const VectorColumn<Real>& from, const Vec3<Real>& center, VectorColumn<Real>& to) const;

  Real arcs(ParticleSystem<Real>& s, const Real& h, bool action);
  Real kick(ParticleSystem<Real>& s, const Real& h, bool action);
  Real gradient_kick(ParticleSystem<Real>& s, const Real& h, bool action);
  void lazy_kick(ParticleSystem<Real>& s, const Real& h);
  Real accelerate(const VectorColumn<Real>& x, const Clock<Real>& clock, bool energy);
  Real jump(ParticleSystem<Real>& s, const Real& h);
  Real interaction(const VectorColumn<Real>& x, bool skip_inner, Index first, bool energy);
  Real indirect(const VectorColumn<Real>& x, bool energy);
  Real without_arcs(const VectorColumn<Real>& x, bool energy);
  void about_center();
  Real other_forces(const VectorColumn<Real>& x, const Clock<Real>& clock, bool energy);
  Real newton(const ParticleSystem<Real>& s, VectorColumn<Real>& a, Request wanted);

  WisdomHolmanOptions options_;
  F forces_;
  Real g_ = Real(0);
  std::vector<std::int64_t> order_;
  std::vector<std::int64_t> within_;         ///< by particle, k of the mass M_k that its Kepler arc goes round
  std::vector<Real> masses_;                 ///< by particle
  std::vector<Real> interior_;               ///< M_k, mass of the first k + 1 bodies in order
  std::vector<Real> circled_;                ///< by particle, the mass that its Kepler arc goes round
  std::vector<Real> reduced_;                ///< by particle, the mass that makes its velocity a momentum
  double moment_ = 0;                        ///< time of the kick
  std::vector<Real> scale_;                  ///< by particle, of its velocity: m_i over the reduced mass
  mutable std::vector<Vec3<Real>> centers_;  ///< of these, as the last change of coordinates met them
  VectorColumn<Real> scratch_, positions_, acceleration_, other_, along_;
  std::optional<ParticleSystem<Real>> inertial_;  ///< positions for other forces
  Workspace workspace_;                           ///< of other forces: no list of neighbors in it
  Primary primary_;
  std::optional<Failure> failure_;
  Evaluations evaluations_;
  EncounterWatch encounters_;
  bool observing_ = false;
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

#include "integrators/wisdom_holman_impl.hpp"  // IWYU pragma: keep
