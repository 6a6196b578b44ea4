#pragma once
/// Which constraints depend on each other.

#include "constraints/constraint_matrix.hpp"
#include "constraints/constraint_set.hpp"

#include <string>

namespace noether {

/// Names the constraints whose gradients depend on each other: those in the null space of G M^-1 G^T.
/// @param equation  one of them; of more than 600 equations it alone is named
template <class Real>
std::string dependent_words(const ConstraintSet& set, const ParticleSystem<Real>& s,
                            const ConstraintLayout<Real>& layout, const ConstraintGradients<Real>& g, Index equation);

}  // namespace noether
