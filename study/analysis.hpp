#pragma once
/// What the rows of a comparison say together: who is ahead, and by which order errors fall.

#include "numbers/text.hpp"
#include "study/comparison.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace noether {

/// Marks the rows that no other row beats in both error and cost. Only completed rows with an error and a cost stand a
/// chance.
/// @param cost  empty: not measured
/// @param error  the same
/// @return one flag for each row
std::vector<bool> pareto_front(const std::vector<std::optional<double>>& cost,
                               const std::vector<std::optional<double>>& error);

/// A straight line through points of a double logarithmic plot.
struct PowerLaw {
  double exponent = 0, exponent_error = 0, log_factor = 0;  ///< y = exp(log_factor) x^exponent
  int points = 0;
  double range = 1;  ///< of the largest x to the smallest

  double operator()(double x) const;
};

/// Least squares through the asymptotic part: of points (x, error) with falling x, the longest run of neighbours above
/// rounding and below 0.1 whose slopes agree to `spread`; empty below two points.
/// @param floor  errors below this are rounding
std::optional<PowerLaw> asymptotic_fit(std::vector<std::pair<double, double>> points, double floor,
                                       double spread = 0.35);

/// Sets both Pareto columns and the order fits of a comparison. A run whose error is as large as what it computes
/// stands on no front.
void analyse(Comparison& comparison);

/// The finest of the runs as the reference where extended precision has none: that of the method whose two finest runs
/// agree best. Stays as it is where they differ by more than 1e-3.
void use_finest_run(Comparison& comparison, const PositionError& error);

}  // namespace noether
