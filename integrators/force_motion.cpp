#include "integrators/force_motion.hpp"

namespace noether {

namespace detail {

namespace {

/// Particles in 113 bits, as their two words have them.
ParticleSystem<Quad> widened(const ParticleSystem<double>& s, const ParticleSystem<double>::LowWords& low) {
  ParticleSystem<Quad> wide = s.as<Quad>();
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> x = low.x[i], v = low.v[i];
    wide.shift(i, x.cast<Quad>(), v.cast<Quad>());
  }
  wide.moved();
  wide.clock() = Clock<Quad>::free(0);
  wide.clock().set_stage_offset(Quad(s.time()));
  return wide;
}

}  // namespace

std::optional<EnergyTerms<Quad>> wide_energy(const std::vector<AnyForce<double>>& forces,
                                             const ParticleSystem<double>& s) {
  if (s.low_words() == nullptr) return {};
  ForceField<Quad> wide_forces;
  for (const AnyForce<double>& force : forces) {
    auto wide = force.in_quad();
    if (!wide) return {};
    wide_forces.add(*std::move(wide));
  }
  const ParticleSystem<Quad> wide = widened(s, *s.low_words());
  bind_force(wide_forces, wide);
  Workspace workspace;
  workspace.put(NeighborList(wide_forces.claims().range));
  VectorColumn<Quad> a(wide.size());
  ForceSink<Quad> sink(a, wide, {.energy = true}, &workspace);
  wide_forces.add_to(sink, wide);
  return EnergyTerms<Quad>{kinetic_energy(wide), sink.potential()};
}

}  // namespace detail

template class ForceMotion<ForceField<double>, double>;
template class ForceMotion<ForceField<Quad>, Quad>;

}  // namespace noether
