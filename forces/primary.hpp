#pragma once
/// The primary of forces and splittings about particle 0.

#include "engine/particle_system.hpp"
#include "numbers/error.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace noether {

namespace detail {
/// @throws Error  always: an axis that stays where it is gives a body no torque
[[noreturn]] inline void refuse_fixed_axis(const std::string& force, const std::string& body) {
  throw Error(force + " has an axis that is fixed in space, which gives '" + body +
                  "' no torque, but that is a rigid body, which turns; give frame = \"body\", or a plain body",
              {.key = "frame"});
}
}  // namespace detail

/// The particle that a part is about: particle 0 of the run, known by its id from the first look on, so that no other
/// one takes its place when it is taken out.
class Primary {
 public:
  /// Before the first step and after each edit.
  /// @throws Error  if particle 0 is not the one of the first look
  template <class Real> void keep(const ParticleSystem<Real>& s, const std::string& part) const {
    if (s.size() == 0) return;
    if (!id_) id_ = s.ids()[0];
    if (*id_ == s.ids()[0]) return;
    throw Error(part + " is about the particle with id " + std::to_string(*id_) +
                ", which has been taken out; keep it, or start a new run, which is about its own first particle");
  }
  /// The same for a force: its reactions on the primary are over that mass, and without one they are not numbers.
  /// @throws Error  if particle 0 has no mass, too
  template <class Real> void check(const ParticleSystem<Real>& s, const std::string& force) const {
    if (s.size() > 0 && !(s.masses()[0] > Real(0))) {
      throw Error(force + " is about particle 0, but '" + s.name(0) + "' has no mass; put the star first");
    }
    keep(s, force);
  }

 private:
  mutable std::optional<std::int64_t> id_;
};

}  // namespace noether
