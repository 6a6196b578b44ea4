#include "io/trajectory_reader.hpp"

#include "io/trajectory_digest.hpp"
#include "io/trajectory_layout.hpp"
#include "io/trajectory_sites.hpp"
#include "io/trajectory_topology.hpp"
#include "numbers/error.hpp"
#include "numbers/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace noether::io {

namespace {

/// The unit of a dataset. What H5MD calls `unit` is for others to read: it follows from the unit system.
std::string unit_at(const Hdf5File& file, const std::string& path, const Dimension& dimension,
                    const UnitSystem& units) {
  const std::string own = file.text_attribute(path, "noether_unit");
  return own.empty() ? unit_of(dimension, units) : own;
}

}  // namespace

TrajectoryReader::TrajectoryReader(const std::filesystem::path& path) : file_(Hdf5File::open_to_read(path)) {
  of_system_ = file_.has(system_path);
  if (!file_.has("/h5md") || !file_.has("/noether") || !(of_system_ || file_.has(particles_path + "/id"))) {
    throw FileError("this is not a trajectory of noether: '/h5md', '/particles/system' and '/noether' are expected",
                    {.file = path.string()});
  }
  shared_.units = file_.text_attribute("/noether", "units");
  if (of_system_) {
    open_system(path);
  } else {
    open_particles(path);
  }
  if (!file_.has(frame_digests_path)) return;
  digests_ = file_.open(frame_digests_path);
  if (digests_->shape().size() != 2 || digests_->shape()[1] != std::tuple_size_v<RowDigest>)
    throw FileError("damaged: digests of frames are not 32 bytes each", {.file = path.string()});
  frames_ = std::min(frames_, digests_->rows());
}

void TrajectoryReader::open_system(const std::filesystem::path& path) {
  const std::int64_t n = file_.integer_attribute(system_path, "variables");
  static constexpr std::int64_t believable = std::int64_t{1} << 32U;
  if (n < 1 || n > believable) {
    throw FileError(fmt::format("damaged: a system of {} variables", n), {.file = path.string()});
  }
  if (file_.has(system_path + "/name")) {
    shared_.variable_names = file_.open(system_path + "/name").read_texts();
    if (static_cast<std::int64_t>(shared_.variable_names.size()) != n) {
      throw FileError(fmt::format("damaged: {} variables have {} names", n, shared_.variable_names.size()),
                      {.file = path.string()});
    }
  }
  if (file_.has(system_path + "/value")) {
    variables_ = file_.open(system_path + "/value");
    if (variables_.shape().size() != 2 || variables_.shape()[1] != n) {
      throw FileError(fmt::format("damaged: frames of {} variables do not have {} numbers each", n, n),
                      {.file = path.string()});
    }
    steps_ = file_.open(system_path + "/step").read_integers();
    times_ = file_.open(system_path + "/time").read_reals();
    shared_.time_unit = unit_at(file_, system_path + "/time", dimensions::time, known_units(shared_.units, path));
    frames_ = std::min({variables_.rows(), static_cast<Index>(steps_.size()), static_cast<Index>(times_.size())});
  }
  for (std::int64_t i = static_cast<std::int64_t>(shared_.variable_names.size()); i < n; ++i) {
    shared_.variable_names.push_back(fmt::format("y[{}]", i));
  }
}

void TrajectoryReader::open_particles(const std::filesystem::path& path) {
  shared_.ids = file_.open(particles_path + "/id").read_integers();
  shared_.names = file_.open(particles_path + "/name").read_texts();
  shared_.masses = file_.open(particles_path + "/mass").read_reals();
  const Index n = static_cast<Index>(shared_.ids.size());
  if (shared_.names.size() != shared_.ids.size() || shared_.masses.size() != shared_.ids.size()) {
    throw FileError("damaged: ids, names and masses differ in number", {.file = path.string()});
  }
  shared_.types = read_type_names(file_, n);
  if (file_.has(particles_path + "/charge")) shared_.charges = file_.open(particles_path + "/charge").read_reals();
  if (!shared_.charges.empty() && shared_.charges.size() != shared_.ids.size())
    throw FileError("damaged: ids and charges differ in number", {.file = path.string()});
  if (!file_.has(particles_path + "/position")) return;
  position_ = file_.open(particles_path + "/position/value");
  velocity_ = file_.open(particles_path + "/velocity/value");
  periodic_ = file_.has(image_path + "/value");
  if (periodic_) {
    image_ = file_.open(image_path + "/value");
    edges_ = file_.open(edges_path + "/value");
    if (edges_.shape().size() != 2 || edges_.shape()[1] != 3) {
      throw FileError("damaged: the edges of the box are not 3 in each frame", {.file = path.string()});
    }
  }
  for (const Hdf5Dataset* dataset : {&position_, &velocity_, periodic_ ? &image_ : &position_}) {
    const std::vector<Index> shape = dataset->shape();
    if (shape.size() != 3 || shape[1] != n || shape[2] != 3) {
      throw FileError(
          fmt::format("damaged: positions, velocities or images of {} particles do not have the shape ({}, 3)", n, n),
          {.file = path.string()});
    }
  }
  open_columns(path);
  open_sites(path);
  steps_ = file_.open(particles_path + "/position/step").read_integers();
  times_ = file_.open(particles_path + "/position/time").read_reals();
  const UnitSystem& units = known_units(shared_.units, path);
  shared_.length_unit = unit_at(file_, particles_path + "/position/value", dimensions::length, units);
  shared_.velocity_unit = unit_at(file_, particles_path + "/velocity/value", dimensions::velocity, units);
  shared_.time_unit = unit_at(file_, particles_path + "/position/time", dimensions::time, units);
  frames_ = std::min(
      {position_.rows(), velocity_.rows(), static_cast<Index>(steps_.size()), static_cast<Index>(times_.size())});
  if (periodic_) frames_ = std::min({frames_, image_.rows(), edges_.rows()});
  for (const auto& [name, column] : columns_) frames_ = std::min(frames_, column.rows());
  for (const auto& [name, dataset] : sites_) frames_ = std::min(frames_, dataset.rows());
}

