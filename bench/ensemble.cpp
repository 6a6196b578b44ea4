/// Members of an ensemble, eight in the lanes of one run: nanoseconds per step and system, beside one system alone, and
/// beside WHFast512 of `rebound` where Python has it and the processor has AVX-512; and the same in lanes with MEGNO, a
/// small change that goes along and is measured at every step. Then the outer planets for 1000 years: microseconds of a
/// system, and the largest error of three systems against 113 bits, beside batches of eight by `heyoka`, at the loosest
/// of its tolerances whose error is no larger, or the tightest, where Python has it; and with MEGNO in lanes.
///
/// Protocol: 9 rounds of every variant, its system alone and the peer in turn, each over 50 000 steps (with one system
/// to a register 100 000), after one to warm up; medians of processor times. Planets: those of the Solar System, 5 days
/// a step, and the outer ones, 120 days; each lane begins a little elsewhere. Orbits: 5 rounds, ours, a system alone
/// and the peer in turn, after one to warm up.

#include "bench/peer_program.hpp"
#include "bench/support.hpp"

#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/lane_method.hpp"
#include "integrators/planet_systems.hpp"
#include "integrators/wisdom_holman.hpp"
#include "monitors/chaos.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <sstream>

using namespace noether;

namespace {

constexpr double light = 173.144632674240;  ///< [au/day]

struct Variant {
  std::string name;
  ParticleSystem<double> bodies;
  double step;
  const Scheme* scheme;
  std::function<std::unique_ptr<SystemLanes>(const ParticleSystem<double>&)> lanes;
  AnyHamiltonian<double> alone;
  CompositionOptions options = {};
  std::string peer = {};
  bool relativity = false;
};

std::vector<std::int64_t> order_of(const ParticleSystem<double>& bodies) {
  ParticleSystem<double> s = bodies;
  WisdomHolman<double> probe(WisdomHolmanOptions{});
  probe.bind(s);
  return probe.order();
}

Variant planets(const std::string& name, const ParticleSystem<double>& bodies, double step, bool relativity,
                const CompositionOptions& options = {}) {
  const auto lanes = [=](const ParticleSystem<double>& like) {
    PlanetSystemsOptions made{.G = like.units().G,
                              .order = order_of(like),
                              .light = {},
                              .G_of_light = like.units().G,
                              .others = {},
                              .compensated = options.compensated};
    if (relativity) made.light = light;
    return planet_systems(std::move(made), like);
  };
  ForceField<double> forces;
  if (relativity) forces.add(GrPotential{});
  return {name,    bodies,      step,      &schemes::verlet_aba, lanes, WisdomHolmanOptions{}.split(std::move(forces)),
          options, "whfast512", relativity};
}

Variant leapfrog(const ParticleSystem<double>& bodies, double step) {
  const auto lanes = [](const ParticleSystem<double>& like) {
    return systems_under_forces(ForceField<double>().add(Gravity{}), like, false);
  };
  return {"leapfrog", bodies, step, &schemes::verlet, lanes, KineticPotential(Gravity{}), {}, {}, false};
}

std::optional<double> peer_ns(bench::PeerProgram& peer, const Variant& one, std::int64_t steps) {
  std::vector<Json> bodies;
  for (Index i = 0; i < one.bodies.size(); ++i) {
    const Vec3<double> x = one.bodies.positions()[i], v = one.bodies.velocities()[i];
    bodies.push_back(Json::list({one.bodies.masses()[i], x[0], x[1], x[2], v[0], v[1], v[2]}));
  }
  const auto answer = peer.ask(Json::object({{"G", one.bodies.units().G},
                                             {"method", one.peer},
                                             {"relativity", one.relativity},
                                             {"step", one.step},
                                             {"steps", steps},
                                             {"bodies", Json::list(bodies)}})
                                   .text());
  std::istringstream words(answer.value_or(""));
  double seconds = 0;
  if (words >> seconds) return 1e9 * seconds / static_cast<double>(steps);
  return {};
}

/// Eight systems that begin a little elsewhere.
SplittingLanes run_of(const Variant& one) {
  SplittingLanes run(one.lanes(one.bodies), *one.scheme, one.options, Clock<double>::fixed(0, one.step));
  for (std::size_t lane = 0; lane < SystemLanes::lanes; ++lane) {
    ParticleSystem<double> s = one.bodies;
    s.positions().all() *= 1 + 1e-6 * static_cast<double>(lane);
    run.put(lane, s);
  }
  return run;
}

/// A run with a small change of each system.
class MegnoRun {
 public:
  /// @param run  that has not begun, of so many bodies a system
  MegnoRun(LaneRun& run, Index bodies) : run_(run) {
    run_.carry(1);
    const auto numbers = 6 * static_cast<std::size_t>(bodies);
    for (std::size_t lane = 0; lane < SystemLanes::lanes; ++lane) {
      changes_.push_back(std::make_shared<LaneChange>());
      changes_.back()->begin(0, std::vector<double>(numbers, 1e-3));
      run_.follow(lane, 0, changes_.back());
    }
  }
  bool advance(std::int64_t steps) {
    constexpr std::int64_t look = 1000;
    for (std::int64_t made = 0; made < steps; made += look) {
      if (!run_.advance(std::min(look, steps - made))) return false;
      for (std::size_t k = 0; k < changes_.size(); ++k)
        changes_[k]->tell([&](std::int64_t, double growth) { sums_[k].add(growth); });
    }
    return true;
  }

