#pragma once
/// The shearing sheet: epicycles A, exact for any time, and kicks B by all forces.

#include "engine/concepts.hpp"
#include "engine/description.hpp"
#include "engine/erasure.hpp"
#include "engine/sums.hpp"
#include "forces/hill_frame.hpp"
#include "forces/sum.hpp"
#include "integrators/epicycle.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/sheared_box.hpp"
#include "integrators/sphere_contacts.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

namespace noether {

/// Parameters of `ShearingSheet`.
struct ShearingSheetOptions {
  double Omega = 1;                    ///< angular velocity of the frame [1/time]
  std::optional<double> Omega_z = {};  ///< of oscillations across the plane [1/time]; default: Omega

  static constexpr auto describe() {
    return part<ShearingSheetOptions>(
        "shearing_sheet", "a patch of a disc in a frame that turns with it: epicycles A, and kicks B by all forces",
        formula("H = sum m [v^2/2 - 3 Omega^2 x^2/2 + Omega_z^2 z^2/2] + U(q, t),  p = m (v_x, v_y + 2 Omega x, v_z)"),
        source("Hill1878, ReinTremaine2011"), letter('A', "epicycles"), letter('B', "kicks"),
        field<&ShearingSheetOptions::Omega>("Omega", "1/time", "angular velocity of the frame")
            .required("\"1.3143527e-4 1/s\""),
        field<&ShearingSheetOptions::Omega_z>("Omega_z", "1/time",
                                              "angular velocity of oscillations across the plane; default: Omega"));
  }
  /// @throws Error  for an Omega that is not above 0, or a negative Omega_z
  void check() const;

  SheetRates rates() const { return {Omega, Omega_z.value_or(Omega)}; }
  /// What the frame adds to the forces of a scene: methods that do not split serve it too.
  std::tuple<HillFrame> forces() const { return {HillFrame{rates().Omega, rates().Omega_z}}; }
  template <class Real> AnyHamiltonian<Real> split(ForceField<Real> forces) const;
};

/// Particles near a point that goes round a primary on a circle with angular velocity Omega, x away from the primary, y
/// along the motion, z along the axis (Hill's approximation):
///
///     A:  x'' = 2 Omega y' + 3 Omega^2 x,   y'' = - 2 Omega x',   z'' = - Omega_z^2 z    (integrators/epicycle.hpp)
///     B:  v -> v + h F/m
///
/// Both are exact flows, and quadratic in momenta, so every scheme keeps its order, and where forces are weak those for
/// near-integrable systems have theirs in the strength of the forces. Velocities are those in the turning frame;
/// canonical momenta are m (v_x, v_y + 2 Omega x, v_z), which copies for observers that want the action show in the
/// place of m v. Conserved is the energy in the turning frame, of which Jacobi's constant is - 2. The action of A is
/// half of what p . q gains, that of B is - h U.
///
/// With hard spheres A is the motion of free particles that rebound from each other, and runs forward only: it is still
/// an exact flow, but a kick is shared alike between the time before a contact in a step and the time after it.
/// @cost 29 operations a particle for A; one evaluation of the forces for B, nothing where there are none
/// @source Hill1878, ReinTremaine2011
template <class F, class Real = double> class ShearingSheet {
 public:
  using real = Real;

  /// @throws SchemeMismatch  if a force depends on velocities; Error for rates that are none
  explicit ShearingSheet(F forces, ShearingSheetOptions options = {})
      : kicks_(std::move(forces)), rates_(options.rates()), frame_{rates_.Omega, rates_.Omega_z} {
    options.check();
  }

  std::string name() const { return "shearing_sheet"; }
  HamiltonianClaims claims() const {
    HamiltonianClaims claims = kicks_.claims();
    claims.periodic = knows_boxes;
    claims.keeps_momentum = claims.keeps_angular_momentum = false;
    if (spheres_) {
      claims.irreversible = "A";
      claims.dissipative = spheres_->law().dissipates();
      claims.symplectic = false;
      claims.columns = true;
      claims.no_action = "hard spheres rebound in no time, so the motion has no action";
    }
    if (!boxed_) return claims;
    claims.coordinates = unsheared;
    claims.inertial = false;
    claims.time_dependent = forces_act_ || spheres_;  // where the images are
    claims.no_action = "the coordinates of a sheet in a box move with its shear, and have no action";
    return claims;
  }
  const F& forces() const { return kicks_.forces(); }
  /// Makes those particles that have a radius hard spheres.
  void add_spheres(const HardSpheres& law) requires std::is_same_v<Real, double> { spheres_.emplace(law); }

  /// @throws Error  in a periodic box with other forces than gravity
  void bind(ParticleSystem<Real>& s);
  void expect_kicks(double longest) { kicks_.expect_kicks(longest); }
  bool set_neighbor_options(const NeighborOptions& options) { return kicks_.set_neighbor_options(options); }
  void open(ParticleSystem<Real>& s);
  void close(ParticleSystem<Real>& s);

  void flow(char letter, ParticleSystem<Real>& s, const Real& h);
  Real flow_with_action(char letter, ParticleSystem<Real>& s, const Real& h);
  /// Letter by letter; in a box the end of a drift across two steps follows from the word. Where no forces act a block
  /// of particles makes many steps at a time, with the same bits.
  Advance run(const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span);
  EnergyTerms<Real> energy(const ParticleSystem<Real>& s);
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a);

