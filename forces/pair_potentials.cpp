#include "forces/pair_potentials.hpp"

#include <fmt/format.h>

namespace noether {

namespace {

/// r^7 exp(-r / rho) is largest at 7 rho; U' = 0 where it is 6 C rho / A: below that once, and above it once.
double excess(const Buckingham& b, double r) {
  const double x = r / b.rho;
  return b.A * std::pow(r, 7) * std::exp(-x) - 6 * b.C * b.rho;
}

}  // namespace

void LennardJonesPair::check() const {
  if (!(epsilon > 0)) refuse_field("epsilon", epsilon, "is not a valid strength; an energy above 0 is expected");
  if (!(sigma > 0)) refuse_field("sigma", sigma, "is not a valid length; a length above 0 is expected");
}

void ReactionField::check() const {
  if (!(radius > 0)) refuse_field("cutoff", radius, "is not a valid length; a length above 0 is expected");
  if (dielectric && !(*dielectric >= 1)) {
    refuse_field("dielectric", *dielectric, "is not a valid relative permittivity; 1 or more is expected");
  }
  if (switched_from && !(*switched_from > 0 && *switched_from < radius))
    refuse_field("switch_from", *switched_from, fmt::format("does not lie between 0 and the cutoff {}", radius));
}

void Wca::check() const {
  if (!(epsilon > 0)) refuse_field("epsilon", epsilon, "is not a valid strength; an energy above 0 is expected");
  if (!(sigma > 0)) refuse_field("sigma", sigma, "is not a valid length; a length above 0 is expected");
}

void MorsePair::check() const {
  if (!(depth > 0)) refuse_field("depth", depth, "is not a valid depth of a well; an energy above 0 is expected");
  if (!(a > 0)) refuse_field("a", a, "is not a valid inverse width; a number above 0 is expected");
  if (!(length >= 0)) refuse_field("length", length, "is not a valid length; 0 or more is expected");
}

void Buckingham::check() const {
  if (!(A > 0)) refuse_field("A", A, "is not a valid repulsion; an energy above 0 is expected");
  if (!(rho > 0)) refuse_field("rho", rho, "is not a valid length; a length above 0 is expected");
  if (!(C >= 0)) refuse_field("C", C, "is not a valid dispersion; 0 or more is expected");
  if (C > 0 && !(excess(*this, 7 * rho) > 0)) {
    refuse_field(
        "C", C,
        fmt::format(
            "is so strong that these pairs attract at every distance; less than {:.6g} A rho^6 is needed for a barrier",
            std::pow(7.0, 7) * std::exp(-7.0) / 6));
  }
}

double Buckingham::nearest() const {
  if (C == 0) return 0;
  double inside = 0, outside = 7 * rho;  // of the barrier's top
  while (true) {
    const double middle = inside + (outside - inside) / 2;
    if (!(middle > inside && middle < outside)) return outside;
    (excess(*this, middle) > 0 ? outside : inside) = middle;
  }
}

template struct detail::ForceModel<WcaForce, double>;
template struct detail::ForceModel<WcaForce, Quad>;
template struct detail::ForceModel<MorseForce, double>;
template struct detail::ForceModel<MorseForce, Quad>;
template struct detail::ForceModel<BuckinghamForce, double>;
template struct detail::ForceModel<BuckinghamForce, Quad>;
template struct detail::ForceModel<ReactionFieldForce, double>;
template struct detail::ForceModel<ReactionFieldForce, Quad>;

}  // namespace noether
