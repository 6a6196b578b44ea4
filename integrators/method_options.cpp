#include "integrators/method_options.hpp"

#include <fmt/format.h>

namespace noether {

std::string option_text(const OptionValue::Value& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *whole);
  if (const double* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const std::string* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* list = std::get_if<std::vector<std::string>>(&value))
    return fmt::format("{}", fmt::join(*list, ", "));
  return "default";
}

bool OwnOptions::operator==(const OwnOptions& other) const {
  if (group_ != other.group_) return false;
  if (group_ == nullptr) return true;
  const auto mine = group_->values(MethodOptions{.own = *this}), theirs = group_->values(MethodOptions{.own = other});
  for (std::size_t k = 0; k < mine.size(); ++k) {
    if (mine[k].value != theirs[k].value) return false;
  }
  return true;
}

}  // namespace noether
