#include "integrators/methods/discrete_gradient.hpp"

#include "engine/sums.hpp"
#include "integrators/all_methods.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace noether {

namespace {

/// The potential of particles, or H of a system, counted as a force is.
template <class Real> class CountedEnergy {
 public:
  CountedEnergy(VectorField<Real>& f, const Real& t, bool of_particles) : f_(f), t_(t), of_particles_(of_particles) {}
  Real operator()(const Vector<Real>& y) const {
    ++f_.evaluations().force;
    return of_particles_ ? f_.potential(t_, y) : f_.hamiltonian(t_, y);
  }

 private:
  VectorField<Real>& f_;
  const Real& t_;
  bool of_particles_;
};

/// What is missing of a difference of energies, over the square of the displacement; 0 where it is rounding.
template <class Real> Real missing_part(const Real& missing, const Real& scale, const Real& square) {
  using std::abs;
  const Real rounding = std::numeric_limits<Real>::epsilon();
  return abs(missing) <= rounding * scale || !(square > Real(0)) ? Real(0) : Real(missing / square);
}

/// Work arrays of a step, so that none allocates any.
template <class Real> struct DisplacementWork { Vector<Real>&middle, &way, &end; };

/// Gonzalez's mean force of particles.
template <class Real> class GonzalezForce final : public MeanForce<Real> {
 public:
  /// @param about_center  whether the displacements are those about that of the center of mass
  GonzalezForce(VectorField<Real>& f, const Real& t, const Vector<Real>& y, const Vector<Real>& masses,
                bool about_center, DisplacementWork<Real> work)
      : f_(f),
        t_(t),
        energy_(f, t, true),
        masses_(masses),
        about_center_(about_center),
        work_(work),
        before_(energy_(y)) {}

  void between(const Vector<Real>& y0, const Vector<Real>& y1, Vector<Real>& a) override {
    using std::abs;
    work_.middle = (y0 + y1) / Real(2);
    f_.acceleration(t_, work_.middle, a);
    const Real after = energy_(y1);
    const Index n = masses_.size();
    Vector<Real>& moved = work_.way;
    moved = y1.head(n) - y0.head(n);
    const auto [done, size] = sums_over<Real, 2>(n, [&](Index i) {
      const Real part = masses_[i] * a[i] * moved[i];
      return std::array<Real, 2>{part, abs(part)};
    });
    if (about_center_) take_mean_from(moved);
    const Real square = sum_over<Real>(n, [&](Index i) { return masses_[i] * moved[i] * moved[i]; });
    const Real factor = missing_part(Real(before_ - after - done), Real(abs(before_) + abs(after) + size), square);
    for (Index i = 0; i < n; ++i) {
      if (masses_[i] > Real(0)) a[i] += factor * moved[i];
    }
  }

 private:
  void take_mean_from(Vector<Real>& moved) const {
    const Index n = moved.size() / 3;
    for (Index begin = 0; begin < moved.size(); begin += n) {
      const auto [mass, moment] = sums_over<Real, 2>(n, [&](Index i) {
        return std::array<Real, 2>{masses_[begin + i], masses_[begin + i] * moved[begin + i]};
      });
      if (mass > Real(0)) moved.segment(begin, n).array() -= moment / mass;
    }
  }

  VectorField<Real>& f_;
  const Real& t_;
  CountedEnergy<Real> energy_;
  const Vector<Real>& masses_;
  bool about_center_;
  DisplacementWork<Real> work_;
  Real before_;
};

/// The equations of the mean rate k of a step of a Hamiltonian system, y1 = y + h k, k = J G(y, y1).
template <class Real> class GonzalezEquations final : public StepEquations<Real> {
 public:
  GonzalezEquations(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h, DisplacementWork<Real> work)
      : f_(f), t_(t), y_(y), h_(h), energy_(f, t, false), work_(work), before_(energy_(y)) {}

  void map(const Real& part, const Vector<Real>& k, Vector<Real>& out) override {
    using std::abs;
    const Index n = y_.size() / 2;
    Vector<Real>& way = work_.way;
    way = part * Real(h_) * k;
    work_.end = y_ + way;
    work_.middle = y_ + way / Real(2);
    f_.rate(t_, work_.middle, out);
    // grad H = (-p', q') of the middle.
    const auto [done, size, square] = sums_over<Real, 3>(n, [&](Index i) {
      const Real q = -out[n + i] * way[i], p = out[i] * way[n + i];
      return std::array<Real, 3>{q + p, abs(q) + abs(p), way[i] * way[i] + way[n + i] * way[n + i]};
    });
    const Real after = energy_(work_.end);
    const Real factor = missing_part(Real(after - before_ - done), Real(abs(before_) + abs(after) + size), square);
    for (Index i = 0; i < n; ++i) {
      out[i] += factor * way[n + i];
      out[n + i] -= factor * way[i];
    }
  }
  UpdateSize size_of(const Real& part, const Vector<Real>& update, const Vector<Real>& k) override {
    work_.end = y_ + part * Real(h_) * k;
    return update_size(update.data(), static_cast<double>(part) * h_, y_.data(), work_.end.data(), y_.size());
  }
  Real reach(const Real& part, const Vector<Real>& /*k*/) const override {
    using std::abs;
    const Real most = y_.cwiseAbs().maxCoeff();
    return (most > Real(0) ? most : Real(1)) / abs(part * Real(h_));
  }

 private:
  VectorField<Real>& f_;
  const Real& t_;
  const Vector<Real>& y_;
  double h_;
  CountedEnergy<Real> energy_;
  DisplacementWork<Real> work_;
  Real before_;
};

/// The equations of one coordinate of particles, or of one coordinate and its momentum, while all others stand. Of
/// particles the unknown is half of what the velocity changes by, of systems the mean rates of both.
template <class Real> class CoordinateEquations final : public StepEquations<Real> {
 public:
  /// @param mass  of the coordinate; 0: y is (q, p), and the energy that of both
  CoordinateEquations(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h, Index coordinate,
                      const Real& mass, bool momentum_first)
      : energy_(f, t, mass > Real(0)),
        y_(y),
        h_(h),
        q_(coordinate),
        p_(y.size() / 2 + coordinate),
        mass_(mass),
        momentum_first_(momentum_first),
        from_q_(y[q_]),
        from_p_(y[p_]),
        before_(energy_(y)),
        largest_q_(largest_of(y.head(y.size() / 2))),
        largest_p_(largest_of(y.tail(y.size() / 2))),
        motion_(mass > Real(0) ? Real(std::abs(h)) * y.tail(y.size() / 2).cwiseAbs().maxCoeff() : Real(0)) {}

  void map(const Real& part, const Vector<Real>& x, Vector<Real>& out) override {
    place(part, x);
    out.resize(x.size());
    const Real to_q = y_[q_], to_p = y_[p_], step = part * Real(h_);
    if (mass_ > Real(0)) {
      out[0] = -step / (Real(2) * mass_) * quotient(q_, from_q_, to_q, before_).first;
    } else if (momentum_first_) {
      y_[q_] = from_q_;
      const auto [of_p, between] = quotient(p_, from_p_, to_p, before_);
      out[0] = of_p;
      out[1] = -quotient(q_, from_q_, to_q, between).first;
    } else {
      y_[p_] = from_p_;
      const auto [of_q, between] = quotient(q_, from_q_, to_q, before_);
      out[1] = -of_q;
      out[0] = quotient(p_, from_p_, to_p, between).first;
    }
  }
  UpdateSize size_of(const Real& part, const Vector<Real>& update, const Vector<Real>& x) override {
    place(part, x);
    const double step = static_cast<double>(part) * h_;
    const bool particles = mass_ > Real(0);
    const UpdateSize q = update_size(&update[0], step, &largest_q_, &y_[q_], 1),
                     p = update_size(&update[particles ? 0 : 1], particles ? 2 : step, &largest_p_, &y_[p_], 1);
    return {std::max(q.whole, p.whole), std::max(q.each, p.each)};
  }
  Real reach(const Real& part, const Vector<Real>& /*x*/) const override {
    using std::abs;
    return largest_q_ / abs(part * Real(h_));
  }
  /// The coordinate and its momentum at the end of a part.
  void place(const Real& part, const Vector<Real>& x) {
    const Real step = part * Real(h_);
    if (mass_ > Real(0)) {
      y_[q_] = from_q_ + step * (from_p_ + x[0]);
      y_[p_] = from_p_ + Real(2) * x[0];
    } else {
      y_[q_] = from_q_ + step * x[0];
      y_[p_] = from_p_ + step * x[1];
    }
  }

 private:
  /// (H(to) - H(from)) / (to - from) of one variable, which is left at `to`, and H(to). Where they are one number to
  /// half of all digits it is the derivative between them, by a difference.
  std::pair<Real, Real> quotient(Index variable, const Real& from, const Real& to, const Real& energy) {
    using std::abs, std::sqrt;
    const Real epsilon = std::numeric_limits<Real>::epsilon();
    const Real way = to - from, scale = variable == q_ ? largest_q_ : largest_p_;
    y_[variable] = to;
    const Real after = energy_(y_);
    // Particles tell by their motion how far a force reaches; at rest, and of systems, the variable does.
    const bool moves = variable == q_ && motion_ > Real(0);
    if (abs(way) > (moves ? Real(1e-4) * motion_ : sqrt(epsilon) * scale)) return {(after - energy) / way, after};
    const Real length = moves ? Real(1e-4) * motion_ : Real(std::cbrt(static_cast<double>(epsilon))) * scale;
    const Real up = from + way / Real(2) + length, down = from + way / Real(2) - length;
    y_[variable] = up;
    const Real above = energy_(y_);
    y_[variable] = down;
    const Real below = energy_(y_);
    y_[variable] = to;
    return {(above - below) / (up - down), after};
  }

  template <class Values> static Real largest_of(const Values& values) {
    const Real most = values.cwiseAbs().maxCoeff();
    return most > Real(0) ? most : Real(1);
  }

  CountedEnergy<Real> energy_;
  Vector<Real>& y_;
  double h_;
  Index q_, p_;
  Real mass_;
  bool momentum_first_;
  Real from_q_, from_p_, before_, largest_q_, largest_p_;
  Real motion_;  ///< how far the fastest coordinate of particles goes in a step [length]
};

/// What methods by energies alone need of a field. @throws SchemeMismatch  where there is none
template <class Real> void require_energy(std::string_view method, const VectorField<Real>& f) {
  const FieldClaims field = f.claims();
  if (field.canonical || (field.second_order && f.has_potential())) return;
  throw SchemeMismatch(fmt::format(
      "method '{}' needs the energy of what it steps, but '{}' has none to tell; use 'gauss_4'", method, field.name));
}

}  // namespace

