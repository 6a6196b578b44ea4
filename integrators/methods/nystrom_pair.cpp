#include "integrators/methods/nystrom_pair.hpp"

#include "integrators/all_methods.hpp"

namespace noether {

template <class Real>
NystromPair<Real>::NystromPair(const MethodInfo& info, const MethodOptions& options)
    : name_(info.name),
      adaptive_(info.is_adaptive(options)),
      tolerance_(info, options),
      first_(options.first.value_or(0)),
      a_(as_real<Real>(tableaus::dprkn_12().a)),
      c_(as_real<Real>(tableaus::dprkn_12().c)),
      b_q_(as_real<Real>(tableaus::dprkn_12().b_q)),
      b_v_(as_real<Real>(tableaus::dprkn_12().b_v)),
      e_q_(as_real<Real>(tableaus::dprkn_12().e_q)),
      e_v_(as_real<Real>(tableaus::dprkn_12().e_v)) {}

template <class Real> void NystromPair<Real>::bind(const VectorField<Real>& f) {
  k_.assign(b_v_.size(), Vector<Real>(f.size() / 2));
  y1_.resize(f.size());
  e_.resize(f.size());
  control_.forget();
}

template <class Real>
double NystromPair<Real>::next_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  if (control_.next() == 0)
    control_.start(first_ > 0 ? std::copysign(first_, h) : first_step(f, t, y, order, tolerance_, h));
  return shorter(control_.next(), h, f.scales(y, tolerance_.rtol));
}

template <class Real>
StepResult NystromPair<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made;
  f.acceleration(t, y, k_[0]);
  while (true) {
    made.h = adaptive_ ? next_step(f, t, y, h) : h;
    if (adaptive_) {
      made.failure = underflow(static_cast<double>(t), made.h, f.scales(y, tolerance_.rtol));
      if (made.failure) return made;
    }
    trial(f, t, y, made.h);
    if (!adaptive_ || control_.accept(made.h, error(f.scales(y, tolerance_.rtol), y, made.h))) break;
    ++made.rejected;
  }
  y = y1_;
  return made;
}

template <class Real> Real NystromPair<Real>::sum(const std::vector<Real>& weights, Index i) const {
  Real total(0);
  for (std::size_t j = 0; j < weights.size(); ++j) {
    if (weights[j] != Real(0)) total += weights[j] * k_[j][i];
  }
  return total;
}

template <class Real>
void NystromPair<Real>::trial(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  const Index half = y.size() / 2;
  const Real step(h);
  y1_ = y;
  for (std::size_t s = 1; s < k_.size(); ++s) {
    for (Index i = 0; i < half; ++i) y1_[i] = y[i] + step * (c_[s] * y[half + i] + step * sum(a_[s], i));
    f.acceleration(t + c_[s] * step, y1_, k_[s]);
  }
  for (Index i = 0; i < half; ++i) {
    y1_[i] = y[i] + step * (y[half + i] + step * sum(b_q_, i));
    y1_[half + i] = y[half + i] + step * sum(b_v_, i);
  }
}

template <class Real> double NystromPair<Real>::error(const ParticleScales& scales, const Vector<Real>& y, double h) {
  const Index half = y.size() / 2;
  const Real step(h);
  for (Index i = 0; i < half; ++i) {
    e_[i] = step * step * sum(e_q_, i);
    e_[half + i] = step * sum(e_v_, i);
  }
  return tolerance_.norm(scales, e_, y, y1_);
}

template class NystromPair<double>;
template class NystromPair<Quad>;

namespace methods {

namespace {

template <class Real> std::unique_ptr<Method<Real>> nystrom(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<NystromPair<Real>>(info, options);
}

}  // namespace

std::span<const MethodInfo> nystrom_list() {
  static const MethodInfo list[] = {
      {.name = "dprkn_12",
       .aliases = "dormand_prince_nystrom_12 rkn_12_10",
       .summary =
           "Runge-Kutta-Nystroem 12(10) of Dormand, El-Mikkawy and Prince for q'' = a(t, q): 17 evaluations per step",
       .use = "forces of positions, errors near rounding over short times",
       .source = "DormandElMikkawyPrince1987",
       .family = "runge-kutta-nystroem",
       .order = 12,
       .evaluations = 17,
       .adaptive = true,
       .stability_limit = 8.3262,
       .make = nystrom<double>,
       .make_quad = nystrom<Quad>},
  };
  return list;
}

}  // namespace methods

}  // namespace noether