 private:
  LaneRun& run_;
  std::vector<std::shared_ptr<LaneChange>> changes_;
  MegnoSums<double> sums_[SystemLanes::lanes];
};

void measure(const bench::Rows& rows, const Variant& one, bench::PeerProgram& peer) {
  constexpr int rounds = 9;
  constexpr std::int64_t steps = 50'000;
  constexpr auto systems = static_cast<double>(SystemLanes::lanes);
  SplittingLanes run = run_of(one), with_changes = run_of(one);
  MegnoRun megno(with_changes, one.bodies.size());
  Simulation<double> alone(one.bodies, Composition<AnyHamiltonian<double>>(one.alone, *one.scheme, one.options),
                           one.step);
  std::vector<double> in_lanes, with_megno, times, by_itself, theirs;
  for (int round = 0; round <= rounds; ++round) {
    const double seconds = bench::processor_seconds_of([&] {
      if (!run.advance(steps)) throw Error("a run failed");
    });
    const double beside = bench::processor_seconds_of([&] {
      if (!megno.advance(steps)) throw Error("a run failed");
    });
    const double single = bench::processor_seconds_of([&] {
      if (!alone.run(steps).ok()) throw Error("a run failed");
    });
    if (round == 0) continue;
    in_lanes.push_back(1e9 * seconds / (static_cast<double>(steps) * systems));
    with_megno.push_back(1e9 * beside / (static_cast<double>(steps) * systems));
    times.push_back(beside / seconds);
    by_itself.push_back(1e9 * single / static_cast<double>(steps));
    if (one.peer.empty() || !peer.version()) continue;
    if (const auto took = peer_ns(peer, one, 2 * steps)) theirs.push_back(*took);
  }
  std::optional<bench::Peer> beside;
  if (!theirs.empty()) beside = bench::Peer{"rebound " + one.peer, *peer.version(), bench::Measured(theirs).median};
  rows.add(one.name + "/lanes", "system_step_ns", bench::Measured(in_lanes), "ns", one.bodies.size(), beside);
  rows.add(one.name + "/lanes, megno", "system_step_ns", bench::Measured(with_megno), "ns", one.bodies.size());
  rows.add(one.name + "/lanes, megno over plain", "ratio", bench::Measured(times), "1", one.bodies.size());
  rows.add(one.name + "/alone", "system_step_ns", bench::Measured(by_itself), "ns", one.bodies.size(), beside);
}

/// Eight starts, and where three of them end.
struct Orbits {
  std::vector<ParticleSystem<double>> starts;
  double until;
  std::vector<std::size_t> checked = {0, 3, 7};
  std::vector<ParticleSystem<Quad>> ends = {};

