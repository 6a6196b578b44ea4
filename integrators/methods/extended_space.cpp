#include "integrators/methods/extended_space.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>

namespace noether {

namespace {

/// How far apart the copies may be, of the largest that the state has been.
constexpr double farthest_copies = 0.1;
/// Omega beside the strongest coupling of the start: of canonical systems, and of particles.
constexpr double bond_over_curvature = 2, bond_over_rate = 8;

std::vector<std::string> compositions(int order) {
  std::vector<std::string> names;
  for (const Scheme* scheme : schemes::all()) {
    if (scheme->is_composition() && (order == 0 || scheme->order.classical == order)) names.emplace_back(scheme->name);
  }
  return names;
}

void check_composition(const std::string& name) {
  if (name.empty()) return;
  const Scheme* const scheme = schemes::find(name);
  if (scheme == nullptr) {
    refuse_field("composition", name, "is not a scheme" + did_you_mean(name, compositions(0)));
  }
  if (!scheme->is_composition()) {
    refuse_field("composition", name, "is not a symmetric composition; use one, such as yoshida_4");
  }
}

/// Lengths of the sub-steps of a composition, which add up to 1. @throws Error  for one of another order
template <class Real>
std::vector<Real> substeps_of(std::string_view method, int order, const std::string& composition) {
  const std::string name = !composition.empty() ? composition
                           : order == 2         ? "verlet"
                           : order == 4         ? "yoshida_4"
                           : order == 6         ? "kahan_li_6_s9"
                                                : "kahan_li_8_s17";
  const Scheme& scheme = *schemes::find(name);
  if (scheme.order.classical != order) {
    throw Error(fmt::format("composition = \"{}\" has order {}, but method '{}' order {}; use {}", name,
                            scheme.order.classical, method, order, fmt::join(compositions(order), ", ")),
                {.key = "composition", .value = name});
  }
  std::vector<Stage> stages;
  for (std::size_t k = 0; k < scheme.substep_count; ++k) stages.push_back({'A', scheme.substeps[k]});
  return rounded_weights<Real>(std::span<const Stage>(stages));
}

/// What extended phase space asks of a field. @throws SchemeMismatch
template <class Real> void require_canonical(std::string_view method, const VectorField<Real>& f) {
  const FieldClaims field = f.claims();
  if (field.canonical || (field.second_order && !field.velocity_dependent)) return;
  throw SchemeMismatch(fmt::format(
      "method '{}' is for an energy H(q, p), but '{}' has rates of another kind; use 'gauss_4'", method, field.name));
}

template <class Real> Real largest(const Vector<Real>& y, int half) {
  const Index n = y.size() / 2;
  return n == 0 ? Real(0) : Real(y.segment(half * n, n).cwiseAbs().maxCoeff());
}

/// What the bond of the copies is measured by. Of a canonical system the largest second derivative of H about y, in the
/// units of q and p as they are; of particles the fastest rate, the root of the largest eigenvalue of J^2, J = df/dy.
/// 0 where there is none.
/// @cost 16 products J v, each of them two evaluations where J is not known
template <class Real> Real strongest_coupling(VectorField<Real>& f, const Real& t, const Vector<Real>& y) {
  using std::cbrt, std::max, std::min, std::sqrt;
  const Index n = y.size() / 2;
  const bool canonical = f.claims().canonical && f.particles() == 0;
  const Real unset(std::numeric_limits<double>::max()), size[2] = {largest(y, 0), largest(y, 1)};
  Vector<Real> v, w, up, down, moved;
  const auto product = [&](const Vector<Real>& along, Vector<Real>& out) {
    if (f.has_derivative()) return f.derivative(t, y, Real(0), along, out);
    Real step = unset;
    for (const int half : {0, 1}) {
      const Real way = largest(along, half);
      if (way > Real(0) && size[half] > Real(0)) step = min(step, Real(size[half] / way));
    }
    step = step == unset ? Real(1) : step * Real(cbrt(std::numeric_limits<Real>::epsilon()));
    moved = y + step * along;
    f.rate(t, moved, up);
    moved = y - step * along;
    f.rate(t, moved, down);
    out = (up - down) / (step + step);
  };
  const auto apply = [&](const Vector<Real>& along) {
    product(along, w);
    if (!canonical) return;
    moved = w;  // (dH/dp, -dH/dq) becomes the gradient
    w.head(n) = -moved.tail(n);
    w.tail(n) = moved.head(n);
  };
  f.rate(t, y, v);
  if (largest(v, 0) == Real(0) || largest(v, 1) == Real(0)) v.setOnes(y.size());
  Real square(0);
  for (int k = 0; k < 8; ++k) {
    apply(v);
    const Vector<Real> once = w;
    apply(once);
    square = Real(0);
    for (const int half : {0, 1}) {
      const Real before = canonical ? Real(v.cwiseAbs().maxCoeff()) : largest(v, half);
      if (before > Real(0)) square = max(square, Real(largest(w, half) / before));
    }
    if (!(square > Real(0)) || !std::isfinite(static_cast<double>(square))) return Real(0);
    v = w / square;
  }
  return Real(sqrt(square));
}

}  // namespace

void SemiexplicitOptions::check() const { check_composition(composition); }

void TaoOptions::check() const {
  if (omega && !(*omega > 0 && std::isfinite(*omega))) {
    refuse_field("omega", *omega,
                 "is not a valid rate of the copies about each other; one above 0 is expected, some times the fastest "
                 "rate of the motion");
  }
}

// ---- both copies ---------------------------------------------------------------------------------------------------

template <class Real> void TwinStates<Real>::resize(Index size) {
  for (Vector<Real>* v : {&first, &second, &mixed_, &rates_}) v->setZero(size);
}

template <class Real>
void TwinStates<Real>::move_second_positions(VectorField<Real>& f, const Real& t, const Real& tau) {
  const Index n = first.size() / 2;
  mixed_.head(n) = first.head(n);
  mixed_.tail(n) = second.tail(n);
  f.rate(t, mixed_, rates_);
  second.head(n) += tau * rates_.head(n);
  first.tail(n) += tau * rates_.tail(n);
}

template <class Real>
void TwinStates<Real>::move_first_positions(VectorField<Real>& f, const Real& t, const Real& tau) {
  const Index n = first.size() / 2;
  mixed_.head(n) = second.head(n);
  mixed_.tail(n) = first.tail(n);
  f.rate(t, mixed_, rates_);
  first.head(n) += tau * rates_.head(n);
  second.tail(n) += tau * rates_.tail(n);
}

template <class Real> void TwinStates<Real>::turn_difference(const Real& angle, const Vector<Real>& scales) {
  using std::cos, std::sin;
  const Index n = first.size() / 2;
  const Real c = cos(angle), s = sin(angle);
  for (Index i = 0; i < n; ++i) {
    const Real &scale = scales[i], q = first[i] - second[i], p = first[n + i] - second[n + i];
    const Real half_q = (c * q + s * p / scale - q) / Real(2), half_p = (c * p - s * q * scale - p) / Real(2);
    first[i] += half_q;
    second[i] -= half_q;
    first[n + i] += half_p;
    second[n + i] -= half_p;
  }
}

// ---- Tao's method --------------------------------------------------------------------------------------------------

template <class Real>
TaoMethod<Real>::TaoMethod(const MethodInfo& info, const MethodOptions& options)
    : name_(info.name),
      order_(info.order),
      substeps_(substeps_of<Real>(info.name, info.order, "")),
      given_omega_(options.own.as<TaoOptions>().omega) {}

template <class Real> MethodClaims TaoMethod<Real>::claims() const {
  return {.name = name_, .order = order_, .of_momenta = true};  // there and back the copies are no longer equal
}

template <class Real> void TaoMethod<Real>::bind(const VectorField<Real>& f) {
  require_canonical(name_, f);
  second_order_ = f.claims().second_order;
  of_particles_ = f.particles() > 0;
  of_momenta_ = of_particles_ && f.claims().canonical;
  twins_.resize(f.size());
  apart_.setZero(f.size());
  masses_ = of_momenta_ ? f.masses() : Vector<Real>::Ones(f.size() / 2);
  scales_ = Vector<Real>::Ones(f.size() / 2);
  begun_ = false;
}

template <class Real>
void TaoMethod<Real>::begin(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  begun_ = true;
  largest_ = {Real(0), Real(0)};
  const double over = of_particles_ ? bond_over_rate : bond_over_curvature;
  const Real coupling = given_omega_ && !of_momenta_ ? Real(0) : strongest_coupling(f, t, y);
  omega_ = given_omega_ ? Real(*given_omega_) : Real(over) * coupling;
  if (!(omega_ > Real(0))) omega_ = Real(1 / std::abs(h));
  stretch_ = of_momenta_ && coupling > Real(0) ? coupling / Real(2) : omega_;
  scale_momenta();
}

/// Of particles a rate relates positions and velocities, of charges positions and p/m = v + q A/m, which in a magnetic
/// field is the half of that by which it turns; of other systems both are turned as they are.
template <class Real> void TaoMethod<Real>::scale_momenta() {
  if (of_particles_) scales_ = stretch_ * masses_;
}

template <class Real> void TaoMethod<Real>::moved(VectorField<Real>& /*f*/, const Real& /*t*/, const Vector<Real>&) {
  apart_.setZero();
}

/// Tells of copies that have parted.
template <class Real> std::optional<Failure> TaoMethod<Real>::watch() {
  using std::max;
  for (const int half : {0, 1}) {
    Real& size = largest_[static_cast<std::size_t>(half)];
    size = max(size, max(largest(twins_.first, half), largest(twins_.second, half)));
    const Real distance = largest(apart_, half);
    if (!(distance > Real(farthest_copies) * size)) continue;
    return Failure{
        Outcome::Kind::solver_failure, -1, "copies",
        fmt::format("the copies of the state are {:.2g} of its size apart in {}: omega = {:.3g} is too small "
                    "or the step too long; give a larger omega, a shorter step, or use 'semiexplicit_{}'",
                    static_cast<double>(distance / size),
                    half == 0       ? "positions"
                    : second_order_ ? "velocities"
                                    : "momenta",
                    static_cast<double>(omega_), order_)};
  }
  return {};
}

template <class Real> StepResult TaoMethod<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  if (!begun_) begin(f, t, y, h);
  StepResult made{.h = h};
  twins_.first = y;
  twins_.second = y + apart_;
  Real gone(0), pending(0);  // of the step; of the half step of A that is joined with the next one
  for (const Real& part : substeps_) {
    const Real half = part * Real(h) / Real(2), now = t + gone * Real(h);
    twins_.move_second_positions(f, now, pending + half);
    twins_.move_first_positions(f, now, half);
    twins_.turn_difference(Real(4) * omega_ * half, scales_);
    gone += part;
    twins_.move_first_positions(f, t + gone * Real(h), half);
    pending = half;
  }
  twins_.move_second_positions(f, t + gone * Real(h), pending);
  y = twins_.first;
  apart_ = twins_.second - twins_.first;
  made.failure = watch();
  return made;
}

