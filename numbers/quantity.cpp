#include "numbers/quantity.hpp"

#include "numbers/error.hpp"
#include "numbers/suggest.hpp"
#include "numbers/unit_words.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <system_error>
#include <utility>

namespace noether {

namespace {

[[noreturn]] void fail(const std::string& message, std::string_view text) {
  throw Error(message, {.value = std::string(text)});
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return "";
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

/// A word of a product: "day", or "1", with its power, multiplied or divided.
struct Term {
  std::string_view word;
  int power = 1;
  bool divides = false;
};

/// Letters, and whatever is not ASCII: an unknown unit is then named whole.
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || static_cast<unsigned char>(c) >= 128;
}
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Reads products of words; `whole` is what messages quote.
class TermReader {
 public:
  TermReader(std::string_view text, std::string_view whole) : rest_(text), whole_(whole) {}

  /// All terms. An operator may stand before the first one, as in "1" followed by "/ps".
  std::vector<Term> read(bool operator_first) {
    std::vector<Term> terms;
    skip_blanks();
    while (!rest_.empty()) {
      const bool may_join = operator_first || !terms.empty();
      const bool divides = may_join && take('/');
      if (may_join && !divides) take('*');
      terms.push_back(read_term(divides));
    }
    return terms;
  }

 private:
  Term read_term(bool divides) {
    std::size_t length = 0;
    while (length < rest_.size() && (is_letter(rest_[length]) || (length > 0 && rest_[length] == '_'))) ++length;
    if (length == 0 && rest_.starts_with('1')) length = 1;
    if (length == 0) unexpected();
    Term term{.word = rest_.substr(0, length), .power = 1, .divides = divides};
    rest_.remove_prefix(length);
    read_power(term);
    const bool ends = rest_.empty() || rest_[0] == ' ' || rest_[0] == '*' || rest_[0] == '/';
    if (!ends) unexpected();
    skip_blanks();
    return term;
  }

  /// "^-1", "**-1", or the number alone, as catalogs of stars have it: "km s-1". Behind "1" and behind the sign of
  /// degrees a number alone is no power: "1/12 yr" would be a year, and minutes of arc would be lost.
  void read_power(Term& term) {
    const std::size_t mark = rest_.starts_with("**") ? 2 : rest_.starts_with('^') ? 1 : 0;
    const std::string_view behind = rest_.substr(mark);
    const std::size_t sign = behind.starts_with('-') ? 1 : 0;
    const bool has_bare_powers = term.word != "1" && term.word != "\xC2\xB0";
    if (mark == 0 && (!has_bare_powers || behind.size() <= sign || !is_digit(behind[sign]))) return;
    rest_.remove_prefix(mark);
    int power = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), power);
    if (error != std::errc() || power < -9 || power > 9) {
      fail(fmt::format("bad power in '{}'; expected a whole number from -9 to 9, as in 'm^2'", whole_), whole_);
    }
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    term.power = power;
  }

  bool take(char c) {
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    skip_blanks();
    return true;
  }

  void skip_blanks() {
    while (rest_.starts_with(' ')) rest_.remove_prefix(1);
  }

  [[noreturn]] void unexpected() const {
    const std::string_view what = rest_.empty() ? "end" : rest_.substr(0, 1);
    const char* const quote = rest_.empty() ? "" : "'";
    fail(fmt::format("unexpected {}{}{} in '{}'; units are joined by '*', '/' or a space, as in 'kg m/s^2'", quote,
                     what, quote, whole_),
         whole_);
  }

  std::string_view rest_, whole_;
};

/// Those of the words that fit.
std::vector<std::string> fitting(std::vector<std::string> words, const std::function<bool(std::string_view)>& fits) {
  std::erase_if(words, [&](const std::string& word) { return !fits(word); });
  return words;
}

/// The unit made of two words, "kJ/mol", "kJ mol^-1" or "g/cm^3", where the terms at i spell one.
const units::Definition* find_quotient(const std::vector<Term>& terms, std::size_t i) {
  if (i + 1 >= terms.size() || terms[i].divides || terms[i].power != 1) return nullptr;
  Term below = terms[i + 1];
  if (below.word == "mol" && !below.divides) below = {.word = "mol", .power = -below.power, .divides = true};
  if (!below.divides) return nullptr;
  const std::string power = below.power == 1 ? "" : fmt::format("^{}", below.power);
  return find_unit(fmt::format("{}/{}{}", terms[i].word, below.word, power));
}

