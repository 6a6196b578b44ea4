#include "integrators/variational/weber_steps.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/methods/newton.hpp"

#include <fmt/format.h>

namespace noether {

namespace {
constexpr std::string_view by_extrapolation = "weber_extrapolated";
}

template <class Real>
WeberStep<Real>::WeberStep(const MethodInfo& info) : name_(info.name), extrapolates_(info.name == by_extrapolation) {}

template <class Real> MethodClaims WeberStep<Real>::claims() const {
  return {.name = name_,
          .order = 2,
          .symplectic = !over_lagrangian_,
          .reversible = !remembers(),
          .keeps_angular_momentum = true,
          .second_order_only = true,
          .of_lagrangian = true};
}

template <class Real> void WeberStep<Real>::bind(const VectorField<Real>& f) {
  const FieldClaims field = f.claims();
  const auto* lagrangian = LagrangianField<Real>::behind(f);
  over_lagrangian_ = lagrangian != nullptr;
  if (over_lagrangian_ && lagrangian->second_rates() == 0) {
    throw SchemeMismatch(
        fmt::format("method '{}' treats second derivatives in forces, such as r'' in Weber's, but system '{}' names "
                    "none; use 'variational_midpoint'",
                    name_, field.name));
  }
  if (!over_lagrangian_ && !field.second_order) {
    throw SchemeMismatch(
        fmt::format("method '{}' is for q'' = a(t, q, q', q'') only, but '{}' is a first-order "
                    "system; use a method for y' = f, such as 'dormand_prince_5'",
                    name_, field.name));
  }
  velocity_dependent_ = over_lagrangian_ || field.velocity_dependent;
  n_ = f.size() / 2;
  for (Vector<Real>* v : {&q_, &v0_, &mean_, &v1_, &a_, &before_, &update_, &p_}) v->resize(n_);
  state_.resize(2 * n_);
  h_ = 0;
  const Index rates = over_lagrangian_ ? lagrangian->second_rates() : 0;
  w_.resize(rates);
  rates_.bind(2, rates);
}

template <class Real> StepResult WeberStep<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made{.h = h};
  made.failure = find_start(f, t, y);
  if (made.failure) return made;
  if (h != h_) rates_.forget();
  h_ = h;
  const Real half = Real(h) / Real(2);
  q_ = y.head(n_) + half * v0_;
  given_ = remembers() && rates_.count() == 2;
  if (given_) w_ = Real(2) * rates_[0] - rates_[1];
  made.failure = kick(f, t + half, h);
  if (made.failure) return made;
  if (remembers()) LagrangianField<Real>::behind(f)->find_second_rates(q_, mean_, a_, rates_.push());
  y.head(n_) = q_ + half * v1_;
  if (over_lagrangian_) {
    made.failure = finish(f, t + Real(h), y);
  } else {
    y.tail(n_) = v1_;
  }
  return made;
}

template <class Real>
std::optional<Failure> WeberStep<Real>::find_start(VectorField<Real>& f, const Real& t, const Vector<Real>& y) {
  if (!over_lagrangian_) {
    v0_ = y.tail(n_);
    return {};
  }
  q_ = y.head(n_);
  p_ = y.tail(n_);
  return LagrangianField<Real>::behind(f)->velocity(t, q_, p_, v0_);
}

/// v1, and a at the mean velocity, which the force contains: by iteration to rounding.
template <class Real> std::optional<Failure> WeberStep<Real>::kick(VectorField<Real>& f, const Real& t, double h) {
  mean_ = v0_;
  if (std::optional<Failure> failure = accelerate(f, t, true)) return failure;
  if (velocity_dependent_) {
    std::optional<Failure> inside;
    const Real half = Real(h) / Real(2);
    const auto correct = [&]() -> std::optional<UpdateSize> {
      before_ = mean_;
      mean_ = v0_ + half * a_;
      update_ = mean_ - before_;
      if (!inside) inside = accelerate(f, t, false);
      return update_size(update_.data(), 1, before_.data(), mean_.data(), n_);
    };
    const bool lost = newton_to_rounding<Real>(
                          correct, [] {}, [] { return true; })
                          .has_value();
    if (inside) return inside;
    if (lost) {
      return Failure{Outcome::Kind::solver_failure, -1, "step",
                     fmt::format("the velocity in the forces of a step of {:.9g} was not found by iteration; take a "
                                 "smaller step",
                                 h)};
    }
  }
  v1_ = v0_ + Real(h) * a_;
  return {};
}

/// a at the mean velocity. @param renew  whether the place is another than in the call before
template <class Real>
std::optional<Failure> WeberStep<Real>::accelerate(VectorField<Real>& f, const Real& t, bool renew) {
  if (!over_lagrangian_) {
    state_.head(n_) = q_;
    state_.tail(n_) = mean_;
    f.acceleration(t, state_, a_);
    return {};
  }
  auto* lagrangian = LagrangianField<Real>::behind(f);
  if (!given_) return lagrangian->solve_acceleration(t, q_, mean_, renew, a_);
  ++f.evaluations().force;
  lagrangian->acceleration_with(t, q_, mean_, w_, a_);
  return {};
}

/// The momenta of the end, and whether there are velocities for them: masses may have become negative on the way.
template <class Real>
std::optional<Failure> WeberStep<Real>::finish(VectorField<Real>& f, const Real& t, Vector<Real>& y) {
  auto* lagrangian = LagrangianField<Real>::behind(f);
  q_ = y.head(n_);
  lagrangian->terms(t, q_, v1_, terms_);
  p_ = terms_.momentum;
  y.tail(n_) = p_;
  return lagrangian->velocity(t, q_, p_, v1_);
}

template <class Real> void WeberStep<Real>::save(SavedState& saved, const std::string& prefix) const {
  if (!remembers()) return;
  save_value(saved, prefix + "/h", h_);
  rates_.save(saved, prefix + "/rates");
}
template <class Real> void WeberStep<Real>::load(const SavedState& saved, const std::string& prefix) {
  if (!remembers()) return;
  load_value(saved, prefix + "/h", h_);
  rates_.load(saved, prefix + "/rates");
}

template class WeberStep<double>;
template class WeberStep<Quad>;

namespace {
template <class Real> std::unique_ptr<Method<Real>> make_weber_step(const MethodInfo& info, const MethodOptions&) {
  return std::make_unique<WeberStep<Real>>(info);
}

MethodInfo weber_info(std::string_view name, std::string_view summary, std::string_view use) {
  return {.name = name,
          .summary = summary,
          .use = use,
          .source = "Assis1994",
          .family = "variational",
          .order = 2,
          .evaluations = 1,
          .stability_limit = 2,
          .make = make_weber_step<double>,
          .make_quad = make_weber_step<Quad>};
}
}  // namespace

std::span<const MethodInfo> methods::weber_list() {
  static const MethodInfo list[] = {
      weber_info("weber_implicit", "r'' in the force from the acceleration itself: verlet_aba over Weber's force",
                 "Weber's force as he wrote it, energy without drift; variational_midpoint is its symplectic peer"),
      weber_info(by_extrapolation, "r'' in the force from the two steps before: verlet_aba over Weber's force",
                 "a comparison with codes that extrapolate r'' in Weber's force: their energy drifts"),
  };
  return list;
}

}  // namespace noether
