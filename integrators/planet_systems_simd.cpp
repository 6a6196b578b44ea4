#include "integrators/planet_systems_simd.hpp"

#include "integrators/kepler_simd.hpp"

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
ArcReport drift(const SystemRows& s, const ArcTask& task) {
  return s.compensated ? drift_all<true>(s, task) : drift_all<false>(s, task);
}

void place(const SystemRows& s) {
  Eights center{0.0, 0.0, 0.0};
  for (std::ptrdiff_t k = 0; k < s.count; ++k) {
    SystemRow& row = s.row[k];
    const Eights x = load_eights(row.x);
    store_eights(x + center, row.y);
    center = center + load_eight(row.share) * x;
  }
}

/// 1/r^3 from r^2.
NOETHER_EIGHT_INLINE Eight inverse_cube(const Eight& r2) { return Eight(1.0) / (r2 * square_root(r2)); }

/// What the star does to the planets and they to it; the arc of the innermost has that of both.
NOETHER_EIGHT_INLINE Eights pulls_of_star(const SystemRows& s) {
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
    if (k > 0) {
      const Eight cube = inverse_cube(r2);
      pull = pull - (mass * cube) * y;
      star = star + (load_eight(row.attracts) * cube) * y;
    }
    if (s.relativity != nullptr) {
      const Eight bent = load_eight(s.relativity) / (r2 * r2);
      pull = pull - bent * y;
      star = star + (bent * load_eight(row.of_star)) * y;
    }
    if (s.beside != nullptr) pull = pull + load_eights(row.beside);
    store_eights(pull, row.pull);
  }
  return star;
}

NOETHER_EIGHT_INLINE void pulls_of_pairs(const SystemRows& s) {
  for (std::ptrdiff_t k = 1; k < s.count; ++k) {
    SystemRow& row = s.row[k];
    const Eights y = load_eights(row.y);
    const Eight attracts = load_eight(row.attracts);
    Eights pull = load_eights(row.pull);
    for (std::ptrdiff_t j = 0; j < k; ++j) {
      SystemRow& other = s.row[j];
      const Eights d = y - load_eights(other.y);
      const Eight cube = inverse_cube(dot(d, d));
      pull = pull - (load_eight(other.attracts) * cube) * d;
      store_eights(load_eights(other.pull) + (attracts * cube) * d, other.pull);
    }
    store_eights(pull, row.pull);
  }
}

/// Accelerations relative to the centre of mass within, without what the arcs have done already.
template <bool compensated> void kick_all(const SystemRows& s, double h) {
  Eights center = pulls_of_star(s);
  pulls_of_pairs(s);
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
}
void kick(const SystemRows& s, double h) { s.compensated ? kick_all<true>(s, h) : kick_all<false>(s, h); }

}  // namespace

extern const PlanetSystemKernels planet_system_kernels;
const PlanetSystemKernels planet_system_kernels{prepare, drift, place, kick};

}  // namespace noether::NOETHER_SIMD_LEVEL