template <class Real> MethodClaims GonzalezMethod<Real>::claims() const {
  return {.name = name_,
          .order = 2,
          .reversible = true,
          .energy_exact = true,
          .conservative_only = true,
          .of_momenta = true};
}

template <class Real> void GonzalezMethod<Real>::bind(const VectorField<Real>& f) {
  require_energy(name_, f);
  const FieldClaims field = f.claims();
  second_order_ = field.second_order;
  about_center_ = field.keeps_momentum && f.particles() > 0;
  for (Vector<Real>* v : {&middle_, &way_, &end_, &rate_}) v->resize(f.size());
  if (!second_order_) return root_.bind(f.size(), form_);
  masses_ = f.masses();
  step_.bind(f, form_);
}

template <class Real>
StepResult GonzalezMethod<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made{.h = h};
  const DisplacementWork<Real> work{middle_, way_, end_};
  if (second_order_) {
    GonzalezForce<Real> force(f, t, y, masses_, about_center_, work);
    made.failure = step_.make(force, y, h, f.evaluations());
    return made;
  }
  GonzalezEquations<Real> equations(f, t, y, h, work);
  f.rate(t, y, rate_);
  made.failure = root_.solve(equations, rate_, h, f.evaluations());
  if (!made.failure) y += Real(h) * rate_;
  return made;
}

