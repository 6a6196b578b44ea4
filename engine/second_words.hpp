#pragma once
/// Second words of particles through an edit.

#include "engine/particle_system.hpp"

#include <cstddef>
#include <cstdint>
#include <unordered_map>

namespace noether {

namespace detail {

/// Gives particles the second words that they had before they were edited; a position or velocity that was changed has
/// none, and so do new particles.
/// @param before  as they were, with the second words
/// @param s  with second words, which are 0
template <class Real> void keep_second_words(const ParticleSystem<Real>& before, ParticleSystem<Real>& s) {
  const auto* old = before.low_words();
  auto* low = s.low_words();
  if (old == nullptr || low == nullptr) return;
  std::unordered_map<std::int64_t, Index> place;
  for (Index i = 0; i < before.size(); ++i) place.emplace(before.ids()[static_cast<std::size_t>(i)], i);
  for (Index i = 0; i < s.size(); ++i) {
    const auto found = place.find(s.ids()[static_cast<std::size_t>(i)]);
    if (found == place.end()) continue;
    const Index was = found->second;
    const Vec3<Real> x = s.positions()[i], v = s.velocities()[i], old_x = before.positions()[was],
                     old_v = before.velocities()[was];
    if (x == old_x) low->x.set(i, old->x[was]);
    if (v == old_v) low->v.set(i, old->v[was]);
  }
}

}  // namespace detail

}  // namespace noether
