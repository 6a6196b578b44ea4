#pragma once
/// Which particles a part ties to each other, where others may come and go.

#include "engine/particle_system.hpp"

#include <array>
#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

namespace noether {

namespace detail {

/// Notes the ids of the particles in some places, or where those with known ids stand now. Both lists may be empty.
/// @throws Error  for a place where there is nobody, and for a particle that has gone
void find_tied(const std::vector<std::int64_t>& ids, std::vector<Index>& places, std::vector<std::int64_t>& known);

}  // namespace detail

/// Groups of particles that a part ties, `{{0, 1}, {1, 2}}`; shape (groups, count).
///
/// They are given by their places. From the first `find` on they are known by their ids, so that they stay the same
/// particles when others are taken out of a run.
template <std::size_t count> class Tied {
 public:
  using Group = std::array<Index, count>;

  Tied() = default;
  Tied(std::initializer_list<Group> groups) : groups_(groups) {}
  explicit Tied(std::vector<Group> groups) : groups_(std::move(groups)) {}

  /// Finds the particles among those of a run: a force does so in `check(system)`, which is called before the first
  /// step and after each edit.
  /// @throws Error  for a place where there is nobody, and for a particle that has gone
  template <class Real> void find(const ParticleSystem<Real>& s) const {
    std::vector<Index> places;
    for (const Group& group : groups_) places.insert(places.end(), group.begin(), group.end());
    detail::find_tied(s.ids(), places, ids_);
    auto place = places.begin();
    for (Group& group : groups_) {
      for (Index& i : group) i = *place++;
    }
  }

  std::size_t size() const { return groups_.size(); }
  bool empty() const { return groups_.empty(); }
  auto begin() const { return groups_.cbegin(); }
  auto end() const { return groups_.cend(); }
  const Group& front() const { return groups_.front(); }
  const Group& operator[](std::size_t k) const { return groups_[k]; }

  // Whoever changes places names particles anew.
  Group& operator[](std::size_t k) { return anew()[k]; }
  Group& emplace_back() { return anew().emplace_back(); }

 private:
  std::vector<Group>& anew() {
    ids_.clear();
    return groups_;
  }

  mutable std::vector<Group> groups_;
  mutable std::vector<std::int64_t> ids_;  ///< of all their particles in a row, once they have been found
};

}  // namespace noether