template <class Real> MethodClaims ItohAbeMethod<Real>::claims() const {
  return {.name = name_,
          .order = symmetric_ ? 2 : 1,
          .reversible = symmetric_,
          .keeps_momentum = false,
          .energy_exact = true,
          .conservative_only = true,
          .of_momenta = true};
}

template <class Real> void ItohAbeMethod<Real>::bind(const VectorField<Real>& f) {
  require_energy(name_, f);
  second_order_ = f.claims().second_order;
  unknown_.setZero(second_order_ ? 1 : 2);
  root_.bind(unknown_.size(), JacobianForm::dense);
  if (!second_order_) return;
  masses_ = f.masses();
  if (masses_.size() > 0 && !(masses_.minCoeff() > Real(0))) {
    throw SchemeMismatch(fmt::format(
        "method '{}' uses energies alone, but a particle of mass 0 has none; give every particle a mass, or use "
        "'gonzalez'",
        name_));
  }
}

/// Every coordinate once, in order or in the reversed order, and of a system its momentum with it.
template <class Real>
std::optional<Failure> ItohAbeMethod<Real>::sweep(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h,
                                                  bool reversed) {
  const Index n = y.size() / 2;
  for (Index k = 0; k < n; ++k) {
    const Index i = reversed ? n - 1 - k : k;
    CoordinateEquations<Real> equations(f, t, y, h, i, second_order_ ? masses_[i] : Real(0), reversed);
    unknown_.setZero();
    if (auto failure = root_.solve(equations, unknown_, h, f.evaluations())) return failure;
    equations.place(Real(1), unknown_);
  }
  return {};
}

