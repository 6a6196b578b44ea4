#include "integrators/wisdom_holman_simd.hpp"

#include "integrators/kepler_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

void prepare(const PlanetRows& planets) {
  for (std::ptrdiff_t k = 0; k < planets.rows; ++k) set_distance(load_eights(planets.row[k].x), planets.row[k]);
}

template <bool compensated> ArcReport drift_all(const PlanetRows& planets, const ArcTask& task) {
  ArcReport report;
  for (std::ptrdiff_t k = 0; k < planets.rows; ++k)
    advance_arcs<compensated>({task, planets.exact, 8 * k}, planets.row[k], report);
  return report;
}
ArcReport drift(const PlanetRows& planets, const ArcTask& task) {
  return planets.compensated ? drift_all<true>(planets, task) : drift_all<false>(planets, task);
}

/// Forces of pairs of two rows, or of one row with itself, and whether some are near.
struct PairSums {
  Eights force{0.0, 0.0, 0.0};  ///< on the first row
  Eights back{0.0, 0.0, 0.0};   ///< to be taken from those on the second
  Eight least = 0.0;            ///< below 0 where a pair is near
};

/// Constants of the pairs of two rows, or of one row with itself, that are kept.
struct KeptPairs {
  const PlanetPairs& pairs;

  template <int away> NOETHER_EIGHT_INLINE Eight attraction() const { return load_eight(pairs.attraction[away]); }
  template <int away> NOETHER_EIGHT_INLINE Eight near() const { return load_eight(pairs.near[away]); }
};
/// Those of the planets of one row and of one further out, to the bit; `near` is not less.
struct PairsOfRows {
  const PlanetRow &first, &second;

  template <int away> NOETHER_EIGHT_INLINE Eight attraction() const {
    return load_eight(first.attracts) * rotate<away>(load_eight(second.mass));
  }
  template <int away> NOETHER_EIGHT_INLINE Eight near() const {
    const Eight both = load_eight(first.reach) + rotate<away>(load_eight(second.reach));
    return both * both;
  }
};
/// Calls work(constants, first row, second row) for all pairs of different rows.
template <class Work> NOETHER_EIGHT_INLINE void for_rows(const PlanetRows& planets, const Work& work) {
  const PlanetPairs* pairs = planets.pairs;
  for (std::ptrdiff_t a = 0; a < planets.rows; ++a) {
    ++pairs;
    for (std::ptrdiff_t b = a + 1; b < planets.rows; ++b) {
      PlanetRow &first = planets.row[a], &second = planets.row[b];
      if (planets.of_own_alone) {
        work(PairsOfRows{first, second}, first, second);
      } else {
        work(KeptPairs{*pairs++}, first, second);
      }
    }
  }
}
/// Constants of a row with itself.
NOETHER_EIGHT_INLINE const PlanetPairs& own_pairs(const PlanetRows& planets, std::ptrdiff_t a) {
  return planets.pairs[planets.of_own_alone ? a : a * planets.rows - a * (a - 1) / 2];
}

