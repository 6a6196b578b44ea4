#pragma once
/// A pair force from a potential of a few lines.

#include "engine/charge.hpp"
#include "engine/sums.hpp"
#include "forces/charge_series_row.hpp"
#include "forces/pair_precision.hpp"
#include "forces/pairs.hpp"
#include "forces/secant.hpp"
#include "numbers/pack.hpp"
#include "numbers/simd_loop.hpp"

#include <concepts>
#include <cstddef>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>

namespace noether {

/// A potential between two particles: its parameters, and what it does at a distance.
///
///     struct Yukawa {
///       double strength = 1, length = 1;
///       double scale() const { return strength / (length * length); }
///       template <class Real> PairTerms<Real> operator()(const Real& r2) const;  // energy and -U'(r)/r
///     };
///
/// `scale` is a strong force of everyday: sums count whole units of 2^-47 of it or less. Where there is a `nearest()`,
/// pairs nearer than that end the run. For doubles the function is called in loops that the compiler turns into lanes:
/// best without branches, and with `pair_exp` for exp.
template <class P>
concept NeutralPairPotential = requires(const P& potential, double r2) {
  { potential(r2) } -> std::convertible_to<PairTerms<double>>;
  { potential.scale() } -> std::convertible_to<double>;
};

/// A potential between two charges: of the square of the distance and of C q_i q_j [energy length], C being the factor
/// of Coulomb's law. Energy and force are that product times a function of the distance, and another function.
///
///     double scale(double product) const;  // of charges as strong as that
///     template <class Real> PairTerms<Real> operator()(const Real& r2, const Real& product) const;
template <class P>
concept ChargedPairPotential = requires(const P& potential, double r2, double product) {
  { potential(r2, product) } -> std::convertible_to<PairTerms<double>>;
  { potential.scale(product) } -> std::convertible_to<double>;
};

/// A potential that is zero, and so is its force, from a distance of its own on.
template <class P>
concept EndsByItself = requires(const P& potential) {
  { potential.range() } -> std::convertible_to<double>;
};

/// A potential between charges of which a part, what the surrounding answers, also acts between excluded pairs and on
/// each charge itself, where `answers_excluded` is true.
///
///     template <class Real> PairTerms<Real> answer_terms(const Real& r2, const Real& product) const;
template <class P>
concept AnswersExcluded = ChargedPairPotential<P> && requires(const P& potential, double r2, double product) {
  { potential.answers_excluded } -> std::convertible_to<bool>;
  { potential.answer_terms(r2, product) } -> std::convertible_to<PairTerms<double>>;
};

/// A potential between charges that is 1/r and a polynomial, for loops in lanes of its own, and what these compute in.
///
///     PairPrecision precision;
///     const ChargeSeries& series() const;  // without terms: not with these parameters
template <class P>
concept HasChargeSeries = ChargedPairPotential<P> && requires(const P& potential) {
  { potential.series() } -> std::convertible_to<ChargeSeries>;
  { potential.precision } -> std::convertible_to<PairPrecision>;
};

template <class P>
concept PairPotential = NeutralPairPotential<P> || ChargedPairPotential<P>;

/// e^x, for potentials: of doubles without a branch or a call, so that loops of it go in lanes; 1 ulp.
template <class Real> Real pair_exp(const Real& x) {
  using std::exp;
  return exp(x);
}
template <> inline double pair_exp(const double& x) {
  const double inside = x < -700 ? -700 : x > 700 ? 700 : x;
  constexpr double magic = 6755399441055744.0;  // 1.5 x 2^52: adding it rounds to a whole number
  const double shifted = inside * 0x1.71547652b82fep0 + magic, n = shifted - magic;
  const double r = (inside - n * 0x1.62e42fee00000p-1) - n * 0x1.a39ef35793c76p-33;
  double p = 1.0 / 6227020800;
  p = p * r + 1.0 / 479001600;
  p = p * r + 1.0 / 39916800;
  p = p * r + 1.0 / 3628800;
  p = p * r + 1.0 / 362880;
  p = p * r + 1.0 / 40320;
  p = p * r + 1.0 / 5040;
  p = p * r + 1.0 / 720;
  p = p * r + 1.0 / 120;
  p = p * r + 1.0 / 24;
  p = p * r + 1.0 / 6;
  p = p * r + 0.5;
  p = 1 + (r + r * r * p);
  const auto exponent = __builtin_bit_cast(std::int64_t, shifted) << 52U;
  return __builtin_bit_cast(double, __builtin_bit_cast(std::int64_t, p) + exponent);
}

namespace detail {

template <class Real, class P>
[[gnu::always_inline]] inline PairTerms<Real> bare_terms(const P& potential, const Real& r2, const Real& product) {
  if constexpr (ChargedPairPotential<P>) {
    return potential(r2, product);
  } else {
    static_cast<void>(product);
    return potential(r2);
  }
}

template <class P> double scale_of(const P& potential, double product) {
  if constexpr (ChargedPairPotential<P>) {
    return potential.scale(product);
  } else {
    static_cast<void>(product);
    return potential.scale();
  }
}

/// How a potential ends: energy less that of `last`, less its force times r; or times a switch of t = (r2 - from2) over
/// what is left to the square of the cutoff, of `potential_switch` of (r - from) over what is left to the cutoff; or
/// force plus (r - from)^2 (bend[0] + bend[1] (r - from)). What charges add to `last` and `bend` is `charged` times
/// their product.
struct PairEnd {
  Cutoff style = Cutoff::plain;
  PairTerms<double> last{}, charged{};
  double from = 0, from2 = 0, inverse = 0;
  double bend[2] = {0, 0}, charged_bend[2] = {0, 0};
};

/// Times a switch of t = (r2 - from2) inverse.
template <class Real>
[[gnu::always_inline]] inline PairTerms<Real> switched(const PairTerms<Real>& bare, Cutoff style, double from2,
                                                       double inverse, const Real& r2) {
  Real t = (r2 - Real(from2)) * Real(inverse);
  t = t > Real(0) ? t : Real(0);
  const Switch<Real> off(style, t);
  return {bare.energy * off.value, off.value * bare.force - Real(2 * inverse) * bare.energy * off.slope};
}

/// The same of t = (r - from) inverse.
template <class Real>
[[gnu::always_inline]] inline PairTerms<Real> switched_in_r(const PairTerms<Real>& bare, Cutoff style, double from,
                                                            double inverse, const Real& r2) {
  using std::sqrt;
  const Real r = sqrt(r2);
  Real t = (r - Real(from)) * Real(inverse);
  t = t > Real(0) ? t : Real(0);
  const Switch<Real> off(style, t);
  return {bare.energy * off.value, off.value * bare.force - Real(inverse) * bare.energy * off.slope / r};
}

/// With the force bent to 0 from `from` on, and the energy less `shift`.
template <class Real>
[[gnu::always_inline]] inline PairTerms<Real> bent(const PairTerms<Real>& bare, const Real& shift,
                                                   const std::array<Real, 2>& bend, double from, const Real& r2) {
  using std::sqrt;
  const Real r = sqrt(r2);
  Real x = r - Real(from);
  x = x > Real(0) ? x : Real(0);
  const Real x2 = x * x;
  return {bare.energy - shift - x2 * x * (bend[0] / Real(3) + bend[1] * x / Real(4)),
          bare.force + x2 * (bend[0] + bend[1] * x) / r};
}

template <class Real, class P>
[[gnu::always_inline]] inline PairTerms<Real> ended(const P& potential, const PairEnd& end, const Real& r2,
                                                    const Real& product) {
  const PairTerms<Real> bare = bare_terms(potential, r2, product);
  if (end.style == Cutoff::plain) return bare;
  Real last_energy(end.last.energy), last_force(end.last.force);
  if constexpr (ChargedPairPotential<P>) {
    last_energy += product * Real(end.charged.energy);
    last_force += product * Real(end.charged.force);
  }
  if (end.style == Cutoff::shifted) return {bare.energy - last_energy, bare.force};
  if (end.style == Cutoff::shifted_force) {
    using std::sqrt;
    const Real r = sqrt(r2);
    return {bare.energy - last_energy + last_force * r, bare.force - last_force / r};
  }
  if (end.style == Cutoff::force_switch) {
    std::array<Real, 2> bend = {Real(end.bend[0]), Real(end.bend[1])};
    if constexpr (ChargedPairPotential<P>) {
      bend[0] += product * Real(end.charged_bend[0]);
      bend[1] += product * Real(end.charged_bend[1]);
    }
    return bent(bare, last_energy, bend, end.from, r2);
  }
  if (end.style == Cutoff::potential_switch) return switched_in_r(bare, end.style, end.from, end.inverse, r2);
  return switched(bare, end.style, end.from2, end.inverse, r2);
}

/// A potential that 113 bits evaluate too.
template <class P>
concept InQuad = requires(const P& potential, const Quad& x) {
  { potential(x) } -> std::same_as<PairTerms<Quad>>;
}
|| requires(const P& potential, const Quad& x) {
  { potential(x, x) } -> std::same_as<PairTerms<Quad>>;
};

/// What a potential and charges of this product have at the cutoff of a style that takes it off: `last` and `bend`.
template <class P> PairEnd last_of(const P& potential, Cutoff style, double cutoff, double from, double product) {
  PairEnd end;
  end.last = bare_terms<double, P>(potential, cutoff * cutoff, product);
  if (style == Cutoff::shifted_force) {
    end.last.force *= cutoff;
    end.last.energy += end.last.force * cutoff;
  }
  if (style != Cutoff::force_switch) return end;
  // The force F and its derivative there, by a difference that 113 bits make exact for doubles: from the outside, where
  // parts that end there by themselves are gone.
  constexpr bool wide = InQuad<P>;
  using Number = std::conditional_t<wide, Quad, double>;
  const Number rc(cutoff), h = rc * Number(wide ? 1e-10 : 1e-5), width = rc - Number(from), charges(product);
  const auto terms = [&](const Number& r) { return bare_terms<Number, P>(potential, r * r, charges); };
  const auto force = [&](const Number& r) { return terms(r).force * r; };
  const Number F = force(rc), slope = (Number(4) * force(rc + h) - Number(3) * F - force(rc + h + h)) / (h + h);
  const Number bend0 = (slope * width - Number(3) * F) / (width * width),
               bend1 = (Number(2) * F - slope * width) / (width * width * width);
  const Number shift = terms(rc).energy - width * width * width * (bend0 / Number(3) + bend1 * width / Number(4));
  end.bend[0] = static_cast<double>(bend0);
  end.bend[1] = static_cast<double>(bend1);
  end.last.energy = static_cast<double>(shift);
  return end;
}

/// How a potential ends at a cutoff. @param from  where a switch begins [length]
template <class P> PairEnd end_of(const P& potential, Cutoff style, double cutoff, double from) {
  PairEnd end{.style = style};
  if (style == Cutoff::plain) return end;
  const PairEnd neutral = last_of(potential, style, cutoff, from, 0), unit = last_of(potential, style, cutoff, from, 1);
  end.last = neutral.last;
  end.charged = {unit.last.energy - end.last.energy, unit.last.force - end.last.force};
  for (std::size_t k = 0; k < 2; ++k) {
    end.bend[k] = neutral.bend[k];
    end.charged_bend[k] = unit.bend[k] - neutral.bend[k];
  }
  end.from = from;
  end.from2 = from * from;
  end.inverse = 1 / (style == Cutoff::potential_switch ? cutoff - from : cutoff * cutoff - from * from);
  return end;
}

/// Distances of pairs, and what their charges multiply to, shape (count), a multiple of eight.
struct PairRun {
  const double *r2, *product;
  std::ptrdiff_t count;
};

/// Energies and forces of pairs of doubles.
using PairLoop = void (*)(const void* potential, const PairEnd& end, const PairRun& pairs, double* energy,
                          double* force);

template <class P, Cutoff style>
[[gnu::always_inline]] inline void loop_over_pairs(const void* potential, const PairEnd& given, const PairRun& pairs,
                                                   double* energy, double* force) {
  PairEnd end = given;
  end.style = style;
  const P own = *static_cast<const P*>(potential);  // nothing that is written can change it
  const PairRun run = pairs;
#if !defined(__clang__)
#pragma GCC ivdep
#endif
  for (std::ptrdiff_t k = 0; k < run.count; ++k) {
    const PairTerms<double> terms = ended<double>(own, end, run.r2[k], ChargedPairPotential<P> ? run.product[k] : 0.0);
    energy[k] = terms.energy;
    force[k] = terms.force;
  }
}

template <class P> PairLoop pair_loop(Cutoff style) {
  switch (style) {
    case Cutoff::plain:
      return simd_loop<loop_over_pairs<P, Cutoff::plain>>();
    case Cutoff::shifted:
      return simd_loop<loop_over_pairs<P, Cutoff::shifted>>();
    case Cutoff::shifted_force:
      return simd_loop<loop_over_pairs<P, Cutoff::shifted_force>>();
    case Cutoff::switch_c2:
      return simd_loop<loop_over_pairs<P, Cutoff::switch_c2>>();
    case Cutoff::potential_switch:
      return simd_loop<loop_over_pairs<P, Cutoff::potential_switch>>();
    case Cutoff::charmm_switch:
      return simd_loop<loop_over_pairs<P, Cutoff::charmm_switch>>();
    case Cutoff::force_switch:
      return simd_loop<loop_over_pairs<P, Cutoff::force_switch>>();
    default:
      return simd_loop<loop_over_pairs<P, Cutoff::switch_c4>>();
  }
}

/// All that the loop over a neighbor list needs to know of a pair force.
struct PairPlan {
  const void* potential;
  PairLoop loop;
  PairEnd end;
  double cutoff, nearest, scale;
  double coulomb_constant;   ///< times the charges of a pair [energy length/charge^2]; 0: charges are not asked for
  std::array<int, 2> types;  ///< only pairs of these; -1: all
  std::string_view name;
};

/// Those of a plan, for scaled pairs.
PairLimits limits_of(const PairPlan& plan);
void add_pairs_in_lanes(ForceSink<double>& out, const ParticleSystem<double>& s, const PairPlan& plan);
/// The same of charges, by their series.
void add_charges_in_lanes(ForceSink<double>& out, const ParticleSystem<double>& s, const PairPlan& plan,
                          const ChargeSeries& series, PairPrecision precision);
/// The indices of two types; -1 both for no names. @throws Error  for one name alone, or a name that no type has
std::array<int, 2> pair_types(const Topology* topology, const std::string& first, const std::string& second);
void check_pair_scale(double scale);
/// @throws Error  if the particles have no charges
void check_charges(bool there, std::string_view name);
/// C q^2 of the strongest charge; of a unit charge where there is none [energy length].
double strongest_product(const ParticleSystem<double>& s);

}  // namespace detail

/// A potential between all pairs up to a cutoff, or between the pairs of two types.
///
/// Ends at the cutoff, excluded and scaled pairs, small boxes and exact sums are those of LennardJonesForce. A pair
/// that is nearer than `nearest()` of the potential, or too strong for the sums, ends the run as `overlap`.
/// @cost doubles O(n); other number types O(n^2)
/// @source Verlet1967
template <PairPotential P> struct PairForce : P {
  /// Whether the potential asks for charges.
  static constexpr bool charged = ChargedPairPotential<P>;
  /// Whether the potential has a `range()` of its own; then no cutoff is asked for.
  static constexpr bool ends_by_itself = EndsByItself<P>;

  double cutoff = 0;                                                             ///< [length]
  Cutoff cutoff_style = ends_by_itself ? Cutoff::plain : Cutoff::shifted_force;  ///<
  std::optional<double> switch_from = {};  ///< where a switch begins [length]; default: 0.9 cutoff
  std::string first = {}, second = {};     ///< names of two types; default: all pairs

  static constexpr auto describe() requires requires { P::describe(); }
  {
    constexpr auto potential = P::describe();
    constexpr auto first_type =
        field<&PairForce::first>("first", "1", "a type: only its pairs with `second`; default: all types");
    constexpr auto second_type =
        field<&PairForce::second>("second", "1", "a type: only its pairs with `first`; default: all types");
    if constexpr (ends_by_itself) {
      return part<PairForce>(potential, first_type, second_type);
    } else {
      return part<PairForce>(
          potential,
          field<&PairForce::cutoff>("cutoff", "length", "largest distance at which pairs interact")
              .required("\"1 nm\""),
          field<&PairForce::cutoff_style>("cutoff_style", "1", "how the potential ends at the cutoff"),
          field<&PairForce::switch_from>("switch_from", "length", "where a switch begins; default: 0.9 cutoff"),
          first_type, second_type);
    }
  }
  ForceClaims claims() const {
    return {
        .periodic = true, .charges = charged, .exclusions = true, .range = reach(), .tangent = TangentPattern::full};
  }

  /// @throws Error  for a cutoff that is no length, a switch that begins elsewhere, a force without strength
  void check() const {
    if constexpr (requires { P::check(); }) P::check();
    detail::check_cutoff(reach(), cutoff_style, switch_from);
    detail::check_pair_scale(detail::scale_of<P>(*this, 1));
  }
  /// @throws Error  also for names that no type has, and where charges are asked for that the particles do not have
  template <class Real> void check(const ParticleSystem<Real>& s) const {
    check();
    detail::pair_types(s.topology(), first, second);
    if constexpr (charged) detail::check_charges(s.template has<Charge>(), name());
    if constexpr (HasChargeSeries<P>) detail::check_precision(this->precision, s.box().is_periodic(), name());
  }

  template <class Real>
    requires(!std::is_same_v<Real, Pack>)  // lanes would have to agree on who is in range
  void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const auto terms = terms_of(s);
    if constexpr (std::is_same_v<Real, double>) {
      const P& potential = *this;
      const double scale = detail::scale_of(potential, charged ? detail::strongest_product(s) : 0);
      const detail::PairPlan plan{&potential,
                                  detail::pair_loop<P>(cutoff_style),
                                  end(),
                                  reach(),
                                  nearest_pair(),
                                  scale,
                                  charged ? s.units().coulomb_constant : 0,
                                  detail::pair_types(s.topology(), first, second),
                                  name()};
      add_in_lanes(out, s, plan);
      detail::add_special_pairs(out, s, terms, detail::limits_of(plan));
      add_answers(out, s, detail::limits_of(plan));
    } else {
      detail::add_pairs_in_turn(out, s, reach(), terms);
      detail::add_special_pairs(out, s, terms, {.range = reach()});
      add_answers(out, s, {.range = reach()});
    }
  }

