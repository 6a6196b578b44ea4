#include "scene/read_builder.hpp"

#include "scene/builders.hpp"
#include "scene/foreign_names.hpp"
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
  static const std::vector<BuilderKind> all = {builder_kind<Lattice>(), builder_kind<Liquid>(),
                                               builder_kind<PolymerChains>(), builder_kind<WaterBox>()};
  return all;
}

ParticleSystem<double> build_particles(TableReader& reader, SceneValue& effective) {
  const std::string type = reader.text("type");
  for (const BuilderKind& kind : builders()) {
    if (kind.info.name != type) continue;
    TableReader fields(reader.context(), reader.table(), fmt::format("builder '{}'", type), reader.path());
    fields.find("type");
    effective.put("type", SceneValue::of(type, reader.line("type")));
    return kind.build(fields, effective);
  }
  reader.fail("type", fmt::format("unknown builder '{}'{}", type, proposal(type, names_of(builders()))));
}

}  // namespace noether
