/// The reference methods, to rounding: seconds, largest energy error and position error at the end, beside IAS15 of
/// `rebound` and the Taylor method of `heyoka` (high accuracy) where Python has them; each is left out where it is not.
///
/// Cases, of which arguments may name some: `outer`, the outer planets over 10 000 years; `solar_system`, that of the
/// example over 200 years; `chain_of_7`, `triple` and `circumbinary`, those of tests/data/orbits: seven planets near
/// resonances, three stars, and a planet about two stars; `kepler_0.9` and `kepler_0.9999`, two bodies of that e over
/// 1000 turns and over 100.
///
/// Protocol: 16 rounds of every method and every peer in turn, each over a hundredth of the case to warm up and then
/// over all of it; medians of processor seconds of the run alone. Each round has its own start, for an error at
/// rounding level is one throw of dice: errors are medians over the starts. The first start is the case itself, of
/// which the others have each coordinate and each velocity multiplied by 1 + 1e-10 u with u from -1 to 1.
///
/// Positions are compared with what the same doubles lead to: two bodies by one Kepler arc in 113 bits, others by
/// `wide_gauss_8`, which is right to 1e-20 of a step, in steps of half the fixed ones, of a quarter where these would
/// be too long. All have so few digits that their sum is the end without rounding. Energies are looked at every 10
/// steps of each program's own, in the first 5 rounds, in a run beside the one that is timed.

#include "bench/peer_program.hpp"
#include "bench/support.hpp"

#include "forces/gravity.hpp"
#include "integrators/classical.hpp"
#include "integrators/kepler.hpp"
#include "monitors/monitors.hpp"
#include "scene/scene.hpp"

#include <filesystem>
#include <fstream>
#include <future>
#include <map>
#include <random>
#include <sstream>

using namespace noether;

namespace {

struct Case {
  std::string name;
  ParticleSystem<double> bodies;
  double G = 1, step = 0;
  int steps = 0;          ///< how often `step` goes into the case
  bool fixed = false;     ///< whether Gauss's method is sound with steps of that length
  double first_step = 0;  ///< a guess for methods that choose their own
  int exact_steps = 0;    ///< of `encke_gauss_8`; 0: no body dominates, or steps of one length are not sound

  double end() const { return steps * step; }
};

ParticleSystem<double> ellipse(double e) {
  ParticleSystem<double> s;
  s.add("sun", 1, {0, 0, 0}, {0, 0, 0});
  s.add("planet", 1e-3, {1 - e, 0, 0}, {0, std::sqrt((1 + e) / (1 - e) * 1.001), 0});
  move_to_barycenter(s);
  return s;
}

/// The first start of a file of tests/data/orbits, with steps of about a twelfth of the shortest period.
Case orbits(const std::string& name, bool fixed) {
  std::ifstream file(std::string(NOETHER_SOURCE_DIR) + "/tests/data/orbits/" + name + ".txt");
  std::string text;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with('#')) text += line + '\n';
  }
  std::istringstream in(text);
  Case one;
  one.name = name;
  one.fixed = fixed;
  double end = 0, end_of_body = 0;
  std::size_t bodies = 0;
  int measured_from = 0, starts = 0;
  in >> one.G >> end >> one.step >> bodies >> measured_from >> starts;
  std::vector<double> masses(bodies);
  for (double& mass : masses) in >> mass;
  for (const double mass : masses) {
    Vec3<double> x, v;
    for (int k = 0; k < 3; ++k) in >> x[k];
    for (int k = 0; k < 3; ++k) in >> v[k];
    for (int word = 0; word < 6; ++word) in >> end_of_body;
    one.bodies.add("body", mass, x, v);
  }
  if (!in) throw Error("tests/data/orbits has no '" + name + "'");
  one.steps = static_cast<int>(std::lround(end / one.step));
  one.first_step = one.step / 16;
  return one;
}

