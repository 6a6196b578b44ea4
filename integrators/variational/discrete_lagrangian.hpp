#pragma once
/// A discrete Lagrangian that the user writes, as a method.

#include "engine/description.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/classical.hpp"
#include "integrators/methods/newton.hpp"
#include "integrators/variational/follow_root.hpp"
#include "integrators/variational/lagrangian_field.hpp"
#include "integrators/variational/singular_action.hpp"
#include "numbers/dual.hpp"

#include <algorithm>
#include <concepts>
#include <memory>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

namespace noether {

/// L_d(q0, q1, h): what approximates the action of a step of h from q0 to q1.
///
///     struct MyLd {
///       template <class Real> Real operator()(const Vector<Real>& q0, const Vector<Real>& q1, const Real& h) const;
///     };
///
/// It may also offer `int order() const`, else it counts as order 1, and the work of forces beside the action, as the
/// discrete principle of d'Alembert has it, delta S + f- . delta q0 + f+ . delta q1:
///
///     template <class Real> void force(const Vector<Real>& q0, const Vector<Real>& q1, const Real& h,
///                                      Vector<Real>& minus, Vector<Real>& plus) const;
///
/// One with `describe()` has parameters, and is a method of scenes, by its name: see `Variational::info`.
template <class Ld, class Real>
concept DiscreteLagrangian = requires(const Ld& ld, const Vector<Real>& q, const Real& h) {
  { ld(q, q, h) } -> std::convertible_to<Real>;
};

namespace detail {

template <class Ld> constexpr std::string_view discrete_name() {
  if constexpr (Described<Ld>) {
    return part_name<Ld>();
  } else {
    return "discrete_lagrangian";
  }
}

/// Why a user's discrete Lagrangian cannot step a field; of forces it sees its own alone, and of time nothing.
/// @throws SchemeMismatch
void check_own_action(std::string_view name, bool has_force, const FieldClaims& field);

/// Derivatives of L_d over numbers of any type, and what they are computed in.
template <class Ld, class Number> class DiscreteSlopes {
 public:
  /// D1 L_d (`first`) or D2 L_d at (q0, q1), shape (n).
  /// @cost L_d in numbers with four slopes, for every four coordinates
  void find(const Ld& ld, const Vector<Number>& q0, const Vector<Number>& q1, const Number& h, bool first,
            Vector<Number>& out) {
    const Index n = q0.size();
    for (Vector<Sloped>* of : {&from_, &to_}) of->resize(n);
    for (Index i = 0; i < n; ++i) {
      from_[i] = Sloped(q0[i]);
      to_[i] = Sloped(q1[i]);
    }
    out.resize(n);
    Vector<Sloped>& by = first ? from_ : to_;
    for (Index begin = 0; begin < n; begin += slopes) {
      const Index end = std::min(begin + slopes, n);
      for (Index i = begin; i < end; ++i) by[i].slope[static_cast<std::size_t>(i - begin)] = Number(1);
      const Sloped action = ld(from_, to_, Sloped(h));
      for (Index i = begin; i < end; ++i) {
        by[i].slope[static_cast<std::size_t>(i - begin)] = Number(0);
        out[i] = action.slope[static_cast<std::size_t>(i - begin)];
      }
    }
  }

 private:
  static constexpr Index slopes = 4;
  using Sloped = Dual<Number, static_cast<std::size_t>(slopes)>;

  Vector<Sloped> from_, to_;
};

/// p0 = -D1 L_d - f-, p1 = D2 L_d + f+: q1 by Newton's iteration to rounding, with D1 D2 L_d by nested dual numbers.
/// @cost n/4 discrete Lagrangians over numbers with four slopes for each of four to six updates, and n^2/4 over nested
/// ones
template <class Ld, class Real> class DiscreteMethod final : public Method<Real> {
  using Along = Dual<Real, 1>;

 public:
  explicit DiscreteMethod(Ld ld) : ld_(std::move(ld)) {}

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<DiscreteMethod>(*this); }
  MethodClaims claims() const override {
    int order = 1;
    if constexpr (requires { ld_.order(); }) order = ld_.order();
    return {.name = discrete_name<Ld>(), .order = order, .symplectic = !has_force, .second_order_only = true};
  }
  void bind(const VectorField<Real>& f) override {
    if (LagrangianField<Real>::behind(f) == nullptr) refuse_without_lagrangian(discrete_name<Ld>(), f.claims().name);
    check_own_action(discrete_name<Ld>(), has_force, f.claims());
    n_ = f.size() / 2;
    for (Vector<Real>* v : {&q0_, &q1_, &p0_, &left_, &update_, &before_, &minus_, &plus_, &slope_}) v->resize(n_);
    for (Vector<Along>* v : {&from_, &to_, &along_slope_, &along_minus_, &along_plus_}) v->resize(n_);
    matrix_.resize(n_, n_);
  }

