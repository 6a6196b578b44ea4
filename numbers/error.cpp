#include "numbers/error.hpp"

#include <utility>

namespace noether {

namespace {

std::string prefix(const ErrorLocation& at) {
  if (at.file.empty()) return at.line > 0 ? "line " + std::to_string(at.line) + ": " : "";
  return at.line > 0 ? at.file + ":" + std::to_string(at.line) + ": " : at.file + ": ";
}

}  // namespace

Error::Error(const std::string& message) : Error(message, ErrorLocation{}) {}

Error::Error(const std::string& message, ErrorLocation location)
    : std::runtime_error(prefix(location) + message), message_(message), location_(std::move(location)) {}

}  // namespace noether
