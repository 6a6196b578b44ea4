/// What a step in a shearing sheet costs a particle: epicycles alone, in open space and in a box whose images slide,
/// and gravity through nine images, with spheres that touch too, beside REBOUND's SEI (bench/peers/sheet.py).
///
/// Protocol: seven rounds of noether and the peer in turn, one thread, medians of processor times by particles and
/// steps; and medians of pairs of wall times for what two threads gain. REBOUND sums directly over nine boxes, or uses
/// its tree with the opening angle 0.5 of its example, for contacts likewise; `peer_force_error` is the error of its
/// pulls then. Spheres are those of ice of 400 kg/m^3 at Saturn, in units of Omega and their radius, and elastic.

#include "bench/peer_program.hpp"
#include "bench/support.hpp"

#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/shearing_sheet.hpp"
#include "scene/ring_patch.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

using namespace noether;

namespace {

constexpr double edge = 100, softening = 0.5;

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

struct Case {
  std::string name;
  ParticleSystem<double> start;
  std::string peer_gravity;
  std::int64_t steps;
  double step = 0.05;
  double radius = 0;  ///< of elastic spheres; 0: points
};

/// Of so many steps; of none, the error of the peer's pulls.
std::optional<double> peer_seconds(bench::PeerProgram& peer, const Case& one, std::int64_t steps) {
  const ParticleSystem<double>& s = one.start;
  std::vector<Json> bodies;
  const bool boxed = s.box().is_periodic();
  const double wide = boxed ? s.box().edges()[0] : 0;
  for (Index i = 0; i < s.size(); ++i) {
    // Its box has the origin in the middle, where the same shear is that of other velocities.
    const Vec3<double> x = s.unwrapped(i) - Vec3<double>(wide / 2, wide / 2, 0), v = s.velocities()[i];
    bodies.push_back(Json::list({s.masses()[i], x[0], x[1], x[2], v[0], v[1] + 0.75 * wide, v[2]}));
  }
  const auto answer = peer.ask(Json::object({{"gravity", one.peer_gravity},
                                             {"Omega", 1.0},
                                             {"step", one.step},
                                             {"steps", steps},
                                             {"edges", boxed ? Json::list({wide, wide, edge}) : Json::list({})},
                                             {"softening", softening},
                                             {"radius", one.radius},
                                             {"bodies", Json::list(bodies)}})
                                   .text());
  if (!answer || *answer == "-") return {};
  return std::stod(*answer);
}

void measure(const bench::Rows& rows, bench::PeerProgram& peer, const Case& one) {
  const Index n = one.start.size();
  ForceField<double> forces;
  if (one.peer_gravity != "none") forces.add(Gravity{.G = 1, .softening = softening});
  AnyHamiltonian<double> sheet = ShearingSheet<ForceField<double>>(forces, {.Omega = 1});
  if (one.radius > 0) sheet = with_letter(HardSpheres{.restitution = 1}, sheet);
  auto integrator = compose(std::move(sheet), schemes::verlet_aba);
  ParticleSystem<double> s = one.start;
  s.clock() = Clock<double>::fixed(0, one.step);
  integrator.bind(s);
  const std::int64_t steps = one.steps;
  const auto many = [&] { integrator.advance(s, {.steps = steps}); };
  set_thread_count(1);
  many();
  const double particle_steps = static_cast<double>(n) * static_cast<double>(steps);
  std::vector<double> ours, theirs;
  for (int round = 0; round < 7; ++round) {
    ours.push_back(1e9 * bench::processor_seconds_of(many) / particle_steps);
    if (!peer.version()) continue;
    if (const auto seconds = peer_seconds(peer, one, steps)) theirs.push_back(1e9 * *seconds / particle_steps);
  }
  std::optional<bench::Peer> beside;
  if (!theirs.empty())
    beside = bench::Peer{"rebound sei, gravity " + one.peer_gravity, *peer.version(), bench::Measured(theirs).median};
  rows.add(one.name, "particle_step_ns", bench::Measured(ours), "ns", n, beside);
  rows.add(one.name, "times_as_quick_on_2", bench::times_as_quick(2, [&] { return bench::seconds_of(many); }), "1", n);
  if (one.peer_gravity != "tree" || !peer.version()) return;
  if (const auto error = peer_seconds(peer, one, 0))
    rows.add(one.name, "peer_force_error", bench::Measured(std::vector{*error}), "1", n);
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("sheet", count, arguments, {"free", "gravity", "spheres"});
  bench::PeerProgram peer("sheet.py");
  if (!peer.version()) fmt::print(stderr, "rebound is not installed: it is left out of the comparison\n");
  if (rows.wants("free")) {
    measure(rows, peer, {"free", ring(10'000, false, 0), "none", 2000});
    measure(rows, peer, {"free_in_box", ring(10'000, true, 0), "none", 1000});
  }
  if (rows.wants("gravity")) {
    measure(rows, peer, {"nine_images_1000", ring(1000, true, 1e-3), "basic", 20});
    measure(rows, peer, {"nine_images_1000_tree", ring(1000, true, 1e-3), "tree", 20});
  }
  if (rows.wants("spheres")) {
    for (const Index n : {1000, 10'000}) {
      const double wide = n == 1000 ? edge : 3 * edge;
      const RingPatch patch{.size = {wide, wide, edge}, .Omega = 1, .smallest = 1, .density = 1.5, .particles = n};
      const double orbits = n == 1000 ? 0.1 : 0.003;
      measure(rows, peer,
              {"spheres_" + std::to_string(n), patch.build(), "tree", std::llround(1000 * orbits),
               2e-3 * std::numbers::pi, 1});
    }
  }
}
