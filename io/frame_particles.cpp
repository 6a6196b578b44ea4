#include "io/frame_particles.hpp"

#include "engine/bodies.hpp"
#include "engine/charge.hpp"
#include "io/files.hpp"
#include "io/sandbox.hpp"
#include "io/trajectory_bodies.hpp"
#include "io/trajectory_digest.hpp"
#include "io/trajectory_layout.hpp"
#include "io/trajectory_reader.hpp"
#include "io/trajectory_topology.hpp"
#include "numbers/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

namespace noether::io {

namespace {

/// A column of the file, all its rows.
struct StoredColumn {
  ColumnInfo info;
  std::vector<double> values;  ///< (n, width), row by row
};

/// What a frame and its file hold, as they hold it.
struct StoredFrame {
  std::int64_t number = 0;
  Index frames = 0;
  Frame frame;
  Frames shared;
  std::vector<Index> order;  ///< the row of each particle
  std::shared_ptr<const Topology> topology;
  std::shared_ptr<const Bodies> bodies;
  std::map<std::string, StoredColumn> columns;
  std::string sha256, scene_toml;
  bool knows_types = true;
};

/// The declaration of a column as far as the file tells it. Of a file from before dimensions were written its unit
/// stands for it.
ColumnInfo info_of(const Hdf5File& file, const std::string& path, const std::string& name, Index width) {
  ColumnInfo info{name, file.text_attribute(path, dimension_attribute), ColumnRole::parameter, static_cast<int>(width)};
  if (info.dimension.empty())
    info.dimension = name == Charge::name ? "charge" : file.text_attribute(path, "noether_unit");
  const std::string role = file.text_attribute(path, role_attribute);
  if (!role.empty()) info.role = role == "momentum" ? ColumnRole::momentum : ColumnRole::configuration;
  return info;
}

std::map<std::string, StoredColumn> stored_columns(const TrajectoryReader& reader, const Frame& frame) {
  const Hdf5File& file = reader.file();
  std::map<std::string, StoredColumn> all;
  for (const auto& [name, values] : frame.columns) {
    all[name] = {info_of(file, particles_path + "/" + name, name, reader.shared().columns.at(name).first), values};
  }
  const auto rows = static_cast<Index>(reader.shared().ids.size());
  for (const std::string& name : file.children(particles_path)) {
    const std::string path = particles_path + "/" + name;
    if (name == "id" || name == "mass" || name == "name" || name == "species" || file.is_group(path)) continue;
    const Hdf5Dataset dataset = file.open(path);
    const std::vector<Index> shape = dataset.shape();
    const Index width = shape.size() == 2 ? shape[1] : 1;
    if (shape.empty() || shape.size() > 2 || shape[0] != rows || width < 1 || width > 9)
      throw FileError(fmt::format("damaged: '{}' is not a column for {} particles", path, rows), {.file = file.name()});
    StoredColumn column{info_of(file, path, name, width), {}};
    if (dataset.type() == ElementType::integer) {
      for (const std::int64_t number : dataset.read_integers()) column.values.push_back(static_cast<double>(number));
    } else {
      column.values = dataset.read_reals();
    }
    all[name] = std::move(column);
  }
  return all;
}

void check_stored(const TrajectoryReader& reader, const StoredFrame& stored, const std::filesystem::path& path) {
  const auto refuse_frame = [&](const std::string& what) {
    throw FileError(fmt::format("{}; see 'noether verify' for what is intact in this file", what),
                    {.file = path.string()});
  };
  const auto written = reader.digest(stored.number);
  if (written && *written != frame_digest(stored.frame)) {
    refuse_frame(fmt::format("damaged: frame {} at step {} does not have the digest that was written with it",
                             stored.number, stored.frame.step));
  }
  const Hdf5File& file = reader.file();
  if (constants_differ(file))
    refuse_frame("damaged: the ids, names, masses, types, bonds or parameters differ from those that were written");
  for (const std::vector<double>* numbers :
       {&stored.frame.positions, &stored.frame.velocities, &stored.shared.masses}) {
    if (!std::all_of(numbers->begin(), numbers->end(), [](double x) { return std::isfinite(x); }))
      refuse_frame(fmt::format("damaged: frame {} at step {} is not finite", stored.number, stored.frame.step));
  }
}

/// The columns that rigid bodies have.
const std::vector<ColumnInfo>& columns_of_bodies() {
  static const std::vector<ColumnInfo> all = ColumnList<BodyInertia, BodyOrientation, BodySpin>::infos();
  return all;
}

/// Bodies have their columns, whose numbers are finite, and exactly they have moments; types of sites are there.
void check_columns_of_bodies(const StoredFrame& stored, const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& what) { throw FileError("damaged: " + what, {.file = path.string()}); };
  for (const ColumnInfo& wanted : columns_of_bodies()) {
    const auto found = stored.columns.find(wanted.name);
    if (found == stored.columns.end() || found->second.info.width != wanted.width)
      refuse(fmt::format("there are rigid bodies, but no column '{}' of {} numbers each", wanted.name, wanted.width));
    const std::vector<double>& values = found->second.values;
    if (!std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); }))
      refuse(fmt::format("column '{}' is not finite", wanted.name));
  }
  const std::vector<double>& inertia = stored.columns.at(std::string(BodyInertia::name)).values;
  for (std::size_t i = 0; i < stored.order.size(); ++i) {
    const auto row = 3 * static_cast<std::size_t>(stored.order[i]);
    const bool turns = inertia[row] > 0 || inertia[row + 1] > 0 || inertia[row + 2] > 0;
    if (turns == (stored.bodies->kind(static_cast<Index>(i)) != nullptr)) continue;
    refuse(fmt::format("particle {} has {}", i,
                       turns ? "moments of inertia, but is not a body" : "no moments of inertia"));
  }
  if (stored.topology == nullptr) return;
  for (const BodyKind& kind : stored.bodies->kinds) {
    for (const BodySite& site : kind.sites) {
      if (site.type >= stored.topology->type_count()) refuse(fmt::format("a site is of type {}", site.type));
    }
  }
}

