#include "io/checkpoint.hpp"

#include "engine/snapshot.hpp"
#include "io/digest.hpp"
#include "io/files.hpp"
#include "io/hdf5_file.hpp"
#include "numbers/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <utility>

namespace noether::io {

namespace {

constexpr std::string_view trailer_head = "sha256:";
constexpr std::size_t trailer_size = trailer_head.size() + 64 + 1;

std::string trailer_of(std::string_view content) { return fmt::format("{}{}\n", trailer_head, sha256(content)); }

/// A path below `group` for the name of an array: slashes nest, and nothing stands where something else already does.
std::string path_for(const Hdf5File& file, const std::string& group, const std::string& name) {
  std::string path = group, part;
  for (const char letter : name + "/") {
    if (letter != '/') {
      part += letter;
      continue;
    }
    if (part.empty()) continue;
    if (part == "." || part == "..") part += "_";
    path += "/" + part;
    while (file.has(path) && !file.is_group(path)) path += "_";
    part.clear();
  }
  if (path == group) path += "/_";
  while (file.has(path)) path += "_";
  return path;
}

/// Where the path differs from the name, an attribute keeps the name.
void write_state(const Hdf5File& file, const std::string& group, const SavedState& state) {
  file.make_group(group);
  for (const auto& [name, array] : state) {
    const std::string path = path_for(file, group, name);
    std::visit(
        [&](const auto& values) {
          if constexpr (std::is_same_v<std::decay_t<decltype(values)>, std::vector<std::string>>) {
            file.write(path, values);
          } else {
            file.write(path, values, {static_cast<Index>(values.size())});
          }
        },
        array);
    if (path != group + "/" + name) file.set_attribute(path, "name", name);
  }
}

SavedArray read_array(const Hdf5Dataset& dataset) {
  switch (dataset.type()) {
    case ElementType::real:
      return dataset.read_reals();
    case ElementType::integer:
      return dataset.read_integers();
    default:
      return dataset.read_texts();
  }
}

/// @throws FileError for groups that are nested without end
void read_state(const Hdf5File& file, const std::string& group, const std::string& below, SavedState& state) {
  static constexpr int deepest = 64;
  if (std::count(below.begin(), below.end(), '/') > deepest)
    throw FileError(fmt::format("damaged: the groups below '{}' are nested more than {} levels deep", group, deepest),
                    {.file = file.name()});
  for (const std::string& child : file.children(group + below)) {
    const std::string name = below + "/" + child;
    const std::string path = group + name;
    if (file.is_group(path)) {
      read_state(file, group, name, state);
    } else {
      const bool renamed = file.has_attribute(path, "name");
      state[renamed ? file.text_attribute(path, "name") : name.substr(1)] = read_array(file.open(path));
    }
  }
}

/// A checkpoint on its way; whole from the moment the first rename is due.
std::filesystem::path being_written(std::filesystem::path file) { return file += ".new"; }

std::string to_bytes(const Checkpoint& checkpoint, const std::filesystem::path& name) {
  const Hdf5File file = Hdf5File::create_in_memory(name);
  write_state(file, "/state", checkpoint.run.particles);
  file.make_group("/parts");
  for (const auto& [part, state] : checkpoint.run.parts) write_state(file, "/parts/" + part, state);
  file.make_group("/noether");
  file.write_text("/noether/scene", checkpoint.scene_toml);
  file.write_text("/noether/digest", checkpoint.digest);
  file.write_text("/noether/checksum", "the file ends with a line sha256:<hex> over all bytes before it");
  file.set_attribute("/noether", "version", version());
  file.set_attribute("/noether", "commit", commit());
  file.set_attribute("/noether", "simd", checkpoint.simd);
  file.set_attribute("/noether", "outcome", checkpoint.outcome);
  file.set_attribute("/noether", "step", checkpoint.step);
  file.set_attribute("/noether", "time", checkpoint.time);
  file.set_attribute("/noether", "complete", std::int64_t{1});
  return file.to_bytes();
}

Checkpoint from_bytes(const std::string& bytes, const std::filesystem::path& name) {
  const Hdf5File file = Hdf5File::open_bytes(bytes, name);
  if (file.integer_attribute("/noether", "complete") != 1) {
    throw FileError("this is not a complete checkpoint", {.file = name.string()});
  }
  Checkpoint checkpoint;
  read_state(file, "/state", "", checkpoint.run.particles);
  for (const std::string& part : file.children("/parts")) {
    read_state(file, "/parts/" + part, "", checkpoint.run.parts[part]);
  }
  checkpoint.scene_toml = file.read_text("/noether/scene");
  checkpoint.digest = file.read_text("/noether/digest");
  checkpoint.simd = file.text_attribute("/noether", "simd");
  checkpoint.outcome = file.text_attribute("/noether", "outcome");
  checkpoint.step = file.integer_attribute("/noether", "step");
  checkpoint.time = file.real_attribute("/noether", "time");
  return checkpoint;
}

}  // namespace

std::filesystem::path previous_checkpoint(const std::filesystem::path& file) {
  std::filesystem::path name = file.stem();
  name += ".previous";
  name += file.extension();
  return file.parent_path() / name;
}

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
  std::string bytes = to_bytes(checkpoint, file);
  bytes += trailer_of(bytes);
  const std::filesystem::path beside = being_written(file);
  write_and_sync(beside, bytes);
  rename_if_there(file, previous_checkpoint(file));
  rename_if_there(beside, file);
  sync_folder(file.parent_path());
}

