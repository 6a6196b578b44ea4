#pragma once
/// Work of one step on a Lie group, counted by an algebra that counts.

#include "integrators/method.hpp"

namespace noether {

/// What a step of fixed length asks of a group: its velocities, exponentials and commutators, while a method makes it
/// the second one of a run, on a field whose every element is another one. Exponentials of elements that are 0, and
/// commutators with them, are none.
GroupWork counted_work(const MethodInfo& info, const MethodOptions& options);

/// The same of a method of Munthe-Kaas, with what its commutators could be reduced to.
GroupWork rkmk_work(const MethodInfo& info, const MethodOptions& options);

}  // namespace noether
