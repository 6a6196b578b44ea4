#pragma once
/// Whether a run has what a monitor wants to see of it.

#include "engine/concepts.hpp"

#include <string>

namespace noether::detail {

/// What a run can tell beside what its integrator claims; asked for what is wanted alone.
struct Told {
  bool virial = false, action = false;
  bool by_steps = false;  ///< the monitor looks by steps
};

/// Why no action tells the steps of a run; empty where one does.
std::string why_no_action(const IntegratorClaims& claims, bool has_action);

/// @throws Error  naming the monitor and what the run has not
void check_wanted(const std::string& monitor, const Request& wanted, const IntegratorClaims& claims, const Told& told);

}  // namespace noether::detail
