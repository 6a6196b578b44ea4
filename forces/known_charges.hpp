#pragma once
/// What sums over a lattice of charges ask of the charges, as long as these are the same.

#include "engine/workspace.hpp"
#include "forces/ewald_split.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace noether::detail {

template <class Real> struct KnownCharges {
  std::vector<Real> charges;
  ChargeSums<Real> sums{};
  double strongest = 1;  ///< the size of the strongest one; 1 where all are 0

  /// Those of a system, kept in a workspace.
  static const KnownCharges& of(Workspace& workspace, const ParticleSystem<Real>& s) {
    auto& known = workspace.get<KnownCharges>();
    const Real* const q = s.template column<Charge>().data();
    if (std::equal(known.charges.begin(), known.charges.end(), q, q + s.size())) return known;
    known.charges.assign(q, q + s.size());
    known.sums = charge_sums(s);
    known.strongest = 0;
    for (const Real& charge : known.charges)
      known.strongest = std::max(known.strongest, std::abs(plain_number(charge)));
    if (known.strongest == 0) known.strongest = 1;
    return known;
  }
};

}  // namespace noether::detail
