#pragma once
/// A Hamiltonian from outside the library: charges that turn about a uniform field, with a basic word of five letters.

#include "engine/concepts.hpp"
#include "engine/description.hpp"
#include "engine/signature.hpp"
#include "forces/sum.hpp"
#include "integrators/kinetic_potential.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace noether::test {

/// v' = omega e_z x v + a(x, t): drifts A, turns R of the velocities, kicks B.
///
/// Each flow is exact and keeps volumes; the drift alone is no canonical map of charges in a field, so no composition
/// of them is symplectic.
template <class F, class Real = double> class Gyrating {
 public:
  using real = Real;

  Gyrating(double omega, F forces) : omega_(omega), forces_(std::move(forces)) {}

  std::string name() const { return "gyration"; }
  HamiltonianClaims claims() const {
    const ForceClaims forces = claims_of(forces_);
    return {.alphabet = "ABR",
            .basic = "ARBRA",
            .quadratic_kinetic = false,
            .symplectic = false,
            .energy = forces.energy,
            .time_dependent = forces.time_dependent,
            .dissipative = forces.dissipative,
            .no_action = "drifts of charges in a field are not canonical maps, so the motion has no action",
            .keeps_momentum = false,
            .keeps_angular_momentum = false};
  }
  void bind(ParticleSystem<Real>& s) {
    bind_force(forces_, s);
    a_ = VectorColumn<Real>(s.size());
  }
  void open(ParticleSystem<Real>& /*inertial already*/) {}
  void close(ParticleSystem<Real>& /*inertial already*/) {}
  void flow(char letter, ParticleSystem<Real>& s, const Real& h) {
    if (letter == 'A') return s.advance_positions(h);
    if (letter == 'R') return turn(s, Real(omega_) * h);
    sum(s, {});
    s.advance_velocities(h, a_);
    if (!observing_) ++evaluations_.force;
  }
  /// @throws LogicError  always: see `claims`
  Real flow_with_action(char /*letter*/, ParticleSystem<Real>& /*s*/, const Real& /*h*/) {
    throw LogicError("charges that drift in a field have no action");
  }
  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) { return {kinetic_energy(s), sum(s, {.energy = true})}; }
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
    sum(s, {});
    a = a_;
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> v = s.velocities()[i];
      a.add(i, Vec3<Real>(-Real(omega_) * v[1], Real(omega_) * v[0], Real(0)));
    }
  }
  void observe(std::optional<Request> wanted) { observing_ = wanted.has_value(); }
  const std::optional<Failure>& failure() const { return failure_; }
  Evaluations evaluations() const { return evaluations_; }
  void save(SavedState& saved, const std::string& prefix) const {
    save_value(saved, prefix + "omega", omega_);
    detail::save_signature(saved, prefix, forces_);
    save_value(saved, prefix + "evaluations", evaluations_.force);
  }
  void load(const SavedState& saved, const std::string& prefix) {
    double omega = 0;
    load_value(saved, prefix + "omega", omega);
    if (omega != omega_) throw Error("the saved charges turn by another omega");
    detail::check_signature(saved, prefix, forces_);
    load_value(saved, prefix + "evaluations", evaluations_.force);
  }

 private:
  static void turn(ParticleSystem<Real>& s, const Real& angle) {
    using std::cos, std::sin;
    const Real c = cos(angle), d = sin(angle);
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> v = std::as_const(s).velocities()[i];
      s.velocities().set(i, Vec3<Real>(c * v[0] - d * v[1], d * v[0] + c * v[1], v[2]));
    }
  }
  Real sum(const ParticleSystem<Real>& s, Request wanted) {
    ForceSink<Real> sink(a_, s, wanted);
    forces_.add_to(sink, s);
    return sink.potential();
  }

  double omega_;
  F forces_;
  VectorColumn<Real> a_;
  bool observing_ = false;
  std::optional<Failure> failure_;
  Evaluations evaluations_;
};

/// The same as a part of scenes: `[hamiltonian] type = "gyration"`.
struct Gyration {
  double omega = 0;  ///< [1/time]

  static constexpr auto describe() {
    return part<Gyration>("gyration", "charges that turn about a uniform field along z",
                          formula("v' = omega e_z x v + a(x, t)"), letter('A', "drifts"),
                          letter('R', "turns of the velocities"), letter('B', "kicks"),
                          field<&Gyration::omega>("omega", "1/time", "how fast they turn").required("1"));
  }
  template <class Real> AnyHamiltonian<Real> split(ForceField<Real> forces) const {
    return Gyrating<ForceField<Real>, Real>(omega, std::move(forces));
  }
};

}  // namespace noether::test
