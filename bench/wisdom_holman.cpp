/// Wisdom-Holman with the planets in lanes: nanoseconds per step, beside the same letter by letter and WHFast512,
/// WHFast and SABA(10,6,4) of `rebound` where Python has it (WHFast512 needs AVX-512); they are left out where they are
/// not.
///
/// Parts, of which arguments may name some: `steps`, the eight planets at 5 days (of ABA(10,6,4) at 40 days, where a
/// sub-step is a drift and a kick); `passes`, the share of drifts that needed a second pass, at steps of 1 to 40 days;
/// `outer`, ABA(10,6,4) of the outer planets; `tracers`, a thousand to a million of them among four giant planets.
///
/// Protocol: 9 rounds of every variant and every peer in turn, each over so many steps that it takes some 20 ms, after
/// one to warm up; medians of processor times. Tracers: 5 rounds of two million tracer-steps or more and 256 steps at
/// least, by the clock where there are several threads; the peer does a tenth of them.

#include "bench/peer_program.hpp"
#include "bench/support.hpp"

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/wisdom_holman.hpp"
#include "scene/scene.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <random>
#include <sstream>

using namespace noether;

namespace {

struct Variant {
  std::string name;
  AnyHamiltonian<double> hamiltonian;
  const Scheme* scheme;
  double step;
  CompositionOptions options = {};
  std::string peer = {};    ///< method of the other program that does the same
  bool relativity = false;  ///< as a potential, which the peer must have too
};

/// A field that pulls at nothing and keeps planets out of lanes.
const UniformField no_field{.acceleration = {0, 0, 0}};

template <class... Fs> AnyHamiltonian<double> splitting(Coordinates coordinates, Fs... forces) {
  ForceField<double> field;
  (field.add(std::move(forces)), ...);
  return WisdomHolmanOptions{.coordinates = coordinates}.split(std::move(field));
}

std::vector<Variant> variants() {
  const GrPotential bend{};
  constexpr Coordinates jacobi = Coordinates::jacobi, democratic = Coordinates::democratic;
  const Scheme &plain = schemes::verlet_aba, &fine = schemes::aba_10_6_4;
  const CompositionOptions compensated{.compensated = true};
  return {{"jacobi", splitting(jacobi), &plain, 5, {}, "whfast512"},
          {"jacobi, relativity", splitting(jacobi, bend), &plain, 5, {}, "whfast512", true},
          {"jacobi, compensated", splitting(jacobi), &plain, 5, compensated},
          {"democratic", splitting(democratic), &plain, 5},
          {"democratic, relativity", splitting(democratic, bend), &plain, 5},
          {"democratic, compensated", splitting(democratic), &plain, 5, compensated},
          {"jacobi, composed kernel", splitting(jacobi), &plain, 5, {.kernel = StepKernel::composed}},
          {"jacobi, lazy kernel", splitting(jacobi), &plain, 5, {.kernel = StepKernel::lazy}},
          {"jacobi, modified kernel", splitting(jacobi), &plain, 5, {.kernel = StepKernel::modified}},
          {"aba_10_6_4", splitting(jacobi), &fine, 40, {}, "saba(10,6,4)"},
          {"letters", splitting(jacobi, no_field), &plain, 5, {}, "whfast"},
          {"letters, compensated", splitting(jacobi, no_field), &plain, 5, compensated}};
}

/// Processor time of a step [ns].
double step_ns(Simulation<double>& run, std::int64_t steps) {
  const double seconds = bench::processor_seconds_of([&] {
    if (!run.run(steps).ok()) throw Error("a run failed");
  });
  return 1e9 * seconds / static_cast<double>(steps);
}

Json bodies_of(const ParticleSystem<double>& s) {
  std::vector<Json> bodies;
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> x = s.positions()[i], v = s.velocities()[i];
    bodies.push_back(Json::list({s.masses()[i], x[0], x[1], x[2], v[0], v[1], v[2]}));
  }
  return Json::list(bodies);
}

