#pragma once
/// Sine and cosine of small angles, whose bits are the same on every processor.

#include "numbers/real.hpp"

#include <cmath>
#include <type_traits>

namespace noether {

/// Both functions of one angle.
template <class Real> struct SineCosine { Real sine, cosine; };

/// sin x and cos x: of doubles up to a quarter of pi by polynomials, within an ulp; of others by the functions of the
/// type.
/// @cost 14 products and 12 sums
/// @source Ng1992
template <class Real> SineCosine<Real> sine_cosine(const Real& x) {
  using std::cos, std::sin;
  if constexpr (std::is_same_v<Real, double>) {
    if (std::fabs(x) <= 0.78539816339744828) {
      const double z = x * x, w = z * z;
      const double s = 8.33333333332248946124e-03 + z * (-1.98412698298579493134e-04 + z * 2.75573137070700676789e-06) +
                       z * w * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10);
      const double c =
          z * (4.16666666666666019037e-02 + z * (-1.38888888888741095749e-03 + z * 2.48015872894767294178e-05)) +
          w * w * (-2.75573143513906633035e-07 + z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11));
      const double halved = 0.5 * z, remainder = 1 - halved;
      return {x + (z * x) * (-1.66666666666666324348e-01 + z * s), remainder + (((1 - remainder) - halved) + z * c)};
    }
  }
  return {sin(x), cos(x)};
}

}  // namespace noether
