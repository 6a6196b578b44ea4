#include "integrators/planet_systems.hpp"

#include "integrators/kepler_tangent.hpp"
#include "integrators/kicked_changes.hpp"
#include "integrators/planet_systems_simd.hpp"
#include "integrators/wisdom_holman.hpp"
#include "numbers/pack.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace noether {

namespace {

/// Whole numbers of 64 bytes as lines of eight, one number of each lane.
template <class T> void copy_lane_of(T& lines, std::size_t from, std::size_t to) {
  static_assert(sizeof(T) % (8 * sizeof(double)) == 0, "an array of lines of eight numbers");
  auto* number = reinterpret_cast<double*>(&lines);
  for (std::size_t k = 0; k < sizeof(T) / sizeof(double); k += 8) number[k + to] = number[k + from];
}

/// Of each system what its planets have in common.
struct alignas(64) SystemConstants {
  double star[8];        ///< G m_0
  double relativity[8];  ///< 6 (G m_0/c)^2
};

/// Where the centres of mass are and how they move.
struct alignas(64) SystemCenters {
  double x[3][8], v[3][8], x_low[3][8], v_low[3][8];
};

void exact_turn(const double* start, double mu, double h, double s, double* change) {
  const auto three = [](const double* of) { return Vec3<double>(of[0], of[1], of[2]); };
  const KeplerTangent tangent(three(start), three(start + 3), mu, h, s);
  const KeplerChange before{three(change), three(change + 3)};
  const Vec3<double> x = tangent.position(before), v = tangent.velocity(before);
  for (int c = 0; c < 3; ++c) change[c] = x[c], change[c + 3] = v[c];
}

class PlanetLanesOfSystems final : public SystemLanes {
 public:
  PlanetLanesOfSystems(PlanetSystemsOptions options, const ParticleSystem<double>& like)
      : options_(std::move(options)),
        kernels_(planet_system_kernels()),
        planets_(options_.order.size() - 1),
        like_(like),
        others_(!options_.others.terms().empty()),
        time_dependent_(options_.others.claims().time_dependent) {
    for (State* state : {&run_, &shown_, &kept_}) {
      state->rows.assign(planets_, SystemRow{});
      state->masses.assign(others_ ? planets_ + 1 : 0, Pack(0));
    }
    if (!others_) return;
    if (!options_.others.has_lanes()) throw Error("a force is written for doubles only, so it has no lanes");
    bind_force(options_.others, like);
    inertial_ = one_ = like.as<Pack>();
    inertial_.clock() = Clock<Pack>::free(0);
    a_ = one_a_ = VectorColumn<Pack>(like.size());
  }

  std::string name() const override { return "wisdom_holman"; }
  HamiltonianClaims claims() const override {
    HamiltonianClaims claims = WisdomHolman<double>(WisdomHolmanOptions{}).claims();
    claims.alphabet = "AB";
    claims.kernels = {};
    return claims;
  }

  void put(std::size_t lane, const ParticleSystem<double>& s) override {
    const double m0 = s.masses()[0], G = options_.G;
    run_.constants.star[lane] = G * m0;
    if (options_.light) {
      const double bend = options_.G_of_light * m0 / *options_.light;
      run_.constants.relativity[lane] = 6 * bend * bend;
    }
    Vec3<double> x = s.positions()[0], v = s.velocities()[0];
    double inside = m0;
    if (others_) run_.masses[0].lane[lane] = m0;
    for (std::size_t k = 0; k < planets_; ++k) {
      const Index i = at(k);
      const double m = s.masses()[i];
      SystemRow& row = run_.rows[k];
      const Vec3<double> dx = s.positions()[i] - x, dv = s.velocities()[i] - v;
      inside += m;
      row.share[lane] = m / inside;
      row.mu[lane] = G * inside;
      row.attracts[lane] = G * m;
      row.of_star[lane] = m / m0;
      row.moves[lane] = 1;
      for (int c = 0; c < 3; ++c) {
        row.x[c][lane] = dx[c], row.v[c][lane] = dv[c];
        row.x_low[c][lane] = row.v_low[c][lane] = 0;
      }
      x += row.share[lane] * dx;
      v += row.share[lane] * dv;
      if (others_) run_.masses[k + 1].lane[lane] = m;
    }
    for (int c = 0; c < 3; ++c) {
      run_.centers.x[c][lane] = x[c], run_.centers.v[c][lane] = v[c];
      run_.centers.x_low[c][lane] = run_.centers.v_low[c][lane] = 0;
    }
    run_.predicted_for = 0;
    prepared_ = false;
    attracted_.reset();
  }

