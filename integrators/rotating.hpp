#pragma once
/// A Hamiltonian of bodies that turn: what stands around one of points.

#include "engine/bodies.hpp"
#include "engine/description.hpp"
#include "engine/erasure.hpp"
#include "engine/sums.hpp"
#include "integrators/free_rotor.hpp"
#include "integrators/variational_rotor.hpp"
#include "integrators/wrapped.hpp"
#include "numbers/cost_book.hpp"
#include "numbers/parallel.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace noether {

template <> struct EnumNames<Rotor> {
  static constexpr std::array<std::pair<Rotor, std::string_view>, 3> values = {
      {{Rotor::exact, "exact"}, {Rotor::axes, "axes"}, {Rotor::variational, "variational"}}};
};

/// As scenes have it.
constexpr std::string_view rotor_name(Rotor rotor) {
  for (const auto& known : EnumNames<Rotor>::values) {
    if (known.first == rotor) return known.second;
  }
  return "";
}

/// The rotor of a name; empty where there is none.
constexpr std::optional<Rotor> rotor_of(std::string_view name) {
  for (const auto& known : EnumNames<Rotor>::values) {
    if (known.second == name) return known.first;
  }
  return {};
}

/// How bodies turn.
struct RotatingOptions {
  Rotor rotor = Rotor::exact;
  std::string axes = "xyz";  ///< order of the axes of the rotor of that name, for half a step and back

  static constexpr auto describe() {
    return part<RotatingOptions>(
        "rotating", "rigid bodies that turn: A turns them freely too, B twists them by the torques of forces",
        formula("H + sum Pi^2/2I:  A: q -> free turn, S stays;  B: S -> S + h torque"),
        source("CelledoniFassoSafstromZanna2008, VanZonSchofield2007, DullweberLeimkuhlerMcLachlan1997, "
               "MoserVeselov1991"),
        field<&RotatingOptions::rotor>("rotor", "1",
                                       "how bodies turn: exact; axes, one after the other; variational, as the "
                                       "discrete body of Moser and Veselov does"),
        field<&RotatingOptions::axes>("axes", "1", "order of axes of rotor = \"axes\": xyz is x y z y x"));
  }
  /// @throws Error  for axes that are no order of x, y and z
  void check() const { axis_order(axes); }
};

