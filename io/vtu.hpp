#pragma once
/// Frames for ParaView and its like: unstructured grids of VTK, in XML and ASCII.

#include "io/trajectory_reader.hpp"

#include <filesystem>

namespace noether::io {

/// Writes every frame as a grid: particles as points, with velocities, ids and masses; tetrahedra of a mesh as cells,
/// with their region and their volume over that at rest; where there is no mesh, each particle is a cell.
///
/// One frame becomes `out`, several become OUT_0000.vtu, OUT_0001.vtu and so on, with OUT.pvd beside them, which names
/// them with their times.
/// @return the number of frames
/// @throws FileError
Index write_vtu(const TrajectoryReader& reader, const std::filesystem::path& out);

}  // namespace noether::io
