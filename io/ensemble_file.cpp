#include "io/ensemble_file.hpp"

#include "io/hdf5_file.hpp"
#include "numbers/error.hpp"
#include "numbers/text.hpp"
#include "numbers/version.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

namespace noether::io {

namespace {

const std::string ensemble_group = "/ensemble";
constexpr const char* ensemble_schema = "noether.ensemble/1";

std::string below(const std::string& name) { return ensemble_group + "/" + name; }

/// The whole numbers of rows, by the names of their datasets.
constexpr std::pair<const char*, std::int64_t EnsembleRow::*> row_integers[] = {{"member", &EnsembleRow::member},
                                                                                {"outcome", &EnsembleRow::outcome},
                                                                                {"step", &EnsembleRow::step},
                                                                                {"particle", &EnsembleRow::particle}};

std::size_t as_size(Index n) { return static_cast<std::size_t>(n); }

/// One number, or several, of every row as one list.
std::vector<double> numbers_of(const std::vector<EnsembleRow>& rows, std::size_t first, std::size_t count) {
  std::vector<double> all;
  all.reserve(rows.size() * count);
  for (const EnsembleRow& row : rows) {
    const auto begin = row.values.begin() + static_cast<std::ptrdiff_t>(first);
    all.insert(all.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
  }
  return all;
}

std::vector<Index> with_rows(std::size_t rows, std::vector<Index> shape) {
  shape.insert(shape.begin(), static_cast<Index>(rows));
  return shape;
}

void write_definition(const Hdf5File& file, const EnsembleDefinition& d, const EnsembleShard& shard) {
  file.make_group("/noether");
  file.write_text("/noether/scene", d.scene_toml);
  file.set_attribute("/noether", "version", version());
  file.set_attribute("/noether", "commit", commit());
  file.set_attribute("/noether", "simd", d.simd);
  file.make_group(ensemble_group);
  file.set_attribute(ensemble_group, "schema", ensemble_schema);
  file.set_attribute(ensemble_group, "grid", std::vector<std::int64_t>(d.grid.begin(), d.grid.end()));
  file.set_attribute(ensemble_group, "members", d.members);
  file.set_attribute(ensemble_group, "seed", d.seed);
  file.set_attribute(ensemble_group, "in_lanes", std::int64_t{d.in_lanes ? 1 : 0});
  file.set_attribute(ensemble_group, "definition", d.digest());
  if (shard.whole()) return;
  file.set_attribute(ensemble_group, "shard", shard.shard);
  file.set_attribute(ensemble_group, "shards", shard.shards);
}

/// @throws FileError
[[noreturn]] void refuse_table(const std::filesystem::path& file, const std::string& why) {
  throw FileError(why, {.file = file.string()});
}

/// The columns of a file, as its datasets say, in their order.
std::vector<EnsembleColumn> columns_in(const Hdf5File& file) {
  std::vector<EnsembleColumn> columns;
  std::vector<std::pair<std::int64_t, std::string>> order;
  for (const std::string& name : file.children(ensemble_group)) {
    if (file.has_attribute(below(name), "column"))
      order.emplace_back(file.integer_attribute(below(name), "column"), name);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [place, name] : order) {
    EnsembleColumn column{.name = name, .dimension = file.text_attribute(below(name), "dimension")};
    std::vector<Index> shape = file.open(below(name)).shape();
    column.shape.assign(shape.begin() + 1, shape.end());
    if (file.has_attribute(below(name), "columns")) {
      for (const std::string& one : words_of(file.text_attribute(below(name), "columns")))
        column.columns.push_back(one);
    }
    columns.push_back(std::move(column));
  }
  return columns;
}

EnsembleDefinition definition_in(const Hdf5File& file, const std::filesystem::path& name) {
  EnsembleDefinition d;
  d.scene_toml = file.read_text("/noether/scene");
  d.simd = file.text_attribute("/noether", "simd");
  d.members = file.integer_attribute(ensemble_group, "members");
  d.seed = file.integer_attribute(ensemble_group, "seed");
  d.in_lanes = file.integer_attribute(ensemble_group, "in_lanes") != 0;
  for (const std::int64_t n : file.integers_attribute(ensemble_group, "grid")) d.grid.push_back(n);
  d.variations = file.open(below("vary")).read_texts();
  d.keys = file.open(below("keys")).read_texts();
  d.outcomes = file.open(below("outcomes")).read_texts();
  d.columns = columns_in(file);
  if (d.members < 1) refuse_table(name, "the file is damaged: there are no members");
  return d;
}

void add_bytes(std::string& to, const void* from, std::size_t count) {
  to.append(static_cast<const char*>(from), count);
}
template <class T> void take_bytes(const char*& from, T& to) {
  std::copy_n(from, sizeof to, reinterpret_cast<char*>(&to));
  from += sizeof to;
}

}  // namespace

Index EnsembleColumn::width() const {
  return std::accumulate(shape.begin(), shape.end(), Index{1}, std::multiplies<>());
}

Index EnsembleDefinition::width() const {
  Index width = std::ssize(keys);
  for (const EnsembleColumn& column : columns) width += column.width();
  return width;
}

std::string EnsembleDefinition::digest() const {
  RunningDigest hash;
  const auto add = [&](const std::string& text) {
    hash.add(static_cast<std::int64_t>(text.size()));
    hash.add(text);
  };
  const auto add_all = [&](const std::vector<std::string>& texts) {
    hash.add(std::ssize(texts));
    for (const std::string& text : texts) add(text);
  };
  add(ensemble_schema);
  add(version());
  add(scene_toml);
  add_all(variations);
  add_all(keys);
  hash.add(members);
  hash.add(seed);
  hash.add(std::int64_t{in_lanes ? 1 : 0});
  add(simd);
  add_all(outcomes);
  for (const EnsembleColumn& column : columns) {
    add(column.name);
    for (const Index n : column.shape) hash.add(static_cast<std::int64_t>(n));
  }
  return hash.hex();
}

std::string EnsembleRow::bytes() const {
  std::string bytes;
  for (const auto& [name, number] : row_integers) add_bytes(bytes, &(this->*number), sizeof(std::int64_t));
  add_bytes(bytes, digest.data(), sizeof digest);
  add_bytes(bytes, &time, sizeof time);
  add_bytes(bytes, values.data(), values.size() * sizeof(double));
  return bytes;
}

EnsembleRow EnsembleRow::from_bytes(const char* bytes, std::size_t width) {
  EnsembleRow row;
  for (const auto& [name, number] : row_integers) take_bytes(bytes, row.*number);
  take_bytes(bytes, row.digest);
  take_bytes(bytes, row.time);
  row.values.resize(width);
  for (double& value : row.values) take_bytes(bytes, value);
  return row;
}

std::map<std::string, std::int64_t> outcomes_of(const EnsembleDefinition& definition,
                                                const std::vector<EnsembleRow>& rows) {
  std::map<std::string, std::int64_t> outcomes;
  for (const EnsembleRow& row : rows) {
    const bool known = row.outcome >= 0 && row.outcome < std::ssize(definition.outcomes);
    ++outcomes[known ? definition.outcomes[static_cast<std::size_t>(row.outcome)] : "unknown"];
  }
  return outcomes;
}

std::string EnsembleTable::digest() const {
  RunningDigest hash;
  for (const EnsembleRow& row : rows) hash.add(row.bytes());
  return "sha256:" + hash.hex();
}

void write_ensemble(const std::filesystem::path& name, const EnsembleTable& table) {
  const std::vector<EnsembleRow>& rows = table.rows;
  const EnsembleDefinition& d = table.definition;
  const Hdf5File file = Hdf5File::create(name);
  write_definition(file, d, table.shard);
  file.write(below("vary"), d.variations);
  file.write(below("keys"), d.keys);
  file.write(below("outcomes"), d.outcomes);
  for (const auto& [dataset, number] : row_integers) {
    std::vector<std::int64_t> values;
    for (const EnsembleRow& row : rows) values.push_back(row.*number);
    file.write(below(dataset), values, with_rows(rows.size(), {}));
  }
  std::vector<std::int64_t> digests;
  std::vector<double> times;
  for (const EnsembleRow& row : rows) {
    digests.insert(digests.end(), row.digest.begin(), row.digest.end());
    times.push_back(row.time);
  }
  file.write(below("digest"), digests, with_rows(rows.size(), {std::ssize(EnsembleRow{}.digest)}));
  file.write(below("time"), times, with_rows(rows.size(), {}));
  file.write(below("parameters"), numbers_of(rows, 0, d.keys.size()), with_rows(rows.size(), {std::ssize(d.keys)}));
  std::size_t first = d.keys.size();
  for (std::size_t k = 0; k < d.columns.size(); ++k) {
    const EnsembleColumn& column = d.columns[k];
    file.write(below(column.name), numbers_of(rows, first, as_size(column.width())),
               with_rows(rows.size(), column.shape));
    file.set_attribute(below(column.name), "column", static_cast<std::int64_t>(k));
    file.set_attribute(below(column.name), "dimension", column.dimension);
    if (!column.columns.empty())
      file.set_attribute(below(column.name), "columns", fmt::format("{}", fmt::join(column.columns, " ")));
    first += as_size(column.width());
  }
  file.take_name();
}

bool holds_ensemble(const std::filesystem::path& name) noexcept {
  try {
    const Hdf5File file = Hdf5File::open_to_read(name);
    return file.has(ensemble_group) && file.text_attribute(ensemble_group, "schema") == ensemble_schema;
  } catch (const std::exception&) {
    return false;
  }
}

EnsembleTable read_ensemble(const std::filesystem::path& name) {
  if (name.extension() == ".rows") {
    refuse_table(name, "these are the rows of an unfinished shard or ensemble; run it again, it goes on from there");
  }
  const Hdf5File file = Hdf5File::open_to_read(name);
  if (!file.has(ensemble_group) || file.text_attribute(ensemble_group, "schema") != ensemble_schema)
    refuse_table(name, "this is not a file of an ensemble");
  EnsembleTable table;
  table.definition = definition_in(file, name);
  const EnsembleDefinition& d = table.definition;
  if (file.has_attribute(ensemble_group, "shards")) {
    table.shard = {file.integer_attribute(ensemble_group, "shard"), file.integer_attribute(ensemble_group, "shards")};
  }
  const bool sane = table.shard.shards >= 1 && table.shard.shard >= 0 && table.shard.shard < table.shard.shards;
  if (!sane || file.text_attribute(ensemble_group, "definition") != d.digest()) {
    refuse_table(name, "the file is damaged, or was written by another version; make it anew");
  }
  const auto count = as_size(file.open(below("member")).rows());
  if (count != as_size(table.shard.count(d.members))) refuse_table(name, "the file is damaged: members are missing");
  table.rows.resize(count);
  for (const auto& [dataset, number] : row_integers) {
    const std::vector<std::int64_t> values = file.open(below(dataset)).read_integers();
    if (values.size() != count)
      refuse_table(name, fmt::format("the file is damaged: '{}' is not of all members", dataset));
    for (std::size_t k = 0; k < count; ++k) table.rows[k].*number = values[k];
  }
  const auto reals = [&](const std::string& dataset, std::size_t width) {
    std::vector<double> values = file.open(below(dataset)).read_reals();
    if (values.size() != count * width)
      refuse_table(name, fmt::format("the file is damaged: '{}' is not of all members", dataset));
    return values;
  };
  const auto append = [&](const std::string& dataset, std::size_t width) {
    const std::vector<double> values = reals(dataset, width);
    for (std::size_t k = 0; k < count; ++k) {
      const auto begin = values.begin() + static_cast<std::ptrdiff_t>(k * width);
      table.rows[k].values.insert(table.rows[k].values.end(), begin, begin + static_cast<std::ptrdiff_t>(width));
    }
  };
  const std::vector<double> times = reals("time", 1);
  const std::vector<std::int64_t> digests = file.open(below("digest")).read_integers();
  if (digests.size() != count * EnsembleRow{}.digest.size())
    refuse_table(name, "the file is damaged: digests are missing");
  for (std::size_t k = 0; k < count; ++k) {
    EnsembleRow& row = table.rows[k];
    row.time = times[k];
    std::copy_n(digests.begin() + static_cast<std::ptrdiff_t>(k * row.digest.size()), row.digest.size(),
                row.digest.begin());
    if (row.member != table.shard.shard + static_cast<std::int64_t>(k) * table.shard.shards) {
      refuse_table(name, "the file is damaged: its members are out of order");
    }
  }
  append("parameters", d.keys.size());
  for (const EnsembleColumn& column : d.columns) append(column.name, as_size(column.width()));
  return table;
}

std::string difference_of(const EnsembleDefinition& a, const EnsembleDefinition& b) {
  if (a.simd != b.simd) return fmt::format("SIMD level '{}' there, '{}' here", a.simd, b.simd);
  if (a.variations != b.variations) {
    return fmt::format("--vary {} there, --vary {} here", fmt::join(a.variations, " "), fmt::join(b.variations, " "));
  }
  if (a.in_lanes != b.in_lanes) return "members went in lanes in one of them and one by one in the other";
  if (a.members != b.members) return fmt::format("{} members there, {} here", a.members, b.members);
  if (a.seed != b.seed) return fmt::format("--seed {} there, {} here", a.seed, b.seed);
  if (a.scene_toml != b.scene_toml) return "the scene is another one";
  return "the monitors, or the version of noether, are other ones";
}

EnsembleTable merge_ensembles(const std::vector<std::filesystem::path>& files) {
  EnsembleTable all;
  std::map<std::int64_t, std::string> shards;  ///< by number, the file
  for (const std::filesystem::path& file : files) {
    EnsembleTable one = read_ensemble(file);
    if (shards.empty()) {
      all.definition = one.definition;
      all.shard = one.shard;
    } else if (one.definition.digest() != all.definition.digest()) {
      throw SceneError(fmt::format("it is not of the ensemble of {}: {}", files.front().string(),
                                   difference_of(all.definition, one.definition)),
                       {.file = file.string()});
    } else if (one.shard.shards != all.shard.shards) {
      throw SceneError(fmt::format("it is one of {} shards, but {} is one of {}", one.shard.shards,
                                   files.front().string(), all.shard.shards),
                       {.file = file.string()});
    }
    const auto [known, is_new] = shards.emplace(one.shard.shard, file.string());
    if (!is_new) {
      throw SceneError(fmt::format("it is shard {} of {}, and so is {}; give it once", one.shard.shard,
                                   one.shard.shards, known->second),
                       {.file = file.string()});
    }
    std::move(one.rows.begin(), one.rows.end(), std::back_inserter(all.rows));
  }
  std::vector<std::int64_t> missing;
  for (std::int64_t k = 0; k < all.shard.shards && missing.size() < 8; ++k) {
    if (!shards.contains(k)) missing.push_back(k);
  }
  if (!missing.empty()) {
    throw SceneError(fmt::format("of {} shards {} {} missing; run {} first, by --shard {}/{}", all.shard.shards,
                                 fmt::join(missing, ", "), missing.size() == 1 ? "is" : "are",
                                 missing.size() == 1 ? "it" : "them", missing.front(), all.shard.shards));
  }
  all.shard = {};
  std::sort(all.rows.begin(), all.rows.end(), [](const auto& a, const auto& b) { return a.member < b.member; });
  return all;
}

}  // namespace noether::io
