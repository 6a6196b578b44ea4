#pragma once
/// Secant forces: between two states, with the difference of the energies as their work.

#include "engine/force_sink.hpp"
#include "engine/sums.hpp"
#include "forces/images.hpp"
#include "forces/secant_tangent.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// Energy of a pair, and the force along its line of centres over their distance: -U'(r) / r.
template <class Real> struct PairTerms { Real energy, force; };

/// Two particles whose energy depends on their distance, as a force names them to `Secants`.
struct SecantPair {
  Index i, j;
  double range = 0;         ///< all images within it act [length]; 0: the nearest one alone, at any distance
  double nearest_part = 1;  ///< with `range`: of the force, that acts between the nearest images
  double closest = 0;       ///< pairs that are closer end the run [length]
  bool of_masses = false;   ///< energies are per product of the two masses; tracers feel the field
};

namespace detail {

/// Whether a step is so short that a quotient of the differences of energies over it would tell less than the
/// derivative in its middle.
/// @param step2, size2  squares of the step and of what moves
template <class Real> bool is_shortest(const Real& step2, const Real& size2) {
  return step2 <= Real(std::numeric_limits<Real>::epsilon()) * size2;
}
/// Whether the force in the middle of a step does the work of the energy, as far as numbers can tell.
/// @param missing  work [energy] @param scale  of the energies [energy]
template <class Real> bool is_rounding(const Real& missing, const Real& scale) {
  using std::abs;
  return abs(missing) <= Real(4) * Real(std::numeric_limits<Real>::epsilon()) * scale;
}

/// The mean of -U'(r)/r over r^2 from one value to the other, by Gauss's rule of three points.
template <class Real, class Terms> Real mean_force(const Real& from2, const Real& step, const Terms& terms) {
  using std::sqrt;
  const Real middle2 = from2 + step / Real(2), away = sqrt(Real(15)) / Real(10) * step;
  const Real outer = terms(middle2 - away).force + terms(middle2 + away).force;
  return (Real(5) * outer + Real(8) * terms(middle2).force) / Real(18);
}

/// Force over distance, k, of a pair that goes from the distance vector d0 to d1: f = k (d0 + d1) / 2 on the first of
/// them, with f . (d1 - d0) = U0 - U1 to rounding.
///
///     k = - 2 (U1 - U0) / (r1^2 - r0^2)
///
/// That is the mean of -U'(r)/r over r^2, and over short steps it is found as such: a quotient of small differences
/// would be rounded far more. The mean serves where it does the work of the energy, as it does off kinks and jumps.
/// @param step  r1^2 - r0^2, as (d0 + d1) . (d1 - d0): the difference of the squares is rounded far more
/// @param terms  (r2): energy and -U'(r)/r of the pair, as `PairTerms`
/// @param end2  square of the distance where the energy ends or jumps; 0: nowhere
/// @source LaBuddeGreenspan1976
template <class Real, class Terms>
Real secant_of(const Real& from2, const Real& to2, const Real& step, const Terms& terms, const Real& end2 = Real(0)) {
  using std::abs;
  if (step == Real(0)) return terms(from2).force;
  const Real size = to2 + from2;
  // Three points are right to the 6th power of the step over the distances.
  const double epsilon = static_cast<double>(std::numeric_limits<Real>::epsilon());
  const bool is_short = abs(step) <= Real(0.4 * std::cbrt(std::sqrt(epsilon))) * size;
  const bool is_smooth = is_short && (from2 < end2) == (to2 < end2);
  const Real mean = is_smooth ? mean_force(from2, step, terms) : Real(0);
  if (is_smooth && step * step <= Real(epsilon) * size * size) return mean;
  const Real before = terms(from2).energy, after = terms(to2).energy;
  const Real missing = before - after - mean * step / Real(2);
  const Real rounding = Real(64 * epsilon) * (abs(before) + abs(after) + abs(mean) * size);
  if (is_smooth && abs(missing) <= rounding) return mean;
  return Real(2) * (before - after) / step;
}

/// By how much `secant_of`, k, changes with r1^2: (-U'(r1)/r1 - k) / step, and over short steps, where that would be
/// rounded too far, half of what -U'(r)/r changes by at two thirds of the way.
template <class Real, class Terms>
Real secant_slope(const Real& from2, const Real& to2, const Real& step, const Real& k, const Terms& terms) {
  using std::abs;
  const Real size = to2 + from2;
  const Real away = Real(std::cbrt(static_cast<double>(std::numeric_limits<Real>::epsilon()))) * size;
  if (abs(step) > away) return (terms(to2).force - k) / step;
  const Real place = from2 + Real(2) * step / Real(3);
  return (terms(place + away).force - terms(place - away).force) / (Real(4) * away);
}

/// The way of a particle between two states; exact on the grid of a box, however many cells it has crossed.
template <class Real> Vec3<Real> way_of(const ParticleSystem<Real>& from, const ParticleSystem<Real>& to, Index i) {
  Vec3<Real> way = to.positions()[i] - from.positions()[i];
  for (int k = 0; k < 3 && to.box().is_periodic(); ++k) {
    way[k] += Real(to.images().component(k)[i] - from.images().component(k)[i]) * Real(to.box().edges()[k]);
  }
  return way;
}

/// Why a step has no secants. @param moves  the pair, by more than the box is long; else its nearest image changes
Failure no_secant(Index i, Index j, const std::vector<std::string>& names, bool moves);
/// Why a pair has no energy. @param r2  square of its distance
Failure too_close(Index i, Index j, const std::vector<std::string>& names, double r2, double closest);

}  // namespace detail

