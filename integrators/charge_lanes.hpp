#pragma once
/// Charges in fields of closed forms side by side in lanes, many steps at a time.

#include "engine/any_force.hpp"
#include "engine/particle_system.hpp"
#include "forces/electromagnetic_fields.hpp"
#include "forces/sum.hpp"
#include "integrators/charge_row.hpp"
#include "integrators/gyration.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace noether {

/// Charges that feel nothing but fields do not feel each other: 64 of them make many steps while they are in the cache,
/// then the next 64. The bits are those of all charges letter by letter: they do not depend on how many steps that are,
/// on which charges are side by side, or on threads.
class ChargeLanes {
 public:
  /// How charges are pushed.
  struct Push {
    LanePush push = LanePush::exact;
    GyrationAngle<double> angle = {};  ///< of `LanePush::cycles`
    double c = 0;                      ///< of relativistic pushes
  };

  /// Takes over the fields, and charges and masses when they move.
  /// @return whether lanes know all of these forces, and the particles stand in no box and keep no low words
  template <class F> bool bind(const F& forces, const ParticleSystem<double>& s, const Push& push) {
    fields_.clear();
    known_ = !s.box().is_periodic() && s.low_words() == nullptr && add_all(forces) && !fields_.empty();
    push_ = push;
    steps_at_once_ = known_ ? std::clamp<std::int64_t>(most_at_once / std::max<Index>(s.size(), 1), 32, 1024) : 1;
    return known_;
  }
  bool known() const { return known_; }
  /// Steps after which somebody may ask the run to stop: some milliseconds, or of millions of charges as many as pay
  /// for the way to memory and back.
  std::int64_t steps_at_once() const { return steps_at_once_; }

  /// Moves charges, in the coordinates of their kicks, by letters.
  void follow(ParticleSystem<double>& s, const std::vector<ChargeLetter>& letters) const;

 private:
  static constexpr std::int64_t most_at_once = 4'000'000;  ///< charges times steps

  template <class F> bool add_all(const F& forces) {
    if constexpr (requires { forces.terms(); }) {
      return std::all_of(forces.terms().begin(), forces.terms().end(), [&](const auto& force) { return add(force); });
    } else if constexpr (requires { forces.for_each([](const auto&) {}); }) {
      bool all = true;
      forces.for_each([&](const auto& force) { all = all && add(force); });
      return all;
    } else {
      return add(forces);
    }
  }
  bool add(const AnyForce<double>& force);
  bool add(const InField<UniformElectromagnetic>& field);
  bool add(const InField<GradientField>& field);
  bool add(const InField<MagneticDipole>& field);
  bool add(const InField<Tokamak>& field);
  bool add(const InField<PenningTrap>& field);
  template <class F> bool add(const F& /*unknown*/) { return false; }

  std::vector<LaneFieldNumbers> fields_;
  Push push_;
  bool known_ = false;
  std::int64_t steps_at_once_ = 1;
};

}  // namespace noether
