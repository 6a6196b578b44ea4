#pragma once
/// Words as a shell takes them: commands that can be typed again.

#include <string>
#include <string_view>

namespace noether {

/// A word in single quotes, unless a shell takes it as it is.
std::string shell_quoted(std::string_view word);

}  // namespace noether
