#pragma once
/// The search for neighbors in lanes: the interface of `neighbor_search_simd.cpp`, compiled once per SIMD level.

#include "numbers/kernels_simd.hpp"

#include <cstddef>
#include <cstdint>

namespace noether {

/// Points that follow each other in memory: `count` of them from place `begin` on, numbered from `number` on.
struct PointRun {
  std::int32_t begin, count, number;
};

/// Where points are, in single precision; 16 more can be read behind the last.
struct SearchPoints {
  const float *x, *y, *z;
};

/// A box along the axes: its middle and half of its edges.
struct SearchBox {
  float middle[3], half[3];
};

/// Points near a box, relative to its middle, shape (count) each, and their numbers. There must be room for 16 more.
struct NearPoints {
  float *x, *y, *z;
  std::int32_t* number;
  std::ptrdiff_t count;
};

/// Neighbors are sorted by distance into this many shells.
constexpr int neighbor_shells = 4;

struct NeighborSearchKernels {
  /// Finds the points of all runs whose squared distance from a box is up to `limit`, in order; `near` must have room
  /// for all.
  void (*gather)(const PointRun* runs, std::ptrdiff_t count, const SearchPoints& points, const SearchBox& box,
                 float limit, NearPoints& near);
  /// Writes numbers and squared distances of the points up to `limit` from (x, y, z), in order, and returns how many
  /// there are. 16 more can be read behind the points, and have room.
  std::ptrdiff_t (*select)(const NearPoints& near, float x, float y, float z, float limit, std::int32_t* number,
                           float* r2);
  /// Writes the numbers of all but those that are struck by shells, those with r2 up to limits[0] first, and returns
  /// how many these are; `rows` grows to what each shell and those within it hold. 16 more can be read and written, and
  /// have room.
  std::ptrdiff_t (*sort)(const std::int32_t* number, float* r2, std::ptrdiff_t count, const std::int32_t* struck,
                         std::ptrdiff_t struck_count, const float (&limits)[neighbor_shells], std::int32_t* out,
                         std::int32_t (&rows)[neighbor_shells]);
  /// Turns eight lists into rows of eight, each number times four; lists have room up to the next multiple of eight
  /// rows, as has `out`.
  void (*turn)(const std::int32_t* const (&lists)[8], std::ptrdiff_t rows, std::int32_t* out);
};

NOETHER_KERNELS(NeighborSearchKernels, neighbor_search_kernels)

}  // namespace noether