/// A frame, the last where the number is not one of the file: the caller looks. @throws FileError
StoredFrame stored_frame(const std::filesystem::path& path, std::int64_t wanted) {
  const TrajectoryReader reader(path);
  if (!reader.shared().variable_names.empty()) {
    throw FileError("this is the run of a first-order system, which has no particles; give its variables in [system]",
                    {.file = path.string()});
  }
  StoredFrame stored;
  stored.frames = reader.frames();
  if (stored.frames == 0) {
    throw FileError(
        "there are no frames to start from; a run writes frames if its scene has [[every]] type = "
        "\"trajectory\"",
        {.file = path.string()});
  }
  const bool there = wanted >= 0 && wanted < stored.frames;
  stored.number = there ? wanted : stored.frames - 1;
  stored.frame = reader.frame(stored.number);
  stored.shared = reader.shared();
  stored.order = read_order(reader.file(), static_cast<Index>(stored.shared.ids.size()));
  stored.bodies = read_rigid_bodies(reader.file(), stored.order);
  stored.topology = read_topology(reader.file(), stored.shared.ids, stored.order);
  // Species without names of types were numbers of names.
  stored.knows_types = stored.topology != nullptr || !reader.file().has(particles_path + "/species");
  stored.columns = stored_columns(reader, stored.frame);
  if (stored.bodies != nullptr) check_columns_of_bodies(stored, path);
  check_stored(reader, stored, path);
  if (reader.file().has("/noether/scene")) stored.scene_toml = reader.file().read_text("/noether/scene");
  RunningDigest hash;
  hash.add(std::string_view("noether-bodies-1\n"));
  for (const std::int64_t number : frame_digest(stored.frame)) hash.add(number);
  hash.add(constants_digest(reader.file()));
  stored.sha256 = hash.hex();
  return stored;
}

template <class Number> Vec3<Number> row_of(const std::vector<Number>& numbers, Index row) {
  const auto at = 3 * static_cast<std::size_t>(row);
  return {numbers.at(at), numbers.at(at + 1), numbers.at(at + 2)};
}

/// Whether there are rigid bodies, though the file may not say what they are made of: they have all three columns.
bool has_rigid_bodies(const StoredFrame& stored) {
  return std::all_of(columns_of_bodies().begin(), columns_of_bodies().end(), [&](const ColumnInfo& one) {
    const auto found = stored.columns.find(one.name);
    return found != stored.columns.end() && found->second.info.width == one.width;
  });
}

/// Whether the new run has room for a column: the charge always, others where it declares them.
bool has_room_for(const ColumnInfo& info, const FrameOptions& options) {
  const auto is_it = [&](const ColumnInfo& one) { return one.name == info.name && one.width == info.width; };
  if (!options.columns || info.name == Charge::name) return true;
  return std::any_of(options.columns->begin(), options.columns->end(), is_it);
}

/// The declaration that the new run has, or else that of the file.
ColumnInfo declared(const ColumnInfo& info, const FrameOptions& options) {
  if (options.columns) {
    for (const ColumnInfo& one : *options.columns) {
      if (one.name == info.name && one.width == info.width) return one;
    }
  }
  return info.name == Charge::name && info.width == 1 ? column_info<Charge>() : info;
}

