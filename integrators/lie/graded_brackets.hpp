#pragma once
/// How many commutators a method of Munthe-Kaas needs, counted in a graded free Lie algebra.

#include "integrators/methods/tableau.hpp"

#include <vector>

namespace noether {

/// Commutators of a method of Munthe-Kaas of an explicit table, reduced as Munthe-Kaas and Owren do.
///
/// Combinations Q_j of the stages K_i = h A_i are chosen that are of as high a power of h as they can be, whatever the
/// field: of the power w where the elementary weights of all rooted trees with fewer than w nodes are orthogonal to
/// them. All elements of a step are then polynomials of brackets of Q_j, of which terms beyond the order p can be left
/// out, in the elements of stages those beyond p - 1, whose effect has one power more. Counted is how many brackets the
/// others need at least: for each power of h the dimension that what brackets contribute to all elements together
/// spans. (Where a dimension is a sum of brackets with other first members it takes more than one of them.)
/// @return by the power of h, from 3 on
/// @source MuntheKaasOwren1999
std::vector<int> bracket_dimensions(const Tableau& table);

/// Their sum.
int least_commutators(const Tableau& table);

}  // namespace noether