  StepResult step(VectorField<Real>& f, const Real& /*t*/, Vector<Real>& y, double h) override {
    StepResult made{.h = h};
    q0_ = y.head(n_);
    p0_ = y.tail(n_);
    made.failure = find_end(f, h);
    if (made.failure) return made;
    h_ = h;
    find_forces(q1_, Real(h));
    slopes_.find(ld_, q0_, q1_, Real(h), false, slope_);
    for (Index i = 0; i < n_; ++i) {
      y[i] = q1_[i];
      y[n_ + i] = slope_[i] + plus_[i];
    }
    return made;
  }

  bool has_action() const override { return true; }
  Real action(VectorField<Real>& /*f*/, const Real& /*t*/, const Vector<Real>& y) override {
    return ld_(Vector<Real>(y.head(n_)), q1_, Real(h_));
  }
  Memory memory() const override { return Memory::none; }
  void save(SavedState& /*saved*/, const std::string& /*prefix*/) const override {}
  void load(const SavedState& /*saved*/, const std::string& /*prefix*/) override {}

 private:
  static constexpr bool has_force = requires(const Ld& ld, const Vector<Real>& q, const Real& h, Vector<Real>& f) {
    ld.force(q, q, h, f, f);
  };

  /// The root that continues the motion, as in integrators/variational/galerkin.hpp.
  std::optional<Failure> find_end(VectorField<Real>& f, double h) {
    q1_ = q0_;
    bool near = true;
    const std::optional<Failure> failure = solve(f, h, near);
    if (!failure && near) return {};
    const Vector<Real> found = q1_;
    q1_ = q0_;
    const FollowedRoot followed = follow_root([&](double to, double from) {
      const Vector<Real> kept = q1_;
      if (from > 0) q1_ = q0_ + Real(to / from) * (kept - q0_);
      bool near_piece = true;
      if (!solve(f, to * h, near_piece) && near_piece) return true;
      q1_ = kept;
      return false;
    });
    if (followed.reached == 1) return {};
    if (followed.lost) return singular_action(h, followed.reached, q1_);
    q1_ = found;
    return failure;
  }

  /// Newton's iteration from the q1 at hand.
  std::optional<Failure> solve(VectorField<Real>& f, double h, bool& near) {
    const Vector<Real> guess = q1_;
    if (!renew_matrix(f, Real(h))) return singular_action(h, 0, q0_);
    const auto correct = [&]() -> std::optional<UpdateSize> {
      ++f.evaluations().force;
      find_forces(q1_, Real(h));
      slopes_.find(ld_, q0_, q1_, Real(h), true, slope_);
      for (Index i = 0; i < n_; ++i) left_[i] = -(p0_[i] + slope_[i] + minus_[i]);
      factors_.solve(left_, update_);
      before_ = q1_;
      q1_ += update_;
      return update_size(update_.data(), 1, before_.data(), q1_.data(), n_);
    };
    const auto restart = [&] {
      q1_ = guess;
      near = false;  // another matrix may lead to another root
    };
    return newton_to_rounding<Real>(correct, restart, [&] { return renew_matrix(f, Real(h)); });
  }

  void find_forces(const Vector<Real>& q1, const Real& h) {
    minus_.setZero();
    plus_.setZero();
    if constexpr (has_force) ld_.force(q0_, q1, h, minus_, plus_);
  }

  /// D1 D2 L_d + df-/dq1 at (q0, q1).
  bool renew_matrix(VectorField<Real>& f, const Real& h) {
    ++f.evaluations().jacobian;
    for (Index k = 0; k < n_; ++k) {
      for (Index i = 0; i < n_; ++i) {
        from_[i] = Along(q0_[i]);
        to_[i] = detail::along(q1_[i], Real(i == k ? 1 : 0));
        along_minus_[i] = along_plus_[i] = Along(Real(0));
      }
      if constexpr (has_force) ld_.force(from_, to_, Along(h), along_minus_, along_plus_);
      along_slopes_.find(ld_, from_, to_, Along(h), true, along_slope_);
      for (Index i = 0; i < n_; ++i) matrix_(i, k) = along_slope_[i].slope[0] + along_minus_[i].slope[0];
    }
    return factors_.compute(matrix_);
  }

