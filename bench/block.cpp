/// What a body that deforms costs: nanoseconds per tetrahedron and step, and what part of the bandwidth of memory it
/// takes.
///
/// A block of 32^3 cells, 196 608 tetrahedra and 35 937 particles, of Saint-Venant and Kirchhoff, by `verlet`.
/// `copy_bandwidth` is that of a loop that copies 128 MB, bytes read and written together, on as many threads;
/// `part_of_copy` is what a step moves at least, `bytes_per_tetrahedron`, over what such a copy moves in its time:
///
///     the shape 80, the corners 16, the forces written and read 192, their places 16: 304 for each tetrahedron
///     positions read by elements 24, drift 72, kick 72, accelerations 72, the mass and its places 16: 256 for each
///     particle
///
/// Protocol: 15 slices of 4 steps and of 4 copies, in turn; medians of processor times, with two threads of the clock.
/// `two_threads` is how many times as quick two threads are as one, by the clock.
///
/// `equal_error`: a soft block of 4^3 cells tumbles for 4 units of time; what `simo_tarnow_wong`, `implicit_midpoint`,
/// `newmark` and `verlet` take for it where each has the steps with which its places end 0.01 off, known from
/// `srkn14a`. Medians of 7 runs in turn. `stiff_step`: a step of the bent bar of tests/methods/deforming_block_test.cpp
/// at h omega = 16.

#include "bench/support.hpp"

#include "forces/hyperelastic.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "scene/block.hpp"

using namespace noether;

namespace {

constexpr int steps_of_slice = 4, slices = 15;
constexpr double bytes_of_tetrahedron = 304, bytes_of_particle = 256;

class Run {
 public:
  explicit Run(const HyperelasticForce& force)
      : particles_(
            Block{.cells = {32, 32, 32}, .size = {1, 1, 1}, .density = 1, .stretch = {1.02, 0.99, 1.01}}.build()),
        integrator_(KineticPotential(force), *schemes::find("verlet")) {
    particles_.clock() = Clock<double>::fixed(0, 0.002);
    integrator_.bind(particles_);
    step();
  }
  void step() { static_cast<void>(integrator_.advance(particles_, {.steps = steps_of_slice})); }
  Index particles() const { return particles_.size(); }
  Index elements() const { return static_cast<Index>(particles_.topology()->mesh->tetrahedra.size()); }
  double checksum() const { return particles_.positions()[particles() / 3][0]; }

 private:
  ParticleSystem<double> particles_;
  Composition<KineticPotential<HyperelasticForce>> integrator_;
};

/// Copies numbers of one array to another.
class Copy {
 public:
  Copy() : from_(std::size_t{1} << 23U, 1.0), to_(from_.size(), 0.0) {}
  void operator()() {
    for (int k = 0; k < steps_of_slice; ++k) {
      for_blocks(static_cast<Index>(from_.size() / chunk), [&](Index begin, Index end) {
        std::copy(from_.begin() + begin * chunk, from_.begin() + end * chunk, to_.begin() + begin * chunk);
      });
      from_[0] += to_[1];
    }
  }
  double bytes() const { return 16.0 * steps_of_slice * static_cast<double>(from_.size()); }

