#include "io/trajectory.hpp"

#include "io/digest.hpp"
#include "io/hdf5_file.hpp"
#include "io/sandbox.hpp"
#include "io/trajectory_bodies.hpp"
#include "io/trajectory_constants.hpp"
#include "io/trajectory_datasets.hpp"
#include "io/trajectory_digest.hpp"
#include "io/trajectory_layout.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

namespace noether::io {

/// The file itself, shared by copies of the writer.
class TrajectoryWriter::File {
 public:
  /// @param one_frame  and no more: no room is kept for others
  File(std::filesystem::path path, TrajectoryOptions options, bool one_frame = false)
      : path_(std::move(path)), options_(std::move(options)), one_frame_(one_frame) {}

  File(const File&) = delete;
  File& operator=(const File&) = delete;
  /// A run that has ended well has been flushed; of one that has not, what can be saved is saved.
  ~File() {
    try {
      write_out();
    } catch (const Error&) {
    }
  }

  const std::filesystem::path& path() const { return path_; }

  void begin(const ParticleSystem<double>& state) {
    if (!hdf5_) return create(state);
    if (!bodies_known_) add_bodies(state);
  }

  /// A moment that has just been written is not written again: of a cadence in wall time a stop may be a look already.
  void observe(const ParticleSystem<double>& state, std::int64_t step, double time) {
    begin(state);
    if (options_.frames && !(wrote_ && now_.step == step && now_.time == time)) {
      match(state);
      write_frame(state, step, time);
      wrote_ = true;
    }
    flush_now_and_then();
  }

  void record(const Sample& sample) {
    if (!hdf5_) {
      waiting_.emplace_back(sample);
      return;
    }
    write_sample(sample);
    flush_now_and_then();
  }

  void flush() {
    write_out();
    if (hdf5_) hdf5_->flush();
    flushed_ = std::chrono::steady_clock::now();
  }

  void finish(const Outcome& outcome) {
    if (!hdf5_) return;
    hdf5_->set_attribute("/noether", "complete", std::int64_t{outcome.ok() ? 1 : 0});
    flush();
  }

  void save(SavedState& saved, const std::string& prefix) {
    std::vector<std::string> paths;
    std::vector<std::int64_t> rows;
    write_out();
    if (hdf5_) {
      for (const std::string& path : growing_paths()) {
        paths.push_back(path);
        rows.push_back(hdf5_->open(path).rows());
      }
    }
    save_value(saved, prefix + "/created", hdf5_.has_value());
    save_value(saved, prefix + "/dataset", paths);
    save_value(saved, prefix + "/rows", rows);
  }

  void load(const SavedState& saved, const std::string& prefix) {
    bool created = false;
    std::vector<std::string> paths;
    std::vector<std::int64_t> rows;
    load_value(saved, prefix + "/created", created);
    load_value(saved, prefix + "/dataset", paths);
    load_value(saved, prefix + "/rows", rows);
    close();
    if (!created || options_.lost) return;
    if (!std::filesystem::exists(path_)) {
      throw TrajectoryLost("the trajectory that the saved run continues is missing; bring it back, or start over",
                           {.file = path_.string()});
    }
    try {
      try_in_child(path_, [&] { File(path_, options_).rehearse(paths, rows); });
    } catch (const FileError& error) {
      // Nothing was written: what is wrong is wrong with the file, unless it is not ours.
      if (::access(path_.c_str(), R_OK | W_OK) != 0) throw;
      throw TrajectoryLost(error.message(), error.location());
    }
    hdf5_ = Hdf5File::open_to_append(path_);
    cut(paths, rows);
    // Space that was freed by cutting is not reused before the file has been closed.
    close();
    hdf5_ = Hdf5File::open_to_append(path_);
    open();
  }

 private:
  void write_out() {
    frame_.write_out();
    for (auto& [name, monitor] : monitors_) monitor.write_out();
  }

  void close() {
    frame_ = {};
    monitors_.clear();
    waiting_.clear();
    ids_.clear();
    variables_ = 0;
    periodic_ = wrote_ = bodies_known_ = false;
    hdf5_.reset();
  }

