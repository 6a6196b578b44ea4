#include "scene/read_particles.hpp"

#include "engine/bodies.hpp"
#include "engine/charge.hpp"
#include "engine/make_rigid.hpp"
#include "io/bodies.hpp"
#include "io/frame_particles.hpp"
#include "numbers/suggest.hpp"
#include "scene/body_tables.hpp"
#include "scene/particle_keys.hpp"
#include "scene/read_builder.hpp"
#include "scene/read_structure.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace noether {

namespace {

/// `epoch = "JD 2451545 TDB"`, or without the scale. @throws SceneError
std::optional<io::BodyEpoch> read_epoch(TableReader& reader) {
  const SceneValue* value = reader.find("epoch");
  if (value == nullptr) return {};
  if (const auto epoch = julian_day_of(*value)) return epoch;
  reader.fail("epoch", fmt::format("epoch = {} is not a Julian day; one is expected, such as \"JD 2451545\" or \"JD "
                                   "2451545 TDB\"",
                                   to_text(*value)));
}

/// `elements = "jacobi"`: what elements are about. @throws SceneError
io::ElementsAbout read_elements_about(TableReader& reader, SceneValue& effective) {
  const SceneValue* value = reader.find("elements");
  if (value == nullptr) return io::ElementsAbout::first_body;
  const std::string text = reader.text("elements");
  if (text != "jacobi" && text != "first_body") {
    reader.fail("elements", fmt::format("unknown elements '{}'{}", text, did_you_mean(text, {"first_body", "jacobi"})));
  }
  effective.put("elements", *value);
  return text == "jacobi" ? io::ElementsAbout::all_before_it : io::ElementsAbout::first_body;
}

/// The bodies of a table in a file, and the moment for which they hold.
ParticleSystem<double> from_file(TableReader& reader, const std::filesystem::path& folder, io::ElementsAbout elements,
                                 bool alone, std::optional<io::BodyEpoch>& epoch, SceneValue& effective,
                                 std::vector<std::string>& warnings) {
  io::BodiesOptions options{.units = reader.context().units, .elements = elements};
  if (reader.context().G) options.G = gravitation(reader);
  const std::optional<io::BodyEpoch> wanted = epoch;
  if (wanted) options.epoch = wanted->julian_day;
  options.columns = reader.context().columns;
  options.left_out = reader.context().other_columns;
  // A key of bodies whatever the parts are.
  const auto is_charge = [](const ColumnInfo& column) { return column.name == Charge::name; };
  if (std::none_of(options.columns.begin(), options.columns.end(), is_charge))
    options.columns.push_back(column_info<Charge>());
  std::erase_if(options.left_out, is_charge);
  io::BodyTable table;
  ParticleSystem<double> s = particles_in_file(reader, "bodies", folder, "bodies.csv", "a table of bodies", effective,
                                               [&](const std::filesystem::path& file) {
                                                 table = io::read_body_table(file, options);
                                                 return std::move(table.particles);
                                               });
  if (table.epoch) {
    if (wanted && !wanted->scale.empty() && !table.epoch->scale.empty() && wanted->scale != table.epoch->scale) {
      reader.fail("epoch", fmt::format("epoch = \"{}\" is not in the time scale of the tables, {}", text_of(*wanted),
                                       table.epoch->scale));
    }
    epoch = table.epoch;
    if (epoch->scale.empty() && wanted) epoch->scale = wanted->scale;
  }
  for (const std::string& name : table.left_out) {
    warnings.push_back(
        fmt::format("no part of this scene uses the column '{}' of {}: it is left out", name, reader.text("bodies")));
  }
  if (!table.light_center.empty()) warnings.push_back(table.light_center);
  if (table.without_sun && alone) {
    warnings.push_back(
        fmt::format("the states in {} are about the Solar System Barycenter, but the Sun is not among them",
                    reader.text("bodies")));
  }
  return s;
}

/// Whether the bodies are those of a frame of run.h5.
bool are_of_a_frame(TableReader& reader, const std::filesystem::path& folder) {
  return reader.has("bodies") && io::is_hdf5(folder / reader.text("bodies"));
}

/// The bodies of a frame of run.h5, the last unless `frame` says which. What the frame is stands in the effective
/// table: a run that goes on writing must not change the start of this one.
ParticleSystem<double> from_frame(TableReader& reader, const std::filesystem::path& folder, SceneValue& effective,
                                  std::vector<std::string>& warnings) {
  io::FrameOptions options{.frame = {}, .units = reader.context().units, .columns = reader.context().columns};
  if (has_frame_number(reader)) options.frame = reader.integer("frame");
  io::FrameParticles found;
  const auto read = [&](const std::filesystem::path& file) {
    try {
      found = io::read_frame_particles(file, options);
    } catch (const FileError&) {
      throw;
    } catch (const Error& error) {
      if (error.key() == "units") reader.fail("bodies", error.message());
      reader.fail(error.key(), error.message());
    }
    return std::move(found.particles);
  };
  ParticleSystem<double> s =
      particles_in_file(reader, "bodies", folder, "run.h5", "a run.h5", effective, read, [&] { return found.sha256; });
  if (has_frame_number(reader) || !reader.has("frame"))
    effective.put("frame", SceneValue::of(found.frame, reader.line("frame")));
  if (!found.knows_types) {
    warnings.push_back(
        fmt::format("{} is from a version that did not store types, molecules and bonds: its particles have none here",
                    reader.text("bodies")));
  }
  if (found.lost_bodies) {
    reader.fail("bodies", fmt::format("{} has rigid bodies, and is from a version that did not store what they are "
                                      "made of; start from its scene",
                                      reader.text("bodies")));
  }
  for (const std::string& name : found.left_out) {
    warnings.push_back(
        fmt::format("no part of this scene uses the column '{}' of {}: it is left out", name, reader.text("bodies")));
  }
  for (const char* key : {"body", "rigid_body"}) {
    if (!reader.has(key) || (s.topology() == nullptr && !s.has<Charge>())) continue;
    reader.fail(key, fmt::format("the particles of {} have types, bonds or charges, which bodies of tables would not "
                                 "have; take [[particles.{}]] out",
                                 reader.text("bodies"), key));
  }
  return s;
}

/// Bodies of a file, of `[[particles.body]]` tables, or of both, in this order.
ParticleSystem<double> from_bodies(TableReader& reader, const std::filesystem::path& folder, SceneValue& effective,
                                   std::vector<std::string>& warnings) {
  const bool file = reader.has("bodies"), frame = are_of_a_frame(reader, folder);
  if (frame && !reader.has("body") && !reader.has("rigid_body")) {  // so nobody has a passage at a date
    reader.expect_only(
        {"bodies", "bodies_sha256", "elements", "frame", "box", "exclusions", "special_pair", "molecules"});
  } else if (frame || file) {
    reader.expect_only({"bodies", "bodies_sha256", "epoch", "elements", "body", "rigid_body", "frame", "box",
                        "exclusions", "special_pair"});
  } else {
    reader.expect_only({"body", "rigid_body", "epoch", "elements", "frame", "box", "type", "pair", "mixing",
                        "exclusions", "special_pair"});
  }
  const auto points = tables_of(reader, "body"), rigid = tables_of(reader, "rigid_body");
  const io::ElementsAbout elements = read_elements_about(reader, effective);
  ParticleSystem<double> s(*reader.context().units);
  std::optional<io::BodyEpoch> epoch = read_epoch(reader);
  if (frame) {
    s = from_frame(reader, folder, effective, warnings);
  } else if (file) {
    s = from_file(reader, folder, elements, points.empty() && rigid.empty(), epoch, effective, warnings);
  }
  if (epoch) effective.put("epoch", SceneValue::of(text_of(*epoch), reader.line("epoch")));
  if (points.empty() && rigid.empty()) return s;
  return add_body_tables(reader, effective, std::move(s), {elements, epoch, folder}, warnings);
}

/// For each particle its place in the order of x, y, z: equal positions become neighbors.
std::vector<Index> sorted_by_position(const ParticleSystem<double>& s) {
  std::vector<Index> order(static_cast<std::size_t>(s.size()));
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<Index>(k);
  std::stable_sort(order.begin(), order.end(), [&](Index i, Index j) {
    const Vec3<double> a = s.positions()[i], b = s.positions()[j];
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  });
  return order;
}

/// Whether `type` names a builder; it is a list of tables where types of particles are given.
bool is_built(TableReader& reader) {
  const SceneValue* type = reader.find("type");
  return type != nullptr && type->get<SceneValue::Array>() == nullptr;
}

/// Particles come from one place; only bodies of a file and of tables may stand together. @throws SceneError
void check_sources(TableReader& reader) {
  const auto bodies = tables_of(reader, "body"), rigid = tables_of(reader, "rigid_body");
  std::vector<std::pair<const char*, const char*>> found;
  if (reader.has("bodies")) found.emplace_back("bodies", "from a file");
  if (reader.has("structure")) found.emplace_back("structure", "from a structure");
  if (is_built(reader)) found.emplace_back("type", "from a builder");
  if (!bodies.empty() || !rigid.empty()) {
    found.emplace_back(bodies.empty() ? "rigid_body" : "body",
                       bodies.empty() ? "from [[particles.rigid_body]]" : "from [[particles.body]]");
  }
  const bool both = found.size() == 2 && reader.has("bodies");
  if (found.size() > 1 && !both) {
    reader.fail(found[0].first,
                fmt::format("bodies come {} and {}; give one or the other", found[0].second, found[1].second));
  }
  if (found.empty()) {
    reader.fail(nullptr, "bodies",
                "there are no particles; give bodies = \"FILE.csv\", structure = \"FILE.data\", type = \"lattice\" or "
                "another builder, or [[particles.body]] or [[particles.rigid_body]] tables");
  }
}

/// @param of_a_frame  particles of run.h5, whose frame has been read
void read_frame(TableReader& reader, ParticleSystem<double>& s, bool of_a_frame, SceneValue& effective) {
  if (reader.has("structure") && has_frame_number(reader)) {
    effective.put("frame", *reader.find("frame"));
    return;
  }
  if (of_a_frame && (has_frame_number(reader) || !reader.has("frame"))) return;
  if (has_frame_number(reader)) {
    reader.fail("frame", fmt::format("frame = {} is the number of a frame, but {} has no frames; \"barycenter\" or "
                                     "\"as_given\" is expected",
                                     to_text(*reader.find("frame")),
                                     reader.has("bodies") ? "a table of bodies" : "[[particles.body]]"));
  }
  const std::string frame = reader.text("frame", "as_given");
  if (frame != "as_given" && frame != "barycenter") {
    reader.fail("frame", no_such_frame(frame, of_a_frame || reader.has("structure")));
  }
  if (frame == "barycenter" && has_bodies(s) && s.bodies()->any_held()) {
    reader.fail("frame",
                "a fixed point holds one of the bodies and stays where it is; take frame = \"barycenter\" out");
  }
  if (frame == "barycenter" && s.box().is_periodic()) {
    reader.fail("frame", "a periodic box has no centre of mass; take frame = \"barycenter\" out");
  }
  if (frame == "barycenter") {
    try {
      move_to_barycenter(s);
    } catch (const Error& error) {
      reader.fail("frame", error.message());
    }
  }
  effective.put("frame", SceneValue::of(frame, reader.line("frame")));
}

/// `molecules = "rigid"`: those of a structure, or of a frame of atoms, become rigid bodies. @throws SceneError
void read_molecules(TableReader& reader, ParticleSystem<double>& s, SceneValue& effective) {
  if (!reader.has("molecules")) return;
  const std::string text = reader.text("molecules");
  if (text != "rigid") {
    reader.fail("molecules", fmt::format("unknown molecules '{}'{}", text, did_you_mean(text, {"rigid"})));
  }
  for (const std::string key : {"exclusions", "special_pair"}) {
    if (reader.has(key)) {
      reader.fail(key, fmt::format("{} name atoms, which rigid molecules no longer have; take {} out",
                                   key == "exclusions" ? key : "special pairs", key));
    }
  }
  if (s.bodies() != nullptr) {
    reader.fail("molecules",
                fmt::format("the particles of {} are rigid bodies already; take molecules out", reader.text("bodies")));
  }
  try {
    s = make_rigid(s);
  } catch (const Error& error) {
    reader.fail("molecules", error.message());
  }
  if (s.bodies() == nullptr) {
    reader.fail("molecules", "there are no molecules, for no atoms are bonded; take molecules out");
  }
  effective.put("molecules", SceneValue::of(text, reader.line("molecules")));
}

}  // namespace

