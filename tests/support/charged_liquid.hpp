#pragma once
/// Charges in no order, in periodic boxes, for tests of sums over all their images.

#include "engine/charge.hpp"
#include "tests/support/liquid.hpp"

#include <algorithm>
#include <memory>
#include <random>
#include <utility>

namespace noether::test {

/// A liquid of charges of both signs in no order. @param net  what they add up to
inline ParticleSystem<double> charged_liquid(int cells, double net = 0) {
  ParticleSystem<double> s = liquid(cells, 0.8, 1, 0.25);
  std::mt19937_64 random(11);
  auto& q = s.add_column<Charge>();
  for (Index i = 0; i < s.size(); ++i) q[i] = i % 2 == 0 ? 1 : -1;
  for (Index i = s.size() - 1; i > 0; --i) std::swap(q[i], q[static_cast<Index>(random() % static_cast<unsigned>(i))]);
  q[0] += net;
  return s;
}

/// The same with pairs that are left out or scaled.
inline ParticleSystem<double> with_special_pairs(ParticleSystem<double> s) {
  auto topology = std::make_shared<Topology>();
  topology->exclusions = {{0, 1}, {0, 2}, {2, s.size() - 1}};
  topology->scaled_pairs = {{{0, 3}, 0.5}, {{1, s.size() - 2}, 0.25}};
  s.set_topology(topology);
  return s;
}

/// The same particles in the opposite order, with what is left of their excluded pairs; scaled ones, which are added in
/// the order of their list, are taken out of both.
inline ParticleSystem<double> backwards(ParticleSystem<double>& s) {
  const Index n = s.size();
  ParticleSystem<double> back(s.units());
  back.set_box(s.box());
  for (Index i = n - 1; i >= 0; --i) back.add("", 1, s.positions()[i], {0, 0, 0});
  auto& q = back.add_column<Charge>();
  for (Index i = 0; i < n; ++i) q[i] = s.column<Charge>()[n - 1 - i];
  auto kept = std::make_shared<Topology>(), reversed = std::make_shared<Topology>();
  kept->exclusions = s.topology()->exclusions;
  for (const auto& [i, j] : kept->exclusions) reversed->exclusions.push_back({n - 1 - j, n - 1 - i});
  std::sort(reversed->exclusions.begin(), reversed->exclusions.end());
  s.set_topology(kept);
  back.set_topology(reversed);
  return back;
}

/// The same particles in a box that is longer along one axis.
inline ParticleSystem<double> stretched(const ParticleSystem<double>& s, int axis, double by) {
  ParticleSystem<double> longer(s.units());
  Vec3<double> edges = s.box().edges();
  edges[axis] *= by;
  longer.set_box(Box::periodic(edges));
  for (Index i = 0; i < s.size(); ++i) {
    Vec3<double> x = s.positions()[i];
    x[axis] *= by;
    longer.add("", 1, x, {0, 0, 0});
  }
  auto& q = longer.add_column<Charge>();
  for (Index i = 0; i < s.size(); ++i) q[i] = s.column<Charge>()[i];
  if (s.topology() != nullptr) longer.set_topology(std::make_shared<Topology>(*s.topology()));
  return longer;
}

}  // namespace noether::test
