#include "io/bodies.hpp"

#include "io/body_readers.hpp"
#include "io/files.hpp"
#include "numbers/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace noether::io {

TextFile::TextFile(std::filesystem::path file, std::string_view expected) : file_(std::move(file)) {
  static constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  const std::string bytes = read_bytes(file_);
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
    throw FileError("this is text in UTF-16; save it as UTF-8", {.file = file_.string()});
  }
  const std::size_t zero = bytes.find('\0');
  if (zero != std::string::npos) {
    throw FileError(fmt::format("this is not a text file: byte {} is zero; expected {}", zero, expected),
                    {.file = file_.string()});
  }
  std::string_view rest = bytes;
  if (rest.starts_with(byte_order_mark)) rest.remove_prefix(byte_order_mark.size());
  set_lines(rest);
}

TextFile TextFile::within(std::size_t line, std::string_view content) const {
  TextFile text;
  text.file_ = file_;
  text.outer_line_ = line;
  text.set_lines(content);
  return text;
}

void TextFile::set_lines(std::string_view rest) {
  // Lines end as in Unix, DOS, or, where there is no other end, as in the old Macintosh.
  const char line_end = rest.find('\n') == std::string_view::npos ? '\r' : '\n';
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(line_end), rest.size());
    std::string_view line = rest.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines_.emplace_back(line);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

void TextFile::fail(std::size_t line, const std::string& message, const std::string& value) const {
  const bool inner = outer_line_ != 0;
  const std::string place = inner && line != 0 ? fmt::format("line {} of its text: ", line) : "";
  throw SceneError(place + message,
                   {.file = file_.string(), .line = static_cast<int>(inner ? outer_line_ : line), .value = value});
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::vector<std::string> split_at(std::string_view text, char separator) {
  std::vector<std::string> fields;
  while (true) {
    const std::size_t end = text.find(separator);
    fields.emplace_back(trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return fields;
    text.remove_prefix(end + 1);
  }
}

Heading parse_heading(std::string_view text) {
  const std::size_t bracket = text.find_first_of("[(");
  const bool closed = bracket != std::string_view::npos && text.ends_with(text[bracket] == '[' ? ']' : ')');
  if (!closed) return {std::string(text), {}};
  return {std::string(trimmed(text.substr(0, bracket))),
          std::string(trimmed(text.substr(bracket + 1, text.size() - bracket - 2)))};
}

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// A number of Fortran with its exponent as C has it: 1.5D+03 becomes 1.5e+03. Other words stay as they are.
std::string with_exponent_of_c(std::string_view word) {
  std::string number(word);
  const std::size_t mark = word.find_first_of("Dd");
  if (mark == std::string_view::npos || mark == 0 || mark + 1 == word.size()) return number;
  const char before = word[mark - 1];
  std::string_view power = word.substr(mark + 1);
  if (power.front() == '+' || power.front() == '-') power.remove_prefix(1);
  const bool whole = !power.empty() && std::all_of(power.begin(), power.end(), is_digit);
  if (whole && (is_digit(before) || before == '.')) number[mark] = 'e';
  return number;
}

/// Ends the refusal of what is no number with what it may be meant as.
std::string_view meant_by(std::string_view word) {
  if (word.find(',') != std::string_view::npos) return "; use a decimal point";
  static constexpr std::array<std::string_view, 4> minus_signs = {"\xE2\x88\x92", "\xE2\x80\x93", "\xE2\x80\x92",
                                                                  "\xE2\x80\x90"};
  for (const std::string_view sign : minus_signs) {
    if (word.find(sign) != std::string_view::npos) return "; write a minus as '-'";
  }
  return "";
}

}  // namespace

double number_in(const TextFile& text, std::size_t line, std::string_view word, const std::string& what) {
  const std::string shown(word), plain = with_exponent_of_c(word);
  if (word.empty()) text.fail(line, what + " is empty; expected a number");
  std::string_view digits = plain;
  if (digits.front() == '+') digits.remove_prefix(1);
  double number = 0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (problem == std::errc::result_out_of_range) {
    text.fail(line, fmt::format("{} is {}, which is outside the range of doubles", what, shown), shown);
  }
  if (problem != std::errc() || end != digits.data() + digits.size() || digits.front() == '+') {
    text.fail(line, fmt::format("{} is '{}', which is not a number{}", what, shown, meant_by(word)), shown);
  }
  if (!std::isfinite(number)) text.fail(line, fmt::format("{} is {}; expected a finite number", what, shown), shown);
  return number;
}

double mass_number_in(const TextFile& text, std::size_t line, std::string_view word, const std::string& what) {
  const double number = number_in(text, line, word, what);
  if (number < 0) text.fail(line, fmt::format("{} is {}; expected 0 or more", what, word), std::string(word));
  return number;
}

void BodyList::add(std::size_t line, const std::string& name, double mass, const Vec3<double>& x,
                   const Vec3<double>& v) {
  if (const std::string wrong = wrong_name(name); !wrong.empty()) text_.fail(line, wrong, name);
  for (const double number : {mass, x[0], x[1], x[2], v[0], v[1], v[2]}) {
    if (!std::isfinite(number)) text_.fail(line, fmt::format("the state of {} is not finite in these units", name));
  }
  if (!names_.insert(name).second)
    text_.fail(line, fmt::format("the name '{}' is already used; names must differ", name), name);
  particles_.add(name, mass, x, v);
}

BodyTable read_body_table(const std::filesystem::path& file, const BodiesOptions& options) {
  const TextFile text = horizons_answer(TextFile(file));
  return is_horizons(text) ? read_horizons_bodies(text, options) : read_csv_bodies(text, options);
}

ParticleSystem<double> read_bodies(const std::filesystem::path& file, const BodiesOptions& options) {
  return read_body_table(file, options).particles;
}

}  // namespace noether::io
