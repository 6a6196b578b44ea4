#pragma once
/// Charges in fields as a canonical system: y = (x, p), p = m v + q A.

#include "engine/proper_velocity.hpp"
#include "integrators/classical.hpp"
#include "integrators/field_forces.hpp"

#include <memory>
#include <string>
#include <utility>

namespace noether {

/// The motion of charges under the energy that magnetic fields give them, beside other forces F = - dU/dx:
///
///     H = sum |p - q A|^2/2m + q phi + U,   x' = (p - q A)/m,   p' = F + q (E + v x B) + q (dA/dt + v . grad A)
///
/// The last sum is how q A changes along the way of the charge, one slope of the fields over dual numbers. p' is -
/// dH/dx as far as E and B are those of phi and A; v x B + v . grad A is grad (v . A), and E the rest. Methods that
/// keep an energy H(q, p), or that are symplectic in q and p, do so here, and not by x and v.
///
/// In y stand momenta over the largest mass, and `hamiltonian` is H over it: numbers as large as velocities, and the
/// same equations. Particles carry x and v; v has a second word, so that a run that is looked at finds its p again.
/// @cost the forces, and the fields once more over dual numbers
/// @source HeEtAl2015
template <class Real> class CanonicalCharges final : public VectorField<Real> {
 public:
  /// @param name  of the Hamiltonian the forces come from, as reports show it
  /// @throws SchemeMismatch  if a force depends on velocities otherwise than fields do, or a field is not known over
  ///         dual numbers
  explicit CanonicalCharges(ForceField<Real> forces, std::string name = "charged_particles");

  std::unique_ptr<VectorField<Real>> clone() const override { return std::make_unique<CanonicalCharges>(*this); }
  FieldClaims claims() const override;
  std::string signature() const override;
  /// @throws SchemeMismatch  for fields without a vector potential, and for particles without mass
  void bind(const ParticleSystem<Real>& s) override;
  Index size() const override { return 6 * work_.size(); }
  Index particles() const override { return work_.size(); }
  void gather(const ParticleSystem<Real>& s, Vector<Real>& y) const override;
  void scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const override;

  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) override { return by_velocities_.energy(s); }
  std::optional<Mat3<Real>> virial(const ParticleSystem<Real>& s) override { return by_velocities_.virial(s); }
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) override {
    by_velocities_.accelerations(s, a);
  }
  bool has_hamiltonian() const override { return true; }
  Real hamiltonian(const Real& t, const Vector<Real>& y) override;
  /// Over the largest.
  Vector<Real> masses() const override;

 protected:
  void measure_particles(const Vector<Real>& y, double rtol, ParticleScales& scales) override;
  void evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) override;

 private:
  using Moving = Dual<Real, 1>;

  void check_potentials(const ParticleSystem<Real>& s);
  /// Forces and fields at (t, x) of y, and its velocities, which are left in `work_`.
  Real find_velocities(const Real& t, const Vector<Real>& y, bool energy);
  /// The slopes of fields where charges go by `v`, and time by `dt`.
  void go_along(const ForceField<Real>& fields, const ParticleSystem<Real>& s, const Real& t, const Real& dt,
                const VectorColumn<Real>& v);

  ForceField<Real> forces_, fields_;
  std::string name_;
  ForceMotion<ForceField<Real>, Real> by_velocities_;
  Coupling coupling_;
  Workspace workspace_;
  ParticleSystem<Real> work_;
  Real unit_ = Real(1);                                ///< the largest mass
  VectorColumn<Real> a_{0}, rates_{0}, of_fields_{0};  ///< F/m + q E/m, q B/m and q A
  ParticleSystem<Moving> along_;                       ///< on their way along a direction
  VectorColumn<Moving> along_a_{0}, along_rates_{0}, along_of_fields_{0};
  mutable VectorColumn<Real> seen_a_{0}, seen_of_fields_{0};  ///< work of `gather` and `scatter`
};

extern template class CanonicalCharges<double>;
extern template class CanonicalCharges<Quad>;

/// A method over charges by their momenta: `canonical_charges(PenningTrap{.B0 = 25}, method("avf"))`.
template <class F> Classical<double> canonical_charges(F field, const MethodChoice& choice) {
  ForceField<double> forces;
  if constexpr (std::is_same_v<F, ForceField<double>>) {
    forces = std::move(field);
  } else {
    forces.add(typename detail::OnCharges<F>::type(std::move(field)));
  }
  return Classical<double>(std::make_unique<CanonicalCharges<double>>(std::move(forces)), choice);
}

}  // namespace noether
