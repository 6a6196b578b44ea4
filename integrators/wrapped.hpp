#pragma once
/// What stands around a Hamiltonian or an integrator and changes some of it: everything else goes through.

#include "engine/erasure.hpp"

#include <optional>
#include <string>
#include <utility>

namespace noether {

/// The members of a split Hamiltonian or of an integrator, each as that of the one inside.
///
/// Neither `save` nor `load` is among them. A part around another one that has none either is saved as it describes
/// itself: its fields, which a saved run must have been made with, its state, and then the one inside.
template <class T> class Wrapped;

/// Around a Hamiltonian. A letter of its own (drag, a bath) derives from it and writes what it changes: its claims, the
/// flow of its letter, what it saves.
template <SplitHamiltonian H> class Wrapped<H> {
 public:
  using real = typename H::real;

  explicit Wrapped(H hamiltonian) : hamiltonian_(std::move(hamiltonian)) {}

  const H& inside() const { return hamiltonian_; }
  H& inside() { return hamiltonian_; }
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
  void observe(std::optional<Request> wanted) { hamiltonian_.observe(wanted); }
  const std::optional<Failure>& failure() const { return hamiltonian_.failure(); }
  Evaluations evaluations() const { return hamiltonian_.evaluations(); }

 protected:
  H hamiltonian_;
};

/// Around an integrator. A decorator (what is done to the run at its whole steps) derives from it and writes what it
/// changes: its claims, `advance`, and with that `advance_with_action` or `has_action`. Its `advance` must leave the
/// same bits for any cuts of a run: what it does when may depend on the count of steps alone.
template <Integrator I> class Wrapped<I> {
 public:
  using real = typename I::real;

  explicit Wrapped(I integrator) : integrator_(std::move(integrator)) {}

  const I& inside() const { return integrator_; }
  I& inside() { return integrator_; }
  IntegratorClaims claims() const { return integrator_.claims(); }
  void bind(ParticleSystem<real>& s) { integrator_.bind(s); }
  Advance advance(ParticleSystem<real>& s, const Span& span) { return integrator_.advance(s, span); }
  bool has_action() const { return detail::has_action(integrator_); }
  Advance advance_with_action(ParticleSystem<real>& s, const Span& span, real& action) {
    return detail::advance_with_action(integrator_, s, span, action);
  }
  real settle(const ParticleSystem<real>& raw, ParticleSystem<real>& out, Request wanted,
              const std::optional<double>& at, bool corrected) {
    return detail::settle(integrator_, raw, out, wanted, at, corrected);
  }
  void go_on_from(const ParticleSystem<real>& now, ParticleSystem<real>& raw) {
    detail::go_on_from(integrator_, now, raw);
  }
  EnergyTerms<real> energy(const ParticleSystem<real>& s) { return integrator_.energy(s); }
  std::optional<EnergyTerms<Quad>> wide_energy(const ParticleSystem<real>& s) {
    return detail::wide_energy_of(integrator_, s);
  }
  std::optional<Mat3<real>> virial(const ParticleSystem<real>& s) { return detail::virial_of(integrator_, s); }
  void accelerations(const ParticleSystem<real>& s, VectorColumn<real>& a) { integrator_.accelerations(s, a); }
  Evaluations evaluations() const { return integrator_.evaluations(); }

 protected:
  /// Goes on from another state of the particles at a whole step, as after an edit: the method begins anew.
  /// @param now  settled, then changed
  void continue_from(const ParticleSystem<real>& now, ParticleSystem<real>& raw) {
    detail::begin_from(integrator_, now, raw);
  }

  I integrator_;
};

}  // namespace noether
