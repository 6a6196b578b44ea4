#include "study/variation.hpp"

#include "numbers/error.hpp"
#include "numbers/random.hpp"
#include "numbers/suggest.hpp"
#include "numbers/text.hpp"
#include "scene/key_paths.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

namespace noether {

namespace {

/// Streams of draws begin here: builders of particles have the first ones.
constexpr std::uint32_t first_stream = 1U << 16U;

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// Reads one variation.
class VariationText {
 public:
  explicit VariationText(std::string_view text) : text_(text) {}

  Variation read() const {
    const std::size_t equals = text_.find('=');
    const std::string_view key = trimmed(text_.substr(0, equals));
    if (equals == std::string_view::npos || key.empty()) {
      fail("expected KEY=a:b:n, KEY=uniform(a,b) or KEY=normal(m,s), such as particles.body.b.e=0:0.4:64");
    }
    Variation made{.key = std::string(key), .text = std::string(text_)};
    const std::string_view value = trimmed(text_.substr(equals + 1));
    const std::size_t open = value.find('(');
    open == std::string_view::npos ? read_grid(value, made) : read_draw(value, open, made);
    return made;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw Error(fmt::format("--vary {}: {}", text_, why), {.value = std::string(text_)});
  }

  double number(std::string_view text) const {
    text = trimmed(text);
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
      fail(fmt::format("'{}' is not a number; a finite one is expected", text));
    }
    return value;
  }

  void read_grid(std::string_view value, Variation& made) const {
    const std::size_t one = value.find(':'), two = one == std::string_view::npos ? one : value.find(':', one + 1);
    if (one == std::string_view::npos) {
      fail(fmt::format("'{}' is neither a grid a:b:n nor uniform(a,b) or normal(m,s); for one value use --set", value));
    }
    if (two == std::string_view::npos) {
      fail(fmt::format("a grid has a number of points; give {}:64, say, for 64 of them", value));
    }
    made.first = number(value.substr(0, one));
    made.second = number(value.substr(one + 1, two - one - 1));
    std::string_view points = trimmed(value.substr(two + 1));
    const std::size_t space = points.find(' ');
    if (space != std::string_view::npos) made.unit = trimmed(points.substr(space));
    points = points.substr(0, space);
    const auto [end, error] = std::from_chars(points.data(), points.data() + points.size(), made.count);
    if (error == std::errc::result_out_of_range || (error == std::errc() && made.count > EnsemblePlan::most_members)) {
      fail(fmt::format("{} points are too many; at most {} members are possible", points, EnsemblePlan::most_members));
    }
    if (error != std::errc() || end != points.data() + points.size()) {
      fail(fmt::format("'{}' is not a number of points; a whole number of at least 2 is expected", points));
    }
    if (made.count < 2) {
      fail(fmt::format("a grid of {} has no ends; give at least 2, or one value by --set",
                       counted(made.count, "point")));
    }
  }

  void read_draw(std::string_view value, std::size_t open, Variation& made) const {
    const std::string_view name = trimmed(value.substr(0, open));
    if (name != "uniform" && name != "normal") {
      fail(fmt::format("there is no distribution '{}'{}", name, did_you_mean(name, {"uniform", "normal"})));
    }
    made.kind = name == "uniform" ? Variation::Kind::uniform : Variation::Kind::normal;
    const std::size_t close = value.find(')', open), comma = value.find(',', open);
    if (close == std::string_view::npos || comma == std::string_view::npos || comma > close) {
      fail(fmt::format("{} has two numbers: {}", name,
                       made.kind == Variation::Kind::uniform ? "uniform(a,b), from a to b"
                                                             : "normal(m,s), mean and standard deviation"));
    }
    made.first = number(value.substr(open + 1, comma - open - 1));
    made.second = number(value.substr(comma + 1, close - comma - 1));
    made.unit = trimmed(value.substr(close + 1));
    if (made.kind == Variation::Kind::normal && !(made.second > 0)) {
      fail(fmt::format("{} is not a valid standard deviation; a number above 0 is expected", made.second));
    }
    if (made.kind == Variation::Kind::uniform && !(made.first < made.second)) {
      fail(fmt::format("the range from {} to {} is empty; the first number must be below the second", made.first,
                       made.second));
    }
  }

  std::string_view text_;
};

double draw(const Variation& variation, const Philox& stream, std::int64_t member) {
  const std::array<std::uint32_t, 4> bits = stream.at(static_cast<std::uint64_t>(member));
  if (variation.kind == Variation::Kind::normal) return variation.first + variation.second * normal_pair(bits)[0];
  const double u = open_uniform(bits[0], bits[1]);
  return variation.first * (1 - u) + variation.second * u;  // no difference of the ends, which may be too large
}

double grid_point(const Variation& grid, std::int64_t k) {
  const double last = static_cast<double>(grid.count - 1), at = static_cast<double>(k);
  return (grid.first * (last - at) + grid.second * at) / last;  // both ends are exact
}

}  // namespace

