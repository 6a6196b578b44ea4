#include "integrators/lie/rkmk.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/lie/group_options.hpp"
#include "integrators/lie/group_steps.hpp"
#include "integrators/lie/group_work.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <string>
#include <utility>

namespace noether {

template <class Real>
Rkmk<Real>::Rkmk(const MethodInfo& info, const MethodOptions& options, const tableaus::NamedTableau& table, int terms)
    : name_(info.name),
      order_(table.table().order),
      adaptive_(info.is_adaptive(options)),
      first_same_as_last_(table.table().first_same_as_last),
      tolerance_(info, options),
      first_(options.first.value_or(0)),
      a_(as_real<Real>(table.table().a)),
      b_(as_real<Real>(table.table().b)),
      c_(as_real<Real>(table.table().c)),
      e_(as_real<Real>(table.table().e)),
      control_(table.control_order(), table.most_growth()),
      inverse_dexp_(terms) {
  if (table.second_error != nullptr) e3_ = as_real<Real>(table.second_error());
  if (table.dense != nullptr) d_ = as_real<Real>(table.dense());
}

template <class Real> void Rkmk<Real>::bind(const VectorField<Real>& f) {
  // Asking for the group changes nothing of the field.
  const Index algebra = detail::OnGroup<Real>(const_cast<VectorField<Real>&>(f)).algebra();
  k_.assign(b_.size(), Vector<Real>(algebra));
  for (Vector<Real>* element : {&u_, &velocity_, &error_, &begin_}) element->resize(algebra);
  for (Vector<Real>* place : {&y0_, &y1_}) place->resize(f.size());
  sizes_.resize(algebra);
  inverse_dexp_.bind(algebra);
  have_first_ = false;
  control_.forget();
}

template <class Real>
double Rkmk<Real>::next_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  if (control_.next() == 0) {
    control_.start(first_ > 0 ? std::copysign(first_, h) : detail::first_step_on_group(f, t, y, order_, tolerance_, h));
  }
  return shorter(control_.next(), h, f.scales(y, tolerance_.rtol));
}

/// out = h sum w_j k_j over the first `w.size()` stages.
template <class Real> void Rkmk<Real>::combine(const std::vector<Real>& w, double h, Vector<Real>& out) const {
  const Real step(h);
  bool first = true;
  for (std::size_t j = 0; j < w.size(); ++j) {
    if (w[j] == Real(0)) continue;
    const Vector<Real>& k = k_[j];
    for (Index i = 0; i < k.size(); ++i) out[i] = first ? w[j] * k[i] : out[i] + w[j] * k[i];
    first = false;
  }
  for (Index i = 0; i < out.size(); ++i) out[i] = first ? Real(0) : step * out[i];
}

/// Leaves u and where it leads in `u_` and `y1_`, and with a stage there the velocity.
template <class Real> void Rkmk<Real>::trial(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  const detail::OnGroup<Real> on(f);
  for (std::size_t i = 1; i < b_.size(); ++i) {
    combine(a_[i], h, u_);
    on.act(u_, y, y1_);
    on.velocity(t + c_[i] * Real(h), y1_, velocity_);
    if (on.group() != nullptr) {
      inverse_dexp_.apply(*on.group(), u_, velocity_, k_[i]);
    } else {
      k_[i] = velocity_;
    }
  }
  // Where the last stage is the first of the next step it stands at the new point already.
  if (first_same_as_last_) return;
  combine(b_, h, u_);
  on.act(u_, y, y1_);
}

template <class Real> StepResult Rkmk<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made;
  if (!have_first_) detail::OnGroup<Real>(f).velocity(t, y, k_[0]);
  while (true) {
    made.h = adaptive_ ? next_step(f, t, y, h) : h;
    if (adaptive_) {
      made.failure = underflow(static_cast<double>(t), made.h, f.scales(y, tolerance_.rtol));
      if (made.failure) return made;
    }
    trial(f, t, y, made.h);
    if (!adaptive_ || control_.accept(made.h, error(f, made.h, y))) break;
    ++made.rejected;
  }
  if (dense()) {  // what `interpolate` takes
    y0_ = y;
    h_ = made.h;
    begin_ = k_[0];
  }
  y = y1_;
  have_first_ = first_same_as_last_;
  if (have_first_) k_[0] = velocity_;
  return made;
}

/// The cubic of u through both ends with their slopes, and one term of degree 4, as over straight lines.
template <class Real> void Rkmk<Real>::interpolate(VectorField<Real>& f, const Real& theta, Vector<Real>& y) {
  const Real h(h_), left = Real(1) - theta;
  const auto stage = [&](std::size_t j) -> const Vector<Real>& { return j == 0 ? begin_ : k_[j]; };
  const Vector<Real>& end = k_[b_.size() - 1];
  for (Index i = 0; i < u_.size(); ++i) {
    const Real bend = h * begin_[i] - u_[i], twist = u_[i] - h * end[i] - bend;
    Real last(0);
    for (std::size_t j = 0; j < d_.size(); ++j) {
      if (d_[j] != Real(0)) last += d_[j] * stage(j)[i];
    }
    error_[i] = theta * (u_[i] + left * (bend + theta * (twist + left * (h * last))));
  }
  detail::OnGroup<Real>(f).act(error_, y0_, y);
}

