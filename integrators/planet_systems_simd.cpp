#include "integrators/planet_systems_simd.hpp"

#include "integrators/kepler_changes_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

void prepare(const SystemRows& s) {
  for (std::ptrdiff_t k = 0; k < s.count; ++k) set_distance(load_eights(s.row[k].x), s.row[k]);
}

template <bool compensated> ArcReport drift_all(const SystemRows& s, const ArcTask& task) {
  ArcReport report;
  for (std::ptrdiff_t k = 0; k < s.count; ++k) advance_arcs<compensated>({task, s.exact, 8 * k}, s.row[k], report);
  return report;
}
template <bool compensated> ArcReport drift_with_changes(const SystemRows& s, const ArcTask& task) {
  ArcReport report;
  for (std::ptrdiff_t k = 0; k < s.count; ++k) {
    SystemRow& row = s.row[k];
    const auto beside = [&](const EightOrbits& o, const Eights& x, const Eights& v, const EightEnds& e,
                            unsigned lanes) {
      const EightTurns turns(o, x, v, e.s(), functions_of(o, e), load_eight(row.r_inverse));
      ExactTurns exact(s.changes.turn, beyond_series(o, e, lanes), task.h);
      if (__builtin_expect(exact.lanes != 0, 0)) set_exact(exact, row, x, v, load_eight(row.arc));
      for (std::ptrdiff_t c = 0; c < s.changes.count; ++c) {
        ChangeRow& change = s.changes.row[c * s.count + k];
        Eights a = load_eights(change.x), b = load_eights(change.v);
        if (__builtin_expect(exact.lanes != 0, 0)) {
          turn_with(turns, exact, a, b);
        } else {
          turns.turn(a, b);
        }
        store_eights(a, change.x);
        store_eights(b, change.v);
      }
    };
    advance_arcs<compensated>({task, s.exact, 8 * k}, row, report, beside);
  }
  const Eight h(task.h);
  for (std::ptrdiff_t c = 0; c < s.changes.count; ++c) {
    ChangeCenter& center = s.changes.center[c];
    store_eights(load_eights(center.x) + h * load_eights(center.v), center.x);
  }
  return report;
}
ArcReport drift(const SystemRows& s, const ArcTask& task) {
  if (s.changes.count > 0)
    return s.compensated ? drift_with_changes<true>(s, task) : drift_with_changes<false>(s, task);
  return s.compensated ? drift_all<true>(s, task) : drift_all<false>(s, task);
}

/// Where planets are relative to their stars, or changes of them.
template <class Row> NOETHER_EIGHT_INLINE void place_rows(const SystemRows& s, Row* rows) {
  Eights center{0.0, 0.0, 0.0};
  for (std::ptrdiff_t k = 0; k < s.count; ++k) {
    const Eights x = load_eights(rows[k].x);
    store_eights(x + center, rows[k].y);
    center = center + load_eight(s.row[k].share) * x;
  }
}
void place(const SystemRows& s) {
  place_rows(s, s.row);
  for (std::ptrdiff_t c = 0; c < s.changes.count; ++c) place_rows(s, s.changes.row + c * s.count);
}

/// An attraction by 1/r^2, and how it changes along a direction.
struct EightPull {
  Eight cube;     ///< 1/r^3
  Eight stretch;  ///< 3/r^5

  template <bool changes> NOETHER_EIGHT_INLINE static EightPull of(const Eight& r2) {
    EightPull pull;
    const Eight root = square_root(r2);
    pull.cube = Eight(1.0) / (r2 * root);
    if constexpr (changes) pull.stretch = (Eight(3.0) * pull.cube) * (pull.cube * root);
    return pull;
  }
  /// (d . grad) of d/r^3 along u.
  NOETHER_EIGHT_INLINE Eights along(const Eights& d, const Eights& u) const {
    return less(cube * u, stretch * fused_dot(d, u), d);
  }
};

