#pragma once
/// What stands around a Hamiltonian and changes some of it: everything else goes through.

#include "engine/erasure.hpp"

#include <optional>
#include <string>
#include <utility>

namespace noether {

/// The members of a split Hamiltonian, each as that of the one inside. A letter of its own (drag, a bath) derives from
/// it and writes what it changes: its claims, the flow of its letter, what it saves.
template <SplitHamiltonian H> class Wrapped {
 public:
  using real = typename H::real;

  explicit Wrapped(H hamiltonian) : hamiltonian_(std::move(hamiltonian)) {}

  std::string name() const { return detail::name_of(hamiltonian_); }
  HamiltonianClaims claims() const { return hamiltonian_.claims(); }
  void bind(ParticleSystem<real>& s) { hamiltonian_.bind(s); }
  void expect_kicks(double longest) { detail::expect_kicks(hamiltonian_, longest); }
  bool set_neighbor_options(const NeighborOptions& options) {
    return detail::set_neighbor_options(hamiltonian_, options);
  }
  bool can_project() const { return detail::can_project(hamiltonian_); }
  void project_velocities(ParticleSystem<real>& s, const real& h) { detail::project_velocities(hamiltonian_, s, h); }
  void open(ParticleSystem<real>& s) { hamiltonian_.open(s); }
  void close(ParticleSystem<real>& s) { hamiltonian_.close(s); }
  void flow(char letter, ParticleSystem<real>& s, const real& h) { hamiltonian_.flow(letter, s, h); }
  real flow_with_action(char letter, ParticleSystem<real>& s, const real& h) {
    return hamiltonian_.flow_with_action(letter, s, h);
  }
  EnergyTerms<real> energy(const ParticleSystem<real>& s) { return hamiltonian_.energy(s); }
  std::optional<Mat3<real>> virial(const ParticleSystem<real>& s) { return detail::virial_of(hamiltonian_, s); }
  void accelerations(const ParticleSystem<real>& s, VectorColumn<real>& a) { hamiltonian_.accelerations(s, a); }
  void observe(std::optional<Wanted> wanted) { hamiltonian_.observe(wanted); }
  const std::optional<Failure>& failure() const { return hamiltonian_.failure(); }
  Evaluations evaluations() const { return hamiltonian_.evaluations(); }
  void save(SavedState& saved, const std::string& prefix) const { detail::save_any(saved, prefix, hamiltonian_); }
  void load(const SavedState& saved, const std::string& prefix) { detail::load_any(saved, prefix, hamiltonian_); }

 protected:
  H hamiltonian_;
};

}  // namespace noether
