#include "numbers/quantity.hpp"

#include "numbers/error.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
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

/// Another word for a unit of the table; plurals are made of `constant` and of these.
struct Alias {
  std::string_view word, symbol;
};
constexpr std::array aliases = {
    Alias{"h", "hour"},
    Alias{"hr", "hour"},
    Alias{"hrs", "hour"},
    Alias{"yrs", "yr"},
    Alias{"AU", "au"},
    Alias{"parsec", "pc"},
    Alias{"kilometer", "km"},
    Alias{"centimeter", "cm"},
    Alias{"nanometer", "nm"},
    Alias{"femtosecond", "fs"},
    Alias{"picosecond", "ps"},
    Alias{"nanosecond", "ns"},
    Alias{"kilogram", "kg"},
    Alias{"kelvin", "K"},
    // As astropy, VizieR, catalogs and files of molecules have them.
    Alias{"sec", "s"},
    Alias{"d", "day"},
    Alias{"solMass", "Msun"},
    Alias{"M_sun", "Msun"},
    Alias{"M_Sun", "Msun"},
    Alias{"Msol", "Msun"},
    Alias{"MSun", "Msun"},
    Alias{"M\xE2\x98\x89", "Msun"},
    Alias{"M\xE2\x8A\x99", "Msun"},
    Alias{"earthMass", "Mearth"},
    Alias{"M_earth", "Mearth"},
    Alias{"M_Earth", "Mearth"},
    Alias{"MEarth", "Mearth"},
    Alias{"M\xE2\x8A\x95", "Mearth"},
    Alias{"jupiterMass", "Mjup"},
    Alias{"M_jup", "Mjup"},
    Alias{"M_Jup", "Mjup"},
    Alias{"MJup", "Mjup"},
    Alias{"Mjupiter", "Mjup"},
    Alias{"solRad", "Rsun"},
    Alias{"R_sun", "Rsun"},
    Alias{"R_Sun", "Rsun"},
    Alias{"RSun", "Rsun"},
    Alias{"earthRad", "Rearth"},
    Alias{"R_earth", "Rearth"},
    Alias{"jupiterRad", "Rjup"},
    Alias{"R_jup", "Rjup"},
    Alias{"lyr", "ly"},
    Alias{"arcsecond", "arcsec"},
    Alias{"arcminute", "arcmin"},
    Alias{"\xC2\xB0", "deg"},
    Alias{"Angstrom", "angstrom"},
    Alias{"\xC3\x85", "angstrom"},
    Alias{"\xE2\x84\xAB", "angstrom"},
    Alias{"picometer", "pm"},
    Alias{"millimeter", "mm"},
    Alias{"Bohr", "bohr"},
    Alias{"a_0", "bohr"},
    Alias{"amu", "u"},
    Alias{"Da", "u"},
    Alias{"dalton", "u"},
    Alias{"Dalton", "u"},
    Alias{"mole", "mol"},
    Alias{"Kcal", "kcal"},
    Alias{"electronvolt", "eV"},
    Alias{"Hartree", "hartree"},
    Alias{"E_h", "hartree"},
    Alias{"newton", "N"},
    Alias{"pascal", "Pa"},
    Alias{"millisecond", "ms"},
    Alias{"microsecond", "us"},
    Alias{"\xC2\xB5s", "us"},
    Alias{"\xCE\xBCs", "us"},
    Alias{"\xC2\xB5m", "um"},
    Alias{"\xCE\xBCm", "um"},
};

/// GM of a planet over that of the Sun, both nominal, in solar masses.
constexpr units::Ratio of_msun(std::int64_t digits, int exponent) {
  return units::find("Msun")->si * units::decimal(digits, exponent) / units::decimal(13271244);
}

/// Units that texts alone have: programs ask `unit_value` for them. Masses of planets are to Msun as the nominal GM
/// are, 3.986004e14 and 1.2668653e17 to 1.3271244e20 m^3/s^2; radii are nominal, those of planets equatorial; the
/// parsec is 648000/pi au, the light-year one of a Julian year, the calorie the thermochemical one; bohr and hartree
/// are CODATA 2018.
/// @source Codata2018, IauB2of2015, IauB3of2015
constexpr std::array text_units = {
    units::Definition{"Mearth", "", dimensions::mass, of_msun(3986004, -5)},
    units::Definition{"Mjup", "", dimensions::mass, of_msun(12668653, -3)},
    units::Definition{"Rsun", "", dimensions::length, units::decimal(6957, 5)},
    units::Definition{"Rearth", "", dimensions::length, units::decimal(63781, 2)},
    units::Definition{"Rjup", "", dimensions::length, units::decimal(71492, 3)},
    units::Definition{"pc", "", dimensions::length, units::Ratio{648000 * Quad(149597870700), units::pi}},
    units::Definition{"kpc", "", dimensions::length, units::Ratio{648000000 * Quad(149597870700), units::pi}},
    units::Definition{"Mpc", "", dimensions::length, units::Ratio{648000000000 * Quad(149597870700), units::pi}},
    units::Definition{"ly", "", dimensions::length, units::decimal(9460730472580800)},
    units::Definition{"mm", "", dimensions::length, units::decimal(1, -3)},
    units::Definition{"um", "", dimensions::length, units::decimal(1, -6)},
    units::Definition{"pm", "", dimensions::length, units::decimal(1, -12)},
    units::Definition{"bohr", "", dimensions::length, units::decimal(529177210903, -22)},
    units::Definition{"ms", "", dimensions::time, units::decimal(1, -3)},
    units::Definition{"us", "", dimensions::time, units::decimal(1, -6)},
    units::Definition{"arcmin", "", dimensions::none, units::Ratio{units::pi, Quad(10800)}},
    units::Definition{"arcsec", "", dimensions::none, units::Ratio{units::pi, Quad(648000)}},
    units::Definition{"mas", "", dimensions::none, units::Ratio{units::pi, Quad(648000000)}},
    units::Definition{"kcal/mol", "", dimensions::energy, units::decimal(4184) / units::decimal(602214076, 15)},
    units::Definition{"eV", "", dimensions::energy, units::decimal(1602176634, -28)},
    units::Definition{"meV", "", dimensions::energy, units::decimal(1602176634, -31)},
    units::Definition{"hartree", "", dimensions::energy, units::decimal(43597447222071, -31)},
    units::Definition{"erg", "", dimensions::energy, units::decimal(1, -7)},
    units::Definition{"N", "", dimensions::force, units::decimal(1)},
    units::Definition{"Pa", "", dimensions::pressure, units::decimal(1)},
    units::Definition{"bar", "", dimensions::pressure, units::decimal(1, 5)},
    units::Definition{"atm", "", dimensions::pressure, units::decimal(101325)},
};

