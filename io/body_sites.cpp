#include "io/body_sites.hpp"

#include "io/text_table.hpp"
#include "numbers/quantity.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace noether::io {

namespace {

/// Columns of the table, in the order in which messages list them; `dimension` is empty for texts.
struct SiteColumn {
  std::string_view name, dimension;
};
constexpr std::array<SiteColumn, 7> site_columns = {{{"x", "length"},
                                                     {"y", "length"},
                                                     {"z", "length"},
                                                     {"mass", "mass"},
                                                     {"charge", "charge"},
                                                     {"type", ""},
                                                     {"name", ""}}};

class SiteTable {
 public:
  SiteTable(const std::filesystem::path& file, const UnitSystem& units, const SiteTypes& types)
      : text_(file, "a table of sites, CSV"), units_(units), types_(types) {}

  std::vector<BodySite> read() {
    std::vector<BodySite> sites;
    for (std::size_t line = 1; line <= text_.lines().size(); ++line) {
      const std::string& row = text_.lines()[line - 1];
      const std::string_view content = trimmed(std::string_view(row).substr(0, row.find('#')));
      if (content.empty()) continue;
      const std::vector<std::string> fields = split_at(content, ',');
      if (columns_.empty()) {
        read_headings(line, fields);
      } else {
        sites.push_back(site_of(line, fields));
      }
    }
    if (columns_.empty())
      text_.fail(0, "there is no line of column names; one such as x [km],y,z,mass [kg] is expected");
    return sites;
  }

 private:
  struct Found {
    std::size_t known;
    double unit = 1;
    bool has_unit = false;
  };

  void read_headings(std::size_t line, const std::vector<std::string>& fields) {
    std::optional<double> of_place;
    for (const std::string& field : fields) {
      const Heading heading = parse_heading(field);
      const auto found = std::find_if(site_columns.begin(), site_columns.end(),
                                      [&](const SiteColumn& column) { return column.name == heading.name; });
      if (found == site_columns.end()) {
        std::vector<std::string> names;
        for (const SiteColumn& column : site_columns) names.emplace_back(column.name);
        text_.fail(line, fmt::format("unknown column '{}'{}", heading.name, did_you_mean(heading.name, names)),
                   heading.name);
      }
      const auto at = static_cast<std::size_t>(found - site_columns.begin());
      if (has(found->name)) text_.fail(line, fmt::format("column '{}' appears twice", heading.name), heading.name);
      Found column{at};
      column.has_unit = heading.unit.has_value();
      if (heading.unit) column.unit = unit_of(line, heading, *found);
      if (at < 3 && heading.unit && !of_place) of_place = column.unit;
      if (!heading.unit && !found->dimension.empty() && at > 2 && !units_.is_reduced()) refuse_unit(line, found->name);
      columns_.push_back(column);
    }
    for (const std::string_view name : {"x", "y", "z", "mass"}) {
      if (!has(name)) text_.fail(line, fmt::format("there is no column '{}'", name));
    }
    if (types_.names.size() > 1 && !has("type"))
      text_.fail(line, "there is no column 'type', but there are several types");
    if (!of_place && !units_.is_reduced()) refuse_unit(line, "x");
    for (Found& column : columns_) {
      if (column.known < 3 && !column.has_unit) column.unit = of_place.value_or(1);
    }
  }

  [[noreturn]] void refuse_unit(std::size_t line, std::string_view name) const {
    text_.fail(line,
               fmt::format("column '{}' has no unit; give one in brackets, such as {}", name,
                           name == "mass"     ? "mass [kg]"
                           : name == "charge" ? "charge [e]"
                                              : "x [km]"),
               std::string(name));
  }

  double unit_of(std::size_t line, const Heading& heading, const SiteColumn& known) const {
    try {
      return parse_quantity("1 " + *heading.unit, parse_dimension(known.dimension), units_);
    } catch (const Error& error) {
      text_.fail(line, fmt::format("column '{}': {}", heading.name, error.message()), *heading.unit);
    }
  }

  bool has(std::string_view name) const {
    return std::any_of(columns_.begin(), columns_.end(),
                       [&](const Found& column) { return site_columns[column.known].name == name; });
  }

  BodySite site_of(std::size_t line, const std::vector<std::string>& fields) const {
    if (fields.size() != columns_.size()) {
      text_.fail(line, fmt::format("the line has {} fields, but there are {} columns", fields.size(), columns_.size()));
    }
    BodySite site;
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const SiteColumn& known = site_columns[columns_[k].known];
      const std::string what = fmt::format("column '{}'", known.name);
      if (known.name == "name") {
        site.name = fields[k];
      } else if (known.name == "type") {
        const std::vector<std::string>& names = types_.names;
        const auto found = std::find(names.begin(), names.end(), fields[k]);
        if (found == names.end()) {
          text_.fail(line, fmt::format("unknown type '{}'{}", fields[k], did_you_mean(fields[k], names)), fields[k]);
        }
        site.type = static_cast<int>(found - names.begin());
      } else if (known.name == "mass") {
        site.mass = mass_number_in(text_, line, fields[k], what) * columns_[k].unit;
      } else if (known.name == "charge") {
        site.charge = number_in(text_, line, fields[k], what) * columns_[k].unit;
      } else {
        site.place[static_cast<Index>(columns_[k].known)] = number_in(text_, line, fields[k], what) * columns_[k].unit;
      }
    }
    if (!has("charge")) site.charge = types_.charge(site.type);
    return site;
  }

  TextFile text_;
  const UnitSystem& units_;
  const SiteTypes& types_;
  std::vector<Found> columns_;
};

}  // namespace

std::vector<BodySite> read_body_sites(const std::filesystem::path& file, const UnitSystem& units,
                                      const SiteTypes& types) {
  return SiteTable(file, units, types).read();
}

}  // namespace noether::io
