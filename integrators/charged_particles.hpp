#pragma once
/// Charges in fields: free motion, and kicks that turn velocities about the magnetic field.

#include "engine/concepts.hpp"
#include "engine/description.hpp"
#include "engine/erasure.hpp"
#include "engine/proper_velocity.hpp"
#include "engine/word.hpp"
#include "forces/sum.hpp"
#include "integrators/charge_lanes.hpp"
#include "integrators/field_forces.hpp"
#include "integrators/gyration.hpp"
#include "integrators/kinetic_potential.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace noether {

/// How a kick turns velocities.
enum class Rotation : std::uint8_t {
  exact,       ///< the helix of constant fields: B is an exact flow
  boris,       ///< half a kick by E, a turn by 2 atan(h omega/2), half a kick: no sine
  hyper_boris  ///< several such turns in closed form, with a better angle
};
/// How particles near the speed of light are kicked.
enum class Relativistic : std::uint8_t { no, boris, vay, higuera_cary };

template <> struct EnumNames<Rotation> {
  static constexpr std::array<std::pair<Rotation, std::string_view>, 3> values = {
      {{Rotation::exact, "exact"}, {Rotation::boris, "boris"}, {Rotation::hyper_boris, "hyper_boris"}}};
};
template <> struct EnumNames<Relativistic> {
  static constexpr std::array<std::pair<Relativistic, std::string_view>, 4> values = {
      {{Relativistic::no, "no"},
       {Relativistic::boris, "boris"},
       {Relativistic::vay, "vay"},
       {Relativistic::higuera_cary, "higuera_cary"}}};
};

/// Parameters of `ChargedParticles`.
struct ChargedParticlesOptions {
  Rotation rotation = Rotation::exact;
  std::int64_t cycles = 2;           ///< of `hyper_boris`: turns in a kick
  std::int64_t gyrophase_order = 2;  ///< of `hyper_boris`: of the angle of each
  Relativistic relativistic = Relativistic::no;
  bool canonical = false;        ///< methods for y' = f move p = m v + q A in the place of v
  std::optional<double> c = {};  ///< speed of light [length/time]; default: that of the unit system

  static constexpr auto describe() {
    return part<ChargedParticlesOptions>(
        "charged_particles",
        "charges in fields: free motion A, and kicks B that turn velocities about the magnetic field",
        formula("x' = v,  m v' = q (E(t, x) + v x B(t, x)) + other forces"),
        source("Boris1970, QinEtAl2013, HeEtAl2015, Vay2008, HigueraCary2017, ZenitaniKato2020"), letter('A', "drifts"),
        letter('B', "kicks and turns"),
        field<&ChargedParticlesOptions::rotation>("rotation", "1",
                                                  "how kicks turn velocities: exact; boris, by 2 atan(h omega/2); "
                                                  "hyper_boris, in cycles of better angles"),
        field<&ChargedParticlesOptions::cycles>("cycles", "1", "of rotation = \"hyper_boris\": turns in a kick"),
        field<&ChargedParticlesOptions::gyrophase_order>(
            "gyrophase_order", "1", "of rotation = \"hyper_boris\": order of the angle of each turn, even"),
        field<&ChargedParticlesOptions::relativistic>(
            "relativistic", "1",
            "no; or how particles near the speed of light are kicked: boris, vay, or higuera_cary, which keeps volume "
            "and gets drifts across fields right"),
        field<&ChargedParticlesOptions::canonical>(
            "canonical", "1",
            "methods for y' = f move p = m v + q A in the place of v, under H = |p - q A|^2/2m + q phi; those of an "
            "energy H(q, p), such as semiexplicit_2, tao_2 and avf, do so anyway"),
        field<&ChargedParticlesOptions::c>("c", "length/time", "speed of light; default: that of the unit system"));
  }
  /// @throws Error  for options that do not go together
  void check() const;

  /// Nothing in itself but the motion: methods that do not split serve it too, but not at the speed of light.
  std::tuple<> forces() const { return {}; }
  bool only_forces() const { return relativistic == Relativistic::no; }
  /// The speed of light of relativistic particles [length/time]; empty for others. @throws Error  where none is known
  std::optional<double> light(const UnitSystem& units) const;
  template <class Real> AnyHamiltonian<Real> split(ForceField<Real> forces) const;
};

