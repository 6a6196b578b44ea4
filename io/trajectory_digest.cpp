#include "io/trajectory_digest.hpp"

#include "io/trajectory_layout.hpp"
#include "io/trajectory_topology.hpp"

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
  for (const std::string& group : {particles_path, system_path, connectivity_path, topology_path}) {
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

}  // namespace noether::io
