#include "engine/signature.hpp"

namespace noether::detail {

std::string value_text(double x) { return fmt::format("{}", x); }
std::string value_text(std::int64_t x) { return fmt::format("{}", x); }
std::string value_text(const std::optional<double>& x) { return x ? value_text(*x) : "default"; }
std::string value_text(const Vec3<double>& x) { return fmt::format("[{}, {}, {}]", x[0], x[1], x[2]); }
std::string value_text(const std::array<double, 3>& x) { return fmt::format("[{}, {}, {}]", x[0], x[1], x[2]); }
std::string value_text(const std::optional<std::array<double, 3>>& x) { return x ? value_text(*x) : "default"; }

void add_field_text(std::string& fields, std::string_view name, const std::string& value) {
  fields += fmt::format("{}{} = {}", fields.empty() ? "" : ", ", name, value);
}

}  // namespace noether::detail