  void take(std::size_t lane, ParticleSystem<double>& s) const override {
    Vec3<double> x, v;
    for (int c = 0; c < 3; ++c) x[c] = shown_.centers.x[c][lane], v[c] = shown_.centers.v[c][lane];
    for (std::size_t k = planets_; k-- > 0;) {
      const SystemRow& row = shown_.rows[k];
      Vec3<double> dx, dv;
      for (int c = 0; c < 3; ++c) dx[c] = row.x[c][lane], dv[c] = row.v[c][lane];
      x -= row.share[lane] * dx;
      v -= row.share[lane] * dv;
      s.positions().set(at(k), x + dx);
      s.velocities().set(at(k), v + dv);
    }
    s.positions().set(0, x);
    s.velocities().set(0, v);
  }

  void copy_lane(std::size_t from, std::size_t to) override {
    attracted_.reset();
    for (SystemRow& row : run_.rows) copy_lane_of(row, from, to);
    copy_lane_of(run_.centers, from, to);
    copy_lane_of(run_.constants, from, to);
    for (Pack& m : run_.masses) m.lane[to] = m.lane[from];
    for (ChangeRow& row : run_.changes) copy_lane_of(row, from, to);
    for (ChangeCenter& center : run_.change_centers) copy_lane_of(center, from, to);
  }

  void show() override {
    show_changes();
    changes_go_along_ = false;
  }
  void go_on() override {
    now_ = &run_;
    changes_go_along_ = true;
  }
  void keep() override {
    prepare();
    kept_ = run_;
  }
  void go_back() override {
    run_ = kept_;
    attracted_.reset();
    failure_.reset();
  }

  void flow(char letter, double h, double time) override {
    prepare();
    if (letter == 'A') return drift(h);
    const SystemRows systems = rows();
    attract(systems, time);
    kernels_.kick(systems, h);
    if (!others_) return;  // inner forces leave the centres of mass alone
    for (int c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < lanes; ++k) add(now_->centers.v[c][k], now_->centers.v_low[c][k], center_[c][k]);
      for (std::ptrdiff_t j = 0; j < systems.changes.count; ++j) {
        ChangeCenter& center = systems.changes.center[j];
        for (std::size_t k = 0; k < lanes; ++k) center.v[c][k] += center.kick[c][k];
      }
    }
  }

  void carry(std::size_t changes) override {
    run_.changes.assign(changes * planets_, ChangeRow{});
    run_.change_centers.assign(changes, ChangeCenter{});
    slopes_.emplace(options_.others, like_);
    if (others_) u_ = VectorColumn<Pack>(like_.size());
  }
  void put_change(std::size_t lane, std::size_t change, const double* c) override {
    attracted_.reset();
    const auto n = static_cast<std::size_t>(like_.size());
    for (const bool speed : {false, true}) {
      const double* half = c + (speed ? 3 * n : 0);
      for (std::size_t k = 0; k < 3; ++k) {
        double whole = half[k * n];
        for (std::size_t j = 0; j < planets_; ++j) {
          ChangeRow& row = run_.changes[change * planets_ + j];
          const double d = half[k * n + static_cast<std::size_t>(at(j))] - whole;
          (speed ? row.v : row.x)[k][lane] = d;
          whole += run_.rows[j].share[lane] * d;
        }
        ChangeCenter& center = run_.change_centers[change];
        (speed ? center.v : center.x)[k][lane] = whole;
      }
    }
  }
  void scale_change(std::size_t lane, std::size_t change, double factor) override {
    attracted_.reset();
    const auto scale = [&](auto& of) {
      for (int c = 0; c < 3; ++c) of.x[c][lane] *= factor, of.v[c][lane] *= factor;
    };
    for (std::size_t j = 0; j < planets_; ++j) scale(run_.changes[change * planets_ + j]);
    scale(run_.change_centers[change]);
  }
  void measure(std::span<const LaneFlow> ahead, std::size_t change, double* squares) override {
    double arcs = 0, kick = 0;
    if (ahead.size() == 1) {
      prepare();
      (ahead[0].letter == 'A' ? arcs : kick) = ahead[0].h;
      if (kick != 0) {
        attract(rows(), ahead[0].time);
        attracted_ = time_of(ahead[0].time);  // it is what the next kick of the run begins with
      }
    } else if (!ahead.empty()) {
      show_changes();
      for (const LaneFlow& one : ahead) flow(one.letter, one.h, one.time);
    }
    kernels_.measure(rows(), static_cast<std::ptrdiff_t>(change), arcs, kick, squares);
    now_ = &run_;
  }
  void scale_velocities(double factor) override {
    const auto scale = [&](double(&lines)[3][8]) {
      for (auto& line : lines) {
        for (double& v : line) v *= factor;
      }
    };
    for (SystemRow& row : now_->rows) {
      scale(row.v);
      scale(row.v_low);
    }
    scale(now_->centers.v);
    scale(now_->centers.v_low);
  }
  const std::optional<Failure>& failure() const override { return failure_; }

