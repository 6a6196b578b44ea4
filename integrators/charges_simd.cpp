#include "integrators/charges_simd.hpp"

#include "numbers/eight_sine_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

/// a where a number is 0, else b.
NOETHER_EIGHT_INLINE Eight where_zero(const Eight& number, const Eight& a, const Eight& b) {
  return eight_of([&](int k) { return number.r[k] == EightRegister{} ? a.r[k] : b.r[k]; });
}
/// a where a number is 0 or above, else b.
NOETHER_EIGHT_INLINE Eight where_not_negative(const Eight& number, const Eight& a, const Eight& b) {
  return eight_of([&](int k) { return number.r[k] >= EightRegister{} ? a.r[k] : b.r[k]; });
}
NOETHER_EIGHT_INLINE Eights over(const Eights& a, const Eight& b) { return {a.x / b, a.y / b, a.z / b}; }
NOETHER_EIGHT_INLINE Eights cross(const Eights& a, const Eights& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Eight charges: a number of each in a line. Where there is none, the last one stands again.
struct alignas(64) ChargeRow {
  double x[3][8], v[3][8];
  double charge[8], mass[8];
  double per_mass[8];          ///< q/m
  double feels[8];             ///< 1 where fields act, 0 where there is no charge or no mass
  double a[3][8], rate[3][8];  ///< what the uniform fields do that come before all others
  double all_feel;             ///< whether `feels` is 1 everywhere
};

/// What fields do: F/m of the electric ones, and q B/m.
struct Pulls {
  Eights a, rate;
};

/// Adds what a field does, as `InField` and its sink do.
struct FieldSum {
  const ChargeRow& row;
  Pulls sum;

  NOETHER_EIGHT_INLINE Eights felt(const Eights& what) const {
    if (row.all_feel != 0) return what;
    const Eight feels = load_eight(row.feels), none = 0.0;
    return {where_zero(feels, none, what.x), where_zero(feels, none, what.y), where_zero(feels, none, what.z)};
  }
  NOETHER_EIGHT_INLINE void electric(const Eights& E) {
    sum.a = sum.a + felt(over(load_eight(row.charge) * E, load_eight(row.mass)));
  }
  NOETHER_EIGHT_INLINE void magnetic(const Eights& B) { sum.rate = sum.rate + felt(load_eight(row.per_mass) * B); }
};

/// The fields of forces/electromagnetic_fields.hpp, operation by operation.
NOETHER_EIGHT_INLINE void add_field(const LaneFieldNumbers& of, const Eights& x, FieldSum& out) {
  const double* n = of.number;
  const Eight zero = 0.0;
  switch (of.field) {
    case LaneField::uniform:
      out.electric({n[0], n[1], n[2]});
      out.magnetic({n[3], n[4], n[5]});
      return;
    case LaneField::gradient:
      out.magnetic({zero, zero, Eight(n[0]) + Eight(n[1]) * x.x});
      return;
    case LaneField::dipole: {
      const Eights M{n[0], n[1], n[2]};
      const Eight r2 = dot(x, x), r3 = r2 * square_root(r2);
      out.magnetic(over((Eight(3.0) * dot(M, x)) * x - r2 * M, r2 * r3));
      return;
    }
    case LaneField::tokamak: {
      const Eight R2 = x.x * x.x + x.y * x.y, R = square_root(R2);
      const Eight toroidal = Eight(n[0] * n[1]) / R2, poloidal = Eight(n[0]) / (Eight(n[2]) * R);
      out.magnetic({Eight(-1.0) * toroidal * x.y - poloidal * x.z * x.x / R, toroidal * x.x - poloidal * x.z * x.y / R,
                    poloidal * (R - Eight(n[1]))});
      return;
    }
    case LaneField::penning:
      out.electric({Eight(n[1]) * x.x, Eight(n[1]) * x.y, Eight(-2 * n[1]) * x.z});
      out.magnetic({zero, zero, n[0]});
      return;
  }
}

NOETHER_EIGHT_INLINE Pulls pulls(const ChargeTask& task, const ChargeRow& row, const Eights& x) {
  FieldSum out{row, {load_eights(row.a), load_eights(row.rate)}};
  for (std::ptrdiff_t k = task.uniform_count; k < task.field_count; ++k) add_field(task.fields[k], x, out);
  return out.sum;
}

[[gnu::noinline, gnu::cold]] EightTurns turns_of_any(const ChargeTask& task, const Eight& angle) {
  alignas(64) double of[8], sine[8], cosine[8];
  store_eight(angle, of);
  task.turn(of, sine, cosine);
  return {load_eight(sine), load_eight(cosine)};
}

/// What follows has the operations of integrators/gyration.hpp one by one.
struct Turn {
  Eight sine, versine;
};
NOETHER_EIGHT_INLINE Turn exact_turn(const ChargeTask& task, double h, const Eight& rate2) {
  const Eight rate = square_root(where_zero(rate2, 1.0, rate2)), angle = Eight(h) * rate / Eight(2.0);
  const bool small = exceeding(absolute(angle), 0.78539816339744828) == 0;
  const EightTurns by = __builtin_expect(small, 1) ? sine_cosine(angle) : turns_of_any(task, angle);
  const Eight part = Eight(2.0) * by.sine / rate;
  return {where_zero(rate2, h, part * by.cosine), where_zero(rate2, h * h / 2, part * by.sine / rate)};
}
NOETHER_EIGHT_INLINE Turn turn_in_cycles(const ChargeTask& task, double h, const Eight& rate2) {
  const double half = h / (2 * static_cast<double>(task.cycles));
  Eight series = task.tangent[task.terms - 1];
  if (task.terms > 1) {
    const Eight x2 = Eight(half * half) * rate2;
    for (std::int64_t k = task.terms - 1; k-- > 0;) series = series * x2 + Eight(task.tangent[k]);
  }
  const Eight t = Eight(half) * series, part = Eight(2.0) * t / (Eight(1.0) + t * t * rate2);
  const Turn one{part, t * part};
  Turn all = one;
  for (std::int64_t cycle = 1; cycle < task.cycles; ++cycle) {
    const Eight versine = all.versine + one.versine * (Eight(1.0) - rate2 * all.versine) + all.sine * one.sine;
    all.sine = all.sine + (one.sine - rate2 * (all.sine * one.versine + one.sine * all.versine));
    all.versine = versine;
  }
  return all;
}
NOETHER_EIGHT_INLINE Eights turned(const ChargeTask& task, const Eights& v, const Pulls& by, double h) {
  const Eights &a = by.a, &rate = by.rate;
  const Eight rate2 = dot(rate, rate);
  const Turn turn = task.push == LanePush::exact ? exact_turn(task, h, rate2) : turn_in_cycles(task, h, rate2);
  const Eights across = cross(v, rate), pulled = cross(a, rate);
  const Eight lag = where_zero(rate2, 0.0, (Eight(h) - turn.sine) / where_zero(rate2, 1.0, rate2));
  return turn.sine * across + turn.versine * (cross(across, rate) + pulled) + lag * cross(pulled, rate) + Eight(h) * a;
}

NOETHER_EIGHT_INLINE Eights full_turn_about(const Eights& u, const Eights& t) {
  const Eights across = cross(u, t);
  return (Eight(2.0) / (Eight(1.0) + dot(t, t))) * (across + cross(across, t));
}
NOETHER_EIGHT_INLINE Eight gamma_between(const Eights& u, const Eights& tau, double c) {
  const Eight tau2 = dot(tau, tau), along = dot(u, tau) / Eight(c);
  const Eight sigma = Eight(1.0) + dot(u, u) / Eight(c * c) - tau2, rest = tau2 + along * along;
  const Eight root = square_root(sigma * sigma + Eight(4.0) * rest);
  const Eight direct = (sigma + root) / Eight(2.0),
              other = Eight(2.0) * rest / where_not_negative(sigma, 1.0, root - sigma);
  return square_root(where_not_negative(sigma, direct, other));
}
NOETHER_EIGHT_INLINE Eights pushed_fast(const ChargeTask& task, const Eights& u, const Pulls& by, double h) {
  const double c2 = task.c * task.c;
  const Eights half = Eight(h / 2) * by.a, before = u + half, tau = Eight(h / 2) * by.rate;
  if (task.push == LanePush::relativistic_boris) {
    const Eight length = Eight(h) / (Eight(2.0) * square_root(Eight(1.0) + dot(before, before) / Eight(c2)));
    return (half + half) + full_turn_about(before, length * by.rate);
  }
  if (task.push == LanePush::higuera_cary)
    return (half + half) + full_turn_about(before, over(tau, gamma_between(before, tau, task.c)));
  const Eight gamma = square_root(Eight(1.0) + dot(u, u) / Eight(c2));
  const Eights ahead = u + Eight(h) * by.a + over(cross(u, tau), gamma);
  const Eights t = over(tau, gamma_between(ahead, tau, task.c));
  return over(ahead + dot(ahead, t) * t + cross(ahead, t), Eight(1.0) + dot(t, t)) - u;
}

/// @tparam relativistic  v is gamma times the velocity
template <bool relativistic> NOETHER_EIGHT_INLINE void drift(const ChargeTask& task, double h, Eights& x, Eights& v) {
  if constexpr (relativistic) {
    const Eight length = Eight(h) / square_root(Eight(1.0) + dot(v, v) / Eight(task.c * task.c)), zero = 0.0;
    x = x + length * v;
    v = v + Eights{zero, zero, zero};  // as the shift of positions does, to the sign of a zero
  } else {
    x = x + Eight(h) * v;
  }
}

template <bool relativistic> void follow_all(const ChargeTask& task, ChargeRow* rows, std::ptrdiff_t count) {
  for (std::ptrdiff_t n = 0; n < task.count; ++n) {
    // A drift and the kick behind it in one go.
    const ChargeLetter& first = task.letters[n];
    const bool drifts = first.letter == 'A';
    const bool kicks = !drifts || (n + 1 < task.count && task.letters[n + 1].letter == 'B');
    const double kick = kicks ? task.letters[drifts ? n + 1 : n].h : 0;
    if (drifts && kicks) ++n;
    for (std::ptrdiff_t k = 0; k < count; ++k) {
      ChargeRow& row = rows[k];
      Eights x = load_eights(row.x), v = load_eights(row.v);
      if (drifts) drift<relativistic>(task, first.h, x, v);
      if (drifts) store_eights(x, row.x);
      if (kicks) {
        const Pulls by = pulls(task, row, x);
        v = v + (relativistic ? pushed_fast(task, v, by, kick) : turned(task, v, by, kick));
      }
      store_eights(v, row.v);
    }
  }
}

/// Registers as they lie in a column; a row with places too many goes charge by charge.
NOETHER_EIGHT_INLINE void load_line(const double* from, std::ptrdiff_t charges, double* to) {
  if (charges >= 8) {
    for (int k = 0; k < eight_registers; ++k) {
      EightRegister one;
      __builtin_memcpy(&one, from + eight_width * k, sizeof one);
      *reinterpret_cast<EightRegister*>(to + eight_width * k) = one;
    }
  } else {
    for (std::ptrdiff_t lane = 0; lane < 8; ++lane) to[lane] = from[lane < charges ? lane : charges - 1];
  }
}
NOETHER_EIGHT_INLINE void store_line(const double* from, std::ptrdiff_t charges, double* to) {
  if (charges >= 8) {
    for (int k = 0; k < eight_registers; ++k) {
      const EightRegister one = *reinterpret_cast<const EightRegister*>(from + eight_width * k);
      __builtin_memcpy(to + eight_width * k, &one, sizeof one);
    }
  } else {
    for (std::ptrdiff_t lane = 0; lane < charges; ++lane) to[lane] = from[lane];
  }
}

void load_row(const ChargeTask& task, std::ptrdiff_t first, std::ptrdiff_t charges, ChargeRow& row) {
  for (int k = 0; k < 3; ++k) {
    load_line(task.x[k] + first, charges, row.x[k]);
    load_line(task.v[k] + first, charges, row.v[k]);
  }
  load_line(task.charge + first, charges, row.charge);
  load_line(task.mass + first, charges, row.mass);
  const Eight charge = load_eight(row.charge), mass = load_eight(row.mass);
  const Eight feels = where_zero(charge, 0.0, where_zero(mass, 0.0, 1.0));
  store_eight(feels, row.feels);
  store_eight(charge / mass, row.per_mass);
  row.all_feel = exceeding(1.0, feels) == 0 ? 1 : 0;
  FieldSum out{row, {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}};
  for (std::ptrdiff_t n = 0; n < task.uniform_count; ++n) add_field(task.fields[n], load_eights(row.x), out);
  store_eights(out.sum.a, row.a);
  store_eights(out.sum.rate, row.rate);
}

void follow(const ChargeTask& task, std::ptrdiff_t begin, std::ptrdiff_t end) {
  ChargeRow rows[ChargeKernels::most / 8];
  std::ptrdiff_t count = 0;
  for (std::ptrdiff_t first = begin; first < end; first += 8) load_row(task, first, end - first, rows[count++]);
  const bool slow = task.push == LanePush::exact || task.push == LanePush::cycles;
  slow ? follow_all<false>(task, rows, count) : follow_all<true>(task, rows, count);
  for (std::ptrdiff_t k = 0; k < count; ++k) {
    const std::ptrdiff_t first = begin + 8 * k;
    for (int axis = 0; axis < 3; ++axis) {
      store_line(rows[k].x[axis], end - first, task.x[axis] + first);
      store_line(rows[k].v[axis], end - first, task.v[axis] + first);
    }
  }
}

}  // namespace

extern const ChargeKernels charge_kernels;
const ChargeKernels charge_kernels{follow};

}  // namespace noether::NOETHER_SIMD_LEVEL
