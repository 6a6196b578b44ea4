#pragma once
/// Where things stand in run.h5: the writer, the reader and the inspector agree on it here.

#include <string>

namespace noether::io {

inline const std::string particles_path = "/particles/system";
inline const std::string monitors_path = "/noether/monitors";

}  // namespace noether::io
