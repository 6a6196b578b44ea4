#include "forces/particle_mesh_ewald.hpp"

#include "forces/charge_mesh.hpp"
#include "forces/known_charges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

constexpr double most_points = 1e9, bytes_of_point = 28;

/// A mesh, and what it was chosen for.
struct KeptMesh {
  ParticleMeshEwald part;
  Vec3<double> edges = Vec3<double>::Zero();
  Index charged = 0;
  detail::MeshLayout layout;
  detail::ChargeTiles tiles;
  detail::ChargeMesh<double> mesh;
  detail::ChargeMesh<float> single_mesh;  ///< laid only in mixed precision

  bool is_for(const ParticleMeshEwald& other, const ParticleSystem<double>& s, Index count) const {
    return edges == s.box().edges() && charged == count && part.cutoff == other.cutoff &&
           part.relative_error == other.relative_error && part.order == other.order && part.alpha == other.alpha &&
           part.mesh_spacing == other.mesh_spacing && part.precision == other.precision;
  }
};

Vec3<double> spacing_of(const detail::MeshLayout& layout) {
  Vec3<double> spacing = layout.edges;
  for (Index k = 0; k < 3; ++k) spacing[k] /= static_cast<double>(layout.points[static_cast<std::size_t>(k)]);
  return spacing;
}
double single_error_of(const detail::MeshLayout& layout, double neighbor) {
  return detail::single_precision_error(layout.alpha, spacing_of(layout).minCoeff(), neighbor);
}
double neighbor_of(const ParticleSystem<double>& s, Index charged) {
  return std::cbrt(s.box().volume() / static_cast<double>(charged));
}
double error_of(const detail::MeshLayout& layout, double neighbor) {
  return detail::mesh_error(layout.alpha, spacing_of(layout), layout.order, neighbor);
}

}  // namespace

void ParticleMeshEwald::check() const {
  detail::check_split(cutoff, relative_error, alpha);
  detail::check_wave_kick(wave_kick);
  if (order && (*order < detail::least_order || *order > detail::largest_order)) {
    refuse_field("order", std::to_string(*order),
                 fmt::format("is not a valid order of splines; {} to {} is expected", detail::least_order,
                             detail::largest_order));
  }
  if (mesh_spacing && !(*mesh_spacing > 0 && *mesh_spacing < 1e100))
    refuse_field("mesh_spacing", *mesh_spacing, "is not a valid length; a length above 0 is expected");
}

void ParticleMeshEwald::check(const ParticleSystem<double>& s) const {
  check();
  detail::check_lattice(s.box().is_periodic(), s.has<Charge>(), describe().name);
  const Index charged = detail::charge_sums(s).charged;
  if (charged == 0) return;
  const detail::MeshLayout layout = layout_for(s, charged);
  double points = 1;
  for (const std::int64_t size : layout.points) points *= static_cast<double>(size);
  if (points > most_points) {
    throw Error(fmt::format(
        "the force '{}' would have a mesh of {:.2g} points, more than {:.0e}, in {:.2g} GB of memory; take a longer "
        "cutoff or a larger relative_error",
        describe().name, points, most_points, bytes_of_point * points / 1e9));
  }
  if (precision == PairPrecision::full) return;
  const double single = single_error_of(layout, neighbor_of(s, charged));
  if (single <= relative_error) return;
  refuse_field("relative_error", relative_error,
               fmt::format("is finer than forces in mixed precision are; {:.2g} or more is expected, or precision = "
                           "\"double\"",
                           single));
}

