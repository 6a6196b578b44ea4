#pragma once
/// A Hamiltonian in a bath: friction and noise as one more letter.

#include "engine/bodies.hpp"
#include "engine/description.hpp"
#include "engine/erasure.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/noisy.hpp"
#include "numbers/cost_book.hpp"
#include "numbers/parallel.hpp"
#include "numbers/random.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

namespace noether {

struct LangevinOptions {
  double temperature = 0.0;  ///< of the bath [temperature]
  double friction = 0.0;     ///< [1/time]
  std::int64_t seed = 0;     ///< other seeds, other noise

  static constexpr auto describe() {
    return part<LangevinOptions>(
        "langevin", "a heat bath of one temperature for every particle: the irreversible letter O",
        formula("O: v -> c v + sqrt(k_B T/m (1 - c^2)) xi,  c = exp(-friction h)"), source("LeimkuhlerMatthews2013"),
        letter('O', "flows of the bath: friction and noise, exact"),
        field<&LangevinOptions::temperature>("temperature", "temperature", "temperature of the bath")
            .required("\"300 K\""),
        field<&LangevinOptions::friction>("friction", "1/time", "rate at which velocities forget their past")
            .required("\"1/ps\""),
        field<&LangevinOptions::seed>("seed", "1", "seed of the noise: runs with different seeds are independent"));
  }

