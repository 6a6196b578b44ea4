#include "engine/moments.hpp"

#include "engine/moments_simd.hpp"

#include "engine/sums.hpp"

#include <array>

namespace noether {

namespace {

WeightedVectors weighted_vectors(const ParticleSystem<double>& s, const VectorColumn<double>& of) {
  return {s.size(), s.masses().data(), {of.component(0), of.component(1), of.component(2)}};
}

/// Sum of the vectors that `of(i)` gives.
template <class Of> Vec3<Quad> vector_sum(Index n, const Of& of) {
  const auto row = [&](Index i) {
    const Vec3<Quad> v = of(i);
    return std::array{v[0], v[1], v[2]};
  };
  const auto [x, y, z] = sums_over<Quad, 3>(n, row);
  return Vec3<Quad>(x, y, z);
}

template <class Real> auto weighted_unwrapped(const ParticleSystem<Real>& s) {
  if (!s.box().is_periodic()) return weighted_sum(s, s.positions());
  VectorColumn<Real> unwrapped(s.size());
  for (Index i = 0; i < s.size(); ++i) unwrapped.set(i, s.unwrapped(i));
  return weighted_sum(s, unwrapped);
}

}  // namespace

WideSums weighted_sum(const ParticleSystem<double>& s, const VectorColumn<double>& of) {
  WideSums sums{};
  moment_kernels().weighted(weighted_vectors(s, of), sums);
  return sums;
}
Vec3<Quad> weighted_sum(const ParticleSystem<Quad>& s, const VectorColumn<Quad>& of) {
  return vector_sum(s.size(), [&](Index i) { return Vec3<Quad>(s.masses()[i] * of[i]); });
}

WideSums weighted_positions(const ParticleSystem<double>& s) { return weighted_unwrapped(s); }
Vec3<Quad> weighted_positions(const ParticleSystem<Quad>& s) { return weighted_unwrapped(s); }

WideSums angular_momentum(const ParticleSystem<double>& s) {
  const VectorColumn<double>& x = s.positions();
  WideSums sums{};
  moment_kernels().crossed(weighted_vectors(s, s.velocities()), {x.component(0), x.component(1), x.component(2)}, sums);
  return sums;
}
Vec3<Quad> angular_momentum(const ParticleSystem<Quad>& s) {
  return vector_sum(s.size(), [&](Index i) {
    return Vec3<Quad>(s.masses()[i] * cross(Vec3<Quad>(s.positions()[i]), Vec3<Quad>(s.velocities()[i])));
  });
}

}  // namespace noether
