#pragma once
/// What the planets of a Wisdom-Holman splitting did over some letters, as tracers need it.

#include "integrators/planet_row.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace noether {

/// Letters of some steps of the planets, which tracers then go one after the other: planets do not feel them.
///
/// Level w of Jacobi coordinates is about the center of mass of the star and the w innermost planets. Positions are
/// relative to the star, accelerations those that the splitting leaves to kicks.
class PlanetPath {
 public:
  using Vector = std::array<double, 3>;

  void clear() { letters_.clear(), numbers_.clear(); }
  void reserve(std::size_t letters, std::size_t numbers, std::size_t planets) {
    letters_.reserve(letters);
    numbers_.reserve(numbers);
    levels_.reserve(planets + 1);
  }
  /// Which step of the run the next letter is part of.
  void at_step(std::int64_t step) { step_ = step; }

  void add_arc(const ArcTask& task);
  /// Before the planets make that kick.
  /// @param planets  of `rows` that are there
  void begin_kick(const PlanetRows& rows, std::size_t planets, double h, double time, bool predicted, bool noting);
  /// After it.
  /// @param star_mu  G m_0
  void end_kick(const PlanetRows& rows, std::size_t planets, double star_mu);

  /// So many numbers each kick has.
  static std::size_t numbers_of_kick(bool jacobi, std::size_t planets) {
    return 3 * planets + 6 * (jacobi ? planets + 1 : 1);
  }

  const std::vector<PathLetter>& letters() const { return letters_; }
  const std::vector<double>& numbers() const { return numbers_; }

 private:
  void add(const Vector& v) { numbers_.insert(numbers_.end(), v.begin(), v.end()); }
  void add_levels(const PlanetRows& rows, std::size_t planets, double star_mu);

  std::vector<PathLetter> letters_;
  std::vector<double> numbers_;
  std::vector<Vector> levels_;  ///< of the kick: acceleration of each, from the outermost
  Vector jump_ = {};            ///< of the kick, the first one
  std::int64_t step_ = 0;
};

}  // namespace noether
