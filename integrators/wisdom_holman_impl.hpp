#pragma once
/// Definitions of integrators/wisdom_holman.hpp; included by it.

#include "integrators/wisdom_holman.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {

template <class Real, class F> HamiltonianClaims WisdomHolman<Real, F>::claims() const {
  const ForceClaims forces = claims_of(forces_);
  if (forces.kicks.find_first_not_of('B') != std::string::npos) {
    throw SchemeMismatch(
        "wisdom_holman has only kicks of the letter B; take the letter of the force out, or use "
        "kinetic_potential");
  }
  const bool by_positions = !forces.velocity_dependent, lazy = jacobi() && by_positions && !forces.on_bodies;
  const bool gradient = lazy && has_derivative<Real>(forces_);
  return {.alphabet = gradient ? "ABGL"
                      : lazy   ? "ABL"
                               : "AB",
          .inexact = by_positions && (jacobi() || (!scaled() && !has_forces)) ? "" : "B",
          .kernels = gradient ? "GL"
                     : lazy   ? "L"
                              : "",
          .no_kernel = no_kernel(),
          .lazy = lazy ? "L" : "",
          .quadratic_kinetic = jacobi() && by_positions,
          .symplectic = by_positions,
          .energy = forces.energy,
          .time_dependent = forces.time_dependent,
          .dissipative = forces.dissipative,
          .no_action = by_positions ? "" : "a force depends on velocities, so the motion has no action",
          .twists = true,
          .coordinates = static_cast<std::uint8_t>(options_.coordinates),
          .inertial = false,
          .velocity_forces = true,
          .kepler = true,
          .keeps_momentum = forces.keeps_momentum,
          .keeps_angular_momentum = forces.keeps_angular_momentum,
          .steps_at_once = has_tracers() ? steps_of_tracers : 1};
}

template <class Real, class F> void WisdomHolman<Real, F>::bind(ParticleSystem<Real>& s) {
  using std::sqrt;
  const auto& c = std::as_const(s);
  if constexpr (has_forces) bind_force(forces_, s);
  workspace_ = Workspace();
  bind_spins(c);
  g_ = Real(options_.G ? *options_.G : s.units().G);
  const auto n = static_cast<std::size_t>(s.size());
  primary_.keep(c, "wisdom_holman");
  if (!(c.masses()[0] > Real(0))) {
    throw Error(
        fmt::format("'{}' comes first, so it is the primary of wisdom_holman, but its mass is 0; put the most "
                    "massive body first",
                    s.name(0)));
  }
  std::vector<double> axis(n, 0.0);
  double size = 0;
  order_.assign(1, 0);
  masses_.assign(n, c.masses()[0]);
  for (Index i = 1; i < s.size(); ++i) {
    const Real m = c.masses()[i];
    masses_[static_cast<std::size_t>(i)] = m;
    if (m > Real(0) && c.masses()[i - 1] == Real(0)) {
      throw Error(fmt::format("'{}' has mass but comes after the tracer '{}'; put tracers after all massive bodies",
                              s.name(i), s.name(i - 1)));
    }
    const Real r = sqrt(norm2(c.positions()[i] - c.positions()[0]));
    const Real inverse = Real(2) / r - norm2(c.velocities()[i] - c.velocities()[0]) / (g_ * (c.masses()[0] + m));
    // Unbound bodies come last, by distance.
    axis[static_cast<std::size_t>(i)] =
        inverse > Real(0) ? static_cast<double>(Real(1) / inverse) : 1e300 * (1 + static_cast<double>(r));
    if (m > Real(0)) size = std::max(size, static_cast<double>(r));
    order_.push_back(i);
  }
  std::stable_sort(order_.begin() + 1, order_.end(), [&](std::int64_t i, std::int64_t j) {
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    const bool tracer_a = masses_[a] == Real(0), tracer_b = masses_[b] == Real(0);
    if (tracer_a || tracer_b) return !tracer_a && tracer_b;
    return axis[a] < axis[b];
  });
  gather_masses();
  place_within(axis);
  gather_arcs();
  std::vector<double> masses;
  for (const Real& m : masses_) masses.push_back(static_cast<double>(m));
  encounters_.bind(masses, s.ids());
  for (auto* column : {&scratch_, &positions_, &acceleration_, &other_, &along_})
    *column = VectorColumn<Real>(s.size());
  if constexpr (has_forces) inertial_ = s;
  forces_along_.reset();
  if constexpr (has_forces && Force<F, Dual<Real, 1>>) {
    if (jacobi() && has_derivative<Real>(forces_)) forces_along_.emplace(*inertial_);
  }
  pulled_.reset();
  failure_.reset();
  if constexpr (may_have_lanes) {
    planets_ = {.G = g_, .jacobi = jacobi(), .masses = masses_, .bend = {}, .size = size};
    lanes_have_forces_ = forces_in_lanes(c);
    bind_lanes();
  }
}

