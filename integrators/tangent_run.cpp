#include "integrators/tangent_run.hpp"

#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "integrators/particle_vector.hpp"
#include "integrators/varied_field.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace noether {

namespace {

/// Steps of an integrator over the state and its changes, however particles hold them.
template <class Real> class TangentRun : public TangentFlow<Real> {
 public:
  using typename TangentFlow<Real>::State;
  using typename TangentFlow<Real>::Changes;

  TangentRun(AnyIntegrator<Real> integrator, ParticleSystem<Real> rows)
      : integrator_(std::move(integrator)), raw_(std::move(rows)), settled_(raw_) {}

  std::optional<Failure> advance(std::int64_t steps) override {
    const Advance done = integrator_.advance(raw_, {.steps = steps});
    if (done.failure != nullptr) return *done.failure;
    return {};
  }

 protected:
  /// The state that begins anew, to be written to.
  ParticleSystem<Real>& begin_at(const Clock<Real>& clock) {
    raw_.clock() = clock;
    raw_.phase() = Phase{};
    raw_.keep_low_words(false);
    return raw_;
  }
  void bind() { integrator_.bind(raw_); }
  const ParticleSystem<Real>& settled() {
    integrator_.settle(raw_, settled_, {}, {}, true);
    return settled_;
  }

 private:
  AnyIntegrator<Real> integrator_;
  ParticleSystem<Real> raw_, settled_;
};

/// Of a splitting: row i + k n is change k of particle i.
template <class Real> class SplitTangents final : public TangentRun<Real> {
 public:
  using typename TangentFlow<Real>::State;
  using typename TangentFlow<Real>::Changes;

  SplitTangents(AnyIntegrator<Real> integrator, ParticleSystem<Real> rows, Index n)
      : TangentRun<Real>(std::move(integrator), std::move(rows)), n_(n) {}

  std::unique_ptr<TangentFlow<Real>> clone() const override { return std::make_unique<SplitTangents>(*this); }
  Index size() const override { return 6 * n_; }
  void gather(const ParticleSystem<Real>& now, State& y) const override { detail::gather_particles(now, y); }
  void begin(const Clock<Real>& clock, const State& y, const Changes& changes) override {
    ParticleSystem<Real>& s = this->begin_at(clock);
    put(y.data(), 0, s);
    for (Index k = 0; k < changes.cols(); ++k) put(changes.col(k).data(), k + 1, s);
    this->bind();
  }
  void read(State& y, Changes& changes) override {
    const ParticleSystem<Real>& s = this->settled();
    y.resize(size());
    take(s, 0, y.data());
    changes.resize(size(), s.size() / n_ - 1);
    for (Index k = 0; k < changes.cols(); ++k) take(s, k + 1, changes.col(k).data());
  }

 private:
  void put(const Real* y, Index k, ParticleSystem<Real>& s) const {
    for (int c = 0; c < 3; ++c) {
      std::copy_n(y + c * n_, n_, s.positions().component(c) + k * n_);
      std::copy_n(y + (3 + c) * n_, n_, s.velocities().component(c) + k * n_);
    }
  }
  void take(const ParticleSystem<Real>& s, Index k, Real* y) const {
    for (int c = 0; c < 3; ++c) {
      std::copy_n(s.positions().component(c) + k * n_, n_, y + c * n_);
      std::copy_n(s.velocities().component(c) + k * n_, n_, y + (3 + c) * n_);
    }
  }

  Index n_;
};

/// Of a classical method: the variables of a `VariedField`.
template <class Real> class FieldTangents final : public TangentRun<Real> {
 public:
  using typename TangentFlow<Real>::State;
  using typename TangentFlow<Real>::Changes;

  FieldTangents(AnyIntegrator<Real> integrator, ParticleSystem<Real> variables, VariedField<Real> layout,
                std::unique_ptr<VectorField<Real>> field, Index changes)
      : TangentRun<Real>(std::move(integrator), std::move(variables)),
        layout_(std::move(layout)),
        field_(std::move(field)),
        changes_(changes) {}
  FieldTangents(const FieldTangents& other)
      : TangentRun<Real>(other), layout_(other.layout_), field_(other.field_->clone()), changes_(other.changes_) {}

  std::unique_ptr<TangentFlow<Real>> clone() const override { return std::make_unique<FieldTangents>(*this); }
  Index size() const override { return field_->size(); }
  void gather(const ParticleSystem<Real>& now, State& y) const override { field_->gather(now, y); }
  void begin(const Clock<Real>& clock, const State& y, const Changes& changes) override {
    layout_.put(y, 0, all_);
    for (Index k = 0; k < changes_; ++k) {
      one_ = changes.col(k);
      layout_.put(one_, k + 1, all_);
    }
    layout_.scatter(all_, this->begin_at(clock));
    this->bind();
  }
  void read(State& y, Changes& changes) override {
    layout_.gather(this->settled(), all_);
    layout_.take(all_, 0, y);
    changes.resize(size(), changes_);
    for (Index k = 0; k < changes_; ++k) {
      layout_.take(all_, k + 1, one_);
      changes.col(k) = one_;
    }
  }

 private:
  VariedField<Real> layout_;
  std::unique_ptr<VectorField<Real>> field_;
  Index changes_;
  Vector<Real> all_, one_;
};

}  // namespace

