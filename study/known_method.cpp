#include "study/known_method.hpp"

namespace noether {

std::vector<KnownMethod> all_known_methods() {
  std::vector<KnownMethod> every;
  for (const Scheme* scheme : schemes::all()) every.push_back({.scheme = scheme});
  for (const MethodInfo* info : methods::all()) {
    every.push_back({.info = info});
  }
  return every;
}

}  // namespace noether