std::vector<Case> cases() {
  const std::filesystem::path examples = std::filesystem::path(NOETHER_SOURCE_DIR) / "examples";
  const Scene outer = load_scene(examples / "outer_solar_system" / "scene.toml");
  const Scene all = load_scene(examples / "solar_system" / "scene.toml");
  constexpr double turn = 6.283185307179586;
  return {{"outer", outer.particles, *outer.hamiltonian.G, 432, 8455, true, 10, 10146},
          {"solar_system", all.particles, all.particles.units().G, 5.484375, 13320, true, 1, 7696},
          orbits("chain_of_7", true),
          orbits("triple", false),
          orbits("circumbinary", false),
          {"kepler_0.9", ellipse(0.9), 1, turn, 1000, false, 1e-3},
          {"kepler_0.9999", ellipse(0.9999), 1, turn, 100, false, 1e-6}};
}

/// The case from another start.
Case moved(const Case& one, int start) {
  Case other = one;
  std::mt19937_64 random(static_cast<unsigned>(start));
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int k = 0; start > 0 && k < 3; ++k) {
    for (Index i = 0; i < one.bodies.size(); ++i) {
      other.bodies.positions().component(k)[i] *= 1 + 1e-10 * uniform(random);
      other.bodies.velocities().component(k)[i] *= 1 + 1e-10 * uniform(random);
    }
  }
  return other;
}

/// Gravity as a user may write it: for doubles only, one pair after the other.
struct ScalarGravity {
  double G;

  void add_to(ForceSink<double>& out, const ParticleSystem<double>& s) const {
    for (Index i = 0; i < s.size(); ++i) {
      for (Index j = 0; j < i; ++j) {
        const Vec3<double> d = s.positions()[i] - s.positions()[j];
        const double r2 = d.squaredNorm(), r = std::sqrt(r2), k = G / (r2 * r);
        out.acceleration(i, -k * s.masses()[j] * d);
        out.acceleration(j, k * s.masses()[i] * d);
        if (out.wants_energy()) out.energy(-G * s.masses()[i] * s.masses()[j] / r);
      }
    }
  }
};

/// Positions at the end, all relative to the first body.
using Positions = std::vector<double>;

template <class Real> Positions positions_of(const ParticleSystem<Real>& s) {
  Positions flat;
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<Real> x = s.positions()[i] - s.positions()[0];
    for (int k = 0; k < 3; ++k) flat.push_back(static_cast<double>(x[k]));
  }
  return flat;
}

/// Where the doubles of the case lead, as the protocol says.
Positions truth_of(const Case& one) {
  if (one.bodies.size() == 2) {
    const auto wide = one.bodies.as<Quad>();
    const Vec3<Quad> x = wide.positions()[1] - wide.positions()[0], v = wide.velocities()[1] - wide.velocities()[0];
    const Quad mu = Quad(one.G) * (wide.masses()[0] + wide.masses()[1]);
    const KeplerArc<Quad> arc = kepler_arc<Quad>(x, v, mu, Quad(one.end()));
    if (arc.status != KeplerStatus::converged) throw Error("the truth of '" + one.name + "' failed");
    const Vec3<Quad> end = x + arc.dx;
    return {0, 0, 0, static_cast<double>(end[0]), static_cast<double>(end[1]), static_cast<double>(end[2])};
  }
  const int finer = one.fixed ? 2 : 4;
  Simulation run(one.bodies, classical(Gravity{.G = one.G}, method("wide_gauss_8")), one.step / finer);
  if (!run.run(finer * one.steps).ok()) throw Error("the truth of '" + one.name + "' failed");
  return positions_of(run.particles());
}

double distance(const Positions& a, const Positions& b) {
  double worst = 0;
  for (std::size_t k = 0; k < a.size(); k += 3) {
    worst = std::max(worst, std::hypot(a[k] - b[k], a[k + 1] - b[k + 1], a[k + 2] - b[k + 2]));
  }
  return worst;
}

