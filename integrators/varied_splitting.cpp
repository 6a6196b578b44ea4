#include "integrators/varied_splitting.hpp"

#include "integrators/jacobi_derivatives.hpp"
#include "numbers/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

namespace noether {

namespace detail {

namespace {

template <class Real> void check_slopes(const ForceField<Real>& forces, bool velocities) {
  for (const AnyForce<Real>& force : forces.terms()) {
    if (!force.has_derivative()) {
      throw Error(fmt::format("the force '{}' is written for doubles only and has no derivatives", force.name()));
    }
    if (force.claims().velocity_dependent && !velocities) {
      throw Error(fmt::format(
          "the force '{}' depends on velocities, and kicks by it have no derivatives here; use a method for y' = f, "
          "such as 'gauss_8' with adaptive = false",
          force.name()));
    }
  }
}

}  // namespace

template <class Real>
ForceSlopes<Real>::ForceSlopes(ForceField<Real> forces, const ParticleSystem<Real>& s, bool velocities)
    : forces_(std::move(forces)), moving_(s.template as<D>()), a_(s.size()) {
  check_slopes(forces_, velocities);
  if (any()) bind_force(forces_, s);
  moving_.clock() = Clock<D>::free(0);
}

template <class Real>
const VectorColumn<Dual<Real, 1>>& ForceSlopes<Real>::sum(char letter, const Real& time, const VectorColumn<Real>& x,
                                                          const VectorColumn<Real>& u, const VectorColumn<Real>* v,
                                                          const VectorColumn<Real>* w) {
  const auto move = [](const VectorColumn<Real>& from, const VectorColumn<Real>& by, VectorColumn<D>& moving) {
    for (int k = 0; k < 3; ++k) {
      for (Index i = 0; i < from.size(); ++i) moving.component(k)[i] = along(from.component(k)[i], by.component(k)[i]);
    }
  };
  move(x, u, moving_.positions());
  if (v != nullptr) move(*v, *w, moving_.velocities());
  moving_.clock().set_stage_offset(D(time));
  ForceSink<D> sink(a_, std::as_const(moving_), {});
  if (letter != 0) sink.set_kick_letter(letter);
  forces_.add_to(sink, std::as_const(moving_));
  if (sink.failure() && !failure_) failure_ = sink.failure();
  return a_;
}

template <class Real> void Varied<Real>::take(const VectorColumn<Real>& all, Index k, VectorColumn<Real>& one) const {
  for (int c = 0; c < 3; ++c) std::copy_n(all.component(c) + k * n_, n_, one.component(c));
}
template <class Real> void Varied<Real>::put(const VectorColumn<Real>& one, Index k, VectorColumn<Real>& all) const {
  for (int c = 0; c < 3; ++c) std::copy_n(one.component(c), n_, all.component(c) + k * n_);
}

}  // namespace detail

template <class Real>
VariedMotion<Real>::VariedMotion(ForceField<Real> forces, const ParticleSystem<Real>& s, Index changes)
    : Base(s.size(), changes), slopes_(std::move(forces), s), x_(s.size()), u_(s.size()) {
  if (s.box().is_periodic()) throw Error("changes of particles in a periodic box cannot be followed; take out the box");
}

template <class Real> HamiltonianClaims VariedMotion<Real>::claims() const {
  const ForceClaims forces = slopes_.claims();
  const std::string kicks = forces.kicks.empty() ? "B" : forces.kicks;
  return {.alphabet = "A" + kicks,
          .basic = std::string(kicks.rbegin(), kicks.rend()) + "A" + kicks,
          .kicks = kicks,
          .energy = false,
          .time_dependent = forces.time_dependent,
          .dissipative = forces.dissipative};
}

template <class Real> void VariedMotion<Real>::flow(char letter, ParticleSystem<Real>& s, const Real& h) {
  if (letter == 'A') {
    s.advance_positions(h);
    return;
  }
  if (!Base::is_known(letter, s)) {
    const VectorColumn<Real>& all = std::as_const(s).positions();
    Base::take(all, 0, x_);
    for (Index k = 1; k <= changes_; ++k) {
      Base::take(all, k, u_);
      const auto& a = slopes_.sum(letter, s.time(), x_, u_);
      for (int c = 0; c < 3; ++c) {
        for (Index i = 0; i < n_; ++i) {
          a_.component(c)[i] = a.component(c)[i].value;
          a_.component(c)[i + k * n_] = a.component(c)[i].slope[0];
        }
      }
    }
    Base::note(slopes_.failure());
    Base::remember(letter, s);
  }
  s.advance_velocities(h, a_);
}

template <class Real> void VariedPlanets<Real>::prepare() {
  x_.assign(static_cast<std::size_t>(1 + changes_), VectorColumn<Real>(n_));
  inertial_ = b_ = x_;
  base_x_ = base_u_ = VectorColumn<Real>(n_);
}

template <class Real> HamiltonianClaims VariedPlanets<Real>::claims() const {
  HamiltonianClaims claims = claims_;
  claims.alphabet = "AB";
  claims.kernels = "";
  claims.no_kernel = "because changes of a state have no flows of kernels";
  claims.lazy = "";
  claims.energy = false;
  claims.twists = false;
  claims.steps_at_once = 1;
  return claims;
}

/// Does the same to the state and to every change: changes of coordinates are linear.
template <class Real>
template <class Change>
void VariedPlanets<Real>::each_part(ParticleSystem<Real>& s, const Change& change) {
  for (Index k = 0; k <= changes_; ++k) {
    Varied::take(std::as_const(s).positions(), k, part_.positions());
    Varied::take(std::as_const(s).velocities(), k, part_.velocities());
    change(part_);
    Varied::put(std::as_const(part_).positions(), k, s.positions());
    Varied::put(std::as_const(part_).velocities(), k, s.velocities());
  }
}

template <class Real> void VariedPlanets<Real>::open(ParticleSystem<Real>& s) {
  each_part(s, [&](ParticleSystem<Real>& one) {
    if (jacobi()) {
      About::to_jacobi(one.positions());
      About::to_jacobi(one.velocities());
    } else if (barycentric()) {
      About::to_barycentric(one);
    } else {
      About::to_democratic(one);
    }
    if (scaled()) About::scale(one.velocities(), false);
  });
  s.phase().coordinates = claims_.coordinates;
}

template <class Real> void VariedPlanets<Real>::close(ParticleSystem<Real>& s) {
  each_part(s, [&](ParticleSystem<Real>& one) {
    if (scaled()) About::scale(one.velocities(), true);
    const auto& c = std::as_const(one);
    if (jacobi()) {
      const Vec3<Real> x = c.positions()[0], v = c.velocities()[0];
      About::from_jacobi(c.positions(), one.positions(), x);
      About::from_jacobi(c.velocities(), one.velocities(), v);
    } else if (barycentric()) {
      About::from_barycentric(one);
    } else {
      About::from_democratic(one);
    }
  });
  s.phase().coordinates = 0;
}

template <class Real> void VariedPlanets<Real>::flow(char letter, ParticleSystem<Real>& s, const Real& h) {
  if (letter == 'A') {
    arcs(s, h);
    return;
  }
  if (!jacobi()) jump(s, h / Real(2));
  if (!Varied::is_known('B', s)) {
    accelerate(s);
    Varied::remember('B', s);
  }
  s.advance_velocities(h, a_);
  if (!jacobi()) jump(s, h / Real(2));
}

template <class Real> void VariedPlanets<Real>::arcs(ParticleSystem<Real>& s, const Real& h) {
  const auto& c = std::as_const(s);
  std::atomic<Index> failed{n_};
  for_blocks(n_, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      if (i == 0) continue;
      const Real mu = g_ * circled_[static_cast<std::size_t>(i)];
      const Vec3<Real> x = c.positions()[i], v = c.velocities()[i];
      const KeplerArc<Real> arc = kepler_arc(x, v, mu, h);
      if (arc.status != KeplerStatus::converged) failed = i;
      const KeplerTangentOf<Real> tangent(x, v, mu, h, arc.s);
      for (Index row = i + n_; row < (1 + changes_) * n_; row += n_) {
        const KeplerChangeOf<Real> start{c.positions()[row], c.velocities()[row]};
        s.shift(row, Vec3<Real>(tangent.position(start) - start.x), Vec3<Real>(tangent.velocity(start) - start.v));
      }
      s.shift(i, arc.dx, arc.dv);
    }
  });
  for (Index row = 0; row < (1 + changes_) * n_; row += n_)
    s.shift(row, Vec3<Real>(h * c.velocities()[row]), Vec3<Real>(Vec3<Real>::Zero()));
  s.moved();
  if (failed < n_)
    Varied::note(Failure{Outcome::Kind::solver_failure, failed, "position", "the Kepler solver did not converge"});
}

