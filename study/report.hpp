#pragma once
/// A comparison as one page of HTML that needs nothing else.

#include "study/solution.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace noether {

/// The page: error against time and against evaluations, energies over time, orders, the solution of a single body,
/// all rows, and how it was made. It asks no network for anything.
std::string report_html(const Comparison& comparison, const std::optional<Solution>& solution = {});

/// What the page looks like, and what it does when it is touched.
std::string_view report_style();
std::string_view report_script();

}  // namespace noether
