#include "forces/lennard_jones.hpp"

#include "forces/lennard_jones_mixed_simd.hpp"
#include "forces/lennard_jones_simd.hpp"
#include "forces/pair_chunk_simd.hpp"
#include "forces/pair_groups.hpp"
#include "neighbors/subset_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <numbers>

namespace noether {

namespace {

constexpr double default_switch = 0.9;  // parts of the cutoff
/// Units below the scale of the strongest attraction, 24 epsilon / sigma.
constexpr int unit_bits = 47, mixed_unit_bits = 21;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

double power_of_two_above(double x) { return x > 0 ? std::ldexp(1.0, std::ilogb(x) + 1) : 1.0; }

LennardJonesStyle style_of(Cutoff cutoff) {
  switch (cutoff) {
    case Cutoff::shifted_force:
      return LennardJonesStyle::shifted_force;
    case Cutoff::switch_c2:
      return LennardJonesStyle::switch_c2;
    case Cutoff::switch_c4:
      return LennardJonesStyle::switch_c4;
    default:
      return LennardJonesStyle::shifted;
  }
}

/// Whether the kernels of Lennard-Jones have no such style.
bool is_of_other_programs(Cutoff style) {
  return style == Cutoff::potential_switch || style == Cutoff::charmm_switch || style == Cutoff::force_switch;
}

std::string_view name_of_style(Cutoff style) {
  const auto& all = EnumNames<Cutoff>::values;
  return std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.first == style; })->second;
}

/// Whether what a style leaves out is the energy of pairs times 1 - S.
bool has_tail(Cutoff style) {
  return style == Cutoff::plain || (detail::is_switched(style) && style != Cutoff::force_switch);
}

/// int (1 - S) U r^2 dr from where a switch begins to the cutoff [energy length^3]: by the five points of Gauss, on
/// parts that are each 2 % longer than the one before, or shorter.
double left_out_by_switch(const LennardJonesRow& row, Cutoff style, double cutoff, double from) {
  constexpr double nodes[5] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831, 0.9061798459386640};
  constexpr double weights[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                 0.2369268850561891};
  const double span = std::log(cutoff / from), width = cutoff * cutoff - from * from;
  const double parts = std::max(32.0, std::ceil(span / 0.02)), half = span / parts / 2;
  double sum = 0;
  for (double part = 0; part < parts; ++part) {
    for (int k = 0; k < 5; ++k) {
      const double r = from * std::exp((2 * part + 1 + nodes[k]) * half), r2 = r * r, inverse6 = 1 / (r2 * r2 * r2);
      const double t = style == Cutoff::potential_switch ? (r - from) / (cutoff - from) : (r2 - from * from) / width;
      const double energy = inverse6 * (inverse6 * row.energy12 - row.energy6);
      sum += weights[k] * half * (1 - detail::Switch<double>(style, t).value) * energy * r2 * r;
    }
  }
  return sum;
}

/// The row of a pair of types.
LennardJonesRow row_of(const PairKind& kind, double cutoff, Cutoff cutoff_style, double switch_from) {
  const double s3 = kind.sigma * kind.sigma * kind.sigma, s6 = s3 * s3, s12 = s6 * s6;
  LennardJonesRow row;
  row.range2 = kind.epsilon == 0 ? 0 : cutoff * cutoff;
  row.force12 = 48 * kind.epsilon * s12;
  row.force6 = 24 * kind.epsilon * s6;
  row.energy12 = 4 * kind.epsilon * s12;
  row.energy6 = 4 * kind.epsilon * s6;
  const double c2 = cutoff * cutoff;
  if (cutoff_style == Cutoff::switch_c2 || cutoff_style == Cutoff::switch_c4) {
    row.style[0] = switch_from * switch_from;
    row.style[1] = 1 / (c2 - switch_from * switch_from);
    return row;
  }
  if (cutoff_style == Cutoff::plain || is_of_other_programs(cutoff_style)) return row;
  const auto end = detail::lennard_jones_terms(c2, row, LennardJonesStyle::shifted);
  row.style[0] = end.energy;
  if (cutoff_style == Cutoff::shifted_force) {
    row.style[1] = end.force * cutoff;
    row.style[0] += row.style[1] * cutoff;
  }
  return row;
}