  Orbits(const ParticleSystem<double>& bodies, double end) : until(end) {
    for (std::size_t lane = 0; lane < LaneRun::lanes; ++lane) {
      starts.push_back(bodies);
      starts.back().positions().all() *= 1 + 1e-6 * static_cast<double>(lane);
    }
    constexpr std::int64_t steps = 2000;
    for (const std::size_t lane : checked) {
      ForceField<Quad> forces;
      forces.add(AnyForce<Quad>(Gravity{}));
      Simulation<Quad> run(starts[lane].as<Quad>(),
                           Classical<Quad>(std::make_unique<ForceMotion<ForceField<Quad>, Quad>>(std::move(forces)),
                                           method("gauss_8", {.adaptive = false})),
                           until / static_cast<double>(steps));
      if (!run.run(steps).ok()) throw Error("the reference failed");
      ends.push_back(run.particles());
    }
  }
  /// @param place  of a body of a system
  template <class Place> double error(const Place& place) const {
    double worst = 0;
    for (std::size_t k = 0; k < checked.size(); ++k) {
      for (Index i = 1; i < ends[k].size(); ++i) {
        Vec3<double> there;
        for (int c = 0; c < 3; ++c) there[c] = static_cast<double>(ends[k].positions()[i][c]);
        worst = std::max(worst, (place(checked[k], i) - there).norm() / there.norm());
      }
    }
    return worst;
  }
};

struct BatchRun {
  double seconds = 0, error = 0;
};

std::optional<BatchRun> heyoka_run(bench::PeerProgram& peer, const Orbits& orbits, double tolerance) {
  const ParticleSystem<double>& first = orbits.starts[0];
  std::vector<Json> states;
  for (const ParticleSystem<double>& one : orbits.starts) {
    std::vector<double> state;
    for (Index i = 0; i < one.size(); ++i) {
      const Vec3<double> x = one.positions()[i], v = one.velocities()[i];
      state.insert(state.end(), {x[0], x[1], x[2], v[0], v[1], v[2]});
    }
    states.push_back(Json::list_of(state));
  }
  const auto answer = peer.ask(
      Json::object({{"G", first.units().G},
                    {"masses", Json::list_of(std::vector<double>(first.masses().begin(), first.masses().end()))},
                    {"states", Json::list(states)},
                    {"until", orbits.until},
                    {"tolerance", tolerance}})
          .text());
  std::istringstream words(answer.value_or(""));
  BatchRun run;
  if (!(words >> run.seconds)) return {};
  std::vector<double> ends;
  for (double x = 0; words >> x;) ends.push_back(x);
  run.error = orbits.error([&](std::size_t lane, Index i) {
    const std::size_t at = 6 * (lane * static_cast<std::size_t>(first.size()) + static_cast<std::size_t>(i));
    return Vec3<double>(ends.at(at), ends.at(at + 1), ends.at(at + 2));
  });
  return run;
}

/// The loosest tolerance at which heyoka's error is no larger, or the tightest.
std::optional<double> tolerance_of(bench::PeerProgram& peer, const Orbits& orbits, double error) {
  static std::vector<std::pair<double, double>> known;  // tolerance, error
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 0x1p-52}) {
    if (!known.empty() && known.back().first <= tolerance) continue;
    if (!known.empty() && known.back().second <= error) break;
    if (const auto run = heyoka_run(peer, orbits, tolerance)) known.emplace_back(tolerance, run->error);
  }
  for (const auto& [tolerance, its_error] : known) {
    if (its_error <= error) return tolerance;
  }
  if (known.empty()) return {};
  return known.back().first;
}

struct Stepped {
  std::string name;
  std::int64_t steps;
  std::function<std::unique_ptr<LaneRun>(const ParticleSystem<double>&, const Clock<double>&)> lanes;
  AnyIntegrator<double> alone;
  bool takes_changes;  ///< whether changes of a state go along
};

Stepped stepped(const std::string& name, std::int64_t steps) {
  const MethodInfo* info = methods::find(name);
  const MethodChoice choice = method(name, {.adaptive = info->adaptive ? std::optional(false) : std::nullopt});
  return {name, steps,
          [choice](const ParticleSystem<double>& like, const Clock<double>& clock) {
            return run_in_lanes(method_in_lanes(choice), ForceField<double>().add(Gravity{}), like, clock);
          },
          classical(KineticPotential(ForceField<double>().add(Gravity{})), choice), info->family != "multistep"};
}

Stepped split(const std::string& name, const Scheme& scheme, std::int64_t steps) {
  const auto lanes = [&scheme](const ParticleSystem<double>& like, const Clock<double>& clock) {
    return std::make_unique<SplittingLanes>(systems_under_forces(ForceField<double>().add(Gravity{}), like, false),
                                            scheme, CompositionOptions{}, clock);
  };
  return {name, steps, lanes, compose(KineticPotential(Gravity{}), scheme), true};
}

