#include "integrators/system_lanes.hpp"

#include "engine/lane_by_lane.hpp"
#include "integrators/composition.hpp"
#include "integrators/damped.hpp"
#include "integrators/kinetic_potential.hpp"
#include "numbers/pack.hpp"

#include <cmath>
#include <utility>

namespace noether {

namespace {

/// Systems under forces. A force is evaluated in all lanes at once; where its branches differ, in one lane after the
/// other, each time with that lane in all eight: the same code has the same bits.
class KickedLanes final : public SystemLanes {
 public:
  KickedLanes(ForceField<double> forces, const ParticleSystem<double>& like, bool compensated)
      : forces_(std::move(forces)), claims_(KineticPotential<ForceField<double>>(forces_).claims()) {
    if (!forces_.has_lanes()) throw Error("a force is written for doubles only, so it has no lanes");
    bind_force(forces_, like);
    run_ = like.as<Pack>();
    run_.clock() = Clock<Pack>::free(0);
    run_.keep_low_words(compensated);
    shown_ = kept_ = one_ = run_;
    one_.keep_low_words(false);
    a_ = one_a_ = VectorColumn<Pack>(like.size());
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
    for (Index i = 0; i < run_.size(); ++i) run_.masses()[i].lane[to] = run_.masses()[i].lane[from];
    if (auto* low = run_.low_words()) copy(low->x), copy(low->v);
  }

  void show() override {
    shown_.assign_state(run_);
    showing_ = true;
  }
  void go_on() override { showing_ = false; }
  void keep() override { kept_.assign_state(run_); }
  void go_back() override {
    run_.assign_state(kept_);
    failure_.reset();
  }

  void flow(char letter, double h, double time) override {
    ParticleSystem<Pack>& s = showing_ ? shown_ : run_;
    if (letter == 'A') return s.advance_positions(Pack(h));
    s.clock().set_stage_offset(Pack(time));
    sum(letter, s);
    s.advance_velocities(Pack(h), a_);
  }
  void scale_velocities(double factor) override { (showing_ ? shown_ : run_).scale_velocities(Pack(factor)); }
  const std::optional<Failure>& failure() const override { return failure_; }

 private:
  void sum(char letter, const ParticleSystem<Pack>& s) {
    if (careful_ == 0) {
      try {
        return evaluate(letter, s, a_);
      } catch (const LanesDiffer&) {
        careful_ = 100;  // giving up costs more than a few evaluations
      }
    }
    --careful_;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      spread(lane, s.positions(), one_.positions());
      spread(lane, s.velocities(), one_.velocities());
      for (Index i = 0; i < s.size(); ++i) one_.masses()[i] = Pack(s.masses()[i].lane[lane]);
      one_.clock() = s.clock();
      evaluate(letter, one_, one_a_);
      for (int k = 0; k < 3; ++k) {
        for (Index i = 0; i < s.size(); ++i) a_.component(k)[i].lane[lane] = one_a_.component(k)[i].lane[0];
      }
    }
  }
  void evaluate(char letter, const ParticleSystem<Pack>& s, VectorColumn<Pack>& a) {
    ForceSink<Pack> sink(a, s, {}, &workspace_);
    if (claims_.kicks.size() > 1) sink.set_kick_letter(letter);
    forces_.add_to(sink, s);
    if (sink.failure() && !failure_ && !showing_) failure_ = sink.failure();
  }
  static void spread(std::size_t lane, const VectorColumn<Pack>& from, VectorColumn<Pack>& to) {
    for (int k = 0; k < 3; ++k) {
      for (Index i = 0; i < from.size(); ++i) to.component(k)[i] = Pack(from.component(k)[i].lane[lane]);
    }
  }

  ForceField<double> forces_;
  HamiltonianClaims claims_;
  ParticleSystem<Pack> run_, shown_, kept_, one_;
  VectorColumn<Pack> a_, one_a_;
  Workspace workspace_;
  std::optional<Failure> failure_;
  bool showing_ = false;
  int careful_ = 0;  ///< evaluations to come that go lane by lane
};

/// Systems in lanes as a Hamiltonian: the particles that it is given are a clock and a phase.
class LaneLetters {
 public:
  using real = double;

  explicit LaneLetters(SystemLanes* systems) : systems_(systems) {}
  std::string name() const { return systems_->name(); }
  HamiltonianClaims claims() const { return systems_->claims(); }
  void bind(ParticleSystem<double>& /*s*/) {}
  void open(ParticleSystem<double>& s) { s.phase().coordinates = claims().coordinates; }
  void close(ParticleSystem<double>& s) { s.phase().coordinates = 0; }
  void flow(char letter, ParticleSystem<double>& s, double h) { systems_->flow(letter, h, s.time()); }
  double flow_with_action(char /*letter*/, ParticleSystem<double>& /*s*/, double /*h*/) {
    throw LogicError("the action was requested of systems in lanes, which do not sum it");
  }
  EnergyTerms<double> energy(const ParticleSystem<double>& /*s*/) {
    throw LogicError("the energy was requested of systems in lanes, which do not sum it");
  }
  void accelerations(const ParticleSystem<double>& /*s*/, VectorColumn<double>& /*a*/) {
    throw LogicError("accelerations were requested of systems in lanes");
  }
  void observe(std::optional<Request> wanted) { wanted ? systems_->show() : systems_->go_on(); }
  Evaluations evaluations() const { return {}; }
  const std::optional<Failure>& failure() const { return systems_->failure(); }

 private:
  SystemLanes* systems_;
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

struct LaneRun::Walk {
  Walk(SystemLanes* systems, const Scheme& scheme, const CompositionOptions& options, const Clock<double>& clock)
      : word(LaneLetters(systems), scheme, options) {
    at.add("", 1, Vec3<double>::Zero(), Vec3<double>::Zero());
    at.clock() = clock;
    word.bind(at);
    settled = kept = at;
  }
  Composition<LaneLetters> word;
  ParticleSystem<double> at, settled, kept;  ///< of which only clock and phase mean anything
};

LaneRun::LaneRun(std::unique_ptr<SystemLanes> systems, const Scheme& scheme, const CompositionOptions& options,
                 const Clock<double>& clock)
    : systems_(std::move(systems)), walk_(std::make_unique<Walk>(systems_.get(), scheme, options, clock)) {}

LaneRun::~LaneRun() = default;

std::int64_t LaneRun::step() const { return walk_->at.clock().step(); }

bool LaneRun::advance(std::int64_t steps) {
  return walk_->word.advance(walk_->at, {.steps = steps}).failure == nullptr;
}

void LaneRun::settle() {
  if (!walk_->at.phase().opened) {  // then there is nothing to be completed
    systems_->show();
    systems_->go_on();
  }
  walk_->word.settle(walk_->at, walk_->settled, {}, {}, true);
}

void LaneRun::take(std::size_t lane, ParticleSystem<double>& s) const {
  systems_->take(lane, s);
  s.clock() = walk_->at.clock();
  s.clock().set_fraction(0);
  s.phase() = Phase{};
}

void LaneRun::keep() {
  systems_->keep();
  walk_->kept.assign_state(walk_->at);
}

void LaneRun::go_back() {
  systems_->go_back();
  walk_->at.assign_state(walk_->kept);
}

}  // namespace noether
