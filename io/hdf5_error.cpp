#include "io/hdf5_error.hpp"

#if NOETHER_HDF5

#include <hdf5.h>

#include <string_view>

namespace noether::io {

namespace {

/// Keeps the innermost description of HDF5's error stack, or the system's own words where it quotes them.
herr_t keep_reason(unsigned /*depth*/, const H5E_error2_t* entry, void* kept) {
  static constexpr std::string_view quote = "error message = '";
  auto& reason = *static_cast<std::string*>(kept);
  const std::string_view text = entry->desc == nullptr ? "" : entry->desc;
  if (const auto at = text.find(quote); at != std::string_view::npos) {
    const std::string_view rest = text.substr(at + quote.size());
    reason = rest.substr(0, rest.find('\''));
    return 1;
  }
  if (reason.empty()) reason = text;
  return 0;
}

}  // namespace

std::string take_hdf5_error() {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_reason, &reason);
  H5Eclear2(H5E_DEFAULT);
  return reason;
}

}  // namespace noether::io

#endif
