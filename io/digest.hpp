#pragma once
/// Digests: equal digests mean equal states, to the bit.

#include "engine/particle_system.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace noether::io {

/// SHA-256 of bytes, 64 hexadecimal digits in lower case.
/// @throws Error if the cryptographic library refuses
/// @cost O(bytes)
std::string sha256(std::string_view bytes);

/// 32 bytes of SHA-256 as four whole numbers, as files keep them beside each row.
using RowDigest = std::array<std::int64_t, 4>;

/// A SHA-256 that is fed piece by piece.
class RunningDigest {
 public:
  /// @throws Error if the cryptographic library refuses, here and below
  RunningDigest();
  void add(const void* data, std::size_t bytes);
  void add(std::string_view text) { add(static_cast<const void*>(text.data()), text.size()); }
  template <class Number> void add(std::span<const Number> numbers) {
    add(static_cast<const void*>(numbers.data()), numbers.size_bytes());
  }
  void add(std::int64_t number) { add(&number, sizeof number); }
  void add(double number) { add(&number, sizeof number); }
  /// Of all that was added; then it begins anew.
  RowDigest row();
  /// The same as 64 hexadecimal digits.
  std::string hex();

 private:
  struct Context;
  struct Free {
    void operator()(Context* context) const;
  };
  std::unique_ptr<Context, Free> context_;
};

/// The digest of a settled state, "sha256:<hex>".
///
/// SHA-256, little-endian, of the ASCII "noether-state-1\n", int64 step, int64 n, float64 time (t0 + n dt; of a free
/// clock its high word), then in id order int64 id[n], float64 x[n][3], v[n][3], m[n], and in a periodic box
/// int32 image[n][3]. Where other columns move, the first word is "noether-state-2\n", and they follow in the order of
/// their names, each as its name and its float64 values. Of a first-order system: over
/// "noether-system-1\n", int64 step, int64 n, float64 time, float64 y[n].
/// @cost O(n log n)
std::string digest(const ParticleSystem<double>& settled);

/// Values of columns that move, by name; of each shape (n, width), row by row, in id order.
using MovingColumns = std::map<std::string, std::vector<double>>;

/// The columns of a system that move, its particles in some order.
MovingColumns moving_columns(const ParticleSystem<double>& s, const std::vector<Index>& order);

/// The same from arrays that stand in id order: ids (n), positions (n, 3), velocities (n, 3), masses (n), row by row,
/// in a periodic box images (n, 3), and other columns that move.
std::string digest(std::int64_t step, double time, std::span<const std::int64_t> ids, std::span<const double> positions,
                   std::span<const double> velocities, std::span<const double> masses,
                   std::span<const std::int32_t> images = {}, const MovingColumns& moving = {});

/// The same of a first-order system, from its variables y (n).
std::string system_digest(std::int64_t step, double time, std::span<const double> variables);

/// Indices of the particles in the order of their ids, shape (n).
/// @cost O(n) where they stand in order already
std::vector<Index> id_order(const std::vector<std::int64_t>& ids);

}  // namespace noether::io