bool ends_like_checkpoint(const std::filesystem::path& file) {
  std::ifstream source(file, std::ios::binary);
  std::string end(trailer_head.size(), '\0');
  source.seekg(-static_cast<std::streamoff>(trailer_size), std::ios::end);
  source.read(end.data(), static_cast<std::streamsize>(end.size()));
  return source && end == trailer_head;
}

Checkpoint read_checkpoint(const std::filesystem::path& file) {
  std::string bytes = read_bytes(file);
  const std::size_t content = bytes.size() < trailer_size ? 0 : bytes.size() - trailer_size;
  const std::string_view all = bytes;
  if (content == 0 || !all.substr(content).starts_with(trailer_head)) {
    throw FileError(
        fmt::format("damaged, or not a checkpoint: the line 'sha256:...' at the end of its {} bytes is missing",
                    bytes.size()),
        {.file = file.string()});
  }
  if (trailer_of(all.substr(0, content)) != all.substr(content)) {
    throw FileError("damaged: its contents do not match the SHA-256 at its end", {.file = file.string()});
  }
  bytes.resize(content);
  return from_bytes(bytes, file);
}

FoundCheckpoint newest_checkpoint(const std::filesystem::path& folder) {
  FoundCheckpoint found;
  const std::filesystem::path newest = folder / "checkpoint.h5", beside = being_written(newest);
  for (const std::filesystem::path& file : {newest, previous_checkpoint(newest), beside}) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) continue;
    try {
      Checkpoint checkpoint = read_checkpoint(file);
      if (!found.checkpoint || checkpoint.step > found.checkpoint->step) found.checkpoint = std::move(checkpoint);
    } catch (const FileError& error) {
      // A half-written file beside is what a killed process leaves: nothing is lost with it.
      if (file != beside) found.damaged.emplace_back(error.what());
    }
  }
  return found;
}

void CheckpointWriter::observe(const Snapshot<double>& now) {
  Checkpoint checkpoint;
  checkpoint.run = now.saved_run();
  checkpoint.run.parts.insert(beside_.begin(), beside_.end());
  checkpoint.scene_toml = scene_toml_;
  checkpoint.digest = digest(now.state());
  checkpoint.step = now.step();
  checkpoint.time = now.time();
  write_checkpoint(file_, checkpoint);
}

}  // namespace noether::io
