#include "engine/box.hpp"

#include "engine/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace noether {

Box Box::periodic(const Vec3<double>& edges) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    // Half of the largest exponent: squares of distances are to be numbers.
    if (!(edges[k] > 1e-150 && edges[k] < 1e150)) {
      throw Error(fmt::format("an edge of the box is {}; a length above 0 is expected", edges[k]));
    }
    box.spacing_[k] = std::ldexp(1.0, std::ilogb(edges[k]) - 52);
  }
  box.edges_ = edges;
  return box;
}

void Box::shift(int k, double d, double& x, std::int32_t& image) const {
  double step = on_grid(k, d);
  wrap(k, step, image);
  // Nothing on the way is longer than the edge: that is where the grid ends.
  if (step >= edges_[k] - x) {
    x = (x - edges_[k]) + step;
    ++image;
  } else {
    x += step;
  }
}

void Box::advance(int k, double h, const double* v, double* x, std::int32_t* image, Index count) const {
  const double edge = edges_[k], spacing = spacing_[k];
  // Adding and subtracting `magic` rounds to the grid what is shorter than a quarter of the edge.
  const double magic = std::ldexp(1.5, 52) * spacing, shortest_long = std::ldexp(1.0, 50) * spacing;
  constexpr Index together = 64;
  for (Index begin = 0; begin < count; begin += together) {
    const Index end = std::min(count, begin + together);
    double far = 0;
    for (Index i = begin; i < end; ++i) far = std::max(far, std::abs(h * v[i]));
    if (!(far < shortest_long)) {
      for (Index i = begin; i < end; ++i) shift(k, h * v[i], x[i], image[i]);
      continue;
    }
    for (Index i = begin; i < end; ++i) {
      const double step = (h * v[i] + magic) - magic;
      const bool above = step >= edge - x[i], below = step < -x[i];
      // As in `shift`: first the sum that cannot leave the grid.
      const double from = x[i] - (above ? edge : 0.0), by = step + (below ? edge : 0.0);
      x[i] = from + by;
      image[i] += static_cast<std::int32_t>(above) - static_cast<std::int32_t>(below);
    }
  }
}

}  // namespace noether