/// One estimate, or two: err = |e5|^2 / sqrt(|e5|^2 + 0.01 |e3|^2).
template <class Real> double Rkmk<Real>::error(VectorField<Real>& f, double h, const Vector<Real>& y) {
  const auto norm = [&](const std::vector<Real>& weights, double length) {
    combine(weights, length, error_);
    return detail::error_on_group(tolerance_, f, h, error_, y, y1_, sizes_);
  };
  if (e3_.empty()) return norm(e_, h);
  const double five = norm(e_, 1), three = norm(e3_, 1), both = five * five + 0.01 * three * three;
  return both > 0 ? std::abs(h) * five * five / std::sqrt(both) : both;
}

template <class Real> void Rkmk<Real>::save(SavedState& saved, const std::string& prefix) const {
  control_.save(saved, prefix + "control/");
  save_value(saved, prefix + "have_first", have_first_);
  std::vector<Real> first;
  if (have_first_) first.assign(k_[0].data(), k_[0].data() + k_[0].size());
  save_value(saved, prefix + "first", first);
}

template <class Real> void Rkmk<Real>::load(const SavedState& saved, const std::string& prefix) {
  control_.load(saved, prefix + "control/");
  load_value(saved, prefix + "have_first", have_first_);
  std::vector<Real> first;
  load_value(saved, prefix + "first", first);
  if (!have_first_) return;
  for (Index i = 0; i < k_[0].size(); ++i) k_[0][i] = detail::element(first, static_cast<std::size_t>(i));
}

template class Rkmk<double>;
template class Rkmk<Quad>;

namespace methods {

namespace {

/// The table under a method of Munthe-Kaas; null where it is none.
const tableaus::NamedTableau* table_under(const MethodInfo& info) {
  for (const tableaus::NamedTableau& table : tableaus::all_explicit()) {
    if (info.name == "rkmk_" + std::string(table.name)) return &table;
  }
  return nullptr;
}

/// @throws Error  for fewer brackets than the order needs
template <class Real> std::unique_ptr<Method<Real>> rkmk(const MethodInfo& info, const MethodOptions& options) {
  const tableaus::NamedTableau& table = *table_under(info);
  const int order = table.table().order, needed = dexp_terms_for(order);
  const std::int64_t terms = options.own.as<RkmkOptions>().dexp_terms.value_or(needed);
  const auto refuse = [&](const std::string& why) { refuse_field("dexp_terms", std::to_string(terms), why); };
  if (terms < needed) {
    refuse(
        fmt::format("would take its order from '{}', which has {}; at least {} is expected", info.name, order, needed));
  }
  if (terms > most_dexp_terms)
    refuse(fmt::format("is more than {}, beyond which the series has no use", most_dexp_terms));
  return std::make_unique<Rkmk<Real>>(info, options, table, static_cast<int>(terms));
}

std::vector<MethodInfo> make_rkmk_list() {
  static std::deque<std::string> texts;  // that the list has views of
  const auto keep = [](std::string text) -> std::string_view { return texts.emplace_back(std::move(text)); };
  std::vector<MethodInfo> list;
  for (const tableaus::NamedTableau& table : tableaus::all_explicit()) {
    const MethodInfo* base = nullptr;
    for (const MethodInfo& one : runge_kutta_list()) base = one.name == table.name ? &one : base;
    NOETHER_EXPECTS(base != nullptr, "every explicit table has a method");
    MethodInfo made = *base;
    made.name = keep(fmt::format("rkmk_{}", base->name));
    made.aliases = "";
    made.summary =
        keep(fmt::format("Munthe-Kaas's method of '{}': bodies and matrices turn by exponentials, points as by "
                         "'{}' itself",
                         base->name, base->name));
    made.use = base->adaptive ? "rigid bodies under any forces, of velocities too, with steps by an error estimate"
                              : "rigid bodies under any forces, of velocities too; comparison with published runs";
    made.source = keep(fmt::format("MuntheKaas1999 {}", base->source));
    made.family = "lie";
    made.options = {bodies_on_group, &own_options<RkmkOptions>};
    made.on_groups = true;
    made.make = rkmk<double>;
    made.make_quad = rkmk<Quad>;
    made.group_work = rkmk_work;
    list.push_back(made);
  }
  return list;
}

}  // namespace

std::span<const MethodInfo> rkmk_list() {
  static const std::vector<MethodInfo> list = make_rkmk_list();
  return list;
}

}  // namespace methods

int dexp_terms_of(const MethodInfo& info, const MethodOptions& options) {
  const tableaus::NamedTableau* table = methods::table_under(info);
  if (table == nullptr) return -1;
  return static_cast<int>(options.own.as<RkmkOptions>().dexp_terms.value_or(dexp_terms_for(table->table().order)));
}

}  // namespace noether
