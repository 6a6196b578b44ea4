#pragma once
/// A run as one page of HTML that plays it.

#include "cli/view_data.hpp"

#include <string>

namespace noether {

/// Pages stay below this number of bytes.
inline constexpr std::size_t largest_page = 25'000'000;

struct ViewPage {
  std::string html;
  std::size_t frames = 0;  ///< that it holds
};

/// The page of a run. Where all frames would be too large, it holds fewer of them, at equal distances.
///
/// It needs nothing else: style, script and frames stand in it. The frames are whole numbers of 2 or 4 bytes (fractions
/// of the box's edges, or the bits of floats), each less the one of the frame before, their bytes sorted by
/// significance, compressed (zlib), in base64.
ViewPage view_page(const ViewData& data);

}  // namespace noether
