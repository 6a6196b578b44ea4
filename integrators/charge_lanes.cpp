#include "integrators/charge_lanes.hpp"

#include "integrators/charges_simd.hpp"
#include "numbers/parallel.hpp"
#include "numbers/small_angle.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace noether {

namespace {

void turn_one_by_one(const double* angle, double* sine, double* cosine) {
  for (int lane = 0; lane < 8; ++lane) {
    const SineCosine<double> of = sine_cosine(angle[lane]);
    sine[lane] = of.sine;
    cosine[lane] = of.cosine;
  }
}

}  // namespace

bool ChargeLanes::add(const InField<UniformElectromagnetic>& field) {
  fields_.push_back({LaneField::uniform, {field.E[0], field.E[1], field.E[2], field.B[0], field.B[1], field.B[2]}});
  return true;
}
bool ChargeLanes::add(const InField<GradientField>& field) {
  fields_.push_back({LaneField::gradient, {field.B0, field.gradient}});
  return true;
}
bool ChargeLanes::add(const InField<MagneticDipole>& field) {
  fields_.push_back({LaneField::dipole, {field.moment[0], field.moment[1], field.moment[2]}});
  return true;
}
bool ChargeLanes::add(const InField<Tokamak>& field) {
  fields_.push_back({LaneField::tokamak, {field.B0, field.R0, field.safety}});
  return true;
}
bool ChargeLanes::add(const InField<PenningTrap>& field) {
  fields_.push_back({LaneField::penning, {field.B0, field.gradient}});
  return true;
}
bool ChargeLanes::add(const AnyForce<double>& force) {
  const auto is = [&]<class Field>(const InField<Field>* field) { return field != nullptr && add(*field); };
  return is(force.as<InField<UniformElectromagnetic>>()) || is(force.as<InField<GradientField>>()) ||
         is(force.as<InField<MagneticDipole>>()) || is(force.as<InField<Tokamak>>()) ||
         is(force.as<InField<PenningTrap>>());
}

void ChargeLanes::follow(ParticleSystem<double>& s, const std::vector<ChargeLetter>& letters) const {
  const auto other = std::find_if(fields_.begin(), fields_.end(),
                                  [](const LaneFieldNumbers& of) { return of.field != LaneField::uniform; });
  auto &x = s.positions(), &v = s.velocities();
  const ChargeTask task{.x = {x.component(0), x.component(1), x.component(2)},
                        .v = {v.component(0), v.component(1), v.component(2)},
                        .charge = std::as_const(s).column<Charge>().component(0),
                        .mass = std::as_const(s).masses().component(0),
                        .letters = letters.data(),
                        .count = static_cast<std::ptrdiff_t>(letters.size()),
                        .fields = fields_.data(),
                        .field_count = static_cast<std::ptrdiff_t>(fields_.size()),
                        .uniform_count = other - fields_.begin(),
                        .push = push_.push,
                        .cycles = push_.angle.cycles(),
                        .terms = push_.angle.terms(),
                        .tangent = push_.angle.tangent().data(),
                        .c = push_.c,
                        .turn = turn_one_by_one};
  static_assert(block_size <= ChargeKernels::most);
  const ChargeKernels& kernels = charge_kernels();
  for_blocks(s.size(), [&](Index begin, Index end) { kernels.follow(task, begin, end); });
  s.moved();
}

}  // namespace noether
