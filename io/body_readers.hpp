#pragma once
/// The readers behind `read_bodies`, one for each kind of table.

#include "io/body_table.hpp"
#include "io/text_table.hpp"

namespace noether::io {

/// Bodies from CSV. @throws SceneError
BodyTable read_csv_bodies(const TextFile& text, const BodiesOptions& options);

/// Bodies from vector tables of Horizons. @throws SceneError
BodyTable read_horizons_bodies(const TextFile& text, const BodiesOptions& options);

/// The text that Horizons' JSON answers, one or several, bring as their "result"; the text itself where it is no JSON.
/// @throws SceneError  for JSON that is broken or holds no table, with what Horizons says
TextFile horizons_answer(TextFile text);

}  // namespace noether::io
