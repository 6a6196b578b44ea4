#pragma once
/// Constraints of one's own, written in Python: a function of some particles' positions that stays 0.

#include "constraints/constraint.hpp"
#include "python/module/callable.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <string_view>

namespace noether {
class Parts;
}

namespace noether::python {

/// One equation on k particles. Derivatives come by dual numbers, which are objects in Python too
/// (python/noether/duals.py): the function is called with them in the place of floats.
/// @cost several microseconds a call, and each operation of Python's
template <std::size_t k> class UserConstraint {
 public:
  std::int64_t function = 0;
  double size = 1;

  static constexpr std::size_t particles = k;
  static constexpr auto describe() {
    constexpr std::array<std::string_view, 4> names = {"user_constraint", "user_constraint_of_pairs",
                                                       "user_constraint_of_triples", "user_constraint_of_groups"};
    return part<UserConstraint>(
        names[k - 1], "a function of one's own, in Python: of positions, which stays 0",
        field<&UserConstraint::function>("function", "1", "its number, which Python gives").required("1"),
        field<&UserConstraint::size>("scale", "1", "above 0: what its values are small beside"));
  }
  /// @throws Error  for a scale that is not above 0
  void check() const;
  double scale() const { return size; }
  /// Finds its function. @throws Error  if it lives no more
  UserConstraint at_start(const Points<double, k>& x) const;

  template <class Real> Real value(const Points<Real, k>& x) const;

 private:
  std::shared_ptr<Callable> callable_;
};

/// Makes all of them known.
void add_user_constraints(Parts& parts);

}  // namespace noether::python