/// Rigid bodies (engine/bodies.hpp) under a Hamiltonian of points whose kicks pass on torques:
///
///     H(x, p, q, S) = H_points + sum_bodies (Pi_1^2/2 I_1 + Pi_2^2/2 I_2 + Pi_3^2/2 I_3),   Pi = R(q)^T S
///     A:  that of H_points, and q -> the free turn for h, S stays to the bit   action increment  + h T_turn
///     B:  that of H_points, and S -> S + h torque(x, q)                        action increment  - h U
///
/// Free motion and free turns commute, so A is exact with the rotor `exact`, and Runge-Kutta-Nystroem tables keep their
/// order, since T is quadratic in the momenta; `axes` and `variational` make it a symmetric map of order 2. With p = 2
/// (0, S) q all this is canonical in the R^8 of q and p, where the shadow Hamiltonian looks
/// (docs/theory/rigid_body.md). A point beside bodies has no moments and does not turn; a body that a fixed point holds
/// turns about it. Eight systems in the lanes of a `Pack` have the bits of each alone, and dual numbers carry the
/// tangent map.
/// @cost one free turn for each body and A
/// @source ToumaWisdom1994, DullweberLeimkuhlerMcLachlan1997
template <SplitHamiltonian H> class Rotating : public Wrapped<H> {
 public:
  using real = typename H::real;

  /// @throws Error  for axes that are no order; SchemeMismatch for a Hamiltonian that passes on no torques
  explicit Rotating(H hamiltonian, RotatingOptions options = {})
      : Wrapped<H>(std::move(hamiltonian)), options_(std::move(options)), order_(axis_order(options_.axes)) {
    if (Wrapped<H>::claims().twists) return;
    throw SchemeMismatch("the kicks of '" + detail::name_of(this->hamiltonian_) +
                         "' do not pass on torques, so it cannot turn bodies; use kinetic_potential or wisdom_holman");
  }

  HamiltonianClaims claims() const {
    HamiltonianClaims claims = Wrapped<H>::claims();
    claims.columns = claims.turns = true;
    claims.rotor = rotor_name(options_.rotor);
    if (options_.rotor != Rotor::exact && claims.inexact.find('A') == std::string_view::npos) {
      claims.inexact = claims.inexact.empty() ? "A" : "AB";
    }
    return claims;
  }
  /// @throws Error  for particles without bodies among them, and for constraints, which hold points
  void bind(ParticleSystem<real>& s) {
    if (!has_bodies(s)) throw Error("there are no rigid bodies to turn; add some, or take Rotating out");
    Wrapped<H>::bind(s);
    if (Wrapped<H>::claims().constraints > 0) {
      throw Error("constraints hold points, but some particles are rigid bodies; take one of the two out");
    }
    if constexpr (InLanes<real>) check_lanes(s);
    if (!one_by_one && options_.rotor == Rotor::variational) {
      throw Error(
          "rotor = \"variational\" solves an equation for each body, which neither several systems side by side nor "
          "dual "
          "numbers can; run the systems one by one, or use rotor = \"exact\"");
    }
    turned_ = ScalarColumn<real>((s.size() + 7) / 8 * 8);
    failure_.reset();
  }
  void observe(std::optional<Request> wanted) {
    observing_ = wanted.has_value();
    Wrapped<H>::observe(wanted);
  }
  const std::optional<Failure>& failure() const { return failure_ ? failure_ : Wrapped<H>::failure(); }
  void flow(char letter, ParticleSystem<real>& s, const real& h) {
    if (letter == 'A') turn(s, h);
    Wrapped<H>::flow(letter, s, h);
  }
  real flow_with_action(char letter, ParticleSystem<real>& s, const real& h) {
    real action(0);
    if (letter == 'A') {
      turn(s, h);
      action = sum_over<real>(s.size(), [&](Index i) { return turned_[i]; });
    }
    return action + Wrapped<H>::flow_with_action(letter, s, h);
  }
  EnergyTerms<real> energy(const ParticleSystem<real>& s) {
    EnergyTerms<real> terms = Wrapped<H>::energy(s);
    terms.kinetic += turning_energy_of(s);
    return terms;
  }
  void save(SavedState& saved, const std::string& prefix) const {
    detail::save_signature(saved, prefix + "rotating/", options_);
    detail::save_any(saved, prefix, this->hamiltonian_);
  }
  void load(const SavedState& saved, const std::string& prefix) {
    detail::check_signature(saved, prefix + "rotating/", options_);
    detail::load_any(saved, prefix, this->hamiltonian_);
  }

 private:
  static constexpr bool one_by_one = std::is_same_v<real, double> || std::is_same_v<real, Quad>;

  /// @throws Error  where systems side by side differ in what a body is: a point, a line or a body
  static void check_lanes(const ParticleSystem<real>& s) {
    const auto& inertia = s.template column<BodyInertia>();
    for (Index i = 0; i < s.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        const auto turns = inertia.component(k)[i] > real(0);
        if (any(turns) == all(turns)) continue;
        throw Error("'" + s.name(i) +
                    "' has a moment of inertia that is 0 in some lanes and not in others; run these "
                    "systems one by one");
      }
    }
  }
  void turn(ParticleSystem<real>& s, const real& h) {
    const Spent spent("rotor");
    const auto& inertia = std::as_const(s).template column<BodyInertia>();
    const auto& spin = std::as_const(s).template column<BodySpin>();
    auto& orientation = s.template column<BodyOrientation>();
    if constexpr (one_by_one) {
      if (options_.rotor == Rotor::variational) {
        const std::optional<Failure> failure = turn_all_variationally<real>(s, h, turned_);
        if (failure && !failure_ && !observing_) failure_ = failure;
        return;
      }
    }
    for_blocks(s.size(), [&](Index begin, Index end) {
      if (options_.rotor == Rotor::axes) {
        return turn_all_by_axes<real>(orientation, spin, inertia, h, order_, begin, end, turned_);
      }
      for (Index i = begin; i < end; ++i) {
        const Turned<real> next = turn_exactly<real>(std::as_const(orientation)[i], spin[i], inertia[i], h);
        orientation.set(i, next.orientation);
        turned_[i] = next.action;
      }
    });
  }

  RotatingOptions options_;
  AxisOrder order_;
  ScalarColumn<real> turned_;  ///< action of the last turn of each body [energy time], in whole eights
  bool observing_ = false;
  std::optional<Failure> failure_;
};

template <class H> Rotating(H) -> Rotating<H>;
template <class H> Rotating(H, RotatingOptions) -> Rotating<H>;

extern template class Rotating<AnyHamiltonian<double>>;
extern template class Rotating<AnyHamiltonian<Quad>>;
extern template struct detail::HamiltonianModel<Rotating<AnyHamiltonian<double>>>;
extern template struct detail::HamiltonianModel<Rotating<AnyHamiltonian<Quad>>>;

}  // namespace noether