/// Charges in fields, beside any other forces F(t, x):
///
///     A:  x -> x + h v
///     B:  v -> the flow of v' = F/m + q E/m + v x Omega, Omega = q B/m, at fixed t and x, or a symmetric map like it
///
/// Both are exact where `rotation` is, and every scheme of the general class keeps its order; with `boris` and
/// `hyper_boris` B is a symmetric map of order 2, and compositions are made of whole steps A B A. Both keep the volume
/// in (x, v), and neither is symplectic in (x, m v + q A): where B changes from place to place no drift with v fixed is
/// the flow of a Hamiltonian. What is conserved nevertheless is bounded for long times where the field has symmetries
/// (docs/theory/fields.md). Fields tell q B/m by `ForceSink::gyration`; other forces may not depend on velocities.
///
/// Relativistic, the velocity column is the proper velocity u = gamma v while a run goes on; what is shown is v with
/// its low word, without which gamma could not be told near the speed of light:
///
///     A:  x -> x + h u/gamma    B:  u' = F/m + q E/m + u x Omega/gamma by `relativistic`    H = sum m c^2 (gamma - 1)
///
/// Where nothing but fields of closed forms acts (uniform, gradient, dipole, tokamak, trap), 64 charges at a time make
/// many steps in lanes, with the bits of letter by letter.
/// @cost one evaluation of the fields and forces per B; 40 operations a particle for the turn, and with `exact` a sine
/// @source Boris1970, QinEtAl2013, HeEtAl2015, Vay2008, HigueraCary2017, ZenitaniKato2020
template <class F, class Real = double> class ChargedParticles : public detail::ChargesInFields<F, Real> {
 public:
  /// @throws SchemeMismatch  if a force depends on velocities otherwise than fields do; Error for options that do not
  ///         go together
  explicit ChargedParticles(F forces, ChargedParticlesOptions options = {})
      : detail::ChargesInFields<F, Real>(std::move(forces), "charged_particles"),
        options_(options),
        angle_(angle_of(options)) {
    options_.check();
  }

  std::string name() const { return "charged_particles"; }
  HamiltonianClaims claims() const {
    const bool exact = options_.rotation == Rotation::exact && !relativistic();
    return this->with_forces(
        {.alphabet = "AB",
         .inexact = exact ? "" : "B",
         .basic = exact ? "BAB" : "ABA",  // no two maps of order 2 are joined
         .symplectic = false,
         .no_action = "no Hamiltonian has its kicks, which turn velocities, as a flow, so the motion has no action",
         .coordinates = std::uint8_t(relativistic() ? proper_velocities : 0),
         .inertial = !relativistic(),
         .keeps_momentum = !relativistic(),  // of m v, which is what is watched
         .keeps_angular_momentum = !relativistic(),
         .steps_at_once = steps_at_once()});
  }

  /// @throws Error  without a speed of light that a relativistic run needs, and for particles as fast as it
  void bind(ParticleSystem<Real>& s);
  void open(ParticleSystem<Real>& s);
  void close(ParticleSystem<Real>& s);
  void flow(char letter, ParticleSystem<Real>& s, const Real& h);
  /// Whole steps: where there is nothing but fields of closed forms, in lanes, each charge for many steps.
  Advance run(const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span);
  EnergyTerms<Real> energy(const ParticleSystem<Real>& s);
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a);
  void save(SavedState& saved, const std::string& prefix) const;
  void load(const SavedState& saved, const std::string& prefix);

 private:
  using Base = detail::ChargesInFields<F, Real>;
  using Base::forces_, Base::observing_;

  static GyrationAngle<Real> angle_of(const ChargedParticlesOptions& options) {
    if (options.rotation == Rotation::boris) return GyrationAngle<Real>(1, 2);
    return options.rotation == Rotation::exact ? GyrationAngle<Real>()
                                               : GyrationAngle<Real>(options.cycles, options.gyrophase_order);
  }
  bool relativistic() const { return options_.relativistic != Relativistic::no; }
  void drift(ParticleSystem<Real>& s, const Real& h);
  void kick(ParticleSystem<Real>& s, const Real& h);
  Vec3<Real> pushed(const Vec3<Real>& u, Index i, const Real& h) const;
  void bind_lanes(const ParticleSystem<Real>& s);
  std::int64_t steps_at_once() const {
    if constexpr (has_lanes) return lanes_.steps_at_once();
    return 1;
  }

  static constexpr bool has_lanes = std::is_same_v<Real, double>;
  struct NoLanes {};

  ChargedParticlesOptions options_;
  GyrationAngle<Real> angle_;
  Real c_ = Real(0);  ///< speed of light, where it matters
  std::conditional_t<has_lanes, ChargeLanes, NoLanes> lanes_;
  std::vector<ChargeLetter> letters_;  ///< of the steps that lanes make at once
};

template <class Real> AnyHamiltonian<Real> ChargedParticlesOptions::split(ForceField<Real> forces) const {
  return ChargedParticles<ForceField<Real>, Real>(std::move(forces), *this);
}

// `ChargedParticles(Tokamak{.B0 = 1}, {.rotation = Rotation::boris})`; several fields and forces as a Sum of InFields.
template <class F> ChargedParticles(F) -> ChargedParticles<typename detail::OnCharges<F>::type, double>;
template <class F>
ChargedParticles(F, ChargedParticlesOptions) -> ChargedParticles<typename detail::OnCharges<F>::type, double>;

extern template class ChargedParticles<ForceField<double>>;
extern template class ChargedParticles<ForceField<Quad>, Quad>;
extern template struct detail::HamiltonianModel<ChargedParticles<ForceField<double>>>;
extern template struct detail::HamiltonianModel<ChargedParticles<ForceField<Quad>, Quad>>;

}  // namespace noether

#include "integrators/charged_particles_impl.hpp"  // IWYU pragma: keep
