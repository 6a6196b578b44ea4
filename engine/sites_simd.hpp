#pragma once
/// Places of the sites of rigid bodies, eight bodies side by side: the interface of `sites_simd.cpp`, compiled once per
/// SIMD level.

#include "numbers/kernels_simd.hpp"

#include <cstddef>

namespace noether {

/// Columns of bodies and of sites: component k of row i stands at `[k][i]`.
struct SiteColumns {
  const double* orientation[4];
  const double* x[3];
  double* arm[3];  ///< of sites, from the centre of their body, in space
  double* at[3];   ///< where they are
};

struct SiteKernels {
  /// Places the sites of the bodies [from, to), all of one kind, with the bits of `to_space`.
  /// @param site  the first one of body `from`; those of the others follow
  /// @param places  of the `sites` sites in a body, three numbers each
  void (*place)(const SiteColumns& columns, const double* places, std::ptrdiff_t sites, std::ptrdiff_t from,
                std::ptrdiff_t to, std::ptrdiff_t site);
};

NOETHER_KERNELS(SiteKernels, site_kernels)

}  // namespace noether
