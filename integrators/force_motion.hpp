#pragma once
/// Particles under forces as y' = f(t, y), y = (x, v).

#include "engine/erasure.hpp"
#include "engine/lane_by_lane.hpp"
#include "engine/signature.hpp"
#include "forces/secant_tangent.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/particle_vector.hpp"
#include "integrators/vector_field.hpp"
#include "neighbors/neighbor_list.hpp"
#include "numbers/pack.hpp"
#include "numbers/parallel.hpp"

#include <algorithm>
#include <deque>
#include <limits>
#include <optional>
#include <utility>

namespace noether {

namespace detail {

/// A force as the terms that it is a sum of.
template <class Real, class F> std::vector<AnyForce<Real>> terms_of(const F& force) {
  if constexpr (std::is_same_v<F, ForceField<Real>>) {
    return force.terms();
  } else if constexpr (requires { force.for_each([](const auto&) {}); }) {
    std::vector<AnyForce<Real>> terms;
    force.for_each([&](const auto& term) { terms.emplace_back(term); });
    return terms;
  } else {
    return {AnyForce<Real>(force)};
  }
}

/// The energy of particles in 113 bits, second words included. It keeps what it works with from call to call.
class WideEnergy {
 public:
  bool begun() const { return particles_.has_value(); }
  void begin(const std::vector<AnyForce<double>>& forces, const ParticleSystem<double>& s);
  /// @param s  of the masses that it was begun with, with second words
  /// @return empty where a force is in doubles only
  std::optional<EnergyTerms<Quad>> of(const ParticleSystem<double>& s);

