#pragma once
/// Definitions of integrators/shearing_sheet.hpp; included by it.

#include "integrators/shearing_sheet.hpp"

#include "numbers/parallel.hpp"
#include "numbers/simd_loop.hpp"

#include <algorithm>

namespace noether {

template <class F, class Real> void ShearingSheet<F, Real>::bind(ParticleSystem<Real>& s) {
  forces_act_ = !std::is_same_v<F, Sum<>>;
  if constexpr (requires(const F& f) { f.terms().empty(); }) forces_act_ = !kicks_.forces().terms().empty();
  boxed_ = s.box().is_periodic();
  failure_.reset();
  if (!boxed_) {
    kicks_.bind(s);
  } else if constexpr (knows_boxes) {
    box_.bind(s, rates_, kicks_.forces());
  } else {
    throw Error("shearing sheets in boxes are stepped one system at a time; run these systems one by one");
  }
  if constexpr (std::is_same_v<Real, double>) {
    if (spheres_ && s.clock().dt() < 0)
      throw Error("hard spheres cannot go back in time: what they lose is not known; a step above 0 is expected");
    if (spheres_) spheres_->bind(s, rates_);
  }
}

template <class F, class Real> void ShearingSheet<F, Real>::open(ParticleSystem<Real>& s) {
  if constexpr (knows_boxes) {
    if (boxed_) box_.open(s);
  }
}

template <class F, class Real> const Epicycle<Real>& ShearingSheet<F, Real>::epicycle(const Real& h) {
  if constexpr (remembers) {
    const auto end = known_.begin() + static_cast<std::ptrdiff_t>(count_);
    const auto found = std::find_if(known_.begin(), end, [&](const Known& known) { return known.h == h; });
    if (found != end) return found->epicycle;
  }
  Known& place = known_[next_];
  next_ = (next_ + 1) % known_.size();
  count_ = std::min(count_ + 1, known_.size());
  place = {h, Epicycle<Real>(rates_, h)};
  return place.epicycle;
}

template <class F, class Real>
void ShearingSheet<F, Real>::move(ParticleSystem<Real>& s, const Epicycle<Real>& epicycle) {
  kicks_.note_move();
  if constexpr (std::is_same_v<Real, double>) {
    if (s.low_words() == nullptr && !epicycle.turns()) {
      auto& x = s.positions();
      auto& v = s.velocities();
      const auto loop = simd_loop<Epicycle<double>::move>();
      for_blocks(s.size(), [&](Index begin, Index end) {
        loop(epicycle, x.component(0), x.component(1), x.component(2), v.component(0), v.component(1), v.component(2),
             begin, end);
      });
      return;
    }
  }
  for (Index i = 0; i < s.size(); ++i) {
    const auto change = epicycle.change(std::as_const(s).positions()[i], std::as_const(s).velocities()[i]);
    s.shift(i, change.x, change.v);
  }
  s.moved();
}

template <class F, class Real> void ShearingSheet<F, Real>::flow(char letter, ParticleSystem<Real>& s, const Real& h) {
  if constexpr (knows_boxes) {
    if (boxed_) {
      if (!observing_) {
        throw Error("in the box of a shearing sheet there are no letters beside A and B; take drag and baths out");
      }
      // What is left of a step for an observer ends at its end.
      return flow_in_box(letter, s, h, s.time());
    }
  }
  if (letter == 'A') return spheres_ ? move_spheres(s, h, h) : move(s, epicycle(h));
  if (forces_act_) kicks_.flow(letter, s, h);
}

template <class F, class Real>
void ShearingSheet<F, Real>::flow_in_box(char letter, ParticleSystem<Real>& s, const Real& h, const Real& end) {
  if constexpr (knows_boxes) {
    if (letter == 'A') return spheres_ ? move_spheres(s, h, end) : box_.move(s, epicycle(h), end);
    box_.kick(s, h);
    if (!observing_ && forces_act_) ++evaluations_;
  }
}

template <class F, class Real>
void ShearingSheet<F, Real>::move_to(ParticleSystem<Real>& s, const Epicycle<Real>& epicycle, const Real& end) {
  if constexpr (knows_boxes) {
    if (boxed_) return box_.move(s, epicycle, end);
  }
  move(s, epicycle);
}

template <class F, class Real>
void ShearingSheet<F, Real>::move_spheres(ParticleSystem<Real>& s, const Real& h, const Real& end) {
  if constexpr (std::is_same_v<Real, double>) {
    spheres_->begin(s);
    double left = h;
    const char* broken = nullptr;
    for (int windows = 0; left > 0 && broken == nullptr; ++windows) {
      const double window = spheres_->find(s, left, boxed_ ? 1.5 * rates_.Omega * (end - left) : 0.0);
      const double after = window == left ? 0.0 : left - window;
      move_to(s, window == h ? epicycle(h) : Epicycle<double>::plain(rates_, window), end - after);
      spheres_->put(s);
      left = after;
      if (spheres_->piles_up()) {
        broken =
            "spheres pile up: they touch more than 1000 times each in one flow; give a larger minimum_rebound or a "
            "smaller step";
      } else if (windows == SphereContacts::most_windows) {
        broken =
            "spheres are so fast that contacts are looked for more than 10000 times in one flow; give a smaller step";
      }
    }
    if (broken == nullptr) return;
    if (!observing_) failure_ = Failure{Outcome::Kind::solver_failure, -1, "velocity", broken};
    if (left > 0) move_to(s, Epicycle<double>::plain(rates_, left), end);
  }
}

template <class F, class Real>
Advance ShearingSheet<F, Real>::run_free(const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span) {
  const Real dt(s.clock().dt());
  Advance done;
  while (done.steps < span.steps) {
    word.step(s.phase(), [&](char letter, const Real& weight, const Real& /*nothing acts*/) {
      if (letter != 'A') return;
      const Epicycle<Real>& next = epicycle(Real(weight * dt));
      if (next.turns() || waiting_ == arcs_.size()) move_all(s);
      if (next.turns()) return move(s, next);
      arcs_[waiting_++] = next;
    });
    s.clock().tick(Real(0));
    ++done.steps;
    if (span.asked_to_stop()) break;
  }
  move_all(s);
  return done;
}

template <class F, class Real> void ShearingSheet<F, Real>::move_all(ParticleSystem<Real>& s) {
  const std::size_t count = std::exchange(waiting_, 0);
  if (count == 0) return;
  kicks_.note_move();
  auto &x = s.positions(), &v = s.velocities();
  const auto move = simd_loop<Epicycle<Real>::move>();
  for_blocks(s.size(), [&](Index begin, Index end) {
    for (std::size_t k = 0; k < count; ++k) {
      move(arcs_[k], x.component(0), x.component(1), x.component(2), v.component(0), v.component(1), v.component(2),
           begin, end);
    }
  });
}

template <class F, class Real>
Advance ShearingSheet<F, Real>::run(const TimedWord<Real>& word, ParticleSystem<Real>& s, const Span& span) {
  if constexpr (in_blocks) {
    if (!boxed_ && !forces_act_ && !spheres_ && s.low_words() == nullptr) return run_free(word, s, span);
  }
  if (!boxed_) return walk_letters(*this, word, s, span, [&](char letter, const Real& h) { flow(letter, s, h); });
  const Real dt(s.clock().dt()), first = word.stages().front().weight;
  std::int64_t step = s.clock().step() - 1;
  return walk_letters(*this, word, s, span, [&](char letter, const Real& h) {
    const bool begins = std::exchange(step, s.clock().step()) != s.clock().step();
    flow_in_box(letter, s, h, Real(s.time() + (begins ? Real(first * dt) : h)));
  });
}

template <class F, class Real>
Real ShearingSheet<F, Real>::flow_with_action(char letter, ParticleSystem<Real>& s, const Real& h) {
  if (boxed_ || spheres_) throw LogicError("a sheet in a box, or of hard spheres, has no action");
  if (letter != 'A') return forces_act_ ? kicks_.flow_with_action(letter, s, h) : Real(0);
  const Epicycle<Real>& epicycle = this->epicycle(h);
  const Real rate = Real(2) * Real(rates_.Omega);
  // H is quadratic in q and p, and v_y + 2 Omega x stays.
  const Real action = sum_over<Real>(s.size(), [&](Index i) {
    const Vec3<Real> x = std::as_const(s).positions()[i], v = std::as_const(s).velocities()[i];
    const auto change = epicycle.change(x, v);
    const Vec3<Real> p(v[0] + change.v[0], v[1] + rate * x[0], v[2] + change.v[2]);
    const Real gain = dot(p, change.x) + (change.v[0] * x[0] + change.v[2] * x[2]);
    return Real(s.masses()[i] * gain / Real(2));
  });
  move(s, epicycle);
  return action;
}

template <class F, class Real> void ShearingSheet<F, Real>::close(ParticleSystem<Real>& s) {
  if constexpr (knows_boxes) {
    if (boxed_) return box_.close(s);
  }
  if (!shows_momenta_) return;
  const Real rate = Real(2) * Real(rates_.Omega);
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<Real> x = std::as_const(s).positions()[i];
    s.velocities().add(i, Vec3<Real>(Real(0), rate * x[0], Real(0)));
  }
}

template <class F, class Real> EnergyTerms<Real> ShearingSheet<F, Real>::energy(const ParticleSystem<Real>& s) {
  EnergyTerms<Real> energy;
  if constexpr (knows_boxes) {
    if (boxed_) energy = {kinetic_energy(s), box_.potential(s)};
  }
  if (!boxed_) energy = kicks_.energy(s);
  energy.potential +=
      sum_over<Real>(s.size(), [&](Index i) { return Real(s.masses()[i] * frame_.potential(s.unwrapped(i))); });
  return energy;
}

template <class F, class Real>
void ShearingSheet<F, Real>::accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
  if constexpr (knows_boxes) {
    if (boxed_) box_.accelerations(s, a);
  }
  if (!boxed_) kicks_.accelerations(s, a);
  for (Index i = 0; i < s.size(); ++i) a.add(i, frame_.acceleration(s.unwrapped(i), Vec3<Real>(s.velocities()[i])));
}

}  // namespace noether
