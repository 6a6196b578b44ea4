#include "integrators/lie/magnus.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/lie/group_work.hpp"
#include "integrators/lie/lie_field.hpp"

#include <utility>

namespace noether {

namespace {

/// Where a method of Gauss looks into a step.
template <class Real> std::array<Real, 3> magnus_nodes(MagnusKind kind) {
  using std::sqrt;
  const Real half = Real(1) / Real(2);
  if (kind == MagnusKind::order_2) return {half, half, half};
  const Real off = kind == MagnusKind::order_6 ? Real(sqrt(Real(15)) / Real(10)) : Real(sqrt(Real(3)) / Real(6));
  if (kind == MagnusKind::order_6) return {half - off, half, half + off};
  return {half - off, half + off, half};
}
int node_count(MagnusKind kind) { return kind == MagnusKind::order_2 ? 1 : kind == MagnusKind::order_6 ? 3 : 2; }

/// Omega of order 6 from h A at three nodes, in the notation of Blanes, Casas and Ros.
template <class Real>
void sixth_order(LieField<Real>& group, std::array<Vector<Real>, 3>& a, std::array<Vector<Real>, 3>& c,
                 Vector<Real>& omega) {
  using std::sqrt;
  const Real root = sqrt(Real(15)) / Real(3), third = Real(10) / Real(3);
  for (Index i = 0; i < omega.size(); ++i) {
    const Real first = a[0][i], middle = a[1][i], last = a[2][i];
    a[0][i] = middle;
    a[1][i] = root * (last - first);
    a[2][i] = third * (last - Real(2) * middle + first);
  }
  group.bracket(a[0], a[1], c[0]);
  for (Index i = 0; i < omega.size(); ++i) c[1][i] = Real(2) * a[2][i] + c[0][i];
  group.bracket(a[0], c[1], c[2]);
  for (Index i = 0; i < omega.size(); ++i) {
    c[1][i] = a[1][i] - c[2][i] / Real(60);
    c[0][i] -= Real(20) * a[0][i] + a[2][i];
  }
  group.bracket(c[0], c[1], c[2]);
  for (Index i = 0; i < omega.size(); ++i) omega[i] = a[0][i] + a[2][i] / Real(12) + c[2][i] / Real(240);
}

}  // namespace

template <class Real> void Magnus<Real>::bind(const VectorField<Real>& f) {
  LieField<Real>* const group = const_cast<VectorField<Real>&>(f).on_group();
  if (group == nullptr || !group->linear()) {
    throw SchemeMismatch("method '" + std::string(name_) + "' is for Y' = A(t) Y on rotations only");
  }
  for (auto* list : {&a_, &c_}) {
    for (Vector<Real>& element : *list) element.resize(group->algebra());
  }
  omega_.resize(group->algebra());
  y1_.resize(f.size());
}

template <class Real> StepResult Magnus<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  using std::sqrt;
  LieField<Real>& group = *f.on_group();
  const Real step(h), root = sqrt(Real(3));
  const std::array<Real, 3> nodes = magnus_nodes<Real>(kind_);
  for (int k = 0; k < node_count(kind_); ++k) {
    auto& a = a_[static_cast<std::size_t>(k)];
    group.velocity(t + nodes[static_cast<std::size_t>(k)] * step, y, a);
    for (Index i = 0; i < a.size(); ++i) a[i] *= step;
  }
  const Vector<Real>&first = a_[0], &last = a_[1];
  if (kind_ == MagnusKind::commutator_free_4) {
    const Real more = Real(1) / Real(4) + root / Real(6), less = Real(1) / Real(4) - root / Real(6);
    for (Index i = 0; i < omega_.size(); ++i) omega_[i] = more * first[i] + less * last[i];
    group.act(omega_, y, y1_);
    std::swap(y, y1_);
    for (Index i = 0; i < omega_.size(); ++i) omega_[i] = less * first[i] + more * last[i];
  } else if (kind_ == MagnusKind::order_2) {
    omega_ = first;
  } else if (kind_ == MagnusKind::order_4) {
    group.bracket(first, last, c_[0]);
    for (Index i = 0; i < omega_.size(); ++i) omega_[i] = (first[i] + last[i]) / Real(2) - root * c_[0][i] / Real(12);
  } else {
    sixth_order(group, a_, c_, omega_);
  }
  group.act(omega_, y, y1_);
  y = y1_;
  return {.h = h};
}

template class Magnus<double>;
template class Magnus<Quad>;

namespace methods {

namespace {

template <MagnusKind kind, class Real>
std::unique_ptr<Method<Real>> magnus(const MethodInfo& info, const MethodOptions& /*options*/) {
  return std::make_unique<Magnus<Real>>(info, kind);
}

template <MagnusKind kind> MethodInfo magnus_method(MethodInfo info) {
  info.family = "lie";
  info.evaluations = node_count(kind);
  info.on_groups = info.linear_only = true;
  info.make = magnus<kind, double>;
  info.make_quad = magnus<kind, Quad>;
  info.group_work = counted_work;
  return info;
}

}  // namespace

std::span<const MethodInfo> magnus_list() {
  static const MethodInfo list[] = {
      magnus_method<MagnusKind::order_2>({.name = "magnus_2",
                                          .aliases = "exponential_midpoint",
                                          .summary = "Magnus's series to order 2: the exponential of the midpoint",
                                          .use = "Y' = A(t) Y on rotations; magnus_4 costs one evaluation more",
                                          .source = "IserlesNorsett1999",
                                          .order = 2}),
      magnus_method<MagnusKind::order_4>({.name = "magnus_4",
                                          .summary = "Magnus's series to order 4: two nodes, one commutator",
                                          .use = "Y' = A(t) Y on rotations",
                                          .source = "BlanesCasasRos2000",
                                          .order = 4}),
      magnus_method<MagnusKind::order_6>({.name = "magnus_6",
                                          .summary = "Magnus's series to order 6: three nodes, three commutators",
                                          .use = "Y' = A(t) Y on rotations, to small errors",
                                          .source = "BlanesCasasRos2000",
                                          .order = 6}),
      magnus_method<MagnusKind::commutator_free_4>(
          {.name = "magnus_cf_4",
           .summary = "order 4 by two nodes and two exponentials, without commutators",
           .use = "Y' = A(t) Y on rotations of many dimensions, whose commutators are dear",
           .source = "BlanesMoan2006",
           .order = 4}),
  };
  return list;
}

}  // namespace methods

}  // namespace noether
