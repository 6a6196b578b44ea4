#include "constraints/constraint_equations.hpp"

#include "numbers/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace noether {

namespace {

/// What the rounding of a particle's coordinates is relative to [length].
template <class Real> Vec3<Real> size_of_position(const ParticleSystem<Real>& s, Index i, bool differences_only) {
  using std::abs;
  const Vec3<double>& edges = s.box().edges();
  const Vec3<Real> x = s.unwrapped(i);
  Vec3<Real> size;
  for (Index k = 0; k < 3; ++k) {
    const Real edge(edges[k]), far = abs(x[k]);
    size[k] = edge > far || (s.box().is_periodic() && differences_only) ? edge : far;
  }
  return size;
}

}  // namespace

// ---- laying out ----------------------------------------------------------------------------------------------------

template <class Real> void ConstraintEquations<Real>::lay_out(const ParticleSystem<Real>& s) {
  failure_.reset();
  known_.reset();
  layout_ = {};
  layout_.first.push_back(0);
  scales_.clear();
  set_.find(s.ids());
  for (const auto& group : set_.groups()) {
    for (Index c = 0; c < group->size(); ++c) {
      for (Index e = 0; e < group->equations(); ++e) {
        for (Index k = 0; k < group->particles(); ++k) {
          const Index i = group->particle(c, k);
          if (i >= s.size() || !(s.masses()[i] > Real(0))) {
            throw BadConstraints(fmt::format("{} has no mass, but constraint '{}' ties it; give it a mass",
                                             i < s.size() ? "'" + s.name(i) + "'" : fmt::format("particle {}", i),
                                             group->name()));
          }
          layout_.particle.push_back(i);
          layout_.inverse_mass.push_back(Real(1) / s.masses()[i]);
        }
        layout_.first.push_back(static_cast<Index>(layout_.particle.size()));
        scales_.push_back(group->scale(c));
        if (!(scales_.back() > 0)) {
          throw BadConstraints(fmt::format("the scale of {} is {}; a number above 0 is expected",
                                           set_.words(static_cast<Index>(scales_.size()) - 1, s), scales_.back()));
        }
      }
    }
  }
  matrix_.lay_out(layout_);
  find_ties();
  const std::size_t entries = layout_.particle.size(), n = at(layout_.equations());
  for (ConstraintGradients<Real>* g : {&here_, &old_}) g->assign(entries, Vec3<Real>::Zero());
  g_.setZero(static_cast<Index>(n));
  lambda_.setZero(static_cast<Index>(n));
  floors_.assign(n, 0);
  masses_ = s.masses();
  check_reach(s);
  start_ = moved_ = s.box().is_periodic() ? VectorColumn<Real>(s.size()) : s.positions();
}

template <class Real> void ConstraintEquations<Real>::find_ties() {
  std::vector<std::pair<Index, Index>> ties;  // particle and entry
  for (Index a = 0; a < static_cast<Index>(layout_.particle.size()); ++a) ties.emplace_back(layout_.particle[at(a)], a);
  std::sort(ties.begin(), ties.end());
  std::vector<Index> equation_of(ties.size());
  for (Index e = 0; e < layout_.equations(); ++e) {
    for (Index a = layout_.first[at(e)]; a < layout_.first[at(e) + 1]; ++a) equation_of[at(a)] = e;
  }
  for (std::vector<Index>* list : {&tied_, &first_tie_, &tie_entry_, &tie_equation_}) list->clear();
  for (const auto& [particle, entry] : ties) {
    if (tied_.empty() || tied_.back() != particle) {
      tied_.push_back(particle);
      first_tie_.push_back(static_cast<Index>(tie_entry_.size()));
    }
    tie_entry_.push_back(entry);
    tie_equation_.push_back(equation_of[at(entry)]);
  }
  first_tie_.push_back(static_cast<Index>(tie_entry_.size()));
}

/// From half of an edge on another image may be as near as the one that is meant.
template <class Real> void ConstraintEquations<Real>::check_reach(const ParticleSystem<Real>& s) const {
  if (!s.box().is_periodic()) return;
  const double half = s.box().edges().minCoeff() / 2;
  Index equation = 0;
  for (const auto& group : set_.groups()) {
    for (Index c = 0; c < group->size(); ++c, equation += group->equations()) {
      if (group->reach(c) < half) continue;
      throw BadConstraints(
          fmt::format("{}, {:.6g} apart, reaches half of an edge of the periodic box, {:.6g}: the nearest images would "
                      "no longer be the tied ones; enlarge the box",
                      set_.words(equation, s), group->reach(c), half));
    }
  }
}

// ---- gradients, values, floors --------------------------------------------------------------------------------------

template <class Real> bool ConstraintEquations<Real>::know(const ParticleSystem<Real>& s) {
  if (known_ && *known_ == s.version()) return false;
  find_gradients(Positions(s), here_);
  known_ = s.version();
  matrix_.forget_factors();
  return true;
}

template <class Real>
void ConstraintEquations<Real>::find_gradients(const Positions& x, ConstraintGradients<Real>& out) const {
  Vec3<Real>* next = out.data();
  for (const auto& group : set_.groups()) {
    const Index each = group->equations() * group->particles();
    for_blocks(group->size(), [&](Index begin, Index end) { group->gradients(x, begin, end, next + begin * each); });
    next += group->size() * each;
  }
}

