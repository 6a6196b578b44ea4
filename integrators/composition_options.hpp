#pragma once
/// What a splitting takes beside its scheme.

#include "engine/description.hpp"

#include <string_view>

namespace noether {

/// Options of a composition, whatever its scheme.
struct CompositionOptions {
  bool compensated = false;  ///< keep the rounding errors of x and v and add them back (Kahan, Neumaier)

  /// Why methods for y' = f have none of them.
  static constexpr std::string_view elsewhere = "sums in its own way";

  static constexpr auto describe() {
    return part<CompositionOptions>(
        "composition", "options of splittings in addition to the scheme",
        field<&CompositionOptions::compensated>("compensated", "1",
                                                "keeps the rounding errors of sums and adds them again later"));
  }
  /// Refuses what does not go with constraints. @throws Error
  void check_with_constraints() const {
    if (compensated) {
      refuse_field("compensated", "true",
                   "does not work with constraints, which are solved to the rounding of plain sums");
    }
  }
};

}  // namespace noether
