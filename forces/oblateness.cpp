#include "forces/oblateness.hpp"

#include <fmt/format.h>

namespace noether {

void Oblateness::check() const {
  check_constant_of_gravitation(G);
  if (J2 == 0 && J4 == 0) throw Error("oblateness has neither J2 nor J4, so it would do nothing; give one");
  if (!(radius > 0)) refuse_field("radius", radius, "is not a valid radius; a length above 0 is expected");
  if (axis[0] == 0 && axis[1] == 0 && axis[2] == 0) {
    refuse_field("axis", axis, "has no direction; expected one such as [0, 0, 1]");
  }
}

/// @param freedoms  in which particle 0 turns
void Oblateness::check_primary(const Bodies* bodies, const std::string& name, int freedoms) const {
  if (!turns()) {
    if (freedoms > 0) detail::refuse_fixed_axis("oblateness", name);
    return;
  }
  if (freedoms < 3) {
    throw Error(
        fmt::format("frame = \"body\" turns the axis with '{}', which {}; make it a rigid body of three moments "
                    "of inertia, or take frame out",
                    name, freedoms == 0 ? "is a point" : "is a line"),
        {.key = "frame"});
  }
  if (bodies->any_held()) {
    throw Error(
        "oblateness about the axis of a body moves bodies, but a fixed point holds one of them; take one of the "
        "two out",
        {.key = "frame"});
  }
}

template struct detail::ForceModel<Oblateness, double>;
template struct detail::ForceModel<Oblateness, Quad>;

}  // namespace noether
