/// The reference methods, to rounding: seconds, largest energy error and position error at the end, beside IAS15 of
/// `rebound` and the Taylor method of `heyoka` (high accuracy) where Python has them; each is left out where it is not.
///
/// Cases, of which arguments may name some: `outer`, the outer planets over 10 000 years; `solar_system`, that of the
/// example over 200 years; `kepler_0.9` and `kepler_0.9999`, two bodies of that e over 1000 turns and over 100.
///
/// Protocol: 5 rounds of every method and every peer in turn, each over a hundredth of the case to warm up and then
/// over all of it; medians of processor seconds of the run alone. Each round has its own start, 1e-9 aside of the one
/// before, for an error at rounding level is one throw of dice: errors are medians over the rounds. Positions are
/// compared with Gauss's 8 stages in 113 bits from the same doubles. Energies are looked at every 10 steps of each
/// program's own, in a run beside the one that is timed.

#include "bench/peer_program.hpp"
#include "bench/support.hpp"

#include "forces/gravity.hpp"
#include "integrators/classical.hpp"
#include "monitors/monitors.hpp"
#include "scene/scene.hpp"

#include <filesystem>
#include <future>
#include <map>
#include <sstream>

using namespace noether;

namespace {

struct Case {
  std::string name;
  ParticleSystem<double> bodies;
  double G, end, first_step;
  int fixed_steps;  ///< of Gauss with steps of one length; 0: such steps are of no use here
};

ParticleSystem<double> ellipse(double e) {
  ParticleSystem<double> s;
  s.add("sun", 1, {0, 0, 0}, {0, 0, 0});
  s.add("planet", 1e-3, {1 - e, 0, 0}, {0, std::sqrt((1 + e) / (1 - e) * 1.001), 0});
  move_to_barycenter(s);
  return s;
}

std::vector<Case> cases() {
  const std::filesystem::path examples = std::filesystem::path(NOETHER_SOURCE_DIR) / "examples";
  const Scene outer = load_scene(examples / "outer_solar_system" / "scene.toml");
  const Scene all = load_scene(examples / "solar_system" / "scene.toml");
  constexpr double day = 1, year = 365.25 * day, turn = 6.283185307179586;
  return {{"outer", outer.particles, *outer.hamiltonian.G, 1e4 * year, 10, 8455},
          {"solar_system", all.particles, all.particles.units().G, 200 * year, 1, 13320},
          {"kepler_0.9", ellipse(0.9), 1, 1000 * turn, 1e-3, 0},
          {"kepler_0.9999", ellipse(0.9999), 1, 100 * turn, 1e-6, 0}};
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

Positions truth_of(const Case& one) {
  auto field = std::make_unique<ForceMotion<Gravity, Quad>>(Gravity{.G = one.G});
  Simulation run(one.bodies.as<Quad>(), Classical<Quad>(std::move(field), method("gauss_8", {.rtol = 1e-22})));
  if (!run.run_until(one.end).ok()) throw Error("the truth of '" + one.name + "' failed");
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
  int steps;  ///< of one length; 0: of the method's choice
  bool scalar = false;
};

Simulation<double> start(const Case& one, const Entry& entry) {
  const Classical<double> integrator =
      entry.scalar ? classical(ScalarGravity{one.G}, entry.choice) : classical(Gravity{.G = one.G}, entry.choice);
  return entry.steps > 0 ? Simulation(one.bodies, integrator, one.end / entry.steps)
                         : Simulation(one.bodies, integrator);
}

/// Runs over 1 / `part` of the case.
void go(Simulation<double>& run, const Case& one, const Entry& entry, int part = 1) {
  const Outcome outcome = entry.steps > 0 ? run.run(entry.steps / part) : run.run_until(one.end / part);
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
  double seconds = 0, energy_error = 0;
  Positions positions;
};

PeerRun run_peer(bench::PeerProgram& peer, const Case& one) {
  std::vector<Json> bodies;
  for (Index i = 0; i < one.bodies.size(); ++i) {
    const Vec3<double> x = one.bodies.positions()[i], v = one.bodies.velocities()[i];
    bodies.push_back(Json::list({one.bodies.masses()[i], x[0], x[1], x[2], v[0], v[1], v[2]}));
  }
  const auto answer = peer.ask(
      Json::object({{"G", one.G}, {"end", one.end}, {"first_step", one.first_step}, {"bodies", Json::list(bodies)}})
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

/// Seconds of the rounds, and where they ended.
struct Rounds {
  std::vector<double> seconds, energies;
  std::vector<Positions> ends;

  void add(double took, double energy, Positions end) {
    seconds.push_back(took);
    energies.push_back(energy);
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
  constexpr int rounds = 5;
  std::vector<Entry> entries = {{"gauss_8", method("gauss_8"), 0}, {"gauss_radau_15", method("gauss_radau_15"), 0}};
  entries.push_back({"gauss_8_scalar_force", method("gauss_8"), 0, true});
  if (one.fixed_steps > 0) {
    entries.push_back({"gauss_8_fixed", method("gauss_8", {.adaptive = false}), one.fixed_steps});
  }
  std::map<std::string, Rounds> ours, theirs;
  std::vector<std::future<Positions>> wanted;
  std::vector<Case> starts;
  for (int round = 0; round < rounds; ++round) {
    Case& aside = starts.emplace_back(one);
    aside.bodies.positions().component(0)[1] *= 1 + 1e-9 * round;
    for (const Entry& entry : entries) {
      Simulation<double> warm = start(aside, entry), run = start(aside, entry);
      go(warm, aside, entry, 100);
      const double took = bench::processor_seconds_of([&] { go(run, aside, entry); });
      ours[entry.name].add(took, energy_error(aside, entry), positions_of(run.particles()));
    }
    for (auto& [peer, program] : peers) {
      const PeerRun run = run_peer(program, aside);
      theirs[peer].add(run.seconds, run.energy_error, run.positions);
    }
  }
  for (const Case& aside : starts) {
    wanted.push_back(std::async(std::launch::async, [&aside] { return truth_of(aside); }));
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
  const bench::Rows rows("reference", count, arguments, {"outer", "solar_system", "kepler_0.9", "kepler_0.9999"});
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
  for (const Case& one : cases()) {
    if (rows.wants(one.name)) measure(rows, one, peers);
  }
}
