#pragma once
/// A Hamiltonian in a bath that rescales all velocities: one more letter, with its conserved energy.

#include "engine/bodies.hpp"
#include "engine/description.hpp"
#include "engine/erasure.hpp"
#include "engine/moments.hpp"
#include "engine/signature.hpp"
#include "engine/sums.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/noisy.hpp"
#include "numbers/chi_squared.hpp"
#include "numbers/cost_book.hpp"
#include "numbers/parallel.hpp"
#include "numbers/random.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace noether {

struct VelocityRescalingOptions {
  double temperature = 0.0;      ///< of the bath [temperature]
  double relaxation_time = 0.0;  ///< [time]
  std::int64_t seed = 0;         ///< other seeds, other noise

  static constexpr auto describe() {
    return part<VelocityRescalingOptions>(
        "velocity_rescaling",
        "a bath that draws the kinetic energy anew and rescales all velocities alike: the irreversible letter V",
        formula("V: v -> a v about the center of mass,  a^2 = c + (1 - c) (R^2 + S) k_B T/2K + 2 R sqrt(c (1 - c) k_B "
                "T/2K),  c = exp(-h/relaxation_time)"),
        source("BussiDonadioParrinello2007"),
        letter('V', "flows of the bath: all velocities rescaled at random, exact"),
        field<&VelocityRescalingOptions::temperature>("temperature", "temperature", "temperature of the bath")
            .required("\"300 K\""),
        field<&VelocityRescalingOptions::relaxation_time>("relaxation_time", "time",
                                                          "time in which the kinetic energy forgets its past")
            .required("\"0.1 ps\""),
        field<&VelocityRescalingOptions::seed>("seed", "1",
                                               "seed of the noise: runs with different seeds are independent"));
  }

  /// @throws Error  for a negative temperature, and a time that is not above 0
  void check() const {
    if (!(temperature >= 0 && std::isfinite(temperature)))
      refuse_field("temperature", temperature, "is not a valid temperature; 0 or more is expected");
    if (!(relaxation_time > 0 && std::isfinite(relaxation_time)))
      refuse_field("relaxation_time", relaxation_time, "is not a valid time; a time above 0 is expected");
  }
};

