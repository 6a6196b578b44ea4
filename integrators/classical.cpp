#include "integrators/classical.hpp"

#include "integrators/lie/lie_field.hpp"
#include "integrators/particle_vector.hpp"
#include "integrators/step_control.hpp"
#include "integrators/variational/lagrangian_field.hpp"

#include <cmath>
#include <limits>

namespace noether {

template <class Real> IntegratorClaims Classical<Real>::claims() const {
  const MethodClaims method = method_->claims();
  const FieldClaims field = field_->claims();
  return {.method = std::string(method.name),
          .hamiltonian = field.name,
          .order = method.order,
          .clock = method.adaptive ? ClockMode::free : ClockMode::fixed,
          .symplectic = method.symplectic && !method.adaptive && !field.dissipative && field.symplectic,
          .no_action = field.no_action,
          .reversible = method.reversible && !method.adaptive && !field.dissipative,
          .backward = true,
          .energy_exact = method.energy_exact && field.energy && !field.dissipative && !field.time_dependent,
          .energy = field.energy,
          .dissipative = field.dissipative,
          .time_dependent = field.time_dependent,
          .keeps_momentum = field.keeps_momentum && method.keeps_momentum,
          .keeps_angular_momentum = field.keeps_angular_momentum && method.keeps_angular_momentum,
          .momentum = field.keeps_momentum,
          .angular_momentum = field.keeps_angular_momentum,
          .memory = method_->memory(),
          .variables = field.variables,
          .second_words = method.second_words,
          .between_steps = !method.adaptive && method_->dense()};
}

namespace {

/// What a method that is made for a conserved energy cannot serve, and why.
void check_conservative(std::string_view method, const FieldClaims& field) {
  const auto refuse = [&](const std::string& why) {
    throw SchemeMismatch(
        fmt::format("method '{}' keeps the energy, but {}; use 'gauss_4' or another method for y' = f", method, why));
  };
  if (field.variables && !field.energy)
    refuse(fmt::format("system '{}' has rates, and no energy that they keep", field.name));
  if (field.dissipative) refuse("a force of this run is dissipative");
  if (field.variables && !field.canonical)
    refuse(fmt::format("system '{}' has a force beside its Lagrangian", field.name));
  if (field.time_dependent)
    refuse(field.variables ? fmt::format("system '{}' depends on time", field.name)
                           : "a force of this run depends on time");
  if (!field.energy) refuse("a force of this run has none");
  if (field.second_order && field.velocity_dependent) refuse("a force of this run depends on velocities");
}

}  // namespace

namespace {

/// What forces cannot do where a step has come to: on the way they could not, but that was a trial of its iteration.
template <class Real>
std::optional<Failure> failure_at(VectorField<Real>& field, const Real& t, const Vector<Real>& y) {
  Vector<Real> rates(y.size());
  field.forget_failure();
  field.rate(t, y, rates);
  return field.failure();
}

/// Why the end of a step over a Lagrangian has no velocity: masses may have become negative on the way.
template <class Real>
std::optional<Failure> failure_of_end(VectorField<Real>& field, const Real& t, const Vector<Real>& y) {
  auto* const lagrangian = LagrangianField<Real>::behind(field);
  if (lagrangian == nullptr || !lagrangian->has_hamiltonian()) return {};
  return lagrangian->check_velocity(t, y);
}

}  // namespace

template <class Real> void Classical<Real>::bind(ParticleSystem<Real>& s) {
  const MethodClaims method = method_->claims();
  LieField<Real>* const group = field_->on_group();
  if (s.bodies() != nullptr && (!choice_.info->on_groups || group == nullptr)) {
    throw SchemeMismatch(fmt::format(
        "method '{}' moves points, but some particles are rigid bodies that turn; use a splitting scheme, such as "
        "'verlet' or 'srkn14a', or {}",
        method.name,
        choice_.info->on_groups ? "lie() in the place of classical()"
                                : "a method on groups of rotations, such as 'rkmk_rk4'"));
  }
  if (choice_.info->linear_only && (group == nullptr || !group->linear())) {
    throw SchemeMismatch(
        fmt::format("method '{}' is for Y' = A(t) Y on rotations only, but '{}' is no such field; use 'rkmk_dop853'",
                    method.name, field_->claims().name));
  }
  field_->bind(s);
  if (group != nullptr && choice_.info->on_groups) group->check_start(s);
  const FieldClaims field = field_->claims();
  const bool of_lagrangian =
      (method_->has_action() || method.of_lagrangian) && LagrangianField<Real>::behind(*field_) != nullptr;
  if (method.second_order_only && !field.second_order && !of_lagrangian) {
    throw SchemeMismatch(
        fmt::format("method '{}' is for q'' = a only, but '{}' is a first-order system; use a method "
                    "for y' = f, such as 'dormand_prince_5'",
                    method.name, field.name));
  }
  if (method.positions_only && field.velocity_dependent) {
    throw SchemeMismatch(
        fmt::format("method '{}' is for q'' = a(t, q) only, but a force depends on velocities; use a "
                    "method for y' = f, such as 'dop853' or 'gauss_8'",
                    method.name));
  }
  if (method.conservative_only) check_conservative(method.name, field);
  if (method.gravity_only && !field_->gravity_of_points()) {
    throw SchemeMismatch(fmt::format(
        "method '{}' is for masses without softening that attract each other, but '{}' has no such gravity; "
        "use 'gauss_8'",
        method.name, field.name));
  }
  method_->bind(*field_);
  if (method_->low_words() != nullptr) s.keep_low_words(true);
  y_.resize(field_->size());
  before_.resize(field_->size());
  ahead_.reset();
}

template <class Real> Advance Classical<Real>::advance(ParticleSystem<Real>& s, const Span& span) {
  Advance done;
  const bool fixed = s.clock().mode() == ClockMode::fixed;
  const double most = longest_step(s.clock());
  field_->gather(s, y_);
  Vector<Real>* const low = method_->low_words();
  if (low != nullptr) detail::gather_low_words(s, *low);
  while (done.steps < span.steps) {
    const Real t = s.clock().time();
    if (!fixed) {
      const double next = method_->next_step(*field_, t, y_, most);
      if (s.clock().is_later(s.clock().high() + next, span.limit)) {
        done.at_limit = true;
        break;
      }
      // Steps that all pass may grow shorter for ever, as on the way into a collision.
      if (auto failure = underflow(s.clock().high(), next)) {
        failure_ = std::move(failure);
        done.failure = &*failure_;
        break;
      }
    }
    field_->forget_failure();
    StepResult made = method_->step(*field_, t, y_, most);
    field_->evaluations().rejected += made.rejected;
    // A step of free length can go round what a force cannot do; one that is given cannot.
    if (fixed && field_->failure()) {
      const bool spoiled = made.failure || !y_.allFinite();
      made.failure = spoiled ? field_->failure() : failure_at(*field_, Real(t + Real(most)), y_);
    }
    // Stages may not have come so far as the end.
    if (!made.failure) made.failure = failure_of_end(*field_, Real(t + Real(made.h)), y_);
    if (made.failure) {
      failure_ = std::move(made.failure);
      done.failure = &*failure_;
      break;
    }
    if (fixed) {
      s.clock().tick(Real(0));
    } else {
      s.clock().advance(made.h);
    }
    ++done.steps;
    if (span.asked_to_stop()) break;
  }
  if (done.steps > 0) field_->scatter(y_, s);
  if (done.steps > 0 && low != nullptr) detail::scatter_low_words(*low, s);
  return done;
}

template <class Real> bool Classical<Real>::has_action() const {
  if (!method_->has_action()) return false;
  return field_->has_potential() || LagrangianField<Real>::behind(*field_) != nullptr;
}

template <class Real>
Advance Classical<Real>::advance_with_action(ParticleSystem<Real>& s, const Span& span, Real& action) {
  Advance done;
  Span step = span;
  step.steps = 1;
  while (done.steps < span.steps) {
    field_->gather(s, before_);
    const Real t = s.clock().time();
    const Advance made = advance(s, step);
    if (made.steps == 0) {
      done.at_limit = made.at_limit;
      done.failure = made.failure;
      break;
    }
    action += method_->action(*field_, t, before_);
    ++done.steps;
    if (span.asked_to_stop()) break;
  }
  return done;
}

template <class Real>
Real Classical<Real>::settle(const ParticleSystem<Real>& raw, ParticleSystem<Real>& out, Request /*wanted*/,
                             std::optional<double> at, bool /*corrected*/) {
  out.assign_state(raw);
  if (!at) {
    out.wrap();
    return Real(0);
  }
  const Evaluations counted = field_->evaluations();
  look_ahead(raw, *at);
  out.clock().move_to(*at);  // fields that change tell velocities by the time
  field_->scatter(y_, out);
  if (ahead_) {
    const bool inside = ahead_->method->dense() && ahead_->h != 0;
    const Vector<Real>* const low = inside ? ahead_->method->interpolated_low_words() : ahead_->method->low_words();
    if (low != nullptr) detail::scatter_low_words(*low, out);
  }
  out.wrap();
  field_->evaluations() = counted;
  return Real(0);  // at whole steps nothing is left to do, and between them no action is told
}

template <class Real> void Classical<Real>::go_on_from(const ParticleSystem<Real>& now, ParticleSystem<Real>& raw) {
  raw.assign_state(now);
  if (Vector<Real>* const low = method_->low_words()) {
    raw.keep_low_words(false);
    raw.keep_low_words(true);
    low->setZero();
  }
  field_->gather(raw, y_);
  method_->moved(*field_, raw.clock().time(), y_);
  ahead_.reset();
}

/// Signed as time runs.
template <class Real> double Classical<Real>::longest_step(const Clock<Real>& clock) const {
  if (clock.mode() == ClockMode::fixed) return clock.dt();
  return choice_.options.max_step ? std::copysign(*choice_.options.max_step, clock.never()) : clock.never();
}

/// Leaves y at time `at` in `y_`, from the last whole step of the run; no numbers where a step on the way fails.
template <class Real> void Classical<Real>::look_ahead(const ParticleSystem<Real>& raw, double at) {
  constexpr double resolution = 4 * std::numeric_limits<double>::epsilon();  // as in `underflow`
  const bool dense = method_->dense();
  const Clock<Real>& clock = raw.clock();
  const bool known = dense && ahead_ && ahead_->from == clock.step() && !clock.is_later(ahead_->begin.at_step(), at);
  if (!known) {
    ahead_ = Ahead{method_->clone(), clock.step(), clock, clock, 0, {}};
    field_->gather(raw, ahead_->y);
    if (Vector<Real>* const low = ahead_->method->low_words()) detail::gather_low_words(raw, *low);
    y_ = ahead_->y;
  }
  while (clock.is_later(at, ahead_->end.at_step())) {
    const Clock<Real>& now = ahead_->begin = ahead_->end;
    double most = longest_step(clock);
    if (!dense && clock.is_later(now.at_step() + most, at)) most = static_cast<double>(now.until(at));
    field_->forget_failure();
    const StepResult made = ahead_->method->step(*field_, now.time(), ahead_->y, most);
    // A sum of times is rounded: what that leaves may be shorter than any step, and the state is the one after the
    // last.
    if (made.failure && !dense && std::abs(at - now.at_step()) <= resolution * std::abs(at)) break;
    // What fails here fails in the run as well, or ends it here.
    if (made.failure || !(std::abs(made.h) > 0)) {
      y_.setConstant(Real(std::numeric_limits<double>::quiet_NaN()));
      ahead_.reset();
      return;
    }
    ahead_->h = made.h;
    if (now.mode() == ClockMode::fixed) {
      ahead_->end.tick(Real(0));
    } else {
      ahead_->end.advance(made.h);
    }
    y_ = ahead_->y;
  }
  if (!dense || ahead_->h == 0) return;
  ahead_->method->interpolate(*field_, Real(ahead_->begin.until(at) / Quad(ahead_->h)), y_);
}

template <class Real> std::string Classical<Real>::signature() const {
  const MethodInfo& info = *choice_.info;
  MethodOptions options = choice_.options;
  options.adaptive = info.is_adaptive(options);
  std::string fields;
  std::vector<const OptionGroup*> groups = {error_control};
  for (const OptionGroup* group : info.options) {
    if (group != nullptr) groups.push_back(group);
  }
  for (const OptionGroup* group : groups) {
    for (const OptionValue& one : group->values(options)) {
      if (MethodOptions::is_new(one.name) && one.value.index() == 0) continue;
      detail::add_field_text(fields, one.name, option_text(one.value));
    }
  }
  return fmt::format("{}({}, first = {})", info.name, fields, detail::value_text(options.first));
}

template <class Real> void Classical<Real>::save(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "method", signature());
  save_value(saved, prefix + "field", field_->signature());
  const Evaluations& counted = field_->evaluations();
  save_value(
      saved, prefix + "evaluations",
      std::vector<std::int64_t>{counted.force, counted.jacobian, counted.rejected, counted.kepler, counted.unsettled});
  field_->save(saved, prefix + "field/");
  method_->save(saved, prefix + "state/");
}

template <class Real> void Classical<Real>::load(const SavedState& saved, const std::string& prefix) {
  const auto check = [&](const std::string& name, const std::string& now) {
    std::string before;
    load_value(saved, prefix + name, before);
    if (before != now) throw Error(fmt::format("the saved run was made with {}, but this one has {}", before, now));
  };
  check("method", signature());
  check("field", field_->signature());
  field_->load(saved, prefix + "field/");
  std::vector<std::int64_t> counted;
  load_value(saved, prefix + "evaluations", counted);
  field_->evaluations() = {.force = detail::element(counted, 0),
                           .kepler = counted.size() > 3 ? counted[3] : 0,
                           .jacobian = detail::element(counted, 1),
                           .rejected = detail::element(counted, 2),
                           .unsettled = counted.size() > 4 ? counted[4] : 0};
  method_->load(saved, prefix + "state/");
  ahead_.reset();
}

template class Classical<double>;
template class Classical<Quad>;
template struct detail::IntegratorModel<Classical<double>>;
template struct detail::IntegratorModel<Classical<Quad>>;

}  // namespace noether
