#pragma once
/// Texts as an array of equal lengths, as HDF5 stores them best.

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace noether::io {

/// Texts side by side, each padded by zeros to the longest one.
struct PaddedTexts {
  std::size_t size = 1;  ///< of each [bytes]
  std::string bytes;
};

inline PaddedTexts pad(const std::vector<std::string>& texts) {
  PaddedTexts padded;
  for (const std::string& text : texts) padded.size = std::max(padded.size, text.size());
  for (const std::string& text : texts) {
    padded.bytes += text;
    padded.bytes.append(padded.size - text.size(), '\0');
  }
  return padded;
}

/// The texts again; each ends at its first zero.
inline std::vector<std::string> unpad(const PaddedTexts& padded) {
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < padded.bytes.size(); at += padded.size) {
    const std::string text = padded.bytes.substr(at, padded.size);
    texts.push_back(text.substr(0, text.find('\0')));
  }
  return texts;
}

}  // namespace noether::io