 private:
  struct State {
    std::vector<SystemRow> rows;
    SystemCenters centers = {};
    SystemConstants constants = {};
    std::vector<Pack> masses;  ///< for other forces, in the order of the rows, the star first
    std::vector<ChangeRow> changes;
    std::vector<ChangeCenter> change_centers;
    double predicted_for = 0;  ///< the length of the arcs that the rows hold predictions for; 0: none
  };

  Index at(std::size_t planet) const { return static_cast<Index>(options_.order[planet + 1]); }

  SystemRows rows() {
    return {.row = now_->rows.data(),
            .count = static_cast<std::ptrdiff_t>(planets_),
            .star = now_->constants.star,
            .relativity = options_.light ? now_->constants.relativity : nullptr,
            .beside = others_ ? star_[0] : nullptr,
            .pull = pull_[0],
            .center = center_[0],
            .compensated = options_.compensated,
            .exact = exact_arc,
            .changes = {now_->changes.data(), now_->change_centers.data(),
                        changes_go_along_ ? std::ssize(now_->change_centers) : 0, exact_turn}};
  }
  void show_changes() {
    prepare();
    shown_ = run_;
    now_ = &shown_;
  }
  void prepare() {
    if (std::exchange(prepared_, true)) return;
    kernels_.prepare(rows());
  }

