#include "forces/particle_mesh_ewald.hpp"

#include "forces/charge_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

constexpr double most_points = 1e9;

/// A mesh, and what it was chosen for.
struct ChosenMesh {
  ParticleMeshEwald part;
  Vec3<double> edges = Vec3<double>::Zero();
  Index charged = 0;
  detail::MeshLayout layout;
  detail::ChargeTiles tiles;
  detail::ChargeMesh<double> mesh;

  bool is_for(const ParticleMeshEwald& other, const ParticleSystem<double>& s, Index count) const {
    return edges == s.box().edges() && charged == count && part.cutoff == other.cutoff &&
           part.relative_error == other.relative_error && part.order == other.order && part.alpha == other.alpha &&
           part.mesh_spacing == other.mesh_spacing;
  }
};

}  // namespace

void ParticleMeshEwald::check() const {
  detail::check_split(cutoff, relative_error, alpha);
  detail::check_wave_kick(wave_kick);
  if (order < detail::least_order || order > detail::largest_order) {
    refuse_field("order", std::to_string(order),
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
  if (points <= most_points) return;
  throw Error(
      fmt::format("the force '{}' would have a mesh of {:.2g} points, more than {:.0e}; take a longer cutoff or "
                  "a larger relative_error",
                  describe().name, points, most_points));
}

detail::MeshLayout ParticleMeshEwald::layout_for(const ParticleSystem<double>& s, Index charged) const {
  const detail::SplitErrors errors(s.box().volume(), charged);
  const double each = relative_error / std::sqrt(2.0);  // near part and waves have independent errors
  detail::MeshLayout layout{.order = static_cast<int>(order),
                            .alpha = alpha.value_or(errors.alpha_for(each, cutoff)),
                            .edges = s.box().edges()};
  const double neighbor = std::cbrt(s.box().volume() / static_cast<double>(charged));
  const double spacing = mesh_spacing.value_or(detail::spacing_for(each, layout.alpha, layout.order, neighbor));
  for (std::size_t k = 0; k < 3; ++k) {
    const double points = std::clamp(std::ceil(layout.edges[static_cast<Index>(k)] / spacing), 1.0, 1e9);
    layout.points[k] = detail::quick_size(std::max<std::int64_t>(order, static_cast<std::int64_t>(points)));
  }
  return layout;
}

void ParticleMeshEwald::add_to(ForceSink<double>& out, const ParticleSystem<double>& s) const {
  const detail::ChargeSums<double> sums = detail::charge_sums(s);
  if (sums.charged == 0) return;
  auto& own = out.workspace().get<ChosenMesh>();
  if (!own.is_for(*this, s, sums.charged)) {
    own.layout = layout_for(s, sums.charged);
    own.part = *this;
    own.edges = s.box().edges();
    own.charged = sums.charged;
    own.mesh.lay(own.layout);
    own.tiles.lay(own.layout.points, own.layout.order - 1, s.size());
  }
  const detail::SplitParts wanted = detail::wanted_parts(out, wave_kick);
  if (wanted.near) PairForce<detail::ScreenedCharges>{{own.layout.alpha, cutoff}}.add_to(out, s);
  if (!wanted.waves) return;
  const Spent spent("force", "particle_mesh_ewald waves");
  detail::add_self_energy(out, s, sums, own.layout.alpha);
  detail::add_smooth_pairs(out, s, own.layout.alpha);
  const double* const q = s.column<Charge>().data();
  const double strongest = std::sqrt(detail::strongest_product(s) / s.units().coulomb_constant);
  own.tiles.sort(s, q);
  const bool all = out.wants_energy() || out.wants_virial();
  detail::MeshSums waves;
  own.mesh.solve(own.tiles, strongest, s.units().coulomb_constant, all ? &waves : nullptr);
  own.mesh.add_accelerations(out.accelerations(), s, own.tiles);
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
