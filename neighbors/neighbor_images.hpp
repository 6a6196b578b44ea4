#pragma once
/// How many images of a particle a list of neighbors has to hold.

#include "engine/box.hpp"

namespace noether {

/// Refuses a box so small beside what a list reaches that a particle would have more than 10 000 images.
/// @throws Error  with the key `box`, or `skin` where the range alone would do
void check_images(const Box& box, double range, double skin);

}  // namespace noether