template <class Real>
StepResult ItohAbeMethod<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made{.h = h};
  if (!symmetric_) {
    made.failure = sweep(f, t, y, h, false);
    return made;
  }
  made.failure = sweep(f, t, y, h / 2, false);
  if (!made.failure) made.failure = sweep(f, t, y, h / 2, true);
  return made;
}

template class GonzalezMethod<double>;
template class GonzalezMethod<Quad>;
template class ItohAbeMethod<double>;
template class ItohAbeMethod<Quad>;

namespace {

template <class Real>
std::unique_ptr<Method<Real>> make_gonzalez(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<GonzalezMethod<Real>>(info, options);
}
template <class Real>
std::unique_ptr<Method<Real>> make_itoh_abe(const MethodInfo& info, const MethodOptions& /*options*/) {
  return std::make_unique<ItohAbeMethod<Real>>(info, info.order == 2);
}

}  // namespace

std::span<const MethodInfo> methods::discrete_gradient_list() {
  static const MethodInfo list[] = {
      {.name = "gonzalez",
       .aliases = "discrete_gradient",
       .summary = "Gonzalez's discrete gradient: the middle's, and the missing work along the displacement",
       .use = "exact energy at any step, for any energy; momentum too, angular momentum not",
       .source = "Gonzalez1996",
       .family = "energy",
       .options = {linear_solver},
       .order = 2,
       .stability_limit = std::numeric_limits<double>::infinity(),
       .make = make_gonzalez<double>,
       .make_quad = make_gonzalez<Quad>},
      {.name = "itoh_abe",
       .summary = "discrete gradient from energies alone, coordinate by coordinate",
       .use = "exact energy where no gradient is known, and few coordinates",
       .source = "ItohAbe1988",
       .family = "energy",
       .order = 1,
       .stability_limit = std::numeric_limits<double>::infinity(),
       .make = make_itoh_abe<double>,
       .make_quad = make_itoh_abe<Quad>},
      {.name = "itoh_abe_symmetric",
       .summary = "half a step of Itoh and Abe's method, and half a step in the reversed order of the coordinates",
       .use = "as itoh_abe, of order 2",
       .source = "ItohAbe1988",
       .family = "energy",
       .order = 2,
       .stability_limit = std::numeric_limits<double>::infinity(),
       .make = make_itoh_abe<double>,
       .make_quad = make_itoh_abe<Quad>},
  };
  return list;
}

}  // namespace noether