bool has_depth(const LennardJonesRow& row) { return row.range2 > 0; }

/// The row by which all pairs act that act at all; -1: there are more.
std::ptrdiff_t only_row(const std::vector<LennardJonesRow>& rows) {
  const auto first = std::find_if(rows.begin(), rows.end(), has_depth);
  const auto other = std::find_if(first, rows.end(), [&](const auto& row) { return has_depth(row) && row != *first; });
  return other == rows.end() ? std::min(first - rows.begin(), static_cast<std::ptrdiff_t>(rows.size()) - 1) : -1;
}

/// The particles that act, in a list of their own, where these are half of all at most and each acts on each other;
/// null where that is not so.
SubsetList* subset_of(ForceSink<double>& out, const ParticleSystem<double>& s, const detail::LennardJonesTable& table) {
  if (std::all_of(table.rows.begin(), table.rows.end(), has_depth)) return nullptr;
  std::vector<std::uint8_t> acts(at(table.types));
  for (int a = 0; a < table.types; ++a) {
    const auto row = table.rows.begin() + a * table.types;
    acts[at(a)] = std::any_of(row, row + table.types, has_depth) ? 1 : 0;
  }
  for (int a = 0; a < table.types; ++a) {
    for (int b = 0; b < table.types; ++b) {
      if (acts[at(a)] != 0 && acts[at(b)] != 0 && !has_depth(table.rows[at(a * table.types + b)])) return nullptr;
    }
  }
  auto& subset = out.workspace().get<SubsetList>();
  subset.choose(s, acts);
  return 2 * subset.size() <= s.size() ? &subset : nullptr;
}

/// The pairs of types that have a depth, where not all have one; null: all.
const NeighborSelection* selection_of(ForceSink<double>& out, const NeighborList& list,
                                      const detail::LennardJonesTable& table) {
  if (list.crowded() >= 0 || std::all_of(table.rows.begin(), table.rows.end(), has_depth)) return nullptr;
  auto& selection = out.workspace().get<NeighborSelection>();
  selection.update(list, table.types, [&](int a, int b) { return has_depth(table.rows[at(a * table.types + b)]); });
  return &selection;
}

/// The pairs that can act, from the shared list or, where there is none, one made here, or from one of those alone that
/// act.
class ActingPairs {
 public:
  ActingPairs(ForceSink<double>& out, const ParticleSystem<double>& s, const detail::LennardJonesTable& table,
              double range)
      : out_(out), s_(s), table_(table), range_(range), subset_(subset_of(out, s, table)) {}

  detail::ListedPairs up_to_date(NeighborList::Numbers numbers) {
    if (subset_ != nullptr) {
      subset_->update(s_, range_, out_.neighbors(), numbers);
      return {.list = subset_->list(), .indices = {subset_->members()}};
    }
    if (out_.neighbors() == nullptr && !own_) own_.emplace(range_);
    NeighborList& list = own_ ? *own_ : *out_.neighbors();
    list.update(s_, numbers);
    return {.list = list, .selection = selection_of(out_, list, table_)};
  }

 private:
  ForceSink<double>& out_;
  const ParticleSystem<double>& s_;
  const detail::LennardJonesTable& table_;
  double range_;
  SubsetList* subset_;
  std::optional<NeighborList> own_;
};

}  // namespace