  void create(const ParticleSystem<double>& state) {
    units_ = &state.units();
    bodies_known_ = true;
    hdf5_ = Hdf5File::create(path_);
    write_header(*hdf5_, *units_, options_.scene_toml);
    if (state.variables().empty()) {
      match_order(state);
      periodic_ = state.box().is_periodic();
      write_constants(*hdf5_, state, order_);
      if (options_.frames) create_frames(state);
    } else {
      describe_system(state);
      if (options_.frames) create_system_frames();
    }
    for (const KeptSample& kept : std::exchange(waiting_, {})) write_sample(kept.sample());
    hdf5_->set_attribute("/noether", constants_attribute, constants_digest(*hdf5_));
    hdf5_->set_attribute("/noether", headers_attribute, headers_digest(*hdf5_));
    hdf5_->take_name();
  }

  /// A file from before it said what bodies are made of says so, if it is what was written.
  void add_bodies(const ParticleSystem<double>& state) {
    bodies_known_ = true;
    if (state.bodies() == nullptr || hdf5_->has(bodies_path + "/kind") || constants_differ(*hdf5_) ||
        hdf5_->text_attribute("/noether", headers_attribute) != headers_digest(*hdf5_)) {
      return;
    }
    match(state);
    write_rigid_bodies(*hdf5_, state, order_);
    hdf5_->set_attribute("/noether", constants_attribute, constants_digest(*hdf5_));
    hdf5_->set_attribute("/noether", headers_attribute, headers_digest(*hdf5_));
    flush();
  }

  void describe_system(const ParticleSystem<double>& state) {
    variables_ = static_cast<Index>(state.variables().size());
    hdf5_->make_group(system_path);
    hdf5_->set_attribute(system_path, "variables", std::int64_t{variables_});
    if (!state.variable_names().empty()) hdf5_->write(system_path + "/name", state.variable_names());
  }

  /// Position's values come first, step and time are shared by position and velocity.
  void create_frames(const ParticleSystem<double>& state) {
    const Index particles = state.size();
    const std::string position = particles_path + "/position";
    const std::string velocity = particles_path + "/velocity";
    const Index rows = rows_at_once(3 * particles, frame_bytes), few = rows_at_once(1, sample_bytes);
    frame_.position =
        BufferedDataset<double>(hdf5_->create_growing(position + "/value", ElementType::real, {particles, 3}, rows));
    frame_.velocity =
        BufferedDataset<double>(hdf5_->create_growing(velocity + "/value", ElementType::real, {particles, 3}, rows));
    frame_.step =
        BufferedDataset<std::int64_t>(hdf5_->create_growing(position + "/step", ElementType::integer, {}, few));
    frame_.time = BufferedDataset<double>(hdf5_->create_growing(position + "/time", ElementType::real, {}, few));
    hdf5_->link(position + "/step", velocity + "/step");
    hdf5_->link(position + "/time", velocity + "/time");
    if (periodic_) create_box_frames(particles, rows, few);
    for (const auto& column : state.columns()) {
      if (column.info.moves()) create_column_frames(column.info, particles);
    }
    if (options_.sites) {
      frame_.sites.create(*hdf5_, state, order_, [&](Index numbers) { return rows_at_once(numbers, frame_bytes); });
    }
    frame_.digest = create_digests(frame_digests_path);
    hdf5_->open(position + "/value").write_last();
    set_unit_of_motion(*hdf5_, position + "/value", "length", *units_);
    set_unit_of_motion(*hdf5_, velocity + "/value", "velocity", *units_);
    set_unit_of_motion(*hdf5_, position + "/time", "time", *units_);
  }

  Index rows_at_once(Index numbers, Index wanted) const { return one_frame_ ? 1 : rows_per_chunk(numbers, wanted); }

  BufferedDataset<std::int64_t> create_digests(const std::string& path) const {
    constexpr Index size = std::tuple_size_v<RowDigest>;
    return BufferedDataset<std::int64_t>(
        hdf5_->create_growing(path, ElementType::integer, {size}, rows_at_once(size, sample_bytes)));
  }
  /// Those of a file to go on with; none where it has none.
  std::optional<BufferedDataset<std::int64_t>> open_digests(const std::string& path) const {
    if (!hdf5_->has(path)) return {};
    return BufferedDataset<std::int64_t>(open(path, {Index{std::tuple_size_v<RowDigest>}}));
  }

