#include "integrators/methods/encke_simd.hpp"

#include "integrators/kepler_tangent_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

constexpr std::ptrdiff_t stages = 8;

NOETHER_EIGHT_INLINE double largest_lane(const Eight& a) {
  const Eight four = larger(a, rotate<4>(a)), two = larger(four, rotate<2>(four));
  return larger(two, rotate<1>(two)).r[0][0];
}
NOETHER_EIGHT_INLINE Eight dot(const double* a, const Eights& b) {
  return Eight(a[0]) * b.x + Eight(a[1]) * b.y + Eight(a[2]) * b.z;
}
NOETHER_EIGHT_INLINE Eights same(const double* a) { return {a[0], a[1], a[2]}; }
NOETHER_EIGHT_INLINE Eight norm2(const Eights& a) { return dot(a, a); }

NOETHER_EIGHT_INLINE EightStarts start_of(const EnckeBody& body) {
  const double *x = body.x0, *v = body.v0;
  const double r = __builtin_sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
  const double eta = x[0] * v[0] + x[1] * v[1] + x[2] * v[2], v2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  return {body.mu, r, 1 / r, eta, r * v2 - body.mu, 2 * body.mu / r - v2};
}

/// c_n(z) for |z| up to 4, as a first look at an arc asks for: right to 1e-11.
template <int n> NOETHER_EIGHT_INLINE Eight rough_series(const Eight& z, const Eight& z2) {
  constexpr auto over_factorial = [](int k) {
    double f = k % 2 == 0 ? 1 : -1;
    for (int j = 2; j <= 2 * k + n; ++j) f *= j;
    return 1 / f;
  };
  const auto pair = [&](int k) { return Eight(over_factorial(k)) + Eight(over_factorial(k + 1)) * z; };
  return pair(0) + z2 * (pair(2) + z2 * (pair(4) + z2 * (pair(6) + z2 * Eight(over_factorial(8)))));
}

/// A universal variable within some 1e-10 of the arc's, its lower half of digits cut off: the last step is then many
/// roundings long and of either sign. A fraction of one would be rounded off, always to the same side.
NOETHER_EIGHT_INLINE Eight first_look(const EightStarts& a, const Eight& t) {
  const Eight s = reversion(t, a.r_inverse, a.eta, a.zeta, a.beta), s2 = s * s, z = a.beta * s2, z2 = z * z;
  const Eight g2 = s2 * rough_series<2>(z, z2), g3 = (s2 * s) * rough_series<3>(z, z2);
  const Eight g1 = s - a.beta * g3, g0 = Eight(1.0) - a.beta * g2, r = a.r + (a.eta * g1 + a.zeta * g2);
  const Eight missing = (t - a.r * s) - (a.eta * g2 + a.zeta * g3);
  const Eight next = s + reversion(missing, Eight(1.0) / r, a.eta * g0 + a.zeta * g1, a.mu - a.beta * r, a.beta);
  const Eight wide = Eight(0x1p27 + 1) * next;
  return wide - (wide - next);
}

/// Universal functions and their variable at the stages, from where the first look has led.
NOETHER_EIGHT_INLINE void put_functions(EnckeBody& body, const EightWords& tau) {
  const EightStarts a = start_of(body);
  const Eight t = load_eight(tau[0]), cut = load_eight(body.arc);
  EightSixFunctions g(a.beta, cut);
  const Eight missing = ((t - a.r * cut) - (a.eta * g.g2 + a.zeta * g.g3)) + load_eight(tau[1]);
  const Eight eta = a.eta * g.g0 + a.zeta * g.g1, over = Eight(1.0) / (a.r + (a.eta * g.g1 + a.zeta * g.g2));
  const Eight first = missing * over, d = first - Eight(0.5) * eta * over * first * first;
  g.shift(a.beta, d);
  const Eight s = cut + d;
  store_eight(s, body.arc);
  const Eight* const all[] = {&g.g0, &g.g1, &g.g2, &g.g3, &g.g4, &g.g5};
  for (int k = 0; k < 6; ++k) store_eight(*all[k], body.functions[k]);
  // What a shift leaves is of the order d^3, and beyond |beta s^2| = 4 the series is not good.
  body.missed = exceeding(absolute(a.beta * s * s), Eight(4.0)) | exceeding(absolute(d), Eight(0x1p-23) * absolute(s));
}

