#pragma once
/// Finds members by name. An optional member that is nearly right, `claims(int)` for `claims()`, is then an error of
/// the compiler and not a part that has none. (A misspelt name cannot be found: C++ tells nobody which names a class
/// has.)

#include <type_traits>

/// Defines `finds_NAME<T>()`: whether a class has a member called NAME, whatever it takes and gives: beside another one
/// of that name it is ambiguous. What is final, or no class, has none that can be found.
#define NOETHER_FINDS_MEMBER(NAME)                             \
  struct only_##NAME {                                         \
    int NAME;                                                  \
  };                                                           \
  template <class T> struct beside_##NAME : T, only_##NAME {}; \
  template <class T> consteval bool finds_##NAME() {           \
    if constexpr (std::is_class_v<T> && !std::is_final_v<T>) { \
      return !requires { &beside_##NAME<T>::NAME; };           \
    }                                                          \
    return false;                                              \
  }
