#include "integrators/force_motion.hpp"

namespace noether {

namespace detail {

namespace {

/// Puts particles in 113 bits to where their two words are.
void take_words(const ParticleSystem<double>& s, const ParticleSystem<double>::LowWords& low,
                ParticleSystem<Quad>& wide) {
  for (int k = 0; k < 3; ++k) {
    Quad *const x = wide.positions().component(k), *const v = wide.velocities().component(k);
    for (Index i = 0; i < s.size(); ++i) {
      x[i] = Quad(s.positions().component(k)[i]) + Quad(low.x.component(k)[i]);
      v[i] = Quad(s.velocities().component(k)[i]) + Quad(low.v.component(k)[i]);
    }
  }
  wide.moved();
  wide.clock().set_stage_offset(Quad(s.time()));
}

}  // namespace

std::optional<EnergyTerms<Quad>> WideEnergy::of(const ParticleSystem<double>& s) {
  if (!serves_) return {};
  ParticleSystem<Quad>& wide = *particles_;
  take_words(s, *s.low_words(), wide);
  ForceSink<Quad> sink(a_, wide, {.energy = true}, &workspace_);
  forces_.add_to(sink, wide);
  return EnergyTerms<Quad>{kinetic_energy(wide), sink.potential()};
}

void WideEnergy::begin(const std::vector<AnyForce<double>>& forces, const ParticleSystem<double>& s) {
  particles_ = s.as<Quad>();
  particles_->clock() = Clock<Quad>::free(0);
  for (const AnyForce<double>& force : forces) {
    auto wide = force.in_quad();
    if (!wide) return;
    forces_.add(*std::move(wide));
  }
  bind_force(forces_, *particles_);
  workspace_.put(NeighborList(forces_.claims().range));
  a_ = VectorColumn<Quad>(s.size());
  serves_ = true;
}

}  // namespace detail

template class ForceMotion<ForceField<double>, double>;
template class ForceMotion<ForceField<Quad>, Quad>;

}  // namespace noether