std::string epoch_of(const SceneValue& effective) {
  const SceneValue* particles = effective.find("particles");
  const SceneValue* epoch = particles != nullptr ? particles->find("epoch") : nullptr;
  return epoch != nullptr ? *epoch->get<std::string>() : "";
}

std::optional<std::pair<Index, Index>> coincident_bodies(const ParticleSystem<double>& s) {
  const std::vector<Index> order = sorted_by_position(s);
  for (std::size_t k = 1; k < order.size(); ++k) {
    const Index i = order[k - 1], j = order[k];
    const bool massive = s.masses()[i] != 0 || s.masses()[j] != 0;
    if (massive && s.positions()[i] == s.positions()[j]) return std::pair(std::min(i, j), std::max(i, j));
  }
  return {};
}

ParticleSystem<double> read_particles(const SceneContext& context, const SceneValue& table,
                                      const std::filesystem::path& folder, SceneValue& effective,
                                      std::vector<std::string>& warnings) {
  TableReader reader(context, table, "[particles]", "particles");
  if (!is_built(reader)) {
    reader.expect_only({"bodies",
                        "bodies_sha256",
                        "epoch",
                        "elements",
                        "body",
                        "rigid_body",
                        "structure",
                        "structure_sha256",
                        "type",
                        "pair",
                        "mixing",
                        "box",
                        "special",
                        "exclusions",
                        "file_units",
                        "atom_style",
                        "frame",
                        "temperature",
                        "seed",
                        "coefficients",
                        "coefficients_sha256",
                        "molecules",
                        "density",
                        "special_pair"});
  }
  check_sources(reader);
  if (is_built(reader)) {
    ParticleSystem<double> s = build_particles(reader, effective);
    for (const ColumnInfo& column : context.columns) s.add_column(column);
    return s;
  }
  TableReader own(context, table, "[particles]", "particles");
  ParticleSystem<double> s = reader.has("structure") ? read_structure_particles(own, folder, effective, warnings)
                                                     : from_bodies(own, folder, effective, warnings);
  if (reader.has("structure") || are_of_a_frame(reader, folder)) read_molecules(own, s, effective);
  if (!reader.has("structure")) {
    const auto box = read_box(own, effective);
    // A box that particles of run.h5 have already would only count their images anew.
    if (box && !(*box == s.box())) s.set_box(*box);
  }
  for (const ColumnInfo& column : context.columns) s.add_column(column);
  read_exclusions(own, s, effective);
  read_special_pairs(own, s, effective);
  read_frame(own, s, !reader.has("structure") && are_of_a_frame(reader, folder), effective);
  return s;
}

}  // namespace noether