/// What the star does to the planets and they to it; the arc of the innermost has that of both.
template <bool changes> NOETHER_EIGHT_INLINE Eights pulls_of_star(const SystemRows& s) {
  Eights star{0.0, 0.0, 0.0};
  if (s.beside != nullptr) {
    star = {load_eight(s.beside), load_eight(s.beside + 8), load_eight(s.beside + 16)};
  }
  const Eight mass = load_eight(s.star);
  for (std::ptrdiff_t k = 0; k < s.count; ++k) {
    SystemRow& row = s.row[k];
    const Eights y = load_eights(row.y);
    const Eight r2 = dot(y, y);
    Eights pull{0.0, 0.0, 0.0};
    EightPull by_star{0.0, 0.0};
    Eight bent(0.0), bends(0.0);
    if (k > 0) {
      by_star = EightPull::of<changes>(r2);
      pull = pull - (mass * by_star.cube) * y;
      star = star + (load_eight(row.attracts) * by_star.cube) * y;
    }
    if (s.relativity != nullptr) {
      bent = load_eight(s.relativity) / (r2 * r2);
      pull = pull - bent * y;
      star = star + (bent * load_eight(row.of_star)) * y;
      if constexpr (changes) bends = Eight(4.0) * (bent / r2);
    }
    if (s.beside != nullptr) pull = pull + load_eights(row.beside);
    store_eights(pull, row.pull);
    if constexpr (!changes) continue;
    for (std::ptrdiff_t c = 0; c < s.changes.count; ++c) {
      ChangeRow& change = s.changes.row[c * s.count + k];
      const Eights u = load_eights(change.y);
      Eights of_star = load_eights(s.changes.center[c].pull), of_pull{0.0, 0.0, 0.0};
      if (k > 0) {
        const Eights a = by_star.along(y, u);
        of_pull = less(of_pull, mass, a);
        of_star = fused(load_eight(row.attracts), a, of_star);
      }
      if (s.relativity != nullptr) {
        const Eights a = less(bent * u, bends * fused_dot(y, u), y);
        of_pull = of_pull - a;
        of_star = fused(load_eight(row.of_star), a, of_star);
      }
      if (s.beside != nullptr) of_pull = of_pull + load_eights(change.beside);
      store_eights(of_pull, change.pull);
      store_eights(of_star, s.changes.center[c].pull);
    }
  }
  return star;
}

template <bool changes> NOETHER_EIGHT_INLINE void pulls_of_pairs(const SystemRows& s) {
  for (std::ptrdiff_t k = 1; k < s.count; ++k) {
    SystemRow& row = s.row[k];
    const Eights y = load_eights(row.y);
    const Eight attracts = load_eight(row.attracts);
    Eights pull = load_eights(row.pull);
    for (std::ptrdiff_t j = 0; j < k; ++j) {
      SystemRow& other = s.row[j];
      const Eights d = y - load_eights(other.y);
      const EightPull both = EightPull::of<changes>(dot(d, d));
      const Eight other_attracts = load_eight(other.attracts);
      pull = pull - (other_attracts * both.cube) * d;
      store_eights(load_eights(other.pull) + (attracts * both.cube) * d, other.pull);
      if constexpr (!changes) continue;
      for (std::ptrdiff_t c = 0; c < s.changes.count; ++c) {
        ChangeRow &mine = s.changes.row[c * s.count + k], &theirs = s.changes.row[c * s.count + j];
        const Eights a = both.along(d, load_eights(mine.y) - load_eights(theirs.y));
        store_eights(less(load_eights(mine.pull), other_attracts, a), mine.pull);
        store_eights(fused(attracts, a, load_eights(theirs.pull)), theirs.pull);
      }
    }
    store_eights(pull, row.pull);
  }
}