/// Adds the secant forces of terms of the energy to a sink, the same mechanism for all forces.
///
///     template <class Real> void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from,
///                                              const ParticleSystem<Real>& to) const {
///       Secants<Real> secants(out, from, to);
///       for (const auto& [i, j] : springs) {
///         secants.pair({.i = i, .j = j}, [&](const Real& r2) { return PairTerms<Real>{...}; });
///       }
///     }
///
/// The secants of a term do the work of its energy over the step to rounding, are the same for both directions of the
/// step, add up to no force and to no torque about the middle of the step, but for those of `tether`; they become the
/// forces as the step becomes short. Their derivatives with respect to the second state go to the sink where it wants
/// them; a force all of whose secants are added here may claim a `TangentPattern`. In a periodic box images are
/// followed from the first state. Where an energy is that of the nearest image alone and another one is nearest in the
/// second state, the sink fails.
/// @source LaBuddeGreenspan1976, Gonzalez1996
template <class Real> class Secants {
 public:
  Secants(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to)
      : out_(out), from_(from), to_(to) {}

  /// A pair, its energy and force given by `terms(r2)` as `PairTerms`.
  template <class Terms> void pair(const SecantPair& pair, const Terms& terms) {
    const Index i = pair.i, j = pair.j;
    const Vec3<Real> moved = displacement(i) - displacement(j), d0 = apart(i, j);
    if (!(pair.range > 0)) {
      if (keeps_image(i, j, Vec3<Real>(d0 + moved))) add(pair, d0, moved, Real(1), terms);
      return;
    }
    if (!can_follow(pair, d0, moved)) return;
    // What comes into range began no further away than it moves.
    const double reach = pair.range + std::sqrt(static_cast<double>(norm2(moved)));
    detail::for_images(from_, i, j, reach, [&](const Vec3<Real>& image, bool nearest) {
      const Real part(nearest ? pair.nearest_part : 1.0);
      if (part != Real(0)) add(pair, image, moved, part, terms);
    });
  }
  /// A pair whose distance vector from j to i in the first state is `d0`, along whatever images.
  template <class Terms> void pair_along(Index i, Index j, const Vec3<Real>& d0, const Terms& terms) {
    add({.i = i, .j = j}, d0, Vec3<Real>(displacement(i) - displacement(j)), Real(1), terms);
  }

  /// A particle and a point that stands still, likewise. Tracers have no energy and feel nothing.
  template <class Terms> void tether(Index i, const Vec3<Real>& point, const Terms& terms) {
    const Vec3<Real> d0 = from_.box().minimum_image(Vec3<Real>(from_.positions()[i] - point));
    const Vec3<Real> moved = displacement(i);
    if (!keeps_image(i, i, Vec3<Real>(d0 + moved))) return;
    out_.force(i, force_of(d0, moved, terms, Real(0)));
    if (out_.tangent() != nullptr) out_.tangent()->force(i, i, tangent_of(d0, moved, terms, Real(0)));
  }

  /// Three or four particles whose energy depends on their shape: the force in the middle of the step, and what is
  /// missing of the work along the changes of all their distances and of their volume, which exert neither a force nor
  /// a torque.
  /// @param place  of each particle about the second one, in the first state [length]
  /// @param evaluate  (places): forces and energy, as members `force` and `energy`
  template <std::size_t n, class Evaluate>
  void group(const std::array<Index, n>& particles, const std::array<Vec3<Real>, n>& place, const Evaluate& evaluate) {
    std::array<Vec3<Real>, n> moved;
    for (std::size_t k = 0; k < n; ++k) moved[k] = displacement(particles[k]) - displacement(particles[1]);
    const std::array<Vec3<Real>, n> force = forces_of_group(place, moved, evaluate);
    for (std::size_t k = 0; k < n; ++k) out_.force(particles[k], force[k]);
    if (out_.tangent() != nullptr) add_tangent_of_group(particles, place, moved, evaluate);
  }

  /// Whether the nearest image of a pair in the first state is that of the second one, too; the sink fails if not.
  bool keeps_image(Index i, Index j) {
    return keeps_image(i, j, Vec3<Real>(apart(i, j) + displacement(i) - displacement(j)));
  }
  /// Nearest image of x_i - x_j in the first state.
  Vec3<Real> apart(Index i, Index j) const {
    return from_.box().minimum_image(Vec3<Real>(from_.positions()[i] - from_.positions()[j]));
  }

 private:
  bool keeps_image(Index i, Index j, const Vec3<Real>& d) {
    if (!changes_image(d)) return true;
    out_.fail(detail::no_secant(i, j, to_.names(), false));
    return false;
  }
  Vec3<Real> displacement(Index i) const { return detail::way_of(from_, to_, i); }
  bool changes_image(const Vec3<Real>& d) const {
    using std::abs;
    const Box& box = to_.box();
    for (int k = 0; k < 3 && box.is_periodic(); ++k) {
      if (abs(d[k]) > Real(0.5 * (1 + 1e-12) * box.edges()[k])) return true;
    }
    return false;
  }
  /// Whether the images of a pair can be told from one state to the other.
  bool can_follow(const SecantPair& pair, const Vec3<Real>& d0, const Vec3<Real>& moved) {
    const Box& box = from_.box();
    if (!box.is_periodic()) return true;
    const double longest = box.edges().maxCoeff();
    const bool moves = !(norm2(moved) <= Real(longest * longest));
    const Real range2(pair.range * pair.range);
    const Vec3<Real> d1 = d0 + moved;
    // What is special is the nearest image, so another one must not become it while either acts.
    const bool special =
        pair.nearest_part != 1 && changes_image(d1) && (norm2(d0) < range2 || norm2(box.minimum_image(d1)) < range2);
    if (!moves && !special) return true;
    out_.fail(detail::no_secant(pair.i, pair.j, to_.names(), moves));
    return false;
  }
  /// Of a distance vector d0 that changes by `moved`.
  template <class Terms>
  Vec3<Real> force_of(const Vec3<Real>& d0, const Vec3<Real>& moved, const Terms& terms, const Real& end2) const {
    const Vec3<Real> d1 = d0 + moved, both = d0 + d1;
    return detail::secant_of(norm2(d0), norm2(d1), Real(dot(both, moved)), terms, end2) / Real(2) * both;
  }
  /// By how much that force changes with the second distance vector.
  template <class Terms>
  Mat3<Real> tangent_of(const Vec3<Real>& d0, const Vec3<Real>& moved, const Terms& terms, const Real& end2) const {
    const Vec3<Real> d1 = d0 + moved, both = d0 + d1;
    const Real from2 = norm2(d0), to2 = norm2(d1), step = dot(both, moved);
    const Real k = detail::secant_of(from2, to2, step, terms, end2);
    const Real slope = detail::secant_slope(from2, to2, step, k, terms);
    return k / Real(2) * Mat3<Real>::Identity() + slope * both * d1.transpose();
  }
  template <class Terms>
  void add(const SecantPair& pair, const Vec3<Real>& d0, const Vec3<Real>& moved, const Real& part,
           const Terms& terms) {
    const Vec3<Real> d1 = d0 + moved;
    const Real range2(pair.range * pair.range), from2 = norm2(d0), to2 = norm2(d1);
    if (pair.range > 0 && !(from2 < range2) && !(to2 < range2)) return;
    const Real least = from2 < to2 ? from2 : to2;
    if (least < Real(pair.closest * pair.closest)) {
      out_.fail(detail::too_close(pair.i, pair.j, to_.names(), static_cast<double>(least), pair.closest));
    }
    const Vec3<Real> f = part * force_of(d0, moved, terms, range2);
    if (pair.of_masses) {
      out_.acceleration(pair.i, Vec3<Real>(to_.masses()[pair.j] * f));
      out_.acceleration(pair.j, Vec3<Real>(-to_.masses()[pair.i] * f));
    } else {
      out_.pair(pair.i, pair.j, f);
    }
    if (out_.tangent() != nullptr) add_tangent(pair, Mat3<Real>(part * tangent_of(d0, moved, terms, range2)));
  }
  void add_tangent(const SecantPair& pair, const Mat3<Real>& derivative) {
    SecantTangent<Real>& tangent = *out_.tangent();
    if (!pair.of_masses) return tangent.pair(pair.i, pair.j, derivative);
    const Mat3<Real> on_i = to_.masses()[pair.j] * derivative, on_j = to_.masses()[pair.i] * derivative;
    tangent.acceleration(pair.i, pair.i, on_i);
    tangent.acceleration(pair.i, pair.j, Mat3<Real>(-on_i));
    tangent.acceleration(pair.j, pair.i, Mat3<Real>(-on_j));
    tangent.acceleration(pair.j, pair.j, on_j);
  }
  template <std::size_t n, class Evaluate>
  static std::array<Vec3<Real>, n> forces_of_group(const std::array<Vec3<Real>, n>& place,
                                                   const std::array<Vec3<Real>, n>& moved, const Evaluate& evaluate) {
    using std::abs, std::sqrt;
    std::array<Vec3<Real>, n> middle, last;
    Real step2(0), size2(0), work(0), strength2(0);
    for (std::size_t k = 0; k < n; ++k) {
      last[k] = place[k] + moved[k];
      middle[k] = (place[k] + last[k]) / Real(2);
      step2 += norm2(moved[k]);
      size2 += norm2(middle[k]);
    }
    std::array<Vec3<Real>, n> force = evaluate(middle).force;
    if (detail::is_shortest(step2, size2)) return force;
    const Real before = evaluate(place).energy, after = evaluate(last).energy;
    for (std::size_t k = 0; k < n; ++k) {
      work += dot(force[k], moved[k]);
      strength2 += norm2(force[k]);
    }
    const Real missing = before - after - work, scale = abs(before) + abs(after) + sqrt(strength2 * size2);
    if (detail::is_rounding(missing, scale)) return force;
    const std::array<Vec3<Real>, n> change = change_of_shape(place, last, middle, moved, size2);
    Real along(0);
    for (std::size_t k = 0; k < n; ++k) along += dot(change[k], moved[k]);
    for (std::size_t k = 0; k < n && along > Real(0); ++k) force[k] += missing / along * change[k];
    return force;
  }
  /// By differences over the places of each particle but the second one; all of them moved together change nothing.
  template <std::size_t n, class Evaluate>
  void add_tangent_of_group(const std::array<Index, n>& particles, const std::array<Vec3<Real>, n>& place,
                            std::array<Vec3<Real>, n> moved, const Evaluate& evaluate) {
    using std::sqrt;
    Real size2(0);
    for (std::size_t k = 0; k < n; ++k) size2 += norm2(Vec3<Real>(place[k] + moved[k]));
    const Real reach = Real(std::cbrt(static_cast<double>(std::numeric_limits<Real>::epsilon()))) * sqrt(size2);
    for (std::size_t of = 0; of < n; ++of) {
      if (of == 1) continue;
      std::array<Mat3<Real>, n> derivative;
      for (Index axis = 0; axis < 3; ++axis) {
        const Real here = moved[of][axis], up = here + reach, down = here - reach;
        moved[of][axis] = up;
        const std::array<Vec3<Real>, n> after = forces_of_group(place, moved, evaluate);
        moved[of][axis] = down;
        const std::array<Vec3<Real>, n> before = forces_of_group(place, moved, evaluate);
        moved[of][axis] = here;
        for (std::size_t k = 0; k < n; ++k) derivative[k].col(axis) = (after[k] - before[k]) / (up - down);
      }
      for (std::size_t k = 0; k < n; ++k) {
        out_.tangent()->force(particles[k], particles[of], derivative[k]);
        out_.tangent()->force(particles[k], particles[1], Mat3<Real>(-derivative[k]));
      }
    }
  }
  /// A motion of the particles about the middle of the step that changes all distances, and the volume of four, as the
  /// step does: its product with the step is a sum of squares.
  template <std::size_t n>
  static std::array<Vec3<Real>, n> change_of_shape(const std::array<Vec3<Real>, n>& first,
                                                   const std::array<Vec3<Real>, n>& last,
                                                   const std::array<Vec3<Real>, n>& middle,
                                                   const std::array<Vec3<Real>, n>& moved, const Real& size2) {
    std::array<Vec3<Real>, n> change;
    change.fill(Vec3<Real>::Zero());
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const Real growth = norm2(Vec3<Real>(last[a] - last[b])) - norm2(Vec3<Real>(first[a] - first[b]));
        const Vec3<Real> along = growth * (middle[a] - middle[b]);
        change[a] += along;
        change[b] -= along;
      }
    }
    if constexpr (n == 4) {
      const Vec3<Real> a = middle[0] - middle[1], b = middle[2] - middle[1], c = middle[3] - middle[1];
      const std::array<Vec3<Real>, 3> normal = {cross(b, c), cross(c, a), cross(a, b)};
      const Real larger = (dot(normal[0], moved[0]) + dot(normal[1], moved[2]) + dot(normal[2], moved[3])) / size2;
      change[0] += larger * normal[0];
      change[1] -= larger * (normal[0] + normal[1] + normal[2]);
      change[2] += larger * normal[1];
      change[3] += larger * normal[2];
    }
    return change;
  }

  ForceSink<Real>& out_;
  const ParticleSystem<Real>&from_, &to_;
};

