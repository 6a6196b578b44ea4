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

/// A report's page: its title as the heading, then the body, with the style and the script of all reports.
std::string html_page(std::string_view title, std::string_view body);

}  // namespace noether