void TrajectoryReader::open_columns(const std::filesystem::path& path) {
  const Index n = static_cast<Index>(shared_.ids.size());
  for (const std::string& name : moving_columns(file_)) {
    const std::string group = particles_path + "/" + name;
    Hdf5Dataset column = file_.open(group + "/value");
    const std::vector<Index> shape = column.shape();
    if (shape.size() != 3 || shape[1] != n || shape[2] < 1 || shape[2] > 9) {
      throw FileError(
          fmt::format("damaged: column '{}' of {} particles does not have the shape ({}, 1 to 9)", name, n, n),
          {.file = path.string()});
    }
    shared_.columns[name] = {shape[2], file_.text_attribute(group, "noether_unit")};
    columns_.emplace(name, std::move(column));
  }
}

void TrajectoryReader::open_sites(const std::filesystem::path& path) {
  if (!file_.has(sites_path + "/id")) return;
  site_count_ = file_.open(sites_path + "/id").rows();
  for (const std::string& name : growing_sites(file_)) {
    Hdf5Dataset dataset = file_.open(name);
    const std::vector<Index> shape = dataset.shape();
    if (shape.size() != 3 || shape[1] != site_count_ || shape[2] != 3) {
      throw FileError(
          fmt::format("damaged: '{}' of {} sites does not have the shape ({}, 3)", name, site_count_, site_count_),
          {.file = path.string()});
    }
    sites_.emplace(name, std::move(dataset));
  }
  if (sites_.size() != (periodic_ ? 3U : 2U))
    throw FileError("damaged: positions, velocities or images of sites are missing", {.file = path.string()});
}

std::optional<RowDigest> TrajectoryReader::digest(Index k) const {
  if (!digests_) return {};
  const std::vector<std::int64_t> row = digests_->read_integers(k, 1);
  RowDigest digest{};
  std::copy(row.begin(), row.end(), digest.begin());
  return digest;
}

Frame TrajectoryReader::frame(Index k) const {
  const auto at = static_cast<std::size_t>(k);
  if (of_system_) return {steps_.at(at), times_.at(at), {}, {}, variables_.read_reals(k, 1), {}, {}};
  Frame frame{steps_.at(at), times_.at(at), position_.read_reals(k, 1), velocity_.read_reals(k, 1), {}, {}, {}};
  if (periodic_) {
    for (const std::int64_t image : image_.read_integers(k, 1))
      frame.images.push_back(static_cast<std::int32_t>(image));
    frame.edges = edges_.read_reals(k, 1);
  }
  for (const auto& [name, column] : columns_) frame.columns[name] = column.read_reals(k, 1);
  if (sites_.empty()) return frame;
  frame.sites.positions = sites_.at(sites_path + "/position/value").read_reals(k, 1);
  frame.sites.velocities = sites_.at(sites_path + "/velocity/value").read_reals(k, 1);
  if (!periodic_) return frame;
  for (const std::int64_t image : sites_.at(sites_path + "/image/value").read_integers(k, 1))
    frame.sites.images.push_back(static_cast<std::int32_t>(image));
  return frame;
}

std::vector<std::pair<std::string, Index>> TrajectoryReader::lengths() const {
  std::vector<std::pair<std::string, Index>> all;
  if (file_.has(system_path + "/value")) {
    all = {{system_path + "/value", variables_.rows()},
           {system_path + "/step", static_cast<Index>(steps_.size())},
           {system_path + "/time", static_cast<Index>(times_.size())}};
    if (digests_) all.emplace_back(frame_digests_path, digests_->rows());
    return all;
  }
  if (!file_.has(particles_path + "/position")) return {};
  all = {{particles_path + "/position/value", position_.rows()},
         {particles_path + "/velocity/value", velocity_.rows()},
         {particles_path + "/position/step", static_cast<Index>(steps_.size())},
         {particles_path + "/position/time", static_cast<Index>(times_.size())}};
  if (periodic_) {
    all.emplace_back(image_path + "/value", image_.rows());
    all.emplace_back(edges_path + "/value", edges_.rows());
  }
  for (const auto& [name, column] : columns_) {
    all.emplace_back(fmt::format("{}/{}/value", particles_path, name), column.rows());
  }
  for (const auto& [name, dataset] : sites_) all.emplace_back(name, dataset.rows());
  if (digests_) all.emplace_back(frame_digests_path, digests_->rows());
  return all;
}

}  // namespace noether::io
