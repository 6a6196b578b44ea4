#include "io/vtu.hpp"

#include "engine/mesh.hpp"
#include "io/files.hpp"
#include "io/trajectory_topology.hpp"

#include <fmt/format.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>

namespace noether::io {

namespace {

constexpr int vtk_vertex = 1, vtk_tetrahedron = 10;

/// A text of XML without the characters that mean something in it.
std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  }
  return safe;
}

class VtuText {
 public:
  VtuText(const Frames& shared, const Mesh* mesh) : shared_(shared), mesh_(mesh) {}

  std::string of(const Frame& frame) {
    text_.clear();
    const std::size_t points = shared_.ids.size(), cells = mesh_ != nullptr ? mesh_->tetrahedra.size() : points;
    add("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
        "<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n",
        points, cells);
    reals(label("position", shared_.length_unit), 3, frame.positions);
    add("</Points>\n<PointData>\n");
    reals(label("velocity", shared_.velocity_unit), 3, frame.velocities);
    reals("mass", 1, shared_.masses);
    whole("id", "Int64", points, [&](std::size_t i) { return shared_.ids[i]; });
    add("</PointData>\n<CellData>\n");
    if (mesh_ != nullptr) {
      whole("region", "Int32", cells, [&](std::size_t k) { return mesh_->tetrahedra[k].type; });
      reals("volume_ratio", 1, volume_ratios(frame));
    }
    add("</CellData>\n<Cells>\n");
    add_cells(cells);
    add("</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
    return fmt::to_string(text_);
  }

 private:
  template <class... Arguments> void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Arguments>(arguments)...);
  }
  static std::string label(const std::string& name, const std::string& unit) {
    return unit.empty() || unit == "1" ? name : fmt::format("{} [{}]", name, unit);
  }
  void reals(const std::string& name, std::size_t width, const std::vector<double>& values) {
    add("<DataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">\n", escaped(name), width);
    for (std::size_t k = 0; k < values.size(); ++k) add("{:.17g}{}", values[k], (k + 1) % width == 0 ? '\n' : ' ');
    add("</DataArray>\n");
  }
  template <class Value> void whole(const char* name, const char* type, std::size_t count, const Value& value) {
    add("<DataArray type=\"{}\" Name=\"{}\" format=\"ascii\">\n", type, name);
    for (std::size_t k = 0; k < count; ++k) add("{}{}", value(k), (k + 1) % 16 == 0 || k + 1 == count ? '\n' : ' ');
    add("</DataArray>\n");
  }
  void add_cells(std::size_t cells) {
    const std::size_t corners = mesh_ != nullptr ? 4 : 1;
    whole("connectivity", "Int64", corners * cells, [&](std::size_t k) {
      return mesh_ != nullptr ? static_cast<std::int64_t>(mesh_->tetrahedra[k / 4].particles[k % 4])
                              : static_cast<std::int64_t>(k);
    });
    whole("offsets", "Int64", cells, [&](std::size_t k) { return corners * (k + 1); });
    whole("types", "UInt8", cells, [&](std::size_t) { return mesh_ != nullptr ? vtk_tetrahedron : vtk_vertex; });
  }
  std::vector<double> volume_ratios(const Frame& frame) const {
    Mesh moved;
    for (std::size_t i = 0; i < shared_.ids.size(); ++i) {
      moved.rest.emplace_back(frame.positions[3 * i], frame.positions[3 * i + 1], frame.positions[3 * i + 2]);
    }
    std::vector<double> ratios;
    for (const BondedTerm<4>& element : mesh_->tetrahedra) {
      ratios.push_back(moved.sixfold_volume(element) / mesh_->sixfold_volume(element));
    }
    return ratios;
  }

  const Frames& shared_;
  const Mesh* mesh_;
  fmt::memory_buffer text_;
};

}  // namespace

Index write_vtu(const TrajectoryReader& reader, const std::filesystem::path& out) {
  const auto rows = static_cast<Index>(reader.shared().ids.size());
  std::vector<Index> in_rows(static_cast<std::size_t>(rows));  // frames have their particles in the order of ids
  for (Index k = 0; k < rows; ++k) in_rows[static_cast<std::size_t>(k)] = k;
  const std::shared_ptr<const Topology> topology = read_topology(reader.file(), reader.shared().ids, in_rows);
  VtuText text(reader.shared(), topology != nullptr ? topology->mesh.get() : nullptr);
  const auto write_grid = [](const std::filesystem::path& file, const std::string& grid) {
    write_text_file(file, [&](std::ofstream& target) { target << grid; });
  };
  const Index frames = reader.frames();
  if (frames == 1) {
    write_grid(out, text.of(reader.frame(0)));
    return 1;
  }
  std::string collection = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
  for (Index k = 0; k < frames; ++k) {
    const Frame frame = reader.frame(k);
    const std::string name = fmt::format("{}_{:04}.vtu", out.stem().string(), k);
    write_grid(out.parent_path() / name, text.of(frame));
    collection.append(fmt::format("<DataSet timestep=\"{:.17g}\" file=\"{}\"/>\n", frame.time, escaped(name)));
  }
  write_grid(std::filesystem::path(out).replace_extension(".pvd"), collection + "</Collection>\n</VTKFile>\n");
  return frames;
}

}  // namespace noether::io