  /// Edges of the box and images of the particles: a particle's unwrapped position is position + image * edges.
  void create_box_frames(Index particles, Index rows, Index few) {
    frame_.image = BufferedDataset<std::int64_t>(
        hdf5_->create_growing(image_path + "/value", ElementType::integer, {particles, 3}, rows));
    frame_.edges = BufferedDataset<double>(hdf5_->create_growing(edges_path + "/value", ElementType::real, {3}, few));
    for (const std::string& group : {image_path, edges_path}) {
      hdf5_->link(particles_path + "/position/step", group + "/step");
      hdf5_->link(particles_path + "/position/time", group + "/time");
    }
    set_unit(*hdf5_, edges_path + "/value", "length", *units_);
  }

  /// A column that moves beyond position and velocity, such as an orientation: shape (frames, n, width).
  void create_column_frames(const ColumnInfo& info, Index particles) {
    const std::string group = particles_path + "/" + info.name;
    frame_.columns[info.name] = BufferedDataset<double>(
        hdf5_->create_growing(group + "/value", ElementType::real, {particles, Index{info.width}},
                              rows_at_once(info.width * particles, frame_bytes)));
    hdf5_->link(particles_path + "/position/step", group + "/step");
    hdf5_->link(particles_path + "/position/time", group + "/time");
    hdf5_->set_attribute(group, role_attribute,
                         std::string(info.role == ColumnRole::momentum ? "momentum" : "configuration"));
    hdf5_->set_attribute(group, "noether_unit", unit_in_words(info.dimension, *units_));
    hdf5_->set_attribute(group, dimension_attribute, info.dimension);
    const std::string unit = h5md_unit(info.dimension, *units_);
    if (!unit.empty()) hdf5_->set_variable_text(group + "/value", "unit", unit);
  }

  void create_system_frames() {
    const Index rows = rows_at_once(variables_, frame_bytes), few = rows_at_once(1, sample_bytes);
    frame_.variables =
        BufferedDataset<double>(hdf5_->create_growing(system_path + "/value", ElementType::real, {variables_}, rows));
    frame_.step =
        BufferedDataset<std::int64_t>(hdf5_->create_growing(system_path + "/step", ElementType::integer, {}, few));
    frame_.time = BufferedDataset<double>(hdf5_->create_growing(system_path + "/time", ElementType::real, {}, few));
    frame_.digest = create_digests(frame_digests_path);
    hdf5_->open(system_path + "/value").write_last();
    set_unit_of_motion(*hdf5_, system_path + "/time", "time", *units_);
  }

  /// Makes ready to go on with an existing file.
  void open() {
    units_ = &known_units(hdf5_->text_attribute("/noether", "units"), path_);
    hdf5_->set_attribute("/noether", "complete", std::int64_t{0});
    // The end may have been moved.
    write_scene(*hdf5_, options_.scene_toml);
    if (hdf5_->has(system_path)) {
      variables_ = hdf5_->integer_attribute(system_path, "variables");
      if (options_.frames) open_system_frames();
    } else {
      sorted_ids_ = hdf5_->open(particles_path + "/id").read_integers();
      if (options_.frames) open_frames();
    }
  }

  void open_frames() {
    frame_.digest = open_digests(frame_digests_path);
    const auto particles = static_cast<Index>(sorted_ids_.size());
    frame_.position = BufferedDataset<double>(open(particles_path + "/position/value", {particles, 3}));
    frame_.velocity = BufferedDataset<double>(open(particles_path + "/velocity/value", {particles, 3}));
    frame_.step = BufferedDataset<std::int64_t>(open(particles_path + "/position/step", {}));
    frame_.time = BufferedDataset<double>(open(particles_path + "/position/time", {}));
    for (const std::string& name : moving_columns(*hdf5_)) {
      const std::string path = fmt::format("{}/{}/value", particles_path, name);
      const std::vector<Index> shape = hdf5_->open(path).growing_shape();
      frame_.columns[name] = BufferedDataset<double>(open(path, {particles, shape.back()}));
    }
    frame_.sites.open(*hdf5_, [&](const std::string& path, const auto& row) { return open(path, row); });
    periodic_ = hdf5_->has(image_path);
    if (!periodic_) return;
    frame_.image = BufferedDataset<std::int64_t>(open(image_path + "/value", {particles, 3}));
    frame_.edges = BufferedDataset<double>(open(edges_path + "/value", {3}));
  }