/// @throws Error  for a body that a fixed point holds, and for torques beside forces that depend on velocities
template <class Real, class F> void WisdomHolman<Real, F>::bind_spins(const ParticleSystem<Real>& s) {
  twists_ = s.bodies() != nullptr;
  torque_ = VectorColumn<Real>(twists_ ? s.size() : 0);
  if (s.bodies() != nullptr && s.bodies()->any_held()) {
    throw Error("a fixed point holds one of the bodies, which cannot be on a Kepler arc; use kinetic_potential");
  }
  if (!twists_ || !velocity_dependent_) return;
  throw Error("a force depends on velocities, which kicks of rigid bodies do not support; take it out");
}

/// What the arcs need of each particle. The mass of the star that a barycentric arc goes round is such that two bodies
/// alone stay on it.
template <class Real, class F> void WisdomHolman<Real, F>::gather_arcs() {
  circled_.assign(order_.size(), Real(0));
  reduced_ = circled_;
  scale_.assign(order_.size(), Real(1));
  const Real star = masses_[0], total = interior_.back();
  for (std::size_t k = 1; k < order_.size(); ++k) {
    const auto i = static_cast<std::size_t>(at(k));
    const Real m = masses_[i];
    circled_[i] = interior_[within(at(k))];
    reduced_[i] = m;
    if (jacobi()) {
      if (k < massive()) reduced_[i] = m * interior_[k - 1] / interior_[k];
    } else if (barycentric()) {
      reduced_[i] = m * total / (total - m);
      scale_[i] = (total - m) / total;
      circled_[i] = star * star / (star + m) * scale_[i];
    } else if (scaled()) {
      reduced_[i] = m * star / (star + m);
      scale_[i] = (star + m) / star;
      circled_[i] = star + m;
    }
  }
}

template <class Real, class F> void WisdomHolman<Real, F>::open(ParticleSystem<Real>& s) {
  if (jacobi()) {
    to_jacobi(s.positions());
    to_jacobi(s.velocities());
  } else if (barycentric()) {
    to_barycentric(s);
  } else {
    to_democratic(s);
  }
  if (scaled()) scale(s.velocities(), false);
  if constexpr (may_have_lanes) {
    if (!observing_) lanes_.forget();
  }
  s.phase().coordinates = static_cast<std::uint8_t>(options_.coordinates);
}

template <class Real, class F> void WisdomHolman<Real, F>::close(ParticleSystem<Real>& s) {
  if (scaled()) scale(s.velocities(), true);
  if (jacobi()) {
    from_jacobi(s.positions(), s.positions(), std::as_const(s).positions()[0]);
    from_jacobi(s.velocities(), s.velocities(), std::as_const(s).velocities()[0]);
  } else if (barycentric()) {
    from_barycentric(s);
  } else {
    from_democratic(s);
  }
  s.phase().coordinates = 0;
}

