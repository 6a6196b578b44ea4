#pragma once
/// One run made in every way: threads x cadence x program or scene x restart, at every SIMD level.

#include "engine/simulation.hpp"
#include "integrators/composition_options.hpp"
#include "io/digest.hpp"
#include "monitors/monitors.hpp"
#include "monitors/variables.hpp"
#include "numbers/simd.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/energy_projection.hpp"
#include "tests/support/mesh_field.hpp"
#include "tests/support/settings.hpp"
#include "tests/support/tops.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace noether::test {

inline constexpr std::int64_t twin_steps = 5;

/// One run, as a program makes it and as a scene does.
struct Twin {
  std::string name;
  ParticleSystem<double> bodies;
  AnyIntegrator<double> program;
  double step;
  std::string hamiltonian;  ///< of the scene, or its system
  std::string method;
  std::string place = {};       ///< where the scene's particles are, if not in open space
  std::string decorators = {};  ///< of the scene
  CompositionOptions options = {};
  std::string particles = "[[particles.body]]\nname='replaced'\nmass=1\nx=[0,0,0]\nv=[0,0,0]\n";  ///< before `bodies`
  std::string watched = "energy";                                                                 ///< or `variables`
};

/// One way to make the run.
struct Way {
  int threads = 1;
  std::int64_t cadence = 0;
  bool from_scene = false;
  bool restarted = false;
};

/// Those of noether, and some from outside.
inline Parts parts_of_twins() {
  Parts all = standard_parts();
  all.add_decorator<EnergyProjection>();
  all.add_hamiltonian<Tops>();
  all.add_force<MeshField>();
  return all;
}

/// As a scene has them.
inline std::string keys_of(const CompositionOptions& options) {
  std::string kernel;
  for (const auto& [value, name] : EnumNames<StepKernel>::values) kernel = value == options.kernel ? name : kernel;
  const std::string inner = options.inner_steps.empty() ? "" : "inner_steps=" + options.inner_steps.text() + "\n";
  return fmt::format("compensated={}\ncorrector={}\nkernel='{}'\nsecond_corrector={}\n{}", options.compensated,
                     options.corrector, kernel, options.second_corrector, inner);
}

inline Simulation<double> simulation_of(const Twin& twin, const Way& way) {
  const std::string watch =
      way.cadence > 0 ? fmt::format("[[every]]\ntype='{}'\nsteps={}\n", twin.watched, way.cadence) : "";
  const auto from_scene = [&] {
    Scene scene = read_scene(fmt::format("units='reduced'\n{}{}{}[integrator]\nmethod='{}'\nstep={}\nsteps={}\n{}{}{}",
                                         twin.place, twin.particles, twin.hamiltonian, twin.method, twin.step,
                                         twin_steps, keys_of(twin.options), twin.decorators, watch),
                             "scene.toml", parts_of_twins());
    scene.particles = twin.bodies;
    return assemble(scene);
  };
  if (way.from_scene) return from_scene();
  Simulation<double> simulation(twin.bodies, twin.program, twin.step);
  if (way.cadence > 0 && twin.watched == "energy") simulation.every(way.cadence, Energy{});
  if (way.cadence > 0 && twin.watched == "variables") simulation.every(way.cadence, Variables{});
  return simulation;
}

/// The digest of the first words, and after it second ones where they are digits of the state.
inline std::string bits_of(Simulation<double>& simulation, bool second_words) {
  const ParticleSystem<double>& s = simulation.particles();
  std::string bits = io::digest(s);
  if (!second_words) return bits;
  REQUIRE(s.low_words() != nullptr);
  for (const VectorColumn<double>* column : {&s.low_words()->x, &s.low_words()->v}) {
    for (Index i = 0; i < s.size(); ++i) {
      for (int k = 0; k < 3; ++k) bits += fmt::format(" {:a}", column->component(k)[i]);
    }
  }
  return bits;
}

inline std::string digest_of(const Twin& twin, const Way& way) {
  const bool second_words = twin.program.claims().second_words;
  const Threads threads(way.threads);
  Simulation<double> whole = simulation_of(twin, way);
  if (!way.restarted) {
    REQUIRE(whole.run(twin_steps).ok());
    return bits_of(whole, second_words);
  }
  REQUIRE(whole.run(2).ok());
  Simulation<double> again = simulation_of(twin, way);
  again.restore(whole.save());
  REQUIRE(again.run(twin_steps - 2).ok());
  return bits_of(again, second_words);
}

/// Every way there is: 96.
inline std::vector<Way> all_ways() {
  std::vector<Way> ways;
  for (int threads = 1; threads <= 8; ++threads) {
    for (const std::int64_t cadence : {0, 1, 3}) {
      for (const bool from_scene : {false, true}) {
        for (const bool restarted : {false, true}) ways.push_back({threads, cadence, from_scene, restarted});
      }
    }
  }
  return ways;
}

/// Goes every so manieth of 96 ways at every SIMD level; at one level all of them end in the same bits.
inline void check_ways(const Twin& twin, std::size_t stride) {
  const std::vector<Way> ways = all_ways();
  for (const SimdLevel level : {SimdLevel::base, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!has_simd_level(level)) continue;
    const AtLevel at(level);
    const std::string expected = digest_of(twin, {});
    for (std::size_t k = 0; k < ways.size(); k += stride) {
      const Way& way = ways[k];
      CAPTURE(twin.name, name(level), way.threads, way.cadence, way.from_scene, way.restarted);
      CHECK(digest_of(twin, way) == expected);
    }
  }
}

}  // namespace noether::test
