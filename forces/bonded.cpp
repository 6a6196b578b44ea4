#include "forces/bonded.hpp"

#include "engine/error.hpp"
#include "engine/simd_loop.hpp"

#include <fmt/format.h>

namespace noether {

const BondedTerms& Bonded::terms_of(const std::shared_ptr<const Topology>& topology, Index n) const {
  if (terms_ != nullptr && terms_->belong_to(topology.get(), n)) return *terms_;
  if (topology == nullptr ||
      topology->bonds.size() + topology->angles.size() + topology->dihedrals.size() + topology->impropers.size() == 0) {
    throw Error(
        "force 'bonded' has nothing to act on: the particles come without bonded terms; give a structure with "
        "bonds, or take the force out");
  }
  terms_ = std::make_shared<const BondedTerms>(topology, n);
  return *terms_;
}

namespace {

template <class Potential>
[[gnu::always_inline]] inline bool forces_of(const std::array<double, 6>& parameters, const double* r2, Index count,
                                             double* force_over_r) {
  const Potential potential(parameters);
  int broken = 0;
  for (Index k = 0; k < count; ++k) {
    if constexpr (requires { potential.holds(r2[k]); }) broken |= potential.holds(r2[k]) ? 0 : 1;
    force_over_r[k] = potential.force_over_r(r2[k]);
  }
  return broken == 0;
}

}  // namespace

bool detail::bond_forces(const BondedKind<BondPotential>& kind, const double* r2, Index count, double* force_over_r) {
  return with_potential<double>(kind, [&](const auto& potential) {
    return simd_loop<forces_of<std::decay_t<decltype(potential)>>>()(kind.parameters, r2, count, force_over_r);
  });
}

Failure detail::overstretch(const BondedTerms& terms, Index bond, double length,
                            const std::vector<std::string>& names) {
  const BondedTerm<2>& term = terms.topology().bonds[static_cast<std::size_t>(bond)];
  const auto told = [&](Index i) {
    const std::string& name = names[static_cast<std::size_t>(i)];
    return name.empty() ? fmt::format("particle {}", i) : fmt::format("'{}'", name);
  };
  const double longest = terms.bonds[static_cast<std::size_t>(term.type)].parameters[1];
  return {.kind = Outcome::Kind::overstretch,
          .particle = term.particles[0],
          .quantity = "bond",
          .message = fmt::format("the bond of {} and {} is {:.6g} long, and a fene bond is shorter than {:.6g}; take a "
                                 "smaller step, or begin with shorter bonds",
                                 told(term.particles[0]), told(term.particles[1]), length, longest)};
}

template void Bonded::add_to(ForceSink<double>&, const ParticleSystem<double>&) const;
template struct detail::ForceModel<Bonded, double>;
template struct detail::ForceModel<Bonded, Quad>;

}  // namespace noether
