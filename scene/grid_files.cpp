#include "scene/grid_files.hpp"

#include "io/hdf5_file.hpp"
#include "scene/reader.hpp"

#include <fmt/format.h>

#include <array>
#include <span>
#include <string>
#include <vector>

namespace noether {

namespace {

std::array<double, 3> triple(const io::Hdf5File& file, const std::string& name) {
  const std::vector<double> values = file.open("/" + name).read_reals();
  if (values.size() != 3) throw Error(fmt::format("its '{}' has {} numbers; three are expected", name, values.size()));
  return {values[0], values[1], values[2]};
}

FieldGrid read_grid(const std::filesystem::path& path) {
  const io::Hdf5File file = io::Hdf5File::open_to_read(path);
  for (const char* name : {"/origin", "/spacing"}) {
    if (!file.has(name)) throw Error(fmt::format("it has no dataset '{}'", name + 1));
  }
  FieldGrid grid;
  grid.origin = triple(file, "origin");
  grid.spacing = triple(file, "spacing");
  const auto read = [&](const std::string& name, std::size_t axes) {
    std::vector<double> values;
    if (!file.has("/" + name)) return values;
    const io::Hdf5Dataset dataset = file.open("/" + name);
    const std::vector<Index> shape = dataset.shape();
    const bool fits = shape.size() == axes && (axes == 3 || shape[3] == 3);
    const std::array<Index, 3> counts = fits ? std::array<Index, 3>{shape[0], shape[1], shape[2]} : grid.counts;
    if (!fits || (grid.counts[0] != 0 && counts != grid.counts)) {
      throw Error(fmt::format("its '{}' has the shape [{}]; [nx, ny, nz{}] is expected, the same for all", name,
                              fmt::join(shape, ", "), axes == 4 ? ", 3" : ""));
    }
    grid.counts = counts;
    return dataset.read_reals();
  };
  grid.A = read("A", 4);
  grid.B = read("B", 4);
  grid.phi = read("phi", 3);
  grid.check();
  return grid;
}

}  // namespace

void read_files(GridField& field, TableReader& reader) {
  std::filesystem::path path = field.file;
  if (path.is_relative()) path = std::filesystem::path(reader.context().source.file).parent_path() / path;
  try {
    field.grid = std::make_shared<const FieldGrid>(read_grid(path));
  } catch (const Error& error) {
    reader.fail("file", fmt::format("{} is not a field on a grid: {}", field.file, error.message()));
  }
  if (reader.context().notes == nullptr || field.grid->B.empty()) return;
  if (const double divergence = field.divergence(); divergence > 0) {
    reader.context().notes->push_back(fmt::format(
        "{} has B alone: between its places div B is up to {:.1e} of |B| over a spacing; with A it would be 0",
        field.file, divergence));
  }
}

void write_field_grid(const std::filesystem::path& path, const FieldGrid& grid) {
  grid.check();
  const io::Hdf5File file = io::Hdf5File::create(path);
  file.write("/origin", std::span<const double>(grid.origin), {3});
  file.write("/spacing", std::span<const double>(grid.spacing), {3});
  const std::vector<Index> shape = {grid.counts[0], grid.counts[1], grid.counts[2]},
                           of_vectors = {shape[0], shape[1], shape[2], 3};
  if (!grid.A.empty()) file.write("/A", std::span<const double>(grid.A), of_vectors);
  if (!grid.B.empty()) file.write("/B", std::span<const double>(grid.B), of_vectors);
  if (!grid.phi.empty()) file.write("/phi", std::span<const double>(grid.phi), shape);
  file.take_name();
}

}  // namespace noether