  /// @throws Error  for a negative temperature or friction
  void check() const {
    if (!(temperature >= 0 && std::isfinite(temperature)))
      refuse_field("temperature", temperature, "is not a valid temperature; 0 or more is expected");
    if (!(friction >= 0 && std::isfinite(friction)))
      refuse_field("friction", friction, "would drive the motion instead of damping it; 0 or more is expected");
  }
};

/// Adds the letter `O`, the exact Ornstein-Uhlenbeck flow of friction and noise, to a split Hamiltonian.
///
///     O:  v -> c v + sqrt(k_B T/m (1 - c^2)) xi,   c = exp(-friction h),   xi normal, three for each particle
///
/// and in the same way Pi_k -> c Pi_k + sqrt(k_B T I_k (1 - c^2)) xi of the principal axes of rigid bodies.
///
/// `word("BAOAB")` keeps the distribution of positions of a harmonic oscillator exactly at every stable step, and to
/// second order with a small error elsewhere; a word without an O, such as `verlet`, gets half an O at both ends
/// (OBABO). It is irreversible: schemes with negative steps are refused. With constraints the velocities are projected
/// along them after each O.
///
/// The noise has no state: it is a function of the seed, the id of the particle, the step, and the place of the O in
/// the word. Where the last O of a step is joined with the first of the next both are done, one after the other, so
/// that a copy completed for an observer has the noise of the run.
/// @cost 12 random words, 2 logarithms and 4 sines or cosines for each particle and O
/// @source LeimkuhlerMatthews2013, LeimkuhlerMatthews2016, Salmon2011
template <SplitHamiltonian H> class Langevin : public Noisy<Langevin<H>, H, 'O'> {
 public:
  using real = typename H::real;

  /// @throws Error  for a negative temperature or friction, or constraints that do not tell how to project velocities
  Langevin(H hamiltonian, LangevinOptions options)
      : Noisy<Langevin<H>, H, 'O'>(std::move(hamiltonian)), options_(options), key_(noise_key(options.seed)) {
    options_.check();
    if (hamiltonian_.claims().constraints > 0 && !detail::can_project(hamiltonian_)) {
      throw Error("noise would push velocities off the constraints of '" + detail::name_of(hamiltonian_) +
                  "', which does not offer project_velocities; put the thermostat around kinetic_potential itself");
    }
  }

  std::string name() const { return "langevin"; }
  HamiltonianClaims claims() const {
    HamiltonianClaims claims = this->claims_in_bath();
    claims.keeps_momentum = false;
    return claims;
  }
  void accelerations(const ParticleSystem<real>& s, VectorColumn<real>& a) {
    hamiltonian_.accelerations(s, a);
    for (Index i = 0; i < s.size(); ++i) a.add(i, -real(options_.friction) * s.velocities()[i]);
  }
  void save(SavedState& saved, const std::string& prefix) const {
    detail::save_signature(saved, prefix + "langevin/", options_);
    detail::save_any(saved, prefix, hamiltonian_);
  }
  void load(const SavedState& saved, const std::string& prefix) {
    detail::check_signature(saved, prefix + "langevin/", options_);
    detail::load_any(saved, prefix, hamiltonian_);
  }

 private:
  friend class Noisy<Langevin<H>, H, 'O'>;
  using Noisy<Langevin<H>, H, 'O'>::hamiltonian_;

  void mix(ParticleSystem<real>& s, const real& h, std::int64_t step, std::uint32_t stage) {
    using std::exp, std::expm1, std::sqrt;
    const Spent spent("thermostat", "langevin");
    const real gamma(options_.friction), keep = exp(-gamma * h);
    const real kT = real(s.units().k_B) * real(options_.temperature), warmth = -expm1(real(-2) * gamma * h) * kT;
    const std::vector<std::int64_t>& ids = s.ids();
    const real* masses = std::as_const(s).masses().data();
    VectorColumn<real>& v = s.velocities();
    auto* low = s.low_words();
    for_blocks(s.size(), [&](Index begin, Index end) {
      double xi[3][block_size];
      real sigma[block_size];
      noise(key_, ids.data() + begin, end - begin, step, stage, xi[0], xi[1], xi[2]);
      for (Index i = begin; i < end; ++i) {  // neighbors of one mass, the most of all, share a root
        const bool same = i > begin && masses[i] == masses[i - 1];
        sigma[i - begin] = same ? sigma[i - 1 - begin] : real(sqrt(warmth / masses[i]));
      }
      for (int c = 0; c < 3; ++c) {
        real* const along = v.component(c);
        for (Index i = begin; i < end; ++i) along[i] = along[i] * keep + sigma[i - begin] * real(xi[c][i - begin]);
        if (low == nullptr) continue;
        for (Index i = begin; i < end; ++i) low->v.component(c)[i] *= keep;
      }
    });
    if (has_bodies(s)) mix_spins(s, keep, warmth, step, stage);
    detail::project_velocities(hamiltonian_, s, h);
  }

  /// The same for the spins of bodies, along their principal axes, by noise of its own; what a fixed point holds stays.
  void mix_spins(ParticleSystem<real>& s, const real& keep, const real& warmth, std::int64_t step,
                 std::uint32_t stage) {
    using std::sqrt;
    const std::array<std::uint32_t, 2> key = {key_[0] ^ 0x7475726eU, key_[1]};
    const auto& inertia = std::as_const(s).template column<BodyInertia>();
    const auto& orientation = std::as_const(s).template column<BodyOrientation>();
    auto& spin = s.template column<BodySpin>();
    auto& v = s.velocities();
    for_blocks(s.size(), [&](Index begin, Index end) {
      double xi[3][block_size];
      noise(key, s.ids().data() + begin, end - begin, step, stage, xi[0], xi[1], xi[2]);
      for (Index i = begin; i < end; ++i) {
        const Vec3<real> moments = inertia[i];
        if (turning_freedoms(moments) == 0) continue;
        const Mat3<real> r = rotation_matrix<real>(orientation[i]);
        Vec3<real> in_body = to_body<real>(r, std::as_const(spin)[i]);
        for (int k = 0; k < 3; ++k) {
          in_body[k] = keep * in_body[k] + real(sqrt(warmth * moments[k])) * real(xi[k][i - begin]);
        }
        spin.set(i, to_space<real>(r, in_body));
        if (s.bodies()->is_held(i)) v.set(i, Vec3<real>::Zero());
      }
    });
  }

  LangevinOptions options_;
  std::array<std::uint32_t, 2> key_;
};

/// The bath as a letter, for scenes: what `[hamiltonian.thermostat] type = "langevin"` adds to a splitting.
template <SplitHamiltonian H> Langevin<H> with_letter(const LangevinOptions& options, H hamiltonian) {
  return Langevin<H>(std::move(hamiltonian), options);
}

extern template class Langevin<AnyHamiltonian<double>>;
extern template struct detail::HamiltonianModel<Langevin<AnyHamiltonian<double>>>;

}  // namespace noether
