/// Wisdom-Holman with the planets in lanes: nanoseconds per step, beside the same letter by letter and WHFast512,
/// WHFast and SABA(10,6,4) of `rebound` where Python has it (WHFast512 needs AVX-512); they are left out where they are
/// not.
///
/// Parts, of which arguments may name some: `steps`, the eight planets at 5 days (of ABA(10,6,4) at 40 days, where a
/// sub-step is a drift and a kick); `passes`, how often an arc needed a second pass or the solver of single arcs, and
/// what a step takes there: the eight planets at 1 to 40 days; then equal planets, with steps of a twentieth of the
/// innermost period, by eccentricity (also with steps of a twentieth of a turn at pericentre), by number, and near each
/// other, by the distance of neighbouring orbits in mutual Hill radii;
/// `outer`, ABA(10,6,4) of the outer planets; `tracers`, a thousand to a million of them among four giant planets.
///
/// Protocol: 9 rounds of every variant and every peer in turn, each over so many steps that it takes some 20 ms, after
/// one to warm up; medians of processor times. Tracers: 5 rounds of two million tracer-steps or more and 256 steps at
/// least, by the clock where there are several threads; the peer does a tenth of them. Passes: 100 000 steps, those of
/// planets near each other from 20 starts; medians of 20 slices. A row of eight planets counts once for each pass.

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
  return {
      {"jacobi", splitting(jacobi), &plain, 5, {}, "whfast512"},
      {"jacobi, relativity", splitting(jacobi, bend), &plain, 5, {}, "whfast512", true},
      {"jacobi, compensated", splitting(jacobi), &plain, 5, compensated},
      {"democratic", splitting(democratic), &plain, 5},
      {"democratic, relativity", splitting(democratic, bend), &plain, 5},
      {"democratic, compensated", splitting(democratic), &plain, 5, compensated},
      {"jacobi, composed kernel", splitting(jacobi), &plain, 5, {.kernel = StepKernel::composed}, "whfast composition"},
      {"jacobi, lazy kernel", splitting(jacobi), &plain, 5, {.kernel = StepKernel::lazy}, "whfast lazy"},
      {"jacobi, modified kernel",
       splitting(jacobi),
       &plain,
       5,
       {.kernel = StepKernel::modified},
       "whfast modifiedkick"},
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

using Starts = std::vector<ParticleSystem<double>>;

/// How often arcs in lanes need more than one evaluation, and what a step takes there: 100 000 steps in all.
void count_passes(const bench::Rows& rows, const std::string& system, const Starts& starts, double step) {
  constexpr std::int64_t slices = 20, steps = 5'000;
  for (const Coordinates coordinates : {Coordinates::jacobi, Coordinates::democratic}) {
    std::int64_t second = 0, exact = 0;
    std::optional<double> closest;
    std::vector<double> taken;
    for (ParticleSystem<double> s : starts) {
      s.clock() = Clock<double>::fixed(0, step);
      Composition integrator(WisdomHolman({.coordinates = coordinates}), schemes::verlet_aba);
      integrator.bind(s);
      for (std::int64_t slice = 0; slice < slices / std::ssize(starts); ++slice) {
        const double seconds = bench::processor_seconds_of([&] {
          if (integrator.advance(s, {.steps = steps}).failure != nullptr) throw Error("'" + system + "' failed");
        });
        taken.push_back(1e9 * seconds / static_cast<double>(steps));
      }
      second += integrator.hamiltonian().lanes().second_passes();
      exact += integrator.hamiltonian().lanes().exact_arcs();
      const auto met = integrator.evaluations().encounter;
      if (met && met->hill_radii < closest.value_or(encounter_hill_radii)) closest = met->hill_radii;
    }
    const std::string name =
        fmt::format("{}, {}", coordinates == Coordinates::jacobi ? "jacobi" : "democratic", system);
    const auto add = [&](const std::string& metric, const bench::Measured& value, const std::string& unit) {
      rows.add(name, metric, value, unit, starts.front().size());
    };
    const auto share = [&](std::int64_t count) {
      return bench::Measured({static_cast<double>(count) / static_cast<double>(slices * steps)});
    };
    add("second_passes_per_step", share(second), "1");
    add("exact_arcs_per_step", share(exact), "1");
    add("step_ns", bench::Measured(taken), "ns");
    if (closest) add("closest_approach", bench::Measured({*closest}), "Hill radii");
  }
}

constexpr double turn = 6.283185307179586;

/// Planets of equal masses and eccentricities about a star, in units in which the innermost one turns once in 2 pi; the
/// axis of each is `ratio` times that of the one within. Phases, pericentres and inclinations up to 0.01 are random.
ParticleSystem<double> equal_planets(int planets, double mass, double ratio, double e, unsigned seed = 1) {
  ParticleSystem<double> s;
  s.add("star", 1, {0, 0, 0}, {0, 0, 0});
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  double a = 1;
  for (int k = 0; k < planets; ++k, a *= ratio) {
    const double E = turn * uniform(random), w = turn * uniform(random), tilt = 0.01 * uniform(random);
    const double rate = 1 / (std::sqrt(a) * (1 - e * std::cos(E))), flat = std::sqrt(1 - e * e);
    const auto turned = [&](double p, double q) {
      const double up = std::sin(w) * p + std::cos(w) * q;
      return Vec3<double>(std::cos(w) * p - std::sin(w) * q, up * std::cos(tilt), up * std::sin(tilt));
    };
    s.add("planet " + std::to_string(k), mass, turned(a * (std::cos(E) - e), a * flat * std::sin(E)),
          turned(-rate * std::sin(E), flat * rate * std::cos(E)));
  }
  move_to_barycenter(s);
  return s;
}

void count_all_passes(const bench::Rows& rows, const ParticleSystem<double>& solar_system) {
  for (const double days : {1, 3, 5, 6, 7, 8, 10, 15, 20, 40}) {
    count_passes(rows, fmt::format("{} d", days), {solar_system}, days);
  }
  constexpr double light = 1e-7, heavy = 1e-5, step = turn / 20;
  for (const double e : {0.05, 0.3, 0.6, 0.8, 0.95}) {
    const ParticleSystem<double> s = equal_planets(8, light, 1.5, e);
    count_passes(rows, fmt::format("e = {}", e), {s}, step);
    count_passes(rows, fmt::format("e = {}, by pericentre", e), {s}, step * std::sqrt(std::pow(1 - e, 3) / (1 + e)));
  }
  for (const int planets : {1, 2, 4, 8, 9, 16, 30}) {
    const std::string name = fmt::format("{} planet{}", planets, planets > 1 ? "s" : "");
    count_passes(rows, name, {equal_planets(planets, light, 1.3, 0.05)}, step);
  }
  for (const int planets : {2, 8}) {
    for (const double apart : {10, 6, 4, 3, 2, 1}) {
      Starts starts;
      for (unsigned seed = 1; seed <= 20; ++seed) {
        starts.push_back(equal_planets(planets, heavy, 1 + apart * std::cbrt(2 * heavy / 3), 0, seed));
      }
      count_passes(rows, fmt::format("{} planets, {} apart", planets, apart), starts, step);
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
  if (rows.wants("passes")) count_all_passes(rows, planets);
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
