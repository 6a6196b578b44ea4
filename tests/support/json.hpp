#pragma once
/// What the program says in JSON, as far as tests ask: whether it is JSON, and what stands behind a key.

#include <string>

namespace noether::test {

/// Whether a text is one line that holds one JSON object.
bool is_json_line(const std::string& text);

/// The value behind the first `"key":` as it is written: a number, a text in its quotes, an object or a list with its
/// brackets; "" if there is none.
std::string json_member(const std::string& json, const std::string& key);

}  // namespace noether::test