  void open_system_frames() {
    frame_.digest = open_digests(frame_digests_path);
    frame_.variables = BufferedDataset<double>(open(system_path + "/value", {variables_}));
    frame_.step = BufferedDataset<std::int64_t>(open(system_path + "/step", {}));
    frame_.time = BufferedDataset<double>(open(system_path + "/time", {}));
  }

  /// A dataset to go on with. @throws FileError if its rows are not what the run will add
  Hdf5Dataset open(const std::string& path, const std::vector<Index>& row) const {
    Hdf5Dataset dataset = hdf5_->open(path);
    const std::vector<Index> shape = dataset.growing_shape();
    if (is_leader(path)) dataset.write_last();
    if (std::equal(shape.begin() + 1, shape.end(), row.begin(), row.end())) return dataset;
    throw FileError(fmt::format("damaged: a row of '{}' has the shape ({}) where the run has ({})", path,
                                fmt::join(shape.begin() + 1, shape.end(), ", "), fmt::join(row, ", ")),
                    {.file = path_.string()});
  }

  /// Every dataset that grows, each once.
  std::vector<std::string> growing_paths() const {
    std::vector<std::string> paths;
    if (hdf5_->has(particles_path + "/position")) {
      paths = {particles_path + "/position/step", particles_path + "/position/time", particles_path + "/position/value",
               particles_path + "/velocity/value"};
    }
    if (hdf5_->has(image_path)) paths.insert(paths.end(), {image_path + "/value", edges_path + "/value"});
    for (const std::string& name : moving_columns(*hdf5_)) {
      paths.push_back(fmt::format("{}/{}/value", particles_path, name));
    }
    for (const std::string& path : growing_sites(*hdf5_)) paths.push_back(path);
    if (hdf5_->has(system_path + "/value")) {
      paths = {system_path + "/step", system_path + "/time", system_path + "/value"};
    }
    for (const std::string& monitor : hdf5_->children(monitors_path)) {
      const std::string group = monitors_path + "/" + monitor;
      for (const std::string& name : hdf5_->children(group)) paths.push_back(group + "/" + name);
      if (hdf5_->has(sample_digests_path(monitor))) paths.push_back(sample_digests_path(monitor));
    }
    if (hdf5_->has(frame_digests_path)) paths.push_back(frame_digests_path);
    return paths;
  }

  /// Cuts every dataset back to its saved length; those that came later become empty.
  void cut(const std::vector<std::string>& paths, const std::vector<std::int64_t>& rows) {
    hdf5_->begin_cut();
    for (const std::string& path : growing_paths()) {
      if (is_leader(path)) hdf5_->open(path).write_last();
      const auto found = std::find(paths.begin(), paths.end(), path);
      if (found == paths.end()) hdf5_->open(path).resize(0);
    }
    for (std::size_t k = 0; k < paths.size(); ++k) {
      Hdf5Dataset dataset = hdf5_->open(paths[k]);
      const Index held = dataset.rows(), wanted = rows.at(k);
      if (held < wanted) {
        throw FileError(fmt::format("'{}' holds {} rows where the saved run expects {}; the file was cut or replaced: "
                                    "bring it back, or start over",
                                    paths[k], held, wanted),
                        {.file = path_.string()});
      }
      // A torn header may have rows that were never written, which do not count.
      if (dataset.growing_shape().front() != wanted) dataset.resize(wanted);
    }
    flush();
  }

  /// Goes on with the file, without leaving a trace in it: its damage may be such that HDF5 crashes.
  void rehearse(const std::vector<std::string>& paths, const std::vector<std::int64_t>& rows) {
    static constexpr Index some_chunks = 1 << 14;
    hdf5_ = Hdf5File::open_to_rehearse(path_);
    cut(paths, rows);
    open();
    for (const std::string& path : growing_paths()) {
      Hdf5Dataset dataset = hdf5_->open(path);
      const std::vector<Index> shape = dataset.growing_shape();
      const Index row = std::accumulate(shape.begin() + 1, shape.end(), Index{1}, std::multiplies<>());
      const auto numbers = static_cast<std::size_t>(row * std::max<Index>(some_chunks / std::max<Index>(row, 1), 1));
      if (dataset.type() == ElementType::integer) {
        dataset.append(std::vector<std::int64_t>(numbers));
      } else {
        dataset.append(std::vector<double>(numbers));
      }
    }
    flush();
    close();
  }

  void match_order(const ParticleSystem<double>& state) {
    ids_ = state.ids();
    order_ = id_order(ids_);
    sorted_ids_.clear();
    for (const Index i : order_) sorted_ids_.push_back(ids_[static_cast<std::size_t>(i)]);
  }

