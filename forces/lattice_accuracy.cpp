#include "forces/lattice_accuracy.hpp"

#include "engine/force_sink.hpp"
#include "engine/sums.hpp"
#include "forces/charge_mesh.hpp"
#include "forces/ewald.hpp"
#include "forces/particle_mesh_ewald.hpp"
#include "numbers/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace noether {

namespace {

/// Seconds, about: a pair with its erfc, and a wave of one charge.
constexpr double pair_cost = 4e-6, wave_cost = 2e-7;
constexpr Index most_all = 192, sample = 64;

/// Alpha, cutoff and wave number of a sum that is right to `error` and costs least.
struct CheapSplit {
  double alpha, cutoff, kmax;

  CheapSplit(double volume, Index charged, Index on, double error) {
    const double turn = 6.283185307179586, x2 = std::max(1.0, std::log(2 / error));
    const double density = static_cast<double>(charged) / volume;
    const double near = static_cast<double>(on) * 2 * turn / 3 * density * pair_cost;  // of a cutoff of 1
    const double far = static_cast<double>(charged + on) * detail::wave_count(2 * x2, volume) * wave_cost;
    cutoff = std::pow(far / near, 1.0 / 6);
    const detail::SplitErrors errors(volume, charged);
    alpha = errors.alpha_for(error, cutoff);
    kmax = errors.wave_number_for(error, alpha);
  }
};

/// Waves that differ along z only.
struct Row {
  int x, y, first, last;
};
std::vector<Row> rows_of(const std::vector<detail::Wave>& waves) {
  std::vector<Row> rows;
  for (const detail::Wave& wave : waves) {
    if (rows.empty() || rows.back().x != wave[0] || rows.back().y != wave[1])
      rows.push_back({wave[0], wave[1], wave[2], wave[2]});
    rows.back().last = wave[2];
  }
  return rows;
}

struct Turn {
  Quad c, s;
};
Turn product(const Turn& a, const Turn& b) { return {a.c * b.c - a.s * b.s, a.s * b.c + a.c * b.s}; }
/// exp(i k.x) of the wave of a table; waves of negative numbers are conjugates.
Turn turn_of(const detail::WaveTables<Quad>& tables, int axis, int m, Index i) {
  const Quad s = tables.sines(axis, m)[i];
  return {tables.cosines(axis, m)[i], m < 0 ? -s : s};
}

/// Calls body(k) for each k of [0, n), which threads share.
template <class Body> void for_each_shared(std::size_t n, const Body& body) {
  const auto run = [](const void* it, Index k) noexcept {
    (*static_cast<const Body*>(it))(static_cast<std::size_t>(k));
  };
  if (n > 0) detail::share_blocks(static_cast<Index>(n), run, &body);
}

/// Forces of the waves: first the sum q exp(i k.x) of each, then what all of them do to some charges.
void add_waves(const ParticleSystem<Quad>& s, const std::vector<Index>& on, const CheapSplit& split,
               std::vector<Vec3<Quad>>& forces) {
  const Vec3<double>& edges = s.box().edges();
  const std::vector<detail::Wave> waves = detail::waves_up_to(split.kmax, edges);
  const std::vector<Row> rows = rows_of(waves);
  std::array<int, 3> most{};
  for (const detail::Wave& wave : waves) {
    for (std::size_t k = 0; k < 3; ++k) most[k] = std::max(most[k], std::abs(wave[k]));
  }
  detail::WaveTables<Quad> tables;
  detail::fill_wave_tables(tables, s, most);
  const auto& q = s.column<Charge>();
  std::vector<std::vector<Turn>> sums(rows.size());
  for_each_shared(rows.size(), [&](std::size_t r) {
    const Row& row = rows[r];
    sums[r].assign(static_cast<std::size_t>(row.last - row.first + 1), {Quad(0), Quad(0)});
    for (Index i = 0; i < s.size(); ++i) {
      if (q[i] == Quad(0)) continue;
      Turn place = product(turn_of(tables, 0, row.x, i), turn_of(tables, 1, row.y, i));
      place = {q[i] * place.c, q[i] * place.s};
      for (int z = row.first; z <= row.last; ++z) {
        const Turn one = product(place, turn_of(tables, 2, z, i));
        Turn& sum = sums[r][static_cast<std::size_t>(z - row.first)];
        sum = {sum.c + one.c, sum.s + one.s};
      }
    }
    for (int z = row.first; z <= row.last; ++z) {
      const detail::WaveWeight<Quad> weight({row.x, row.y, z}, edges, split.alpha, s.units().coulomb_constant);
      Turn& sum = sums[r][static_cast<std::size_t>(z - row.first)];
      sum = {Quad(2) * weight.A * sum.c, Quad(2) * weight.A * sum.s};
    }
  });
  const Quad turn = Quad(8) * atan(Quad(1));
  for_each_shared(on.size(), [&](std::size_t p) {
    const Index i = on[p];
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const Row& row = rows[r];
      const Turn place = product(turn_of(tables, 0, row.x, i), turn_of(tables, 1, row.y, i));
      Quad along(0), along_z(0);
      for (int z = row.first; z <= row.last; ++z) {
        const Turn one = product(place, turn_of(tables, 2, z, i));
        const Turn& sum = sums[r][static_cast<std::size_t>(z - row.first)];
        const Quad slope = one.s * sum.c - one.c * sum.s;
        along += slope;
        along_z += Quad(z) * slope;
      }
      forces[p] += q[i] * turn *
                   Vec3<Quad>(Quad(row.x) * along / Quad(edges[0]), Quad(row.y) * along / Quad(edges[1]),
                              along_z / Quad(edges[2]));
    }
  });
}