/// A method of ours on a case.
struct Entry {
  std::string name;
  MethodChoice choice;
  int steps = 0;        ///< of one length; 0: of the method's choice
  bool scalar = false;  ///< over `ScalarGravity`
};

Simulation<double> start(const Case& one, const Entry& entry) {
  const Classical<double> integrator =
      entry.scalar ? classical(ScalarGravity{one.G}, entry.choice) : classical(Gravity{.G = one.G}, entry.choice);
  return entry.steps > 0 ? Simulation(one.bodies, integrator, one.end() / entry.steps)
                         : Simulation(one.bodies, integrator);
}

/// Runs over 1 / `part` of the case.
void go(Simulation<double>& run, const Case& one, const Entry& entry, int part = 1) {
  const Outcome outcome = entry.steps > 0 ? run.run(entry.steps / part) : run.run_until(one.end() / part);
  if (!outcome.ok()) throw Error(entry.name + ": " + to_text(outcome));
}

/// The largest change of the energy, relative to that at the start, worked out in 113 bits: a sum in doubles would be
/// off by more than the methods.
class WideEnergy {
 public:
  explicit WideEnergy(double G) : G_(G) {}

  static constexpr auto describe() { return part<WideEnergy>("wide_energy", "energy errors below rounding"); }
  static Request wanted() { return {}; }
  void observe(const Snapshot<double>& now) {
    const ParticleSystem<double>& s = now.state();
    Quad energy(0);
    for (Index i = 0; i < s.size(); ++i) {
      energy += Quad(s.masses()[i]) * norm2(Vec3<Quad>(widened(s.velocities()[i]))) / Quad(2);
      for (Index j = 0; j < i; ++j) {
        const Vec3<Quad> d = widened(s.positions()[i]) - widened(s.positions()[j]);
        energy -= Quad(G_) * Quad(s.masses()[i]) * Quad(s.masses()[j]) / sqrt(norm2(d));
      }
    }
    if (now.step() == 0) first_ = energy;
    worst_ = std::max(worst_, std::abs(static_cast<double>((energy - first_) / first_)));
  }
  double worst() const { return worst_; }

 private:
  static Vec3<Quad> widened(const Vec3<double>& x) { return {Quad(x[0]), Quad(x[1]), Quad(x[2])}; }

  double G_;
  Quad first_ = Quad(0);
  double worst_ = 0;
};

double energy_error(const Case& one, const Entry& entry) {
  Simulation<double> run = start(one, entry);
  const auto& energy = run.every(10, WideEnergy(one.G));
  go(run, one, entry);
  return energy.worst();
}

/// What another program says of a case.
struct PeerRun {
  double seconds = 0, energy_error = 0;  ///< the latter of runs that were watched
  Positions positions;
};

PeerRun run_peer(bench::PeerProgram& peer, const Case& one, bool watched) {
  std::vector<Json> bodies;
  for (Index i = 0; i < one.bodies.size(); ++i) {
    const Vec3<double> x = one.bodies.positions()[i], v = one.bodies.velocities()[i];
    bodies.push_back(Json::list({one.bodies.masses()[i], x[0], x[1], x[2], v[0], v[1], v[2]}));
  }
  const auto answer = peer.ask(Json::object({{"G", one.G},
                                             {"end", one.end()},
                                             {"first_step", one.first_step},
                                             {"watched", watched},
                                             {"bodies", Json::list(bodies)}})
                                   .text());
  if (!answer) throw Error("another program failed on '" + one.name + "'");
  std::istringstream words(*answer);
  PeerRun run;
  words >> run.seconds >> run.energy_error;
  for (double x = 0; words >> x;) run.positions.push_back(x);
  for (std::size_t k = run.positions.size(); k-- > 3;) run.positions[k] -= run.positions[k % 3];
  for (std::size_t k = 0; k < 3; ++k) run.positions[k] = 0;
  return run;
}

/// Seconds of the rounds and where they ended, energy errors of those that were watched.
struct Rounds {
  std::vector<double> seconds, energies;
  std::vector<Positions> ends;