  /// The particles must be those of the file, in any order, or there are as many variables as in the file.
  void match(const ParticleSystem<double>& state) {
    if (static_cast<Index>(state.variables().size()) != variables_) {
      throw FileError(
          fmt::format("the file has {} variables, but the run now has {}: a trajectory can contain only one system",
                      variables_, state.variables().size()),
          {.file = path_.string()});
    }
    if (state.ids() == ids_) return;
    const std::vector<std::int64_t> expected = sorted_ids_;
    match_order(state);
    if (sorted_ids_ == expected) return;
    throw FileError(fmt::format("the file has {} particles, but the run now has {}, or others: a trajectory can "
                                "contain only one set of particles; after an edit write another file",
                                expected.size(), ids_.size()),
                    {.file = path_.string()});
  }

  template <class Number, class Column> void gather(const Column& column, std::vector<Number>& row) const {
    row.clear();
    for (const Index i : order_) {
      for (int k = 0; k < 3; ++k) row.push_back(column.component(k)[i]);
    }
  }

  void write_frame(const ParticleSystem<double>& state, std::int64_t step, double time) {
    now_.step = step;
    now_.time = time;
    if (variables_ > 0) {
      now_.variables = state.variables();
      frame_.variables.append(now_.variables);
    } else {
      if (periodic_) write_box(state);
      write_columns(state);
      frame_.sites.append(state, order_, now_.sites);
      gather(state.velocities(), now_.velocities);
      frame_.velocity.append(now_.velocities);
      gather(state.positions(), now_.positions);
      frame_.position.append(now_.positions);
    }
    frame_.time.append(now_.time);
    frame_.step.append(now_.step);
    if (frame_.digest) frame_.digest->append(frame_digest(now_));
  }

  void write_box(const ParticleSystem<double>& state) {
    gather(state.images(), now_.images);
    now_.edges.assign(state.box().edges().data(), state.box().edges().data() + 3);
    frame_.image.append(std::vector<std::int64_t>(now_.images.begin(), now_.images.end()));
    frame_.edges.append(now_.edges);
  }

  /// @throws FileError  where the run moves other columns than the file has
  void write_columns(const ParticleSystem<double>& state) {
    if (frame_.columns.empty() && !state.columns().any_moves()) return;
    now_.columns = moving_columns(state, order_);
    for (const auto& [name, values] : now_.columns) {
      const auto found = frame_.columns.find(name);
      if (found == frame_.columns.end() || now_.columns.size() != frame_.columns.size()) {
        throw FileError(
            fmt::format("the file does not have the columns that the run changes, such as '{}': a trajectory can "
                        "contain only one kind of particles; after an edit write another file",
                        name),
            {.file = path_.string()});
      }
      found->second.append(values);
    }
  }

  void write_sample(const Sample& sample) {
    MonitorDatasets& monitor = datasets_of(sample);
    std::size_t k = 0;
    for (const Series& one : sample.series) monitor.quantities.at(k++).append(one.values);
    monitor.time.append(sample.time);
    monitor.step.append(sample.step);
    if (monitor.digest) {
      std::map<std::string, std::span<const double>, std::less<>> quantities;
      for (const Series& one : sample.series) quantities[one.name] = one.values;
      monitor.digest->append(sample_digest(sample.step, sample.time, quantities));
    }
    if (sample.scale && sample.scale != monitor.scale) {
      hdf5_->set_attribute(monitors_path + "/" + std::string(sample.monitor), "scale", *sample.scale);
      monitor.scale = sample.scale;
      if (hdf5_->has(sample_digests_path(sample.monitor))) write_headers_of(sample.monitor);
    }
  }

