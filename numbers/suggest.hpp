#pragma once
/// What a misspelt word may have meant.

#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// Edits that turn one word into the other: letters put in, left out, replaced, or exchanged with their neighbor.
///
/// The restricted Damerau-Levenshtein distance (no letter is edited twice), byte by byte.
/// @throws std::bad_alloc
/// @cost length of a times length of b
std::size_t edit_distance(std::string_view a, std::string_view b);

/// A word in small letters, without blanks and "_-/.,()", and without the s of a plural: what is left of "Aba-1064" and
/// of "ABA(10,6,4)" is what is left of "aba_10_6_4".
/// @throws std::bad_alloc
std::string squeezed(std::string_view word);

/// The nearest known word, or nothing where none is near.
///
/// Near is at most max(2, length / 3) edits, 1 for up to 3 letters, case aside, and fewer than the longer word has
/// letters; so is one that begins with the word, if that has 5 letters, or 2 and lacks 2 at most. Nearest is one that
/// is the same when both are squeezed. Among equals the one that agrees better in case wins, then the one whose number
/// at the end is nearer, then the first.
/// @throws std::bad_alloc
std::string suggest(std::string_view word, const std::vector<std::string>& known);

/// The end of a message: "; did you mean 'cutoff'?", or "; expected one of: a, b, c" where nothing is near.
///
/// Empty if nothing is known.
/// @throws std::bad_alloc
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

}  // namespace noether
