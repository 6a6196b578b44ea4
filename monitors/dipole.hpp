#pragma once
/// Monitors of charges in molecules: the dipole moment, and the dielectric constant from its fluctuations.

#include "engine/monitor.hpp"
#include "engine/statistics.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace noether {

namespace detail {

/// The order in which bonds lead from particle to particle: what makes molecules whole.
class WholeMolecules {
 public:
  /// Finds it, once for a topology and a number of particles.
  void find(const std::shared_ptr<const Topology>& topology, Index n);
  /// The dipole moment sum q x [charge length]: the first particle of each molecule where it is without wrapping, every
  /// other one at the image that is nearest to the one it is bonded to.
  template <class Real> std::array<Real, 3> dipole_moment(const ParticleSystem<Real>& s) const;
  /// The first particle of each molecule, shape (n).
  const std::vector<Index>& first() const { return first_; }

 private:
  std::shared_ptr<const Topology> topology_;
  std::vector<Index> order_, parent_, first_;  ///< parents come first; a particle without one is its own
};

}  // namespace detail

/// Watches the dipole moment of all charges,
///
///     M = sum_i q_i r_i
///
/// of unwrapped positions, about the origin of coordinates: where the charges do not add up to nothing, M depends on
/// that place. Molecules are taken as whole, wherever the faces of a periodic box cut them: each particle is at the
/// image nearest to the one that a bond joins it to.
/// @throws Error  when attached to a run without charges
/// @cost O(n), no force evaluation
/// @source Neumann1983
class DipoleMoment {
 public:
  static constexpr bool needs_particles = true;

  static constexpr auto describe() {
    return part<DipoleMoment>("dipole_moment", "the dipole moment of all charges, molecules whole",
                              formula("M = sum_i q_i r_i, unwrapped"), quantities("value[3], size [charge length]"),
                              source("Neumann1983"), state<&DipoleMoment::now_>("now"),
                              state<&DipoleMoment::sizes_>("sizes"), state<&DipoleMoment::unit_>("unit"),
                              state<&DipoleMoment::slope_unit_>("slope_unit"), state<&DipoleMoment::debye_>("debye"));
  }

  /// @throws Error  without charges
  template <class Real> void check(const ParticleSystem<Real>& s) const;
  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;
  /// At the last look [charge length].
  const std::array<double, 3>& value() const { return now_; }
  double size() const;

 private:
  std::array<double, 3> now_{};
  SeriesStatistics sizes_;
  std::string unit_, slope_unit_;
  double debye_ = 0;  ///< in one unit of the moment; 0 in the reduced system

  detail::WholeMolecules molecules_;
};

/// Watches the static dielectric constant of a liquid of neutral molecules in a conducting surrounding, from the
/// fluctuations of the dipole moment of the box,
///
///     epsilon = 1 + 4 pi C (<M^2> - <M>^2) / (3 V k_B T),   M = sum_i q_i r_i, molecules whole
///
/// with C the factor of Coulomb's law. That is the formula for sums over a lattice that end in a conductor ("tin
/// foil"), and for a reaction field of a conductor. The error is that of block means of M^2 - 2 <M> M over time, from
/// 20 looks on; it is too small where the run is not many times as long as M remembers itself.
/// @throws Error  when attached to a run without a periodic box or charges, or with a molecule that has a charge: ions
///   carry a current, and their M wanders off
/// @cost O(n), no force evaluation
/// @source Neumann1983
class DielectricConstant {
 public:
  double temperature = 0;  ///< [temperature]

  static constexpr bool needs_particles = true;

  static constexpr auto describe() {
    using Self = DielectricConstant;
    return part<Self>("dielectric_constant",
                      "the static dielectric constant from the fluctuations of the dipole moment",
                      formula("epsilon = 1 + 4 pi C (<M^2> - <M>^2) / (3 V k_B T), in a conductor"),
                      quantities("value, error [1], mean[3] [charge length]"), source("Neumann1983"),
                      field<&Self::temperature>("temperature", "temperature", "of the liquid").required("\"300 K\""),
                      state<&Self::samples_>("samples"), state<&Self::sums_>("sums"), state<&Self::block_>("block"),
                      state<&Self::blocks_>("blocks"), state<&Self::open_>("open"),
                      state<&Self::open_sums_>("open_sums"), state<&Self::factor_>("factor"));
  }

  /// @throws Error  for a temperature that is none
  void check() const;
  /// @throws Error  as the class says
  template <class Real> void check(const ParticleSystem<Real>& s) const;
  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;
  /// @throws Error if parts of the saved state do not fit
  void load(const SavedState& saved, const std::string& prefix);

  std::int64_t samples() const { return samples_; }
  /// Of all looks so far; NaN before the first.
  double value() const;
  /// Standard error; empty below 20 looks.
  std::optional<double> error() const;
  /// <M> [charge length].
  std::array<double, 3> mean() const;

 private:
  using Sums = std::array<double, 4>;  ///< of M^2 and of the components of M

  std::int64_t samples_ = 0;
  Sums sums_{};
  std::int64_t block_ = 1;      ///< looks in a block
  std::vector<double> blocks_;  ///< means of the full ones, shape (blocks, 4)
  std::int64_t open_ = 0;       ///< looks in the block being filled
  Sums open_sums_{};
  double factor_ = 0;  ///< 4 pi C / (3 V k_B T)

  detail::WholeMolecules molecules_;
};

namespace detail {  // compiled once, in dipole.cpp

extern template struct MonitorModel<DipoleMoment, double>;
extern template struct MonitorModel<DipoleMoment, Quad>;
extern template struct MonitorModel<DielectricConstant, double>;
extern template struct MonitorModel<DielectricConstant, Quad>;

}  // namespace detail

}  // namespace noether
