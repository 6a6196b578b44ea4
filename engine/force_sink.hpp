#pragma once
/// Where forces write: accelerations always, energy and virial only where somebody asked.

#include "engine/outcome.hpp"
#include "engine/particle_system.hpp"
#include "engine/workspace.hpp"
#include "numbers/dual.hpp"
#include "numbers/wide_sum.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace noether {

class NeighborList;
class LaneByLane;
template <class Real> class SecantTangent;

/// What is to be summed beside the accelerations. In one byte: three that are stored one by one and read as a word wait
/// for each other, which a look at a step of six bodies feels.
struct Request {
  bool energy : 1 = false;
  bool virial : 1 = false;
  bool action : 1 = false;  ///< of the flows: by integrators, not by forces
};

/// Collects what the forces of one evaluation give.
///
///     a_i = sum of accelerations + (sum of forces) / m_i,   U = sum of energies,   W = sum of x_i (x) f_i
///
/// A tracer (m = 0) feels `acceleration` and ignores `force` and `pair`. The bits of the accelerations are the same
/// with and without energy and virial.
template <class Real> class ForceSink {
 public:
  /// @param accelerations  shape (n, 3), set to zero here [length/time^2]
  /// @param workspace  of the Hamiltonian, with the neighbor list that forces of short range share; without, each force
  ///   begins with nothing
  /// @param kick  the longest for which velocities are to change by these accelerations [time]; 0: not known
  ForceSink(VectorColumn<Real>& accelerations, const ParticleSystem<Real>& system, Request wanted,
            Workspace* workspace = nullptr, double kick = 0)
      : a_(accelerations), system_(system), wanted_(wanted), shared_(workspace), own_(workspace), kick_(kick) {
    if (wanted.virial) virial_.emplace();
    if (a_.size() < parallel_threshold) {
      a_.set_zero();
    } else {
      for_blocks(a_.size(), [&](Index begin, Index end) { a_.set_zero(begin, end); });
    }
  }

  /// For one force alone, which `sets` the accelerations: they hold anything.
  static ForceSink unset(VectorColumn<Real>& accelerations, const ParticleSystem<Real>& system) {
    return ForceSink(accelerations, system);
  }

  /// Adds `a` to the acceleration of particle `i` [length/time^2].
  void acceleration(Index i, const Vec3<Real>& a) {
    a_.add(i, a);
    if (virial_) virial_->add_outer(system_.positions()[i], system_.masses()[i] * a);
  }
  /// Adds the force `f` on particle `i` [mass length/time^2].
  void force(Index i, const Vec3<Real>& f) {
    push(i, f);
    if (virial_) virial_->add_outer(system_.positions()[i], f);
  }
  /// Adds `f` on particle `i` and `-f` on particle `j`: Newton's third law [mass length/time^2].
  void pair(Index i, Index j, const Vec3<Real>& f) {
    push(i, f);
    push(j, -f);
    if (!virial_) return;
    virial_->add_outer(system_.box().minimum_image(Vec3<Real>(system_.positions()[i] - system_.positions()[j])), f);
  }
  /// Adds to the potential energy [energy], in sums that hardly know an order. A force that has summed its terms itself
  /// does so in a `WideSum`, and its virial in a `WideTensor`.
  void energy(const Real& u) {
    if (wanted_.energy) energy_ += u;
  }
  void energy(const WideSum<Real>& u) {
    if (wanted_.energy) energy_ += u;
  }
  /// Adds to the virial tensor sum x (x) f what a force that writes `accelerations()` directly has summed [energy].
  void virial(const Mat3<Real>& w) {
    if (virial_) *virial_ += w;
  }
  void virial(const WideTensor<Real>& w) {
    if (virial_) *virial_ += w;
  }

  bool wants_energy() const { return wanted_.energy; }
  bool wants_virial() const { return wanted_.virial; }
  /// The column itself, for loops that own their rows; such a force adds to it, and reports its virial.
  VectorColumn<Real>& accelerations() { return a_; }

  /// Whether they hold sums so far; else a force writes them all.
  bool has_sums() const { return has_sums_; }

  /// The neighbor list of the system; null where there is none to be shared.
  NeighborList* neighbors() const { return shared_ != nullptr ? shared_->find<NeighborList>() : nullptr; }
  /// Where this force keeps what it wants to find again at its next evaluation (engine/workspace.hpp).
  Workspace& workspace() {
    if (own_ != nullptr) return *own_;
    if (!lost_) lost_ = std::make_unique<Workspace>();
    return *lost_;
  }
  /// Calls `add()` for term `k` of a sum, which has a workspace of its own.
  template <class Add> void in_room(std::size_t k, const Add& add) {
    if (own_ == nullptr) {
      std::unique_ptr<Workspace> outer = std::move(lost_);
      add();
      lost_ = std::move(outer);
      return;
    }
    Workspace* const outer = std::exchange(own_, &own_->room(k));
    add();
    own_ = outer;
  }

  /// Sums the forces of the kicks of one letter only, as multiple time steps do.
  void set_kick_letter(char letter) { letter_ = letter; }
  /// Whether a force of these kicks (`ForceClaims::kicks`) is summed here.
  bool takes(std::string_view kicks) const { return kicks.find(letter_) != std::string_view::npos; }
  /// Whether forces of all kicks are.
  bool takes_all() const { return letter_ == 0; }
  /// The letter whose kicks are summed; 0: of all.
  char kick_letter() const { return letter_; }

  /// Lets forces write their torques into a column, set to zero here [mass length^2/time^2].
  void set_torques(VectorColumn<Real>& torques) {
    torques_ = &torques;
    torques.set_zero();
  }
  /// Whether somebody asked for torques; most sinks drop them.
  bool wants_torques() const { return torques_ != nullptr; }
  /// Adds the torque `t` on particle `i` about its own centre [mass length^2/time^2].
  void torque(Index i, const Vec3<Real>& t) {
    if (torques_ != nullptr) torques_->add(i, t);
  }
  /// Lets fields write the rates at which they turn velocities, v' = v x rate with rate = q B/m [1/time], into a
  /// column, set to zero here: a sink without one gets v x rate among the accelerations.
  void set_gyrations(VectorColumn<Real>& rates) {
    gyrations_ = &rates;
    rates.set_zero();
  }
  /// Adds to the acceleration of particle `i` what a magnetic field makes of its velocity, v_i x `rate`, with
  /// rate = q B/m [1/time]; a tracer feels none.
  void gyration(Index i, const Vec3<Real>& rate) {
    if (gyrations_ != nullptr) {
      gyrations_->add(i, rate);
    } else {
      acceleration(i, cross(system_.velocities()[i], rate));
    }
  }
  /// Lets fields write q A, the part of the canonical momenta that is theirs, into a column, set to zero here
  /// [mass length/time]; those without a vector potential `fail`.
  void set_field_momenta(VectorColumn<Real>& momenta) {
    field_momenta_ = &momenta;
    momenta.set_zero();
  }
  bool wants_field_momenta() const { return field_momenta_ != nullptr; }
  /// Adds q A of particle `i` [mass length/time].
  void field_momentum(Index i, const Vec3<Real>& p) {
    if (field_momenta_ != nullptr) field_momenta_->add(i, p);
  }
  /// Lets secants add by how much they change with the second state (forces/secant_tangent.hpp).
  void set_tangent(SecantTangent<Real>* tangent) { tangent_ = tangent; }
  /// Null where nobody asked for it.
  SecantTangent<Real>* tangent() const { return tangent_; }
  /// The longest kick by these accelerations [time]; 0 where it is not known.
  double kick() const { return kick_; }
  /// Where lanes that differ are evaluated one by one (engine/lane_by_lane.hpp); null: nobody has seen them differ.
  LaneByLane* lane_by_lane() const { return lane_by_lane_; }
  void set_lane_by_lane(LaneByLane* place) { lane_by_lane_ = place; }
  /// Tells that the force cannot be computed; the first to say so is heard.
  void fail(Failure failure) {
    if (!failure_) failure_ = std::move(failure);
  }
  const std::optional<Failure>& failure() const { return failure_; }

  Real potential() const { return energy_.value(); }
  Mat3<Real> virial() const { return virial_ ? virial_->value() : Mat3<Real>(Mat3<Real>::Zero()); }

 private:
  friend class LaneByLane;
  ForceSink(VectorColumn<Real>& accelerations, const ParticleSystem<Real>& system)
      : a_(accelerations), system_(system), wanted_{}, has_sums_(false) {}

  void push(Index i, const Vec3<Real>& f) {
    const Real m = system_.masses()[i];
    if (m != Real(0)) a_.add(i, f / m);
  }

  VectorColumn<Real>& a_;
  const ParticleSystem<Real>& system_;
  Request wanted_;
  WideSum<Real> energy_;
  std::optional<WideTensor<Real>> virial_;  ///< where it is wanted: nine sums in lanes take as long as a few forces
  Workspace* shared_ = nullptr;             ///< of the whole Hamiltonian
  Workspace* own_ = nullptr;                ///< of the force that is summed
  std::unique_ptr<Workspace> lost_;         ///< of a force to which nobody lends one: gone with the sink
  VectorColumn<Real>* torques_ = nullptr;
  VectorColumn<Real>* gyrations_ = nullptr;
  VectorColumn<Real>* field_momenta_ = nullptr;
  SecantTangent<Real>* tangent_ = nullptr;
  double kick_ = 0;
  char letter_ = 0;  ///< 0: of all kicks
  bool has_sums_ = true;
  LaneByLane* lane_by_lane_ = nullptr;
  std::optional<Failure> failure_;
};