/// G m_i m_j (x_j - x_i)/r^3 of planets i and j, which is `away` lanes further in its row.
template <int away, class Pairs>
NOETHER_EIGHT_INLINE void attract(const Pairs& pairs, const Eights& x, const Eight& from_star2, const Eights& others,
                                  PairSums& sums) {
  const Eights d = rotate<away>(others) - x;
  const Eight r2 = dot(d, d);
  const Eights f = (pairs.template attraction<away>() / (r2 * square_root(r2))) * d;
  sums.least = smaller(sums.least, r2 - pairs.template near<away>() * from_star2);
  sums.force = sums.force + f;
  sums.back = sums.back + rotate<-away>(f);
}
/// The same of planets i and i + 4 of one row, in half the registers where there are several.
NOETHER_EIGHT_INLINE void attract_opposite(const PlanetPairs& pairs, const Eights& x, const Eight& from_star2,
                                           PairSums& sums) {
  constexpr int half = eight_registers / 2;
  const Eight attraction = load_eight(pairs.attraction[4]), near = load_eight(pairs.near[4]);
  const Eights others = rotate<4>(x);
  for (int k = 0; k < (half > 0 ? half : 1); ++k) {
    const EightRegister dx = others.x.r[k] - x.x.r[k], dy = others.y.r[k] - x.y.r[k], dz = others.z.r[k] - x.z.r[k];
    const EightRegister r2 = (dx * dx + dy * dy) + dz * dz, q = attraction.r[k] / (r2 * root_of(r2));
    const EightRegister gap = r2 - near.r[k] * from_star2.r[k];
    sums.least.r[k] = sums.least.r[k] < gap ? sums.least.r[k] : gap;
    sums.force.x.r[k] += q * dx, sums.force.y.r[k] += q * dy, sums.force.z.r[k] += q * dz;
    if constexpr (half > 0) {  // the other one of each pair: the same number with the other sign
      const int m = k + half;
      sums.force.x.r[m] -= q * dx, sums.force.y.r[m] -= q * dy, sums.force.z.r[m] -= q * dz;
    }
  }
}
NOETHER_EIGHT_INLINE PairSums within_row(const PlanetPairs& pairs, const Eights& x, const Eight& from_star2) {
  PairSums sums;
  const KeptPairs kept{pairs};
  attract<1>(kept, x, from_star2, x, sums);
  attract<2>(kept, x, from_star2, x, sums);
  attract<3>(kept, x, from_star2, x, sums);
  attract_opposite(pairs, x, from_star2, sums);
  return sums;
}
template <class Pairs> [[gnu::noinline]] bool between_rows(const Pairs& pairs, PlanetRow& first, PlanetRow& second) {
  const Eights x = load_eights(first.y), others = load_eights(second.y);
  const Eight from_star2 = dot(x, x);
  PairSums sums;
  attract<0>(pairs, x, from_star2, others, sums);
  attract<1>(pairs, x, from_star2, others, sums);
  attract<2>(pairs, x, from_star2, others, sums);
  attract<3>(pairs, x, from_star2, others, sums);
  attract<4>(pairs, x, from_star2, others, sums);
  attract<5>(pairs, x, from_star2, others, sums);
  attract<6>(pairs, x, from_star2, others, sums);
  attract<7>(pairs, x, from_star2, others, sums);
  store_eights(load_eights(first.force) + sums.force, first.force);
  store_eights(load_eights(second.force) - sums.back, second.force);
  return exceeding(Eight(0.0), sums.least) != 0;
}
/// Attractions between planets of different rows; `y` and the forces so far stand in the rows.
NOETHER_EIGHT_INLINE bool between_all(const PlanetRows& planets) {
  bool near = false;
  for_rows(planets,
           [&](const auto& pairs, PlanetRow& first, PlanetRow& second) { near |= between_rows(pairs, first, second); });
  return near;
}

/// Vectors of a row relative to the star from those in Jacobi coordinates; `inside` is sum m_j/M_j x'_j of the rows
/// before, and then of this one too.
NOETHER_EIGHT_INLINE Eights relative_to_star(const PlanetRows& planets, std::ptrdiff_t a, const Eights& x,
                                             Eights& inside) {
  const PlanetRow& row = planets.row[a];
  const Eights moments = load_eight(row.share) * x;
  Eights inner{sums_upward(moments.x), sums_upward(moments.y), sums_upward(moments.z)};
  if (a > 0) inner = inner + inside;
  if (a + 1 < planets.rows) inside = {last_lane(inner.x), last_lane(inner.y), last_lane(inner.z)};
  return load_eight(row.rest) * x + inner;
}

/// Where a kick takes place: at x, or beside it.
template <bool beside> NOETHER_EIGHT_INLINE Eights place_of(const PlanetRow& row) {
  const Eights x = load_eights(row.x);
  if constexpr (beside) return x + load_eights(row.along);
  return x;
}

/// Jacobi coordinates: the forces there, into the rows. @return whether two planets are near
template <bool beside> NOETHER_EIGHT_INLINE bool forces_jacobi(const PlanetRows& planets) {
  unsigned near = 0;
  Eights inside{0.0, 0.0, 0.0};
  for (std::ptrdiff_t a = 0; a < planets.rows; ++a) {
    PlanetRow& row = planets.row[a];
    const Eights y = relative_to_star(planets, a, place_of<beside>(row), inside);
    store_eights(y, row.y);
    const Eight r2 = dot(y, y);
    const PairSums sums = within_row(own_pairs(planets, a), y, r2);
    near |= exceeding(Eight(0.0), sums.least);
    const Eight cube = r2 * square_root(r2);
    Eight pull;
    if (planets.relativity) {
      const Eight inverse = Eight(1.0) / cube;
      pull = inverse * (load_eight(row.star) + load_eight(row.relativity) * (inverse * r2));
    } else {
      pull = load_eight(row.star) / cube;
    }
    store_eights(sums.force - (sums.back + pull * y), row.force);
  }
  if (planets.rows > 1) near |= unsigned(between_all(planets));
  return near != 0;
}

