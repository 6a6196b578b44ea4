/// Pictures of ensembles: figures of members over what varies, in colour.

#include "cli/plot_source.hpp"
#include "io/ensemble_file.hpp"
#include "io/trajectory_layout.hpp"
#include "numbers/error.hpp"
#include "numbers/quantity.hpp"
#include "numbers/suggest.hpp"
#include "numbers/text.hpp"
#include "scene/key_paths.hpp"
#include "scene/parts.hpp"
#include "study/variation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

namespace noether {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A figure of every member.
struct MemberFigure {
  std::string label;
  std::vector<double> values;  ///< NaN where there is none
};

/// "resonance angle amplitude (deg)".
std::string spaced(std::string name) {
  if (name == "megno_mean") return "MEGNO <Y>";
  if (name == "megno_value") return "MEGNO Y";
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

class EnsemblePicture {
 public:
  EnsemblePicture(const std::filesystem::path& file, const Parts& parts)
      : file_(file),
        table_(io::read_ensemble(file)),
        scene_(scene_in_file(table_.definition.scene_toml, file)),
        caption_(caption_of(scene_, file, "", 0, parts)),
        units_(io::known_units(text_at(scene_, {"units"}).empty() ? "reduced" : text_at(scene_, {"units"}), file)) {
    for (const std::string& text : table_.definition.variations) keys_.push_back(Variation::parse(text));
    for (const SceneValue* body : tables_at(scene_, {"particles", "body"})) names_.push_back(text_at(*body, {"name"}));
    const std::size_t refused = static_cast<std::size_t>(
        std::find(table_.definition.outcomes.begin(), table_.definition.outcomes.end(), "refused") -
        table_.definition.outcomes.begin());
    refused_ = static_cast<std::int64_t>(refused);
  }

  PlotData drawn(const PlotOptions& options) const {
    if (options.frame || !options.projection.empty()) {
      throw Error(fmt::format("{} is an ensemble, which has no frames and no projection; leave out {}", file_.string(),
                              options.frame ? "--frame" : "--projection"));
    }
    PlotData data;
    data.title = fmt::format("{}: {}", caption_.title, counted(std::ssize(table_.rows), "member"));
    data.subtitle = caption_.method;
    std::vector<std::string> what = options.what;
    if (what.empty()) what.push_back(default_figure());
    for (const std::string& name : what) data.panels.push_back(panel(name, figure(name)));
    return data;
  }

 private:
  bool in_cells() const { return keys_.size() > 1 && table_.shard.whole() && !keys_[0].drawn() && !keys_[1].drawn(); }

  /// The chaos indicator that there is, else the worst error of the energy, else when members ended.
  std::string default_figure() const {
    for (const char* name : {"megno_mean", "lyapunov_exponent", "resonance_angle_amplitude", "energy_worst"}) {
      for (const io::EnsembleColumn& column : table_.definition.columns) {
        if (column.name == name) return name;
      }
    }
    return "time";
  }

  MemberFigure figure(const std::string& name) const {
    std::vector<std::string> words = split(name);
    MemberFigure made;
    if (words[0] == "time" || words[0] == "step") {
      made.label = words[0] == "time" ? with_unit("time at the end", std::string(units_.time)) : "steps made";
      for (const io::EnsembleRow& row : table_.rows)
        made.values.push_back(words[0] == "time" ? row.time : static_cast<double>(row.step));
    } else {
      std::size_t first = keys_.size();
      const io::EnsembleColumn& column = column_named(words[0], first);
      first += place_in(column, name, std::span(words).subspan(1));
      made.label = with_unit(spaced(name), unit_of_column(column, words));
      for (const io::EnsembleRow& row : table_.rows) made.values.push_back(row.values[first]);
    }
    for (std::size_t k = 0; k < made.values.size(); ++k) {
      if (table_.rows[k].outcome == refused_ || !std::isfinite(made.values[k])) made.values[k] = nan;
    }
    return made;
  }

  static std::vector<std::string> split(const std::string& name) {
    std::vector<std::string> words{""};
    for (const char c : name) c == '.' ? void(words.emplace_back()) : words.back().push_back(c);
    return words;
  }

  /// @param first  gets the place of the column's first number among those of a row
  const io::EnsembleColumn& column_named(const std::string& name, std::size_t& first) const {
    std::vector<std::string> known{"time", "step"};
    for (const io::EnsembleColumn& column : table_.definition.columns) {
      if (column.name == name) return column;
      first += static_cast<std::size_t>(column.width());
      known.push_back(column.name);
    }
    throw Error(fmt::format("--what '{}' is not a figure of the ensemble{}", name, did_you_mean(name, known)));
  }

  /// Which of the column's numbers: by the words behind its name, names of bodies, of columns, or numbers from 0.
  std::size_t place_in(const io::EnsembleColumn& column, const std::string& name, std::span<std::string> words) const {
    std::size_t place = 0, next = 0;
    for (std::size_t axis = 0; axis < column.shape.size(); ++axis) {
      const auto length = static_cast<std::size_t>(column.shape[axis]);
      const bool last = axis + 1 == column.shape.size();
      std::vector<std::string> labels;
      if (last && column.columns.size() == length) labels = column.columns;
      if (!last && names_.size() == length) labels = names_;
      if (last && length == 3 && axis > 0 && labels.empty()) labels = {"x", "y", "z"};
      place = place * length;
      if (next < words.size()) place += index_of(words[next], labels, length, name);
      ++next;
    }
    if (words.size() > column.shape.size()) {
      throw Error(fmt::format("--what '{}': {} has {} after its name at most", name, column.name,
                              counted(std::ssize(column.shape), "place")));
    }
    return place;
  }

  static std::size_t index_of(const std::string& word, const std::vector<std::string>& labels, std::size_t length,
                              const std::string& name) {
    const auto found = std::find(labels.begin(), labels.end(), word);
    if (found != labels.end()) return static_cast<std::size_t>(found - labels.begin());
    const bool number = !word.empty() && word.size() < 9 && word.find_first_not_of("0123456789") == word.npos;
    if (number && std::stoul(word) < length) return std::stoul(word);
    throw Error(fmt::format("--what '{}': there is no '{}'; {}", name, word,
                            labels.empty() ? fmt::format("0 to {} are expected", length - 1)
                                           : fmt::format("one of {} is expected", fmt::join(labels, ", "))));
  }

  std::string unit_of_column(const io::EnsembleColumn& column, const std::vector<std::string>& words) const {
    if (units_.is_reduced() || column.dimension == "1") return "";
    std::vector<std::string> each{""};
    for (const char c : column.dimension) {
      if (c == ',')
        each.emplace_back();
      else if (c != ' ')
        each.back().push_back(c);
    }
    std::string dimension = each.front();
    if (each.size() > 1) {
      const auto found = std::find(column.columns.begin(), column.columns.end(), words.back());
      dimension =
          found == column.columns.end() ? each.front() : each[static_cast<std::size_t>(found - column.columns.begin())];
    }
    if (dimension == "1") return "";
    return dimension == "angle" ? "rad" : unit_of(parse_dimension(dimension), units_);
  }

  /// "a of Saturn (au)" of particles.body.Saturn.a.
  std::string key_label(const Variation& key) const {
    std::string unit = key.unit;
    const SceneValue* value = find_path(scene_, key.key);
    const auto* text = value == nullptr ? nullptr : value->get<std::string>();
    if (unit.empty() && text != nullptr && text->find(' ') != text->npos) unit = text->substr(text->find(' ') + 1);
    const std::string body = "particles.body.";
    const std::size_t dot = key.key.rfind('.');
    if (!key.key.starts_with(body) || dot <= body.size()) return with_unit(key.key, unit);
    return with_unit(fmt::format("{} of {}", key.key.substr(dot + 1), key.key.substr(body.size(), dot - body.size())),
                     unit);
  }

  PlotPanel panel(const std::string& name, MemberFigure figure) const {
    PlotPanel made;
    made.large = true;
    made.x.label = key_label(keys_[0]);
    PlotCurve curve;
    curve.separate = true;
    if (keys_.size() == 1) {
      for (std::size_t k = 0; k < figure.values.size(); ++k) {
        if (!std::isnan(figure.values[k])) curve.points.push_back({table_.rows[k].values[0], figure.values[k]});
      }
      made.y.label = figure.label;
      made.curves.push_back(std::move(curve));
      fit_values(made);
      set_range(made.x, 0);
      made.points_alone = true;
      return made;
    }
    made.y.label = key_label(keys_[1]);
    PlotColors colors{.values = {}, .scale = {.label = figure.label}, .cells = in_cells()};
    std::map<std::pair<double, double>, std::pair<double, double>> cells;  // sum and number of what is in each
    for (std::size_t k = 0; k < figure.values.size(); ++k) {
      const double x = table_.rows[k].values[0], y = table_.rows[k].values[1], value = figure.values[k];
      if (colors.cells) {
        auto& [sum, count] = cells[{x, y}];
        if (!std::isnan(value)) sum += value, count += 1;
      } else if (!std::isnan(value)) {
        curve.points.push_back({x, y}), colors.values.push_back(value);
      }
    }
    for (const auto& [place, of] : cells) {
      curve.points.push_back({place.first, place.second}),
          colors.values.push_back(of.second > 0 ? of.first / of.second : nan);
    }
    set_colors(colors, name);
    made.curves.push_back(std::move(curve));
    set_range(made.x, 0), set_range(made.y, 1);
    made.colors = std::move(colors);
    return made;
  }

  /// An axis with all values of a key: up to the edges of the cells of a grid, with some air about draws.
  void set_range(PlotAxis& axis, std::size_t key) const {
    double low = INFINITY, high = -INFINITY;
    for (const io::EnsembleRow& row : table_.rows)
      low = std::min(low, row.values[key]), high = std::max(high, row.values[key]);
    const bool cells = in_cells() && !keys_[key].drawn();
    double air = cells ? (high - low) / (2 * static_cast<double>(keys_[key].count - 1)) : 0.03 * (high - low);
    if (!(air > 0)) air = 1;
    axis.low = low - air, axis.high = high + air;
  }

  /// All but the outermost hundredth of the values; of MEGNO, which has no upper end, what tells regular from chaotic.
  void set_colors(PlotColors& colors, const std::string& name) const {
    std::vector<double> told;
    for (const double value : colors.values) {
      if (!std::isnan(value)) told.push_back(value);
    }
    if (told.empty())
      throw Error(fmt::format("{}: no member has a {}: there is nothing to draw", file_.string(), name));
    std::sort(told.begin(), told.end());
    const auto last = static_cast<double>(told.size() - 1);
    const auto at = [&](double part) { return told[static_cast<std::size_t>(std::lround(part * last))]; };
    PlotAxis& scale = colors.scale;
    scale.low = at(0.01), scale.high = at(0.99);
    if (told.back() - told.front() <= 1.5 * (scale.high - scale.low))
      scale.low = told.front(), scale.high = told.back();
    scale.logarithmic = told.front() > 0 && scale.high > 100 * scale.low;
    if (name == "megno_mean" || name == "megno_value") scale = {.label = scale.label, .low = 1.9, .high = 4};
    if (!(scale.high > scale.low)) scale.high = scale.low + std::max(std::abs(scale.low), 1.0) * 1e-3;
  }

  std::filesystem::path file_;
  io::EnsembleTable table_;
  SceneValue scene_;
  RunCaption caption_;
  const UnitSystem& units_;
  std::vector<Variation> keys_;
  std::vector<std::string> names_;  ///< of bodies
  std::int64_t refused_ = -1;
};

}  // namespace

PlotData plot_ensemble(const std::filesystem::path& file, const Parts& parts, const PlotOptions& options) {
  return EnsemblePicture(file, parts).drawn(options);
}

}  // namespace noether
