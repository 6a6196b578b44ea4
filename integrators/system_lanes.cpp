#include "integrators/system_lanes.hpp"

#include "integrators/composition.hpp"
#include "integrators/damped.hpp"
#include "integrators/force_lanes.hpp"
#include "integrators/kicked_changes.hpp"
#include "integrators/kinetic_potential.hpp"
#include "numbers/pack.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace noether {

namespace {

/// Systems under forces.
class KickedLanes final : public SystemLanes {
 public:
  KickedLanes(const ForceField<double>& forces, const ParticleSystem<double>& like, bool compensated)
      : forces_(forces, like), like_(like), claims_(KineticPotential<ForceField<double>>(forces).claims()) {
    run_ = like.as<Pack>();
    run_.clock() = Clock<Pack>::free(0);
    run_.keep_low_words(compensated);
    shown_ = kept_ = run_;
    a_ = VectorColumn<Pack>(like.size());
  }

  std::string name() const override { return "kinetic_potential"; }
  HamiltonianClaims claims() const override { return claims_; }

  void put(std::size_t lane, const ParticleSystem<double>& s) override {
    for (int k = 0; k < 3; ++k) {
      for (Index i = 0; i < s.size(); ++i) {
        run_.positions().component(k)[i].lane[lane] = s.positions().component(k)[i];
        run_.velocities().component(k)[i].lane[lane] = s.velocities().component(k)[i];
      }
    }
    known_.reset();
    for (Index i = 0; i < s.size(); ++i) run_.masses()[i].lane[lane] = s.masses()[i];
  }
  void take(std::size_t lane, ParticleSystem<double>& s) const override {
    const ParticleSystem<Pack>& from = shown_;
    for (int k = 0; k < 3; ++k) {
      for (Index i = 0; i < s.size(); ++i) {
        s.positions().component(k)[i] = from.positions().component(k)[i].lane[lane];
        s.velocities().component(k)[i] = from.velocities().component(k)[i].lane[lane];
      }
    }
  }
  void copy_lane(std::size_t from, std::size_t to) override {
    const auto copy = [&](VectorColumn<Pack>& column) {
      for (int k = 0; k < 3; ++k) {
        for (Index i = 0; i < column.size(); ++i) {
          column.component(k)[i].lane[to] = column.component(k)[i].lane[from];
        }
      }
    };
    copy(run_.positions());
    copy(run_.velocities());
    for (Change& change : run_changes_) copy(change.x), copy(change.v);
    known_.reset();
    for (Index i = 0; i < run_.size(); ++i) run_.masses()[i].lane[to] = run_.masses()[i].lane[from];
    if (auto* low = run_.low_words()) copy(low->x), copy(low->v);
  }

  void show() override {
    shown_.assign_state(run_);
    showing_ = true;
  }
  void go_on() override { showing_ = false; }
  void keep() override {
    kept_.assign_state(run_);
    kept_changes_ = run_changes_;
  }
  void go_back() override {
    run_.assign_state(kept_);
    run_changes_ = kept_changes_;
    known_.reset();
    failure_.reset();
  }

  void flow(char letter, double h, double time) override {
    if (showing_) return flow(letter, h, time, shown_, shown_changes_);
    flow(letter, h, time, run_, run_changes_);
  }

