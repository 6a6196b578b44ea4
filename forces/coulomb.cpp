#include "forces/coulomb.hpp"

#include "forces/pair_force.hpp"
#include "numbers/simd_loop.hpp"

#include <algorithm>

namespace noether {

namespace detail {

template <> AddFields<double> fields_loop(bool sums) {
  return sums ? simd_loop<add_fields_of<double, true>>() : simd_loop<add_fields_of<double, false>>();
}

const std::vector<ChargeLeftOut>& charges_left_out(const Topology* topology, Index begin, Index end) {
  thread_local std::vector<ChargeLeftOut> left_out;
  left_out.clear();
  for (Index i = begin; i < end; ++i) left_out.push_back({i, i});
  if (topology == nullptr) return left_out;
  const auto leave_out = [&](const Topology::Pair& pair) {
    const auto [i, j] = pair;
    if (i >= begin && i < end) left_out.push_back({j, i});
    if (j >= begin && j < end) left_out.push_back({i, j});
  };
  for (const Topology::Pair& pair : topology->exclusions) leave_out(pair);
  for (const Topology::ScaledPair& scaled : topology->scaled_pairs) leave_out(scaled.pair);
  std::sort(left_out.begin(), left_out.end());
  return left_out;
}

}  // namespace detail

void Coulomb::check_there(bool charges) { detail::check_charges(charges, "coulomb"); }

template struct detail::ForceModel<Coulomb, double>;
template struct detail::ForceModel<Coulomb, Quad>;

}  // namespace noether
