#include "forces/bonded.hpp"

#include "engine/error.hpp"

#include <fmt/format.h>

namespace noether {

template void Bonded::add_to(ForceSink<double>&, const ParticleSystem<double>&) const;

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

}  // namespace noether
