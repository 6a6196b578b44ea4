#pragma once
/// Columns that parts may declare: of numbers, of whole numbers, of vectors.

#include "engine/charge.hpp"
#include "engine/columns.hpp"

#include <cstdint>
#include <string_view>

namespace noether {

struct Kind {
  static constexpr std::string_view name = "kind", dimension = "1";
  static constexpr ColumnRole role = ColumnRole::parameter;
  template <class Real> using type = ScalarColumn<std::int64_t>;
};
struct SpinVector {
  static constexpr std::string_view name = "spin", dimension = "mass length^2/time";
  static constexpr ColumnRole role = ColumnRole::momentum;
  template <class Real> using type = VectorColumn<Real>;
};

}  // namespace noether
