#include "engine/orbital_elements.hpp"

#include "engine/description.hpp"
#include "numbers/quantity.hpp"

#include <cmath>

namespace noether::detail {

void refuse_elements(const OrbitalElements<double>& o, double mu) {
  if (!(mu > 0))
    throw Error("an orbit about G m = " + format_number(mu) + " is impossible; a mass above 0 is expected",
                {.key = "mass", .value = format_number(mu)});
  constexpr const char* names[] = {"a", "e", "inc", "Omega", "omega", "M"};
  const double values[] = {o.a, o.e, o.inc, o.Omega, o.omega, o.M};
  for (int k = 0; k < 6; ++k) {
    if (!std::isfinite(values[k])) refuse_field(names[k], values[k], "is not finite; a finite number is expected");
  }
  if (o.a == 0)
    refuse_field("a", o.a, "is not a valid semi-major axis; expected a > 0 for an ellipse, a < 0 for a hyperbola");
  if (o.a > 0 && o.e > 1) {
    refuse_field("e", o.e, "does not fit a > 0, which means an ellipse; expected 0 <= e < 1, or a < 0 for a hyperbola");
  }
  if (o.a < 0 && o.e >= 0 && o.e < 1) {
    refuse_field("a", o.a, "does not fit e < 1, which means an ellipse; expected a > 0, or e > 1 for a hyperbola");
  }
  refuse_field("e", o.e, "is neither an ellipse nor a hyperbola; expected 0 <= e < 1 with a > 0, or e > 1 with a < 0");
}

}  // namespace noether::detail