/// Whether secants tell by how much they change with the second state, and for how many pairs of particles.
enum class TangentPattern : std::uint8_t {
  none,   ///< they do not tell
  full,   ///< for all pairs, or so many that a matrix of them is not sparse
  sparse  ///< for few: each particle feels some others, the same ones at all times
};

/// What a force says of itself; a method states what it needs, and a refusal names what is missing.
struct ForceClaims {
  bool energy = true;  ///< it is the gradient of a potential and reports it
  bool virial = true;  ///< it reports its virial
  bool velocity_dependent = false;
  bool gyrates = false;  ///< its dependence on velocities is v x rate alone, which it tells by `gyration`
  bool time_dependent = false;
  bool dissipative = false;
  bool keeps_momentum = true;           ///< its sum over all particles is 0
  bool keeps_angular_momentum = true;   ///< and so is that of its torques
  bool periodic = false;                ///< it knows periodic boxes
  bool sets = false;                    ///< alone, in lanes, it can write accelerations instead of adding to them
  bool kepler = false;                  ///< two bodies under it alone move on Kepler orbits
  bool fixed_figure = false;            ///< it gives particle 0 a figure that stays where it is: no torque
  bool turning_figures = false;         ///< it has the second degree of rigid bodies, at least of particle 0
  std::optional<double> G = {};         ///< of `kepler` [length^3/mass/time^2]; default: the unit system's own
  double softening = 0;                 ///< of `kepler` [length]
  bool bonded = false;                  ///< it acts on the bonds, angles and dihedrals of the structure
  bool meshed = false;                  ///< it acts on the tetrahedra of the structure
  bool pair_coefficients = false;       ///< it takes the coefficients that a structure has for pairs of types
  bool on_bodies = false;               ///< it acts on rigid bodies themselves and gives their torques, not on sites
  std::optional<bool> charges = {};     ///< it looks at charges; empty: it does not say
  std::optional<bool> exclusions = {};  ///< it leaves excluded pairs out; empty: it does not say
  double drag = 0;                      ///< v' = - drag v, the same for all particles [1/time]
  std::string kicks = "B";              ///< letters of the kicks that it takes part in
  double range = 0;  ///< distance beyond which pairs do not feel each other [length]; 0: any distance
  TangentPattern tangent =
      TangentPattern::none;  ///< of its secants; those added by `Secants` (forces/secant.hpp) have one
};