template <class Real> void VariedPlanets<Real>::jump(ParticleSystem<Real>& s, const Real& h) {
  const auto& v = std::as_const(s).velocities();
  const Real mass = barycentric() ? -About::interior_.back() : About::masses_[0];
  for (Index k = 0; k <= changes_; ++k) {
    Vec3<Real> momentum = Vec3<Real>::Zero();
    for (std::size_t b = 1; b < massive(); ++b) momentum += reduced_[b] * v[k * n_ + static_cast<Index>(b)];
    const Vec3<Real> shift = h / mass * momentum;
    for (Index i = 1; i < n_; ++i) {
      Vec3<Real> by = shift;
      if (scaled()) by -= h / mass * reduced_[static_cast<std::size_t>(i)] * v[k * n_ + i];
      s.shift(k * n_ + i, by, Vec3<Real>(Vec3<Real>::Zero()));
    }
  }
  s.moved();
}

/// The kick of `WisdomHolman::accelerate`, and beside it its change along every change.
template <class Real> void VariedPlanets<Real>::accelerate(const ParticleSystem<Real>& s) {
  const bool from_primary = jacobi() || barycentric();
  for (Index k = 0; k <= changes_; ++k) {
    const auto at_k = static_cast<std::size_t>(k);
    Varied::take(s.positions(), k, x_[at_k]);
    if (from_primary) {
      About::inertial_positions(x_[at_k], Vec3<Real>::Zero(), inertial_[at_k]);
    } else {
      inertial_[at_k].assign(x_[at_k]);
    }
    b_[at_k].set_zero();
  }
  add_pulls(from_primary ? 0 : 1);
  if (others_.any()) add_others(s.time());
  for (Index k = 0; k <= changes_; ++k) {
    VectorColumn<Real>& b = b_[static_cast<std::size_t>(k)];
    if (jacobi()) {
      About::to_jacobi(b);
      if (!others_.any()) b.set(0, Vec3<Real>::Zero());
    } else {
      about_center(b);
      if (scaled()) About::scale(b, false);
    }
    if (from_primary) add_arcs(k);
    Varied::put(b, k, a_);
  }
}