/// Adds the letter `V`, stochastic velocity rescaling, to a split Hamiltonian: the exact flow of the kinetic energy
///
///     dK = (f k_B T/2 - K) dt/tau + 2 sqrt(k_B T K/(2 tau)) dW
///
/// of f degrees of freedom, by one factor for all velocities and the spins of rigid bodies,
///
///     V:  v -> a v,   a^2 = c + (1 - c) q (R^2 + S) + 2 R sqrt(c (1 - c) q),   q = k_B T/(2 K),   c = exp(-h/tau)
///
/// R normal, S a sum of f - 1 squares of such; a has the sign of R + sqrt(c/((1 - c) q)). Where the Hamiltonian keeps
/// momentum, K is of velocities relative to the center of mass, whose motion stays as it is, and f is 3 less;
/// constraints take their number from f, and stay satisfied. Velocities that are all zero, or all the same, stay so.
///
/// The heat that the flows have given is counted: energy less heat is conserved as far as the other flows conserve the
/// energy, and `energy` tells its error. A word without a V, such as `verlet`, gets half a V at both ends. It is
/// irreversible: schemes with negative steps are refused.
///
/// The noise has no state: it is a function of the seed, the step, and the place of the V in the word, as in
/// `Langevin`.
/// @cost two passes over the velocities, and some 4 calls of `philox` for all particles together
/// @source BussiDonadioParrinello2007, MarsagliaTsang2000, Salmon2011
template <SplitHamiltonian H> class VelocityRescaling : public Noisy<VelocityRescaling<H>, H, 'V'> {
 public:
  using real = typename H::real;

  /// @throws Error  as `VelocityRescalingOptions::check`
  VelocityRescaling(H hamiltonian, VelocityRescalingOptions options)
      : Noisy<VelocityRescaling<H>, H, 'V'>(std::move(hamiltonian)), options_(options), key_(noise_key(options.seed)) {
    options_.check();
  }

  std::string name() const { return "velocity_rescaling"; }
  HamiltonianClaims claims() const {
    HamiltonianClaims claims = this->claims_in_bath();
    claims.counts_heat = !hamiltonian_.claims().dissipative;
    return claims;
  }
  /// @throws Error  as `Noisy::bind`, and where there is no degree of freedom left
  void bind(ParticleSystem<real>& s) {
    Noisy<VelocityRescaling<H>, H, 'V'>::bind(s);
    const HamiltonianClaims claims = hamiltonian_.claims();
    about_center_ = claims.keeps_momentum;
    freedom_ = 3 * s.size() + turning_freedoms(s) - claims.constraints - (about_center_ ? 3 : 0);
    heat_ += std::exchange(completing_, real(0));  // an edited run goes on from the copy that they completed
    if (freedom_ > 0) return;
    throw Error(std::string("no degree of freedom is left to have a temperature") +
                (about_center_ ? " beside the motion of the center of mass" : "") + "; take the thermostat out");
  }
  /// Of the particles, and the heat that they have been given so far.
  EnergyTerms<real> energy(const ParticleSystem<real>& s) {
    EnergyTerms<real> energy = hamiltonian_.energy(s);
    if (claims().counts_heat) energy.heat = heat_ + completing_;
    return energy;
  }
  /// Between two calls flows complete a copy: its heat is not that of the run.
  void observe(std::optional<Request> wanted) {
    observing_ = wanted.has_value();
    if (observing_) completing_ = real(0);
    hamiltonian_.observe(wanted);
  }
  /// Given to the particles by all flows of the run so far [energy].
  const real& heat() const { return heat_; }
  std::int64_t degrees_of_freedom() const { return freedom_; }

  void save(SavedState& saved, const std::string& prefix) const {
    detail::save_signature(saved, prefix + "velocity_rescaling/", options_);
    save_value(saved, prefix + "velocity_rescaling/heat", heat_);
    detail::save_any(saved, prefix, hamiltonian_);
  }
  void load(const SavedState& saved, const std::string& prefix) {
    detail::check_signature(saved, prefix + "velocity_rescaling/", options_);
    load_value(saved, prefix + "velocity_rescaling/heat", heat_);
    completing_ = real(0);
    detail::load_any(saved, prefix, hamiltonian_);
  }

 private:
  friend class Noisy<VelocityRescaling<H>, H, 'V'>;
  using Noisy<VelocityRescaling<H>, H, 'V'>::hamiltonian_;

  void mix(ParticleSystem<real>& s, const real& h, std::int64_t step, std::uint32_t stage) {
    const Spent spent("thermostat", "velocity_rescaling");
    const Vec3<real> center = velocity_of_center(s);
    const auto twice_kinetic = [&](const Vec3<real>& about) {
      return sum_over<real>(s.size(), [&](Index i) {
        return std::as_const(s).masses()[i] * norm2(Vec3<real>(std::as_const(s).velocities()[i] - about));
      });
    };
    const real turning = has_bodies(s) ? real(2) * turning_energy_of(s) : real(0);
    const real twice = twice_kinetic(center) + turning, eps = std::numeric_limits<real>::epsilon();
    // What rounding leaves of particles that all move alike has no direction to be scaled along.
    if (!(twice > real(16) * eps * eps * (twice_kinetic(Vec3<real>::Zero()) + turning))) return;
    const real kT = real(s.units().k_B) * real(options_.temperature);
    const real factor = factor_of(kT / twice, h, step, stage);
    (observing_ ? completing_ : heat_) += (factor * factor - real(1)) * twice / real(2);
    VectorColumn<real>& v = s.velocities();
    auto* low = s.low_words();
    for_blocks(s.size(), [&](Index begin, Index end) {
      for (int c = 0; c < 3; ++c) {
        real* const along = v.component(c);
        for (Index i = begin; i < end; ++i) along[i] = center[c] + factor * (along[i] - center[c]);
        if (low == nullptr) continue;
        for (Index i = begin; i < end; ++i) low->v.component(c)[i] *= factor;
      }
    });
    if (has_bodies(s)) s.template column<BodySpin>().all() *= factor;
  }

  Vec3<real> velocity_of_center(const ParticleSystem<real>& s) const {
    if (!about_center_) return Vec3<real>::Zero();
    return Vec3<real>(rounded(weighted_sum(s, s.velocities())) /
                      sum_over<real>(s.size(), [&](Index i) { return s.masses()[i]; }));
  }

  /// What velocities are multiplied by. @param q  k_B T/(2 K)
  real factor_of(const real& q, const real& h, std::int64_t step, std::uint32_t stage) const {
    using std::exp, std::expm1, std::sqrt;
    // The counters of other noise have no such second word (`noise`).
    const auto when = static_cast<std::uint64_t>(step);
    const auto bits = [&](std::uint32_t k) {
      return philox({k, std::uint32_t{1} << 30U | stage, static_cast<std::uint32_t>(when),
                     static_cast<std::uint32_t>(when >> 32U)},
                    key_);
    };
    const real R(normal_pair(bits(0))[0]), S(chi_squared(freedom_ - 1, [&](std::uint32_t k) { return bits(k + 1); }));
    const real over = h / real(options_.relaxation_time), fresh = -expm1(-over) * q;  // (1 - c) q
    const real along = exp(-over / real(2)) + R * sqrt(fresh);
    const real size = sqrt(along * along + fresh * S);
    return along < real(0) ? real(-size) : size;
  }

  VelocityRescalingOptions options_;
  std::array<std::uint32_t, 2> key_;
  bool about_center_ = true;   ///< the motion of the center of mass is no heat
  std::int64_t freedom_ = 0;   ///< degrees of freedom
  real heat_ = real(0);        ///< given in the run
  bool observing_ = false;     ///< flows complete a copy
  real completing_ = real(0);  ///< given to the last copy
};

/// The bath as a letter, for scenes: what `[hamiltonian.thermostat] type = "velocity_rescaling"` adds to a splitting.
template <SplitHamiltonian H> VelocityRescaling<H> with_letter(const VelocityRescalingOptions& options, H hamiltonian) {
  return VelocityRescaling<H>(std::move(hamiltonian), options);
}

extern template class VelocityRescaling<AnyHamiltonian<double>>;
extern template struct detail::HamiltonianModel<VelocityRescaling<AnyHamiltonian<double>>>;

}  // namespace noether
