#pragma once
/// How fast fields turn the charges of a scene where its run begins.

#include "numbers/types.hpp"

#include <optional>
#include <vector>

namespace noether {

struct Scene;

/// |q B|/(m gamma) of each particle at a time [1/time]; empty without a field.
/// @cost one evaluation of the fields
std::vector<double> gyration_rates(const Scene& scene, double time);

/// How long the first charge that turns takes for a turn [time]; empty where none does.
std::optional<double> first_gyration(const Scene& scene, double time);

}  // namespace noether