/// Puts v + h a of a change to where it belongs. @return what the kick adds to the velocity of the centre of mass
template <class Put>
NOETHER_EIGHT_INLINE Eights kick_change(const SystemRows& s, std::ptrdiff_t c, const Eight& h, const Put& put) {
  Eights center = load_eights(s.changes.center[c].pull);
  for (std::ptrdiff_t k = 0; k < s.count; ++k) {
    const SystemRow& row = s.row[k];
    ChangeRow& change = s.changes.row[c * s.count + k];
    const Eights relative = load_eights(change.pull) - center;
    center = fused(load_eight(row.share), relative, center);
    Eights a = relative;
    if (k > 0) {
      const Eight inverse = load_eight(row.r_inverse), square = inverse * inverse;
      const Eights x = load_eights(row.x), u = load_eights(change.x);
      a = fused(load_eight(row.mu) * (inverse * square), less(u, (Eight(3.0) * square) * fused_dot(x, u), x), a);
    }
    put(change, fused(h, a, load_eights(change.v)));
  }
  return h * center;
}

template <bool changes> void attract_all(const SystemRows& s) {
  if constexpr (changes) {
    for (std::ptrdiff_t c = 0; c < s.changes.count; ++c) {
      ChangeCenter& center = s.changes.center[c];
      store_eights(s.beside != nullptr ? load_eights(center.star) : Eights{0.0, 0.0, 0.0}, center.pull);
    }
  }
  const Eights star = pulls_of_star<changes>(s);
  store_eight(star.x, s.pull);
  store_eight(star.y, s.pull + 8);
  store_eight(star.z, s.pull + 16);
  pulls_of_pairs<changes>(s);
}
void attract(const SystemRows& s) { s.changes.count > 0 ? attract_all<true>(s) : attract_all<false>(s); }

/// Accelerations relative to the centre of mass within, without what the arcs have done already.
template <bool compensated> void kick_all(const SystemRows& s, double h) {
  Eights center{load_eight(s.pull), load_eight(s.pull + 8), load_eight(s.pull + 16)};
  const Eight over(h);
  for (std::ptrdiff_t k = 0; k < s.count; ++k) {
    SystemRow& row = s.row[k];
    const Eights relative = load_eights(row.pull) - center;
    center = center + load_eight(row.share) * relative;
    Eights a = relative;
    if (k > 0) {
      const Eight inverse = load_eight(row.r_inverse);
      a = a + (load_eight(row.mu) * (inverse * (inverse * inverse))) * load_eights(row.x);
    }
    store_eights(add_change<compensated>(load_eights(row.v), over * a, row.v_low), row.v);
  }
  store_eight(over * center.x, s.center);
  store_eight(over * center.y, s.center + 8);
  store_eight(over * center.z, s.center + 16);
  for (std::ptrdiff_t c = 0; c < s.changes.count; ++c) {
    const auto put = [](ChangeRow& change, const Eights& v) { store_eights(v, change.v); };
    store_eights(kick_change(s, c, over, put), s.changes.center[c].kick);
  }
}
void kick(const SystemRows& s, double h) { s.compensated ? kick_all<true>(s, h) : kick_all<false>(s, h); }

/// Where arcs over h take a change of planet k, in lanes that Newton's step is not enough for.
[[gnu::noinline, gnu::cold]] void look_further(const SystemRows& s, std::ptrdiff_t k, const EightOrbits& o, Eights& a,
                                               Eights& b, double h) {
  const SystemRow& row = s.row[k];
  const Arcs arcs{{.h = h, .predicted = false, .predict = false}, s.exact, 8 * k};
  const Eights x = load_eights(row.x), v = load_eights(row.v);
  ExactArcs exact;
  ArcReport report;
  const EightEnds e = ends_of(arcs, row, o, first_guess(o.h, o.r_inverse, o.eta, o.zeta, o.beta), exact, report);
  const Eight inverse = Eight(1.0) / fused(o.eta, e.g1, fused(o.zeta, e.g2, o.r));
  const EightTurns turns(o, x, v, e.s(), functions_of(o, e), inverse);
  ExactTurns exactly(s.changes.turn, beyond_series(o, e, exact.lanes), h);
  if (exactly.lanes == 0) return turns.turn(a, b);
  Eight found = e.s();
  if (exact.lanes != 0) take_lanes(found, load_eight(exact.s), exact.lanes);
  set_exact(exactly, row, x, v, found);
  turn_with(turns, exactly, a, b);
}
/// Planets that are worked on in turn, each time a little, so that one does not wait for itself.
constexpr std::ptrdiff_t at_once = 4;