 private:
  std::optional<ParticleSystem<Quad>> particles_;
  ForceField<Quad> forces_;
  Workspace workspace_;
  VectorColumn<Quad> a_;
  bool serves_ = false;  ///< whether all forces are known in 113 bits
};

/// Gravity of masses without softening among forces, and what acts beside it.
template <class Real> struct PointGravity {
  std::optional<double> G;
  ForceField<Real> beside;

  PointGravity() = default;
  PointGravity(const std::vector<AnyForce<Real>>& terms, const ParticleSystem<Real>& s) {
    for (const AnyForce<Real>& term : terms) {
      const ForceClaims claims = term.claims();
      if (claims.kepler && claims.softening == 0 && !G) {
        G = claims.G.value_or(s.units().G);
      } else {
        beside.add(term);
      }
    }
  }
};

}  // namespace detail

/// x' = v, v' = a(t, x, v): what forces, the velocity-dependent ones among them, do to particles.
///
/// y holds all x, then all y, then all z, then the velocities likewise, shape (6 n).
/// @cost one force evaluation and a copy of 12 n numbers
template <class F, class Real> class ForceMotion final : public VectorField<Real> {
 public:
  /// @param name  of the Hamiltonian the forces come from, as reports show it
  explicit ForceMotion(F forces, std::string name = "kinetic_potential")
      : forces_(std::move(forces)), name_(std::move(name)) {}

  std::unique_ptr<VectorField<Real>> clone() const override { return std::make_unique<ForceMotion>(*this); }
  FieldClaims claims() const override {
    const ForceClaims forces = claims_of(forces_);
    return {.name = name_,
            .second_order = true,
            .velocity_dependent = forces.velocity_dependent,
            .gyrates = forces.gyrates,
            .time_dependent = forces.time_dependent,
            .energy = forces.energy,
            .dissipative = forces.dissipative,
            .any_origin = forces.keeps_momentum && !forces.velocity_dependent && !forces.time_dependent &&
                          !work_.box().is_periodic(),
            .symplectic = !forces.velocity_dependent,
            .no_action = forces.velocity_dependent ? "a force depends on velocities, so the motion has no action" : "",
            .keeps_momentum = forces.keeps_momentum,
            .keeps_angular_momentum = forces.keeps_angular_momentum && !work_.box().is_periodic()};
  }
  std::string signature() const override { return detail::signature_of(forces_); }

  void bind(const ParticleSystem<Real>& s) override {
    bind_force(forces_, s);
    workspace_ = Workspace();
    workspace_.put(NeighborList(claims_of(forces_).range));
    work_ = s;
    work_.keep_low_words(false);
    work_.clock() = Clock<Real>::free(0);
    a_ = rates_ = VectorColumn<Real>(s.size());
    in_lanes_ = std::is_same_v<Real, double> && has_lanes(forces_) && s.size() <= most_in_lanes;
    if (in_lanes_) bind_lanes(s);
    along_.reset();
    other_.reset();
    coupling_ = Coupling::of(claims_of(forces_), s.units().G);
    gravity_ = {detail::terms_of<Real>(forces_), s};
    bind_force(gravity_.beside, s);
    beside_workspace_ = Workspace();
    beside_workspace_.put(NeighborList(claims_of(forces_).range));
    this->forget_scales();
  }
  Index size() const override { return 6 * work_.size(); }
  Index particles() const override { return work_.size(); }
  void gather(const ParticleSystem<Real>& s, Vector<Real>& y) const override { detail::gather_particles(s, y); }
  void scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const override { detail::scatter_particles(y, s); }

  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) override {
    ForceSink<Real> sink(a_, s, {.energy = true}, &workspace_);
    forces_.add_to(sink, s);
    return {kinetic_energy(s), sink.potential()};
  }
  std::optional<Mat3<Real>> virial(const ParticleSystem<Real>& s) override {
    if (!claims_of(forces_).virial) return {};
    ForceSink<Real> sink(a_, s, {.virial = true}, &workspace_);
    forces_.add_to(sink, s);
    return sink.virial();
  }
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) override {
    ForceSink<Real> sink(a, s, {}, &workspace_);
    forces_.add_to(sink, s);
  }

  bool has_potential() const override { return claims_of(forces_).energy; }
  Real potential(const Real& t, const Vector<Real>& y) override {
    scatter(y, work_);
    work_.clock().set_stage_offset(t);
    work_.wrap();
    ForceSink<Real> sink(a_, work_, {.energy = true}, &workspace_);
    forces_.add_to(sink, work_);
    this->note(sink.failure());
    return sink.failure() ? std::numeric_limits<Real>::quiet_NaN() : sink.potential();
  }
  Vector<Real> masses() const override { return work_.masses().all().replicate(3, 1); }
  Real lagrangian(const Real& t, const Vector<Real>& y) override {
    const Real u = potential(t, y);
    return kinetic_energy(work_) - u;
  }
  std::optional<double> gravity_of_points() const override { return gravity_.G; }
  bool has_forces_beside_gravity() const override { return !gravity_.beside.terms().empty(); }
  void accelerations_beside_gravity(const Real& t, const Vector<Real>& y, Vector<Real>& a) override {
    scatter(y, work_);
    work_.clock().set_stage_offset(t);
    work_.wrap();
    ForceSink<Real> sink(a_, work_, {}, &beside_workspace_);
    gravity_.beside.add_to(sink, work_);
    this->note(sink.failure());
    if (sink.failure()) spoil(a_);
    a.resize(3 * work_.size());
    write(a.data());
  }
  std::optional<EnergyTerms<Quad>> wide_energy(const ParticleSystem<Real>& s) override {
    if constexpr (std::is_same_v<Real, double>) {
      if (s.low_words() == nullptr) return {};
      auto& wide = workspace_.get<detail::WideEnergy>();
      if (!wide.begun()) wide.begin(detail::terms_of<Real>(forces_), s);
      return wide.of(s);
    }
    return {};
  }
  bool has_secant() const override { return noether::has_secant<Real>(forces_); }
  std::string forces_without_secant() const override {
    return names_of([](const AnyForce<Real>& term) { return !term.has_secant(); });
  }
  void secant(const Real& t, const Vector<Real>& y0, const Vector<Real>& y1, Vector<Real>& a) override {
    if constexpr (sees_secants) {
      ++this->evaluations().force;
      add_secants(t, y0, y1, nullptr);
      a.resize(3 * work_.size());
      write(a.data());
    } else {
      VectorField<Real>::secant(t, y0, y1, a);
    }
  }
  TangentPattern tangent_pattern() const override {
    return sees_secants ? claims_of(forces_).tangent : TangentPattern::none;
  }
  std::string forces_without_tangent() const override {
    return names_of([](const AnyForce<Real>& term) { return term.claims().tangent == TangentPattern::none; });
  }
  void secant_tangent(const Real& t, const Vector<Real>& y0, const Vector<Real>& y1,
                      SecantTangent<Real>& tangent) override {
    if (!sees_secants) VectorField<Real>::secant_tangent(t, y0, y1, tangent);
    do {
      tangent.begin(work_.masses());
      add_secants(t, y0, y1, &tangent);
    } while (!tangent.end());
  }

  bool has_derivative() const override { return noether::has_derivative<Real>(forces_); }
  void derivative(const Real& t, const Vector<Real>& y, const Real& dt, const Vector<Real>& dy,
                  Vector<Real>& out) override {
    if constexpr (Force<F, Dual<Real, 1>>) {
      if (!along_) along_.emplace(work_);
      along_->sum(forces_, t, y, dt, dy);
      const Index n = work_.size(), half = 3 * n;
      out.resize(2 * half);
      std::copy_n(dy.data() + half, half, out.data());
      for (int k = 0; k < 3; ++k) {
        for (Index i = 0; i < n; ++i) out[half + k * n + i] = along_->a.component(k)[i].slope[0];
      }
    } else {
      VectorField<Real>::derivative(t, y, dt, dy, out);
    }
  }

  /// x' = v needs no evaluation, and v' none in directions it does not depend on.
  bool jacobian(const Real& t, const Vector<Real>& y, Matrix<Real>& J) override {
    if (!has_derivative()) return false;
    const Index half = 3 * work_.size(), columns = claims_of(forces_).velocity_dependent ? 2 * half : half;
    J.setZero(2 * half, 2 * half);
    for (Index i = 0; i < half; ++i) J(i, half + i) = Real(1);
    direction_.setZero(2 * half);
    for (Index j = 0; j < columns; ++j) {
      direction_[j] = Real(1);
      derivative(t, y, Real(0), direction_, column_);
      direction_[j] = Real(0);
      for (Index i = half; i < 2 * half; ++i) J(i, j) = column_[i];
    }
    return true;
  }

  bool stages_in_turn() const override { return !in_lanes_; }
  Real* place_of_stages() override {
    if constexpr (sees_packs) {
      if (in_lanes_) return numbers(packs_.positions());
    }
    return nullptr;
  }

 protected:
  void measure_particles(const Vector<Real>& y, double rtol, ParticleScales& scales) override {
    scatter(y, work_);
    work_.wrap();
    measure(work_, coupling_, workspace_.find<NeighborList>(), rtol, scales);
  }
  void evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) override {
    const Index half = 3 * work_.size();
    sum(t, y);
    dy.resize(2 * half);
    std::copy_n(y.data() + half, half, dy.data());
    write(dy.data() + half);
  }
  void accelerate(const Real& t, const Vector<Real>& y, Vector<Real>& a) override {
    sum(t, y);
    a.resize(3 * work_.size());
    write(a.data());
  }
  void accelerate_apart(const Real& t, const Vector<Real>& y, Vector<Real>& a, Vector<Real>& rate) override {
    if (!claims_of(forces_).gyrates) return VectorField<Real>::accelerate_apart(t, y, a, rate);
    sum(t, y, &rates_);
    a.resize(3 * work_.size());
    write(a.data());
    rate.resize(3 * work_.size());
    write(rates_, rate.data());
  }
  const Real* evaluate_stages(const StageStates<Real>& states, Real* out) override {
    if constexpr (sees_packs) {
      if (in_lanes_) return evaluate_lanes(states);
    }
    evaluate_in_turn(states, out);
    return out;
  }

 private:
  static constexpr bool sees_secants = requires(const F& forces, ForceSink<Real>& out, const ParticleSystem<Real>& s) {
    forces.add_secant_to(out, s, s);
  };
  static constexpr bool sees_packs = std::is_same_v<Real, double> && Force<F, Pack>;
  /// Above, the lanes are better filled with particles.
  static constexpr Index most_in_lanes = 64;

  void bind_lanes(const ParticleSystem<Real>& s) {
    if constexpr (sees_packs) {
      packs_ = s.template as<Pack>();
      packs_.trim();
      packs_.clock() = Clock<Pack>::free(0);
      pack_a_ = VectorColumn<Pack>(s.size());
      sets_ = claims_of(forces_).sets;
    }
  }
  /// Packs are not padded: a column holds what the stages hold, in the same order.
  static double* numbers(VectorColumn<Pack>& column) { return column.component(0)->lane.data(); }
  const Real* evaluate_lanes(const StageStates<Real>& states) {
    if constexpr (sees_packs) {
      const auto all = static_cast<std::size_t>(3 * work_.size());
      if (states.q != place_of_stages()) copy_packs(states.q, place_of_stages(), all);
      if (states.v != nullptr) copy_packs(states.v, numbers(packs_.velocities()), all);
      packs_.clock().set_stage_offset(Pack::load(states.t));
      sum_in_lanes();
      return numbers(pack_a_);
    }
    return nullptr;
  }
  /// Where the lanes of a force take different branches, the sum starts again with a place to go lane by lane, and
  /// keeps it for a while: each way has the same bits, but giving up costs more than a copy of the sums.
  void sum_in_lanes() {
    if constexpr (sees_packs) {
      if (careful_ == 0) {
        try {
          ForceSink<Pack> sink =
              sets_ ? ForceSink<Pack>::unset(pack_a_, packs_) : ForceSink<Pack>(pack_a_, packs_, {}, &workspace_);
          forces_.add_to(sink, packs_);
          return note_in_lanes(sink.failure());
        } catch (const LanesDiffer&) {
          careful_ = 100;
        }
      }
      --careful_;
      LaneByLane place(work_, a_, before_);
      ForceSink<Pack> sink(pack_a_, packs_, {}, &workspace_);
      sink.set_lane_by_lane(&place);
      add_in_lanes(forces_, sink, packs_);
      note_in_lanes(sink.failure());
    }
  }
  /// What cannot be computed in one lane leaves numbers in none: no step can stand on these stages.
  void note_in_lanes(const std::optional<Failure>& failure) {
    this->note(failure);
    if (failure) spoil(pack_a_);
  }

  /// One stage after the other, straight into the particles and out of them.
  void evaluate_in_turn(const StageStates<Real>& states, Real* out) {
    const Index n = work_.size();
    VectorColumn<Real>&x = work_.positions(), &v = work_.velocities();
    for (int stage = 0; stage < states.stages; ++stage) {
      if (!states.wants(stage)) continue;
      const auto take = [&](const Real* from, VectorColumn<Real>& to) {
        for (int k = 0; k < 3; ++k) {
          Real* const component = to.component(k);
          for (Index i = 0; i < n; ++i, from += lane_count) component[i] = from[stage];
        }
      };
      take(states.q, x);
      if (states.v != nullptr) take(states.v, v);
      work_.clock().set_stage_offset(states.t[stage]);
      work_.moved();
      sum_forces();
      Real* to = out + stage;
      for (int k = 0; k < 3; ++k) {
        const Real* const component = a_.component(k);
        for (Index i = 0; i < n; ++i, to += lane_count) *to = component[i];
      }
    }
    states.fill_lanes(3 * n, out);
  }

  /// @param rates  if given, gets the rates at which velocities turn, and accelerations are without these turns
  void sum(const Real& t, const Vector<Real>& y, VectorColumn<Real>* rates = nullptr) {
    scatter(y, work_);
    work_.clock().set_stage_offset(t);
    sum_forces(rates);
  }
  /// Accelerations of the particles at work. Where a force cannot be computed they are no numbers: a shorter step may
  /// help, or the run has diverged.
  void sum_forces(VectorColumn<Real>* rates = nullptr) {
    work_.wrap();
    ForceSink<Real> sink(a_, work_, {}, &workspace_);
    if (rates != nullptr) sink.set_gyrations(*rates);
    forces_.add_to(sink, work_);
    if (!sink.failure()) return;
    this->note(sink.failure());
    spoil(a_);
  }
  /// Accelerations between two states; not numbers where they cannot be computed. @param tangent  null: unwanted
  void add_secants(const Real& t, const Vector<Real>& y0, const Vector<Real>& y1, SecantTangent<Real>* tangent) {
    if constexpr (sees_secants) {
      if (!other_) other_.emplace(work_);
      scatter(y0, *other_);
      scatter(y1, work_);
      // Both in the cells of one state: what evaluations have wrapped since is no part of the way between them.
      if (work_.box().is_periodic()) other_->restore_images(work_.images());
      other_->clock().set_stage_offset(t);
      work_.clock().set_stage_offset(t);
      ForceSink<Real> sink(a_, work_, {}, &workspace_);
      sink.set_tangent(tangent);
      forces_.add_secant_to(sink, *other_, work_);
      this->note(sink.failure());
      if (sink.failure()) spoil(a_);  // what is there is not all of it
    }
  }
  template <class Wanted> std::string names_of(const Wanted& wanted) const {
    std::string names;
    for (const AnyForce<Real>& term : detail::terms_of<Real>(forces_)) {
      if (wanted(term)) names += (names.empty() ? "'" : ", '") + term.name() + "'";
    }
    return names;
  }
  template <class Number> static void spoil(VectorColumn<Number>& a) {
    for (int k = 0; k < 3; ++k) std::fill_n(a.component(k), a.size(), Number(std::numeric_limits<double>::quiet_NaN()));
  }
  void write(Real* out) const { write(a_, out); }
  static void write(const VectorColumn<Real>& from, Real* out) {
    for (int k = 0; k < 3; ++k) std::copy_n(from.component(k), from.size(), out + k * from.size());
  }

  /// The particles on their way along a direction.
  struct Along {
    explicit Along(const ParticleSystem<Real>& s) : particles(s.template as<Dual<Real, 1>>()), a(s.size()) {
      particles.clock() = Clock<Dual<Real, 1>>::free(0);
    }
    void sum(const F& forces, const Real& t, const Vector<Real>& y, const Real& dt, const Vector<Real>& dy) {
      const Index n = a.size();
      auto &x = particles.positions(), &v = particles.velocities();
      for (int k = 0; k < 3; ++k) {
        for (Index i = 0, at = k * n; i < n; ++i, ++at) {
          x.component(k)[i] = detail::along(y[at], dy[at]);
          v.component(k)[i] = detail::along(y[3 * n + at], dy[3 * n + at]);
        }
      }
      particles.clock().set_stage_offset(detail::along(t, dt));
      ForceSink<Dual<Real, 1>> sink(a, particles, {});
      forces.add_to(sink, particles);
    }

    ParticleSystem<Dual<Real, 1>> particles;
    VectorColumn<Dual<Real, 1>> a;
  };

  F forces_;
  std::string name_;
  Coupling coupling_;
  detail::PointGravity<Real> gravity_;
  Workspace workspace_, beside_workspace_;
  ParticleSystem<Real> work_;
  std::optional<ParticleSystem<Real>> other_;  ///< where secants begin; made by the first of them
  VectorColumn<Real> a_, rates_;
  bool in_lanes_ = false, sets_ = false;
  ParticleSystem<Pack> packs_;
  VectorColumn<Pack> pack_a_;
  std::deque<VectorColumn<Pack>> before_;
  int careful_ = 0;             ///< evaluations to come that are ready for lanes that differ
  std::optional<Along> along_;  ///< made by the first derivative
  Vector<Real> direction_, column_;
};

extern template class ForceMotion<ForceField<double>, double>;
extern template class ForceMotion<ForceField<Quad>, Quad>;

}  // namespace noether
