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

void LaneField::carry(std::size_t changes) {
  by_forces_.emplace(forces_.forces(), one_, velocity_dependent_);
  changes_ = changes;
  u_ = w_ = VectorColumn<Pack>(packs_.size());
}

void LaneField::go_to(double t, const double* q, const double* v) {
  const auto all = static_cast<std::size_t>(part());
  copy_packs(q, numbers_of(packs_.positions()), all);
  if (velocity_dependent_) copy_packs(v, numbers_of(packs_.velocities()), all);
  packs_.clock().set_stage_offset(Pack(t));
}

void LaneField::accelerations(double t, const double* q, const double* v, double* a) {
  of_systems(t, q, v, a);
  const auto next = lanes * static_cast<std::size_t>(part());
  for (std::size_t at = next; at <= changes_ * next; at += next) {
    of_change(t, q, v, q + at, velocity_dependent_ ? v + at : nullptr, a + at);
  }
}

void LaneField::of_systems(double t, const double* q, const double* v, double* a) {
  go_to(t, q, v);
  const std::optional<Failure> failure = forces_.sum(0, packs_, a_);
  if (failure && !failure_) failure_ = failure;
  copy_packs(numbers_of(a_), a, static_cast<std::size_t>(part()));
}

void LaneField::of_change(double t, const double* q, const double* v, const double* dq, const double* dv, double* da) {
  const auto all = static_cast<std::size_t>(part());
  go_to(t, q, v);
  copy_packs(dq, numbers_of(u_), all);
  if (velocity_dependent_) copy_packs(dv, numbers_of(w_), all);
  by_forces_->sum(0, packs_, u_, a_, velocity_dependent_ ? &w_ : nullptr);
  copy_packs(numbers_of(a_), da, all);
}

const ParticleSystem<double>& LaneField::particles(std::size_t lane) {
  for (Index i = 0; i < one_.size(); ++i) one_.masses()[i] = packs_.masses()[i].lane[lane];
  return one_;
}

}  // namespace noether
