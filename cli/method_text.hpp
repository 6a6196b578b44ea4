#pragma once
/// Orders, evaluations and limits of methods, as lists and descriptions show them.

#include "integrators/method.hpp"
#include "scene/json.hpp"

#include <string>

namespace noether {

/// "4", "4, to 12" where steps of its own vary it, "varies, to 16, in Quad to 24" where there are no others: as in
/// docs/methods.md.
std::string order_text(const MethodInfo& info);
/// The highest order in extended precision; that in double where there is none.
int order_in_quad(const MethodInfo& info);

/// Evaluations of the forces a fixed step: "4", "iterates", or "-" where there are no fixed steps.
std::string evaluations_text(const MethodInfo& info);

/// What a step takes on a Lie group, as it is counted: "4 evaluations, 4 exponentials and 6 commutators a step on a
/// group; commutators could be reduced to 2".
std::string group_work_text(const GroupWork& work);
/// "; 2 nested commutators in dexp^-1 of a stage"; empty for methods of other kinds than Munthe-Kaas's.
std::string dexp_text(const MethodInfo& info, const MethodOptions& options);
/// The same for machines.
Json group_work_json(const GroupWork& work);

/// The first h omega that is unstable: "2.828", "never" stable, "always", or "-" where it is not known.
std::string limit_text(double limit);
/// The same for machines: a number (0: never stable), "always", or null.
Json limit_json(double limit);

}  // namespace noether