  void observe(std::optional<Request> wanted) {
    kicks_.observe(wanted);
    observing_ = wanted.has_value();
    shows_momenta_ = wanted && wanted->action;
  }
  const std::optional<Failure>& failure() const { return failure_ ? failure_ : kicks_.failure(); }
  Evaluations evaluations() const { return boxed_ ? Evaluations{.force = evaluations_} : kicks_.evaluations(); }
  void save(SavedState& saved, const std::string& prefix) const {
    detail::save_signature(saved, prefix + "frame/", frame_);
    if (spheres_) detail::save_signature(saved, prefix + "spheres/", spheres_->law());
    kicks_.save(saved, prefix);
    save_value(saved, prefix + "evaluations_in_box", evaluations_);
  }
  /// @throws Error  if the saved sheet turned otherwise, or had other spheres or forces
  void load(const SavedState& saved, const std::string& prefix) {
    detail::check_signature(saved, prefix + "frame/", frame_);
    if (spheres_) detail::check_signature(saved, prefix + "spheres/", spheres_->law());
    failure_.reset();
    kicks_.load(saved, prefix);
    load_value(saved, prefix + "evaluations_in_box", evaluations_);
  }

 private:
  static constexpr bool remembers = std::is_same_v<Real, double>, in_blocks = remembers;
  static constexpr bool knows_boxes = std::is_same_v<Real, double> || std::is_same_v<Real, Quad>;
  struct NoBox {};
  struct Known {
    Real h = Real(0);
    Epicycle<Real> epicycle;
  };

  const Epicycle<Real>& epicycle(const Real& h);
  void move(ParticleSystem<Real>& s, const Epicycle<Real>& epicycle);
  Advance run_free(const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span);
  void move_all(ParticleSystem<Real>& s);
  /// @param end  time at the end of the epicycle
  void move_to(ParticleSystem<Real>& s, const Epicycle<Real>& epicycle, const Real& end);
  /// An epicycle of spheres that touch, in pieces where they are too fast to be followed at once.
  void move_spheres(ParticleSystem<Real>& s, const Real& h, const Real& end);
  void flow_in_box(char letter, ParticleSystem<Real>& s, const Real& h, const Real& end);

  KineticPotential<F, Real> kicks_;
  SheetRates rates_;
  HillFrame frame_;
  std::array<Known, remembers ? 32 : 1> known_;  ///< a word has few lengths, and theirs take longer than a small step
  std::size_t count_ = 0, next_ = 0;
  std::array<Epicycle<Real>, in_blocks ? 64 : 1> arcs_;  ///< that all particles are still to make
  std::size_t waiting_ = 0;
  std::conditional_t<knows_boxes, ShearedBox<Real>, NoBox> box_;
  bool boxed_ = false;
  std::optional<SphereContacts> spheres_;
  std::optional<Failure> failure_;
  std::int64_t evaluations_ = 0;  ///< in a box
  bool forces_act_ = true;
  bool observing_ = false;
  bool shows_momenta_ = false;
};

template <class Real> AnyHamiltonian<Real> ShearingSheetOptions::split(ForceField<Real> forces) const {
  return ShearingSheet<ForceField<Real>, Real>(std::move(forces), *this);
}

/// Hard spheres as a part of A, for scenes: what `[[hamiltonian.force]] type = "hard_spheres"` makes of a sheet.
/// @throws SchemeMismatch  for another Hamiltonian
AnyHamiltonian<double> with_letter(const HardSpheres& law, const AnyHamiltonian<double>& hamiltonian);

template <class F> ShearingSheet(F) -> ShearingSheet<F, double>;
template <class F> ShearingSheet(F, ShearingSheetOptions) -> ShearingSheet<F, double>;

extern template class ShearingSheet<ForceField<double>>;
extern template class ShearingSheet<ForceField<Quad>, Quad>;
extern template struct detail::HamiltonianModel<ShearingSheet<ForceField<double>>>;
extern template struct detail::HamiltonianModel<ShearingSheet<ForceField<Quad>, Quad>>;

}  // namespace noether

#include "integrators/shearing_sheet_impl.hpp"  // IWYU pragma: keep
