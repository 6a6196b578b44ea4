#pragma once
/// Newton's iteration, carried down to rounding.

#include "integrators/method.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace noether {

/// How long an update is: its largest component relative to the largest of its kind, and relative to its own value.
struct UpdateSize {
  double whole = 0, each = 0;
};

/// Size of the update `d` times `factor`, `count` components; a value is as large as `from`, which it was reached from
/// by adding, or as `to`, where it is now: rounding errors are as large as the larger of them.
template <class Real>
UpdateSize update_size(const Real* d, double factor, const Real* from, const Real* to, Index count) {
  double longest = 0, largest = 0, each = 0;
  for (Index i = 0; i < count; ++i) {
    const double change = std::abs(factor * static_cast<double>(d[i]));
    const double value = std::max(std::abs(static_cast<double>(from[i])), std::abs(static_cast<double>(to[i])));
    if (!std::isfinite(change)) return {change, change};
    if (change < std::numeric_limits<double>::min()) continue;  // below the normal numbers nothing is relative any more
    longest = std::max(longest, change);
    largest = std::max(largest, value);
    each = std::max(each, value > 0 ? change / value : std::numeric_limits<double>::max());
  }
  if (longest == 0) return {0, 0};
  return {largest > 0 ? longest / largest : std::numeric_limits<double>::max(), each};
}

/// The same for y = (q, v), where positions and velocities are of two kinds, or for y of one kind.
template <class Real>
UpdateSize update_size(const Vector<Real>& d, const Vector<Real>& from, const Vector<Real>& to, bool second_order) {
  if (!second_order) return update_size(d.data(), 1, from.data(), to.data(), to.size());
  const Index half = to.size() / 2;
  const UpdateSize q = update_size(d.data(), 1, from.data(), to.data(), half);
  const UpdateSize v = update_size(d.data() + half, 1, from.data() + half, to.data() + half, half);
  return {std::max(q.whole, v.whole), std::max(q.each, v.each)};
}

/// What an implicit method says of a linear system that products with its matrix did not solve.
inline Failure unsolved_system() {
  return {Outcome::Kind::solver_failure, -1, "step",
          "GMRES and BiCGSTAB did not solve a linear system of the implicit step; take a smaller step, or "
          "jacobian = \"sparse\" or \"dense\""};
}

/// Repeats `correct` until its updates have stopped to shrink at the level of rounding.
///
/// `correct()` makes one update, by the matrix there is, and returns its size, or nothing if its system was not solved.
/// Where updates shrink by less than half, the iteration goes back to its guess (`restart`) and on with matrices from
/// where it stands (`renew`): an old matrix may lead to another solution. Rounding of a badly conditioned right-hand
/// side may lie above that of the numbers: an update that shrinks no more with a new matrix is taken for it below a
/// millionth of all digits.
/// @return nothing, or why it failed
/// @cost four to eight updates for smooth problems, without a new matrix
template <class Real, class Correct, class Restart, class Renew>
std::optional<Failure> newton_to_rounding(const Correct& correct, const Restart& restart, const Renew& renew) {
  constexpr int most = 100, most_renewals = 40;
  constexpr double unknown = std::numeric_limits<double>::infinity();
  const double rounding = static_cast<double>(std::numeric_limits<Real>::epsilon());
  const double smooth = 64 * rounding, rough = 1e6 * rounding;
  UpdateSize before{unknown, unknown};
  bool old_matrix = true, regular = true;
  int renewals = 0, iteration = 1;
  for (; regular && iteration <= most && renewals <= most_renewals; ++iteration) {
    const std::optional<UpdateSize> made = correct();
    if (!made) return unsolved_system();
    const UpdateSize now = *made;
    if (now.whole == 0) return {};
    // Another update would be lost in rounding, or is nothing but rounding.
    const bool lost = now.each * (now.each / before.each) <= rounding / 4 && std::isfinite(before.each);
    if (now.whole <= smooth && (lost || !(now.each < 0.5 * before.each))) return {};
    const bool slow = !(now.whole < 0.5 * before.whole);
    if (old_matrix && (!slow || now.whole <= smooth)) {
      before = now;
    } else if (old_matrix) {
      const bool near = now.whole <= rough;
      if (!near) restart();
      before = near ? now : UpdateSize{unknown, unknown};
      old_matrix = false;
      ++renewals;
      regular = renew();
    } else {
      if (slow && now.whole <= rough) return {};
      if (!std::isfinite(now.whole)) break;
      const bool quick = now.whole < 0.1 * before.whole && std::isfinite(before.whole);
      before = now;
      if (quick || now.whole <= smooth) continue;
      ++renewals;
      regular = renew();
    }
  }
  return Failure{Outcome::Kind::solver_failure, -1, "step",
                 fmt::format("Newton's iteration found no solution of the implicit step: its last update, number {}, "
                             "was {:.3g} of the solution; take a smaller step",
                             std::min(iteration, most), before.whole)};
}

/// What an implicit method says of a matrix without inverse.
inline Failure singular_matrix(double h) {
  return {Outcome::Kind::solver_failure, -1, "step",
          fmt::format("the matrix of the implicit step of {:.9g} is singular or not finite, 0 iterations made; take a "
                      "smaller step",
                      h)};
}

}  // namespace noether
