#include "integrators/hamiltonian_motion.hpp"

#include "neighbors/neighbor_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace noether {

template <class Real>
HamiltonianMotion<Real>::HamiltonianMotion(AnyHamiltonian<Real> hamiltonian, ForceField<Real> beside,
                                           ForceClaims inside)
    : hamiltonian_(std::move(hamiltonian)), beside_(std::move(beside)), inside_(std::move(inside)) {
  const HamiltonianClaims claims = hamiltonian_.claims();
  if (!claims.inertial) {
    throw SchemeMismatch(
        fmt::format("'{}' uses its own coordinates, so methods for y' = f cannot step it; use a "
                    "splitting scheme, such as 'verlet_aba'",
                    hamiltonian_.name()));
  }
  if (claims.columns) {
    throw SchemeMismatch(
        fmt::format("'{}' moves more than positions and velocities, so methods for y' = f cannot step it; use a "
                    "splitting scheme, such as 'verlet' or 'yoshida_4'",
                    hamiltonian_.name()));
  }
  if (claims.constraints > 0) {
    throw SchemeMismatch(
        fmt::format("'{}' has constraints, which methods for y' = f do not support; use a splitting scheme, such as "
                    "'verlet'",
                    hamiltonian_.name()));
  }
}

template <class Real> FieldClaims HamiltonianMotion<Real>::claims() const {
  const HamiltonianClaims own = hamiltonian_.claims();
  const ForceClaims beside = beside_.claims();
  return {.name = hamiltonian_.name(),
          .second_order = true,
          .velocity_dependent = true,
          .time_dependent = own.time_dependent || beside.time_dependent,
          .energy = own.energy && beside.energy,
          .dissipative = own.dissipative || beside.dissipative,
          .symplectic = own.symplectic,
          .no_action = own.no_action.empty()
                           ? "methods for y' = f have no action for a Hamiltonian that is more than forces"
                           : own.no_action,
          .keeps_momentum = own.keeps_momentum && beside.keeps_momentum,
          .keeps_angular_momentum = own.keeps_angular_momentum && beside.keeps_angular_momentum};
}

template <class Real> std::string HamiltonianMotion<Real>::signature() const {
  SavedState saved;
  hamiltonian_.save(saved, "");
  std::string all = hamiltonian_.name();
  for (const auto& [key, value] : saved) {
    const auto* texts = std::get_if<std::vector<std::string>>(&value);
    if (key.ends_with("signature") && texts != nullptr && !texts->empty()) all += " " + texts->front();
  }
  return beside_.terms().empty() ? all : all + " + " + beside_.signature();
}

template <class Real> void HamiltonianMotion<Real>::bind(const ParticleSystem<Real>& s) {
  work_ = s;
  work_.keep_low_words(false);
  work_.clock() = Clock<Real>::free(0);
  hamiltonian_.bind(work_);
  bind_force(beside_, work_);
  workspace_ = Workspace();
  workspace_.put(NeighborList(std::max(beside_.claims().range, inside_.range)));
  a_ = beside_a_ = VectorColumn<Real>(s.size());
  coupling_ = Coupling::of(inside_, s.units().G);
  this->forget_scales();
}

template <class Real>
std::optional<Failure> HamiltonianMotion<Real>::sum(const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
  hamiltonian_.accelerations(s, a);
  if (beside_.terms().empty()) return hamiltonian_.failure();
  ForceSink<Real> sink(beside_a_, s, {}, &workspace_);
  beside_.add_to(sink, s);
  for (Index i = 0; i < a.size(); ++i) a.add(i, std::as_const(beside_a_)[i]);
  return hamiltonian_.failure() ? hamiltonian_.failure() : sink.failure();
}

template <class Real> void HamiltonianMotion<Real>::sum(const Real& t, const Vector<Real>& y) {
  scatter(y, work_);
  work_.clock().set_stage_offset(t);
  work_.wrap();
  const std::optional<Failure> failure = sum(work_, a_);
  if (!failure) return;
  this->note(failure);
  for (int k = 0; k < 3; ++k) std::fill_n(a_.component(k), a_.size(), Real(std::numeric_limits<double>::quiet_NaN()));
}

template <class Real>
void HamiltonianMotion<Real>::measure_particles(const Vector<Real>& y, double rtol, ParticleScales& scales) {
  scatter(y, work_);
  work_.wrap();
  measure(work_, coupling_, workspace_.find<NeighborList>(), rtol, scales);
}

template <class Real> void HamiltonianMotion<Real>::evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) {
  const Index half = 3 * work_.size();
  sum(t, y);
  dy.resize(2 * half);
  std::copy_n(y.data() + half, half, dy.data());
  for (int k = 0; k < 3; ++k) std::copy_n(a_.component(k), work_.size(), dy.data() + half + k * work_.size());
}

template <class Real> void HamiltonianMotion<Real>::accelerate(const Real& t, const Vector<Real>& y, Vector<Real>& a) {
  sum(t, y);
  a.resize(3 * work_.size());
  for (int k = 0; k < 3; ++k) std::copy_n(a_.component(k), work_.size(), a.data() + k * work_.size());
}

template class HamiltonianMotion<double>;
template class HamiltonianMotion<Quad>;

}  // namespace noether
