#pragma once
/// Rows of marks as SVG, a method a row: verdicts by test, and largest stable steps beside theory.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// What a run of a test showed.
enum class Finding : std::uint8_t {
  kept,        ///< bounded, its errors too
  inaccurate,  ///< bounded, an error beyond a bound
  unbounded,
  unsolved,  ///< a step or a constraint could not be solved
  unsettled  ///< the time was over before
};

/// The result of one method in one test.
struct VerdictMark {
  std::size_t column = 0;
  Finding finding = Finding::kept;
  bool expected = true;
  std::string title = {};  ///< shown under the pointer
};

struct VerdictRow {
  std::string label = {};
  std::vector<VerdictMark> marks = {};
};

/// A table of marks: methods downward, tests across. What was not expected stands in a red cell, of class "alarm".
std::string verdicts_svg(const std::vector<std::string>& columns, const std::vector<VerdictRow>& rows);

/// The marks of all findings with their meanings, as a paragraph of HTML.
std::string verdicts_key();

/// The largest stable step of one method.
struct LimitRow {
  std::string label = {};
  std::optional<double> measured = {}, theory = {};  ///< none: no limit
  bool theory_known = true;
  bool settled = true;                  ///< else measured is as far as is known
  bool differs = false;                 ///< measured and theory
  std::vector<double> resonances = {};  ///< of a nonlinear problem
  std::string note = {};                ///< beside the row
};

/// Bars that end at the measured limit, a stroke where theory has it, dots at resonances: logarithmic where these span
/// a decade and more. No limit is an arrow at the right edge. Where measured and theory differ, bar and texts of the
/// row are red, of class "alarm".
std::string limits_svg(const std::string& axis, const std::vector<LimitRow>& rows);

/// The marks of limits with their meanings, as a paragraph of HTML.
std::string limits_key();

}  // namespace noether