  void add(double took, Positions end) {
    seconds.push_back(took);
    ends.push_back(std::move(end));
  }
  bench::Measured errors(const std::vector<Positions>& truths) const {
    std::vector<double> all;
    for (std::size_t k = 0; k < ends.size(); ++k) all.push_back(distance(ends[k], truths[k]));
    return bench::Measured(all);
  }
};

using Peers = std::map<std::string, bench::PeerProgram>;

void measure(const bench::Rows& rows, const Case& one, Peers& peers) {
  constexpr int rounds = 16, watched_rounds = 5;
  std::vector<Entry> entries = {{"gauss_8", method("gauss_8")}, {"gauss_radau_15", method("gauss_radau_15")}};
  entries.push_back({.name = "gauss_8_scalar_force", .choice = method("gauss_8"), .scalar = true});
  if (one.fixed) {
    entries.push_back({.name = "gauss_8_fixed", .choice = method("gauss_8", {.adaptive = false}), .steps = one.steps});
  }
  if (one.exact_steps > 0) {
    entries.push_back({.name = "encke_gauss_8", .choice = method("encke_gauss_8"), .steps = one.exact_steps});
  }
  std::map<std::string, Rounds> ours, theirs;
  std::vector<std::future<Positions>> wanted;
  std::vector<Case> starts;
  for (int round = 0; round < rounds; ++round) {
    const Case& here = starts.emplace_back(moved(one, round));
    const bool watched = round < watched_rounds;
    for (const Entry& entry : entries) {
      Simulation<double> warm = start(here, entry), run = start(here, entry);
      go(warm, here, entry, 100);
      const double took = bench::processor_seconds_of([&] { go(run, here, entry); });
      ours[entry.name].add(took, positions_of(run.particles()));
      if (watched) ours[entry.name].energies.push_back(energy_error(here, entry));
    }
    for (auto& [peer, program] : peers) {
      const PeerRun run = run_peer(program, here, watched);
      theirs[peer].add(run.seconds, run.positions);
      if (watched) theirs[peer].energies.push_back(run.energy_error);
    }
  }
  for (const Case& here : starts) {
    wanted.push_back(std::async(std::launch::async, [&here] { return truth_of(here); }));
  }
  std::vector<Positions> truths;
  for (auto& truth : wanted) truths.push_back(truth.get());
  for (const Entry& entry : entries) {
    const std::string name = one.name + "/" + entry.name;
    const Rounds& run = ours[entry.name];
    const auto add = [&](const std::string& what, const bench::Measured& here, const std::string& unit, auto of_peer) {
      if (theirs.empty()) rows.add(name, what, here, unit, one.bodies.size());
      for (const auto& [peer, there] : theirs) {
        rows.add(name, what, here, unit, one.bodies.size(),
                 bench::Peer{peer, *peers.at(peer).version(), of_peer(there)});
      }
    };
    add("seconds", bench::Measured(run.seconds), "s",
        [](const Rounds& there) { return bench::Measured(there.seconds).median; });
    add("energy_error_max", bench::Measured(run.energies), "1",
        [](const Rounds& there) { return bench::Measured(there.energies).median; });
    add("position_error_end", run.errors(truths), "length",
        [&](const Rounds& there) { return there.errors(truths).median; });
  }
}

}  // namespace

int main(int count, char** arguments) {
  const std::vector<Case> all = cases();
  std::vector<std::string> names;
  for (const Case& one : all) names.push_back(one.name);
  const bench::Rows rows("reference", count, arguments, names);
  set_thread_count(1);
  Peers peers;
  for (const std::string peer : {"ias15", "heyoka"}) {
    bench::PeerProgram program("reference.py " + peer);
    if (program.version()) {
      peers.emplace(peer, std::move(program));
    } else {
      fmt::print(stderr, "{} is not installed: it is left out of the comparison\n", peer);
    }
  }
  for (const Case& one : all) {
    if (rows.wants(one.name)) measure(rows, one, peers);
  }
}
