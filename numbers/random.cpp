#include "numbers/random.hpp"

#include "numbers/noise_simd.hpp"

namespace noether {

void noise(const std::array<std::uint32_t, 2>& key, const std::int64_t* ids, std::ptrdiff_t count, std::int64_t step,
           std::uint32_t stage, double* x, double* y, double* z) {
  const NoiseKernels& kernels = noise_kernels();
  const std::uint32_t words[2] = {key[0], key[1]};
  std::ptrdiff_t done = 0;
  if (kernels.normals != nullptr) {
    done = count - count % kernels.lanes;
    kernels.normals(words, ids, done, step, stage, x, y, z);
  }
  for (; done < count; ++done) {
    const std::array<double, 3> one = noise(key, ids[done], step, stage);
    x[done] = one[0];
    y[done] = one[1];
    z[done] = one[2];
  }
}

}  // namespace noether
