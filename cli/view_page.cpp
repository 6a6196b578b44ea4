#include "cli/view_page.hpp"

#include "cli/view_files.hpp"
#include "numbers/error.hpp"
#include "scene/json.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <set>

namespace noether {

namespace {

/// Names are shown of so many bodies.
constexpr std::size_t most_names = 40;

/// Numbers of all frames as bytes that compress well: each less the one of the frame before, modulo 2^16 or 2^32, first
/// the least significant bytes of all, then the next.
template <class Word> std::string sorted_bytes(const std::vector<Word>& words, std::size_t row) {
  std::string bytes(words.size() * sizeof(Word), '\0');
  for (std::size_t k = 0; k < words.size(); ++k) {
    const auto change = static_cast<Word>(words[k] - (k < row ? Word{0} : words[k - row]));
    for (std::size_t byte = 0; byte < sizeof(Word); ++byte)
      bytes[byte * words.size() + k] = static_cast<char>((change >> (8 * byte)) & 0xffU);
  }
  return bytes;
}

std::vector<std::uint32_t> bits_of(const std::vector<float>& numbers) {
  std::vector<std::uint32_t> bits;
  bits.reserve(numbers.size());
  for (const float x : numbers) bits.push_back(std::bit_cast<std::uint32_t>(x));
  return bits;
}

std::string compressed(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string result(size, '\0');
  const int failed = compress2(reinterpret_cast<Bytef*>(result.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()), 6);
  if (failed != Z_OK) throw LogicError("the frames could not be compressed");
  result.resize(size);
  return result;
}

std::string base64(const std::string& bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() / 3 * 4 + 4);
  const auto byte = [&](std::size_t k) -> unsigned {
    return k < bytes.size() ? static_cast<std::uint8_t>(bytes[k]) : 0;
  };
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const unsigned three = byte(k) << 16U | byte(k + 1) << 8U | byte(k + 2);
    text += {digits[three >> 18U], digits[three >> 12U & 63U]};
    text += k + 1 < bytes.size() ? digits[three >> 6U & 63U] : '=';
    text += k + 2 < bytes.size() ? digits[three & 63U] : '=';
  }
  return text;
}

std::string frames_text(const ViewData& data) {
  const std::size_t row = 3 * data.particles();
  if (data.periodic()) return base64(compressed(sorted_bytes(data.fractions, row)));
  return base64(compressed(sorted_bytes(bits_of(data.positions), row) + sorted_bytes(bits_of(data.velocities), row)));
}

Json vectors(const ViewData& data, Vec3<double> ViewFrame::*member) {
  std::vector<double> numbers;
  for (const ViewFrame& frame : data.frames) {
    const Vec3<double>& v = frame.*member;
    numbers.insert(numbers.end(), {v[0], v[1], v[2]});
  }
  return Json::list_of(numbers);
}

const char* name_of(ViewPath path) {
  static constexpr std::array<const char*, 4> names = {"smooth", "arcs", "ellipse", "jumps"};
  return names[static_cast<std::size_t>(path)];
}

/// The names of the types, in the order of their first particle, and the number of each particle's.
std::pair<Json, Json> types_of(const ViewData& data) {
  std::vector<std::string> names;
  std::map<std::string, std::int64_t> numbers;
  std::vector<std::int64_t> types;
  for (const std::string& type : data.types) {
    const auto [at, is_new] = numbers.emplace(type, static_cast<std::int64_t>(names.size()));
    if (is_new) names.push_back(type);
    types.push_back(at->second);
  }
  return {Json::list_of(names), Json::list_of(types)};
}

/// What identifies few bodies in open space: their names, unless these are mere numbers.
Json names_of(const ViewData& data) {
  const bool plain = std::all_of(data.names.begin(), data.names.end(), [](const std::string& name) {
    return name.find_first_not_of("0123456789") == std::string::npos;
  });
  return data.periodic() || data.particles() > most_names || plain ? Json() : Json::list_of(data.names);
}

Json energy_of(const ViewData& data) {
  if (data.energy.time.size() < 2) return {};
  return Json::object({{"label", data.caption.energy_changes ? "energy: relative change" : "energy: relative error"},
                       {"times", Json::list_of(data.energy.time)},
                       {"sizes", Json::list_of(data.energy.size)}});
}