/// Calls take(row, dv) with h times the accelerations by the forces in the rows, relative to what is further in: a_k =
/// f_k/m_k + sum_{j >= k} f_j/M_{k-1}, since the star is pulled by minus the sum of all; and with what the planets'
/// arcs have done already, arcs(row, mu h).
template <class Arcs, class Take>
NOETHER_EIGHT_INLINE void for_accelerations(const PlanetRows& planets, double h, const Arcs& arcs, const Take& take) {
  Eights outside{0.0, 0.0, 0.0};
  for (std::ptrdiff_t a = planets.rows - 1; a >= 0; --a) {
    PlanetRow& row = planets.row[a];
    const Eights f = load_eights(row.force);
    Eights outer{sums_downward(f.x), sums_downward(f.y), sums_downward(f.z)};
    if (a + 1 < planets.rows) outer = outer + outside;
    if (a > 0) outside = {first_lane(outer.x), first_lane(outer.y), first_lane(outer.z)};
    const Eight time = h;
    const Eights done = arcs(row, time * load_eight(row.without_arc));
    take(row, ((time * load_eight(row.one_over_m)) * f + done) + (time * load_eight(row.one_over_M)) * outer);
  }
}
/// mu h x/r^3 of the arcs.
template <bool beside> NOETHER_EIGHT_INLINE Eights arcs_done(const PlanetRow& row, const Eight& mu_h) {
  const Eights x = place_of<beside>(row);
  const Eight inverse = beside ? Eight(1.0) / square_root(dot(x, x)) : load_eight(row.r_inverse);
  return (mu_h * (inverse * (inverse * inverse))) * x;
}

template <bool compensated> NOETHER_EIGHT_INLINE void add_to_velocities(PlanetRow& row, const Eights& dv) {
  store_eights(add_change<compensated>(load_eights(row.v), dv, row.v_low), row.v);
}

template <bool compensated, bool beside> NOETHER_EIGHT_INLINE bool kick_jacobi(const PlanetRows& planets, double h) {
  const bool near = forces_jacobi<beside>(planets);
  for_accelerations(planets, h, arcs_done<beside>, add_to_velocities<compensated>);
  return near;
}

/// What moves all heliocentric positions in a jump over h, |sum p|^2/2 m_0.
NOETHER_EIGHT_INLINE Eights jump_of(const PlanetRows& planets, double h) {
  Eights sum{0.0, 0.0, 0.0};
  for (std::ptrdiff_t a = 0; a < planets.rows; ++a) {
    const Eights p = load_eight(planets.row[a].share) * load_eights(planets.row[a].v);
    const Eights total{sum_of_lanes(p.x), sum_of_lanes(p.y), sum_of_lanes(p.z)};
    sum = a == 0 ? total : sum + total;
  }
  return Eight(h) * sum;
}

/// Democratic coordinates: half a jump, the kick, half a jump. Without relativity the kick leaves the momentum alone,
/// so that both jumps are the same.
template <bool compensated>
NOETHER_EIGHT_INLINE bool kick_democratic(const PlanetRows& planets, double h, bool predicted) {
  unsigned near = 0;
  const Eights jump = jump_of(planets, 0.5 * h);
  for (std::ptrdiff_t a = 0; a < planets.rows; ++a) {
    PlanetRow& row = planets.row[a];
    const Eights y = load_eights(row.x) + load_eight(row.moves) * jump;
    store_eights(y, row.y);
    const Eight r2 = dot(y, y);
    const PairSums sums = within_row(own_pairs(planets, a), y, r2);
    near |= exceeding(Eight(0.0), sums.least);
    Eights f = sums.force - sums.back;
    if (planets.relativity) f = f - (load_eight(row.relativity) / (r2 * r2)) * y;
    store_eights(f, row.force);
  }
  if (planets.rows > 1) near |= unsigned(between_all(planets));
  for (std::ptrdiff_t a = 0; a < planets.rows; ++a) {
    PlanetRow& row = planets.row[a];
    const Eights dv = (Eight(h) * load_eight(row.one_over_m)) * load_eights(row.force);
    store_eights(add_change<compensated>(load_eights(row.v), dv, row.v_low), row.v);
  }
  const Eights second = planets.relativity ? jump_of(planets, 0.5 * h) : jump;
  for (std::ptrdiff_t a = 0; a < planets.rows; ++a) {
    PlanetRow& row = planets.row[a];
    const Eights dx = load_eight(row.moves) * (jump + second);
    const Eights x = add_change<compensated>(load_eights(row.x), dx, row.x_low);
    store_eights(x, row.x);
    const Eight before = load_eight(row.r), inverse = set_distance(x, row);
    if (predicted) store_eight((before * load_eight(row.s)) * inverse, row.s);
  }
  return near != 0;
}

bool kick(const PlanetRows& planets, double h, bool predicted) {
  if (planets.jacobi) {
    return planets.compensated ? kick_jacobi<true, false>(planets, h) : kick_jacobi<false, false>(planets, h);
  }
  return planets.compensated ? kick_democratic<true>(planets, h, predicted)
                             : kick_democratic<false>(planets, h, predicted);
}

bool accelerate(const PlanetRows& planets, double h, bool known) {
  const bool near = !known && forces_jacobi<false>(planets);
  for_accelerations(planets, h, arcs_done<false>, [](PlanetRow& row, const Eights& a) { store_eights(a, row.along); });
  return near;
}