/// The value of a unit in a system; plain numbers, such as the degree, are the same in all.
double value_in(const units::Definition& unit, const UnitSystem& system) {
  return units::value(unit, system.scale.value_or(units::si_scale));
}

void append(Unit& unit, const units::Definition& definition, const Term& term, const UnitSystem& system) {
  unit.dimension = term.divides ? unit.dimension / power(definition.dimension, term.power)
                                : unit.dimension * power(definition.dimension, term.power);
  const double one = value_in(definition, system);
  double value = 1;
  for (int i = 0; i < std::abs(term.power); ++i) value *= one;
  unit.factors.push_back({value, term.divides != (term.power < 0)});
}

/// The terms of a unit, by their symbols.
std::vector<Term> unit_terms(std::string_view text, std::string_view whole, bool operator_first) {
  std::vector<Term> terms = TermReader(text, whole).read(operator_first);
  for (Term& term : terms) term.word = symbol_of(term.word);
  return terms;
}

/// Whether the reduced system knows every word: it has plain numbers and angles only.
bool all_plain(const std::vector<Term>& terms) {
  for (const Term& term : terms) {
    const units::Definition* const unit = find_unit(term.word);
    if (term.word != "1" && (unit == nullptr || unit->dimension != dimensions::none)) return false;
  }
  return true;
}

struct NamedDimension {
  std::string_view name;
  Dimension dimension;
};

/// Words for dimensions; the first of each dimension is the one that is written.
constexpr std::array named_dimensions = {
    NamedDimension{"1", dimensions::none},
    NamedDimension{"angle", dimensions::none},
    NamedDimension{"length", dimensions::length},
    NamedDimension{"time", dimensions::time},
    NamedDimension{"mass", dimensions::mass},
    NamedDimension{"charge", dimensions::charge},
    NamedDimension{"temperature", dimensions::temperature},
    NamedDimension{"velocity", dimensions::velocity},
    NamedDimension{"acceleration", dimensions::acceleration},
    NamedDimension{"force", dimensions::force},
    NamedDimension{"energy", dimensions::energy},
    NamedDimension{"frequency", dimensions::frequency},
    NamedDimension{"density", dimensions::density},
    NamedDimension{"pressure", dimensions::pressure},
};

const NamedDimension* find_dimension(std::string_view name) {
  for (const NamedDimension& named : named_dimensions) {
    if (named.name == name) return &named;
  }
  return nullptr;
}

/// "mass length^2/time^2" from the exponents and a word for each base quantity.
std::string product(const Dimension& d, const std::array<std::string_view, 5>& words) {
  const std::array<int, 5> powers = {d.mass, d.length, d.charge, d.temperature, d.time};
  std::string above, below;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const int n = std::abs(powers[i]);
    if (n == 0) continue;
    const std::string factor = n == 1 ? std::string(words[i]) : fmt::format("{}^{}", words[i], n);
    if (powers[i] > 0) {
      above += (above.empty() ? "" : " ") + factor;
    } else {
      below += "/" + factor;
    }
  }
  return (above.empty() ? "1" : above) + below;
}

/// "a time", "an energy", "a quantity of dimension length^3/time^2".
std::string with_article(const Dimension& dimension) {
  if (dimension == dimensions::none) return "a plain number";
  const std::string text = to_text(dimension);
  if (!find_dimension(text)) return "a quantity of dimension " + text;
  return (text[0] == 'a' || text[0] == 'e' ? "an " : "a ") + text;
}

/// What a text should be: a dimension, or an angle, which has none.
struct Expected {
  Dimension dimension = dimensions::none;
  bool angle = false;
};

/// "a time is expected, such as '100 day'".
std::string expectation(const Expected& wanted, std::string_view number, const UnitSystem& system) {
  if (wanted.angle) return fmt::format("an angle is expected, such as '{} deg'", number);
  return fmt::format("{} is expected, such as '{}'", with_article(wanted.dimension),
                     example_of(wanted.dimension, number, system));
}

/// What a unit is read for. `told` is how messages say it: "a time is expected, such as '1 day'".
struct UnitPurpose {
  Expected expected;
  std::string told;
};

