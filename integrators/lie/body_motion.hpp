#pragma once
/// Rigid bodies under forces as a field on a Lie group.

#include "engine/bodies.hpp"
#include "forces/sum.hpp"
#include "integrators/classical.hpp"
#include "integrators/lie/group_options.hpp"
#include "integrators/lie/lie_field.hpp"

#include <memory>
#include <string>

namespace noether {

/// Centres x, v and bodies q, S among them, on SO(3)^n x R^m or on SE(3)^n x R^m:
///
///     x' = v,   v' = a(t, x, v, q),   q' = q (0, Omega)/2,   S' = torque(t, x, q),   Omega = I^-1 R^T S
///     Pi' = Pi x Omega + R^T torque,   Pi = R^T S                                     (spins in the axes of bodies)
///
/// y holds all x, then all y, then all z of the places, then those of velocities, of orientations (w, x, y, z) and of
/// spins in space, shape (13 n); an element has the rates of places, velocities, orientations (in the body's own axes)
/// and spins in the same order, shape (12 n). A point beside bodies has no moments and does not turn.
/// @cost the forces, and of each body two rotation matrices a velocity, an exponential and two matrices a motion
template <class Real> class BodyMotion final : public LieField<Real> {
 public:
  /// @param forces  on bodies: those on their sites stand in OnSites (forces/on_sites.hpp)
  /// @param name  of the Hamiltonian the forces come from, as reports show it
  explicit BodyMotion(ForceField<Real> forces, GroupOptions options = {}, std::string name = "kinetic_potential")
      : forces_(std::move(forces)), options_(options), name_(std::move(name)) {}

  std::unique_ptr<VectorField<Real>> clone() const override { return std::make_unique<BodyMotion>(*this); }
  FieldClaims claims() const override;
  std::string signature() const override { return forces_.signature(); }
  /// @throws Error  for particles without bodies among them
  void bind(const ParticleSystem<Real>& s) override;
  Index size() const override { return 13 * work_.size(); }
  Index particles() const override { return work_.size(); }
  void gather(const ParticleSystem<Real>& s, Vector<Real>& y) const override;
  void scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const override;
  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) override;
  std::optional<Mat3<Real>> virial(const ParticleSystem<Real>& s) override;
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) override;

  Index algebra() const override { return 12 * work_.size(); }
  void act(const Vector<Real>& u, const Vector<Real>& y, Vector<Real>& out) override;
  void bracket(const Vector<Real>& u, const Vector<Real>& v, Vector<Real>& out) override;
  void sizes(const Vector<Real>& y, const Vector<Real>& y1, double h, Vector<double>& out) const override;

 protected:
  void find_velocity(const Real& t, const Vector<Real>& y, Vector<Real>& a) override;
  void evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) override;
  void measure_particles(const Vector<Real>& y, double rtol, ParticleScales& scales) override;

 private:
  /// Accelerations and torques at y.
  void sum(const Real& t, const Vector<Real>& y);
  bool turns(Index i) const { return turns_[static_cast<std::size_t>(i)] != 0; }

  ForceField<Real> forces_;
  GroupOptions options_;
  std::string name_;
  Coupling coupling_;
  Workspace workspace_;
  ParticleSystem<Real> work_;
  VectorColumn<Real> a_, torque_;
  std::vector<char> turns_;  ///< by particle
};

extern template class BodyMotion<double>;
extern template class BodyMotion<Quad>;

/// A method on a Lie group over the forces on rigid bodies: `lie(forces, method("rkmk_rk4"))`.
/// @throws Error  see `make_method`
inline Classical<double> lie(ForceField<double> forces, const MethodChoice& choice) {
  return Classical<double>(std::make_unique<BodyMotion<double>>(std::move(forces), group_options_of(choice.options)),
                           choice);
}

}  // namespace noether
