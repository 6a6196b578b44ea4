#include "integrators/lane_field.hpp"

#include <utility>

namespace noether {

namespace {

/// Packs are not padded: a column holds q in its order.
double* numbers_of(VectorColumn<Pack>& column) { return column.component(0)->lane.data(); }

}  // namespace

LaneField::LaneField(ForceField<double> forces, const ParticleSystem<double>& like)
    : forces_(std::move(forces), like),
      one_(like),
      packs_(like.as<Pack>()),
      a_(like.size()),
      velocity_dependent_(forces_.forces().claims().velocity_dependent) {
  packs_.trim();
  packs_.clock() = Clock<Pack>::free(0);
}

void LaneField::put_masses(std::size_t lane, const ParticleSystem<double>& s) {
  for (Index i = 0; i < s.size(); ++i) packs_.masses()[i].lane[lane] = s.masses()[i];
}

void LaneField::copy_masses(std::size_t from, std::size_t to) {
  for (Index i = 0; i < packs_.size(); ++i) packs_.masses()[i].lane[to] = packs_.masses()[i].lane[from];
}

void LaneField::go_back() {
  packs_.masses().assign(kept_);
  failure_.reset();
}

void LaneField::accelerations(double t, const double* q, const double* v, double* a) {
  const auto all = static_cast<std::size_t>(size());
  copy_packs(q, numbers_of(packs_.positions()), all);
  if (velocity_dependent_) copy_packs(v, numbers_of(packs_.velocities()), all);
  packs_.clock().set_stage_offset(Pack(t));
  const std::optional<Failure> failure = forces_.sum(0, packs_, a_);
  if (failure && !failure_) failure_ = failure;
  copy_packs(numbers_of(a_), a, all);
}

const ParticleSystem<double>& LaneField::particles(std::size_t lane) {
  for (Index i = 0; i < one_.size(); ++i) one_.masses()[i] = packs_.masses()[i].lane[lane];
  return one_;
}

}  // namespace noether