/// The unit of a symbol, or null.
const units::Definition* find_unit(std::string_view symbol) {
  if (const units::Definition* const unit = units::find(symbol)) return unit;
  for (const units::Definition& unit : text_units) {
    if (unit.symbol == symbol) return &unit;
  }
  return nullptr;
}

/// The symbol that a word stands for: itself, or that of a name in English, singular or plural: "days", "AU".
std::string_view symbol_of(std::string_view word) {
  if (find_unit(word) != nullptr) return word;
  const bool plural = word.size() > 2 && word.ends_with('s');
  for (const std::string_view name : {word, plural ? word.substr(0, word.size() - 1) : word}) {
    for (const Alias& alias : aliases) {
      if (alias.word == name) return alias.symbol;
    }
    for (const units::Definition& unit : units::definitions) {
      if (unit.constant == name && name.size() > 2) return unit.symbol;
    }
  }
  return word;
}

[[noreturn]] void unknown_unit(std::string_view word, std::string_view whole) {
  std::vector<std::string> known;
  for (const units::Definition& unit : units::definitions) known.emplace_back(unit.symbol);
  for (const units::Definition& unit : text_units) known.emplace_back(unit.symbol);
  const std::string in = word == whole ? "" : fmt::format(" in '{}'", whole);
  // Half of a quotient has one answer, however far it is in letters.
  for (const std::string& symbol : known) {
    if (!symbol.starts_with(word) || !std::string_view(symbol).substr(word.size()).starts_with('/')) continue;
    fail(fmt::format("unknown unit '{}'{}; did you mean '{}'?", word, in, symbol), whole);
  }
  std::vector<std::string> names;
  for (const Alias& alias : aliases) names.emplace_back(alias.word);
  for (const units::Definition& unit : units::definitions) {
    if (unit.constant.find('_') == std::string_view::npos) names.emplace_back(unit.constant);
  }
  const std::string name = suggest(word, known).empty() ? suggest(word, names) : "";
  if (!name.empty()) fail(fmt::format("unknown unit '{}'{}; did you mean '{}'?", word, in, name), whole);
  fail(fmt::format("unknown unit '{}'{}{}", word, in, did_you_mean(word, known)), whole);
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

Unit unit_from(const std::vector<Term>& terms, std::string_view whole, const UnitSystem& system) {
  Unit unit;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (terms[i].word == "1") continue;
    const units::Definition* const quotient = find_quotient(terms, i);
    const units::Definition* const definition = quotient ? quotient : find_unit(terms[i].word);
    if (!definition) unknown_unit(terms[i].word, whole);
    append(unit, *definition, terms[i], system);
    if (quotient) ++i;
  }
  return unit;
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
  const Unit unit = unit_from(terms, whole, system);
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

Unit parse_unit(std::string_view text, const UnitSystem& system) {
  const std::string_view whole = trimmed(text);
  if (whole.empty()) fail("empty unit; expected one such as 'km/s', or '1' for a plain number", text);
  const std::vector<Term> terms = unit_terms(whole, whole, false);
  if (system.is_reduced() && !all_plain(terms)) {
    fail(fmt::format("unit '{}' in the reduced unit system, where numbers have no units; leave the unit out, or choose "
                     "solar, molecular or si",
                     whole),
         whole);
  }
  return unit_from(terms, whole, system);
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
  for (const units::Definition& unit : text_units) add(unit);
  const auto add_constant = [&](const char* name, const char* dimension, double UnitSystem::*value) {
    rows.push_back({name, name, dimension, solar.*value, molecular.*value, si.*value, reduced.*value});
  };
  add_constant("G", "length^3/mass/time^2", &UnitSystem::G);
  add_constant("k_B", "energy/temperature", &UnitSystem::k_B);
  add_constant("coulomb_constant", "energy length/charge^2", &UnitSystem::coulomb_constant);
  return rows;
}

}  // namespace noether