Json anchors_of(const ViewData& data) {
  std::vector<Json> anchors;
  for (const Anchor& one : data.links.anchors) {
    anchors.push_back(Json::list({static_cast<std::int64_t>(one.body), one.point[0], one.point[1], one.point[2]}));
  }
  return Json::list(anchors);
}

/// Everything but the frames.
std::string about(const ViewData& data) {
  std::vector<double> times;
  std::vector<std::int64_t> steps, links;
  for (const ViewFrame& frame : data.frames) times.push_back(frame.time), steps.push_back(frame.step);
  for (const auto& [i, j] : data.links.pairs) {
    links.push_back(static_cast<std::int64_t>(i)), links.push_back(static_cast<std::int64_t>(j));
  }
  std::vector<Json> paths;
  for (const ViewPath path : data.paths) paths.emplace_back(name_of(path));
  const bool few = data.particles() <= few_bodies;
  const auto [type_names, types] = types_of(data);
  const bool alike = std::set<double>(data.masses.begin(), data.masses.end()).size() < 2;
  return Json::object({{"schema", "noether.page/1"},
                       {"title", data.caption.title},
                       {"method", data.caption.method},
                       {"time_unit", data.caption.time.unit},
                       {"time_length", data.caption.time.length},
                       {"length_unit", data.length_unit},
                       {"particles", static_cast<std::int64_t>(data.particles())},
                       {"particles_in_file", static_cast<std::int64_t>(data.particles_in_file)},
                       {"frames_in_file", static_cast<std::int64_t>(data.frames_in_file)},
                       {"steps", Json::list_of(steps)},
                       {"times", Json::list_of(times)},
                       {"bytes", data.periodic() ? 2 : 4},
                       {"edges", data.periodic() ? vectors(data, &ViewFrame::edges) : Json()},
                       {"centers", data.periodic() ? Json() : vectors(data, &ViewFrame::center)},
                       {"center_velocities", data.periodic() || !few ? Json() : vectors(data, &ViewFrame::velocity)},
                       {"velocities", !data.velocities.empty()},
                       {"masses", few || !alike ? Json::list_of(data.masses) : Json()},
                       {"names", names_of(data)},
                       {"type_names", type_names},
                       {"types", types},
                       {"paths", Json::list(paths)},
                       {"primary", data.primary},
                       {"mu", Json::list_of(data.mu)},
                       {"links", Json::list_of(links)},
                       {"anchors", anchors_of(data)},
                       {"spacing", data.spacing},
                       {"energy", energy_of(data)}})
      .text();
}

std::string with_entities(const std::string& text) {
  std::string result;
  for (const char c : plain_line(text)) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

/// JSON inside of a script element: nothing in it can end the element.
std::string inside_script(const std::string& json) {
  std::string result;
  for (const char c : json) result += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return result;
}

/// The page with what it is to hold in its places.
std::string filled(const std::map<std::string, std::string>& parts) {
  const std::string page = view_page_text();
  std::string result;
  std::size_t at = 0;
  while (at < page.size()) {
    const std::size_t open = std::min(page.find('@', at), page.size());
    result.append(page, at, open - at);
    if (open == page.size()) break;
    const std::size_t close = page.find('@', open + 1);
    const auto part = close == std::string::npos ? parts.end() : parts.find(page.substr(open + 1, close - open - 1));
    if (part == parts.end()) throw LogicError("the page has a place that nothing fills");
    result += part->second;
    at = close + 1;
  }
  return result;
}

std::string page_of(const ViewData& data, const std::string& frames) {
  return filled({{"TITLE", with_entities(data.caption.title)},
                 {"STYLE", view_style_text()},
                 {"SCRIPT", view_script_text()},
                 {"ABOUT", inside_script(about(data))},
                 {"FRAMES", frames}});
}

}  // namespace

ViewPage view_page(const ViewData& data) {
  std::string html = page_of(data, frames_text(data));
  std::size_t frames = data.frames.size();
  while (html.size() > largest_page && frames > 2) {
    // A page of fewer frames is not quite as much smaller: what changes between two of them grows.
    const double part = 0.95 * static_cast<double>(largest_page) / static_cast<double>(html.size());
    frames = std::max<std::size_t>(static_cast<std::size_t>(static_cast<double>(frames) * part), 2);
    const ViewData fewer = with_frames(data, frames);
    html = page_of(fewer, frames_text(fewer));
  }
  return {std::move(html), frames};
}

}  // namespace noether
