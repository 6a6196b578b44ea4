#pragma once
/// The sites of rigid bodies as particles of their own.

#include "engine/bodies.hpp"
#include "engine/force_sink.hpp"

#include <vector>

namespace noether {

/// The sites of bodies and the points beside them as particles of their own, in the order of the particles. Pairs
/// within a body are excluded; its sites are one molecule.
template <class Real> class Sites {
 public:
  Sites() = default;
  /// @throws Error  for a bond of a body: what it is made of holds together without
  /// @param pairs  whether pairs within a body are listed as excluded, and types and bonds kept: not for gravity
  explicit Sites(const ParticleSystem<Real>& s, bool pairs = true);

  /// Places the sites where the bodies are, at their stage time.
  void follow(const ParticleSystem<Real>& s);
  /// Adds force and torque on every body, of accelerations `a` of the sites, to a sink of the bodies; the virial
  /// becomes that of the centres.
  /// @param virial  of the sites [energy]
  void gather(const VectorColumn<Real>& a, const Mat3<Real>& virial, ForceSink<Real>& out,
              const ParticleSystem<Real>& s) const;

  const ParticleSystem<Real>& particles() const { return particles_; }
  /// The first site of particle `i`; that of one behind the last is how many there are.
  Index first(Index i) const { return first_[static_cast<std::size_t>(i)]; }
  /// From the centre of its body to site `a`, in space [length].
  Vec3<Real> arm(Index a) const { return arms_[a]; }

 private:
  ParticleSystem<Real> particles_;
  VectorColumn<Real> places_;  ///< of sites in their bodies [length]
  VectorColumn<Real> arms_;    ///< the same in space
  std::vector<Index> first_;
};

extern template class Sites<double>;
extern template class Sites<Quad>;

}  // namespace noether
