#pragma once
/// A picture as a gnuplot script.

#include "cli/plot_data.hpp"

#include <string>

namespace noether {

enum class PictureFormat { svg, png, pdf };

/// The script that draws `data` into `picture`, a path.
std::string plot_script(const PlotData& data, PictureFormat format, const std::string& picture);

}  // namespace noether
