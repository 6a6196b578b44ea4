/// What a step in a shearing sheet costs a particle: epicycles alone, in open space and in a box whose images slide,
/// and gravity through nine images, beside REBOUND's SEI (bench/peers/sheet.py).
///
/// Protocol: seven rounds of noether and the peer in turn, one thread, medians of processor times by particles and
/// steps; and medians of pairs of wall times for what two threads gain. REBOUND sums directly over nine boxes, or uses
/// its tree with the opening angle 0.5 of its example.

#include "bench/peer_program.hpp"
#include "bench/support.hpp"

#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/shearing_sheet.hpp"
#include "numbers/random.hpp"

#include <cmath>

using namespace noether;

namespace {

constexpr double edge = 100, softening = 0.5, step = 0.05;

/// Particles of a ring at random places, on the shear with small epicycles.
ParticleSystem<double> ring(Index n, bool boxed, double mass) {
  ParticleSystem<double> s(unit_system("reduced"));
  if (boxed) s.set_box(Box::periodic({edge, edge, edge}));
  const auto part = [](Index i, double rate) { return edge * std::fmod(rate * static_cast<double>(i + 1), 1.0); };
  for (Index i = 0; i < n; ++i) {
    const double k = static_cast<double>(i), x = part(i, 0.7548776662466927), y = part(i, 0.5698402909980532);
    s.add("", mass, {x, y, std::sin(k)},
          {0.3 * std::cos(1.7 * k), -1.5 * x + 0.1 * std::sin(2.3 * k), 0.2 * std::cos(k)});
  }
  return s;
}

std::optional<double> peer_seconds(bench::PeerProgram& peer, const ParticleSystem<double>& s,
                                   const std::string& gravity, std::int64_t steps) {
  std::vector<Json> bodies;
  const bool boxed = s.box().is_periodic();
  for (Index i = 0; i < s.size(); ++i) {
    // Its box has the origin in the middle, where the same shear is that of other velocities.
    const Vec3<double> x = s.unwrapped(i) - (boxed ? Vec3<double>(edge / 2, edge / 2, 0) : Vec3<double>(0, 0, 0)),
                       v = s.velocities()[i];
    bodies.push_back(Json::list({s.masses()[i], x[0], x[1], x[2], v[0], v[1] + (boxed ? 0.75 * edge : 0), v[2]}));
  }
  const auto answer = peer.ask(Json::object({{"gravity", gravity},
                                             {"Omega", 1.0},
                                             {"step", step},
                                             {"steps", steps},
                                             {"edges", boxed ? Json::list({edge, edge, edge}) : Json::list({})},
                                             {"softening", softening},
                                             {"bodies", Json::list(bodies)}})
                                   .text());
  if (!answer || *answer == "-") return {};
  return std::stod(*answer);
}

void measure(const bench::Rows& rows, bench::PeerProgram& peer, const std::string& name, Index n, bool boxed,
             const std::string& peer_gravity, std::int64_t steps) {
  const bool pulls = peer_gravity != "none";
  const ParticleSystem<double> start = ring(n, boxed, pulls ? 1e-3 : 0);
  ForceField<double> forces;
  if (pulls) forces.add(Gravity{.G = 1, .softening = softening});
  auto integrator = compose(ShearingSheet<ForceField<double>>(forces, {.Omega = 1}), schemes::verlet_aba);
  ParticleSystem<double> s = start;
  s.clock() = Clock<double>::fixed(0, step);
  integrator.bind(s);
  const auto many = [&] { integrator.advance(s, {.steps = steps}); };
  set_thread_count(1);
  many();
  const double particle_steps = static_cast<double>(n) * static_cast<double>(steps);
  std::vector<double> ours, theirs;
  for (int round = 0; round < 7; ++round) {
    ours.push_back(1e9 * bench::processor_seconds_of(many) / particle_steps);
    if (!peer.version()) continue;
    if (const auto seconds = peer_seconds(peer, start, peer_gravity, steps))
      theirs.push_back(1e9 * *seconds / particle_steps);
  }
  std::optional<bench::Peer> beside;
  if (!theirs.empty())
    beside = bench::Peer{"rebound sei, gravity " + peer_gravity, *peer.version(), bench::Measured(theirs).median};
  rows.add(name, "particle_step_ns", bench::Measured(ours), "ns", n, beside);
  rows.add(name, "times_as_quick_on_2", bench::times_as_quick(2, [&] { return bench::seconds_of(many); }), "1", n);
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("sheet", count, arguments, {"free", "gravity"});
  bench::PeerProgram peer("sheet.py");
  if (!peer.version()) fmt::print(stderr, "rebound is not installed: it is left out of the comparison\n");
  if (rows.wants("free")) {
    measure(rows, peer, "free", 10'000, false, "none", 2000);
    measure(rows, peer, "free_in_box", 10'000, true, "none", 1000);
  }
  if (rows.wants("gravity")) {
    measure(rows, peer, "nine_images_1000", 1000, true, "basic", 20);
    measure(rows, peer, "nine_images_1000_tree", 1000, true, "tree", 20);
  }
}