detail::MeshLayout ParticleMeshEwald::layout_for(const ParticleSystem<double>& s, Index charged) const {
  const detail::SplitErrors errors(s.box().volume(), charged);
  const double each = relative_error / std::sqrt(2.0);  // near part and waves have independent errors
  const double split = alpha.value_or(errors.alpha_for(each, cutoff)), neighbor = neighbor_of(s, charged);
  detail::MeshLayout best;
  double least = 0;
  for (int p = detail::least_order; p <= detail::largest_order; ++p) {
    if (order && p != *order) continue;
    detail::MeshLayout layout{.order = p, .alpha = split, .edges = s.box().edges()};
    const double spacing = mesh_spacing.value_or(detail::spacing_for(each, split, p, neighbor));
    double all = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double points =
          std::clamp(std::ceil(layout.edges[static_cast<Index>(k)] / spacing), static_cast<double>(p), 1e9);
      layout.points[k] = detail::quick_size(static_cast<std::int64_t>(points));
      all *= static_cast<double>(layout.points[k]);
    }
    if (mesh_spacing) {  // the lowest order that is good enough
      best = layout;
      if (!order && error_of(layout, neighbor) <= each) break;
      continue;
    }
    double work = detail::mesh_work(static_cast<double>(charged), all, p);
    if (precision == PairPrecision::mixed && single_error_of(layout, neighbor) > relative_error) work *= 1e10;
    if (best.order == 0 || work < least) {
      best = layout;
      least = work;
    }
  }
  return best;
}

std::optional<ChosenMesh> ParticleMeshEwald::chosen_for(const ParticleSystem<double>& s) const {
  const Index charged = detail::charge_sums(s).charged;
  if (charged == 0) return {};
  const detail::MeshLayout layout = layout_for(s, charged);
  const double neighbor = neighbor_of(s, charged);
  const bool mixed = precision == PairPrecision::mixed;
  return ChosenMesh{layout.alpha, layout.order, layout.points, error_of(layout, neighbor),
                    mixed ? single_error_of(layout, neighbor) : 0};
}

void ParticleMeshEwald::add_to(ForceSink<double>& out, const ParticleSystem<double>& s) const {
  const auto& known = detail::KnownCharges<double>::of(out.workspace(), s);
  const detail::ChargeSums<double>& sums = known.sums;
  if (sums.charged == 0) return;
  auto& own = out.workspace().get<KeptMesh>();
  if (!own.is_for(*this, s, sums.charged)) {
    own.layout = layout_for(s, sums.charged);
    own.part = *this;
    own.edges = s.box().edges();
    own.charged = sums.charged;
    own.tiles.lay(own.layout.points, own.layout.order - 1, sums.charged);
  }
  const detail::SplitParts wanted = detail::wanted_parts(out, wave_kick);
  const detail::ScreenedCharges near{own.layout.alpha, cutoff, 1e-4 * relative_error, precision};
  if (wanted.near) PairForce<detail::ScreenedCharges>{near}.add_to(out, s);
  if (!wanted.waves) return;
  const Spent spent("force", "particle_mesh_ewald waves");
  detail::add_self_energy(out, s, sums, near.alpha);
  detail::add_smooth_pairs(out, s, near);
  own.tiles.sort(s, known.charges.data());
  const bool all = out.wants_energy() || out.wants_virial();
  detail::MeshSums waves;
  const auto solve_on = [&](auto& mesh, detail::MeshSums* sums_of) {
    mesh.lay(own.layout);
    mesh.solve(own.tiles, known.strongest, s.units().coulomb_constant, sums_of);
  };
  if (precision == PairPrecision::mixed) {
    solve_on(own.single_mesh, nullptr);
    own.single_mesh.add_accelerations(out.accelerations(), s, own.tiles);
    if (all) solve_on(own.mesh, &waves);
  } else {
    solve_on(own.mesh, all ? &waves : nullptr);
    own.mesh.add_accelerations(out.accelerations(), s, own.tiles);
  }
  if (!all) return;
  out.energy(waves.energy);
  out.virial(waves.virial);
}

Ewald ParticleMeshEwald::reference() const {
  return Ewald{
      .cutoff = cutoff, .relative_error = std::min(relative_error, 1e-13), .alpha = alpha, .wave_kick = wave_kick};
}

template struct detail::ForceModel<ParticleMeshEwald, double>;

}  // namespace noether
