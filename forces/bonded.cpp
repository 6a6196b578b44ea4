#include "forces/bonded.hpp"

#include "numbers/error.hpp"
#include "numbers/simd_loop.hpp"

#include <fmt/format.h>

#include <limits>

namespace noether {

const BondedTerms& Bonded::terms_of(const std::shared_ptr<const Topology>& topology, Index n) const {
  if (terms_ != nullptr && terms_->belong_to(topology.get(), n)) return *terms_;
  if (topology == nullptr ||
      topology->bonds.size() + topology->angles.size() + topology->dihedrals.size() + topology->impropers.size() == 0) {
    throw Error(
        "force 'bonded' has nothing to act on: the particles have no bonded terms; give a structure with "
        "bonds, or take the force out");
  }
  terms_ = std::make_shared<const BondedTerms>(topology, n);
  return *terms_;
}

namespace {

template <class Potential>
[[gnu::always_inline]] inline bool forces_of(const std::array<double, 6>& parameters, const BondedTerm<2>* bonds,
                                             const std::uint8_t* in_step, Index count, const Vec3<double>& edges,
                                             const std::array<const double*, 3>& positions,
                                             const std::array<double*, 3>& force) {
  alignas(64) double d[3][block_size];
  for (Index i = 0; i < count;) {
    const auto [one, other] = bonds[i].particles;
    const Index together = std::min<Index>(in_step[i], count - i);
    for (std::size_t c = 0; c < 3; ++c) {
      const double *const from = positions[c] + other, *const to = positions[c] + one;
      for (Index k = 0; k < together; ++k) d[c][i + k] = to[k] - from[k];
    }
    i += together;
  }
  const Potential potential(parameters);
  double edge[3], half[3];
  for (int c = 0; c < 3; ++c) {
    edge[c] = edges[c];
    half[c] = edge[c] > 0 ? edge[c] / 2 : std::numeric_limits<double>::infinity();
  }
  // As Box::minimum_image for particles in the cell, without a branch.
  const auto nearest = [&](int c, double x) { return x - (x > half[c] ? edge[c] : x < -half[c] ? -edge[c] : 0.0); };
  int broken = 0;
  for (Index i = 0; i < count; ++i) {
    const double x = nearest(0, d[0][i]), y = nearest(1, d[1][i]), z = nearest(2, d[2][i]);
    const double r2 = x * x + y * y + z * z;
    if constexpr (requires { potential.holds(r2); }) broken |= potential.holds(r2) ? 0 : 1;
    const double force_over_r = potential.force_over_r(r2);
    force[0][i] = force_over_r * x;
    force[1][i] = force_over_r * y;
    force[2][i] = force_over_r * z;
  }
  return broken == 0;
}

}  // namespace

bool detail::bond_forces(const BondedKind<BondPotential>& kind, const BondedTerm<2>* bonds, const std::uint8_t* in_step,
                         Index count, const Vec3<double>& edges, const std::array<const double*, 3>& positions,
                         const std::array<double*, 3>& force) {
  return with_potential<double>(kind, [&](const auto& potential) {
    return simd_loop<forces_of<std::decay_t<decltype(potential)>>>()(kind.parameters, bonds, in_step, count, edges,
                                                                     positions, force);
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
          .message = fmt::format("the bond of {} and {} is {:.6g} long, but a fene bond must be shorter than {:.6g}; "
                                 "take a smaller step, or begin with shorter bonds",
                                 told(term.particles[0]), told(term.particles[1]), length, longest)};
}

template void Bonded::add_to(ForceSink<double>&, const ParticleSystem<double>&) const;
template struct detail::ForceModel<Bonded, double>;
template struct detail::ForceModel<Bonded, Quad>;

}  // namespace noether
