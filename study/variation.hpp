#pragma once
/// What varies from one member of an ensemble to the next: keys of a scene, on grids or drawn at random.

#include "numbers/types.hpp"
#include "scene/value.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// One key and the values it takes.
struct Variation {
  enum class Kind : std::uint8_t {
    grid,     ///< `first` to `second`, both included, in `count` points
    uniform,  ///< drawn between `first` and `second`
    normal    ///< drawn, mean `first`, standard deviation `second`
  };
  std::string key;  ///< a path as `--set` takes it: "particles.body.b.a"
  Kind kind = Kind::grid;
  double first = 0, second = 0;  ///< in `unit`
  std::int64_t count = 1;        ///< of a grid
  std::string unit = {};         ///< behind numbers, such as "au"; empty: that of the scene
  std::string text = {};         ///< as it was written

  /// Reads KEY=a:b:n, KEY=uniform(a,b) or KEY=normal(m,s), each with a unit behind it or none.
  /// @throws Error  for what is none of these, a grid of fewer than 2 points, and a deviation that is not above 0
  static Variation parse(std::string_view text);

  bool drawn() const { return kind != Kind::grid; }
};

/// The members of an ensemble by number: all points of the grids, the last grid's fastest, and at each point as many
/// draws as are asked for, these fastest of all.
///
/// A draw is a function of the seed, the place of its key among those that are drawn, and the member, and of nothing
/// else (`numbers/random.hpp`): members may be made in any order, by any thread and on any machine.
class EnsemblePlan {
 public:
  static constexpr std::int64_t most_members = 1'000'000'000;

  /// @param draws  at each point of the grids; empty where nothing is drawn
  /// @throws Error  for no variations, a key twice, draws of unknown or without number, and more than `most_members`
  EnsemblePlan(std::vector<Variation> variations, std::optional<std::int64_t> draws, std::int64_t seed);

  const std::vector<Variation>& variations() const { return variations_; }
  std::int64_t members() const { return members_; }
  std::int64_t seed() const { return seed_; }
  /// Points of each grid, then the number of draws where there are any: how members lie in an array.
  const std::vector<Index>& shape() const { return shape_; }

  /// The values of a member, in the order of the variations.
  std::vector<double> values(std::int64_t member) const;
  /// What differs from one member to the next: the keys that are drawn, else that of the last grid.
  std::vector<std::string> fastest_keys() const;
  /// The first value of a grid, the lower end of a uniform draw, the mean of a normal one.
  std::vector<double> typical_values() const;

 private:
  std::vector<Variation> variations_;
  std::int64_t members_ = 1, draws_ = 1, seed_ = 0;
  std::vector<Index> shape_;
};

/// How values of variations are put into a scene: as numbers, or as quantities in a unit.
class VariedKeys {
 public:
  /// @param scene  as it was written, with its changes
  /// @throws Error  for a key whose value in the scene is no number and no quantity
  VariedKeys(const SceneValue& scene, const std::vector<Variation>& variations);

  /// Changes of the scene, "key=value", that give it these values to the last bit.
  std::vector<std::string> sets(const std::vector<double>& values) const;

 private:
  struct Key {
    std::string key, unit;
    bool whole = false;  ///< the scene has a whole number there
  };
  std::vector<Key> keys_;
};

}  // namespace noether
