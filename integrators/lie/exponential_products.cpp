#include "integrators/lie/exponential_products.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/lie/group_options.hpp"
#include "integrators/lie/group_steps.hpp"
#include "integrators/lie/group_work.hpp"

#include <utility>

namespace noether {

template <class Real>
ExponentialProducts<Real>::ExponentialProducts(const MethodInfo& info, const ExponentialTableau& table)
    : name_(info.name), order_(table.order), end_(in_real(table.end)) {
  for (const ExponentialProduct& stage : table.stages) stages_.push_back(in_real(stage));
}

template <class Real>
typename ExponentialProducts<Real>::Product ExponentialProducts<Real>::in_real(const ExponentialProduct& product) {
  return {product.from, as_real<Real>(product.weights), static_cast<Real>(product.c)};
}

template <class Real> void ExponentialProducts<Real>::bind(const VectorField<Real>& f) {
  const Index algebra = detail::OnGroup<Real>(const_cast<VectorField<Real>&>(f)).algebra();
  a_.assign(stages_.size() + 1, Vector<Real>(algebra));
  places_.assign(stages_.size(), Vector<Real>(f.size()));
  u_.resize(algebra);
  between_.resize(f.size());
}

/// out = the product, from y or a stage.
template <class Real>
void ExponentialProducts<Real>::go(VectorField<Real>& f, const Product& product, double h, const Vector<Real>& y,
                                   Vector<Real>& out) {
  const detail::OnGroup<Real> on(f);
  const Real step(h);
  const Vector<Real>* from = product.from == 0 ? &y : &places_[static_cast<std::size_t>(product.from) - 1];
  for (const std::vector<Real>& weights : product.weights) {
    u_.setZero();
    for (std::size_t j = 0; j < weights.size(); ++j) {
      if (weights[j] == Real(0)) continue;
      for (Index i = 0; i < u_.size(); ++i) u_[i] += weights[j] * a_[j][i];
    }
    for (Index i = 0; i < u_.size(); ++i) u_[i] *= step;
    if (from == &out) {
      std::swap(between_, out);
      from = &between_;
    }
    on.act(u_, *from, out);
    from = &out;
  }
}

template <class Real>
StepResult ExponentialProducts<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  const detail::OnGroup<Real> on(f);
  on.velocity(t, y, a_[0]);
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    go(f, stages_[i], h, y, places_[i]);
    on.velocity(t + stages_[i].c * Real(h), places_[i], a_[i + 1]);
  }
  Vector<Real>& end = places_.back();
  if (end_.from == static_cast<int>(places_.size())) throw LogicError("the end must not begin at the last stage");
  go(f, end_, h, y, end);
  y = end;
  return {.h = h};
}

template class ExponentialProducts<double>;
template class ExponentialProducts<Quad>;

namespace methods {

namespace {

template <const ExponentialTableau& (*table)(), class Real>
std::unique_ptr<Method<Real>> products_of(const MethodInfo& info, const MethodOptions& /*options*/) {
  return std::make_unique<ExponentialProducts<Real>>(info, table());
}

template <const ExponentialTableau& (*table)()> MethodInfo product_method(MethodInfo info) {
  info.family = "lie";
  info.options = {bodies_on_group, nullptr};
  info.order = table().order;
  info.evaluations = static_cast<int>(table().stages.size()) + 1;
  info.on_groups = true;
  info.make = products_of<table, double>;
  info.make_quad = products_of<table, Quad>;
  info.group_work = counted_work;
  return info;
}

}  // namespace

std::span<const MethodInfo> exponential_list() {
  static const MethodInfo list[] = {
      product_method<tableaus::crouch_grossman_3>(
          {.name = "crouch_grossman_3",
           .summary = "Crouch and Grossman's method of order 3: products of exponentials of single stages",
           .use = "comparison with published runs; commutator_free_3 takes half the exponentials",
           .source = "CrouchGrossman1993",
           .stability_limit = 1.7320508075688772}),
      product_method<tableaus::crouch_grossman_4>(
          {.name = "crouch_grossman_4",
           .summary = "order 4 by five stages and fifteen exponentials of single stages",
           .use = "comparison with published runs; commutator_free_4 takes a third of the exponentials",
           .source = "JackiewiczMarthinsenOwren2000",
           .printed_digits = 16,
           .stability_limit = 0}),
      product_method<tableaus::commutator_free_3>(
          {.name = "commutator_free_3",
           .summary = "order 3 by three stages and three exponentials, without commutators",
           .use = "fields on groups whose commutators are dear",
           .source = "CelledoniMarthinsenOwren2003",
           .stability_limit = 1.7320508075688772}),
      product_method<tableaus::commutator_free_4>(
          {.name = "commutator_free_4",
           .summary = "order 4 by four stages and five exponentials, without commutators",
           .use = "fields on groups whose commutators are dear; on straight lines it is rk4",
           .source = "CelledoniMarthinsenOwren2003",
           .stability_limit = 2.8284271247461903}),
  };
  return list;
}

}  // namespace methods

}  // namespace noether