  void carry(std::size_t changes) override {
    const Index n = run_.size();
    run_changes_.assign(changes, {VectorColumn<Pack>(n), VectorColumn<Pack>(n), VectorColumn<Pack>(n)});
    kept_changes_ = run_changes_;
    by_forces_.emplace(forces_.forces(), like_);
  }
  void put_change(std::size_t lane, std::size_t change, const double* c) override {
    Change& to = run_changes_[change];
    const Index n = run_.size();
    for (int k = 0; k < 3; ++k) {
      for (Index i = 0; i < n; ++i) {
        to.x.component(k)[i].lane[lane] = c[k * n + i];
        to.v.component(k)[i].lane[lane] = c[(3 + k) * n + i];
      }
    }
    known_.reset();
  }
  void scale_change(std::size_t lane, std::size_t change, double factor) override {
    Change& of = run_changes_[change];
    for (int k = 0; k < 3; ++k) {
      for (Index i = 0; i < run_.size(); ++i) {
        of.x.component(k)[i].lane[lane] *= factor;
        of.v.component(k)[i].lane[lane] *= factor;
      }
    }
    known_.reset();
  }
  void measure(std::span<const LaneFlow> ahead, std::size_t change, double* squares) override {
    const LaneFlow none{'A', 0, 0};
    if (ahead.size() < 2) return measure(ahead.empty() ? none : ahead[0], run_changes_[change], squares);
    shown_.assign_state(run_);
    shown_changes_ = run_changes_;
    for (const LaneFlow& one : ahead) flow(one.letter, one.h, one.time, shown_, shown_changes_);
    measure(none, shown_changes_[change], squares);
    shown_changes_.clear();
  }
  void scale_velocities(double factor) override { (showing_ ? shown_ : run_).scale_velocities(Pack(factor)); }
  const std::optional<Failure>& failure() const override { return failure_; }

 private:
  struct Change {
    VectorColumn<Pack> x, v, a;  ///< `a` of the last kick
  };
  /// The kick whose accelerations of changes are known: positions have not moved since.
  struct Known {
    char letter;
    double time;
  };

  void flow(char letter, double h, double time, ParticleSystem<Pack>& s, std::vector<Change>& changes) {
    if (letter == 'A') {
      for (Change& change : changes) add(Pack(h), change.v, change.x);
      known_.reset();
      return s.advance_positions(Pack(h));
    }
    s.clock().set_stage_offset(Pack(time));
    const std::optional<Failure> failure = forces_.sum(claims_.kicks.size() > 1 ? letter : 0, s, a_);
    if (failure && !failure_ && !showing_) failure_ = failure;
    s.advance_velocities(Pack(h), a_);
    if (changes.empty()) return;
    sum_changes(letter, time, s, changes);
    for (Change& change : changes) add(Pack(h), change.a, change.v);
  }
  void sum_changes(char letter, double time, const ParticleSystem<Pack>& s, std::vector<Change>& changes) {
    const bool of_run = &changes == &run_changes_;
    if (!claims_.time_dependent) time = 0;
    if (of_run && known_ && known_->letter == letter && known_->time == time) return;
    for (Change& change : changes) by_forces_->sum(claims_.kicks.size() > 1 ? letter : 0, s, change.x, change.a);
    if (of_run) known_ = Known{letter, time};
  }
  static void add(const Pack& h, const VectorColumn<Pack>& rate, VectorColumn<Pack>& to) {
    for (int k = 0; k < 3; ++k) {
      const Pack* from = rate.component(k);
      Pack* sum = to.component(k);
      for (Index i = 0; i < to.size(); ++i) sum[i] += h * from[i];
    }
  }
  void measure(const LaneFlow& ahead, Change& change, double* squares) {
    const bool kick = ahead.letter != 'A';
    if (kick) {
      run_.clock().set_stage_offset(Pack(ahead.time));
      sum_changes(ahead.letter, ahead.time, run_, run_changes_);
    }
    const Pack h(ahead.h);
    Pack of_x(0), of_v(0);
    for (int k = 0; k < 3; ++k) {
      const Pack *x = std::as_const(change.x).component(k), *v = std::as_const(change.v).component(k),
                 *a = std::as_const(change.a).component(k);
      for (Index i = 0; i < run_.size(); ++i) {
        const Pack at = kick ? x[i] : x[i] + h * v[i], speed = kick ? v[i] + h * a[i] : v[i];
        of_x += at * at;
        of_v += speed * speed;
      }
    }
    of_x.store(squares);
    of_v.store(squares + lanes);
  }

