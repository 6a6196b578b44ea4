#pragma once
/// Definitions of integrators/charged_particles.hpp; included by it.

#include "integrators/charged_particles.hpp"

#include "engine/proper_velocity.hpp"
#include "forces/speed_of_light.hpp"
#include "numbers/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace noether {

template <class F, class Real> void ChargedParticles<F, Real>::bind(ParticleSystem<Real>& s) {
  forces_.bind(s);
  if (!relativistic()) return bind_lanes(s);
  if constexpr (InLanes<Real>) {
    throw Error("relativistic charges are stepped one system at a time; run these systems one by one");
  }
  c_ = speed_of_light_in(s, options_.c, "charged_particles");
  bind_lanes(s);
  if (s.phase().coordinates != 0) return;
  for (Index i = 0; i < s.size(); ++i) {
    const auto v = whole_velocity(s, i);
    if (norm2(v) < c_ * c_) continue;
    throw Error("'" + s.name(i) + "' is as fast as light or faster; speeds below c are expected");
  }
}

template <class F, class Real> void ChargedParticles<F, Real>::bind_lanes(const ParticleSystem<Real>& s) {
  if constexpr (has_lanes) {
    LanePush push = options_.rotation == Rotation::exact ? LanePush::exact : LanePush::cycles;
    if (options_.relativistic == Relativistic::boris) push = LanePush::relativistic_boris;
    if (options_.relativistic == Relativistic::vay) push = LanePush::vay;
    if (options_.relativistic == Relativistic::higuera_cary) push = LanePush::higuera_cary;
    lanes_.bind(forces_.forces(), s, {.push = push, .angle = angle_, .c = c_});
  }
}

template <class F, class Real>
Advance ChargedParticles<F, Real>::run(const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span) {
  if constexpr (has_lanes) {
    if (lanes_.known()) {
      Advance done;
      while (done.steps < span.steps && !(done.steps > 0 && span.asked_to_stop())) {
        const std::int64_t steps = std::min(lanes_.steps_at_once(), span.steps - done.steps);
        letters_.clear();
        for (std::int64_t k = 0; k < steps; ++k) {
          word.step(s.phase(), [&](char letter, const Real& weight, const Real& /*fraction*/) {
            letters_.push_back({letter, weight * s.clock().dt()});
            letter == 'A' ? forces_.note_move() : forces_.count();
          });
          s.clock().tick(Real(0));
        }
        lanes_.follow(s, letters_);
        done.steps += steps;
      }
      return done;
    }
  }
  return walk_letters(*this, word, s, span, [&](char letter, const Real& h) { flow(letter, s, h); });
}

template <class F, class Real> void ChargedParticles<F, Real>::open(ParticleSystem<Real>& s) {
  if (!relativistic()) return;
  using Wide = FastNumber<Real>;
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<Wide> v = whole_velocity(s, i);
    set_whole_velocity<Real>(s, i, gamma_of_velocity(v, Wide(c_)) * v);
  }
  s.phase().coordinates = proper_velocities;
}

template <class F, class Real> void ChargedParticles<F, Real>::close(ParticleSystem<Real>& s) {
  if (!relativistic()) return;
  using std::sqrt;
  using Wide = FastNumber<Real>;
  if constexpr (std::is_same_v<Real, double>) s.keep_low_words(true);
  const Wide c2 = Wide(c_) * Wide(c_);
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<Wide> u = whole_velocity(s, i);
    set_whole_velocity<Real>(s, i, u / Wide(sqrt(Wide(1) + norm2(u) / c2)));
  }
  s.phase().coordinates = 0;
}

template <class F, class Real>
void ChargedParticles<F, Real>::flow(char letter, ParticleSystem<Real>& s, const Real& h) {
  letter == 'A' ? drift(s, h) : kick(s, h);
}

template <class F, class Real> void ChargedParticles<F, Real>::drift(ParticleSystem<Real>& s, const Real& h) {
  if (!observing_) forces_.note_move();
  if (!relativistic()) return s.advance_positions(h);
  using std::sqrt;
  for_blocks(s.size(), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const Vec3<Real> u = std::as_const(s).velocities()[i];
      s.shift(i, Vec3<Real>(h / sqrt(Real(1) + norm2(u) / (c_ * c_)) * u), Vec3<Real>(Vec3<Real>::Zero()));
    }
  });
  s.moved();
}

template <class F, class Real>
Vec3<Real> ChargedParticles<F, Real>::pushed(const Vec3<Real>& u, Index i, const Real& h) const {
  const Vec3<Real> a = forces_.acceleration(i), rate = forces_.rate(i);
  switch (options_.relativistic) {
    case Relativistic::boris:
      return boris_push(u, a, rate, c_, h);
    case Relativistic::vay:
      return vay_push(u, a, rate, c_, h);
    case Relativistic::higuera_cary:
      return higuera_cary_push(u, a, rate, c_, h);
    case Relativistic::no:
      break;
  }
  return turned(u, a, rate, angle_, h);
}

template <class F, class Real> void ChargedParticles<F, Real>::kick(ParticleSystem<Real>& s, const Real& h) {
  forces_.evaluate(s, false);
  const bool compensated = s.low_words() != nullptr;
  for_blocks(s.size(), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const Vec3<Real> v = std::as_const(s).velocities()[i], change = pushed(v, i, h);
      if (compensated) {
        s.shift(i, Vec3<Real>(Vec3<Real>::Zero()), change);
      } else {
        s.velocities().add(i, change);
      }
    }
  });
  if (!observing_) forces_.count();
}

template <class F, class Real> EnergyTerms<Real> ChargedParticles<F, Real>::energy(const ParticleSystem<Real>& s) {
  forces_.evaluate(s, true);
  if (!relativistic()) return {kinetic_energy(s), forces_.potential()};
  using Wide = FastNumber<Real>;
  const Real kinetic = sum_over<Real>(s.size(), [&](Index i) {
    // m c^2 (gamma - 1) without the difference
    const Vec3<Wide> v = whole_velocity(s, i);
    const Wide gamma = gamma_of_velocity(v, Wide(c_)), u2 = gamma * gamma * norm2(v);
    return s.masses()[i] * Real(u2 / (gamma + Wide(1)));
  });
  return {kinetic, forces_.potential()};
}

template <class F, class Real>
void ChargedParticles<F, Real>::accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
  forces_.evaluate(s, false);
  if (a.size() != s.size()) a = VectorColumn<Real>(s.size());
  using Wide = FastNumber<Real>;
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<Real> v = s.velocities()[i];
    Vec3<Real> all = forces_.acceleration(i) + cross(v, forces_.rate(i));
    if (relativistic()) {  // u' = all, v = u/gamma
      const Real gamma(gamma_of_velocity(whole_velocity(s, i), Wide(c_)));
      all = (all - dot(v, all) / (c_ * c_) * v) / gamma;
    }
    a.set(i, all);
  }
}

template <class F, class Real>
void ChargedParticles<F, Real>::save(SavedState& saved, const std::string& prefix) const {
  detail::save_signature(saved, prefix + "charges/", options_);
  forces_.save(saved, prefix);
}

template <class F, class Real>
void ChargedParticles<F, Real>::load(const SavedState& saved, const std::string& prefix) {
  detail::check_signature(saved, prefix + "charges/", options_);
  forces_.load(saved, prefix);
}

}  // namespace noether