  Ld ld_;
  Index n_ = 0;
  double h_ = 0;
  Vector<Real> q0_, q1_, p0_, left_, update_, before_, minus_, plus_, slope_;
  DiscreteSlopes<Ld, Real> slopes_;
  DiscreteSlopes<Ld, Along> along_slopes_;
  Vector<Along> from_, to_, along_slope_, along_minus_, along_plus_;
  Matrix<Real> matrix_;
  DenseFactors<Real> factors_;
};

/// A state (q, p) with nothing known of its motion but what a discrete Lagrangian makes of it.
class LoneState final : public LagrangianField<double> {
 public:
  explicit LoneState(std::string name) : name_(std::move(name)) {}
  std::unique_ptr<VectorField<double>> clone() const override { return std::make_unique<LoneState>(*this); }
  FieldClaims claims() const override { return {.name = name_, .variables = true}; }
  std::string signature() const override { return name_; }
  void bind(const ParticleSystem<double>& s) override;
  Index size() const override { return size_; }
  void gather(const ParticleSystem<double>& s, Vector<double>& y) const override;
  void scatter(const Vector<double>& y, ParticleSystem<double>& s) const override;
  EnergyTerms<double> energy(const ParticleSystem<double>& /*s*/) override { return {}; }
  void accelerations(const ParticleSystem<double>& /*s*/, VectorColumn<double>& /*a*/) override {}
  double action_density(const double& t, const Vector<double>& q, const Vector<double>& v) override;
  void terms_along(const double& t, const Vector<double>& q, const Vector<double>& v, const double& dt,
                   const Vector<double>& dq, const Vector<double>& dv, LagrangianTerms<double>& out) override;

 protected:
  void find_terms(const double& t, const Vector<double>& q, const Vector<double>& v,
                  LagrangianTerms<double>& out) override;
  void find_tangent(const double& t, const Vector<double>& q, const Vector<double>& v,
                    LagrangianTangent<double>& out) override;

 private:
  std::string name_;
  Index size_ = 0;
};

}  // namespace detail

/// A user's discrete Lagrangian as a method:
///
///     Simulation swing(initial_state(Pendulum{}, {2.0}, {0.3}), variational(Pendulum{}, Variational{MyLd{}}), 0.5);
///     Simulation alone(phase_state({2.0}, {0.3}), variational(Variational{MyLd{}}), 0.5);   // nothing but L_d
///     parts.add_method(Variational<MyLd>::info());      // in scenes: method = the name that MyLd describes itself
///     with
///
/// With a system behind it, its energy, its shadow and its truth in extended precision are known too.
/// @source MarsdenWest2001
template <class Ld> class Variational {
 public:
  static_assert(DiscreteLagrangian<Ld, double> && DiscreteLagrangian<Ld, Dual<double, 1>>,
                "a discrete Lagrangian is a call over any number type: template <class Real> Real operator()(const "
                "Vector<Real>& q0, const Vector<Real>& q1, const Real& h) const");
  static_assert(Described<Ld> || std::is_empty_v<Ld>,
                "a discrete Lagrangian with parameters describes itself: static constexpr auto describe()");

  explicit Variational(Ld ld = {}) : ld_(std::move(ld)) {}

  /// It as the lists of methods have it.
  static const MethodInfo& info() {
    static const MethodInfo made = [] {
      MethodInfo own{.name = detail::discrete_name<Ld>(),
                     .summary = "a discrete Lagrangian of your own, made stationary",
                     .use = "a discrete Lagrangian of your own",
                     .source = "MarsdenWest2001",
                     .family = "variational",
                     .make = make<double>,
                     .make_quad = make<Quad>};
      if constexpr (Described<Ld>) own.options = {&own_options<Ld>};
      if constexpr (requires(const Ld& ld) { ld.order(); }) {
        own.order = Ld{}.order();
      } else {
        own.order = 1;
      }
      return own;
    }();
    return made;
  }
  operator MethodChoice() const {  // NOLINT: it is a method
    MethodChoice choice{&info(), {}};
    if constexpr (Described<Ld>) choice.options.own = ld_;
    return choice;
  }

 private:
  template <class Real>
  static std::unique_ptr<Method<Real>> make(const MethodInfo& /*info*/, const MethodOptions& options) {
    if constexpr (Described<Ld>) {
      return std::make_unique<detail::DiscreteMethod<Ld, Real>>(options.own.as<Ld>());
    } else {
      return std::make_unique<detail::DiscreteMethod<Ld, Real>>(Ld{});
    }
  }

  Ld ld_;
};

/// Coordinates q and momenta p that belong to no system.
/// @throws Error  for other numbers of momenta than of coordinates
ParticleSystem<double> phase_state(std::vector<double> q, const std::vector<double>& p);

/// A discrete Lagrangian alone: no energy is known, and other methods cannot step it.
template <class Ld> Classical<double> variational(const Variational<Ld>& method) {
  return Classical<double>(std::make_unique<detail::LoneState>(std::string(detail::discrete_name<Ld>())), method);
}

}  // namespace noether