  detail::ForceLanes forces_;
  ParticleSystem<double> like_;
  HamiltonianClaims claims_;
  ParticleSystem<Pack> run_, shown_, kept_;
  VectorColumn<Pack> a_;
  std::vector<Change> run_changes_, kept_changes_, shown_changes_;
  std::optional<detail::KickedChanges> by_forces_;
  std::optional<Known> known_;
  std::optional<Failure> failure_;
  bool showing_ = false;
};

/// Systems in lanes as a Hamiltonian: the particles that it is given are a clock and a phase.
class LaneLetters {
 public:
  using real = double;

  explicit LaneLetters(SystemLanes* systems) : systems_(systems) {}
  /// While this is set flows of copies are not done, but written down there.
  void write_to(std::vector<LaneFlow>* flows) { flows_ = flows; }
  std::string name() const { return systems_->name(); }
  HamiltonianClaims claims() const { return systems_->claims(); }
  void bind(ParticleSystem<double>& /*s*/) {}
  void open(ParticleSystem<double>& s) { s.phase().coordinates = claims().coordinates; }
  void close(ParticleSystem<double>& s) { s.phase().coordinates = 0; }
  void flow(char letter, ParticleSystem<double>& s, double h) {
    flows_ != nullptr ? flows_->push_back({letter, h, s.time()}) : systems_->flow(letter, h, s.time());
  }
  double flow_with_action(char /*letter*/, ParticleSystem<double>& /*s*/, double /*h*/) {
    throw LogicError("the action was requested of systems in lanes, which do not sum it");
  }
  EnergyTerms<double> energy(const ParticleSystem<double>& /*s*/) {
    throw LogicError("the energy was requested of systems in lanes, which do not sum it");
  }
  void accelerations(const ParticleSystem<double>& /*s*/, VectorColumn<double>& /*a*/) {
    throw LogicError("accelerations were requested of systems in lanes");
  }
  void observe(std::optional<Request> wanted) {
    if (flows_ == nullptr) wanted ? systems_->show() : systems_->go_on();
  }
  Evaluations evaluations() const { return {}; }
  const std::optional<Failure>& failure() const { return systems_->failure(); }

 private:
  SystemLanes* systems_;
  std::vector<LaneFlow>* flows_ = nullptr;
};

/// Systems with one letter more.
class DampedLanes final : public SystemLanes {
 public:
  DampedLanes(std::unique_ptr<SystemLanes> systems, double rate)
      : systems_(std::move(systems)),
        rate_(rate),
        claims_(Damped(LaneLetters(systems_.get()), LinearDrag{.rate = rate}).claims()) {}

  std::string name() const override { return "damped"; }
  HamiltonianClaims claims() const override { return claims_; }
  void put(std::size_t lane, const ParticleSystem<double>& s) override { systems_->put(lane, s); }
  void take(std::size_t lane, ParticleSystem<double>& s) const override { systems_->take(lane, s); }
  void copy_lane(std::size_t from, std::size_t to) override { systems_->copy_lane(from, to); }
  void show() override { systems_->show(); }
  void go_on() override { systems_->go_on(); }
  void keep() override { systems_->keep(); }
  void go_back() override { systems_->go_back(); }
  void flow(char letter, double h, double time) override {
    letter == 'D' ? scale_velocities(std::exp(-rate_ * h)) : systems_->flow(letter, h, time);
  }
  void scale_velocities(double factor) override { systems_->scale_velocities(factor); }
  void carry(std::size_t /*changes*/) override { throw Error("changes of systems with drag have no lanes"); }
  void put_change(std::size_t /*lane*/, std::size_t /*change*/, const double* /*c*/) override {}
  void scale_change(std::size_t /*lane*/, std::size_t /*change*/, double /*factor*/) override {}
  void measure(std::span<const LaneFlow> /*ahead*/, std::size_t /*change*/, double* /*squares*/) override {}
  const std::optional<Failure>& failure() const override { return systems_->failure(); }

 private:
  std::unique_ptr<SystemLanes> systems_;
  double rate_;
  HamiltonianClaims claims_;
};

}  // namespace

std::unique_ptr<SystemLanes> with_drag(std::unique_ptr<SystemLanes> systems, double rate) {
  return std::make_unique<DampedLanes>(std::move(systems), rate);
}

