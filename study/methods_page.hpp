#pragma once
/// Methods as measured, as a page.

#include "study/method_traits.hpp"

#include <string>
#include <vector>

namespace noether {

/// A row of docs/methods.md: name, order, forces, symplectic, reversible, momentum, angular momentum, energy, steps,
/// stability limit, use.
std::vector<std::string> cells_of(const MeasuredMethod& method);

/// docs/methods.md: the methods_measured as one table for each family, with a word on how they were made.
std::string methods_page(const std::vector<MeasuredMethod>& methods_measured);

}  // namespace noether