template <class Real> void TaoMethod<Real>::save(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "begun", begun_);
  save_value(saved, prefix + "omega", omega_);
  if (of_momenta_) save_value(saved, prefix + "stretch", stretch_);
  save_value(saved, prefix + "largest", largest_);
  save_value(saved, prefix + "apart", std::vector<Real>(apart_.begin(), apart_.end()));
}

template <class Real> void TaoMethod<Real>::load(const SavedState& saved, const std::string& prefix) {
  load_value(saved, prefix + "begun", begun_);
  load_value(saved, prefix + "omega", omega_);
  stretch_ = omega_;
  if (of_momenta_) load_value(saved, prefix + "stretch", stretch_);
  load_value(saved, prefix + "largest", largest_);
  std::vector<Real> apart;
  load_value(saved, prefix + "apart", apart);
  if (std::ssize(apart) != apart_.size()) {
    throw Error(fmt::format("the saved run has {} variables, but this one {}", apart.size(), apart_.size()));
  }
  std::copy(apart.begin(), apart.end(), apart_.begin());
  scale_momenta();
}

// ---- the semiexplicit method ---------------------------------------------------------------------------------------

namespace {

/// The equations of the multiplier, in units of how large positions and momenta are.
template <class Real> class MultiplierEquations final : public StepEquations<Real> {
 public:
  MultiplierEquations(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h,
                      const std::vector<Real>& substeps, const std::array<Real, 2>& sizes, TwinStates<Real>& twins)
      : f_(f), t_(t), y_(y), h_(h), substeps_(substeps), sizes_(sizes), twins_(twins) {}

  void map(const Real& part, const Vector<Real>& x, Vector<Real>& out) override {
    const Index n = x.size() / 2;
    twins_.set(y_);
    for (Index i = 0; i < 2 * n; ++i) {
      const Real multiplier = size_of_half(i < n) * x[i];
      twins_.first[i] += multiplier;
      twins_.second[i] -= multiplier;
    }
    walk(part * Real(h_));
    out.resize(2 * n);
    for (Index i = 0; i < 2 * n; ++i) {
      out[i] = (x[i] - (twins_.first[i] - twins_.second[i]) / (Real(2) * size_of_half(i < n))) / Real(2);
    }
  }
  UpdateSize size_of(const Real& /*part*/, const Vector<Real>& update, const Vector<Real>& /*x*/) override {
    const double most = static_cast<double>(Real(update.cwiseAbs().maxCoeff()));
    return {most, most};
  }
  Real reach(const Real& /*part*/, const Vector<Real>& /*x*/) const override { return Real(1); }

 private:
  const Real& size_of_half(bool positions) const { return sizes_[positions ? 0 : 1]; }
  /// A step of A/2 B A/2 for each sub-step, halves of A joined where they meet.
  void walk(const Real& h) {
    Real gone(0), pending(0);
    for (const Real& part : substeps_) {
      const Real whole = part * h, half = whole / Real(2);
      twins_.move_second_positions(f_, t_ + gone * h, pending + half);
      twins_.move_first_positions(f_, t_ + (gone + part / Real(2)) * h, whole);
      gone += part;
      pending = half;
    }
    twins_.move_second_positions(f_, t_ + gone * h, pending);
  }

  VectorField<Real>& f_;
  const Real& t_;
  const Vector<Real>& y_;
  double h_;
  const std::vector<Real>& substeps_;
  const std::array<Real, 2>& sizes_;
  TwinStates<Real>& twins_;
};

}  // namespace

