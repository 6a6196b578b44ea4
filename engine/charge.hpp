#pragma once
/// The column of electric charges.

#include "engine/columns.hpp"

#include <string_view>

namespace noether {

/// Charges, shape (n) [charge]; a column of its own that particles have only where something brought charges.
///
///     particles.add_column<Charge>();
///     particles.column<Charge>()[0] = -0.8476;
struct Charge {
  template <class Real> using type = ScalarColumn<Real>;
  static constexpr std::string_view name = "charge", dimension = "charge";
  static constexpr ColumnRole role = ColumnRole::parameter;
};

}  // namespace noether