template <class Real, class F> void WisdomHolman<Real, F>::flow(char letter, ParticleSystem<Real>& s, const Real& h) {
  if constexpr (may_have_lanes) {
    if (lanes_.bound() && letter_in_lanes(letter)) {
      flow_in_lanes(letter, s, h);
      return;
    }
  }
  if (letter == 'A') {
    arcs(s, h, false);
    return;
  }
  if (letter == 'G') {
    gradient_kick(s, h, false);
    return;
  }
  if (letter == 'L') {
    lazy_kick(s, h);
    return;
  }
  if (!jacobi()) jump(s, h / Real(2));
  kick(s, h, false);
  if (!jacobi()) jump(s, h / Real(2));
}

template <class Real, class F>
Real WisdomHolman<Real, F>::flow_with_action(char letter, ParticleSystem<Real>& s, const Real& h) {
  if (letter == 'L') throw LogicError("the letter L has no action");
  if constexpr (may_have_lanes) {
    if (lanes_.bound() && letter_in_lanes(letter)) return action_in_lanes(letter, s, h);
  }
  if (letter == 'A') return arcs(s, h, true);
  if (letter == 'G') return gradient_kick(s, h, true);
  NOETHER_EXPECTS(!velocity_dependent_, "a kick by forces that depend on velocities has no action");
  Real action(0);
  if (!jacobi()) action += jump(s, h / Real(2));
  action += kick(s, h, true);
  if (!jacobi()) action += jump(s, h / Real(2));
  return action;
}

template <class Real, class F> Real WisdomHolman<Real, F>::arcs(ParticleSystem<Real>& s, const Real& h, bool action) {
  using std::sqrt;
  const auto& c = std::as_const(s);
  const Index n = s.size();
  const Vec3<Real> center_v = c.velocities()[0];
  s.shift(0, h * center_v, Vec3<Real>::Zero());
  std::atomic<Index> failed{n};
  const auto advance = [&](Index begin, Index end) {
    Real sum(0);
    for (Index k = std::max<Index>(begin, 1); k < end; ++k) {
      const auto rank = static_cast<std::size_t>(k);
      const Index i = at(rank);
      const Real mu = g_ * circled_[static_cast<std::size_t>(i)];
      const Vec3<Real> x = c.positions()[i], v = c.velocities()[i];
      const KeplerArc<Real> arc = kepler_arc(x, v, mu, h);
      if (arc.status != KeplerStatus::converged) {
        Index known = failed.load();
        while (i < known && !failed.compare_exchange_weak(known, i)) {
        }
      }
      s.shift(i, arc.dx, arc.dv);
      if (!action || rank >= massive()) continue;
      const Real reduced = reduced_[static_cast<std::size_t>(i)];
      sum += reduced * (h * (norm2(v) / Real(2) - mu / sqrt(norm2(x))) + Real(2) * mu * arc.s);
    }
    return sum;
  };
  Real sum(0);
  if (action) {
    sum = reduce(n, Real(0), advance) + h * interior_.back() * norm2(center_v) / Real(2);
  } else {
    for_blocks(n, [&](Index begin, Index end) { advance(begin, end); });
  }
  s.moved();
  if (observing_) return sum;
  evaluations_.kepler += n - 1;
  if (const Index i = failed.load(); i < n) fail(s, i);
  return sum;
}

template <class Real, class F> void WisdomHolman<Real, F>::fail(const ParticleSystem<Real>& s, Index i) {
  note_failure(Failure{Outcome::Kind::solver_failure, i, "position",
                       fmt::format("the Kepler solver did not converge for {}", s.name(i))});
}

/// Accelerations of the working velocities at working positions. @return the potential, if wanted
template <class Real, class F>
Real WisdomHolman<Real, F>::accelerate(const VectorColumn<Real>& x, const Clock<Real>& clock, bool energy) {
  if (!observing_) ++evaluations_.force;
  pulled_.reset();
  moment_ = static_cast<double>(clock.time());
  acceleration_.set_zero();
  Real potential(0);
  if (jacobi() || barycentric()) {
    inertial_positions(x, Vec3<Real>::Zero(), positions_);
    potential += interaction(positions_, jacobi(), 0, energy);
  } else {
    potential += interaction(x, false, 1, energy);
  }
  if constexpr (has_forces) potential += velocity_dependent_ ? Real(0) : other_forces(x, clock, energy);
  if (jacobi()) {
    to_jacobi(acceleration_);
    potential += indirect(x, energy);
  } else {
    about_center(acceleration_);
    if (scaled()) scale(acceleration_, false);
    if (barycentric()) potential += without_arcs(x, energy);
  }
  return potential;
}

