#include "io/trajectory_digest.hpp"

#include "io/trajectory_groups.hpp"
#include "io/trajectory_layout.hpp"
#include "io/trajectory_topology.hpp"
#include "numbers/error.hpp"

#include <utility>

namespace noether::io {

namespace {

void add_values(RunningDigest& hash, const Hdf5Dataset& dataset) {
  switch (dataset.type()) {
    case ElementType::real:
      hash.add(std::span<const double>(dataset.read_reals()));
      break;
    case ElementType::integer:
      hash.add(std::span<const std::int64_t>(dataset.read_integers()));
      break;
    case ElementType::text:
      for (const std::string& text : dataset.read_texts()) hash.add(text + '\n');
      break;
    case ElementType::other:
      hash.add(std::string_view("other"));
      break;
  }
}

}  // namespace

RowDigest frame_digest(const Frame& frame) {
  RunningDigest hash;
  hash.add(std::string_view("noether-frame-1\n"));
  hash.add(frame.step);
  hash.add(frame.time);
  for (const std::vector<double>* numbers : {&frame.positions, &frame.velocities, &frame.variables})
    hash.add(std::span<const double>(*numbers));
  const std::vector<std::int64_t> images(frame.images.begin(), frame.images.end());
  hash.add(std::span<const std::int64_t>(images));
  hash.add(std::span<const double>(frame.edges));
  for (const auto& [name, values] : frame.columns) {
    hash.add(std::string_view(name));
    hash.add(std::span<const double>(values));
  }
  if (!frame.sites.positions.empty()) {
    hash.add(std::string_view("sites"));
    hash.add(std::span<const double>(frame.sites.positions));
    hash.add(std::span<const double>(frame.sites.velocities));
    const std::vector<std::int64_t> crossed(frame.sites.images.begin(), frame.sites.images.end());
    hash.add(std::span<const std::int64_t>(crossed));
  }
  return hash.row();
}

RowDigest sample_digest(std::int64_t step, double time,
                        const std::map<std::string, std::span<const double>, std::less<>>& quantities) {
  RunningDigest hash;
  hash.add(std::string_view("noether-sample-1\n"));
  hash.add(step);
  hash.add(time);
  for (const auto& [name, values] : quantities) {
    hash.add(std::string_view(name));
    hash.add(values);
  }
  return hash.row();
}

std::string constants_digest(const Hdf5File& file) {
  RunningDigest hash;
  hash.add(std::string_view("noether-constants-1\n"));
  for (const std::string& group : constant_groups()) {
    for (const std::string& name : file.children(group)) {
      const std::string path = group + "/" + name;
      if (file.is_group(path)) continue;
      const Hdf5Dataset dataset = file.open(path);
      if (dataset.grows()) continue;
      hash.add(path + '\n');
      add_values(hash, dataset);
    }
  }
  return hash.hex();
}

bool constants_differ(const Hdf5File& file) {
  return file.has_attribute("/noether", constants_attribute) &&
         file.text_attribute("/noether", constants_attribute) != constants_digest(file);
}

namespace {

/// Walks through a file: the path of an object, each of its attributes, then all that is below it.
template <class Take> class HeaderWalk {
 public:
  HeaderWalk(const Hdf5File& file, Take take) : file_(file), take_(std::move(take)) {}

  void at(const std::string& path) {
    // A damaged link may lead back up.
    if (++visited_ > most_objects) throw FileError("damaged: its groups have no end", {.file = file_.name()});
    take_(path);
    for (const std::string& name : file_.attributes(path)) take_(name + "=" + file_.attribute_bytes(path, name));
    for (const std::string& name : file_.children(path)) at(path + (path == "/" ? "" : "/") + name);
  }

 private:
  static constexpr int most_objects = 20'000;
  const Hdf5File& file_;
  Take take_;
  int visited_ = 0;
};

}  // namespace

std::string headers_digest(const Hdf5File& file, int version) {
  RunningDigest hash;
  hash.add("noether-attributes-" + std::to_string(version) + '\n');
  const auto add = [&](const std::string& one) { hash.add(one + '\n'); };
  std::vector<std::string> groups = constant_groups();
  groups.insert(groups.begin(), "/h5md");
  for (const std::string& group : groups) {
    if (file.has(group)) HeaderWalk(file, add).at(group);
  }
  for (const char* name : {"commit", "simd", "units", "version"}) add(file.attribute_bytes("/noether", name));
  return hash.hex();
}

std::string monitor_headers_digest(const Hdf5File& file, std::string_view monitor) {
  RunningDigest hash;
  hash.add(std::string_view("noether-monitor-1\n"));
  HeaderWalk(file, [&](const std::string& one) {
    hash.add(one + '\n');
  }).at(monitors_path + "/" + std::string(monitor));
  return hash.hex();
}

void write_scene(const Hdf5File& file, const std::string& scene_toml) {
  static const std::string path = "/noether/scene";
  if (!file.has(path) || file.read_text(path) != scene_toml) file.write_text(path, scene_toml);
  file.set_attribute("/noether", scene_attribute, sha256(scene_toml));
}

void read_headers(const Hdf5File& file) {
  HeaderWalk(file, [](const std::string&) {}).at("/");
}

}  // namespace noether::io