template <class Real> void ConstraintEquations<Real>::find_values(const Positions& x) {
  Real* next = g_.data();
  for (const auto& group : set_.groups()) {
    const Index each = group->equations();
    for_blocks(group->size(), [&](Index begin, Index end) { group->values(x, begin, end, next + begin * each); });
    next += group->size() * each;
  }
}

/// What rounding leaves of g: positions are stored to half an ulp, in a periodic box to that of its edge, and g itself
/// is a difference of numbers of its scale.
template <class Real> void ConstraintEquations<Real>::find_floors(const ParticleSystem<Real>& s) {
  using std::abs;
  const ConstraintGradients<Real>& g = known_ ? here_ : old_;
  for (Index e = 0; const auto& group : set_.groups()) {
    for (const Index end = e + group->size() * group->equations(); e < end; ++e) {
      double sum = 2 * scales_[at(e)];
      for (Index a = layout_.first[at(e)]; a < layout_.first[at(e) + 1]; ++a) {
        const Vec3<Real> size = size_of_position(s, layout_.particle[at(a)], group->keeps_momentum());
        for (Index k = 0; k < 3; ++k) sum += static_cast<double>(abs(g[at(a)][k] * size[k]));
      }
      floors_[at(e)] = unit_roundoff * sum;
    }
  }
}

template <class Real> double ConstraintEquations<Real>::worst(Index* equation) const {
  using std::abs;
  double worst = -1;
  for (Index e = 0; e < layout_.equations(); ++e) {
    const double violation = static_cast<double>(abs(g_[e])) / scales_[at(e)];
    if (violation <= worst) continue;
    worst = violation;
    *equation = e;
    if (!std::isfinite(violation)) break;
  }
  return worst;
}

template <class Real> bool ConstraintEquations<Real>::settled() const {
  using std::abs;
  for (Index e = 0; e < layout_.equations(); ++e) {
    if (!(static_cast<double>(abs(g_[e])) <= floors_[at(e)])) return false;
  }
  return true;
}

// ---- stages --------------------------------------------------------------------------------------------------------

template <class Real>
void ConstraintEquations<Real>::push(VectorColumn<Real>& column, const ConstraintGradients<Real>& g,
                                     const Vector& multipliers, const Real& factor) const {
  // Particle by particle, so that threads share them: each takes what its constraints do in their order.
  for_blocks(static_cast<Index>(tied_.size()), [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      Vec3<Real> sum = column[tied_[at(k)]];
      for (Index tie = first_tie_[at(k)]; tie < first_tie_[at(k) + 1]; ++tie) {
        const std::size_t a = at(tie_entry_[at(tie)]);
        sum += -(layout_.inverse_mass[a] * (factor * multipliers[tie_equation_[at(tie)]])) * g[a];
      }
      column.set(tied_[at(k)], sum);
    }
  });
}

template <class Real>
void ConstraintEquations<Real>::move_to(ParticleSystem<Real>& s, const VectorColumn<Real>& x) const {
  if (!s.box().is_periodic()) {
    s.positions() = x;
    return;
  }
  s.shift_in_box(x);
}

template <class Real> void ConstraintEquations<Real>::round_to_grid(const Box& box, VectorColumn<Real>& x) const {
  if constexpr (std::is_same_v<Real, double>) {
    if (!box.is_periodic()) return;
    for (const Index i : layout_.particle) {
      for (int k = 0; k < 3; ++k) x.component(k)[i] = box.on_grid(k, x.component(k)[i]);
    }
  }
}

template <class Real>
VectorColumn<Real>& ConstraintEquations<Real>::move_freely(ParticleSystem<Real>& s, const Real& h) {
  std::swap(old_, here_);
  known_.reset();
  if (s.box().is_periodic()) {
    moved_ = start_;
    moved_.add_scaled(h, s.velocities());
    return moved_;
  }
  start_ = s.positions();
  s.advance_positions(h);
  return s.positions();
}

template <class Real>
void ConstraintEquations<Real>::arrive(ParticleSystem<Real>& s, const VectorColumn<Real>& x, const Real& h) {
  if (s.box().is_periodic()) move_to(s, x);
  push(s.velocities(), old_, lambda_, Real(1) / h);
  know(s);
}

template <class Real> void ConstraintEquations<Real>::turn_back(ParticleSystem<Real>& s) {
  if (!s.box().is_periodic()) s.positions() = start_;
  known_.reset();
}

template <class Real> bool ConstraintEquations<Real>::on_this_side(Index* equation) const {
  for (Index e = 0; e < layout_.equations(); ++e) {
    Real sum(0);
    for (Index a = layout_.first[at(e)]; a < layout_.first[at(e) + 1]; ++a) {
      sum += layout_.inverse_mass[at(a)] * dot(here_[at(a)], old_[at(a)]);
    }
    if (sum > Real(0)) continue;
    *equation = e;
    return false;
  }
  return true;
}

template <class Real> void ConstraintEquations<Real>::measure(double before, double after, std::int64_t iterations) {
  after = after == 0 ? unit_roundoff : after;
  if (iterations == 0 || !(before > after) || !std::isfinite(before)) return;
  work_.measured += iterations;
  work_.log += std::log(after / before);
}

template <class Real>
void ConstraintEquations<Real>::fail(const ParticleSystem<Real>& s, Index equation, const std::string& what) {
  const ConstraintPlace place = set_.place(equation);
  failure_ = Failure{Outcome::Kind::constraint_failure, place.group->particle(place.constraint, 0), "constraint",
                     set_.words(equation, s) + " " + what};
}

template class ConstraintEquations<double>;
template class ConstraintEquations<Quad>;

}  // namespace noether