Variation Variation::parse(std::string_view text) { return VariationText(text).read(); }

EnsemblePlan::EnsemblePlan(std::vector<Variation> variations, std::optional<std::int64_t> draws, std::int64_t seed)
    : variations_(std::move(variations)), seed_(seed) {
  if (variations_.empty()) throw Error("nothing varies; give --vary KEY=a:b:n at least once");
  if (seed < 0) throw Error(fmt::format("--seed {} is not valid; a whole number of 0 or more is expected", seed));
  std::set<std::string> keys;
  bool drawn = false;
  const auto multiply = [this](std::int64_t count) {
    if (count <= most_members / members_) return void(members_ *= count);
    throw Error(fmt::format("the ensemble has more than {} members, which are the most that are possible; take fewer",
                            most_members));
  };
  for (const Variation& one : variations_) {
    if (!keys.insert(one.key).second)
      throw Error(fmt::format("'{}' varies twice; give --vary {} once", one.key, one.key));
    drawn = drawn || one.drawn();
    if (one.drawn()) continue;
    multiply(one.count);
    shape_.push_back(one.count);
  }
  if (drawn && !draws)
    throw Error("values are drawn at random, and nothing says for how many members; give --members N");
  if (!drawn && draws && *draws != members_) {
    throw Error(fmt::format("--members {} is the number of draws, but nothing is drawn: the grids have {}; take it out",
                            *draws, counted(members_, "member")));
  }
  if (!drawn) return;
  if (*draws < 1)
    throw Error(fmt::format("--members {} is not a valid number of members; 1 or more are expected", *draws));
  draws_ = *draws;
  multiply(draws_);
  shape_.push_back(draws_);
}

std::vector<double> EnsemblePlan::values(std::int64_t member) const {
  std::vector<double> values(variations_.size());
  std::int64_t point = member / draws_;
  for (std::size_t k = variations_.size(); k-- > 0;) {
    if (variations_[k].drawn()) continue;
    values[k] = grid_point(variations_[k], point % variations_[k].count);
    point /= variations_[k].count;
  }
  std::uint32_t stream = first_stream;
  for (std::size_t k = 0; k < variations_.size(); ++k) {
    if (!variations_[k].drawn()) continue;
    values[k] = draw(variations_[k], Philox(static_cast<std::uint64_t>(seed_), stream++), member);
  }
  return values;
}

std::vector<std::string> EnsemblePlan::fastest_keys() const {
  std::vector<std::string> drawn;
  for (const Variation& one : variations_) {
    if (one.drawn()) drawn.push_back(one.key);
  }
  return drawn.empty() ? std::vector<std::string>{variations_.back().key} : drawn;
}

std::vector<double> EnsemblePlan::typical_values() const {
  std::vector<double> values;
  for (const Variation& one : variations_) values.push_back(one.first);
  return values;
}

VariedKeys::VariedKeys(const SceneValue& scene, const std::vector<Variation>& variations) {
  for (const Variation& one : variations) {
    Key key{.key = one.key, .unit = one.unit};
    const auto refuse = [&](const SceneValue& value) {
      throw Error(fmt::format("--vary {}: {} = {} is {}, which cannot vary; a number is expected", one.text, one.key,
                              to_text(value), kind_of(value)),
                  {.key = one.key, .value = one.text});
    };
    if (const SceneValue* value = find_path(scene, one.key)) {
      key.whole = value->get<std::int64_t>() != nullptr;
      const std::string* text = value->get<std::string>();
      if (!key.whole && text == nullptr && value->get<double>() == nullptr) refuse(*value);
      if (text != nullptr) {  // a quantity: "1.5 au"
        double number = 0;
        const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), number);
        if (error != std::errc()) refuse(*value);
        const auto digits = static_cast<std::size_t>(end - text->data());
        if (key.unit.empty()) key.unit = trimmed(std::string_view(*text).substr(digits));
      }
    }
    keys_.push_back(std::move(key));
  }
}

std::vector<std::string> VariedKeys::sets(const std::vector<double>& values) const {
  std::vector<std::string> sets;
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const Key& key = keys_[k];
    const bool whole = key.whole && values[k] == std::round(values[k]) && std::abs(values[k]) < 9e15;
    const std::string number =
        whole ? std::to_string(static_cast<std::int64_t>(values[k])) : fmt::format("{}", values[k]);
    sets.push_back(key.unit.empty() ? fmt::format("{}={}", key.key, number)
                                    : fmt::format("{}=\"{} {}\"", key.key, number, key.unit));
  }
  return sets;
}

}  // namespace noether