namespace detail {

/// What the secants of a field are computed in.
template <class Real> struct MiddleOfStep {
  std::optional<ParticleSystem<Real>> particles;
  VectorColumn<Real> a;
};

/// Adds the secants of a force whose energy depends on positions in any way: its accelerations in the middle of the
/// step, and what is missing of the work along the displacements; about the center of mass if it keeps the momentum.
/// Angular momentum is kept only as far as the force in the middle does all the work.
/// @cost three evaluations and a copy of the particles
/// @source Gonzalez1996
template <class F, class Real>
void add_middle_secants(const F& force, ForceSink<Real>& out, const ParticleSystem<Real>& from,
                        const ParticleSystem<Real>& to) {
  using std::abs, std::sqrt;
  auto& own = out.workspace().template get<MiddleOfStep<Real>>();
  own.particles = to;
  ParticleSystem<Real>& middle = *own.particles;
  if (own.a.size() != to.size()) own.a = VectorColumn<Real>(to.size());
  const auto energy_of = [&](const ParticleSystem<Real>& s) {
    ForceSink<Real> sink(own.a, s, {.energy = true});
    force.add_to(sink, s);
    if (sink.failure()) out.fail(*sink.failure());
    return sink.potential();
  };
  const Real before = energy_of(from), after = energy_of(to);
  const ScalarColumn<Real>& m = to.masses();
  const auto moved = [&](Index i) { return way_of(from, to, i); };
  for (Index i = 0; i < to.size(); ++i) middle.shift(i, Vec3<Real>(moved(i) / Real(-2)), Vec3<Real>::Zero());
  middle.moved();
  energy_of(middle);
  Vec3<Real> mean = Vec3<Real>::Zero();
  if (claims_of(force).keeps_momentum) {
    const auto [mass, x, y, z] = sums_over<Real, 4>(to.size(), [&](Index i) {
      const Vec3<Real> way = moved(i);
      return std::array<Real, 4>{m[i], m[i] * way[0], m[i] * way[1], m[i] * way[2]};
    });
    if (mass > Real(0)) mean = Vec3<Real>(x, y, z) / mass;
  }
  const auto [work, strength, square] = sums_over<Real, 3>(to.size(), [&](Index i) {
    const Vec3<Real> a = std::as_const(own.a)[i], about = moved(i) - mean;
    return std::array<Real, 3>{m[i] * dot(a, moved(i)), m[i] * sqrt(norm2(a) * norm2(middle.unwrapped(i))),
                               m[i] * norm2(about)};
  });
  const Real missing = before - after - work, scale = abs(before) + abs(after) + strength;
  const bool serves = is_rounding(missing, scale) || !(square > Real(0));
  const Real factor = serves ? Real(0) : Real(missing / square);
  for (Index i = 0; i < to.size(); ++i) {
    Vec3<Real> a = std::as_const(own.a)[i];
    if (m[i] != Real(0)) a += factor * (moved(i) - mean);
    out.acceleration(i, a);
  }
}

}  // namespace detail

}  // namespace noether
