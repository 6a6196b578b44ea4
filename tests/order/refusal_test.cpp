#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/damped.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/problems.hpp"

#include <string>

namespace noether {
namespace {

using namespace noether::test;

template <class H> std::string refusal(H hamiltonian, const Scheme& scheme) {
  try {
    compose(std::move(hamiltonian), scheme);
  } catch (const SchemeMismatch& mismatch) {
    return mismatch.what();
  }
  return "";
}

std::string refusal(const Scheme& scheme, const HamiltonianClaims& claims) {
  try {
    fitted_word(scheme, claims, "test");
  } catch (const SchemeMismatch& mismatch) {
    return mismatch.what();
  }
  return "";
}

const WisdomHolman<double> democratic_arcs({.coordinates = Coordinates::democratic});
const WisdomHolman<double, Sum<HarmonicField>> arcs_in_field({.coordinates = Coordinates::democratic},
                                                             Sum(HarmonicField{.k = 0.3}));
const Damped<KineticPotential<HarmonicField>> damped_spring(KineticPotential(HarmonicField{.k = 1}), {.rate = 0.1});

TEST_CASE("a scheme that needs exact kicks is refused where other forces join democratic coordinates", "[refusal]") {
  for (const Scheme* scheme : {&schemes::aba_10_6_4, &schemes::blanes_moan_s6}) {
    CHECK(refusal(arcs_in_field, *scheme) ==
          "scheme '" + std::string(scheme->name) +
              "' needs exact flows, but part B of 'wisdom_holman' is a symmetric map of order 2; use 'verlet', a "
              "composition of its steps such as 'yoshida_4', or a scheme made for it such as 'abah_8_6_4'");
    CHECK(refusal(democratic_arcs, *scheme) == "");
  }
  for (const Scheme* scheme :
       {&schemes::abah_10_6_4, &schemes::abah_8_6_4, &schemes::verlet, &schemes::verlet_aba, &schemes::yoshida_6}) {
    CHECK(refusal(arcs_in_field, *scheme) == "");
  }
  CHECK(refusal(WisdomHolman<double>({}), schemes::aba_10_6_4) == "");
}

TEST_CASE("Nystroem schemes of orders above 4 are refused where the kinetic energy is not quadratic", "[refusal]") {
  const HamiltonianClaims exact{.alphabet = "AB", .quadratic_kinetic = false};
  int tested = 0, taken = 0;
  for (const Scheme* scheme : schemes::all()) {
    if (scheme->scheme_class != SchemeClass::rkn) continue;
    // What {B,{B,{B,A}}} = 0 saves is of order 5 and more: symmetric ones of order 4 have it over any splitting.
    if (scheme->order.any_splitting() == scheme->order.classical) {
      CHECK(scheme->order.classical == 4);
      CHECK(scheme->is_symmetric());
      CHECK(refusal(*scheme, exact) == "");
      CHECK(order_over(*scheme, exact).classical == 4);
      ++taken;
      continue;
    }
    CHECK(refusal(*scheme, exact) ==
          "scheme '" + std::string(scheme->name) +
              "' is a Runge-Kutta-Nystroem splitting and keeps its order only where {B,{B,{B,A}}} = 0, which 'test' "
              "does not guarantee; use a general scheme such as 'blanes_moan_s10'");
    CHECK(refusal(democratic_arcs, *scheme) != "");
    CHECK(refusal(WisdomHolman<double>({}), *scheme) == "");
    ++tested;
  }
  CHECK(tested == 5);
  CHECK(taken == 3);
}

TEST_CASE("a scheme with negative steps is refused on an irreversible part", "[refusal]") {
  CHECK(refusal(damped_spring, schemes::yoshida_4) ==
        "scheme 'yoshida_4' steps backwards, but part D of 'damped' is irreversible; use a scheme with forward steps "
        "only, such as 'verlet' or 'mclachlan_2_s2'");
  for (const Scheme* scheme : schemes::all()) {
    bool backwards = false;
    for (const Stage& stage : scheme->word) backwards = backwards || stage.weight < Quad(0);
    CHECK((refusal(damped_spring, *scheme) != "") == backwards);
  }
}

TEST_CASE("a letter that the Hamiltonian does not have is refused", "[refusal]") {
  CHECK(refusal(KineticPotential(HarmonicField{.k = 1}), word("BADAB")) ==
        "scheme 'BADAB' uses the letter D, but 'kinetic_potential' has only AB");
  CHECK(refusal(damped_spring, word("BADAB")) == "");
  CHECK(refusal(damped_spring, word("BAOAB")) == "scheme 'BAOAB' uses the letter O, but 'damped' has only ABD");
}

TEST_CASE("a force that depends on velocities is refused as an exact kick", "[refusal]") {
  struct Friction {
    static ForceClaims claims() { return {.velocity_dependent = true}; }
    void add_to(ForceSink<double>& out, const ParticleSystem<double>& s) const {
      for (Index i = 0; i < s.size(); ++i) out.acceleration(i, -s.velocities()[i]);
    }
  };
  CHECK_THROWS_AS(KineticPotential(Friction{}), SchemeMismatch);
  CHECK_THROWS_AS(KineticPotential(Sum(HarmonicField{.k = 1}, Friction{})), SchemeMismatch);
  const WisdomHolman<double, Friction> arcs({}, Friction{});
  for (const Scheme* scheme : {&schemes::verlet, &schemes::abah_10_6_4, &schemes::yoshida_4})
    CHECK(refusal(arcs, *scheme) == "");
  CHECK(refusal(arcs, schemes::aba_10_6_4) ==
        "scheme 'aba_10_6_4' needs exact flows, but part B of 'wisdom_holman' is a symmetric map of order 2; use "
        "'verlet', "
        "a composition of its steps such as 'yoshida_4', or a scheme made for it such as 'abah_8_6_4'");
  CHECK(refusal(arcs, schemes::srkn6b) != "");
}

TEST_CASE("a drag that drives is refused", "[refusal]") {
  CHECK_THROWS_AS(Damped(KineticPotential(HarmonicField{.k = 1}), {.rate = -0.1}), Error);
}

}  // namespace
}  // namespace noether