template <class Real>
SemiexplicitMethod<Real>::SemiexplicitMethod(const MethodInfo& info, const MethodOptions& options)
    : name_(info.name),
      order_(info.order),
      substeps_(substeps_of<Real>(info.name, info.order, options.own.as<SemiexplicitOptions>().composition)) {}

template <class Real> MethodClaims SemiexplicitMethod<Real>::claims() const {
  return {.name = name_,
          .order = order_,
          .symplectic = true,
          .reversible = true,
          .keeps_angular_momentum = true,
          .of_momenta = true};
}

template <class Real> void SemiexplicitMethod<Real>::bind(const VectorField<Real>& f) {
  require_canonical(name_, f);
  twins_.resize(f.size());
  rate_.resize(f.size());
  multiplier_.setZero(f.size());
  root_.bind(f.size(), {});
}

template <class Real>
StepResult SemiexplicitMethod<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  using std::abs, std::max;
  StepResult made{.h = h};
  f.rate(t, y, rate_);
  std::array<Real, 2> sizes;
  for (const int half : {0, 1}) {
    const Real size = max(largest(y, half), Real(abs(Real(h)) * largest(rate_, half)));
    sizes[static_cast<std::size_t>(half)] = size > Real(0) ? size : Real(1);
  }
  MultiplierEquations<Real> equations(f, t, y, h, substeps_, sizes, twins_);
  multiplier_.setZero();
  made.failure = root_.solve(equations, multiplier_, h, f.evaluations());
  if (made.failure) return made;
  equations.map(Real(1), multiplier_, rate_);
  y = (twins_.first + twins_.second) / Real(2);
  return made;
}