/// Forces of pairs, all images in the cutoff.
void add_near(const ParticleSystem<Quad>& s, const std::vector<Index>& on, const CheapSplit& split,
              std::vector<Vec3<Quad>>& forces) {
  const Vec3<double>& edges = s.box().edges();
  const auto& q = s.column<Charge>();
  const Quad slope = Quad(split.alpha) / sqrt(atan(Quad(1))), reach2 = Quad(split.cutoff) * Quad(split.cutoff);
  std::array<int, 3> images{};
  for (std::size_t k = 0; k < 3; ++k)
    images[k] = static_cast<int>(std::ceil(split.cutoff / edges[static_cast<Index>(k)] + 0.5));
  for_each_shared(on.size(), [&](std::size_t p) {
    const Index i = on[p];
    for (Index j = 0; j < s.size(); ++j) {
      if (j == i || q[j] == Quad(0)) continue;
      const Vec3<Quad> nearest = s.box().minimum_image(Vec3<Quad>(s.positions()[i] - s.positions()[j]));
      const Vec3<double> rounded(static_cast<double>(nearest[0]), static_cast<double>(nearest[1]),
                                 static_cast<double>(nearest[2]));
      const Quad strength = Quad(s.units().coulomb_constant) * q[i] * q[j];
      for (int x = -images[0]; x <= images[0]; ++x) {
        for (int y = -images[1]; y <= images[1]; ++y) {
          for (int z = -images[2]; z <= images[2]; ++z) {
            const Vec3<double> image(x * edges[0], y * edges[1], z * edges[2]);
            if (norm2(Vec3<double>(rounded + image)) > 1.001 * split.cutoff * split.cutoff) continue;
            const Vec3<Quad> d = nearest + Vec3<Quad>(Quad(image[0]), Quad(image[1]), Quad(image[2]));
            const Quad r2 = norm2(d);
            if (!(r2 < reach2)) continue;
            const Quad r = sqrt(r2);
            const detail::ErfcTerms<Quad> terms = detail::erfc_terms(Quad(Quad(split.alpha) * r));
            forces[p] += strength * (terms.erfc / r + slope * terms.bell) / r2 * d;
          }
        }
      }
    }
  });
}

/// Takes out what the topology excludes or scales, of nearest images.
void take_out(const ParticleSystem<Quad>& s, const std::vector<Index>& on, std::vector<Vec3<Quad>>& forces) {
  if (s.topology() == nullptr) return;
  std::vector<std::ptrdiff_t> place(static_cast<std::size_t>(s.size()), -1);
  for (std::size_t p = 0; p < on.size(); ++p) place[static_cast<std::size_t>(on[p])] = static_cast<std::ptrdiff_t>(p);
  const auto& q = s.column<Charge>();
  const auto take = [&](const Topology::Pair& pair, double taken) {
    const auto [i, j] = pair;
    const std::ptrdiff_t pi = place[static_cast<std::size_t>(i)], pj = place[static_cast<std::size_t>(j)];
    if (pi < 0 && pj < 0) return;
    const Vec3<Quad> d = s.box().minimum_image(Vec3<Quad>(s.positions()[i] - s.positions()[j]));
    const Quad r2 = norm2(d);
    const Vec3<Quad> f = Quad(taken) * Quad(s.units().coulomb_constant) * q[i] * q[j] / (r2 * sqrt(r2)) * d;
    if (pi >= 0) forces[static_cast<std::size_t>(pi)] -= f;
    if (pj >= 0) forces[static_cast<std::size_t>(pj)] += f;
  };
  for (const Topology::Pair& pair : s.topology()->exclusions) take(pair, 1);
  for (const Topology::ScaledPair& scaled : s.topology()->scaled_pairs) take(scaled.pair, 1 - scaled.factor);
}