void LennardJonesForce::check() const {
  detail::check_cutoff(cutoff, cutoff_style, switch_from);
  if (epsilon.has_value() != sigma.has_value())
    refuse_field(epsilon ? "epsilon" : "sigma", epsilon ? *epsilon : *sigma,
                 "is given alone; give both epsilon and sigma, or neither");
  if (epsilon && !(*epsilon >= 0)) refuse_field("epsilon", *epsilon, "is not a valid depth; 0 or more is expected");
  if (sigma && !(*sigma > 0)) refuse_field("sigma", *sigma, "is not a valid length; a length above 0 is expected");
  if (tail && !has_tail(cutoff_style)) {
    refuse_field("tail", 1,
                 "is for a plain cutoff or a switch of the energy only; the other cutoff styles also change the energy "
                 "of near pairs");
  }
  if (precision == PairPrecision::mixed && is_of_other_programs(cutoff_style)) {
    refuse_field("precision", "\"mixed\"",
                 fmt::format("does not support cutoff_style = \"{}\"; leave precision out, or take \"switch_c2\" or "
                             "\"switch_c4\"",
                             name_of_style(cutoff_style)));
  }
}

void LennardJonesForce::check_types(const Topology* topology, const Box& box) const {
  check();
  if (tail && !box.is_periodic())
    throw Error(
        "lennard_jones: tail = true is for a liquid without end, so it needs a periodic box; add a box or leave tail "
        "out");
  detail::check_precision(precision, box.is_periodic(), "lennard_jones");
  if (epsilon) return;
  if (topology == nullptr || topology->pair_kinds.empty()) {
    throw Error(
        "lennard_jones: the particles have no Lennard-Jones parameters; give epsilon and sigma here, or types "
        "that have them");
  }
  for (int a = 0; a < topology->type_count(); ++a) static_cast<void>(topology->pair_kind(a, a));
}

const detail::LennardJonesTable& LennardJonesForce::table_for(const std::shared_ptr<const Topology>& topology,
                                                              Index n) const {
  const std::array<double, 7> key = {cutoff,
                                     static_cast<double>(cutoff_style),
                                     switch_from.value_or(-1),
                                     tail ? 1.0 : 0.0,
                                     epsilon.value_or(-1),
                                     sigma.value_or(-1),
                                     static_cast<double>(n)};
  if (table && table->key == key && table->topology == topology) return *table;
  auto made = std::make_shared<detail::LennardJonesTable>();
  made->key = key;
  made->topology = topology;
  made->style = style_of(cutoff_style);
  made->types = topology ? topology->type_count() : 1;
  std::vector<double> members(static_cast<std::size_t>(made->types), 0.0);
  for (Index i = 0; i < n && tail; ++i) ++members[at(topology ? topology->type(i) : 0)];
  double strongest = 0;
  for (int a = 0; a < made->types; ++a) {
    for (int b = 0; b < made->types; ++b) {
      const PairKind kind = epsilon ? PairKind{*epsilon, *sigma} : topology->pair_kind(a, b);
      const double from = switch_from.value_or(default_switch * cutoff);
      const LennardJonesRow& row = made->rows.emplace_back(row_of(kind, cutoff, cutoff_style, from));
      if (is_of_other_programs(cutoff_style)) {
        const detail::LennardJonesOfRow pair{row.force12, row.force6, row.energy12, row.energy6};
        made->ended.push_back({pair, detail::end_of(pair, cutoff_style, cutoff, from)});
      }
      if (kind.epsilon > 0) strongest = std::max(strongest, 24 * kind.epsilon / kind.sigma);
      // 2 pi N_a N_b / V times the integrals of r^2 U and r^3 F over what is left out
      const double s6 = std::pow(kind.sigma, 6), c3 = cutoff * cutoff * cutoff;
      const double repulsion = 4 * kind.epsilon * s6 * s6 / (9 * c3 * c3 * c3),
                   attraction = 4 * kind.epsilon * s6 / (3 * c3);
      const double pairs = 2 * std::numbers::pi * members[at(a)] * members[at(b)];
      if (tail && detail::is_switched(cutoff_style)) {
        const double energy = repulsion - attraction + left_out_by_switch(row, cutoff_style, cutoff, from);
        made->tail_energy += pairs * energy;
        made->tail_virial += pairs * 3 * energy;
      } else {
        made->tail_energy += pairs * (repulsion - attraction);
        made->tail_virial += pairs * (12 * repulsion - 6 * attraction);
      }
    }
  }
  made->force_unit = std::ldexp(power_of_two_above(strongest), -unit_bits);
  made->energy_unit = made->force_unit * power_of_two_above(cutoff);
  for (LennardJonesRow& row : made->rows) {
    row.close2 = std::pow(row.force12 / (0x1.8p50 * made->force_unit), 2.0 / 13.0);
  }
  made->only_row = only_row(made->rows);
  table = made;
  return *table;
}

