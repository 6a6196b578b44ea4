#include "engine/box.hpp"

#include "engine/box_simd.hpp"
#include "numbers/error.hpp"

#include <fmt/format.h>

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

BoxAxis Box::axis(int k) const {
  // A sum that rounding could bring back into the cell is beyond the last point of the grid already.
  return {edges_[k], std::ldexp(1.5, 52) * spacing_[k], std::ldexp(1.0, 50) * spacing_[k]};
}

void Box::bring_in(int k, double* x, std::int32_t* image, Index count) const {
  const BoxAxis of = axis(k);
  const BoxKernels& kernels = box_kernels();
  for (Index i = 0; (i = kernels.round(of, x, i, count)) < count; ++i) {
    x[i] = on_grid(k, x[i]) + 0.0;  // -0 is 0, as in lanes
    wrap(k, x[i], image[i]);
  }
}

void Box::advance(int k, double h, const double* v, double* x, std::int32_t* image, Index count) const {
  const BoxAxis of = axis(k);
  const BoxKernels& kernels = box_kernels();
  for (Index i = 0; (i = kernels.advance(of, h, v, x, i, count)) < count; ++i) shift(k, h * v[i], x[i], image[i]);
}

}  // namespace noether