void kick_beside(const PlanetRows& planets, double h) {
  if (planets.compensated) {
    kick_jacobi<true, true>(planets, h);
  } else {
    kick_jacobi<false, true>(planets, h);
  }
}

/// (u . grad) of d/r^n.
template <int n> NOETHER_EIGHT_INLINE Eights change_of_ray(const Eights& d, const Eights& u, const Eight& r2) {
  return u - ((Eight(double(n)) * dot(d, u)) / r2) * d;
}

/// How the attraction of planets i and j, which is `away` lanes further in its row, changes along a direction.
template <int away, class Pairs>
NOETHER_EIGHT_INLINE void change_of_pair(const Pairs& pairs, const PlanetRow& first, const PlanetRow& second,
                                         PairSums& sums) {
  const Eights d = rotate<away>(load_eights(second.y)) - load_eights(first.y);
  const Eights u = rotate<away>(load_eights(second.y_along)) - load_eights(first.y_along);
  const Eight r2 = dot(d, d);
  const Eights f = (pairs.template attraction<away>() / (r2 * square_root(r2))) * change_of_ray<3>(d, u, r2);
  sums.force = sums.force + f;
  sums.back = sums.back + rotate<-away>(f);
}
NOETHER_EIGHT_INLINE Eights changes_within_row(const PlanetPairs& pairs, const PlanetRow& row) {
  PairSums sums, opposite;
  const KeptPairs kept{pairs};
  change_of_pair<1>(kept, row, row, sums);
  change_of_pair<2>(kept, row, row, sums);
  change_of_pair<3>(kept, row, row, sums);
  change_of_pair<4>(kept, row, row, opposite);  // each pair twice
  return (sums.force + opposite.force) - sums.back;
}
template <class Pairs>
[[gnu::noinline]] void changes_between_rows(const Pairs& pairs, PlanetRow& first, PlanetRow& second) {
  PairSums sums;
  change_of_pair<0>(pairs, first, second, sums);
  change_of_pair<1>(pairs, first, second, sums);
  change_of_pair<2>(pairs, first, second, sums);
  change_of_pair<3>(pairs, first, second, sums);
  change_of_pair<4>(pairs, first, second, sums);
  change_of_pair<5>(pairs, first, second, sums);
  change_of_pair<6>(pairs, first, second, sums);
  change_of_pair<7>(pairs, first, second, sums);
  store_eights(load_eights(first.force) + sums.force, first.force);
  store_eights(load_eights(second.force) - sums.back, second.force);
}

/// The forces in the rows become their changes along the direction.
NOETHER_EIGHT_INLINE void force_changes(const PlanetRows& planets) {
  Eights inside{0.0, 0.0, 0.0};
  for (std::ptrdiff_t a = 0; a < planets.rows; ++a) {
    PlanetRow& row = planets.row[a];
    store_eights(relative_to_star(planets, a, load_eights(row.along), inside), row.y_along);
  }
  for (std::ptrdiff_t a = 0; a < planets.rows; ++a) {
    PlanetRow& row = planets.row[a];
    const Eights y = load_eights(row.y), u = load_eights(row.y_along);
    const Eight r2 = dot(y, y);
    Eights f = changes_within_row(own_pairs(planets, a), row) -
               (load_eight(row.star) / (r2 * square_root(r2))) * change_of_ray<3>(y, u, r2);
    if (planets.relativity) f = f - (load_eight(row.relativity) / (r2 * r2)) * change_of_ray<4>(y, u, r2);
    store_eights(f, row.force);
  }
  for_rows(planets,
           [](const auto& pairs, PlanetRow& first, PlanetRow& second) { changes_between_rows(pairs, first, second); });
}

template <bool compensated> void kick_by_gradient_of(const PlanetRows& planets, double h) {
  force_changes(planets);
  const auto arcs = [](const PlanetRow& row, const Eight& mu_h) {
    const Eights x = load_eights(row.x), u = load_eights(row.along);
    const Eight inverse = load_eight(row.r_inverse);
    return (mu_h * (inverse * (inverse * inverse))) * change_of_ray<3>(x, u, dot(x, x));
  };
  for_accelerations(planets, h, arcs, add_to_velocities<compensated>);
}
void kick_by_gradient(const PlanetRows& planets, double h) {
  if (planets.compensated) {
    kick_by_gradient_of<true>(planets, h);
  } else {
    kick_by_gradient_of<false>(planets, h);
  }
}

}  // namespace

extern const PlanetKernels planet_kernels;
const PlanetKernels planet_kernels{prepare, drift, kick, accelerate, kick_beside, kick_by_gradient};

}  // namespace noether::NOETHER_SIMD_LEVEL
