#pragma once
/// Charges in fields, symplectic in x and m v + q A: one direction of space after the other.

#include "engine/concepts.hpp"
#include "engine/description.hpp"
#include "engine/erasure.hpp"
#include "forces/sum.hpp"
#include "integrators/field_forces.hpp"
#include "integrators/kinetic_potential.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace noether {

/// Parameters of `KSymplectic`.
struct KSymplecticOptions {
  std::int64_t nodes = 8;  ///< of the integrals of B along the lines on which charges move

  static constexpr auto describe() {
    return part<KSymplecticOptions>(
        "k_symplectic",
        "charges in fields, symplectic in x and m v + q A: motion along x, y and z, one after the other",
        formula("X: x' = v_x, v' = v_x e_x x q B/m;  Y, Z likewise;  B: m v' = q E + other forces"),
        source("HeEtAl2017, ZhouEtAl2017"), letter('B', "kicks by electric fields and other forces"),
        letter('X', "motion along x"), letter('Y', "motion along y"), letter('Z', "motion along z"),
        field<&KSymplecticOptions::nodes>("nodes", "1",
                                          "of Gauss's quadrature, by which B is integrated along each line"));
  }
  /// @throws Error  for less than 1 and more than 32 nodes
  void check() const;

  /// Nothing in itself but the motion: methods that do not split serve it too.
  std::tuple<> forces() const { return {}; }
  template <class Real> AnyHamiltonian<Real> split(ForceField<Real> forces) const;
};

/// Charges in fields, as flows of parts of H = m v^2/2 + q phi in the structure that the magnetic field gives to (x,
/// v):
///
///     X:  x -> x + h v_x e_x,  v -> v + e_x x int (q B/m) dx along that line;  Y and Z likewise
///     B:  v -> v + h (F + q E)/m
///
/// Each is the exact flow of m v_x^2/2 and so on, so the step is symplectic in x and p = m v + q A, with no A to be
/// known. The integrals are those of Gauss's quadrature: exact for polynomials, to rounding where B is smooth on the
/// way of a step. Where it is not, what is lost is the symplectic form, not the order. Basic word X Y Z B Z Y X, which
/// compositions join in X. Other forces do not depend on velocities.
///
/// Where the fields tell A the flows have their action, h m v_x^2/2 + int q A_x dx for X and - h (U + q phi) for B, and
/// copies for observers that want it close with p/m = v + q A/m in the place of v: there the map is symplectic.
/// @cost `nodes` evaluations of the fields for each of X, Y, Z, and one of all forces per B
/// @source HeEtAl2017
template <class F, class Real = double> class KSymplectic : public detail::ChargesInFields<F, Real> {
 public:
  /// @throws SchemeMismatch  if a force depends on velocities otherwise than fields do
  explicit KSymplectic(F forces, KSymplecticOptions options = {});

  std::string name() const { return "k_symplectic"; }
  HamiltonianClaims claims() const {
    return this->with_forces({.alphabet = "BXYZ", .timed = "Z", .basic = "XYZBZYX", .no_action = no_momenta_});
  }
  void bind(ParticleSystem<Real>& s);
  void open(ParticleSystem<Real>& /*inertial already*/) {}
  void close(ParticleSystem<Real>& s);
  void flow(char letter, ParticleSystem<Real>& s, const Real& h);
  Real flow_with_action(char letter, ParticleSystem<Real>& s, const Real& h);
  void observe(std::optional<Request> wanted) {
    Base::observe(wanted);
    shows_momenta_ = wanted && wanted->action;
  }
  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) {
    forces_.evaluate(s, true);
    return {kinetic_energy(s), forces_.potential()};
  }
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a);
  void save(SavedState& saved, const std::string& prefix) const {
    detail::save_signature(saved, prefix + "lines/", options_);
    forces_.save(saved, prefix);
  }
  void load(const SavedState& saved, const std::string& prefix) {
    detail::check_signature(saved, prefix + "lines/", options_);
    forces_.load(saved, prefix);
  }

 private:
  using Base = detail::ChargesInFields<F, Real>;
  using Base::forces_, Base::observing_;

  void move_along(int axis, ParticleSystem<Real>& s, const Real& h, bool momenta);

  detail::FieldForces<F, Real> on_lines_;  ///< at the nodes of the lines along which particles move
  KSymplecticOptions options_;
  std::vector<Real> places_, weights_;  ///< in [0, 1]
  ParticleSystem<Real> there_;
  VectorColumn<Real> integrals_{0};
  std::vector<Real> momenta_;  ///< means of q A along the lines, in their direction
  std::string no_momenta_;     ///< which field does not tell A; empty: they all do
  bool shows_momenta_ = false;
};

template <class Real> AnyHamiltonian<Real> KSymplecticOptions::split(ForceField<Real> forces) const {
  return KSymplectic<ForceField<Real>, Real>(std::move(forces), *this);
}

template <class F> KSymplectic(F) -> KSymplectic<typename detail::OnCharges<F>::type, double>;
template <class F> KSymplectic(F, KSymplecticOptions) -> KSymplectic<typename detail::OnCharges<F>::type, double>;

extern template class KSymplectic<ForceField<double>>;
extern template class KSymplectic<ForceField<Quad>, Quad>;
extern template struct detail::HamiltonianModel<KSymplectic<ForceField<double>>>;
extern template struct detail::HamiltonianModel<KSymplectic<ForceField<Quad>, Quad>>;

}  // namespace noether

#include "integrators/k_symplectic_impl.hpp"  // IWYU pragma: keep
