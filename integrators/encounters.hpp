#pragma once
/// Encounters that a splitting about a primary should not meet.

#include "engine/concepts.hpp"
#include "engine/saved_state.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// Bodies nearer to each other than this many mutual Hill radii pull at each other as strongly as the primary's tide.
inline constexpr double encounter_hill_radii = 2;

/// Keeps the closest encounter of bodies about a primary, particle 0, by r ((m_i + m_j)/3 m_0)^(1/3), r the distance
/// from the primary of the one that is nearer to it. It keeps that through edits of the particles.
class EncounterWatch {
 public:
  /// @param masses, ids  by particle
  void bind(const std::vector<double>& masses, const std::vector<std::int64_t>& ids);

  /// Whether two bodies, none of them the primary, may be too near, by the distance of one of them from the primary:
  /// one product and one comparison. It misses none, as the distance of the nearer one, by which `note` goes, is no
  /// longer.
  template <class Real> bool near(Index i, Index j, const Real& r2, const Real& from_primary2) const {
    const double reach = reach_[static_cast<std::size_t>(i)] + reach_[static_cast<std::size_t>(j)];
    return j > 0 && r2 < Real(reach * reach) * from_primary2;
  }
  /// Takes down two bodies at a moment; from several threads and in any order. What is kept depends on the bodies only.
  /// @param backward  whether the run goes back in time
  void note(Index i, Index j, double r2, double nearer_to_primary2, double time, bool backward = false);

  /// The square of the distance of two bodies over that of the nearer one from the primary, from which on `note` has
  /// nothing new to take down, or a little more; 0 for the primary.
  double square_of_news(Index i, Index j) const;

  const std::optional<Encounter>& closest() const { return closest_; }
  /// Forgets what has been noted since that was the closest one.
  void go_back(const std::optional<Encounter>& closest) { closest_ = closest; }
  void save(SavedState& saved, const std::string& prefix) const;
  /// @throws Error  if what was saved is damaged
  void load(const SavedState& saved, const std::string& prefix);

 private:
  std::vector<double> masses_, reach_;  ///< the latter over the distance from the primary, no shorter than it must be
  std::vector<std::int64_t> ids_;
  std::optional<Encounter> closest_;
  bool known_ = false;  ///< one was closest when the run began to go in this direction: nothing is earlier
};

}  // namespace noether
