#pragma once
/// A part describes itself once: name, help, fields with dimensions, state. Readers, writers, `noether list`,
/// `noether describe`, docs and checkpoints are all driven by that one description.

#include "engine/saved_state.hpp"
#include "numbers/error.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace noether {

namespace detail {
template <class M> struct member_of;
template <class T, class V> struct member_of<V T::*> {
  using part = T;
  using value = V;
};
}  // namespace detail

/// A parameter of a part: a member, the key users type, its dimension in words ("length^3/time^2"), one line of help.
template <auto Member> struct Field {
  using value_type = typename detail::member_of<decltype(Member)>::value;
  static constexpr auto member = Member;
  std::string_view name, dimension, help;
  std::string_view example = "";  ///< what a scene may write; not empty: the field has no default and must be given

  /// The same field, which a scene must give; `text` is an example as a scene writes it: "\"60330 km\"".
  constexpr Field required(std::string_view text) const { return {name, dimension, help, text}; }
};

/// A member that changes while a run goes on: it goes into checkpoints and comes back from them.
template <auto Member> struct State {
  using value_type = typename detail::member_of<decltype(Member)>::value;
  static constexpr auto member = Member;
  std::string_view name;
};

/// Names of the values of an enum, as scenes type them: specialise with `static constexpr std::array<std::pair<...>>`.
template <class E> struct EnumNames;

/// The formula of a part, in the notation of its source.
struct Formula {
  std::string_view text;
};

/// Where a part comes from: keys of docs/references.bib.
struct Source {
  std::string_view text;
};

/// What a monitor or writer tells or stores: "total [energy], relative_error [1]".
struct Quantities {
  std::string_view text;
};

/// A letter that a part gives to words, and what its flow is, in words: "drifts".
struct Letter {
  char letter = 0;
  std::string_view text;
};

constexpr Letter letter(char name, std::string_view text) { return {name, text}; }
template <auto Member>
constexpr Field<Member> field(std::string_view name, std::string_view dimension, std::string_view help = "") {
  return {name, dimension, help, ""};
}
template <auto Member> constexpr State<Member> state(std::string_view name) { return {name}; }
constexpr Formula formula(std::string_view text) { return {text}; }
constexpr Source source(std::string_view keys) { return {keys}; }
constexpr Quantities quantities(std::string_view text) { return {text}; }

namespace detail {
template <std::size_t place, class E> struct Entry { E entry; };
template <class Places, class... Es> struct EntryList;
/// Entries of any types in their order: a std::tuple that costs the compiler little.
template <std::size_t... places, class... Es>
struct EntryList<std::index_sequence<places...>, Es...> : Entry<places, Es>... {
  /// Calls `visit` for each of them.
  template <class Visit> constexpr void each(const Visit& visit) const {
    (visit(static_cast<const Entry<places, Es>&>(*this).entry), ...);
  }
  /// Calls `use` once, for all of them.
  template <class Use> constexpr auto all(const Use& use) const {
    return use(static_cast<const Entry<places, Es>&>(*this).entry...);
  }
};
}  // namespace detail

/// The description of a part.
template <class T, class... Entries> struct Part {
  std::string_view name, help;
  detail::EntryList<std::index_sequence_for<Entries...>, Entries...> entries;
};

/// Makes the description of part `T`: call it from `static constexpr auto describe()`.
template <class T, class... Entries>
constexpr Part<T, Entries...> part(std::string_view name, std::string_view help, Entries... entries) {
  return {name, help, {{entries}...}};
}
/// The description of `T` that begins as that of its base, and goes on with entries of its own.
template <class T, class Base, class... Inherited, class... Entries>
constexpr Part<T, Inherited..., Entries...> part(const Part<Base, Inherited...>& base, Entries... entries) {
  return base.entries.all(
      [&](const auto&... inherited) { return part<T>(base.name, base.help, inherited..., entries...); });
}

template <class T>
concept Described = requires {
  T::describe().name;
};

