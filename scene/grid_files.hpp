#pragma once
/// Files of fields on grids, as scenes name them.

#include "forces/grid_field.hpp"

#include <filesystem>

namespace noether {

class TableReader;

/// Reads the grid that a field names, relative to the folder of the scene.
/// @throws SceneError  for a file that is missing or damaged, lacks datasets, or has shapes that do not fit
void read_files(GridField& field, TableReader& reader);

/// Writes a grid as such a file. @throws FileError
void write_field_grid(const std::filesystem::path& file, const FieldGrid& grid);

}  // namespace noether
