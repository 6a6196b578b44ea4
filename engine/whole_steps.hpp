#pragma once
/// How many steps make a duration.

#include <cstdint>

namespace noether::detail {

/// How many steps of `dt` [time] make `duration` [time], both with their signs.
/// @throws Error  unless it is a whole number (to 1e-9), with the two nearest durations
std::int64_t whole_steps(double duration, double dt);

}  // namespace noether::detail
