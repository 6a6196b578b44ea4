#pragma once
/// Forces in eight lanes whose branches differ: evaluated again, one lane after the other, with the bits of double.

#include "engine/concepts.hpp"
#include "numbers/pack.hpp"

#include <deque>

namespace noether {

/// The particles of one lane, and the sums that a force found before it began.
///
/// Nobody pays for it before lanes differ: the first evaluation has no such place and is given up; it is done again
/// with one, from the start.
class LaneByLane {
 public:
  /// @param particles, accelerations  of the same system in doubles; their state is overwritten
  /// @param before  columns to keep sums in, one for each sum within a sum
  LaneByLane(ParticleSystem<double>& particles, VectorColumn<double>& accelerations,
             std::deque<VectorColumn<Pack>>& before)
      : particles_(particles), accelerations_(accelerations), before_(before) {}

  /// Adds a force to sums in lanes: at once where its branches agree, else lane by lane.
  template <class F> void add(const F& force, ForceSink<Pack>& out, const ParticleSystem<Pack>& s) {
    if (depth_ == before_.size()) before_.emplace_back();
    VectorColumn<Pack>& before = before_[depth_];
    before.assign(out.a_);
    const WideSum<Pack> energy = out.energy_;
    const std::optional<WideTensor<Pack>> virial = out.virial_;
    const std::optional<Failure> failure = out.failure_;
    ++depth_;
    try {
      force.add_to(out, s);
      --depth_;
    } catch (const LanesDiffer&) {
      --depth_;
      out.failure_ = failure;
      for (std::size_t lane = 0; lane < Pack::lanes; ++lane) add_one(lane, force, out, s, before, energy, virial);
    }
  }

 private:
  template <class F>
  void add_one(std::size_t lane, const F& force, ForceSink<Pack>& out, const ParticleSystem<Pack>& s,
               const VectorColumn<Pack>& before, const WideSum<Pack>& energy,
               const std::optional<WideTensor<Pack>>& virial) {
    take(lane, s.positions(), particles_.positions());
    take(lane, s.velocities(), particles_.velocities());
    particles_.clock().set_stage_offset(s.time().lane[lane]);
    ForceSink<double> one(accelerations_, particles_, out.wanted_);
    take(lane, before, accelerations_);
    one.energy_ = energy.lane(lane);
    if (virial) one.virial_ = virial->lane(lane);
    force.add_to(one, particles_);
    for (int k = 0; k < 3; ++k) {
      for (Index i = 0; i < before.size(); ++i) out.a_.component(k)[i].lane[lane] = accelerations_.component(k)[i];
    }
    out.energy_.set_lane(lane, one.energy_);
    if (virial) out.virial_->set_lane(lane, *one.virial_);
    if (one.failure_) out.fail(*one.failure_);
  }
  static void take(std::size_t lane, const VectorColumn<Pack>& from, VectorColumn<double>& to) {
    for (int k = 0; k < 3; ++k) {
      for (Index i = 0; i < to.size(); ++i) to.component(k)[i] = from.component(k)[i].lane[lane];
    }
  }

  ParticleSystem<double>& particles_;
  VectorColumn<double>& accelerations_;
  std::deque<VectorColumn<Pack>>& before_;
  std::size_t depth_ = 0;  ///< of the sum that is being added to
};

/// Adds a force to sums in lanes, as every sum of forces does with each of its terms.
/// @throws LanesDiffer  where its branches differ and the sink has no place to go lane by lane
template <class F> void add_in_lanes(const F& force, ForceSink<Pack>& out, const ParticleSystem<Pack>& s) {
  if constexpr (Force<F, double>) {
    if (out.lane_by_lane() != nullptr) return out.lane_by_lane()->add(force, out, s);
  }
  force.add_to(out, s);
}

}  // namespace noether