NOETHER_EIGHT_INLINE void put_orbit(EnckeBody& body, const EightWords& tau) {
  const EightStarts a = start_of(body);
  const Eight t = load_eight(tau[0]), s = load_eight(body.arc);
  const auto function = [&](int k) { return load_eight(body.functions[k]); };
  const EightSixFunctions g{function(0), function(1), function(2), function(3), function(4), function(5)};
  const EightTangents tangents(a, g, s, t);
  const EightHalf upper = tangents.upper();
  const Eight* const rows[] = {&upper.f,   &upper.g,   &upper.f_x,   &upper.f_eta,
                               &upper.f_v, &upper.g_x, &upper.g_eta, &upper.g_v};
  for (int k = 0; k < 8; ++k) store_eight(*rows[k], body.upper[k]);
  const Eights x0 = same(body.x0), place = x0 + (tangents.bend * x0 + upper.g * same(body.v0));
  store_eights(place, body.orbit);
  const Eight r2 = norm2(place), inverse = Eight(1.0) / r2;
  store_eight(inverse, body.inverse_r2);
  store_eight(a.mu * inverse * square_root(inverse), body.mu_r3);
  const int last = stages - 1;
  alignas(64) double r[stages];
  store_eight(tangents.r, r);
  body.last_s = body.arc[last], body.last_r = r[last];
  body.last_eta = a.eta.r[0][0] * body.functions[0][last] + a.zeta.r[0][0] * body.functions[1][last];
}

/// Each part is a long chain of operations for a body: those of neighbours overlap where no part is too long.
void orbits(EnckeBody* bodies, std::ptrdiff_t n, const EightWords& tau) {
  const Eight t = load_eight(tau[0]);
  for (std::ptrdiff_t m = 0; m < n; ++m) store_eight(first_look(start_of(bodies[m]), t), bodies[m].arc);
  for (std::ptrdiff_t m = 0; m < n; ++m) put_functions(bodies[m], tau);
  for (std::ptrdiff_t m = 0; m < n; ++m) put_orbit(bodies[m], tau);
}

/// sum_j a_ji of the rates of one coordinate.
NOETHER_EIGHT_INLINE Eight sum_over_stages(const double* a, const double* rates) {
  Eight even = load_eight(a) * Eight(rates[0]), odd = load_eight(a + stages) * Eight(rates[1]);
  for (std::ptrdiff_t j = 2; j < stages; j += 2) {
    even = even + load_eight(a + stages * j) * Eight(rates[j]);
    odd = odd + load_eight(a + stages * (j + 1)) * Eight(rates[j + 1]);
  }
  return even + odd;
}
NOETHER_EIGHT_INLINE Eights sums_over_stages(const double* a, const double (*rates)[stages]) {
  return {sum_over_stages(a, rates[0]), sum_over_stages(a, rates[1]), sum_over_stages(a, rates[2])};
}

void depart(EnckeBody* bodies, std::ptrdiff_t n, const double* a, double h) {
  for (std::ptrdiff_t m = 0; m < n; ++m) {
    EnckeBody& body = bodies[m];
    const Eights x = sums_over_stages(a, body.rate), v = sums_over_stages(a, body.rate + 3);
    const auto upper = [&](int k) { return load_eight(body.upper[k]); };
    const Eight xx = dot(body.x0, x), mixed = dot(body.v0, x) + dot(body.x0, v), vv = dot(body.v0, v);
    const Eight of_f = upper(2) * xx + upper(3) * mixed + upper(4) * vv;
    const Eight of_g = upper(5) * xx + upper(6) * mixed + upper(7) * vv;
    const Eights d = Eight(h) * ((upper(0) * x + upper(1) * v) + (of_f * same(body.x0) + of_g * same(body.v0)));
    store_eights(d, body.away);
    const Eights place = load_eights(body.orbit) + d;
    store_eights(place, body.place);
    const Eight r2 = norm2(place), cube = Eight(1.0) / (r2 * square_root(r2));
    store_eights((Eight(body.gm) * cube) * place, body.pull);
    store_eights((Eight(-body.mu_low) * cube) * place, body.fresh);
  }
}