std::unique_ptr<SystemLanes> systems_under_forces(const ForceField<double>& forces, const ParticleSystem<double>& like,
                                                  bool compensated) {
  return std::make_unique<KickedLanes>(forces, like, compensated);
}

struct SplittingLanes::Walk {
  Walk(SystemLanes* systems, const Scheme& scheme, const CompositionOptions& options, const Clock<double>& clock)
      : word(LaneLetters(systems), scheme, options), timed(systems->claims().time_dependent) {
    at.add("", 1, Vec3<double>::Zero(), Vec3<double>::Zero());
    at.clock() = clock;
    word.bind(at);
    settled = kept = at;
  }
  /// Works out what completes a copy: where time does not matter, the same after every step.
  void look_ahead() {
    LaneLetters& letters = word.hamiltonian();
    const Phase phase = std::as_const(at).phase();
    if (known && !timed && phase.opened && phase.pending) return;
    ahead.clear();
    letters.write_to(&ahead);
    word.settle(at, settled, {}, {}, true);
    letters.write_to(nullptr);
    known = phase.opened && phase.pending;
  }

  Composition<LaneLetters> word;
  ParticleSystem<double> at, settled, kept;  ///< of which only clock and phase mean anything
  FollowedChanges followed;
  std::vector<LaneFlow> ahead;  ///< what completes a copy
  bool timed, known = false;    ///< whether flows depend on time; whether `ahead` is of a step that left one pending
};

SplittingLanes::SplittingLanes(std::unique_ptr<SystemLanes> systems, const Scheme& scheme,
                               const CompositionOptions& options, const Clock<double>& clock)
    : systems_(std::move(systems)), walk_(std::make_unique<Walk>(systems_.get(), scheme, options, clock)) {}

SplittingLanes::~SplittingLanes() = default;
SplittingLanes::SplittingLanes(SplittingLanes&&) noexcept = default;

std::int64_t SplittingLanes::step() const { return walk_->at.clock().step(); }

void SplittingLanes::follow(std::size_t lane, std::size_t change, std::shared_ptr<LaneChange> by) {
  systems_->put_change(lane, change, by->start().data());
  walk_->followed.add(lane, change, std::move(by));
}

void SplittingLanes::forget(std::size_t lane) { walk_->followed.forget(lane); }

bool SplittingLanes::advance(std::int64_t steps) {
  const std::int64_t until = step() + steps;
  while (step() < until) {
    const std::int64_t stride = walk_->followed.stride(step(), until - step());
    if (walk_->word.advance(walk_->at, {.steps = stride}).failure != nullptr) return false;
    measure(true);
  }
  return true;
}

/// @param due  only changes that are to be measured at this step; else those that may be looked at
void SplittingLanes::measure(bool due) {
  bool looked = false;
  walk_->followed.measure(
      step(), due,
      [&](std::size_t change, double* squares) {
        if (!looked) walk_->look_ahead();
        looked = true;
        systems_->measure(walk_->ahead, change, squares);
      },
      [&](std::size_t lane, std::size_t change, double factor) { systems_->scale_change(lane, change, factor); });
}

void SplittingLanes::settle() {
  if (!walk_->at.phase().opened) {  // then there is nothing to be completed
    systems_->show();
    systems_->go_on();
  }
  walk_->word.settle(walk_->at, walk_->settled, {}, {}, true);
  measure(false);
}

void SplittingLanes::take(std::size_t lane, ParticleSystem<double>& s) const {
  systems_->take(lane, s);
  s.clock() = walk_->at.clock();
  s.clock().set_fraction(0);
  s.phase() = Phase{};
}

void SplittingLanes::keep() {
  systems_->keep();
  walk_->kept.assign_state(walk_->at);
  walk_->followed.keep();
}

void SplittingLanes::go_back() {
  systems_->go_back();
  walk_->at.assign_state(walk_->kept);
  walk_->followed.go_back();
}

}  // namespace noether
