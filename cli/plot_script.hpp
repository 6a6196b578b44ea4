#pragma once
/// A picture as a gnuplot script.

#include "cli/plot_data.hpp"

#include <string>

namespace noether {

enum class PictureFormat { svg, png };

/// The script that draws `data` into `picture`, a path; one panel per scale of orbits and one per error.
std::string plot_script(const PlotData& data, PictureFormat format, const std::string& picture);

}  // namespace noether
