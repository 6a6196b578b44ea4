#include "integrators/methods/kept_invariants.hpp"

#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {

bool LineInvariants::has(std::string_view name) const {
  return std::find(invariants.begin(), invariants.end(), name) != invariants.end();
}

void LineInvariants::check() const {
  for (const std::string& name : invariants) {
    if (std::count(invariants.begin(), invariants.end(), name) > 1) {
      refuse_field("invariants", fmt::format("[\"{}\"]", fmt::join(invariants, "\", \"")),
                   fmt::format("has {} twice; give it once", name));
    }
  }
}

template <class Real> KeptInvariants<Real>::KeptInvariants(const LineInvariants& wanted) : wanted_(wanted) {
  const auto& names = wanted.invariants;
  any_ = !wanted.own.empty() ||
         std::any_of(names.begin(), names.end(), [](const std::string& name) { return name != "energy"; });
}

template <class Real> bool KeptInvariants<Real>::keeps(std::string_view name) const {
  return wanted_.invariants.empty() ? name == "energy" : wanted_.has(name);
}

/// What is wanted by name of what the field names, and a program's own.
template <class Real> void KeptInvariants<Real>::take_named(const VectorField<Real>& f, std::string_view method) {
  const FieldClaims field = f.claims();
  const std::vector<FieldInvariant<Real>> of_field = f.invariants();
  std::vector<std::string> known = {"energy"};
  if (f.particles() > 0) known = {"energy", "momentum", "angular_momentum"};
  for (const FieldInvariant<Real>& one : of_field) known.push_back(one.name);
  named_.clear();
  for (const std::string& name : wanted_.invariants) {
    const auto refuse = [&](const std::string& why) {
      throw SchemeMismatch(fmt::format("method '{}' cannot keep '{}' of '{}', which {}", method, name, field.name, why),
                           {.key = "invariants"});
    };
    const auto named =
        std::find_if(of_field.begin(), of_field.end(), [&](const auto& one) { return one.name == name; });
    if (named != of_field.end()) {
      named_.push_back(*named);
    } else if (std::find(known.begin(), known.end(), name) == known.end()) {
      refuse((of_field.empty() && field.canonical ? "names no invariants" : "has none of that name") +
             did_you_mean(name, known));
    } else if ((name == "momentum" && !field.keeps_momentum) ||
               (name == "angular_momentum" && !field.keeps_angular_momentum)) {
      refuse("does not keep it itself");
    }
  }
  for (const NamedInvariant& one : wanted_.own) named_.push_back(one.template over<Real>());
}

template <class Real>
void KeptInvariants<Real>::bind(const VectorField<Real>& f, std::string_view method, int coefficients) {
  kept_.clear();
  if (!any_) return;
  take_named(f, method);
  const FieldClaims field = f.claims();
  coefficients_ = coefficients;
  particles_ = f.particles();
  second_order_ = field.second_order;
  const Index n = f.size(), half = n / 2;
  masses_ = field.second_order ? f.masses() : Vector<Real>::Ones(half);
  weights_.resize(n);
  for (Index i = 0; i < half; ++i) {
    weights_[i] = weights_[half + i] = masses_[i] > Real(0) ? Real(1) / masses_[i] : Real(1);  // what is of tracers
  }
  const auto add = [&](Kind kind, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) kept_.push_back({kind, k});
  };
  // Methods for y' = f keep the momentum, so this one is not to lose it.
  if (field.keeps_momentum) add(Kind::momentum, 3);
  if (particles_ > 0 && keeps("angular_momentum")) add(Kind::angular_momentum, 3);
  add(Kind::named, named_.size());
  if (keeps("energy")) add(Kind::energy, 1);  // what determines it comes before
  const auto padded = static_cast<std::size_t>((n + 7) / 8 * 8);
  phi_.assign(kept_.size(), AlignedVector<Real>(lane_count * padded, Real(0)));
  for (auto* v : {&y_, &f_, &gradient_}) v->setZero(n);
  counts_.assign(kept_.size(), false);
  gradients_.setZero(n, static_cast<Index>(kept_.size()));
}

/// gradient_ <- that of one invariant at y_, where the field is f_.
template <class Real> void KeptInvariants<Real>::find_gradient(const Kept& one) {
  const Index half = y_.size() / 2;
  gradient_.setZero();
  if (one.kind == Kind::named) {
    named_[one.index].gradient(y_, gradient_);
  } else if (one.kind == Kind::energy) {  // where f is known, so is the gradient of H
    for (Index i = 0; i < half; ++i) {
      gradient_[i] = -masses_[i] * f_[half + i];
      gradient_[half + i] = second_order_ ? masses_[i] * y_[half + i] : f_[i];
    }
  } else if (one.kind == Kind::momentum) {
    gradient_.segment(half + static_cast<Index>(one.index) * particles_, particles_) = masses_.head(particles_);
  } else {  // sum m (q_a v_b - q_b v_a)
    const auto axis = static_cast<Index>(one.index);
    const Index a = (axis + 1) % 3 * particles_, b = (axis + 2) % 3 * particles_;
    for (Index i = 0; i < particles_; ++i) {
      const Real& m = masses_[i];
      gradient_[a + i] = m * y_[half + b + i];
      gradient_[b + i] = -m * y_[half + a + i];
      gradient_[half + b + i] = m * y_[a + i];
      gradient_[half + a + i] = -m * y_[b + i];
    }
  }
}

