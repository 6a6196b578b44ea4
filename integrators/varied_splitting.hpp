#pragma once
/// Split Hamiltonians whose flows carry small changes of the state along: the derivatives of all flows beside them.

#include "engine/concepts.hpp"
#include "engine/tangent_flow.hpp"
#include "forces/sum.hpp"
#include "integrators/kepler_tangent.hpp"
#include "integrators/wisdom_holman.hpp"
#include "integrators/wisdom_holman_coordinates.hpp"
#include "numbers/dual.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace noether {

namespace detail {

/// Forces and how they change along a direction, by one evaluation over dual numbers.
template <class Real> class ForceSlopes {
 public:
  using D = Dual<Real, 1>;

  /// @param velocities  whether forces may depend on them, and `sum` is given them
  ForceSlopes(ForceField<Real> forces, const ParticleSystem<Real>& s, bool velocities = false);
  bool any() const { return !forces_.terms().empty(); }
  ForceClaims claims() const { return claims_of(forces_); }
  /// Sums the forces of the kick `letter`, 0 for all, at positions x + epsilon u and velocities v + epsilon w.
  /// @param v, w  null: as they were
  /// @return shape (n): in the values accelerations at (x, v), in the slopes their change along (u, w)
  const VectorColumn<D>& sum(char letter, const Real& time, const VectorColumn<Real>& x, const VectorColumn<Real>& u,
                             const VectorColumn<Real>* v = nullptr, const VectorColumn<Real>* w = nullptr);
  /// Of the particles, where they are not those that this was made for. @param mass  of particle i
  template <class Mass> void set_masses(const Mass& mass) {
    for (Index i = 0; i < moving_.size(); ++i) moving_.masses()[i] = D(mass(i));
  }
  const std::optional<Failure>& failure() const { return failure_; }

 private:
  ForceField<Real> forces_;
  ParticleSystem<D> moving_;
  VectorColumn<D> a_;
  std::optional<Failure> failure_;
};

/// What both splittings have in common: row i + k n of the particles is change k of particle i, and k = 0 the state.
template <class Real> class Varied {
 public:
  using real = Real;

  void bind(ParticleSystem<Real>& s) {
    NOETHER_EXPECTS(s.size() == (1 + changes_) * n_, "there are rows for all changes");
    known_.reset();
    failure_.reset();
  }
  Real flow_with_action(char /*letter*/, ParticleSystem<Real>& /*s*/, const Real& /*h*/) {
    throw LogicError("changes of a state have no action");
  }
  EnergyTerms<Real> energy(const ParticleSystem<Real>& /*s*/) { return {}; }
  void accelerations(const ParticleSystem<Real>& /*s*/, VectorColumn<Real>& /*a*/) {}
  void observe(const std::optional<Request>& /*wanted*/) {}
  const std::optional<Failure>& failure() const { return failure_; }
  Evaluations evaluations() const { return {}; }

 protected:
  Varied(Index n, Index changes) : n_(n), changes_(changes), a_((1 + changes) * n) {}

  void take(const VectorColumn<Real>& all, Index k, VectorColumn<Real>& one) const;
  void put(const VectorColumn<Real>& one, Index k, VectorColumn<Real>& all) const;
  void note(const std::optional<Failure>& failure) {
    if (failure && !failure_) failure_ = failure;
  }
  /// Whether `a_` holds the accelerations of this kick here.
  bool is_known(char letter, const ParticleSystem<Real>& s) const {
    return known_ && known_->letter == letter && known_->version == s.version() && known_->time == s.time();
  }
  void remember(char letter, const ParticleSystem<Real>& s) { known_ = Known{letter, s.version(), s.time()}; }

  Index n_, changes_;
  VectorColumn<Real> a_;  ///< of all rows

 private:
  struct Known {
    char letter;
    std::uint64_t version;
    Real time;
  };
  std::optional<Known> known_;
  std::optional<Failure> failure_;
};

}  // namespace detail