void measure(const bench::Rows& rows, const Orbits& orbits, const Stepped& one, bench::PeerProgram& peer) {
  constexpr int rounds = 5;
  const double step = orbits.until / static_cast<double>(one.steps);
  const Index bodies = orbits.starts[0].size();
  std::vector<double> in_lanes, times, alone, theirs, their_errors;
  double error = 0;
  std::optional<double> tolerance;
  for (int round = 0; round <= rounds; ++round) {
    const auto begin = [&] {
      auto run = one.lanes(orbits.starts[0], Clock<double>::fixed(0, step));
      for (std::size_t lane = 0; lane < LaneRun::lanes; ++lane) run->put(lane, orbits.starts[lane]);
      return run;
    };
    const auto run = begin(), with_changes = begin();
    std::optional<MegnoRun> megno;
    if (one.takes_changes) megno.emplace(*with_changes, bodies);
    const double seconds = bench::processor_seconds_of([&] {
      if (!run->advance(one.steps)) throw Error("a run failed");
    });
    const double with_megno = bench::processor_seconds_of([&] {
      if (megno && !megno->advance(one.steps)) throw Error("a run failed");
    });
    run->settle();
    std::vector<ParticleSystem<double>> ends = orbits.starts;
    for (std::size_t lane = 0; lane < LaneRun::lanes; ++lane) run->take(lane, ends[lane]);
    error = orbits.error([&](std::size_t lane, Index i) { return ends[lane].positions()[i]; });
    Simulation<double> single(orbits.starts[0], one.alone, step);
    const double by_itself = bench::processor_seconds_of([&] {
      if (!single.run(one.steps).ok()) throw Error("a run failed");
    });
    if (round == 0 && peer.version()) tolerance = tolerance_of(peer, orbits, error);
    if (round > 0) {
      in_lanes.push_back(1e6 * seconds / LaneRun::lanes);
      if (megno) times.push_back(with_megno / seconds);
      alone.push_back(1e6 * by_itself);
    }
    if (!tolerance) continue;
    if (const auto other = heyoka_run(peer, orbits, *tolerance); other && round > 0) {
      theirs.push_back(1e6 * other->seconds / LaneRun::lanes);
      their_errors.push_back(other->error);
    }
  }
  std::optional<bench::Peer> beside, beside_error;
  if (!theirs.empty()) {
    const std::string name = fmt::format("heyoka at {:.1g}, eight to a batch", *tolerance);
    beside = bench::Peer{name, *peer.version(), bench::Measured(theirs).median};
    beside_error = bench::Peer{name, *peer.version(), bench::Measured(their_errors).median};
  }
  const std::string name = fmt::format("1000 years, {} by {:.4g} days", one.name, step);
  rows.add(name + "/lanes", "system_us", bench::Measured(in_lanes), "us", bodies, beside);
  if (one.takes_changes) rows.add(name + "/lanes, megno over plain", "ratio", bench::Measured(times), "1", bodies);
  rows.add(name + "/alone", "system_us", bench::Measured(alone), "us", bodies);
  rows.add(name + "/lanes", "error", bench::Measured({error}), "1", bodies, beside_error);
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("ensemble", count, arguments);
  set_thread_count(1);
  bench::PeerProgram peer("wisdom_holman.py");
  if (!peer.version()) fmt::print(stderr, "rebound is not installed: it is left out of the comparison\n");
  const std::filesystem::path examples = std::filesystem::path(NOETHER_SOURCE_DIR) / "examples";
  const ParticleSystem<double> all = load_scene(examples / "solar_system" / "scene.toml").particles;
  ParticleSystem<double> outer(all.units());
  for (const Index i : {0, 5, 6, 7, 8})
    outer.add(all.name(i), all.masses()[i], all.positions()[i], all.velocities()[i]);
  measure(rows, planets("eight planets", all, 5, false), peer);
  measure(rows, planets("eight planets, relativity", all, 5, true), peer);
  measure(rows, planets("eight planets, compensated", all, 5, false, {.compensated = true}), peer);
  measure(rows, planets("four planets", outer, 120, false), peer);
  measure(rows, leapfrog(outer, 20), peer);
  bench::PeerProgram batches("heyoka_batch.py");
  if (!batches.version()) fmt::print(stderr, "heyoka is not installed: it is left out of the comparison\n");
  const Orbits orbits(outer, 365250);
  measure(rows, orbits, split("leapfrog", schemes::verlet, 36525), batches);
  for (const auto& [name, steps] : std::vector<std::pair<std::string, std::int64_t>>{{"rk4", 7305},
                                                                                     {"dprkn_12", 1217},
                                                                                     {"stormer_cowell_12", 18262},
                                                                                     {"adams_bashforth_4", 18262},
                                                                                     {"gauss_2", 7305},
                                                                                     {"gauss_4", 2435},
                                                                                     {"gauss_6", 1217}})
    measure(rows, orbits, stepped(name, steps), batches);
}
