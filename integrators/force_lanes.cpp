#include "integrators/force_lanes.hpp"

#include "engine/lane_by_lane.hpp"

#include <utility>

namespace noether::detail {

namespace {

void spread_lane(std::size_t lane, const VectorColumn<Pack>& from, VectorColumn<Pack>& to) {
  for (int k = 0; k < 3; ++k) {
    for (Index i = 0; i < from.size(); ++i) to.component(k)[i] = Pack(from.component(k)[i].lane[lane]);
  }
}

}  // namespace

ForceLanes::ForceLanes(ForceField<double> forces, const ParticleSystem<double>& like)
    : forces_(std::move(forces)), sets_(forces_.claims().sets), one_(like.as<Pack>()), one_a_(like.size()) {
  if (!forces_.has_lanes()) throw Error("a force is written for doubles only, so it has no lanes");
  bind_force(forces_, like);
  one_.clock() = Clock<Pack>::free(0);
}

std::optional<Failure> ForceLanes::sum(char letter, const ParticleSystem<Pack>& s, VectorColumn<Pack>& a) {
  if (careful_ == 0) {
    try {
      return evaluate(letter, s, a);
    } catch (const LanesDiffer&) {
      careful_ = 100;  // giving up costs more than a few evaluations
    }
  }
  --careful_;
  std::optional<Failure> failure;
  for (std::size_t lane = 0; lane < Pack::lanes; ++lane) {
    spread_lane(lane, s.positions(), one_.positions());
    spread_lane(lane, s.velocities(), one_.velocities());
    for (Index i = 0; i < s.size(); ++i) one_.masses()[i] = Pack(s.masses()[i].lane[lane]);
    one_.clock() = s.clock();
    const std::optional<Failure> of_lane = evaluate(letter, one_, one_a_);
    if (of_lane && !failure) failure = of_lane;
    for (int k = 0; k < 3; ++k) {
      for (Index i = 0; i < s.size(); ++i) a.component(k)[i].lane[lane] = one_a_.component(k)[i].lane[0];
    }
  }
  return failure;
}

std::optional<Failure> ForceLanes::evaluate(char letter, const ParticleSystem<Pack>& s, VectorColumn<Pack>& a) {
  ForceSink<Pack> sink = sets_ && letter == 0 ? ForceSink<Pack>::unset(a, s) : ForceSink<Pack>(a, s, {}, &workspace_);
  if (letter != 0) sink.set_kick_letter(letter);
  forces_.add_to(sink, s);
  return sink.failure();
}

}  // namespace noether::detail