const detail::LennardJonesMixedTable& LennardJonesForce::mixed_table_for(double spacing) const {
  if (mixed_table && mixed_table->of == table && mixed_table->spacing == spacing) return *mixed_table;
  auto made = std::make_shared<detail::LennardJonesMixedTable>();
  made->of = table;
  made->spacing = spacing;
  made->force_unit = std::ldexp(table->force_unit, unit_bits - mixed_unit_bits);
  const double unit = std::ldexp(1.0, std::ilogb(cutoff));  // so that no power of it leaves the range of floats
  made->inverse2_unit = unit * unit / (spacing * spacing);
  const double u2 = unit * unit, u6 = u2 * u2 * u2, s2 = spacing * spacing;
  const double force = spacing / made->force_unit, energy = 1 / (spacing * made->force_unit);
  for (const LennardJonesRow& row : table->rows) {
    LennardJonesRow mixed;
    mixed.range2 = row.range2 / s2;
    mixed.close2 = std::pow(row.force12 / (0x1.8p27 * made->force_unit), 2.0 / 13.0) / s2;
    mixed.force12 = row.force12 / (u6 * u6 * u2) * force;
    mixed.force6 = row.force6 / (u6 * u2) * force;
    mixed.energy12 = row.energy12 / (u6 * u6) * energy;
    mixed.energy6 = row.energy6 / u6 * energy;
    if (table->style == LennardJonesStyle::switch_c2 || table->style == LennardJonesStyle::switch_c4) {
      mixed.style[0] = row.style[0] / s2;
      mixed.style[1] = row.style[1] * s2;
    } else {
      mixed.style[1] = row.style[1] / unit * force;
    }
    made->rows.push_back(mixed);
  }
  mixed_table = made;
  return *mixed_table;
}

namespace {

std::int64_t type_of_record(const double* record) {
  std::int64_t type = 0;
  std::memcpy(&type, record + 3, sizeof type);
  return type;
}

/// Energies and forces of a chunk of pairs of several types, which begins at row `first`.
void end_pairs_of_types(const detail::LennardJonesTable& table, const double* records, const PairGroup& group,
                        std::ptrdiff_t first, PairChunk& chunk) {
  std::array<std::int64_t, 8> own{};
  for (std::size_t k = 0; k < 8; ++k) own[k] = type_of_record(records + group.records[k]) * table.types;
  for (std::ptrdiff_t k = 0; k < 8 * chunk.rows; ++k) {
    const std::int64_t other = type_of_record(records + group.entries[8 * first + k]);
    const detail::EndedLennardJones& row = table.ended[at(own[at(k % 8)] + other)];
    const PairTerms<double> terms = detail::ended<double>(row.pair, row.end, chunk.r2[k], 0.0);
    chunk.energy[k] = terms.energy;
    chunk.force[k] = terms.force;
  }
}

}  // namespace

