/// Members of an ensemble, eight in the lanes of one run: nanoseconds per step and system, beside one system alone, and
/// beside WHFast512 of `rebound` where Python has it and the processor has AVX-512; and the same in lanes with MEGNO, a
/// small change that goes along and is measured at every step.
///
/// Protocol: 9 rounds of every variant, its system alone and the peer in turn, each over 50 000 steps (with one system
/// to a register 100 000), after one to warm up; medians of processor times. Planets: those of the Solar System, 5 days
/// a step, and the outer ones, 120 days; each lane begins a little elsewhere.

#include "bench/peer_program.hpp"
#include "bench/support.hpp"

#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/planet_systems.hpp"
#include "integrators/wisdom_holman.hpp"
#include "monitors/chaos.hpp"
#include "scene/scene.hpp"

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

/// The same with a small change of each.
class MegnoRun {
 public:
  explicit MegnoRun(const Variant& one) : run_(run_of(one)) {
    run_.carry(1);
    const auto numbers = 6 * static_cast<std::size_t>(one.bodies.size());
    for (std::size_t lane = 0; lane < SystemLanes::lanes; ++lane) {
      changes_.push_back(std::make_shared<LaneChange>());
      changes_.back()->begin(0, std::vector<double>(numbers, 1e-3));
      run_.follow(lane, 0, changes_.back());
    }
  }
  bool advance(std::int64_t steps) {
    constexpr std::int64_t look = 1000;
    for (std::int64_t made = 0; made < steps; made += look) {
      if (!run_.advance(look)) return false;
      for (std::size_t k = 0; k < changes_.size(); ++k)
        changes_[k]->tell([&](std::int64_t, double growth) { sums_[k].add(growth); });
    }
    return true;
  }

 private:
  SplittingLanes run_;
  std::vector<std::shared_ptr<LaneChange>> changes_;
  MegnoSums<double> sums_[SystemLanes::lanes];
};

void measure(const bench::Rows& rows, const Variant& one, bench::PeerProgram& peer) {
  constexpr int rounds = 9;
  constexpr std::int64_t steps = 50'000;
  constexpr auto systems = static_cast<double>(SystemLanes::lanes);
  SplittingLanes run = run_of(one);
  MegnoRun megno(one);
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
}
