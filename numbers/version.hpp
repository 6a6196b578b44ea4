#pragma once
/// Which noether this is: written into every file and report.

namespace noether {

/// Release number, such as "0.1.0".
/// @throws never
const char* version() noexcept;

/// Commit the library was built from, 12 digits, followed by "-dirty" if tracked files differed from it; "unknown"
/// outside a checkout.
/// @throws never
const char* commit() noexcept;

}  // namespace noether
