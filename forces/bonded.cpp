#include "forces/bonded.hpp"

#include "forces/secant.hpp"
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

namespace {

template <class Potential, class Real>
concept DependsOnDistance = requires(const Potential& potential, const Real& r2) {
  potential.force_over_r(r2);
};

/// A bond; @return the square of a length that it cannot have, or 0.
template <class Real, class Potential>
Real add_secants_of(Secants<Real>& secants, const std::array<Index, 2>& p, const Potential& potential) {
  Real too_long(0);
  secants.pair({.i = p[0], .j = p[1]}, [&](const Real& r2) -> PairTerms<Real> {
    if constexpr (requires { potential.holds(r2); }) {
      const Real none(std::numeric_limits<double>::quiet_NaN());
      if (!potential.holds(r2)) return too_long = r2, PairTerms<Real>{none, none};
    }
    return {potential.energy(r2), potential.force_over_r(r2)};
  });
  return too_long;
}

template <class Real, class Potential>
Real add_secants_of(Secants<Real>& secants, const std::array<Index, 3>& p, const Potential& potential) {
  if (!secants.keeps_image(p[0], p[1]) || !secants.keeps_image(p[2], p[1])) return Real(0);
  const std::array<Vec3<Real>, 3> place = {secants.apart(p[0], p[1]), Vec3<Real>::Zero(), secants.apart(p[2], p[1])};
  secants.group(p, place, [&](const std::array<Vec3<Real>, 3>& x) {
    const std::array<Vec3<Real>, 2> d = {x[0] - x[1], x[2] - x[1]};
    return detail::bonded_forces<Real>(potential, d, true);
  });
  return Real(0);
}

template <class Real, class Potential>
Real add_secants_of(Secants<Real>& secants, const std::array<Index, 4>& p, const Potential& potential) {
  for (const auto& [i, j] : {std::pair(p[0], p[1]), std::pair(p[1], p[2]), std::pair(p[3], p[2])}) {
    if (!secants.keeps_image(i, j)) return Real(0);
  }
  const Vec3<Real> third = -secants.apart(p[1], p[2]);
  const std::array<Vec3<Real>, 4> place = {secants.apart(p[0], p[1]), Vec3<Real>::Zero(), third,
                                           third + secants.apart(p[3], p[2])};
  if constexpr (DependsOnDistance<Potential, Real>) {
    secants.pair_along(p[0], p[3], Vec3<Real>(place[0] - place[3]), [&](const Real& r2) {
      return PairTerms<Real>{potential.energy(r2), potential.force_over_r(r2)};
    });
  } else {
    secants.group(p, place, [&](const std::array<Vec3<Real>, 4>& x) {
      const std::array<Vec3<Real>, 3> d = {x[0] - x[1], x[1] - x[2], x[3] - x[2]};
      return detail::bonded_forces<Real>(potential, d, true);
    });
  }
  return Real(0);
}

}  // namespace

template <class Real>
  requires(std::is_same_v<Real, double> || std::is_same_v<Real, Quad>)
void Bonded::add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from,
                           const ParticleSystem<Real>& to) const {
  const BondedTerms& terms = terms_of(to.shared_topology(), to.size());
  Secants<Real> secants(out, from, to);
  const auto family = [&](const auto& list, const auto& kinds) {
    for (std::size_t k = 0; k < list.size(); ++k) {
      const Real too_long = detail::with_potential<Real>(
          kinds[static_cast<std::size_t>(list[k].type)],
          [&](const auto& potential) { return add_secants_of<Real>(secants, list[k].particles, potential); });
      if (too_long == Real(0)) continue;
      out.fail(detail::overstretch(terms, static_cast<Index>(k), std::sqrt(detail::greatest(too_long)), to.names()));
    }
  };
  family(terms.topology().bonds, terms.bonds);
  family(terms.topology().angles, terms.angles);
  family(terms.topology().dihedrals, terms.dihedrals);
  family(terms.topology().impropers, terms.impropers);
}

template void Bonded::add_secant_to(ForceSink<double>&, const ParticleSystem<double>&,
                                    const ParticleSystem<double>&) const;
template void Bonded::add_secant_to(ForceSink<Quad>&, const ParticleSystem<Quad>&, const ParticleSystem<Quad>&) const;

template void Bonded::add_to(ForceSink<double>&, const ParticleSystem<double>&) const;
template struct detail::ForceModel<Bonded, double>;
template struct detail::ForceModel<Bonded, Quad>;

}  // namespace noether
