#pragma once
/// What a call is refused with.

#include "numbers/error.hpp"

#include <string>

namespace noether::test {

/// The message of the error that `make()` throws, without the place it belongs to; empty if it throws none.
template <class Make> std::string refusal_of(const Make& make) {
  try {
    make();
  } catch (const Error& error) {
    return error.message();
  }
  return "";
}

}  // namespace noether::test
