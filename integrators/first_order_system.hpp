#pragma once
/// Systems of first order, y' = f(t, y): kinetics, circuits, heat. The classical methods step them.

#include "engine/signature.hpp"
#include "integrators/classical.hpp"
#include "numbers/dual.hpp"

#include <concepts>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// What a system of first order offers: how many variables it has, and their rates.
///
///     struct Decay {
///       double rate = 1;
///       Index size() const { return 1; }
///       template <class Real> void rates(const Real& t, const Vector<Real>& y, Vector<Real>& dy) const {
///         dy[0] = -rate * y[0];
///       }
///     };
///
/// It may also offer `Sparsity sparsity() const`, where its Jacobian can be other than 0,
/// `std::vector<double> start() const`, the values it begins with, `std::vector<std::string> names() const` of its
/// variables, `std::vector<double> exact(double t) const`, the solution from `start()` at time 0, and
/// `std::vector<double> start_at(double t) const`, where a run that begins at another time is to begin elsewhere.
/// Jacobians are found by dual numbers where `rates` is a template on the number type, else by differences.
template <class S, class Real>
concept FirstOrderSystem = requires(const S& system, const Real& t, const Vector<Real>& y, Vector<Real>& dy) {
  { system.size() } -> std::convertible_to<Index>;
  system.rates(t, y, dy);
};

namespace detail {
/// The field of a system, over one number type: each kind of system has its own, for instance
/// `SystemMotion<Lorenz, double>`.
template <class S, class Real> struct MotionOf;

/// How many variables a system has: as many as it has sizes, or, where one function of its coordinates tells the
/// motion, a momentum for each of them too.
template <class S> Index variable_count(const S& system) {
  if constexpr (requires { requires MotionOf<S, double>::has_momenta; }) return 2 * Index(system.size());
  return Index(system.size());
}
}  // namespace detail

/// Any kind of system whose motion is known: of first order, or Hamiltonian (integrators/hamiltonian_system.hpp).
template <class S, class Real>
concept MovingSystem = requires {
  typename detail::MotionOf<S, Real>::type;
};

/// The state a system begins with: `Simulation run(initial_state(Lorenz{}), classical(Lorenz{}, method("dop853")))`.
/// @throws Error  if the system refuses its fields, or has other numbers of values, names and variables
template <class S>
ParticleSystem<double> initial_state(const S& system, std::vector<double> values,
                                     const UnitSystem& units = unit_system("reduced")) {
  const Index count = detail::variable_count(system);
  const auto check = [&](std::size_t given, const char* what) {
    if (static_cast<Index>(given) == count) return;
    throw Error(
        fmt::format("system '{}' has {} variables, but there are {} {}", detail::name_of(system), count, given, what));
  };
  check_part(system);
  check(values.size(), "values to start from");
  std::vector<std::string> names;
  if constexpr (requires { system.names(); }) {
    names = system.names();
    check(names.size(), "names");
  }
  ParticleSystem<double> s(units);
  s.set_variables(std::move(values), std::move(names));
  return s;
}
template <class S>
  requires requires(const S& system) { system.start(); }
ParticleSystem<double> initial_state(const S& system) { return initial_state(system, system.start()); }

/// A first-order system as the classical methods see it; its variables stand in `ParticleSystem::variables`.
template <class S, class Real> class SystemMotion final : public VectorField<Real> {
 public:
  explicit SystemMotion(S system) : system_(std::move(system)) {}

  std::unique_ptr<VectorField<Real>> clone() const override { return std::make_unique<SystemMotion>(*this); }
  FieldClaims claims() const override {
    return {.name = detail::name_of(system_), .variables = true, .time_dependent = true};
  }
  std::string signature() const override { return detail::signature_of(system_); }

  void bind(const ParticleSystem<Real>& s) override {
    if (static_cast<Index>(s.variables().size()) == system_.size() && s.size() == 0) return;
    throw Error(fmt::format("system '{}' has {} variables, but it was given {} and {} particles",
                            detail::name_of(system_), system_.size(), s.variables().size(), s.size()));
  }
  Index size() const override { return system_.size(); }
  void gather(const ParticleSystem<Real>& s, Vector<Real>& y) const override {
    y.resize(size());
    for (Index i = 0; i < size(); ++i) y[i] = s.variables()[static_cast<std::size_t>(i)];
  }
  void scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const override {
    for (Index i = 0; i < size(); ++i) s.variables()[static_cast<std::size_t>(i)] = y[i];
  }
  Sparsity sparsity() const override {
    if constexpr (requires { system_.sparsity(); }) return system_.sparsity();
    return {};
  }

  bool has_derivative() const override { return FirstOrderSystem<S, Dual<Real, 1>>; }
  void derivative(const Real& t, const Vector<Real>& y, const Real& dt, const Vector<Real>& dy,
                  Vector<Real>& out) override {
    if constexpr (FirstOrderSystem<S, Dual<Real, 1>>) {
      const Index n = y.size();
      for (auto* v : {&point_, &rates_}) v->resize(n);
      for (Index i = 0; i < n; ++i) point_[i] = detail::along(y[i], dy[i]);
      system_.rates(detail::along(t, dt), point_, rates_);
      out.resize(n);
      for (Index i = 0; i < n; ++i) out[i] = rates_[i].slope[0];
    } else {
      VectorField<Real>::derivative(t, y, dt, dy, out);
    }
  }

  EnergyTerms<Real> energy(const ParticleSystem<Real>& /*s*/) override { return {}; }
  void accelerations(const ParticleSystem<Real>& /*s*/, VectorColumn<Real>& /*a*/) override {}

 protected:
  void evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) override {
    dy.resize(y.size());
    system_.rates(t, y, dy);
  }

 private:
  S system_;
  Vector<Dual<Real, 1>> point_, rates_;  ///< work of `derivative`
};

template <class S, class Real>
  requires FirstOrderSystem<S, Real>
struct detail::MotionOf<S, Real> {
  using type = SystemMotion<S, Real>;
};

/// A classical method over a system: `classical(Robertson{}, method("rodas_4"))`.
template <class S>
  requires MovingSystem<S, double> Classical<double> classical(S system, const MethodChoice& choice) {
    return Classical<double>(std::make_unique<typename detail::MotionOf<S, double>::type>(std::move(system)), choice);
  }

}  // namespace noether
