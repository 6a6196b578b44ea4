#pragma once
/// A Hamiltonian from outside the library whose state is more than positions and velocities: round bodies that turn.

#include "engine/columns.hpp"
#include "engine/concepts.hpp"
#include "engine/description.hpp"
#include "engine/signature.hpp"
#include "forces/sum.hpp"
#include "integrators/kinetic_potential.hpp"
#include "neighbors/neighbor_list.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace noether::test {

/// Unit quaternions (w, x, y, z) that turn a body's own axes into those of space.
struct Orientation {
  template <class Real> using type = RowColumn<Real, 4>;
  static constexpr std::string_view name = "orientation", dimension = "1";
  static constexpr ColumnRole role = ColumnRole::configuration;
  static constexpr std::array<double, 4> start = {1, 0, 0, 0};
};
/// Angular momenta about the bodies' own centres, in space.
struct Spin {
  template <class Real> using type = VectorColumn<Real>;
  static constexpr std::string_view name = "spin", dimension = "mass length^2/time";
  static constexpr ColumnRole role = ColumnRole::momentum;
};

template <class Real> using Quaternion = Eigen::Matrix<Real, 4, 1>;

template <class Real> Quaternion<Real> product(const Quaternion<Real>& a, const Quaternion<Real>& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}
/// The third axis of a body in space.
template <class Real> Vec3<Real> axis_of(const Quaternion<Real>& q) {
  return {Real(2) * (q[1] * q[3] + q[0] * q[2]), Real(2) * (q[2] * q[3] - q[0] * q[1]),
          q[0] * q[0] - q[1] * q[1] - q[2] * q[2] + q[3] * q[3]};
}

/// H = sum p^2 / 2 m + sum L^2 / 2 I + U(x, q): flights and turns A together, kicks and torques B, the basic word ABA.
///
/// Of round bodies both flows are exact: with L fixed a body turns about it by the angle |L| h / I.
template <class F, class Real = double> class SpinningTops {
 public:
  using real = Real;

  SpinningTops(double inertia, F forces) : inertia_(inertia), forces_(std::move(forces)) {}

  std::string name() const { return "tops"; }
  HamiltonianClaims claims() const {
    const ForceClaims forces = claims_of(forces_);
    return {.alphabet = "AB",
            .basic = "ABA",
            .energy = forces.energy,
            .time_dependent = forces.time_dependent,
            .dissipative = forces.dissipative,
            .no_action = "turns of bodies are not a motion of positions and momenta, so they have no action",
            .columns = true,
            .keeps_momentum = forces.keeps_momentum,
            .keeps_angular_momentum = false};
  }
  void bind(ParticleSystem<Real>& s) {
    s.add_column(column_info<Orientation>());
    s.add_column(column_info<Spin>());
    bind_force(forces_, s);
    workspace_ = Workspace();
    a_ = torque_ = VectorColumn<Real>(s.size());
  }
  void open(ParticleSystem<Real>& /*inertial already*/) {}
  void close(ParticleSystem<Real>& /*inertial already*/) {}
  void flow(char letter, ParticleSystem<Real>& s, const Real& h) {
    if (letter == 'A') {
      s.advance_positions(h);
      return turn(s, h);
    }
    sum(s, {});
    s.advance_velocities(h, a_);
    s.template column<Spin>().add_scaled(h, torque_);
    if (!observing_) ++evaluations_.force;
  }
  /// @throws LogicError  always: see `claims`
  Real flow_with_action(char /*letter*/, ParticleSystem<Real>& /*s*/, const Real& /*h*/) {
    throw LogicError("turns of bodies have no action");
  }
  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) {
    Real turning(0);
    const auto& spin = s.template column<Spin>();
    for (Index i = 0; i < s.size(); ++i) turning += norm2(spin[i]) / (Real(2) * Real(inertia_));
    const Real moving = kinetic_energy(s);
    return {moving + turning, sum(s, {.energy = true})};
  }
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
    sum(s, {});
    a = a_;
  }
  void observe(std::optional<Request> wanted) { observing_ = wanted.has_value(); }
  const std::optional<Failure>& failure() const { return failure_; }
  Evaluations evaluations() const { return evaluations_; }
  void save(SavedState& saved, const std::string& prefix) const {
    save_value(saved, prefix + "inertia", inertia_);
    detail::save_signature(saved, prefix, forces_);
    save_value(saved, prefix + "evaluations", evaluations_.force);
  }
  void load(const SavedState& saved, const std::string& prefix) {
    double inertia = 0;
    load_value(saved, prefix + "inertia", inertia);
    if (inertia != inertia_) throw Error("the saved bodies have another moment of inertia");
    detail::check_signature(saved, prefix, forces_);
    load_value(saved, prefix + "evaluations", evaluations_.force);
  }

 private:
  void turn(ParticleSystem<Real>& s, const Real& h) const {
    using std::cos, std::sin, std::sqrt;
    const auto& spin = std::as_const(s).template column<Spin>();
    auto& orientation = s.template column<Orientation>();
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> omega = spin[i] / Real(inertia_);
      const Real rate = sqrt(norm2(omega));
      if (rate == Real(0)) continue;
      const Real half = rate * h / Real(2), c = cos(half), d = sin(half) / rate;
      const Quaternion<Real> by(c, d * omega[0], d * omega[1], d * omega[2]);
      orientation.set(i, product(by, Quaternion<Real>(std::as_const(orientation)[i])));
    }
  }
  Real sum(const ParticleSystem<Real>& s, Request wanted) {
    ForceSink<Real> sink(a_, s, wanted, &workspace_);
    sink.set_torques(torque_);
    forces_.add_to(sink, s);
    return sink.potential();
  }

  double inertia_;
  F forces_;
  Workspace workspace_;
  VectorColumn<Real> a_, torque_;
  bool observing_ = false;
  std::optional<Failure> failure_;
  Evaluations evaluations_;
};

/// The same as a part of scenes.
struct Tops {
  double inertia = 1;  ///< [mass length^2]
  using columns = ColumnList<Orientation, Spin>;

  static constexpr auto describe() {
    return part<Tops>("tops", "round bodies that fly and turn", formula("H = sum p^2 / 2 m + sum L^2 / 2 I + U(x, q)"),
                      letter('A', "flights and turns"), letter('B', "kicks and torques"),
                      field<&Tops::inertia>("inertia", "mass length^2", "of each body about any axis of its own"));
  }
  template <class Real> AnyHamiltonian<Real> split(ForceField<Real> forces) const {
    return SpinningTops<ForceField<Real>, Real>(inertia, std::move(forces));
  }
};

}  // namespace noether::test
