#pragma once
/// How fast fields turn the charges of a scene where its run begins.

#include "numbers/types.hpp"

#include <optional>
#include <string>
#include <vector>

namespace noether {

struct Scene;

/// |q B|/(m gamma) of each particle at a time [1/time]; empty without a field.
/// @cost one evaluation of the fields
std::vector<double> gyration_rates(const Scene& scene, double time);

/// How long the first charge that turns takes for a turn [time]; empty where none does.
std::optional<double> first_gyration(const Scene& scene, double time);

/// The last word of a step such as "0.05 gyratoin" that is nearly "gyration"; empty for this word and for all others.
std::string misspelt_gyration(const std::string& step);

}  // namespace noether
