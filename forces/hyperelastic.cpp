#include "forces/hyperelastic.hpp"

#include "forces/tetrahedra_simd.hpp"

#include <fmt/format.h>

#include <cmath>

namespace noether {

void IsotropicMaterial::check() const {
  const bool lame = lambda || mu, engineers = young_modulus || poisson_ratio;
  if (lame && engineers) {
    refuse_field(lambda ? "lambda" : "mu", lambda ? *lambda : *mu,
                 "is given together with young_modulus or poisson_ratio; give two constants of one kind");
  }
  if (!lame && !engineers) {
    throw Error("no constants of the material are given; give lambda and mu, or young_modulus and poisson_ratio",
                {.key = "lambda"});
  }
  if (lame && !(lambda && mu)) {
    refuse_field(lambda ? "lambda" : "mu", lambda ? *lambda : *mu,
                 lambda ? "is given without mu; give both" : "is given without lambda; give both");
  }
  if (engineers && !(young_modulus && poisson_ratio)) {
    refuse_field(
        young_modulus ? "young_modulus" : "poisson_ratio", young_modulus ? *young_modulus : *poisson_ratio,
        young_modulus ? "is given without poisson_ratio; give both" : "is given without young_modulus; give both");
  }
  if (mu && !(*mu > 0)) refuse_field("mu", *mu, "is not a valid shear modulus; a pressure above 0 is expected");
  if (lambda && !(3 * *lambda + 2 * *mu > 0)) {
    refuse_field("lambda", *lambda, "makes the body swell under pressure; more than -2/3 mu is expected");
  }
  if (young_modulus && !(*young_modulus > 0)) {
    refuse_field("young_modulus", *young_modulus, "is not a valid modulus; a pressure above 0 is expected");
  }
  if (poisson_ratio && !(*poisson_ratio > -1 && *poisson_ratio < 0.5)) {
    refuse_field("poisson_ratio", *poisson_ratio,
                 "is not that of a stable material; -1 to 0.5 is expected, both "
                 "excluded");
  }
}

IsotropicLaw IsotropicMaterial::law() const {
  if (!young_modulus || !poisson_ratio) return {material, lambda.value_or(0), mu.value_or(0)};
  const double shear = *young_modulus / (2 * (1 + *poisson_ratio));
  return {material, 2 * shear * *poisson_ratio / (1 - 2 * *poisson_ratio), shear};
}

bool detail::tetrahedra_in_lanes(const TetrahedronGroups& groups, Index from, Index to) {
  return tetrahedron_kernels().forces(groups, from, to);
}

Failure detail::inverted_element(Index element, const std::array<Index, 4>& particles, double part,
                                 const std::vector<std::string>& names) {
  std::string who;
  for (const Index i : particles) {
    const auto at = static_cast<std::size_t>(i);
    const std::string name =
        at < names.size() && !names[at].empty() ? fmt::format("'{}'", names[at]) : fmt::format("particle {}", i);
    who += (who.empty() ? "" : ", ") + name;
  }
  return {.kind = Outcome::Kind::inverted_element,
          .particle = particles[0],
          .quantity = fmt::format("element {}", element),
          .message = fmt::format("element {} of {} is inside out: its volume is {:.3g} of that at rest; take a smaller "
                                 "step, or a stiffer material",
                                 element, who, part)};
}

template struct detail::ForceModel<HyperelasticForce, double>;
template struct detail::ForceModel<HyperelasticForce, Quad>;

}  // namespace noether