/// Whether a dimension may be a factor of another one, as length is of a velocity.
bool is_part_of(const Dimension& factor, const Dimension& whole) {
  const auto in = [](int some, int all) {
    return some == 0 || ((some > 0) == (all > 0) && std::abs(some) <= std::abs(all));
  };
  return factor != dimensions::none && in(factor.length, whole.length) && in(factor.mass, whole.mass) &&
         in(factor.time, whole.time) && in(factor.charge, whole.charge) && in(factor.temperature, whole.temperature);
}

/// Whether the words behind the unknown one at `i`, which is the first, are units.
bool others_are_known(const std::vector<Term>& terms, std::size_t i) {
  const auto is_known = [](const Term& term) { return term.word == "1" || find_unit(term.word) != nullptr; };
  return std::all_of(terms.begin() + static_cast<std::ptrdiff_t>(i) + 1, terms.end(), is_known);
}

/// Whether a word in the place of the unknown one at `i` may be meant: the whole then has the expected dimension, or
/// may have it where other words are unknown too. All may be where nothing is expected. Angles change no dimension, so
/// that they would fit everywhere: they may be meant only where an angle is expected.
std::function<bool(std::string_view)> fits_at(const std::vector<Term>& terms, std::size_t i,
                                              const std::optional<UnitPurpose>& purpose) {
  const bool last = others_are_known(terms, i);
  return [&terms, i, last, wanted = purpose ? std::optional(purpose->expected) : std::nullopt](std::string_view word) {
    if (!wanted) return true;
    const auto dimension_of = [](std::string_view one, const Term& term) {
      const units::Definition* const unit = find_unit(one);
      return unit ? power(unit->dimension, term.divides ? -term.power : term.power) : dimensions::none;
    };
    const Dimension own = dimension_of(symbol_of(word), terms[i]);
    if (own == dimensions::none && !wanted->angle) return false;
    if (!last) return is_part_of(own, wanted->dimension);
    Dimension whole = own;
    for (std::size_t k = 0; k < terms.size(); ++k) {
      if (k != i) whole = whole * dimension_of(terms[k].word, terms[k]);
    }
    return whole == wanted->dimension;
  };
}

[[noreturn]] void unknown_unit(const std::vector<Term>& terms, std::size_t i, std::string_view whole,
                               const std::optional<UnitPurpose>& purpose) {
  const std::string_view word = terms[i].word;
  const auto fits = fits_at(terms, i, purpose);
  const std::vector<std::string> known = fitting(symbols_of_units(), fits);
  std::string near;
  // Half of a quotient has one answer, however far it is in letters.
  for (const std::string& symbol : known) {
    const bool half = symbol.starts_with(word) && std::string_view(symbol).substr(word.size()).starts_with('/');
    if (half && near.empty()) near = symbol;
  }
  if (near.empty()) near = suggest(word, known);
  if (near.empty()) near = suggest(word, fitting(words_for_units(), fits));
  const bool all_fit = !known.empty() && (!purpose || others_are_known(terms, i));
  const std::string end = !near.empty() ? fmt::format("did you mean '{}'?", near)
                          : all_fit     ? fmt::format("expected one of: {}", fmt::join(known, ", "))
                                        : purpose->told;
  const std::string in = word == whole ? "" : fmt::format(" in '{}'", whole);
  fail(fmt::format("unknown unit '{}'{}; {}", word, in, end), whole);
}

/// @param purpose  what it is read for, where that is known: no unit of another dimension is proposed
Unit unit_from(const std::vector<Term>& terms, std::string_view whole, const UnitSystem& system,
               const std::optional<UnitPurpose>& purpose) {
  Unit unit;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (terms[i].word == "1") continue;
    const units::Definition* const quotient = find_quotient(terms, i);
    const units::Definition* const definition = quotient ? quotient : find_unit(terms[i].word);
    if (!definition) unknown_unit(terms, i, whole, purpose);
    append(unit, *definition, terms[i], system);
    if (quotient) ++i;
  }
  return unit;
}

/// All units without a dimension are angles.
bool is_angle(const Term& term) {
  const units::Definition* const unit = find_unit(term.word);
  return unit != nullptr && unit->dimension == dimensions::none;
}