template <class Real>
std::unique_ptr<TangentFlow<Real>> detail::split_tangents(AnyHamiltonian<Real> varied, const Scheme& scheme,
                                                          const CompositionOptions& options,
                                                          const ParticleSystem<Real>& s, Index changes) {
  ParticleSystem<Real> rows(s.units());
  for (Index row = 0; row < (1 + changes) * s.size(); ++row)
    rows.add("", Real(1), Vec3<Real>(Vec3<Real>::Zero()), Vec3<Real>(Vec3<Real>::Zero()));
  return std::make_unique<SplitTangents<Real>>(Composition<AnyHamiltonian<Real>>(std::move(varied), scheme, options),
                                               std::move(rows), s.size());
}

template std::unique_ptr<TangentFlow<double>> detail::split_tangents(AnyHamiltonian<double>, const Scheme&,
                                                                     const CompositionOptions&,
                                                                     const ParticleSystem<double>&, Index);
template std::unique_ptr<TangentFlow<Quad>> detail::split_tangents(AnyHamiltonian<Quad>, const Scheme&,
                                                                   const CompositionOptions&,
                                                                   const ParticleSystem<Quad>&, Index);

std::unique_ptr<TangentFlow<double>> tangent_flow(const AnyHamiltonian<double>& hamiltonian, const Scheme& scheme,
                                                  const ParticleSystem<double>& s, Index changes,
                                                  const CompositionOptions& options) {
  if (const auto* points = hamiltonian.as<KineticPotential<ForceField<double>>>())
    return tangent_flow(*points, scheme, s, changes, options);
  if (const auto* planets = hamiltonian.as<WisdomHolman<double>>())
    return tangent_flow(*planets, scheme, s, changes, options);
  if (const auto* planets = hamiltonian.as<WisdomHolman<double, ForceField<double>>>())
    return tangent_flow(*planets, scheme, s, changes, options);
  const std::string letters = hamiltonian.claims().alphabet;
  throw Error(fmt::format(
      "the flows {} of '{}' have no derivatives; splittings of kinetic_potential without constraints and of "
      "wisdom_holman have them, with no further letter, and methods for y' = f such as 'gauss_8' with adaptive = false",
      letters, hamiltonian.name()));
}

template <class Real>
std::unique_ptr<TangentFlow<Real>> tangent_flow(std::unique_ptr<VectorField<Real>> field, const MethodChoice& choice,
                                                const ParticleSystem<Real>& s, Index changes) {
  if (choice.info->is_adaptive(choice.options)) {
    throw Error(
        fmt::format("method '{}' chooses its steps, which changes of a state would have to follow; give it "
                    "steps of one length (adaptive = false, or another method)",
                    choice.info->name));
  }
  if (s.box().is_periodic()) throw Error("changes of particles in a periodic box cannot be followed; take out the box");
  field->bind(s);
  if (!field->has_derivative()) {
    throw Error(fmt::format("the right-hand side of '{}' is written for doubles only and has no derivatives",
                            field->claims().name));
  }
  VariedField<Real> varied(field->clone(), changes);
  ParticleSystem<Real> variables(s.units());
  variables.set_variables(std::vector<Real>(static_cast<std::size_t>(varied.size()), Real(0)));
  variables.clock() = s.clock();
  Classical<Real> integrator(varied.clone(), choice);
  try {
    integrator.bind(variables);
  } catch (const Error& error) {
    throw Error(fmt::format("changes of a state cannot be followed by this method: {}", error.message()));
  }
  if (integrator.claims().memory != Memory::none) {
    throw Error(
        fmt::format("method '{}' goes on from earlier steps, which changes of a state do not; use a method of "
                    "single steps, such as 'gauss_8' with adaptive = false",
                    choice.info->name));
  }
  return std::make_unique<FieldTangents<Real>>(std::move(integrator), std::move(variables), std::move(varied),
                                               std::move(field), changes);
}

template std::unique_ptr<TangentFlow<double>> tangent_flow(std::unique_ptr<VectorField<double>>, const MethodChoice&,
                                                           const ParticleSystem<double>&, Index);
template std::unique_ptr<TangentFlow<Quad>> tangent_flow(std::unique_ptr<VectorField<Quad>>, const MethodChoice&,
                                                         const ParticleSystem<Quad>&, Index);

}  // namespace noether