/// `KineticPotential` without constraints, and changes of its state: drifts are linear, and a kick by a(x) is one of
/// the change c by (c . grad) a.
/// @cost of a kick one evaluation of the forces over dual numbers a change
/// @source ReinTamayo2016
template <class Real> class VariedMotion : public detail::Varied<Real> {
 public:
  /// @param s  the particles of the run
  /// @throws Error  naming the force that has no derivative; for a periodic box
  VariedMotion(ForceField<Real> forces, const ParticleSystem<Real>& s, Index changes);

  std::string name() const { return "kinetic_potential"; }
  HamiltonianClaims claims() const;
  void open(ParticleSystem<Real>& /*inertial already*/) {}
  void close(ParticleSystem<Real>& /*inertial already*/) {}
  void flow(char letter, ParticleSystem<Real>& s, const Real& h);

 private:
  using Base = detail::Varied<Real>;
  using Base::a_, Base::changes_, Base::n_;

  detail::ForceSlopes<Real> slopes_;
  VectorColumn<Real> x_, u_;
};

/// `WisdomHolman`, and changes of its state: Kepler arcs by the closed form of their derivative, pulls of all pairs and
/// jumps likewise, further forces over dual numbers.
/// @cost of an arc a third of it a change; of a kick the sum over pairs, for further forces an evaluation a change
/// @source ReinTamayo2016
template <class Real> class VariedPlanets : public detail::Varied<Real>, private detail::AboutPrimary<Real> {
 public:
  /// @param bound  to the particles of the run
  /// @param others  its forces beside gravity
  /// @throws Error  naming the force that has no derivative, or that depends on velocities
  template <class F>
  VariedPlanets(const WisdomHolman<Real, F>& bound, ForceField<Real> others, const ParticleSystem<Real>& s,
                Index changes)
      : Varied(s.size(), changes),
        About(bound.about()),
        claims_(bound.claims()),
        circled_(bound.circled()),
        reduced_(bound.reduced()),
        g_(bound.constant()),
        others_(std::move(others), s),
        part_(s) {
    prepare();
  }

  std::string name() const { return "wisdom_holman"; }
  HamiltonianClaims claims() const;
  void open(ParticleSystem<Real>& s);
  void close(ParticleSystem<Real>& s);
  void flow(char letter, ParticleSystem<Real>& s, const Real& h);

 private:
  using Varied = detail::Varied<Real>;
  using About = detail::AboutPrimary<Real>;
  using About::at, About::barycentric, About::jacobi, About::massive, About::scaled, About::within;
  using Varied::a_, Varied::changes_, Varied::n_;

  void prepare();
  template <class Change> void each_part(ParticleSystem<Real>& s, const Change& change);
  void arcs(ParticleSystem<Real>& s, const Real& h);
  void jump(ParticleSystem<Real>& s, const Real& h);
  void accelerate(const ParticleSystem<Real>& s);
  void add_pulls(Index first);
  void add_pull(Index i, Index j, bool mutual);
  void add_others(const Real& time);
  void add_arcs(Index k);
  void about_center(VectorColumn<Real>& column) const;

  HamiltonianClaims claims_;
  std::vector<Real> circled_, reduced_;  ///< by particle
  Real g_;
  detail::ForceSlopes<Real> others_;
  ParticleSystem<Real> part_;                         ///< the state or one change, for changes of coordinates
  std::vector<VectorColumn<Real>> x_, inertial_, b_;  ///< of the state and each change: working and inertial positions
  VectorColumn<Real> base_x_, base_u_;                ///< for other forces
};

extern template class detail::ForceSlopes<double>;
extern template class detail::ForceSlopes<Quad>;
extern template class VariedMotion<double>;
extern template class VariedMotion<Quad>;
extern template class VariedPlanets<double>;
extern template class VariedPlanets<Quad>;

}  // namespace noether