/// The charges that are asked.
std::vector<Index> asked_charges(const ParticleSystem<double>& s) {
  std::vector<Index> charged, asked;
  for (Index i = 0; i < s.size(); ++i) {
    if (s.column<Charge>()[i] != 0 && s.masses()[i] != 0) charged.push_back(i);
  }
  if (charged.size() <= most_all) return charged;
  constexpr double golden = 0.6180339887498949;  // places in no step with anything that repeats, such as molecules
  for (int k = 1; k <= sample; ++k) {
    const double place = golden * k - std::floor(golden * k);
    asked.push_back(charged[static_cast<std::size_t>(place * static_cast<double>(charged.size()))]);
  }
  return asked;
}

/// What a force says of itself, but for what it reaches.
std::optional<LatticeAccuracy> chosen_by(const AnyForce<double>& force, const ParticleSystem<double>& s,
                                         Index charged) {
  const detail::SplitErrors errors(s.box().volume(), charged);
  LatticeAccuracy made{.charged = charged};
  if (const auto* ewald = force.as<Ewald>()) {
    const Ewald chosen = ewald->chosen_for(s.box(), charged);
    made.asked = ewald->relative_error;
    made.alpha = *chosen.alpha;
    made.kmax = chosen.kmax;
    made.expected = std::hypot(errors.near(made.alpha, ewald->cutoff), errors.waves(made.alpha, *chosen.kmax));
    return made;
  }
  if (const auto* meshed = force.as<ParticleMeshEwald>()) {
    const detail::MeshLayout layout = meshed->layout_for(s, charged);
    Vec3<double> spacing;
    for (Index k = 0; k < 3; ++k)
      spacing[k] = layout.edges[k] / static_cast<double>(layout.points[static_cast<std::size_t>(k)]);
    made.asked = meshed->relative_error;
    made.alpha = layout.alpha;
    made.mesh = layout.points;
    made.order = layout.order;
    const double neighbor = std::cbrt(s.box().volume() / static_cast<double>(charged));
    made.expected = std::hypot(errors.near(layout.alpha, meshed->cutoff),
                               detail::mesh_error(layout.alpha, spacing, layout.order, neighbor));
    return made;
  }
  return {};
}

}  // namespace

std::vector<Vec3<double>> detail::exact_lattice_forces(const ParticleSystem<double>& s, const std::vector<Index>& on,
                                                       double error) {
  const CheapSplit split(s.box().volume(), charge_sums(s).charged, static_cast<Index>(on.size()), error);
  const ParticleSystem<Quad> wide = s.as<Quad>();
  std::vector<Vec3<Quad>> forces(on.size(), Vec3<Quad>(Vec3<Quad>::Zero()));
  add_near(wide, on, split, forces);
  add_waves(wide, on, split, forces);
  take_out(wide, on, forces);
  std::vector<Vec3<double>> rounded;
  for (const Vec3<Quad>& f : forces)
    rounded.emplace_back(static_cast<double>(f[0]), static_cast<double>(f[1]), static_cast<double>(f[2]));
  return rounded;
}

std::optional<LatticeAccuracy> lattice_accuracy(const AnyForce<double>& force, const ParticleSystem<double>& s) {
  if (!s.box().is_periodic() || !s.has<Charge>()) return {};
  const detail::ChargeSums<double> sums = detail::charge_sums(s);
  const std::vector<Index> asked = asked_charges(s);
  if (asked.empty()) return {};
  std::optional<LatticeAccuracy> made = chosen_by(force, s, sums.charged);
  if (!made) return {};
  VectorColumn<double> a(s.size());
  ForceSink<double> sink(a, s, {});
  force.add_to(sink, s);
  const std::vector<Vec3<double>> exact = detail::exact_lattice_forces(s, asked, std::min(1e-13, made->asked / 100));
  made->sampled = static_cast<Index>(asked.size());
  const double squares = sum_over<double>(made->sampled, [&](Index p) {
    const auto place = static_cast<std::size_t>(p);
    const Index i = asked[place];
    return norm2(Vec3<double>(s.masses()[i] * std::as_const(a)[i] - exact[place]));
  });
  const auto charged = static_cast<double>(sums.charged);
  const double unit =
      s.units().coulomb_constant * (sums.squares / charged) * std::pow(charged / s.box().volume(), 2.0 / 3);
  made->reached = std::sqrt(squares / static_cast<double>(asked.size())) / unit;
  return made;
}

}  // namespace noether
