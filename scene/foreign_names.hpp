#pragma once
/// Names that people bring from other programs, and what there is here in their place.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// Where a proposed name stands in a scene.
enum class NamePlace : std::uint8_t { method, hamiltonian, force, thermostat, constraint, monitor, builder, key, none };

/// Some names of other programs with one meaning.
struct ForeignName {
  std::string_view words;  ///< between blanks, in small letters, with '_' in place of '-', '/', '.' and ' '
  NamePlace place = NamePlace::none;
  std::string_view here = {};  ///< the name in this program; empty: there is none
  /// More about it, to go on the message; of those without a name all of it. Names of parts stand in quotes.
  std::string_view how = {};
  /// Whether it is something else that serves in its place, and not the same thing under another name.
  bool other = false;
};

/// All of them: parts and methods, then keys.
std::span<const ForeignName> foreign_names();

/// The end of a message about a name that is known but for capitals and joints, or from another program: "; did you
/// mean 'aba_10_6_4'?" for "ABA(10,6,4)". Empty for others, misspelt ones too.
/// @param known  names that are accepted where the word stands
std::string proposal_by_name(std::string_view word, const std::vector<std::string>& known);

/// The end of a message about an unknown name: "; did you mean 'verlet'?" for a misspelt one, what there is here for a
/// name of another program, else as `did_you_mean`.
/// @param known  names that are accepted where the word stands
std::string proposal(std::string_view word, const std::vector<std::string>& known);

/// The same, but `otherwise` where the list of what is known would be too long: "; see `noether list methods`".
std::string proposal(std::string_view word, const std::vector<std::string>& known, std::string_view otherwise);

/// Keys that there are here for one that other programs have.
std::vector<std::string> keys_here(std::string_view word);

/// The end of a message about an unknown key of a table with these keys.
std::string key_proposal(std::string_view key, const std::vector<std::string>& known);

}  // namespace noether
