#include "neighbors/neighbor_images.hpp"

#include "numbers/error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace noether {

void check_images(const Box& box, double range, double skin) {
  if (!box.is_periodic()) return;
  const auto images = [&](double reach) {
    double count = 1;
    for (int k = 0; k < 3; ++k) count *= 1 + 2 * std::ceil(reach / box.edges()[k]);
    return count;
  };
  constexpr double most = 10'000;
  const Vec3<double>& edges = box.edges();
  if (images(range) > most) {
    throw Error(
        fmt::format("the box of {:.6g} x {:.6g} x {:.6g} is so small compared with the range {:.6g} of the pair forces "
                    "that each particle would see {:.3g} images; repeat the cell, or take a shorter cutoff",
                    edges[0], edges[1], edges[2], range, images(range)),
        {.key = "box"});
  }
  if (images(range + skin) > most) {
    throw Error(
        fmt::format("skin = {:.6g} reaches so far beyond the box of {:.6g} x {:.6g} x {:.6g} that each particle "
                    "would see {:.3g} images; take a smaller one",
                    skin, edges[0], edges[1], edges[2], images(range + skin)),
        {.key = "skin"});
  }
}

}  // namespace noether
