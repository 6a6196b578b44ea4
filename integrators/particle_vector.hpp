#pragma once
/// Particles as one vector y = (x, v): all x, then all y, then all z, then the velocities likewise, shape (6 n).

#include "integrators/vector_field.hpp"

#include <algorithm>

namespace noether::detail {

template <class Real> void gather_particles(const ParticleSystem<Real>& s, Vector<Real>& y) {
  y.resize(6 * s.size());
  for (int k = 0; k < 3; ++k) {
    std::copy_n(s.positions().component(k), s.size(), y.data() + k * s.size());
    std::copy_n(s.velocities().component(k), s.size(), y.data() + (3 + k) * s.size());
  }
}

template <class Real> void scatter_particles(const Vector<Real>& y, ParticleSystem<Real>& s) {
  VectorColumn<Real>&x = s.positions(), &v = s.velocities();
  for (int k = 0; k < 3; ++k) {
    std::copy_n(y.data() + k * s.size(), s.size(), x.component(k));
    std::copy_n(y.data() + (3 + k) * s.size(), s.size(), v.component(k));
  }
}

/// Second words of y, where particles have them.
template <class Real> void gather_low_words(const ParticleSystem<Real>& s, Vector<Real>& low) {
  const auto* words = s.low_words();
  if (words == nullptr) {
    low.setZero();
    return;
  }
  for (int k = 0; k < 3; ++k) {
    std::copy_n(words->x.component(k), s.size(), low.data() + k * s.size());
    std::copy_n(words->v.component(k), s.size(), low.data() + (3 + k) * s.size());
  }
}

template <class Real> void scatter_low_words(const Vector<Real>& low, ParticleSystem<Real>& s) {
  s.keep_low_words(true);
  auto* words = s.low_words();
  for (int k = 0; k < 3; ++k) {
    std::copy_n(low.data() + k * s.size(), s.size(), words->x.component(k));
    std::copy_n(low.data() + (3 + k) * s.size(), s.size(), words->v.component(k));
  }
}

}  // namespace noether::detail
