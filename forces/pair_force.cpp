#include "forces/pair_force.hpp"

#include "forces/charged_molecules.hpp"
#include "forces/charged_pairs_mixed_simd.hpp"
#include "forces/charged_pairs_simd.hpp"
#include "forces/pair_chunk_simd.hpp"
#include "forces/pair_groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace noether::detail {

namespace {

// Below the scale of a strong force; those of mixed precision above these.
constexpr int bits_of_unit = 47, bits_of_mixed_unit = 21;

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

/// Records with charges in the place of types, of nobody 0. Kept until this thread asks again.
const double* records_with_charges(const ParticleSystem<double>& s, const NeighborList& list) {
  thread_local AlignedVector<double> memory;
  const std::vector<std::int32_t>& particles = list.particles_of_records();
  const auto count = static_cast<Index>(particles.size());
  memory.resize(4 * (particles.size() + 1));
  double* const to = memory.data();
  const double* const from = list.records();
  const double* const q = s.column<Charge>().data();
  const double by = std::sqrt(s.units().coulomb_constant);
  for_blocks(count, [&](Index begin, Index end) {
    for (Index r = begin; r < end; ++r) {
      for (Index k = 0; k < 3; ++k) to[4 * r + k] = from[4 * r + k];
      to[4 * r + 3] = by * q[particles[static_cast<std::size_t>(r)]];
    }
  });
  for (Index k = 0; k < 3; ++k) to[4 * count + k] = from[4 * count + k];
  to[4 * count + 3] = 0;
  return to;
}

/// The same in whole numbers, with charges in floats. @param by  what charges are multiplied by
const std::int32_t* whole_records_with_charges(const ParticleSystem<double>& s, const NeighborList& list, double by) {
  thread_local AlignedVector<std::int32_t> memory;
  const std::vector<std::int32_t>& particles = list.particles_of_records();
  const auto count = static_cast<Index>(particles.size());
  memory.resize(4 * (particles.size() + 1));
  std::int32_t* const to = memory.data();
  const std::int32_t* const from = list.whole_records();
  const double* const q = s.column<Charge>().data();
  const auto take = [&](Index r, double charge) {
    for (Index k = 0; k < 3; ++k) to[4 * r + k] = from[4 * r + k];
    to[4 * r + 3] = std::bit_cast<std::int32_t>(static_cast<float>(by * charge));
  };
  for_blocks(count, [&](Index begin, Index end) {
    for (Index r = begin; r < end; ++r) take(r, q[particles[static_cast<std::size_t>(r)]]);
  });
  take(count, 0);
  return to;
}

/// Whether t is r^2 itself.
bool is_of_r2(const ChargeSeries& series) { return series.scale == 1 && series.offset == 0; }

/// A series for lengths in another unit.
ChargeSeries in_unit(const ChargeSeries& series, double unit) {
  ChargeSeries other = series;
  const double unit2 = unit * unit;
  other.range2 /= unit2;
  other.switch_from2 /= unit2;
  other.switch_inverse *= unit2;
  for (double& one : other.energy) one *= unit;
  for (double& one : other.force) one *= unit2 * unit;
  if (is_of_r2(series)) {
    other.energy[1] *= unit2;
  } else {
    other.scale *= unit2;
  }
  return other;
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

void check_precision(PairPrecision precision, bool periodic, std::string_view name) {
  if (precision == PairPrecision::full || periodic) return;
  throw Error(fmt::format(
      "{}: precision = \"mixed\" needs a periodic box, but there is none; add a box or leave precision out", name));
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
      out, s, {list, selection}, {force_unit, energy_unit}, limits_of(plan),
      [&](const PairGroup& group, PairSums& found, bool care) {
        PairChunk chunk;
        std::memset(&found, 0, sizeof found);
        for (std::ptrdiff_t row = 0; row < group.rows; row += chunk.rows) {
          chunk.rows = std::min(PairChunk::most_rows, group.rows - row);
          kernels.load(filter, group, row, chunk);
          plan.loop(plan.potential, plan.end, {chunk.r2, chunk.product, 8 * chunk.rows}, chunk.energy, chunk.force);
          (care ? careful : quick)(filter, chunk, found);
        }
      });
}

void add_charges_in_lanes(ForceSink<double>& out, const ParticleSystem<double>& s, const PairPlan& plan,
                          const ChargeSeries& series, PairPrecision precision) {
  const double* const charges = s.column<Charge>().data();
  if (std::all_of(charges, charges + s.size(), [](double q) { return q == 0; })) return;
  const bool mixed = precision == PairPrecision::mixed, sums = out.wants_energy() || out.wants_virial();
  const PairLimits limits = limits_of(plan);
  const double strongest = strongest_product(s), force_unit = limits.strongest / strongest_pair;
  const double energy_unit = force_unit * std::ldexp(1.0, std::ilogb(plan.cutoff) + 1);
  const double close2 = strongest / (0x1.8p50 * force_unit);
  const std::size_t all = sums ? 1 : 0;
  const std::size_t kind = !is_of_r2(series) ? 2 : series.switch_inverse != 0 ? 1 : 0;
  const ChargedPairKernels& kernels = charged_pair_kernels();
  const ChargedPairMixedKernels& mixed_kernels = charged_pair_mixed_kernels();
  const double by = std::sqrt(s.units().coulomb_constant);
  // In mixed precision: what charges are multiplied by, and distances [whole numbers] nearer than which a pair's force
  // is more units than some.
  const double mixed_unit = std::ldexp(force_unit, bits_of_mixed_unit);
  const auto mixed_by = [&](double spacing) {
    return std::sqrt(s.units().coulomb_constant / (spacing * spacing * mixed_unit));
  };
  const auto mixed_close2 = [&](double spacing, double most) {
    return strongest / (most * mixed_unit * spacing * spacing);
  };
  if (auto& molecules = out.workspace().get<ChargedMolecules>();
      plan.types[0] < 0 && molecules.update(s, plan.cutoff, out.neighbors())) {
    const auto quick = kernels.quick_molecules[kind][all], careful = kernels.careful_molecules[kind][all];
    ChargedMoleculeField field{
        !mixed || sums ? molecules.records() : nullptr, {}, &series, close2, force_unit, energy_unit};
    for (std::size_t i = 0; i < ChargedMolecules::sites; ++i) {
      for (std::size_t j = 0; j < ChargedMolecules::sites; ++j)
        field.products[i][j] = (by * molecules.charge(i)) * (by * molecules.charge(j));
    }
    const auto sum_doubles = [&](const PairGroup& group, PairSums& found, bool care) {
      (care ? careful : quick)(field, group, &found);
    };
    if (!mixed) return add_pair_groups(out, s, molecules.pairs(), {force_unit, energy_unit}, limits, sum_doubles);
    const double spacing = ChargedMolecules::whole_spacing(s.box());
    const ChargeSeries scaled = in_unit(series, spacing);
    MixedMoleculeField whole{
        molecules.whole_records(s), {}, &scaled, mixed_close2(spacing, ChargedPairMixedKernels::most_of_molecules)};
    for (std::size_t i = 0; i < ChargedMolecules::sites; ++i)
      whole.charges[i] = static_cast<float>(mixed_by(spacing) * molecules.charge(i));
    const auto mixed_quick = mixed_kernels.quick_molecules[kind], mixed_careful = mixed_kernels.careful_molecules[kind];
    return add_pair_groups(out, s, molecules.pairs(), {mixed_unit, energy_unit}, limits,
                           [&](const PairGroup& group, PairSums& found, bool care) {
                             if (sums) sum_doubles(group, found, care);  // for energies and virials
                             const bool close = sums && found.close;
                             (care ? mixed_careful : mixed_quick)(whole, group, &found);
                             found.close = found.close || close;
                           });
  }
  std::optional<NeighborList> own;
  NeighborList& list = out.neighbors() != nullptr ? *out.neighbors() : own.emplace(plan.cutoff);
  if (mixed) list.update(s, NeighborList::Numbers::whole);
  if (!mixed || sums) list.update(s);
  const NeighborSelection* const selection = selection_of(out, s, list, plan.types);
  const auto quick = kernels.quick[kind][all], careful = kernels.careful[kind][all];
  const ChargedPairField field{!mixed || sums ? records_with_charges(s, list) : nullptr, &series, close2, force_unit,
                               energy_unit};
  const auto sum_doubles = [&](const PairGroup& group, PairSums& found, bool care) {
    (care ? careful : quick)(field, group, found);
  };
  if (!mixed) return add_pair_groups(out, s, {list, selection}, {force_unit, energy_unit}, limits, sum_doubles);
  const double spacing = list.whole_spacing();
  const ChargeSeries scaled = in_unit(series, spacing);
  const MixedChargedField whole{whole_records_with_charges(s, list, mixed_by(spacing)), &scaled,
                                mixed_close2(spacing, ChargedPairMixedKernels::most)};
  const auto mixed_quick = mixed_kernels.quick[kind], mixed_careful = mixed_kernels.careful[kind];
  add_pair_groups(out, s, {list, selection}, {mixed_unit, energy_unit}, limits,
                  [&](const PairGroup& group, PairSums& found, bool care) {
                    if (sums) sum_doubles(group, found, care);  // for energies and virials
                    const bool close = sums && found.close;
                    (care ? mixed_careful : mixed_quick)(whole, group, found);
                    found.close = found.close || close;
                  });
}

}  // namespace noether::detail
