#include "numbers/real.hpp"

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#if defined(__SIZEOF_FLOAT128__) && !(defined(__LDBL_MANT_DIG__) && __LDBL_MANT_DIG__ == 113)
// Declared here because clang does not find GCC's <quadmath.h>; the library itself comes with every GCC.
extern "C" {
__float128 sqrtq(__float128);
__float128 cbrtq(__float128);
__float128 sinq(__float128);
__float128 cosq(__float128);
__float128 tanq(__float128);
__float128 atan2q(__float128, __float128);
__float128 acosq(__float128);
__float128 sinhq(__float128);
__float128 coshq(__float128);
__float128 asinhq(__float128);
__float128 acoshq(__float128);
__float128 expq(__float128);
__float128 expm1q(__float128);
__float128 logq(__float128);
__float128 log1pq(__float128);
__float128 asinq(__float128);
__float128 atanq(__float128);
__float128 tanhq(__float128);
__float128 atanhq(__float128);
__float128 erfq(__float128);
__float128 erfcq(__float128);
__float128 ceilq(__float128);
__float128 hypotq(__float128, __float128);
__float128 fmodq(__float128, __float128);
__float128 powq(__float128, __float128);
__float128 floorq(__float128);
__float128 roundq(__float128);
__float128 strtoflt128(const char*, char**);
int quadmath_snprintf(char*, size_t, const char*, ...);
}
#define NOETHER_QUAD(name) name##q
#else
#define NOETHER_QUAD(name) name##l
#endif

namespace noether {

Quad sqrt(Quad x) { return Quad::from(NOETHER_QUAD(sqrt)(x.value)); }
Quad cbrt(Quad x) { return Quad::from(NOETHER_QUAD(cbrt)(x.value)); }
Quad sin(Quad x) { return Quad::from(NOETHER_QUAD(sin)(x.value)); }
Quad cos(Quad x) { return Quad::from(NOETHER_QUAD(cos)(x.value)); }
Quad tan(Quad x) { return Quad::from(NOETHER_QUAD(tan)(x.value)); }
Quad atan2(Quad y, Quad x) { return Quad::from(NOETHER_QUAD(atan2)(y.value, x.value)); }
Quad acos(Quad x) { return Quad::from(NOETHER_QUAD(acos)(x.value)); }
Quad sinh(Quad x) { return Quad::from(NOETHER_QUAD(sinh)(x.value)); }
Quad cosh(Quad x) { return Quad::from(NOETHER_QUAD(cosh)(x.value)); }
Quad asinh(Quad x) { return Quad::from(NOETHER_QUAD(asinh)(x.value)); }
Quad acosh(Quad x) { return Quad::from(NOETHER_QUAD(acosh)(x.value)); }
Quad exp(Quad x) { return Quad::from(NOETHER_QUAD(exp)(x.value)); }
Quad expm1(Quad x) { return Quad::from(NOETHER_QUAD(expm1)(x.value)); }
Quad log(Quad x) { return Quad::from(NOETHER_QUAD(log)(x.value)); }
Quad log1p(Quad x) { return Quad::from(NOETHER_QUAD(log1p)(x.value)); }
Quad pow(Quad x, Quad y) { return Quad::from(NOETHER_QUAD(pow)(x.value, y.value)); }
Quad floor(Quad x) { return Quad::from(NOETHER_QUAD(floor)(x.value)); }
Quad asin(Quad x) { return Quad::from(NOETHER_QUAD(asin)(x.value)); }
Quad atan(Quad x) { return Quad::from(NOETHER_QUAD(atan)(x.value)); }
Quad tanh(Quad x) { return Quad::from(NOETHER_QUAD(tanh)(x.value)); }
Quad atanh(Quad x) { return Quad::from(NOETHER_QUAD(atanh)(x.value)); }
Quad erf(Quad x) { return Quad::from(NOETHER_QUAD(erf)(x.value)); }
Quad erfc(Quad x) { return Quad::from(NOETHER_QUAD(erfc)(x.value)); }
Quad ceil(Quad x) { return Quad::from(NOETHER_QUAD(ceil)(x.value)); }
Quad hypot(Quad x, Quad y) { return Quad::from(NOETHER_QUAD(hypot)(x.value, y.value)); }
Quad fmod(Quad x, Quad y) { return Quad::from(NOETHER_QUAD(fmod)(x.value, y.value)); }
Quad round(Quad x) { return Quad::from(NOETHER_QUAD(round)(x.value)); }

std::string to_string(Quad x) {
  char text[64];
#if defined(__SIZEOF_FLOAT128__) && !(defined(__LDBL_MANT_DIG__) && __LDBL_MANT_DIG__ == 113)
  quadmath_snprintf(text, sizeof text, "%.35Qe", x.value);
#else
  std::snprintf(text, sizeof text, "%.35Le", x.value);
#endif
  return text;
}

Quad parse_quad(const std::string& text) {
  char* end = nullptr;
#if defined(__SIZEOF_FLOAT128__) && !(defined(__LDBL_MANT_DIG__) && __LDBL_MANT_DIG__ == 113)
  const Binary128 value = strtoflt128(text.c_str(), &end);
#else
  const Binary128 value = std::strtold(text.c_str(), &end);
#endif
  if (text.empty() || *end != '\0') throw std::invalid_argument("'" + text + "' is not a number");
  return Quad::from(value);
}

}  // namespace noether
