#pragma once
/// Finds members by name. An optional member that is nearly right, `claims(int)` or `climas()` for `claims()`, is then
/// an error of the compiler and not a part that has none. (C++ tells nobody which names a class has, so only the
/// likeliest misspellings of a name are found.)

#include <type_traits>

/// Defines `finds_NAME<T>()`: whether a class has a member called NAME, whatever it takes and gives: beside another one
/// of that name it is ambiguous. What is final, or no class, has none that can be found. Defines `misspells_NAME<T>()`:
/// whether it has a member called by one of six misspellings of NAME.
#define NOETHER_FINDS_MEMBER(NAME, A, B, C, D, E, F)           \
  struct only_##NAME {                                         \
    int NAME, A, B, C, D, E, F;                                \
  };                                                           \
  template <class T> struct beside_##NAME : T, only_##NAME {}; \
  template <class T> consteval bool finds_##NAME() {           \
    if constexpr (std::is_class_v<T> && !std::is_final_v<T>) { \
      return !requires { &beside_##NAME<T>::NAME; };           \
    }                                                          \
    return false;                                              \
  }                                                            \
  template <class T> consteval bool misspells_##NAME() {       \
    if constexpr (std::is_class_v<T> && !std::is_final_v<T>) { \
      return !requires {                                       \
        &beside_##NAME<T>::A;                                  \
        &beside_##NAME<T>::B;                                  \
        &beside_##NAME<T>::C;                                  \
        &beside_##NAME<T>::D;                                  \
        &beside_##NAME<T>::E;                                  \
        &beside_##NAME<T>::F;                                  \
      };                                                       \
    }                                                          \
    return false;                                              \
  }
