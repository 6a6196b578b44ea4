#include "integrators/free_rotor_simd.hpp"

#include "numbers/eight_sine_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

/// Eight bodies on their way; axes are numbered as they turn, not as they are in the body.
struct Turning {
  Eight w, q[3];     ///< quaternions
  Eight in_body[3];  ///< angular momenta
};

/// The angular momenta in the bodies.
NOETHER_EIGHT_INLINE void spin_in_body(const Eight (&q)[4], const Eights& spin, Eight (&to)[3]) {
  const EightRotations r = rotations(q[0], q[1], q[2], q[3]);
  to[0] = dot({r.row[0].x, r.row[1].x, r.row[2].x}, spin);
  to[1] = dot({r.row[0].y, r.row[1].y, r.row[2].y}, spin);
  to[2] = dot({r.row[0].z, r.row[1].z, r.row[2].z}, spin);
}

/// Turns them about axis `k` by twice the angle `half`.
/// @param sense  1; -1 where the axes in the order in which they turn are left-handed
template <int k> NOETHER_EIGHT_INLINE void turn_about(Turning& t, const Eight& half, const Eight& sense) {
  constexpr int i = (k + 1) % 3, j = (k + 2) % 3;
  const auto [s, c] = sine_cosine(half);
  const Eight across = sense * s;
  const Eight w = t.w, qk = t.q[k], qi = t.q[i], qj = t.q[j];
  t.w = w * c - qk * s;
  t.q[k] = qk * c + w * s;
  t.q[i] = qi * c + qj * across;
  t.q[j] = qj * c - qi * across;
  const Eight cosine = (c - s) * (c + s), sine = sense * (Eight(2) * c * s), first = t.in_body[i];
  t.in_body[i] = cosine * first + sine * t.in_body[j];
  t.in_body[j] = cosine * t.in_body[j] - sine * first;
}

std::ptrdiff_t by_axes(const TurningColumns& bodies, double h, const int* order, std::ptrdiff_t from,
                       std::ptrdiff_t to) {
  const Eight none(0), quarter(0.78539816339744828), step(h);
  const Eight sense((order[1] - order[0] + 3) % 3 == 1 ? 1 : -1);
  for (std::ptrdiff_t at = from; at < to; at += 8) {
    Eight q[4], in_body[3];
    for (int k = 0; k < 4; ++k) q[k] = load_eight(bodies.orientation[k] + at);
    spin_in_body(q, {load_eight(bodies.spin[0] + at), load_eight(bodies.spin[1] + at), load_eight(bodies.spin[2] + at)},
                 in_body);
    Turning t;
    Eight per_spin[3], freedoms = none;
    t.w = q[0];
    for (int k = 0; k < 3; ++k) {
      t.q[k] = q[1 + order[k]];
      t.in_body[k] = in_body[order[k]];
      const Eight moment = load_eight(bodies.inertia[order[k]] + at);
      per_spin[k] = where_positive(moment, step / (Eight(2) * moment), none);
      freedoms = freedoms + moment;
    }
    Eight action = none, widest = none;
    const auto about = [&]<int k>(bool whole) __attribute__((always_inline)) {
      const Eight along = t.in_body[k], half = along * (whole ? per_spin[k] : per_spin[k] / Eight(2));
      action = action + along * half;
      widest = larger(widest, absolute(half));
      turn_about<k>(t, half, sense);
    };
    about.template operator()<0>(false);
    about.template operator()<1>(false);
    about.template operator()<2>(true);
    about.template operator()<1>(false);
    about.template operator()<0>(false);
    if (exceeding(widest, quarter) != 0) return at;
    Eight turned[4];
    turned[0] = t.w;
    for (int k = 0; k < 3; ++k) turned[1 + order[k]] = t.q[k];
    const Eight length2 = turned[0] * turned[0] + turned[1] * turned[1] + turned[2] * turned[2] + turned[3] * turned[3];
    const Eight factor = Eight(1) - (length2 - Eight(1)) / Eight(2);
    for (int k = 0; k < 4; ++k)
      store_eight(where_positive(freedoms, turned[k] * factor, q[k]), bodies.orientation[k] + at);
    store_eight(action, bodies.action + at);
  }
  return to;
}

}  // namespace

extern const FreeRotorKernels free_rotor_kernels;
const FreeRotorKernels free_rotor_kernels{by_axes};

}  // namespace noether::NOETHER_SIMD_LEVEL