/// The claims of a force type; a force that declares none is conservative, depends on positions only, and acts
/// between particles.
template <class F> ForceClaims claims_of(const F& force) {
  if constexpr (requires { force.claims(); }) {
    return force.claims();
  } else {
    return {};
  }
}

/// Asks a force whether it can act on these particles, in their box: before the first step, so that nothing has to be
/// asked later.
/// @throws Error  naming what is missing
template <class F, class Real> void check_force(const F& force, const ParticleSystem<Real>& s) {
  if (s.box().is_periodic() && !claims_of(force).periodic) {
    throw Error("a periodic box needs forces between nearest images; one of the forces does not support it");
  }
  if constexpr (requires { force.check(s); }) force.check(s);
}

/// Makes a force ready for particles: checks them, and lets it take from them what it wants to know before the run,
/// such as where the particles of given ids stand now.
/// @throws Error  see `check_force`
template <class F, class Real> void bind_force(F& force, const ParticleSystem<Real>& s) {
  check_force(force, s);
  if constexpr (requires { force.bind(s); }) force.bind(s);
}

/// A term of the force: it adds to a sink what it does to the particles, at their stage time.
template <class F, class Real>
concept Force = requires(const F& force, ForceSink<Real>& out, const ParticleSystem<Real>& system) {
  force.add_to(out, system);
};

/// Whether exact derivatives of a force can be had: by the same code over dual numbers.
///
/// A force written for one number type has none; an erased one or a sum says what its parts can do.
template <class Real, class F> bool has_derivative(const F& force) {
  if constexpr (!Force<F, Dual<Real, 1>>) {
    return false;
  } else if constexpr (requires { force.has_derivative(); }) {
    return force.has_derivative();
  } else {
    return true;
  }
}

/// Whether a force knows its secants between two states: `add_secant_to(out, from, to)` adds forces f_i, the same for
/// both ways, for which sum f_i . (x_i(to) - x_i(from)) = U(from) - U(to) to rounding. Methods that keep the energy at
/// any step stand on them.
template <class Real, class F> bool has_secant(const F& force) {
  if constexpr (requires { force.has_secant(); }) {
    return force.has_secant();
  } else {
    return requires(ForceSink<Real> & out, const ParticleSystem<Real>& s) { force.add_secant_to(out, s, s); };
  }
}

}  // namespace noether
