#pragma once
/// The sites of rigid bodies as particles of their own.

#include "engine/bodies.hpp"
#include "engine/force_sink.hpp"
#include "numbers/pack.hpp"

#include <cstdint>
#include <memory>
#include <optional>
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
  /// Consecutive particles of one kind.
  struct Run {
    const BodyKind* kind;  ///< null: points
    Index begin, end;
    std::vector<double> places;  ///< of the sites of a body, three numbers each
  };

  void place(const Run& run, Index begin, Index end, const ParticleSystem<Real>& s,
             const RowColumn<Real, 4>& orientation, VectorColumn<Real>& to);

  ParticleSystem<Real> particles_;
  std::shared_ptr<const Bodies> bodies_;
  VectorColumn<Real> arms_;  ///< of sites, from the centres of their bodies, in space [length]
  std::vector<Index> first_;
  std::vector<Run> runs_;
};

/// The sites of the same particles from one evaluation of forces to the next.
template <class Real> class KeptSites {
 public:
  /// Places the sites where the bodies are. @return whether they are new: the first ones, or those of other particles
  bool follow(const ParticleSystem<Real>& s, bool pairs = true) {
    const bool is_new = !sites_ || members_ != s.members();
    if (is_new) sites_.emplace(s, pairs);
    if (!is_new) sites_->follow(s);
    members_ = s.members();
    return is_new;
  }
  const Sites<Real>& operator*() const { return *sites_; }
  const Sites<Real>* operator->() const { return &*sites_; }

 private:
  std::optional<Sites<Real>> sites_;
  std::uint64_t members_ = 0;
};

extern template class Sites<double>;
extern template class Sites<Quad>;
extern template class Sites<Pack>;
extern template class Sites<Dual<double, 1>>;
extern template class Sites<Dual<Quad, 1>>;

}  // namespace noether