/// What a quantity with a unit is, in words: "an angle", "a time", "a plain number".
std::string kind_of(const std::vector<Term>& terms, const Dimension& dimension) {
  return terms.size() == 1 && is_angle(terms[0]) ? "an angle" : with_article(dimension);
}

/// The number at the front of a text and how many characters it takes.
struct Number {
  double value = 0;
  std::size_t length = 0;
};

Number read_number(std::string_view text, const Expected& expected, const UnitSystem& system) {
  // std::from_chars reads no plus sign, and would read the minus of "+-1".
  const bool plus = text.starts_with('+') && !text.starts_with("+-");
  const char* const first = text.data() + (plus ? 1 : 0);
  Number number;
  const auto [end, error] = std::from_chars(first, text.data() + text.size(), number.value);
  number.length = static_cast<std::size_t>(end - text.data());
  const auto complain = [&](std::string_view what) {
    fail(fmt::format("'{}' {}; {}", text, what, expectation(expected, "1", system)), text);
  };
  if (text.empty()) complain("is empty");
  if (error == std::errc::invalid_argument) complain("does not begin with a number");
  if (error == std::errc::result_out_of_range) complain("is outside the range of numbers, about 1e-308 to 1e308");
  if (!std::isfinite(number.value)) complain("is not finite");
  return number;
}

/// Refuses an exponent of Fortran, 1.5D+30 kg: without a blank it may be days as well, 1d-3.
void refuse_exponent_of_fortran(std::string_view whole, const Number& number) {
  const std::string_view behind = whole.substr(number.length);
  if (!behind.starts_with('D') && !behind.starts_with('d')) return;
  const std::size_t digit = behind.size() > 1 && (behind[1] == '-' || behind[1] == '+') ? 2 : 1;
  if (behind.size() <= digit || !is_digit(behind[digit])) return;
  fail(fmt::format("'{}' has a Fortran-style exponent; write '{}e{}'", whole, whole.substr(0, number.length),
                   behind.substr(1)),
       whole);
}

double read_quantity(std::string_view text, const Expected& wanted, const UnitSystem& system) {
  const std::string_view whole = trimmed(text);
  const Number number = read_number(whole, wanted, system);
  refuse_exponent_of_fortran(whole, number);
  const std::string_view digits = whole.substr(0, number.length);
  if (number.length == whole.size()) {
    if (system.is_reduced() || (wanted.dimension == dimensions::none && !wanted.angle)) return number.value;
    fail(fmt::format("'{}' has no unit; {}", whole, expectation(wanted, digits, system)), whole);
  }
  const std::vector<Term> terms = unit_terms(whole.substr(number.length), whole, true);
  if (system.is_reduced() && !all_plain(terms)) {
    fail(fmt::format("'{}' has a unit; reduced units are plain numbers, such as '{}'", whole, digits), whole);
  }
  const Unit unit = unit_from(terms, whole, system, UnitPurpose{wanted, expectation(wanted, digits, system)});
  if (unit.dimension != wanted.dimension || (wanted.angle && !std::any_of(terms.begin(), terms.end(), is_angle))) {
    fail(fmt::format("'{}' is {}; {}", whole, kind_of(terms, unit.dimension), expectation(wanted, digits, system)),
         whole);
  }
  const double value = unit.times(number.value);
  if (!std::isfinite(value)) fail(fmt::format("'{}' is too large for the {} system", whole, system.name), whole);
  return value;
}

}  // namespace

double Unit::times(double number) const noexcept {
  for (const Factor& factor : factors) number = factor.divides ? number / factor.value : number * factor.value;
  return number;
}

namespace {

Unit unit_for(std::string_view text, const UnitSystem& system, const std::optional<UnitPurpose>& purpose) {
  const std::string_view whole = trimmed(text);
  if (whole.empty()) fail("empty unit; expected one such as 'km/s', or '1' for a plain number", text);
  const std::vector<Term> terms = unit_terms(whole, whole, false);
  if (system.is_reduced() && !all_plain(terms)) {
    fail(fmt::format("unit '{}' in the reduced unit system, where numbers have no units; leave the unit out, or choose "
                     "solar, molecular or si",
                     whole),
         whole);
  }
  return unit_from(terms, whole, system, purpose);
}

}  // namespace

Unit parse_unit(std::string_view text, const UnitSystem& system) { return unit_for(text, system, {}); }