  double time_of(double time) const { return time_dependent_ ? time : 0; }
  void attract(const SystemRows& systems, double time) {
    if (now_ == &run_ && attracted_ && *attracted_ == time_of(time)) return;
    attracted_.reset();
    kernels_.place(systems);
    if (others_) add_others(time);
    kernels_.attract(systems);
  }
  void drift(double h) {
    if (now_ == &run_) attracted_.reset();
    const ArcReport report = kernels_.drift(rows(), {.h = h, .predicted = now_->predicted_for == h, .predict = true});
    now_->predicted_for = h;
    if (report.failed >= 0 && !failure_ && now_ == &run_) {
      failure_.emplace();
      failure_->quantity = "position";
      failure_->message = "the Kepler solver did not converge";
    }
    for (int c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < lanes; ++k) {
        add(now_->centers.x[c][k], now_->centers.x_low[c][k], h * now_->centers.v[c][k]);
      }
    }
  }
  void add(double& value, double& low, double change) const {
    if (!options_.compensated) {
      value += change;
      return;
    }
    const double d = change + low, sum = value + d, back = sum - value;
    low = (value - (sum - back)) + (d - back);
    value = sum;
  }

  /// Accelerations by other forces, of planets that have been placed.
  void add_others(double time) {
    const std::vector<SystemRow>& rows = now_->rows;
    VectorColumn<Pack>& x = inertial_.positions();
    for (int c = 0; c < 3; ++c) {
      Pack star = Pack::load(now_->centers.x[c]);
      for (const SystemRow& row : rows) star -= Pack::load(row.share) * Pack::load(row.x[c]);
      x.component(c)[0] = star;
      for (std::size_t k = 0; k < planets_; ++k) x.component(c)[at(k)] = star + Pack::load(rows[k].y[c]);
    }
    inertial_.masses()[0] = now_->masses[0];
    for (std::size_t k = 0; k < planets_; ++k) inertial_.masses()[at(k)] = now_->masses[k + 1];
    inertial_.clock().set_stage_offset(Pack(time));
    sum();
    for (int c = 0; c < 3; ++c) {
      a_.component(c)[0].store(star_[c]);
      for (std::size_t k = 0; k < planets_; ++k) a_.component(c)[at(k)].store(now_->rows[k].beside[c]);
    }
    for (std::size_t j = 0; changes_go_along_ && j < now_->change_centers.size(); ++j) add_others(j);
  }
  /// How they change along a change.
  void add_others(std::size_t change) {
    ChangeRow* const moved = now_->changes.data() + change * planets_;
    ChangeCenter& center = now_->change_centers[change];
    for (int c = 0; c < 3; ++c) {
      Pack star = Pack::load(center.x[c]);
      for (std::size_t k = 0; k < planets_; ++k) star -= Pack::load(now_->rows[k].share) * Pack::load(moved[k].x[c]);
      u_.component(c)[0] = star;
      for (std::size_t k = 0; k < planets_; ++k) u_.component(c)[at(k)] = star + Pack::load(moved[k].y[c]);
    }
    const VectorColumn<Pack>& a = slopes_->sum(0, inertial_, u_);
    for (int c = 0; c < 3; ++c) {
      a.component(c)[0].store(center.star[c]);
      for (std::size_t k = 0; k < planets_; ++k) a.component(c)[at(k)].store(moved[k].beside[c]);
    }
  }
  /// In all lanes at once, or where branches differ in one after the other, that lane in all eight.
  void sum() {
    try {
      return evaluate(inertial_, a_);
    } catch (const LanesDiffer&) {
    }
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      for (Index i = 0; i < inertial_.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
          one_.positions().component(c)[i] = Pack(std::as_const(inertial_).positions().component(c)[i].lane[lane]);
        }
        one_.masses()[i] = Pack(std::as_const(inertial_).masses()[i].lane[lane]);
      }
      one_.clock() = inertial_.clock();
      evaluate(one_, one_a_);
      for (int c = 0; c < 3; ++c) {
        for (Index i = 0; i < inertial_.size(); ++i) {
          a_.component(c)[i].lane[lane] = one_a_.component(c)[i].lane[0];
        }
      }
    }
  }
  void evaluate(const ParticleSystem<Pack>& s, VectorColumn<Pack>& a) {
    ForceSink<Pack> sink(a, s, {}, &workspace_);
    options_.others.add_to(sink, s);
    if (sink.failure() && !failure_ && now_ == &run_) failure_ = sink.failure();
  }

  PlanetSystemsOptions options_;
  const PlanetSystemKernels& kernels_;
  std::size_t planets_;
  ParticleSystem<double> like_;
  bool others_;
  State run_, shown_, kept_;
  State* now_ = &run_;
  bool prepared_ = false;
  alignas(64) double star_[3][8] = {};    ///< accelerations of the stars by other forces
  alignas(64) double pull_[3][8] = {};    ///< accelerations of the stars
  alignas(64) double center_[3][8] = {};  ///< what the last kick gives to the centres of mass
  ParticleSystem<Pack> inertial_, one_;   ///< for other forces
  VectorColumn<Pack> a_, one_a_, u_;
  std::optional<detail::LaneSlopes> slopes_;
  bool changes_go_along_ = true;
  bool time_dependent_;
  std::optional<double> attracted_;  ///< the time of which the accelerations of the run are known where it stands
  Workspace workspace_;
  std::optional<Failure> failure_;
};

}  // namespace

std::unique_ptr<SystemLanes> planet_systems(PlanetSystemsOptions options, const ParticleSystem<double>& like) {
  NOETHER_EXPECTS(options.order.size() >= 2, "there is a star and at least one planet");
  return std::make_unique<PlanetLanesOfSystems>(std::move(options), like);
}

}  // namespace noether