/// @param first  particle: heliocentric pairs leave out the primary
template <class Real> void VariedPlanets<Real>::add_pulls(Index first) {
  const auto bodies = static_cast<Index>(massive());
  const Index inner = jacobi() && bodies > 1 ? at(1) : -1;
  for (Index i = first + 1; i < bodies; ++i) {
    for (Index j = first; j < i; ++j) {
      if (j != 0 || i != inner) add_pull(i, j, true);  // else exactly the innermost Kepler arc
    }
  }
  for_blocks(n_ - bodies, [&](Index begin, Index end) {
    for (Index i = bodies + begin; i < bodies + end; ++i) {
      for (Index j = jacobi() && within(i) == 0 ? 1 : first; j < bodies; ++j) add_pull(i, j, false);
    }
  });
}

template <class Real> void VariedPlanets<Real>::add_pull(Index i, Index j, bool mutual) {
  using std::sqrt;
  const Real mi = mutual ? About::masses_[static_cast<std::size_t>(i)] : Real(0);
  const Real mj = About::masses_[static_cast<std::size_t>(j)];
  const auto& x = std::as_const(inertial_[0]);
  const Vec3<Real> d = x[i] - x[j];
  const Real r2 = norm2(d), pull = g_ / (r2 * sqrt(r2)), stretch = Real(3) / r2;
  const auto add = [&](std::size_t k, const Vec3<Real>& a) {
    b_[k].add(i, Vec3<Real>(-mj * a));
    if (mutual) b_[k].add(j, Vec3<Real>(mi * a));
  };
  add(0, pull * d);
  for (std::size_t k = 1; k < inertial_.size(); ++k) {
    const Vec3<Real> u = std::as_const(inertial_[k])[i] - std::as_const(inertial_[k])[j];
    add(k, pull * (u - stretch * dot(d, u) * d));
  }
}

