#include "integrators/variational/singular_action.hpp"

#include "integrators/variational/lagrangian_field.hpp"
#include "numbers/error.hpp"

#include <fmt/format.h>

namespace noether {

template <class Real> Failure singular_action(double h, double fraction, const Vector<Real>& q) {
  return {Outcome::Kind::solver_failure, -1, "step",
          fmt::format("the discrete Lagrangian is singular: D1 D2 L_d has no inverse at {:.3g} of the step of {:.9g}, "
                      "near {}; take a smaller step, or other coordinates",
                      fraction, h, place_text(q))};
}
template Failure singular_action(double h, double fraction, const Vector<double>& q);
template Failure singular_action(double h, double fraction, const Vector<Quad>& q);

void refuse_without_lagrangian(std::string_view method, std::string_view field) {
  throw SchemeMismatch(fmt::format(
      "method '{}' makes an action stationary, but '{}' has no Lagrangian; use a method for y' = f, such as "
      "'gauss_3'",
      method, field));
}

}  // namespace noether