namespace detail {
template <class T> struct optional_value { using type = T; };
template <class T> struct optional_value<std::optional<T>> { using type = T; };

/// What values of a field are, in words.
template <class V> constexpr std::string_view field_kind() {
  using T = typename optional_value<V>::type;
  if constexpr (std::is_same_v<T, bool>)
    return "flag";
  else if constexpr (std::is_integral_v<T>)
    return "whole number";
  else if constexpr (std::is_floating_point_v<T>)
    return "number";
  else if constexpr (std::is_enum_v<T>)
    return "choice";
  else if constexpr (std::is_same_v<T, std::string>)
    return "text";
  else if constexpr (std::is_same_v<T, std::array<double, 3>>)
    return "vector";
  else
    return "list";
}

/// The description of `T`, once for all who read it.
template <class T> inline constexpr auto description_of = T::describe();

template <class E> struct is_field : std::false_type {};
template <auto M> struct is_field<Field<M>> : std::true_type {};
template <class E> struct is_state : std::false_type {};
template <auto M> struct is_state<State<M>> : std::true_type {};
}  // namespace detail

/// Calls `visit(field)` for every field of a part, in the order of its description.
template <class T, class Visit> constexpr void for_each_field(const Visit& visit) {
  detail::description_of<T>.entries.each([&]<class E>(const E& entry) {
    if constexpr (detail::is_field<E>::value) visit(entry);
  });
}

/// Calls `visit(state)` for every state entry of a part.
template <class T, class Visit> constexpr void for_each_state(const Visit& visit) {
  detail::description_of<T>.entries.each([&]<class E>(const E& entry) {
    if constexpr (detail::is_state<E>::value) visit(entry);
  });
}

/// Calls `visit(letter)` for every letter of a part.
template <class T, class Visit> constexpr void for_each_letter(const Visit& visit) {
  detail::description_of<T>.entries.each([&]<class E>(const E& entry) {
    if constexpr (std::is_same_v<E, Letter>) visit(entry);
  });
}

/// The entry of type `E` (Formula, Source or Quantities) of a part; empty if it has none.
template <class T, class E> constexpr std::string_view entry_text() {
  std::string_view found;
  detail::description_of<T>.entries.each([&]<class Other>(const Other& entry) {
    if constexpr (std::is_same_v<Other, E>) found = entry.text;
  });
  return found;
}

/// Asks a part whether its fields make sense: its optional `void check() const` throws if they do not.
/// @throws Error  see `refuse_field`
template <class T> void check_part(const T& part) {
  if constexpr (requires { part.check(); }) part.check();
}

/// Ends a part's `check`: "softening = -1 is negative; 0 or a length above is expected".
///
/// A scene shows its own text instead of `value`, and the line where it stands.
/// @throws Error  always, with the key of the field
[[noreturn]] void refuse_field(std::string_view key, const std::string& value, const std::string& why);
[[noreturn]] void refuse_field(std::string_view key, double value, const std::string& why);
[[noreturn]] void refuse_field(std::string_view key, const std::array<double, 3>& value, const std::string& why);

/// Refuses a field G that is given and not above 0. @throws Error
void check_constant_of_gravitation(const std::optional<double>& G);

/// Name of a part: the one it describes itself with, else empty.
template <class T> constexpr std::string_view part_name() {
  if constexpr (Described<T>) {
    return T::describe().name;
  } else {
    return "";
  }
}

namespace detail {
/// The key of a state: "prefix/name", or the name alone.
std::string key_below(const std::string& prefix, std::string_view name);
}  // namespace detail

/// Writes every declared state of `value` below `prefix`.
template <class T> void save_part(SavedState& saved, const std::string& prefix, const T& value) {
  if constexpr (Described<T>) {
    for_each_state<T>([&](const auto& e) { save_value(saved, detail::key_below(prefix, e.name), value.*(e.member)); });
  }
}

/// Reads every declared state of `value` from below `prefix`. @throws Error if one is missing
template <class T> void load_part(const SavedState& saved, const std::string& prefix, T& value) {
  if constexpr (Described<T>) {
    for_each_state<T>([&](const auto& e) { load_value(saved, detail::key_below(prefix, e.name), value.*(e.member)); });
  }
}

}  // namespace noether