  /// Its secants between two states, those of every pair potential.
  /// @cost O(n^2)
  template <class Real>
    requires(!std::is_same_v<Real, Pack>)
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const {
    detail::add_pair_secants(out, from, to, reach(), nearest_pair(), terms_of(to));
    if constexpr (AnswersExcluded<P>) {
      if (!this->answers_excluded || to.topology() == nullptr) return;
      const auto terms = answers_of(to);
      Secants<Real> secants(out, from, to);
      for (const auto& [pair, part] : detail::taken_away(*to.topology())) {
        secants.pair({.i = pair.first, .j = pair.second},
                     [&, i = pair.first, j = pair.second, part = part](const Real& r2) {
                       PairTerms<Real> found{Real(0), Real(0)};
                       terms(i, j, r2, [&](const PairTerms<Real>& one) {
                         found = {Real(part) * one.energy, Real(part) * one.force};
                       });
                       return found;
                     });
      }
    }
  }

 private:
  void add_in_lanes(ForceSink<double>& out, const ParticleSystem<double>& s, const detail::PairPlan& plan) const {
    if constexpr (HasChargeSeries<P>) {
      const ChargeSeries& series = P::series();
      if (series.energy_terms > 0 && series.force_terms > 0 && cutoff_style == Cutoff::plain)
        return detail::add_charges_in_lanes(out, s, plan, series, this->precision);
    }
    detail::add_pairs_in_lanes(out, s, plan);
  }
  /// What the surrounding answers to an excluded pair, as `terms_of`.
  template <class Real> auto answers_of(const ParticleSystem<Real>& s) const requires AnswersExcluded<P> {
    return [this, charges = s.template column<Charge>().data(), types = detail::pair_types(s.topology(), first, second),
            topology = s.topology(),
            constant = Real(s.units().coulomb_constant)](Index i, Index j, const Real& r2, const auto& add) {
      if (!is_between(types, topology, i, j) || !(r2 < Real(reach() * reach()))) return;
      add(P::answer_terms(r2, Real(constant * charges[i] * charges[j])));
    };
  }
  /// Adds what the surrounding answers to excluded pairs, to what is taken away from scaled ones, and to each charge
  /// itself, which is half of a pair at no distance.
  template <class Real>
  void add_answers(ForceSink<Real>& out, const ParticleSystem<Real>& s, const detail::PairLimits& limits) const {
    if constexpr (AnswersExcluded<P>) {
      if (!this->answers_excluded) return;
      const auto answers = answers_of(s);
      if (s.topology() != nullptr) detail::add_scaled_pairs(out, s, detail::taken_away(*s.topology()), answers, limits);
      if (!out.wants_energy()) return;
      out.energy(sum_over<Real>(s.size(), [&](Index i) {
        Real energy(0);
        answers(i, i, Real(0), [&](const PairTerms<Real>& one) { energy = one.energy / Real(2); });
        return energy;
      }));
    } else {
      static_cast<void>(limits);
    }
  }
  /// What a pair does, for the loops over pairs.
  template <class Real> auto terms_of(const ParticleSystem<Real>& s) const {
    const Real* charges = nullptr;
    if constexpr (charged) charges = s.template column<Charge>().data();
    return [this, charges, types = detail::pair_types(s.topology(), first, second), end = this->end(),
            topology = s.topology(),
            constant = Real(s.units().coulomb_constant)](Index i, Index j, const Real& r2, const auto& add) {
      if (!is_between(types, topology, i, j)) return;
      if (!(r2 < Real(reach() * reach()))) return;
      const Real product = charged ? constant * charges[i] * charges[j] : Real(0);
      add(detail::ended<Real>(static_cast<const P&>(*this), end, r2, product));
    };
  }
  /// Whether pairs of these two particles are those of the force.
  static bool is_between(const std::array<int, 2>& types, const Topology* topology, Index i, Index j) {
    if (types[0] < 0) return true;
    const std::array<int, 2> pair = {topology->type(i), topology->type(j)};
    return pair == types || pair == std::array<int, 2>{types[1], types[0]};
  }
  double reach() const {
    if constexpr (ends_by_itself) {
      return P::range();
    } else {
      return cutoff;
    }
  }
  double nearest_pair() const {
    if constexpr (requires { P::nearest(); }) {
      return P::nearest();
    } else {
      return 0;
    }
  }
  static constexpr std::string_view name() {
    if constexpr (requires { P::describe(); }) {
      return P::describe().name;
    } else {
      return "pair";
    }
  }
  detail::PairEnd end() const {
    return detail::end_of<P>(*this, cutoff_style, reach(), switch_from.value_or(0.9 * reach()));
  }
};

}  // namespace noether