/// Accelerations by all pairs of massive bodies from particle `first` on, and of tracers by them.
template <class Real, class F>
Real WisdomHolman<Real, F>::interaction(const VectorColumn<Real>& x, bool skip_inner, Index first, bool energy) {
  using std::sqrt;
  Real potential(0);
  const auto bodies = static_cast<Index>(massive());
  const Index inner = skip_inner && bodies > 1 ? at(1) : -1;
  const Vec3<Real> primary = first == 0 ? x[0] : Vec3<Real>(Vec3<Real>::Zero());
  const auto note = [&](Index i, Index j, const Real& r2) {
    const Real nearer2 = std::min(norm2(x[i] - primary), norm2(x[j] - primary));
    if (noting_) encounters_.note(i, j, static_cast<double>(r2), static_cast<double>(nearer2), moment_, backward_);
  };
  for (Index i = first + 1; i < bodies; ++i) {
    const Real from_primary2 = norm2(x[i] - primary);
    for (Index j = first; j < i; ++j) {
      if (j == 0 && i == inner) continue;  // exactly the innermost Kepler arc
      const Vec3<Real> d = x[i] - x[j];
      const Real r2 = norm2(d), r = sqrt(r2);
      if (encounters_.near(i, j, r2, from_primary2)) note(i, j, r2);
      const Real k = g_ / (r2 * r);
      const Real mi = masses_[static_cast<std::size_t>(i)], mj = masses_[static_cast<std::size_t>(j)];
      acceleration_.add(i, -(k * mj) * d);
      acceleration_.add(j, (k * mi) * d);
      if (energy) potential -= g_ * mi * mj / r;
    }
  }
  for_blocks(x.size() - bodies, [&](Index begin, Index end) {
    for (Index i = bodies + begin; i < bodies + end; ++i) {
      Vec3<Real> pull = Vec3<Real>::Zero();
      const Real from_primary2 = norm2(x[i] - primary);
      for (Index j = jacobi() && within(i) == 0 ? 1 : first; j < bodies; ++j) {  // else its arc has done it exactly
        const Vec3<Real> d = x[i] - x[j];
        const Real r2 = norm2(d);
        if (encounters_.near(i, j, r2, from_primary2)) note(i, j, r2);
        pull -= g_ * masses_[static_cast<std::size_t>(j)] / (r2 * sqrt(r2)) * d;
      }
      acceleration_.set(i, pull);
    }
  });
  return potential;
}

/// What the Kepler arcs of Jacobi coordinates have done already: + G M_k x'/r'^3 for all but the innermost.
template <class Real, class F> Real WisdomHolman<Real, F>::indirect(const VectorColumn<Real>& x, bool energy) {
  using std::sqrt;
  Real potential(0);
  if (!has_forces) acceleration_.set(0, Vec3<Real>::Zero());  // inner forces leave the centre of mass alone
  // The innermost arc has moved the primary as well, and tracers within it go round the primary alone.
  Vec3<Real> of_primary = Vec3<Real>::Zero();
  if (massive() > 1) {
    const Vec3<Real> d = x[at(1)];
    const Real r2 = norm2(d);
    of_primary = g_ * masses_[static_cast<std::size_t>(at(1))] / (r2 * sqrt(r2)) * d;
  }
  for (std::size_t k = std::min<std::size_t>(2, massive()); k < order_.size(); ++k) {
    if (within(at(k)) == 0) {
      acceleration_.add(at(k), -of_primary);
      continue;
    }
    const Vec3<Real> d = x[at(k)];
    const Real r2 = norm2(d), r = sqrt(r2);
    const Real mu = g_ * interior_[within(at(k))];
    acceleration_.add(at(k), mu / (r2 * r) * d);
    if (energy && k < massive()) potential += g_ * masses_[static_cast<std::size_t>(at(k))] * interior_[k - 1] / r;
  }
  return potential;
}

