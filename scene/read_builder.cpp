#include "scene/read_builder.hpp"

#include "engine/make_rigid.hpp"
#include "scene/block.hpp"
#include "scene/builders.hpp"
#include "scene/foreign_names.hpp"
#include "scene/ionic_crystal.hpp"
#include "scene/ring_patch.hpp"
#include "scene/water_box.hpp"

#include <fmt/format.h>

namespace noether {

namespace {

template <class Builder> BuilderKind builder_kind() {
  return {part_info<Builder>(), [](TableReader& reader, SceneValue& effective) {
            Builder builder;
            read_part(reader, builder);
            put_fields(reader, builder, effective);
            try {
              return builder.build(*reader.context().units);
            } catch (const Error& error) {
              reader.refuse(error);
            }
          }};
}

}  // namespace

const std::vector<BuilderKind>& builders() {
  static const std::vector<BuilderKind> all = {
      builder_kind<Lattice>(),      builder_kind<Liquid>(), builder_kind<PolymerChains>(), builder_kind<WaterBox>(),
      builder_kind<IonicCrystal>(), builder_kind<Block>(),  builder_kind<RingPatch>()};
  return all;
}

ParticleSystem<double> build_particles(TableReader& reader, SceneValue& effective) {
  const std::string type = reader.text("type");
  for (const BuilderKind& kind : builders()) {
    if (kind.info.name != type) continue;
    TableReader fields(reader.context(), reader.table(), fmt::format("builder '{}'", type), reader.path());
    for (const char* key : {"type", "rigid_bodies"}) fields.find(key);
    effective.put("type", SceneValue::of(type, reader.line("type")));
    ParticleSystem<double> s = kind.build(fields, effective);
    if (!reader.has("rigid_bodies")) return s;
    effective.put("rigid_bodies", *reader.find("rigid_bodies"));
    if (!reader.flag("rigid_bodies", false)) return s;
    try {
      s = make_rigid(s);
    } catch (const Error& error) {
      reader.fail("rigid_bodies", error.message());
    }
    if (s.bodies() != nullptr) return s;
    reader.fail("rigid_bodies", fmt::format("{} makes no molecules; take rigid_bodies out", type));
  }
  reader.fail("type", fmt::format("unknown builder '{}'{}", type, proposal(type, names_of(builders()))));
}

}  // namespace noether