/// Seconds that the other program takes for so many steps; nothing where it cannot.
std::optional<double> peer_seconds(bench::PeerProgram& peer, const ParticleSystem<double>& s, const Variant& one,
                                   std::int64_t steps) {
  const auto answer = peer.ask(Json::object({{"G", s.units().G},
                                             {"method", one.peer},
                                             {"relativity", one.relativity},
                                             {"step", one.step},
                                             {"steps", steps},
                                             {"bodies", bodies_of(s)}})
                                   .text());
  std::istringstream words(answer.value_or(""));
  double seconds = 0;
  if (words >> seconds) return seconds;
  return {};
}

void measure(const bench::Rows& rows, const std::string& system, const ParticleSystem<double>& bodies,
             const std::vector<Variant>& all, bench::PeerProgram& peer) {
  constexpr int rounds = 9;
  std::map<std::string, std::vector<double>> ours, theirs;
  std::map<std::string, Simulation<double>> runs;
  for (const Variant& one : all) {
    runs.emplace(one.name,
                 Simulation<double>(
                     bodies, Composition<AnyHamiltonian<double>>(one.hamiltonian, *one.scheme, one.options), one.step));
  }
  for (int round = 0; round <= rounds; ++round) {
    for (const Variant& one : all) {
      const std::int64_t steps = one.scheme == &schemes::verlet_aba ? 100'000 : 12'000;
      const double took = step_ns(runs.at(one.name), steps);
      if (round == 0) continue;
      ours[one.name].push_back(took);
      if (one.peer.empty() || !peer.version()) continue;
      const auto seconds = peer_seconds(peer, bodies, one, steps);
      if (seconds) theirs[one.name].push_back(1e9 * *seconds / static_cast<double>(steps));
    }
  }
  for (const Variant& one : all) {
    std::optional<bench::Peer> beside;
    if (const auto found = theirs.find(one.name); found != theirs.end()) {
      beside = bench::Peer{"rebound " + one.peer, *peer.version(), bench::Measured(found->second).median};
    }
    rows.add(system + "/" + one.name, "step_ns", bench::Measured(ours[one.name]), "ns", bodies.size(), beside);
  }
}

void count_passes(const bench::Rows& rows, const ParticleSystem<double>& bodies) {
  constexpr std::int64_t steps = 100'000;
  for (const Coordinates coordinates : {Coordinates::jacobi, Coordinates::democratic}) {
    for (const double step : {1, 3, 5, 6, 7, 8, 10, 15, 20, 40}) {
      auto s = bodies;
      s.clock() = Clock<double>::fixed(0, step);
      Composition integrator(WisdomHolman({.coordinates = coordinates}), schemes::verlet_aba);
      integrator.bind(s);
      integrator.advance(s, {.steps = steps});
      const PlanetLanes& lanes = integrator.hamiltonian().lanes();
      const std::string name =
          fmt::format("{}, {} d", coordinates == Coordinates::jacobi ? "jacobi" : "democratic", step);
      const auto share = [&](std::int64_t count) {
        return bench::Measured({static_cast<double>(count) / static_cast<double>(steps)});
      };
      rows.add(name, "second_passes_per_step", share(lanes.second_passes()), "1", bodies.size());
      rows.add(name, "exact_arcs_per_step", share(lanes.exact_arcs()), "1", bodies.size());
    }
  }
}

/// The Sun and the giant planets, and tracers on orbits of 2 to 4 au, of which all but the last hundredth lie within
/// Jupiter's; those are beyond Neptune.
ParticleSystem<double> with_tracers(const ParticleSystem<double>& outer, Index tracers) {
  ParticleSystem<double> s(outer.units());
  for (Index i = 0; i < 5; ++i) s.add(outer.name(i), outer.masses()[i], outer.positions()[i], outer.velocities()[i]);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (Index k = 0; k < tracers; ++k) {
    const double r = (k < tracers - tracers / 100 ? 2 : 40) + 2 * uniform(random), angle = 6.283 * uniform(random);
    const double speed = std::sqrt(s.units().G * s.masses()[0] / r) * (0.9 + 0.15 * uniform(random));
    const double tilt = 0.2 * uniform(random);
    s.add(
        "tracer", 0, {r * std::cos(angle), r * std::sin(angle), 0},
        {-speed * std::sin(angle), speed * std::cos(angle) * std::cos(tilt), speed * std::cos(angle) * std::sin(tilt)});
  }
  return s;
}

