#include "cli/explain_mesh.hpp"

#include "forces/particle_mesh_ewald.hpp"

#include <fmt/format.h>

#include <optional>

namespace noether {

namespace {

struct MeshInUse {
  std::string force;
  std::optional<ChosenMesh> mesh;  ///< none without charges
};

std::optional<MeshInUse> mesh_of(const Scene& scene) {
  for (const SceneForce& one : scene.hamiltonian.forces) {
    if (const auto* force = one.force.as<ParticleMeshEwald>())
      return MeshInUse{one.name, force->chosen_for(scene.particles)};
  }
  return {};
}

}  // namespace

std::string mesh_text(const Scene& scene) {
  const std::optional<MeshInUse> used = mesh_of(scene);
  if (!used) return "";
  if (!used->mesh) return fmt::format("mesh: no particle has a charge, and {} costs nothing", used->force);
  const ChosenMesh& mesh = *used->mesh;
  const std::string unit = scene.units->is_reduced() ? "" : fmt::format(" per {}", scene.units->length);
  return fmt::format(
      "mesh: {} x {} x {} points and splines of order {}, 1/r split at alpha = {:.6g}{}; root mean square error of "
      "forces "
      "{:.2g} from the mesh{}, in the unit of relative_error",
      mesh.points[0], mesh.points[1], mesh.points[2], mesh.order, mesh.alpha, unit, mesh.error,
      mesh.rounding > 0 ? fmt::format(" and up to {:.2g} from single precision", mesh.rounding) : "");
}

Json mesh_json(const Scene& scene) {
  const std::optional<MeshInUse> used = mesh_of(scene);
  if (!used || !used->mesh) return {};
  const ChosenMesh& mesh = *used->mesh;
  std::vector<Json> points;
  for (const std::int64_t size : mesh.points) points.emplace_back(size);
  return Json::object({{"force", used->force},
                       {"points", Json::list(points)},
                       {"order", std::int64_t{mesh.order}},
                       {"alpha", mesh.alpha},
                       {"error", mesh.error},
                       {"rounding", mesh.rounding}});
}

}  // namespace noether