Unit parse_unit(std::string_view text, std::string_view dimension, const UnitSystem& system) {
  const Expected wanted{.dimension = parse_dimension(dimension), .angle = dimension == "angle"};
  const std::string example = wanted.angle ? "deg" : unit_of(wanted.dimension, system);
  const bool plain = wanted.dimension == dimensions::none && !wanted.angle;
  return unit_for(
      text, system,
      UnitPurpose{wanted, plain ? "a plain number is expected"
                                : fmt::format("a unit of {} is expected, such as '{}'", dimension, example)});
}

double unit_value(std::string_view unit, const UnitSystem& system) { return parse_unit(unit, system).times(1.0); }

double parse_quantity(std::string_view text, const Dimension& expected, const UnitSystem& system) {
  return read_quantity(text, {.dimension = expected}, system);
}

double parse_angle(std::string_view text, const UnitSystem& system) {
  return read_quantity(text, {.angle = true}, system);
}

std::string example_of(const Dimension& dimension, std::string_view number, const UnitSystem& system) {
  const std::string unit = unit_of(dimension, system);
  if (unit == "1") return std::string(number);
  // "1 1/day" would puzzle; "1/day" reads as it is written.
  return unit.starts_with("1/") ? std::string(number) + unit.substr(1) : fmt::format("{} {}", number, unit);
}

Dimension parse_dimension(std::string_view text) {
  const std::string_view whole = trimmed(text);
  if (whole.empty()) fail("empty dimension; expected one such as 'length/time', or '1' for a plain number", text);
  Dimension result;
  for (const Term& term : TermReader(whole, whole).read(false)) {
    const NamedDimension* const named = find_dimension(term.word);
    if (!named) {
      std::vector<std::string> known;
      for (const NamedDimension& candidate : named_dimensions) known.emplace_back(candidate.name);
      fail(fmt::format("unknown dimension '{}'{}", term.word, did_you_mean(term.word, known)), whole);
    }
    result = result * power(named->dimension, term.divides ? -term.power : term.power);
  }
  return result;
}

std::string to_text(const Dimension& dimension) {
  for (const NamedDimension& named : named_dimensions) {
    if (named.dimension == dimension) return std::string(named.name);
  }
  return product(dimension, {"mass", "length", "charge", "temperature", "time"});
}

std::string unit_of(const Dimension& dimension, const UnitSystem& system) {
  if (system.is_reduced() || dimension == dimensions::none) return "1";
  if (dimension == dimensions::energy) return std::string(system.energy);
  return product(dimension, {system.mass, system.length, system.charge, system.temperature, system.time});
}

std::string format_number(double value) {
  if (std::isnan(value)) return "nan";
  std::array<char, 32> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return error == std::errc() ? std::string(buffer.data(), end) : fmt::format("{}", value);
}

std::vector<UnitRow> list_units() {
  const UnitSystem& solar = unit_system("solar");
  const UnitSystem& molecular = unit_system("molecular");
  const UnitSystem& si = unit_system("si");
  const UnitSystem& reduced = unit_system("reduced");
  std::vector<UnitRow> rows;
  const auto add = [&](const units::Definition& unit) {
    UnitRow row{.symbol = std::string(unit.symbol),
                .constant = std::string(unit.constant),
                .dimension = unit.dimension == dimensions::none ? "angle" : to_text(unit.dimension),
                .solar = value_in(unit, solar),
                .molecular = value_in(unit, molecular),
                .si = value_in(unit, si),
                .reduced = std::nullopt};
    if (unit.dimension == dimensions::none) row.reduced = value_in(unit, reduced);
    rows.push_back(std::move(row));
  };
  for (const units::Definition& unit : units::definitions) add(unit);
  for (const units::Definition& unit : units_of_texts()) add(unit);
  const auto add_constant = [&](const char* name, const char* dimension, double UnitSystem::*value) {
    rows.push_back({name, name, dimension, solar.*value, molecular.*value, si.*value, reduced.*value});
  };
  add_constant("G", "length^3/mass/time^2", &UnitSystem::G);
  add_constant("k_B", "energy/temperature", &UnitSystem::k_B);
  add_constant("coulomb_constant", "energy length/charge^2", &UnitSystem::coulomb_constant);
  return rows;
}

}  // namespace noether