/// Steps of tracers per second by their number and by threads.
void measure_tracers(const bench::Rows& rows, const ParticleSystem<double>& outer, bench::PeerProgram& peer) {
  constexpr int rounds = 5;
  const int threads = thread_count();
  const Variant plain{"tracers", splitting(Coordinates::jacobi), &schemes::verlet_aba, 120, {}, "whfast"};
  for (const Index tracers : {1'000, 10'000, 100'000, 1'000'000}) {
    const ParticleSystem<double> s = with_tracers(outer, tracers);
    const std::int64_t steps = std::max<std::int64_t>(256, 2'000'000 / tracers);
    const auto all = static_cast<double>(steps) * static_cast<double>(tracers);
    Simulation<double> run(s, Composition<AnyHamiltonian<double>>(plain.hamiltonian, *plain.scheme), plain.step);
    std::map<int, std::vector<double>> ours;
    std::vector<double> theirs;
    for (int round = 0; round <= rounds; ++round) {
      for (const int by : threads > 1 ? std::vector<int>{1, threads} : std::vector<int>{1}) {
        set_thread_count(by);
        const auto go = [&] {
          if (!run.run(steps).ok()) throw Error("a run failed");
        };
        const double seconds = by == 1 ? bench::processor_seconds_of(go) : bench::seconds_of(go);
        if (round > 0) ours[by].push_back(all / seconds);
      }
      if (round == 0 || tracers > 10'000 || !peer.version()) continue;
      const std::int64_t few = std::max<std::int64_t>(1, steps / 10);
      const auto seconds = peer_seconds(peer, s, plain, few);
      if (seconds) theirs.push_back(static_cast<double>(few) * static_cast<double>(tracers) / *seconds);
    }
    for (const auto& [by, rates] : ours) {
      std::optional<bench::Peer> beside;
      if (by == 1 && !theirs.empty()) {
        beside = bench::Peer{"rebound " + plain.peer, *peer.version(), bench::Measured(theirs).median};
      }
      rows.add(fmt::format("tracers/{}", by == 1 ? "one thread" : fmt::format("{} threads", by)), "tracer_steps_per_s",
               bench::Measured(rates), "1/s", tracers, beside);
    }
  }
  set_thread_count(1);
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("wisdom_holman", count, arguments, {"steps", "passes", "outer", "tracers"});
  const int threads = thread_count();
  set_thread_count(1);
  bench::PeerProgram peer("wisdom_holman.py");
  if (!peer.version()) fmt::print(stderr, "rebound is not installed: it is left out of the comparison\n");
  const std::filesystem::path examples = std::filesystem::path(NOETHER_SOURCE_DIR) / "examples";
  const ParticleSystem<double> planets = load_scene(examples / "solar_system" / "scene.toml").particles;
  if (rows.wants("steps")) measure(rows, "solar_system", planets, variants(), peer);
  if (rows.wants("passes")) count_passes(rows, planets);
  if (rows.wants("outer")) {
    const Scene outer = load_scene(examples / "outer_solar_system" / "scene.toml");
    std::vector<Variant> words;
    for (const double step : {200, 400, 800}) {
      for (const bool compensated : {false, true}) {
        words.push_back({fmt::format("{} d{}", step, compensated ? ", compensated" : ""),
                         splitting(Coordinates::jacobi),
                         &schemes::aba_10_6_4,
                         step,
                         {.compensated = compensated},
                         "saba(10,6,4)"});
      }
    }
    measure(rows, "outer", outer.particles, words, peer);
  }
  if (rows.wants("tracers")) {
    set_thread_count(threads);
    measure_tracers(rows, load_scene(examples / "outer_solar_system" / "scene.toml").particles, peer);
  }
}
