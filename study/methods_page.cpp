#include "study/methods_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

constexpr std::string_view introduction =
    R"page(# Methods, measured

Written by `./noether list methods --measured > docs/methods.md` (with `--json`: the same for machines, claims and
measurements side by side). Every cell but the last is measured by running the method; a test in `tests/study`
measures all of them again and fails where one differs from this page, or from what the method claims. A row whose
cells differ from its claims ends with them in square brackets.

- **order**: p of an error O(h^p) at t = 6 on two orbits of Henon and Heiles, the smaller one, in 113 bits, with steps
  of one length. "4, to 12": where it chooses its steps, the order varies up to 12. "varies, to 16, in Quad to 24 (18)":
  the method always chooses its steps; in double precision orders go up to 16, in 113 bits (Quad) up to 24,
  and there errors fall as the 18th power of the work, between tolerances of 1e-9 and 1e-13.
- **forces**: evaluations per step of given length, after the start, counted, Jacobians not among them. "iterates": as
  many as its equations take.
- **S**, symplectic: M^T J M = J for the Jacobian M of 24 steps. **R**, reversible: 24 steps, velocities turned, 24
  steps lead back. **P**, **L**: momentum and angular momentum of three bodies stay, to rounding. All with steps of
  one length where there are any.
- **energy** over 100 periods of a regular orbit of Henon and Heiles: it is kept to rounding, its error is bounded, or
  drifts away.
- **steps**: "fixed", of one length; "own", chosen by the method.
- **stable to**: the first h omega at which an oscillator grows by more than 1e-15 a step, within 2e-4. "never": it
  grows at every step, if slowly. "always": at none up to 12. "(solver)": beyond it the iteration of the method, to
  rounding in double precision, finds no solution. A scheme of high order may have a first gap as low as 1e-7 and as
  narrow as 1e-3 near 3.14: steps beyond it can be fine.
- **best for**: what the method says of itself.

Methods that serve gravity alone are measured on a star and two planets instead, on states of two doubles against 113
bits, with steps of a sixth of the inner planet's period, over a hundred of its turns for the energy.

Orders (8, 6, 4) and the like, for H = A + eps B with eps small, are measured in
`tests/order/near_integrable_test.cpp`.
)page";

std::string_view mark(bool yes) { return yes ? "yes" : ""; }

std::string order_cell(const MeasuredMethod& p) {
  if (!p.measured.order) return "?";
  const double order = *p.measured.order;
  if (!p.measured.fixed_steps) {
    const double in_quad = p.claimed.order.value_or(0);
    const std::string higher = in_quad > p.highest_order ? fmt::format(", in Quad to {:.0f}", in_quad) : "";
    return fmt::format("varies, to {}{} ({:.0f})", p.highest_order, higher, order);
  }
  const double whole = std::round(order);
  const std::string text = std::abs(order - whole) < 0.35 ? fmt::format("{:.0f}", whole) : fmt::format("{:.1f}", order);
  return p.measured.own_steps && p.highest_order > whole ? fmt::format("{}, to {}", text, p.highest_order) : text;
}

std::string limit_cell(const MethodTraits& measured) {
  if (!measured.stability_limit) return "";
  const double z = *measured.stability_limit;
  if (z == 0) return "never";
  if (std::isinf(z)) return "always";
  return measured.limit_of_iteration ? fmt::format("{:.2f} (solver)", z) : fmt::format("{:.4f}", z);
}

std::string steps_cell(const MethodTraits& measured) {
  if (measured.fixed_steps && measured.own_steps) return "fixed, own";
  return measured.fixed_steps ? "fixed" : "own";
}

std::string row_of(const MeasuredMethod& method) {
  std::string row = "|";
  for (const std::string& cell : cells_of(method)) row += cell.empty() ? " |" : fmt::format(" {} |", cell);
  const std::vector<std::string> differences = method.differences();
  if (!differences.empty()) row.insert(row.size() - 2, fmt::format(" [{}]", fmt::join(differences, "; ")));
  return row + "\n";
}

}  // namespace

std::vector<std::string> cells_of(const MeasuredMethod& method) {
  const MethodTraits& m = method.measured;
  const std::string forces = m.evaluations ? fmt::format("{:.0f}", *m.evaluations) : m.fixed_steps ? "iterates" : "";
  return {method.name,
          order_cell(method),
          forces,
          std::string(mark(m.symplectic)),
          std::string(mark(m.reversible)),
          std::string(mark(m.momentum)),
          std::string(mark(m.angular_momentum)),
          std::string(text_of(m.energy)),
          steps_cell(m),
          limit_cell(m),
          method.use};
}

std::string methods_page(const std::vector<MeasuredMethod>& methods_measured) {
  const std::string head =
      "| method | order | forces | S | R | P | L | energy | steps | stable to | best for |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::string page(introduction);
  std::vector<std::string> families;
  for (const MeasuredMethod& method : methods_measured) {
    if (std::find(families.begin(), families.end(), method.family) == families.end()) {
      families.push_back(method.family);
    }
  }
  for (const std::string& family : families) {
    page += fmt::format("\n## {}\n\n{}", family, head);
    for (const MeasuredMethod& method : methods_measured) {
      if (method.family == family) page += row_of(method);
    }
  }
  return page;
}

}  // namespace noether