template <class Real> void VariedPlanets<Real>::add_others(const Real& time) {
  About::inertial_positions(x_[0], std::as_const(x_[0])[0], base_x_);
  for (Index k = 1; k <= changes_; ++k) {
    const auto at_k = static_cast<std::size_t>(k);
    About::inertial_positions(x_[at_k], std::as_const(x_[at_k])[0], base_u_);
    const auto& a = others_.sum(0, time, base_x_, base_u_);
    for (int c = 0; c < 3; ++c) {
      for (Index i = 0; i < n_; ++i) {
        if (k == 1) b_[0].component(c)[i] += a.component(c)[i].value;
        b_[at_k].component(c)[i] += a.component(c)[i].slope[0];
      }
    }
  }
  Varied::note(others_.failure());
}

/// Takes back what the Kepler arcs have done already.
template <class Real> void VariedPlanets<Real>::add_arcs(Index k) {
  using std::sqrt;
  VectorColumn<Real>& b = b_[static_cast<std::size_t>(k)];
  const auto& x = std::as_const(x_[0]);
  const auto& u = std::as_const(x_[static_cast<std::size_t>(k)]);
  const auto pull = [&](Index i, const Real& mu) -> Vec3<Real> {
    if (k > 0) return change_of_pull<Real>(x[i], u[i], mu);
    const Vec3<Real> d = x[i];
    const Real r2 = norm2(d);
    return -mu / (r2 * sqrt(r2)) * d;
  };
  Vec3<Real> of_primary = Vec3<Real>::Zero();
  const bool moved = jacobi() && massive() > 1;  // the innermost arc has moved the primary as well
  if (moved) of_primary = pull(at(1), g_ * About::masses_[static_cast<std::size_t>(at(1))]);
  const std::size_t first = jacobi() ? std::min<std::size_t>(2, massive()) : 1;
  for (std::size_t rank = first; rank < About::order_.size(); ++rank) {
    const Index i = at(rank);
    const bool innermost = jacobi() && within(i) == 0;
    b.add(i, innermost ? of_primary : Vec3<Real>(-pull(i, g_ * circled_[static_cast<std::size_t>(i)])));
  }
}

template <class Real> void VariedPlanets<Real>::about_center(VectorColumn<Real>& column) const {
  const auto& a = std::as_const(column);
  Vec3<Real> mean = Vec3<Real>::Zero();
  for (std::size_t k = 0; others_.any() && k < massive(); ++k)
    mean += About::masses_[k] / About::interior_.back() * a[static_cast<Index>(k)];
  const Vec3<Real> center = barycentric() ? Vec3<Real>(a[0]) : mean;
  for (Index i = 1; i < column.size(); ++i) column.add(i, -center);
  column.set(0, mean);
}

template class detail::ForceSlopes<double>;
template class detail::ForceSlopes<Quad>;
template class detail::Varied<double>;
template class detail::Varied<Quad>;
template class VariedMotion<double>;
template class VariedMotion<Quad>;
template class VariedPlanets<double>;
template class VariedPlanets<Quad>;

}  // namespace noether
