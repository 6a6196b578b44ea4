#pragma once
/// The literature noether stands on: docs/references.bib, built in.

#include <string>
#include <string_view>

namespace noether {

/// docs/references.bib as text.
/// @throws never
const char* references_bib() noexcept;

/// One entry of it, from its @ to its closing brace; empty if there is none of that key.
std::string bibtex(std::string_view key);

}  // namespace noether
