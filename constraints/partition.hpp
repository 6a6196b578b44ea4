#pragma once
/// Which constraints hang together, and which of these molecules are equal.

#include "constraints/constraint_set.hpp"
#include "engine/column.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace noether {

/// The connected components of a set of constraints, equal ones together: constraints are in one component if they
/// share a particle, directly or by way of others. Nothing couples two components, so each can be solved by itself, and
/// those of one kind side by side.
///
/// Components are numbered by their first particle, and particles within them stand in ascending order: a particle's
/// *place*. Constraints of a component stand by type in the order of the set, those of a type by the particles they
/// tie, then by parameters. None of this depends on the order in which constraints of a type were added.
///
/// Two components are of one *kind* if they have as many particles, of equal masses place by place, and the same
/// constraints, of bitwise equal parameters, on the same places. A constraint tells its parameters by `describe()`; one
/// that does not describe all of its members is equal to no other.
///
///     const Partition parts(set, s.masses());
///     for (Index kind = 0; kind < parts.kinds(); ++kind) {
///       for (const Index water : parts.components_of(kind)) parts.particles(water);    // [O, H, H]
///       parts.places(kind);                                                            // [0, 1, 0, 2, 1, 2]
///     }
class Partition {
 public:
  /// Where a constraint stands in the set.
  struct Member {
    Index group;       ///< in ConstraintSet::groups()
    Index constraint;  ///< within the group
    Index equation;    ///< its first one; an equation of the set

    bool operator==(const Member&) const = default;
  };

  Partition() = default;
  /// @param masses  of all particles that constraints are numbered by, shape (n)
  /// @throws BadConstraints  for a constraint on a particle that is not there
  /// @cost O((n + c) log (n + c)) for c constraints, once
  template <class Real> Partition(const ConstraintSet& set, const ScalarColumn<Real>& masses);

  Index components() const { return static_cast<Index>(kind_.size()); }
  /// The component that a particle belongs to; -1 if no constraint ties it.
  Index component_of(Index particle) const { return component_of_[at(particle)]; }
  /// Particles of a component, ascending: shape (particles of its kind).
  std::span<const Index> particles(Index component) const { return particles_.row(component); }
  /// Constraints of a component: shape (constraints of its kind).
  std::span<const Member> constraints(Index component) const { return constraints_.row(component); }

  /// Number of kinds; they are numbered by the first component of each.
  Index kinds() const { return static_cast<Index>(equations_.size()); }
  Index kind(Index component) const { return kind_[at(component)]; }
  /// Components of a kind, ascending.
  std::span<const Index> components_of(Index kind) const { return of_kind_.row(kind); }
  /// Number of equations of each component of a kind.
  Index equations(Index kind) const { return equations_[at(kind)]; }
  /// Places of the particles that constraints tie, constraint after constraint: those that the first one ties, then
  /// those of the next.
  std::span<const Index> places(Index kind) const { return places_.row(kind); }

 private:
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  /// Rows of different lengths, one after the other.
  template <class T> struct Rows {
    std::vector<Index> first = {0};  ///< of each row, and the end of the last
    std::vector<T> entries;

    std::span<const T> row(Index k) const { return {entries.data() + first[at(k)], entries.data() + first[at(k + 1)]}; }
  };

  /// Sorts `entries` into rows, in their order. @param row_of  of each entry; those of -1 are left out
  template <class T>
  static Rows<T> in_rows(const std::vector<T>& entries, const std::vector<Index>& row_of, Index rows);

  void find_components(const ConstraintSet& set, Index particles);
  void sort_constraints(const ConstraintSet& set, const std::vector<std::vector<Index>>& parameters);
  void find_kinds(const ConstraintSet& set, const std::vector<std::vector<Index>>& parameters,
                  const std::vector<Index>& masses);
  /// The places of what the constraints of a component tie.
  std::vector<Index> places_in(const ConstraintSet& set, Index component) const;

  std::vector<Index> component_of_;
  Rows<Index> particles_;     ///< of each component
  Rows<Member> constraints_;  ///< of each component
  std::vector<Index> kind_;
  Rows<Index> of_kind_;
  std::vector<Index> equations_;  ///< of each kind
  Rows<Index> places_;            ///< of each kind
};

}  // namespace noether