  MonitorDatasets& datasets_of(const Sample& sample) {
    const auto known = monitors_.find(sample.monitor);
    if (known != monitors_.end()) return known->second;
    MonitorDatasets& monitor = monitors_[std::string(sample.monitor)];
    const std::string group = fmt::format("{}/{}/", monitors_path, sample.monitor);
    const bool there = hdf5_->has(group + "step");
    const auto dataset = [&](const std::string& name, ElementType type, const std::vector<Index>& shape) {
      if (there) return open(group + name, shape);
      const Index values = std::accumulate(shape.begin(), shape.end(), Index{1}, std::multiplies<>());
      return hdf5_->create_growing(group + name, type, shape, rows_at_once(values, sample_bytes));
    };
    monitor.step = BufferedDataset<std::int64_t>(dataset("step", ElementType::integer, {}));
    monitor.time = BufferedDataset<double>(dataset("time", ElementType::real, {}));
    for (const Series& one : sample.series) {
      monitor.quantities.emplace_back(dataset(one.name, ElementType::real, one.shape));
    }
    const std::string digests = sample_digests_path(sample.monitor);
    if (there) {
      monitor.digest = open_digests(digests);
    } else {
      monitor.digest = create_digests(digests);
      describe_monitor(group, sample);
      write_headers_of(sample.monitor);
    }
    hdf5_->open(group + "step").write_last();
    return monitor;
  }

  void describe_monitor(const std::string& group, const Sample& sample) const {
    hdf5_->set_attribute(group + "time", "noether_unit", std::string(units_->time));
    for (const Series& one : sample.series) {
      hdf5_->set_attribute(group + one.name, "noether_unit", unit_in_words(one.dimension, *units_));
      if (!one.columns.empty()) hdf5_->set_attribute(group + one.name, "columns", one.columns);
      if (!one.orders.empty()) hdf5_->set_attribute(group + one.name, "orders", one.orders);
    }
  }

  void write_headers_of(std::string_view monitor) const {
    hdf5_->set_attribute(sample_digests_path(monitor), headers_attribute, monitor_headers_digest(*hdf5_, monitor));
  }

  /// A reader that follows the run sees it at most a second late.
  void flush_now_and_then() {
    if (std::chrono::steady_clock::now() - flushed_ > std::chrono::seconds(1)) flush();
  }

  std::filesystem::path path_;
  TrajectoryOptions options_;
  bool one_frame_;
  const UnitSystem* units_ = nullptr;
  std::optional<Hdf5File> hdf5_;
  FrameDatasets frame_;
  std::map<std::string, MonitorDatasets, std::less<>> monitors_;
  std::vector<KeptSample> waiting_;             ///< samples that came before the first look
  std::vector<std::int64_t> ids_, sorted_ids_;  ///< as the run has them, and as the file has them
  std::vector<Index> order_;
  Index variables_ = 0;                              ///< of a system without particles
  bool periodic_ = false;                            ///< frames have a box, and images of the particles
  Frame now_;                                        ///< the frame that is being written, or was the last
  bool wrote_ = false;                               ///< `now_` is in the file
  bool bodies_known_ = false;                        ///< the file says what bodies are made of, or there is no need
  std::chrono::steady_clock::time_point flushed_{};  ///< long ago: the first sample or frame goes out at once
};

TrajectoryWriter::TrajectoryWriter(std::filesystem::path file, TrajectoryOptions options)
    : held_(std::make_shared<File>(std::move(file), std::move(options))) {}

void TrajectoryWriter::at_start(const Snapshot<double>& now) { held_->begin(now.state()); }
void TrajectoryWriter::observe(const Snapshot<double>& now) { held_->observe(now.state(), now.step(), now.time()); }
void TrajectoryWriter::begin(const ParticleSystem<double>& state) { held_->begin(state); }
void TrajectoryWriter::record(const Sample& sample) { held_->record(sample); }
void TrajectoryWriter::flush() { held_->flush(); }
void TrajectoryWriter::finish(const Outcome& outcome) { held_->finish(outcome); }
void TrajectoryWriter::save(SavedState& saved, const std::string& prefix) const { held_->save(saved, prefix); }
void TrajectoryWriter::load(const SavedState& saved, const std::string& prefix) { held_->load(saved, prefix); }
const std::filesystem::path& TrajectoryWriter::file() const { return held_->path(); }

/// The one frame goes through the same hands as those of a run.
struct OneFrame {
  static void write(const std::filesystem::path& path, const TrajectoryOptions& options,
                    const ParticleSystem<double>& settled, std::int64_t step, double time) {
    TrajectoryWriter::File file(path, options, true);
    file.observe(settled, step, time);
    file.finish(Outcome{});
  }
};

void write_one_frame(const std::filesystem::path& file, const ParticleSystem<double>& settled, std::int64_t step,
                     double time, const TrajectoryOptions& options) {
  OneFrame::write(file, options, settled, step, time);
}

}  // namespace noether::io
