#pragma once
/// The erased seam of forces: AnyForce satisfies the concept it erases, so a scene is one more instantiation of the
/// same templates.

#include "engine/concepts.hpp"
#include "engine/lane_by_lane.hpp"
#include "engine/seam.hpp"
#include "engine/signature.hpp"
#include "numbers/members.hpp"
#include "numbers/pack.hpp"

#include <algorithm>
#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace noether {

/// Whether a force can be evaluated in eight lanes: it is written over the number type.
template <class F> bool has_lanes(const F& force) {
  if constexpr (requires { force.has_lanes(); }) {
    return force.has_lanes();
  } else {
    return Force<F, Pack>;
  }
}

namespace detail {

NOETHER_FINDS_MEMBER(claims, claim, climas, calims, cliams, clamis, claism)
NOETHER_FINDS_MEMBER(check, chekc, chcek, cehck, hceck, chekk, chek)
NOETHER_FINDS_MEMBER(bind, bnid, bidn, ibnd, bnd, biind, bindd)
NOETHER_FINDS_MEMBER(reference, refernece, refrence, referance, refernce, refference, referecne)
NOETHER_FINDS_MEMBER(add_secant_to, add_secant, add_secants_to, add_secant_for, add_sceant_to, add_secnat_to,
                     add_secent_to)

template <class F>
concept GivesClaims = requires(const F& force) {
  { force.claims() } -> std::convertible_to<ForceClaims>;
};
template <class F>
concept ChecksFields = requires(const F& force) {
  force.check();
};
template <class F>
concept ChecksParticles = requires(const F& force, const ParticleSystem<double>& s) {
  force.check(s);
};
template <class F>
concept BindsParticles = requires(F& force, const ParticleSystem<double>& s) {
  force.bind(s);
};
template <class F>
concept NamesReference = requires(const F& force) {
  force.reference();
};
template <class F>
concept GivesSecants = requires(const F& force, ForceSink<double>& out, const ParticleSystem<double>& s) {
  force.add_secant_to(out, s, s);
};

/// Whether each optional member of a force, where there is one of its name, is what it has to be.
template <class F> struct ForceMembers {
  static constexpr bool claims = !misspells_claims<F>() && (!finds_claims<F>() || GivesClaims<F>);
  static constexpr bool check = !misspells_check<F>() && (!finds_check<F>() || ChecksFields<F> || ChecksParticles<F>);
  static constexpr bool bind = !misspells_bind<F>() && (!finds_bind<F>() || BindsParticles<F>);
  static constexpr bool reference = !misspells_reference<F>() && (!finds_reference<F>() || NamesReference<F>);
  static constexpr bool secant = !misspells_add_secant_to<F>() && (!finds_add_secant_to<F>() || GivesSecants<F>);
};

/// @throws LogicError  if the force has no secants
template <class F, class Real>
void add_secant_of(const F& force, ForceSink<Real>& out, const ParticleSystem<Real>& from,
                   const ParticleSystem<Real>& to) {
  if constexpr (requires { force.add_secant_to(out, from, to); }) {
    force.add_secant_to(out, from, to);
  } else {
    throw LogicError("secants were requested from the force '" + name_of(force) + "', which has none");
  }
}

/// How a force answers where it need not have a member of this name.
template <class Real> struct ForceAnswers {
  template <class F> static void bind(F& force, const ParticleSystem<Real>& s) {
    if constexpr (requires { force.bind(s); }) force.bind(s);
  }
  template <class F, class Number>
  static void add_to(const F& force, ForceSink<Number>& out, const ParticleSystem<Number>& s) {
    if constexpr (!Force<F, Number>) {
      throw LogicError(std::is_same_v<Number, Pack> ? "evaluation in lanes was requested from a force that has none"
                                                    : "derivatives were requested from a force that has none");
    } else if constexpr (std::is_same_v<Number, Pack>) {
      add_in_lanes(force, out, s);
    } else {
      force.add_to(out, s);
    }
  }
  template <class F> static bool has_secant(const F& force) { return noether::has_secant<Real>(force); }
  template <class F>
  static void add_secant_to(const F& force, ForceSink<Real>& out, const ParticleSystem<Real>& from,
                            const ParticleSystem<Real>& to) {
    add_secant_of(force, out, from, to);
  }
  template <class F> static bool has_lanes(const F& force) { return noether::has_lanes(force); }
  template <class F> static bool has_derivative(const F& force) { return noether::has_derivative<Real>(force); }
  template <class F> static ForceClaims own_claims(const F& force) { return claims_of(force); }
  template <class F> static void check(const F& force, const ParticleSystem<Real>& s) {
    if (s.box().is_periodic() && !claims_of(force).periodic) {
      throw Error("the force '" + name_of(force) + "' does not support a periodic box; take out the force or the box");
    }
    check_force(force, s);
  }
  template <class F> static std::string name(const F& force) { return name_of(force); }
  template <class F> static std::string signature(const F& force) { return signature_of(force); }
};

/* The members of AnyForce. `has_lanes`: it is a force over `Pack` too, so that eight stages cost little more than one;
   `has_derivative`: over dual numbers too, so that its derivatives are exact. Without these, and without `has_secant`,
   their sums throw LogicError. `own_claims` are those of the force, whatever kick it takes part in; `check` throws
   Error as `check_force` does. */
#define NOETHER_FORCE_SEAM(OWN, ANSWERED)                                                                              \
  ANSWERED(void, bind, (const ParticleSystem<Real>& s), s)                                                             \
  ANSWERED(void, add_to, (ForceSink<Real> & out, const ParticleSystem<Real>& s) const, out, s)                         \
  ANSWERED(bool, has_secant, () const)                                                                                 \
  ANSWERED(void, add_secant_to,                                                                                        \
           (ForceSink<Real> & out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const, out, from, \
           to)                                                                                                         \
  ANSWERED(bool, has_lanes, () const)                                                                                  \
  ANSWERED(void, add_to, (ForceSink<Pack> & out, const ParticleSystem<Pack>& s) const, out, s)                         \
  ANSWERED(bool, has_derivative, () const)                                                                             \
  ANSWERED(void, add_to, (ForceSink<Dual<Real, 1>> & out, const ParticleSystem<Dual<Real, 1>>& s) const, out, s)       \
  ANSWERED(ForceClaims, own_claims, () const)                                                                          \
  ANSWERED(void, check, (const ParticleSystem<Real>& s) const, s)                                                      \
  ANSWERED(std::string, name, () const)                                                                                \
  ANSWERED(std::string, signature, () const)

/// Built-in forces are compiled once, each in a .cpp of its own: their headers say `extern template`.
template <class Real> struct ForceBase {
  virtual ~ForceBase() = default;
  virtual std::unique_ptr<ForceBase> clone() const = 0;
  virtual std::unique_ptr<ForceBase<Quad>> in_quad() const = 0;
  NOETHER_FORCE_SEAM(NOETHER_SEAM_PURE, NOETHER_SEAM_PURE)
};
template <class F, class Real> struct ForceModel final : ForceBase<Real> {
  using Members = ForceMembers<F>;
  using Answers = ForceAnswers<Real>;
  static_assert(Members::claims,
                "a force has `ForceClaims claims() const`, or no member of that name or nearly that name");
  static_assert(Members::check,
                "a force has `void check(const ParticleSystem<Real>&) const`, or of its fields `check()`, or no member "
                "of that name or nearly that name");
  static_assert(Members::bind,
                "a force has `void bind(const ParticleSystem<Real>&)`, or no member of that name or nearly that name");
  static_assert(
      Members::reference,
      "a force has a `reference() const` that gives another force, or no member of that name or nearly that name");
  static_assert(
      Members::secant,
      "a force has `add_secant_to(ForceSink<Real>&, from, to) const`, or no member of that name or nearly that name");
  explicit ForceModel(F f) : held(std::move(f)) {}
  std::unique_ptr<ForceBase<Real>> clone() const override { return std::make_unique<ForceModel>(held); }
  std::unique_ptr<ForceBase<Quad>> in_quad() const override {
    if constexpr (requires { held.reference(); }) {
      using Reference = decltype(held.reference());
      static_assert(Force<Reference, Quad>, "the reference of a force is one over Quad");
      return std::make_unique<ForceModel<Reference, Quad>>(held.reference());
    } else if constexpr (Force<F, Quad>) {
      return std::make_unique<ForceModel<F, Quad>>(held);
    } else {
      return nullptr;
    }
  }
  NOETHER_FORCE_SEAM(NOETHER_SEAM_HELD, NOETHER_SEAM_ANSWERED)
  F held;
};

}  // namespace detail

/// Any force over one number type; one virtual call per evaluation.
template <class Real = double> class AnyForce : private detail::Erased<detail::ForceBase<Real>> {
 public:
  template <class F>
    requires(!std::is_same_v<std::decay_t<F>, AnyForce> && Force<std::decay_t<F>, Real>)
  AnyForce(F force)  // NOLINT: erases on purpose
      : detail::Erased<detail::ForceBase<Real>>(std::make_unique<detail::ForceModel<F, Real>>(std::move(force))) {}
  explicit AnyForce(std::unique_ptr<detail::ForceBase<Real>> held)
      : detail::Erased<detail::ForceBase<Real>>(std::move(held)) {}

  NOETHER_FORCE_SEAM(NOETHER_SEAM_CALL, NOETHER_SEAM_CALL)
  ForceClaims claims() const {
    ForceClaims claims = this->own_claims();
    if (kick_letter_ != 0) {
      claims.kicks = kick_letter_ + (claims.kicks.empty() ? std::string() : claims.kicks.substr(1));
      std::sort(claims.kicks.begin(), claims.kicks.end());
    }
    return claims;
  }
  /// Takes part in the kicks of another letter than the force itself says, as multiple time steps want it; of one that
  /// takes part in several, instead of in the first.
  /// @throws Error  if it takes part in those with another of its parts
  AnyForce& in_kick(char letter) {
    const std::string own = this->own_claims().kicks;
    if (own.size() > 1 && std::find(own.begin() + 1, own.end(), letter) != own.end()) {
      throw Error("kick = \"" + std::string(1, letter) + "\" is already that of another part of " + this->name() +
                      "; take one of the two out",
                  {.key = "kick", .value = "\"" + std::string(1, letter) + "\""});
    }
    kick_letter_ = letter;
    return *this;
  }
  /// The force itself where it is of this type, or null.
  template <class F> const F* as() const {
    const auto* model = dynamic_cast<const detail::ForceModel<F, Real>*>(this->held_.get());
    return model != nullptr ? &model->held : nullptr;
  }
  /// The same force in extended precision, or what it names as its `reference()` for truth; empty for one that is
  /// written for doubles only.
  std::optional<AnyForce<Quad>> in_quad() const {
    auto wide = this->held_->in_quad();
    if (wide == nullptr) return {};
    AnyForce<Quad> made(std::move(wide));
    if (kick_letter_ != 0) made.in_kick(kick_letter_);
    return made;
  }

 private:
  char kick_letter_ = 0;  ///< 0: as the force itself says
};

}  // namespace noether