template class TwinStates<double>;
template class TwinStates<Quad>;
template class TaoMethod<double>;
template class TaoMethod<Quad>;
template class SemiexplicitMethod<double>;
template class SemiexplicitMethod<Quad>;

namespace {

template <class Real> std::unique_ptr<Method<Real>> make_tao(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<TaoMethod<Real>>(info, options);
}
template <class Real>
std::unique_ptr<Method<Real>> make_semiexplicit(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<SemiexplicitMethod<Real>>(info, options);
}

MethodInfo tao(std::string_view name, std::string_view summary, int order) {
  return {.name = name,
          .summary = summary,
          .use = "explicit steps of energies that no splitting divides; omega is to be chosen",
          .source = "Tao2016",
          .family = "extended space",
          .options = {&own_options<TaoOptions>},
          .order = order,
          .make = make_tao<double>,
          .make_quad = make_tao<Quad>};
}
MethodInfo semiexplicit(std::string_view name, std::string_view summary, int order) {
  return {.name = name,
          .summary = summary,
          .use = "symplectic steps of energies that no splitting divides, without derivatives of rates",
          .source = "JayawardanaOhsawa2023",
          .family = "extended space",
          .options = {&own_options<SemiexplicitOptions>},
          .order = order,
          .make = make_semiexplicit<double>,
          .make_quad = make_semiexplicit<Quad>};
}

}  // namespace

std::span<const MethodInfo> methods::extended_space_list() {
  static const MethodInfo list[] = {
      semiexplicit("semiexplicit_2", "two copies of the state, brought together by a multiplier in every step", 2),
      semiexplicit("semiexplicit_4", "the same by a composition of order 4", 4),
      semiexplicit("semiexplicit_6", "the same by a composition of order 6", 6),
      semiexplicit("semiexplicit_8", "the same by a composition of order 8", 8),
      tao("tao_2", "Tao's method: two copies of the state, bound by a spring", 2),
      tao("tao_4", "the same by a composition of order 4", 4),
  };
  return list;
}

}  // namespace noether
