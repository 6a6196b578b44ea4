#pragma once
/// Particles under any Hamiltonian as y' = f(t, y), y = (x, v).

#include "engine/erasure.hpp"
#include "forces/sum.hpp"
#include "integrators/particle_vector.hpp"
#include "integrators/vector_field.hpp"

#include <memory>
#include <string>

namespace noether {

/// x' = v, v' = a(t, x, v): the accelerations that a split Hamiltonian tells, and forces beside it that are no part of
/// its kicks (drag). Methods for y' = f serve every Hamiltonian so whose columns are inertial.
///
/// y holds all x, then all y, then all z, then the velocities likewise, shape (6 n).
/// @cost the accelerations of the Hamiltonian and a copy of 12 n numbers
template <class Real> class HamiltonianMotion final : public VectorField<Real> {
 public:
  /// @throws SchemeMismatch  for a Hamiltonian in coordinates of its own, with columns that move, or with constraints
  /// @param inside  what the forces within the Hamiltonian claim; errors of particles are measured by it
  explicit HamiltonianMotion(AnyHamiltonian<Real> hamiltonian, ForceField<Real> beside = {}, ForceClaims inside = {});

  std::unique_ptr<VectorField<Real>> clone() const override { return std::make_unique<HamiltonianMotion>(*this); }
  FieldClaims claims() const override;
  std::string signature() const override;
  void bind(const ParticleSystem<Real>& s) override;
  Index size() const override { return 6 * work_.size(); }
  Index particles() const override { return work_.size(); }
  void gather(const ParticleSystem<Real>& s, Vector<Real>& y) const override { detail::gather_particles(s, y); }
  void scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const override { detail::scatter_particles(y, s); }
  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) override { return hamiltonian_.energy(s); }
  std::optional<Mat3<Real>> virial(const ParticleSystem<Real>& s) override { return hamiltonian_.virial(s); }
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) override { sum(s, a); }
  void save(SavedState& saved, const std::string& prefix) const override { hamiltonian_.save(saved, prefix); }
  void load(const SavedState& saved, const std::string& prefix) override { hamiltonian_.load(saved, prefix); }

 protected:
  void measure_particles(const Vector<Real>& y, double rtol, ParticleScales& scales) override;
  void evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) override;
  void accelerate(const Real& t, const Vector<Real>& y, Vector<Real>& a) override;

 private:
  void sum(const Real& t, const Vector<Real>& y);
  /// @return why they could not be computed
  std::optional<Failure> sum(const ParticleSystem<Real>& s, VectorColumn<Real>& a);

  AnyHamiltonian<Real> hamiltonian_;
  ForceField<Real> beside_;
  ForceClaims inside_;
  Coupling coupling_;
  ParticleSystem<Real> work_;
  VectorColumn<Real> a_, beside_a_;
  Workspace workspace_;  ///< of the forces beside
};

extern template class HamiltonianMotion<double>;
extern template class HamiltonianMotion<Quad>;

}  // namespace noether