/// Accelerations of inertial positions become those of the working velocities, which are relative to the centre of
/// mass, in barycentric coordinates to the primary.
template <class Real, class F> void WisdomHolman<Real, F>::about_center(VectorColumn<Real>& column) const {
  const auto& a = std::as_const(column);
  Vec3<Real> mean = Vec3<Real>::Zero();
  if constexpr (has_forces) {
    for (std::size_t k = 0; k < massive(); ++k) mean += masses_[k] / interior_.back() * a[static_cast<Index>(k)];
  }
  if (barycentric()) {
    const Vec3<Real> of_primary = a[0];
    for (Index i = 1; i < column.size(); ++i) column.add(i, -of_primary);
  } else if constexpr (has_forces) {
    for (Index i = 1; i < column.size(); ++i) column.add(i, -mean);
  }
  column.set(0, mean);
}

/// What the Kepler arcs of barycentric coordinates have done already.
template <class Real, class F> Real WisdomHolman<Real, F>::without_arcs(const VectorColumn<Real>& x, bool energy) {
  using std::sqrt;
  Real potential(0);
  for (Index i = 1; i < x.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Vec3<Real> d = x[i];
    const Real r2 = norm2(d), r = sqrt(r2), mu = g_ * circled_[k];
    acceleration_.add(i, mu / (r2 * r) * d);
    if (energy) potential += reduced_[k] * mu / r;
  }
  return potential;
}

template <class Real, class F>
Real WisdomHolman<Real, F>::other_forces(const VectorColumn<Real>& x, const Clock<Real>& clock, bool energy) {
  inertial_->clock() = clock;
  inertial_positions(x, x[0], inertial_->positions());
  ForceSink<Real> sink(other_, *inertial_, {.energy = energy}, &workspace_);
  if (twists_) sink.set_torques(torque_);
  forces_.add_to(sink, *inertial_);
  note_failure(sink.failure());
  acceleration_.all() += other_.all();
  return sink.potential();
}

/// J = |sum p_i|^2 / 2 m_0 moves every heliocentric position alike; where it is sum_{i<j} p_i p_j / m, m = m_0 or - M,
/// each one by what the others have.
template <class Real, class F> Real WisdomHolman<Real, F>::jump(ParticleSystem<Real>& s, const Real& h) {
  const auto& c = std::as_const(s);
  const Real mass = barycentric() ? -interior_.back() : masses_[0];
  Vec3<Real> momentum = Vec3<Real>::Zero();
  Real own(0);
  for (std::size_t k = 1; k < massive(); ++k) {
    const Vec3<Real> p = reduced_[k] * c.velocities()[static_cast<Index>(k)];
    momentum += p;
    if (scaled()) own += norm2(p);
  }
  const Vec3<Real> shift = h / mass * momentum;
  for (Index i = 1; i < s.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    Vec3<Real> by = shift;
    if (scaled()) by -= h / mass * reduced_[k] * c.velocities()[i];
    s.shift(i, by, Vec3<Real>::Zero());
  }
  s.moved();
  return h * (norm2(momentum) - own) / (Real(2) * mass);
}

template <class Real, class F>
Real WisdomHolman<Real, F>::newton(const ParticleSystem<Real>& s, VectorColumn<Real>& a, Request wanted) {
  if (a.size() != s.size()) a = VectorColumn<Real>(s.size());
  ForceSink<Real> sink(a, s, wanted, &workspace_);
  Gravity{.G = options_.G}.add_to(sink, s);
  forces_.add_to(sink, s);
  return sink.potential();
}

}  // namespace noether
