#pragma once
/// Which groups of run.h5 hold what stands there once.

#include "io/trajectory_bodies.hpp"
#include "io/trajectory_layout.hpp"
#include "io/trajectory_topology.hpp"

#include <string>
#include <vector>

namespace noether::io {

/// Their datasets stand once, all that do not grow: of particles, systems, bonded terms, bodies and their sites.
inline const std::vector<std::string>& constant_groups() {
  static const std::vector<std::string> groups = {particles_path, system_path, connectivity_path,
                                                  topology_path,  bodies_path, sites_path};
  return groups;
}

}  // namespace noether::io
