#include "integrators/kicked_changes.hpp"

#include "forces/gravity_changes_simd.hpp"

namespace noether::detail {

namespace {

void take_lane(std::size_t lane, const VectorColumn<Pack>& from, VectorColumn<double>& to) {
  for (int c = 0; c < 3; ++c) {
    for (Index i = 0; i < from.size(); ++i) to.component(c)[i] = from.component(c)[i].lane[lane];
  }
}

}  // namespace

LaneSlopes::LaneSlopes(const ForceField<double>& forces, const ParticleSystem<double>& like, bool velocities)
    : slopes_(forces, like, velocities),
      x_(like.size()),
      u_(like.size()),
      v_(like.size()),
      w_(like.size()),
      a_(like.size()) {}

const VectorColumn<Pack>& LaneSlopes::sum(char letter, const ParticleSystem<Pack>& s, const VectorColumn<Pack>& u,
                                          const VectorColumn<Pack>* w) {
  for (std::size_t lane = 0; lane < Pack::lanes; ++lane) {
    take_lane(lane, s.positions(), x_);
    take_lane(lane, u, u_);
    if (w != nullptr) {
      take_lane(lane, s.velocities(), v_);
      take_lane(lane, *w, w_);
    }
    slopes_.set_masses([&](Index i) { return s.masses()[i].lane[lane]; });
    const auto& a = slopes_.sum(letter, s.time().lane[0], x_, u_, w != nullptr ? &v_ : nullptr, &w_);
    for (int c = 0; c < 3; ++c) {
      for (Index i = 0; i < s.size(); ++i) a_.component(c)[i].lane[lane] = a.component(c)[i].slope[0];
    }
  }
  return a_;
}

KickedChanges::KickedChanges(const ForceField<double>& forces, const ParticleSystem<double>& like, bool velocities)
    : others_(others_of(forces), like, velocities) {
  for (const AnyForce<double>& force : forces.terms()) {
    if (const Gravity* gravity = force.as<Gravity>())
      gravity_.push_back({gravity->constant(like), gravity->softening, force.claims().kicks});
  }
}

ForceField<double> KickedChanges::others_of(const ForceField<double>& forces) {
  ForceField<double> others;
  for (const AnyForce<double>& force : forces.terms()) {
    if (force.as<Gravity>() == nullptr) others.add(force);
  }
  return others;
}

void KickedChanges::sum(char letter, const ParticleSystem<Pack>& s, const VectorColumn<Pack>& u, VectorColumn<Pack>& a,
                        const VectorColumn<Pack>* w) {
  if (others_.any()) {
    a.assign(others_.sum(letter, s, u, w));
  } else {
    a.set_zero();
  }
  const auto numbers = [](auto* packs) { return packs->lane.data(); };
  const VectorColumn<Pack>& x = s.positions();
  for (const Attraction& one : gravity_) {
    if (letter != 0 && one.kicks.find(letter) == std::string::npos) continue;
    attract_changes()(
        {numbers(x.component(0)), numbers(x.component(1)), numbers(x.component(2)), numbers(s.masses().data()),
         numbers(u.component(0)), numbers(u.component(1)), numbers(u.component(2)), numbers(a.component(0)),
         numbers(a.component(1)), numbers(a.component(2)), s.size()},
        one.G, one.softening * one.softening);
  }
}

}  // namespace noether::detail
