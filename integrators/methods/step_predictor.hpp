#pragma once
/// Where the stages of a step begin, from the rates of the last two steps.

#include "integrators/methods/collocation_table.hpp"
#include "integrators/methods/stage_arithmetic.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace noether {

/// Weights of the rates at the 16 nodes of two steps, of any lengths, in the displacements of the stages of the next
/// one: those of the polynomial of degree 12 through these nodes, by least squares. With s stages the degree is
/// 3 s / 2, rows of others are 0, and lanes beyond s repeat the first.
///
/// Interpolation through all 16 would follow the rounding errors of the rates, whose share grows with the degree.
class StepPredictor {
 public:
  /// Beyond these ratios of lengths, the nodes of the longer step say too little about the shorter one.
  static constexpr double least_ratio = 0.2, most_ratio = 3;

  /// @param table  of up to eight stages
  explicit StepPredictor(const CollocationTable& table);

  /// Takes what memory `weights` needs, which else takes it when it is first asked.
  void reserve();
  /// Shape (16, 8), in units of h^2: row 8 s + j is that of node j of the last step, s = 0, or the one before, s = 1.
  /// They depend on the lengths alone. Valid until the next call.
  const double* weights(double h, double last, double before);
  static bool serves(double h, double last, double before);

 private:
  static constexpr std::size_t nodes = 2 * lane_count;
  using Weights = std::array<double, nodes * lane_count>;

  /// Weights that have been asked for, each in one of the four places that its lengths say. They are no state: a copy
  /// has none.
  struct Tables {
    struct Table {
      double next = 0, before = 0;  ///< ratios to the last step; 0 for none
      std::uint64_t asked = 0;      ///< when, for the last time
      Weights weights{};
    };
    std::vector<Table> all;
    std::uint64_t now = 0;

    Tables() = default;
    Tables(const Tables&) {}
    Tables& operator=(const Tables& other) {
      if (this != &other) all.clear();
      return *this;
    }
    Tables(Tables&&) = default;
    Tables& operator=(Tables&&) = default;
    ~Tables() = default;
  };

  std::size_t stages_;
  StageLanes<double> c_{};
  StageMatrix<double> twice_{};
  Weights same_;  ///< for three steps of one length
  Tables tables_;
};

}  // namespace noether
