#pragma once
/// The planets of a Wisdom-Holman splitting side by side in lanes.

#include "engine/particle_system.hpp"
#include "engine/saved_state.hpp"
#include "integrators/planet_path.hpp"
#include "integrators/planet_row.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// What a splitting is, as its planets in lanes need it; bodies by particle.
struct PlanetSystem {
  double G = 0;
  bool jacobi = true;                    ///< coordinates; otherwise democratic ones
  std::vector<std::int64_t> order = {};  ///< the primary and the massive bodies
  std::vector<double> masses = {};
  std::optional<double> bend = {};  ///< 6 (G m_0/c)^2 of `gr_potential` beside, if that is there
  double size = 1;                  ///< the largest distance of a massive body from the primary
};

/// A second implementation of the flows A and B in Jacobi and in democratic coordinates: eight planets to a register,
/// or as many registers as a level needs for eight. It agrees with the one letter by letter to rounding and has the
/// same bits at every SIMD level.
///
/// Arcs begin with a prediction of the universal variable. Where arcs of one length follow each other it comes from the
/// arc before: that is state. `docs/theory/wisdom_holman.md` has the formulae.
class PlanetLanes {
 public:
  /// Whether these planets, and tracers among them, can be moved in lanes: products of two masses must be normal
  /// numbers.
  static bool can_take(const PlanetSystem& system);

  /// Takes over constants, and forgets the prediction.
  void bind(const PlanetSystem& system);
  /// Below which square of a ratio, distance of planets i and j over that of the nearer one from the star, they are to
  /// be noted, by particle.
  template <class Near> void watch(const Near& near) {
    for (std::size_t k = 1; k < order_.size(); ++k) {
      for (std::size_t j = first_kept(k); j < k; ++j)
        set_near(j, k, near(static_cast<Index>(order_[j]), static_cast<Index>(order_[k])));
    }
    for (std::size_t k = 0; of_own_alone_ && k < order_.size(); ++k) {
      const auto i = static_cast<Index>(order_[k]);
      set_reach(k, near(i, i));
    }
  }
  bool bound() const { return !row_.empty(); }
  std::size_t planets() const { return order_.size(); }

  /// Copies planets in working coordinates into the lanes.
  void load(const ParticleSystem<double>& s);
  /// Copies them back; velocities alone after a kick that moves nothing.
  void store(ParticleSystem<double>& s, bool positions = true) const;

  /// Kepler arcs over h [time].
  /// @param on_copy  what serves an observer uses no prediction and leaves none
  /// @param path     takes down what tracers need of it
  /// @return the particle whose arc was not found, or -1
  Index drift(double h, bool on_copy, PlanetPath* path = nullptr);

  /// A kick, and when it is, for paths.
  struct Kick {
    double h = 0, time = 0;
    bool noting = false;  ///< encounters count
  };
  /// @return whether two planets are so near that they are to be noted
  bool kick(const Kick& kick, bool on_copy, PlanetPath* path = nullptr);
  /// The accelerations of a kick times h, for the two kicks below; Jacobi coordinates.
  /// @return whether two planets are so near that they are to be noted; false where the last kick was at the same place
  bool accelerate(double h);
  /// The kick over h by the accelerations at x plus what `accelerate` found.
  void kick_beside(double h);
  /// The kick by h (a . grad) a, a being what `accelerate` found at the same place.
  void kick_by_gradient(double h);
  /// What `accelerate` found for planet k, counted from the innermost.
  Vec3<double> along(std::size_t k) const {
    const PlanetRow& row = row_[k / 8];
    return {row.along[0][k % 8], row.along[1][k % 8], row.along[2][k % 8]};
  }
  /// Whether the rows hold the forces at the planets' places.
  bool knows_forces() const { return knows_forces_; }
  /// Calls note(i, j, r^2, squared distance of the nearer one from the star) for all pairs, as the last kick met them.
  template <class Note> void for_pairs(const Note& note) const {
    for (std::size_t k = 1; k < order_.size(); ++k) {
      for (std::size_t j = 0; j < k; ++j) {
        const Vec3<double> x = from_star(k), other = from_star(j), d = x - other;
        note(static_cast<Index>(order_[k]), static_cast<Index>(order_[j]), norm2(d), std::min(norm2(x), norm2(other)));
      }
    }
  }
  /// Universal variable of the last arc of planet k, counted from the innermost.
  double arc(std::size_t k) const { return row_[k / 8].arc[k % 8]; }

  /// Rows of planets that needed second passes, and arcs left to the solver for all cases, since `bind`.
  std::int64_t second_passes() const { return second_passes_; }
  std::int64_t exact_arcs() const { return exact_arcs_; }

  void forget() { last_ = 0, predicted_ = false; }
  /// Predictions of the next arcs, and for which length; `s` is empty where there are none.
  struct Predictions {
    double last = 0;
    std::vector<double> s = {};
  };
  void give(Predictions& to) const;
  /// @throws Error  if they are not of these planets
  void take(const Predictions& from);
  bool predicted() const { return predicted_; }
  double last() const { return last_; }
  void save(SavedState& saved, const std::string& prefix) const;
  /// @throws Error  if the saved prediction is not one of these planets
  void load(const SavedState& saved, const std::string& prefix);

 private:
  PlanetRows rows();
  PlanetPairs& pair_constants(std::size_t first_row, std::size_t second_row);
  template <class Set> void for_places(std::size_t inner, std::size_t outer, const Set& set);
  void set_near(std::size_t inner, std::size_t outer, double ratio2);
  void set_reach(std::size_t k, double ratio2_of_equals);
  /// The innermost planet whose pair with planet k has constants that are kept.
  std::size_t first_kept(std::size_t k) const { return of_own_alone_ ? k / 8 * 8 : 0; }
  Vec3<double> from_star(std::size_t k) const {
    const PlanetRow& row = row_[k / 8];
    return {row.y[0][k % 8], row.y[1][k % 8], row.y[2][k % 8]};
  }

  std::vector<std::int64_t> order_;  ///< particles, from the innermost planet out
  AlignedVector<PlanetRow> row_;
  AlignedVector<PlanetPairs> pairs_;
  double star_mu_ = 0;  ///< G m_0
  bool jacobi_ = true, compensated_ = false, relativity_ = false;
  bool of_own_alone_ = false;  ///< constants of pairs are kept of each row with itself alone
  double last_ = 0;            ///< length of the last arcs; 0: none since the prediction was forgotten
  bool predicted_ = false;     ///< `s` of the rows is a prediction for arcs of that length
  bool knows_forces_ = false;
  std::int64_t second_passes_ = 0, exact_arcs_ = 0;
};

}  // namespace noether