 private:
  static constexpr Index chunk = 64;
  std::vector<double> from_, to_;
};

void measure(const bench::Rows& rows, const std::string& name, const HyperelasticForce& force, Copy& copy) {
  Run run(force);
  const double elements = static_cast<double>(run.elements());
  const double bytes = bytes_of_tetrahedron + bytes_of_particle * static_cast<double>(run.particles()) / elements;
  std::vector<double> cost, bandwidth, part;
  for (int k = 0; k < slices; ++k) {
    const double seconds = bench::processor_seconds_of([&] { run.step(); });
    const double copied = copy.bytes() / bench::processor_seconds_of([&] { copy(); });
    cost.push_back(1e9 * seconds / (steps_of_slice * elements));
    bandwidth.push_back(1e-9 * copied);
    part.push_back(bytes * steps_of_slice * elements / seconds / copied);
  }
  rows.add(name, "cost", bench::Measured(cost), "ns/tetrahedron/step", run.elements());
  rows.add(name, "bytes_per_tetrahedron", bench::Measured({bytes}), "bytes", run.elements());
  rows.add(name, "copy_bandwidth", bench::Measured(bandwidth), "GB/s", run.elements());
  rows.add(name, "part_of_copy", bench::Measured(part), "1", run.elements());
  const auto by_clock = [&] { return bench::seconds_of([&] { run.step(); }); };
  rows.add(name, "two_threads", bench::times_as_quick(2, by_clock), "times", run.elements());
}

constexpr double duration = 4, wanted_error = 0.01;

/// Where the corners of a block end that goes on by steps of duration / steps.
template <class I> ParticleSystem<double> end_of(I integrator, ParticleSystem<double> s, std::int64_t steps) {
  s.clock() = Clock<double>::fixed(0, duration / static_cast<double>(steps));
  integrator.bind(s);
  static_cast<void>(integrator.advance(s, {.steps = steps}));
  auto settled = s;
  integrator.settle(s, settled, {}, std::nullopt, true);
  return settled;
}

double farthest(const ParticleSystem<double>& a, const ParticleSystem<double>& b) {
  double most = 0;
  for (Index i = 0; i < a.size(); ++i) {
    most = std::max(most, Vec3<double>(a.positions()[i] - b.positions()[i]).cwiseAbs().maxCoeff());
  }
  return most;
}

void measure_equal_error(const bench::Rows& rows) {
  const HyperelasticForce soft{{.lambda = 1, .mu = 0.8}};
  const auto block = Block{
      .cells = {4, 4, 4},
      .size = {1, 1, 1},
      .density = 1,
      .stretch = {1.2, 0.9, 1.05},
      .angular_velocity = {
          1, 0.3, 2}}.build();
  const auto composed = [&](const char* name) { return Composition(KineticPotential(soft), *schemes::find(name)); };
  const auto truth = end_of(composed("srkn14a"), block, 400);
  const std::vector<std::string> names = {"simo_tarnow_wong", "implicit_midpoint", "newmark", "verlet"};
  const auto end_by = [&](const std::string& name, std::int64_t steps) {
    return name == "verlet" ? end_of(composed("verlet"), block, steps)
                            : end_of(classical(soft, method(name)), block, steps);
  };
  std::vector<std::int64_t> steps;
  for (const std::string& name : names) {
    constexpr std::int64_t first = 200;  // errors of order 2 from there on
    const double error = farthest(end_by(name, first), truth);
    steps.push_back(std::llround(std::ceil(first * std::sqrt(error / wanted_error))));
  }
  std::vector<std::vector<double>> times(names.size());
  for (int repeat = 0; repeat < 7; ++repeat) {
    for (std::size_t k = 0; k < names.size(); ++k) {
      times[k].push_back(1e3 * bench::processor_seconds_of([&] { end_by(names[k], steps[k]); }));
    }
  }
  for (std::size_t k = 0; k < names.size(); ++k) {
    rows.add(names[k], "error", bench::Measured({farthest(end_by(names[k], steps[k]), truth)}), "1", steps[k]);
    rows.add(names[k], "equal_error", bench::Measured(times[k]), "ms", steps[k]);
  }
}

void measure_stiff_step(const bench::Rows& rows) {
  const HyperelasticForce stiff{{.lambda = 1000, .mu = 800}};
  auto bar =
      Block{.cells = {8, 2, 2}, .size = {4, 1, 1}, .density = 1, .bend = 0.3, .angular_velocity = {0.5, 0, 1}}.build();
  bar.clock() = Clock<double>::fixed(0, 0.0505);
  Classical<double> integrator = classical(stiff, method("simo_tarnow_wong"));
  integrator.bind(bar);
  std::vector<double> times;
  for (int slice = 0; slice < 20; ++slice) {
    times.push_back(50 *
                    bench::processor_seconds_of([&] { static_cast<void>(integrator.advance(bar, {.steps = 20})); }));
  }
  rows.add("bent_bar", "stiff_step", bench::Measured(times), "ms", bar.size());
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("block", count, arguments,
                         {"saint_venant_kirchhoff", "neo_hookean", "equal_error", "stiff_step"});
  set_thread_count(1);
  Copy copy;
  for (const auto& [law, name] : EnumNames<ElasticLaw>::values) {
    const std::string text(name);
    if (!rows.wants(text)) continue;
    measure(rows, text, HyperelasticForce{{.material = law, .lambda = 1, .mu = 0.8}}, copy);
  }
  if (rows.wants("equal_error")) measure_equal_error(rows);
  if (rows.wants("stiff_step")) measure_stiff_step(rows);
}