template <class Real> void KeptInvariants<Real>::begin() {
  for (auto& one : phi_) std::fill(one.begin(), one.end(), Real(0));
}

template <class Real>
void KeptInvariants<Real>::add(const typename LineTable<Real>::Eight& nodes, const Real* states, const Real* rates) {
  const auto S = static_cast<std::size_t>(coefficients_);
  for (std::size_t k = 0; k < static_cast<std::size_t>(nodes.nodes); ++k) {
    for (Index i = 0; i < y_.size(); ++i) {
      y_[i] = states[lane_count * i + static_cast<Index>(k)];
      f_[i] = rates[lane_count * i + static_cast<Index>(k)];
    }
    for (std::size_t a = 0; a < kept_.size(); ++a) {
      find_gradient(kept_[a]);
      Real* phi = phi_[a].data();
      for (Index i = 0; i < y_.size(); ++i, phi += lane_count) {
        for (std::size_t j = 0; j < S; ++j) phi[j] += nodes.onto[k][j] * gradient_[i];
      }
    }
  }
}

/// What each invariant would change by, and how much of it each of them takes away.
template <class Real> void KeptInvariants<Real>::correct(Real* g) {
  const auto count = static_cast<Index>(kept_.size());
  gram_.setZero(count, count);
  alpha_.setZero(count);
  for (Index a = 0; a < count; ++a) {
    const Real* const phi = phi_[static_cast<std::size_t>(a)].data();
    for (Index i = 0; i < y_.size(); ++i) {
      for (Index j = 0; j < coefficients_; ++j) {
        const Index at = lane_count * i + j;
        const Real part = phi[at] / Real(static_cast<double>(2 * j + 1));
        alpha_[a] += part * g[at];
        for (Index b = 0; b <= a; ++b)
          gram_(a, b) += part * weights_[i] * phi_[static_cast<std::size_t>(b)][static_cast<std::size_t>(at)];
      }
    }
  }
  solve();
  for (Index a = 0; a < count; ++a) {
    const Real* const phi = phi_[static_cast<std::size_t>(a)].data();
    for (Index i = 0; i < y_.size(); ++i) {
      for (Index j = 0; j < coefficients_; ++j)
        g[lane_count * i + j] -= alpha_[a] * weights_[i] * phi[lane_count * i + j];
    }
  }
}

/// Row a of Cholesky's factor of the Gram matrix, whose diagonal is 0 where an invariant takes nothing.
template <class Real> void KeptInvariants<Real>::factorize_row(Index a) {
  using std::sqrt;
  for (Index b = 0; b < a; ++b) {
    Real& into = gram_(a, b);
    for (Index c = 0; c < b; ++c) into -= gram_(a, c) * gram_(b, c);
    into = gram_(b, b) > Real(0) ? into / gram_(b, b) : Real(0);
  }
  Real& pivot = gram_(a, a);
  for (Index c = 0; c < a; ++c) pivot -= gram_(a, c) * gram_(a, c);
  pivot = counts_[static_cast<std::size_t>(a)] && pivot > Real(0) ? sqrt(pivot) : Real(0);
}

/// Averages of gradients along the path would be independent, by errors of the method: gradients at one point are not.
template <class Real> void KeptInvariants<Real>::start(VectorField<Real>& f, const Real& t, const Vector<Real>& y) {
  const auto count = static_cast<Index>(kept_.size());
  const Real rounding(std::is_same_v<Real, double> ? 0x1p-40 : 0x1p-96);
  y_ = y;
  f.rate(t, y, f_);
  gram_.setZero(count, count);
  for (Index a = 0; a < count; ++a) {
    find_gradient(kept_[static_cast<std::size_t>(a)]);
    gradients_.col(a) = gradient_;
    for (Index b = 0; b <= a; ++b) {
      for (Index i = 0; i < y.size(); ++i) gram_(a, b) += gradients_(i, a) * weights_[i] * gradients_(i, b);
    }
    const Real whole = gram_(a, a);
    counts_[static_cast<std::size_t>(a)] = true;
    factorize_row(a);
    if (gram_(a, a) * gram_(a, a) > rounding * whole) continue;
    counts_[static_cast<std::size_t>(a)] = false;
    gram_(a, a) = Real(0);
  }
}

/// alpha <- gram^-1 alpha by Cholesky's factors.
template <class Real> void KeptInvariants<Real>::solve() {
  const Index count = alpha_.size();
  const auto divide = [&](Index a) { alpha_[a] = gram_(a, a) > Real(0) ? alpha_[a] / gram_(a, a) : Real(0); };
  for (Index a = 0; a < count; ++a) {
    factorize_row(a);
    for (Index c = 0; c < a; ++c) alpha_[a] -= gram_(a, c) * alpha_[c];
    divide(a);
  }
  for (Index a = count; a-- > 0;) {
    for (Index c = a + 1; c < count; ++c) alpha_[a] -= gram_(c, a) * alpha_[c];
    divide(a);
  }
}

template class KeptInvariants<double>;
template class KeptInvariants<Quad>;

}  // namespace noether
