#pragma once
/// The elements that noether's files are made of.

#include <cstdint>

namespace noether::io {

/// What elements a dataset or attribute has; `other` is what noether never writes.
enum class ElementType : std::uint8_t { real, integer, text, other };

}  // namespace noether::io