/// What the attraction by the heaviest body has beyond the tangent of the orbit: (1 + e)^(-3/2) - 1 with
/// e = |k + d|^2 / |k|^2 - 1, without cancellation.
NOETHER_EIGHT_INLINE void begin_perturbation(EnckeBody& body) {
  const Eights orbit = load_eights(body.orbit), away = load_eights(body.away);
  const Eight inverse = load_eight(body.inverse_r2), pull = load_eight(body.mu_r3), along = dot(orbit, away) * inverse;
  const Eight e = Eight(2.0) * along + norm2(away) * inverse, up = Eight(1.0) + e, whole = up * square_root(up);
  const Eight steep = e * (Eight(3.0) + e * (Eight(3.0) + e)) / (whole * (Eight(1.0) + whole));
  const Eight beyond = steep - Eight(3.0) * along;
  store_eights(((pull * beyond) * orbit + (pull * steep) * away) + load_eights(body.fresh), body.fresh);
}

double attract(EnckeBody* bodies, std::ptrdiff_t n) {
  Eight most(0.0);
  for (std::ptrdiff_t m = 0; m < n; ++m) begin_perturbation(bodies[m]);
  for (std::ptrdiff_t m = 1; m < n; ++m) {
    EnckeBody& one = bodies[m];
    const Eights place = load_eights(one.place), pull = load_eights(one.pull);
    Eights fresh = load_eights(one.fresh);
    for (std::ptrdiff_t o = 0; o < m; ++o) {
      EnckeBody& other = bodies[o];
      if (one.gm == 0 && other.gm == 0) continue;
      const Eights d = load_eights(other.place) - place;
      const Eight r2 = norm2(d), inverse = Eight(1.0) / (r2 * square_root(r2));
      const Eight by_other = Eight(other.gm) * inverse, by_one = Eight(one.gm) * inverse;
      most = larger(by_other + by_one, most);
      fresh = fresh + (by_other * d - load_eights(other.pull));
      store_eights(load_eights(other.fresh) - (by_one * d + pull), other.fresh);
    }
    store_eights(fresh, one.fresh);
  }
  return largest_lane(most);
}

/// Perturbations to be at hand, and the rates that follow.
NOETHER_EIGHT_INLINE void put_perturbation(EnckeBody& body, const Eights& p) {
  store_eights(p, body.perturbation);
  const auto upper = [&](int k) { return load_eight(body.upper[k]); };
  const Eight ax = dot(body.x0, p), av = dot(body.v0, p), across = upper(3) * ax + upper(6) * av;
  const Eight along_x = upper(2) * ax + upper(5) * av, along_v = upper(4) * ax + upper(7) * av;
  const Eights x0 = same(body.x0), v0 = same(body.v0), none{0.0, 0.0, 0.0};
  store_eights(none - (upper(1) * p + (across * x0 + along_v * v0)), body.rate);
  store_eights(upper(0) * p + (along_x * x0 + across * v0), body.rate + 3);
}

void predict(EnckeBody* bodies, std::ptrdiff_t n, const double* w) {
  for (std::ptrdiff_t m = 0; m < n; ++m) put_perturbation(bodies[m], sums_over_stages(w, bodies[m].perturbation));
}

EnckeChange take(EnckeBody* bodies, std::ptrdiff_t n, bool first) {
  Eight relative2(0.0), moves2(0.0), all(0.0);
  for (std::ptrdiff_t m = 0; m < n; ++m) {
    EnckeBody& body = bodies[m];
    const Eights p = load_eights(body.fresh), old = load_eights(body.perturbation);
    const Eight change2 = norm2(p - old);
    if (first) {
      const double size2 = largest_lane(larger(norm2(p), norm2(old)));
      body.inverse_size2 = size2 > 0 ? 1 / size2 : 0;
    }
    all = all + change2;
    relative2 = larger(change2 * Eight(body.inverse_size2), relative2);
    moves2 = larger(change2 * load_eight(body.inverse_r2), moves2);
    put_perturbation(body, p);
  }
  constexpr double most = __DBL_MAX__;
  if (exceeding(all, Eight(most)) != 0) return {__builtin_inf(), __builtin_inf()};
  return {largest_lane(relative2), largest_lane(moves2)};
}

}  // namespace

extern const EnckeKernels encke_kernels;
const EnckeKernels encke_kernels{orbits, depart, attract, predict, take};

}  // namespace noether::NOETHER_SIMD_LEVEL