void give_columns(const StoredFrame& stored, const FrameOptions& options, FrameParticles& result) {
  ParticleSystem<double>& s = result.particles;
  const bool rigid = has_rigid_bodies(stored);
  result.lost_bodies = rigid && stored.bodies == nullptr;
  for (const auto& [name, column] : stored.columns) {
    const auto of_body = std::find_if(columns_of_bodies().begin(), columns_of_bodies().end(),
                                      [&, called = name](const ColumnInfo& one) { return one.name == called; });
    const bool is_of_body = rigid && of_body != columns_of_bodies().end();
    if (is_of_body ? stored.bodies == nullptr : !has_room_for(column.info, options)) {
      result.left_out.push_back(name);
      continue;
    }
    const ColumnInfo info = is_of_body ? *of_body : declared(column.info, options);
    s.add_column(info);
    const auto width = static_cast<std::size_t>(info.width);
    for (Index i = 0; i < s.size(); ++i) {
      const auto first =
          column.values.begin() +
          static_cast<std::ptrdiff_t>(width * static_cast<std::size_t>(stored.order[static_cast<std::size_t>(i)]));
      s.set_row(name, i, {first, first + static_cast<std::ptrdiff_t>(width)});
    }
  }
}

Box box_of_frame(const Frame& frame, const std::filesystem::path& path) {
  if (frame.edges.empty()) return Box::open();
  try {
    return Box::periodic(Vec3<double>(frame.edges[0], frame.edges[1], frame.edges[2]));
  } catch (const Error& error) {
    throw FileError(fmt::format("damaged: {}", error.message()), {.file = path.string()});
  }
}

void fill(const StoredFrame& stored, const FrameOptions& options, const std::filesystem::path& path,
          FrameParticles& result) {
  ParticleSystem<double>& s = result.particles;
  std::vector<std::int64_t> ids;
  for (const Index row : stored.order) {
    const auto at = static_cast<std::size_t>(row);
    s.add(stored.shared.names[at], stored.shared.masses[at], row_of(stored.frame.positions, row),
          row_of(stored.frame.velocities, row));
    ids.push_back(stored.shared.ids[at]);
  }
  s.trim();
  s.restore_ids(ids);
  give_columns(stored, options, result);
  s.set_box(box_of_frame(stored.frame, path));
  if (s.box().is_periodic()) {
    VectorColumn<std::int32_t> images(s.size());
    for (Index i = 0; i < s.size(); ++i)
      images.set(i, row_of(stored.frame.images, stored.order[static_cast<std::size_t>(i)]));
    s.restore_images(std::move(images));
  }
  s.set_topology(stored.topology);
  if (stored.bodies != nullptr) s.set_bodies(stored.bodies);
}

}  // namespace

bool is_hdf5(const std::filesystem::path& file) {
  if (file.extension() == ".h5" || file.extension() == ".hdf5") return true;
  std::error_code ignored;
  static constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  return std::filesystem::is_regular_file(file, ignored) && read_bytes(file, signature.size()) == signature;
}

FrameParticles read_frame_particles(const std::filesystem::path& file, const FrameOptions& options) {
  const std::int64_t wanted = options.frame.value_or(-1);
  const StoredFrame stored = try_first(file, [&] { return stored_frame(file, wanted); });
  const UnitSystem& units = known_units(stored.shared.units, file);
  if (options.units != nullptr && options.units->name != units.name) {
    throw Error(fmt::format("the particles of '{}' are in the units '{}', not '{}'; give units = \"{}\"",
                            file.filename().string(), units.name, options.units->name, units.name),
                {.file = file.string(), .key = "units", .value = std::string(options.units->name)});
  }
  if (wanted < -1 || wanted >= stored.frames) {
    throw Error(fmt::format("frame = {}, but '{}' has {} {}: {}, or -1 for the last", wanted, file.filename().string(),
                            stored.frames, stored.frames == 1 ? "frame" : "frames",
                            stored.frames == 1 ? "0" : fmt::format("0 to {}", stored.frames - 1)),
                {.file = file.string(), .key = "frame", .value = std::to_string(wanted)});
  }
  FrameParticles result{.particles = ParticleSystem<double>(units),
                        .frame = stored.number,
                        .step = stored.frame.step,
                        .time = stored.frame.time,
                        .sha256 = stored.sha256,
                        .scene_toml = stored.scene_toml,
                        .left_out = {},
                        .lost_bodies = false,
                        .knows_types = stored.knows_types};
  fill(stored, options, file, result);
  return result;
}

}  // namespace noether::io