/// The styles of other programs go through the lanes of any pair potential.
void LennardJonesForce::add_ended(ForceSink<double>& out, const ParticleSystem<double>& s,
                                  const detail::LennardJonesTable& known) const {
  ActingPairs acting(out, s, known, cutoff);
  const detail::ListedPairs pairs = acting.up_to_date(NeighborList::Numbers::doubles);
  const PairChunkKernels& kernels = pair_chunk_kernels();
  const std::size_t all = out.wants_energy() || out.wants_virial() ? 1 : 0;
  const auto quick = kernels.add[0][all], careful = kernels.add[1][all];
  const PairFilter filter{pairs.list.records(), cutoff * cutoff, 0, known.force_unit, known.energy_unit, nullptr, 0};
  const detail::PairLimits limits{cutoff, 0, detail::strongest_pair * known.force_unit, "Lennard-Jones"};
  const detail::PairLoop loop = detail::pair_loop<detail::LennardJonesOfRow>(cutoff_style);
  detail::add_pair_groups(
      out, s, pairs, {known.force_unit, known.energy_unit}, limits,
      [&](const PairGroup& group, PairSums& found, bool care) {
        PairChunk chunk;
        std::memset(&found, 0, sizeof found);
        for (std::ptrdiff_t row = 0; row < group.rows; row += chunk.rows) {
          chunk.rows = std::min(PairChunk::most_rows, group.rows - row);
          kernels.load(filter, group, row, chunk);
          if (known.only_row < 0) {
            end_pairs_of_types(known, filter.records, group, row, chunk);
          } else {
            const detail::EndedLennardJones& one = known.ended[at(known.only_row)];
            loop(&one.pair, one.end, {chunk.r2, chunk.product, 8 * chunk.rows}, chunk.energy, chunk.force);
          }
          (care ? careful : quick)(filter, chunk, found);
        }
      });
  detail::add_special_pairs(out, s, terms_of(s), limits);
  add_tail(out, s);
}

void LennardJonesForce::add_lanes(ForceSink<double>& out, const ParticleSystem<double>& s) const {
  const detail::LennardJonesTable& known = table_for(s.shared_topology(), s.size());
  if (!known.ended.empty()) return add_ended(out, s, known);
  const bool mixed = precision == PairPrecision::mixed, sums = out.wants_energy() || out.wants_virial();
  ActingPairs acting(out, s, known, cutoff);
  if (mixed && sums) static_cast<void>(acting.up_to_date(NeighborList::Numbers::doubles));
  const detail::ListedPairs pairs =
      acting.up_to_date(mixed ? NeighborList::Numbers::whole : NeighborList::Numbers::doubles);
  const NeighborList& list = pairs.list;
  const LennardJonesKernels& kernels = lennard_jones_kernels();
  const auto style = static_cast<std::size_t>(known.style), many = static_cast<std::size_t>(known.only_row < 0);
  const std::ptrdiff_t first_row = std::max<std::ptrdiff_t>(known.only_row, 0);
  const SumPairs quick = kernels.quick[style][many][sums ? 1 : 0], careful = kernels.careful[style][many][sums ? 1 : 0];
  const PairField field{list.records(), known.rows.data() + first_row, known.types, known.force_unit,
                        known.energy_unit};
  const detail::PairLimits limits{cutoff, 0, detail::strongest_pair * known.force_unit, "Lennard-Jones"};
  const auto sum_doubles = [&](const PairGroup& group, PairSums& found, bool care) {
    (care ? careful : quick)(field, group, found);
  };
  if (mixed) {
    const detail::LennardJonesMixedTable& table_in_use = mixed_table_for(list.whole_spacing());
    const LennardJonesMixedKernels& mixed_kernels = lennard_jones_mixed_kernels();
    const SumMixedPairs mixed_quick = mixed_kernels.quick[style][many],
                        mixed_careful = mixed_kernels.careful[style][many];
    const MixedPairField whole{list.whole_records(), table_in_use.rows.data() + first_row, known.types,
                               table_in_use.inverse2_unit};
    detail::add_pair_groups(out, s, pairs, {table_in_use.force_unit, known.energy_unit}, limits,
                            [&](const PairGroup& group, PairSums& found, bool care) {
                              if (sums) sum_doubles(group, found, care);  // for energies and virials
                              const bool close = sums && found.close;
                              (care ? mixed_careful : mixed_quick)(whole, group, found);
                              found.close = found.close || close;
                            });
  } else {
    detail::add_pair_groups(out, s, pairs, {known.force_unit, known.energy_unit}, limits, sum_doubles);
  }
  detail::add_special_pairs(out, s, terms_of(s), limits);
  add_tail(out, s);
}

template struct detail::ForceModel<LennardJonesForce, double>;
template struct detail::ForceModel<LennardJonesForce, Quad>;

}  // namespace noether
