#pragma once
/// Files as a failing disk returns them.

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>

namespace noether::test {

/// A file with other bytes, of one kind of damage after the other; the same number gives the same damage.
///
/// Of eight files one is cut off, two have lost a sector, and five have from 1 to 10 other bytes: in some anywhere, in
/// others only where something stands, because most bytes are padding.
inline std::string damaged(const std::string& good, unsigned number) {
  std::mt19937 random(number);
  std::string bytes = good;
  const auto place = [&] { return random() % bytes.size(); };
  if (number % 8 == 6) {
    bytes.resize(place());
  } else if (number % 4 == 3) {
    const std::size_t first = place() / 512 * 512;
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(first), std::min<std::size_t>(512, bytes.size() - first),
                '\0');
  } else {
    for (int left = number % 4 == 0 ? 1 : static_cast<int>(random() % 10) + 1; left > 0;) {
      const std::size_t at = place();
      if (number % 8 < 4 && good[at] == 0) continue;
      bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1 + random() % 255));
      --left;
    }
  }
  return bytes;
}

}  // namespace noether::test
