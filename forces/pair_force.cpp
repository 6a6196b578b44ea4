#include "forces/pair_force.hpp"

#include "forces/pair_chunk_simd.hpp"
#include "forces/pair_groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace noether::detail {

namespace {

constexpr int bits_of_unit = 47;  // below the scale of a strong force

double force_unit_of(double scale) { return std::ldexp(1.0, std::ilogb(scale) + 1 - bits_of_unit); }

int type_named(const Topology* topology, const std::string& name, std::string_view key) {
  const std::vector<std::string>& names = topology != nullptr ? topology->type_names : std::vector<std::string>{};
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  throw Error(
      fmt::format("{} = \"{}\" is not a type of the particles; {}", key, name,
                  names.empty() ? "they have no types" : fmt::format("expected one of: {}", fmt::join(names, ", "))));
}

/// Charges in the order of the records; of nobody 0. Kept until this thread asks again.
const double* charges_of_records(const ParticleSystem<double>& s, const NeighborList& list) {
  thread_local std::vector<double> charges;
  const std::vector<std::int32_t>& particles = list.particles_of_records();
  charges.resize(particles.size() + 1);
  double* const to = charges.data();
  const double* const q = s.column<Charge>().data();
  for_blocks(static_cast<Index>(particles.size()), [&](Index begin, Index end) {
    for (Index r = begin; r < end; ++r) to[r] = q[particles[static_cast<std::size_t>(r)]];
  });
  to[particles.size()] = 0;
  return to;
}

/// The pairs of two types; null: all.
const NeighborSelection* selection_of(ForceSink<double>& out, const ParticleSystem<double>& s, const NeighborList& list,
                                      const std::array<int, 2>& types) {
  if (types[0] < 0 || list.crowded() >= 0) return nullptr;
  auto& selection = out.workspace().get<NeighborSelection>();
  selection.update(list, s.topology()->type_count(), [&](int a, int b) {
    return std::array<int, 2>{a, b} == types || std::array<int, 2>{b, a} == types;
  });
  return &selection;
}

}  // namespace

std::array<int, 2> pair_types(const Topology* topology, const std::string& first, const std::string& second) {
  if (first.empty() && second.empty()) return {-1, -1};
  if (first.empty() || second.empty()) {
    throw Error(fmt::format("{} = \"{}\" is given alone; give both first and second, or neither",
                            first.empty() ? "second" : "first", first.empty() ? second : first));
  }
  return {type_named(topology, first, "first"), type_named(topology, second, "second")};
}

void check_pair_scale(double scale) {
  if (!(scale > 0 && scale < 1e150)) {
    throw Error(
        fmt::format("the parameters of a pair potential give it a strength of {}; a force above 0 is expected", scale));
  }
}

void check_charges(bool there, std::string_view name) {
  if (there) return;
  throw Error(fmt::format(
      "force '{}' acts between charges, but the particles have none; give charges, or take the force out", name));
}

double strongest_product(const ParticleSystem<double>& s) {
  double most = 0;
  const auto& q = s.column<Charge>();
  for (Index i = 0; i < s.size(); ++i) most = std::max(most, std::abs(q[i]));
  return s.units().coulomb_constant * (most > 0 ? most * most : 1);
}

PairLimits limits_of(const PairPlan& plan) {
  return {plan.cutoff, plan.nearest, strongest_pair * force_unit_of(plan.scale), plan.name};
}

void add_pairs_in_lanes(ForceSink<double>& out, const ParticleSystem<double>& s, const PairPlan& plan) {
  std::optional<NeighborList> own;
  NeighborList& list = out.neighbors() != nullptr ? *out.neighbors() : own.emplace(plan.cutoff);
  list.update(s);
  const PairChunkKernels& kernels = pair_chunk_kernels();
  const std::size_t all = out.wants_energy() || out.wants_virial() ? 1 : 0;
  const auto quick = kernels.add[0][all], careful = kernels.add[1][all];
  const double force_unit = force_unit_of(plan.scale);
  const double energy_unit = force_unit * std::ldexp(1.0, std::ilogb(plan.cutoff) + 1);
  const NeighborSelection* const selection = selection_of(out, s, list, plan.types);
  const PairFilter filter{list.records(),
                          plan.cutoff * plan.cutoff,
                          plan.nearest * plan.nearest,
                          force_unit,
                          energy_unit,
                          plan.coulomb_constant != 0 ? charges_of_records(s, list) : nullptr,
                          plan.coulomb_constant};
  add_pair_groups(
      out, s, list, {force_unit, energy_unit}, limits_of(plan),
      [&](const PairGroup& group, PairSums& found, bool care) {
        PairChunk chunk;
        std::memset(&found, 0, sizeof found);
        for (std::ptrdiff_t row = 0; row < group.rows; row += chunk.rows) {
          chunk.rows = std::min(PairChunk::most_rows, group.rows - row);
          kernels.load(filter, group, row, chunk);
          plan.loop(plan.potential, plan.end, {chunk.r2, chunk.product, 8 * chunk.rows}, chunk.energy, chunk.force);
          (care ? careful : quick)(filter, chunk, found);
        }
      },
      selection);
}

}  // namespace noether::detail
