#include "constraints/partition.hpp"

#include "numbers/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <utility>

namespace noether {

namespace {

/// 0, 1, ..., n - 1.
std::vector<Index> numbers_to(Index n) {
  std::vector<Index> numbers(static_cast<std::size_t>(n));
  std::iota(numbers.begin(), numbers.end(), Index(0));
  return numbers;
}

/// Sets of particles that are merged: each knows the smallest of its own, after some steps.
class MergedSets {
 public:
  explicit MergedSets(Index n) : parent_(numbers_to(n)) {}
  Index smallest(Index i) {
    while (parent(i) != i) i = parent(i) = parent(parent(i));
    return i;
  }
  void merge(Index i, Index j) {
    const Index a = smallest(i), b = smallest(j);
    parent(std::max(a, b)) = std::min(a, b);
  }

 private:
  Index& parent(Index i) { return parent_[static_cast<std::size_t>(i)]; }

  std::vector<Index> parent_;
};

/// Numbers by value: the smallest is 0, equal ones have the same.
template <class T> std::vector<Index> ranks(const std::vector<T>& values) {
  std::map<T, Index> rank;
  for (const T& value : values) rank.emplace(value, 0);
  Index next = 0;
  for (auto& [value, number] : rank) number = next++;
  std::vector<Index> result;
  for (const T& value : values) result.push_back(rank.at(value));
  return result;
}

/// The rank of each constraint's parameters among those of its group, shape (groups, constraints of each).
std::vector<std::vector<Index>> ranks_of_parameters(const ConstraintSet& set) {
  std::vector<std::vector<Index>> result;
  for (const auto& group : set.groups()) {
    std::vector<std::string> bits;
    for (Index c = 0; c < group->size(); ++c) bits.push_back(group->parameters(c));
    result.push_back(ranks(bits));
  }
  return result;
}

}  // namespace

template <class Real> Partition::Partition(const ConstraintSet& set, const ScalarColumn<Real>& masses) {
  const std::vector<std::vector<Index>> parameters = ranks_of_parameters(set);
  find_components(set, masses.size());
  sort_constraints(set, parameters);
  find_kinds(set, parameters, ranks(std::vector<Real>(masses.begin(), masses.end())));
}
template Partition::Partition(const ConstraintSet&, const ScalarColumn<double>&);
template Partition::Partition(const ConstraintSet&, const ScalarColumn<Quad>&);

template <class T>
Partition::Rows<T> Partition::in_rows(const std::vector<T>& entries, const std::vector<Index>& row_of, Index rows) {
  Rows<T> result;
  result.first.assign(at(rows) + 1, 0);
  for (const Index row : row_of) {
    if (row >= 0) ++result.first[at(row) + 1];
  }
  std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
  result.entries.resize(at(result.first.back()));
  std::vector<Index> next = result.first;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    if (row_of[k] >= 0) result.entries[at(next[at(row_of[k])]++)] = entries[k];
  }
  return result;
}

void Partition::find_components(const ConstraintSet& set, Index particles) {
  MergedSets sets(particles);
  std::vector<bool> tied(at(particles), false);
  for (const auto& group : set.groups()) {
    for (Index c = 0; c < group->size(); ++c) {
      for (Index k = 0; k < group->particles(); ++k) {
        const Index i = group->particle(c, k);
        if (i >= particles) {
          throw BadConstraints(fmt::format("{} ties particle {}, but there are {}", group->name(), i, particles));
        }
        tied[at(i)] = true;
        sets.merge(group->particle(c, 0), i);
      }
    }
  }
  component_of_.assign(at(particles), -1);
  Index count = 0;
  for (Index i = 0; i < particles; ++i) {
    if (!tied[at(i)]) continue;
    const Index first = sets.smallest(i);
    component_of_[at(i)] = first == i ? count++ : component_of_[at(first)];
  }
  particles_ = in_rows(numbers_to(particles), component_of_, count);
}

void Partition::sort_constraints(const ConstraintSet& set, const std::vector<std::vector<Index>>& parameters) {
  std::vector<Member> members;
  std::vector<Index> component;
  Index equation = 0;
  for (std::size_t g = 0; g < set.groups().size(); ++g) {
    const ConstraintGroup& group = *set.groups()[g];
    for (Index c = 0; c < group.size(); ++c, equation += group.equations()) {
      members.push_back({static_cast<Index>(g), c, equation});
      component.push_back(component_of(group.particle(c, 0)));
    }
  }
  const Index components = static_cast<Index>(particles_.first.size()) - 1;
  constraints_ = in_rows(members, component, components);
  const auto before = [&](const Member& a, const Member& b) {
    if (a.group != b.group) return a.group < b.group;
    const ConstraintGroup& group = *set.groups()[at(a.group)];
    for (Index k = 0; k < group.particles(); ++k) {
      const Index i = group.particle(a.constraint, k), j = group.particle(b.constraint, k);
      if (i != j) return i < j;
    }
    const std::vector<Index>& rank = parameters[at(a.group)];
    const Index i = rank[at(a.constraint)], j = rank[at(b.constraint)];
    return i != j ? i < j : a.constraint < b.constraint;
  };
  for (Index k = 0; k < components; ++k) {
    std::sort(constraints_.entries.begin() + constraints_.first[at(k)],
              constraints_.entries.begin() + constraints_.first[at(k + 1)], before);
  }
}

std::vector<Index> Partition::places_in(const ConstraintSet& set, Index component) const {
  const std::span<const Index> own = particles(component);
  std::vector<Index> places;
  for (const Member& member : constraints(component)) {
    const ConstraintGroup& group = *set.groups()[at(member.group)];
    for (Index k = 0; k < group.particles(); ++k) {
      const auto found = std::lower_bound(own.begin(), own.end(), group.particle(member.constraint, k));
      places.push_back(static_cast<Index>(found - own.begin()));
    }
  }
  return places;
}

void Partition::find_kinds(const ConstraintSet& set, const std::vector<std::vector<Index>>& parameters,
                           const std::vector<Index>& masses) {
  std::map<std::vector<Index>, Index> known;  // kinds by all that makes a component what it is
  const Index components = static_cast<Index>(particles_.first.size()) - 1;
  for (Index component = 0; component < components; ++component) {
    const std::vector<Index> places = places_in(set, component);
    std::vector<Index> what = {static_cast<Index>(particles(component).size()),
                               static_cast<Index>(constraints(component).size())};
    Index equations = 0;
    for (const Index i : particles(component)) what.push_back(masses[at(i)]);
    for (const Member& member : constraints(component)) {
      what.push_back(member.group);
      what.push_back(parameters[at(member.group)][at(member.constraint)]);
      equations += set.groups()[at(member.group)]->equations();
    }
    what.insert(what.end(), places.begin(), places.end());
    const auto [found, is_new] = known.emplace(std::move(what), kinds());
    kind_.push_back(found->second);
    if (!is_new) continue;
    equations_.push_back(equations);
    places_.entries.insert(places_.entries.end(), places.begin(), places.end());
    places_.first.push_back(static_cast<Index>(places_.entries.size()));
  }
  of_kind_ = in_rows(numbers_to(components), kind_, kinds());
}

}  // namespace noether