/// An arc that is only looked at.
struct LookedAt {
  EightOrbits o;
  Eight near;
  EightLooks look;
};

/// Where it takes a change of planet k.
NOETHER_EIGHT_INLINE void look_ahead(const SystemRows& s, std::ptrdiff_t k, const LookedAt& arc, double h, Eights& a,
                                     Eights& b) {
  const EightTurns turns(arc.o, load_eights(s.row[k].x), load_eights(s.row[k].v), arc.look.s, arc.look.g,
                         arc.look.inverse);
  Eights u = a, w = b;
  turns.turn(a, b);
  if (__builtin_expect(arc.look.bad == 0, 1)) return;
  Eights found = a, turned = b;
  look_further(s, k, arc.o, u, w, h);
  take_lanes(found, u, arc.look.bad);
  take_lanes(turned, w, arc.look.bad);
  a = found;
  b = turned;
}

/// Sums of squares of a change over all bodies, from the outermost planet inwards.
struct Squares {
  Eights center, center_v;
  Eight x, v;

  NOETHER_EIGHT_INLINE void add(const Eight& share, const Eights& a, const Eights& b) {
    center = less(center, share, a);
    center_v = less(center_v, share, b);
    const Eights at = center + a, speed = center_v + b;
    x = fused_dot(at, at, x);
    v = fused_dot(speed, speed, v);
  }
};

void measure_arcs(const SystemRows& s, std::ptrdiff_t c, double h, Squares& squares) {
  LookedAt looked[at_once];
  for (std::ptrdiff_t end = s.count; end > 0; end -= at_once) {
    const std::ptrdiff_t first = end > at_once ? end - at_once : 0;
    for (std::ptrdiff_t k = first; k < end; ++k) {
      LookedAt& arc = looked[k - first];
      const EightOrbits o = orbits_of(s.row[k], load_eights(s.row[k].x), load_eights(s.row[k].v), h);
      arc.o = o;
      arc.near = first_guess(o.h, o.r_inverse, o.eta, o.zeta, o.beta);
    }
    for (std::ptrdiff_t k = first; k < end; ++k)
      looked[k - first].look = look_from(looked[k - first].o, looked[k - first].near);
    for (std::ptrdiff_t k = end - 1; k >= first; --k) {
      const ChangeRow& change = s.changes.row[c * s.count + k];
      Eights a = load_eights(change.x), b = load_eights(change.v);
      look_ahead(s, k, looked[k - first], h, a, b);
      squares.add(load_eight(s.row[k].share), a, b);
    }
  }
}

void measure(const SystemRows& s, std::ptrdiff_t c, double arcs, double kick, double* to) {
  const ChangeCenter& whole = s.changes.center[c];
  Squares squares{load_eights(whole.x), load_eights(whole.v), 0.0, 0.0};
  if (arcs != 0) {
    squares.center = squares.center + Eight(arcs) * squares.center_v;
    measure_arcs(s, c, arcs, squares);
  } else {
    if (kick != 0) {
      const auto put = [](ChangeRow& change, const Eights& v) { store_eights(v, change.ahead); };
      const Eights of_center = kick_change(s, c, Eight(kick), put);
      if (s.beside != nullptr) squares.center_v = squares.center_v + of_center;
    }
    for (std::ptrdiff_t k = s.count - 1; k >= 0; --k) {
      const ChangeRow& change = s.changes.row[c * s.count + k];
      squares.add(load_eight(s.row[k].share), load_eights(change.x), load_eights(kick != 0 ? change.ahead : change.v));
    }
  }
  store_eight(fused_dot(squares.center, squares.center, squares.x), to);
  store_eight(fused_dot(squares.center_v, squares.center_v, squares.v), to + 8);
}

}  // namespace

extern const PlanetSystemKernels planet_system_kernels;
const PlanetSystemKernels planet_system_kernels{prepare, drift, place, attract, kick, measure};

}  // namespace noether::NOETHER_SIMD_LEVEL
