/// What a sweep of HBVM(8, S) costs over one of Gauss's method with S stages: the outer planets, steps of 100 days.
///
/// Protocol: 40 slices of 500 steps each, one of each method in turn; medians of processor times by the sweeps made,
/// which are evaluations by 8 and by S.

#include "bench/planets.hpp"

#include "forces/gravity.hpp"
#include "integrators/classical.hpp"

using namespace noether;

namespace {

struct Sweeping {
  Simulation<double> run;
  int nodes = 0;

  /// Seconds of a sweep over so many steps.
  double sweep_seconds(std::int64_t steps) {
    const std::int64_t before = run.evaluations().force;
    const double seconds = bench::processor_seconds_of([&] { static_cast<void>(run.run(steps)); });
    return seconds * nodes / static_cast<double>(run.evaluations().force - before);
  }
};

Sweeping sweeping(const std::string& name, int nodes) {
  MethodOptions options;
  if (methods::find(name)->adaptive) options.adaptive = false;
  return {{bench::six_bodies(), classical(Gravity{}, method(name, options)), 100.0}, nodes};
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("line_integral", count, arguments);
  set_thread_count(1);
  for (int S = 2; S <= 4; ++S) {
    Sweeping line = sweeping(fmt::format("hbvm_8_{}", S), 8), gauss = sweeping(fmt::format("gauss_{}", S), S);
    std::vector<double> ratios, lines;
    for (int slice = 0; slice < 40; ++slice) {
      const double one = line.sweep_seconds(500), other = gauss.sweep_seconds(500);
      ratios.push_back(one / other);
      lines.push_back(1e9 * one);
    }
    const std::string name = fmt::format("hbvm_8_{}", S);
    rows.add(name, "sweep_ns", bench::Measured(lines), "ns", 6);
    rows.add(name, fmt::format("sweep_over_gauss_{}", S), bench::Measured(ratios), "1", 6);
  }
}
