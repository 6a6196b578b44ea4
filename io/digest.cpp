#include "io/digest.hpp"

#include <fmt/format.h>
#if NOETHER_STATIC
#define OPENSSL_SUPPRESS_DEPRECATED
#include <openssl/sha.h>
#else
#include <openssl/evp.h>
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <memory>
#include <numeric>
#include <utility>

namespace noether::io {

static_assert(std::endian::native == std::endian::little, "files and digests are little-endian as memory is");

#if NOETHER_STATIC
/// By functions that name the algorithm: those below would link all that the archive has, 4 MB.
struct RunningDigest::Context {
  SHA256_CTX held{};
  bool begun = false;

  bool made() const { return true; }
  bool begin() { return SHA256_Init(&held) == 1; }
  bool add(const void* data, std::size_t bytes) { return SHA256_Update(&held, data, bytes) == 1; }
  bool end(RowDigest& row) { return SHA256_Final(reinterpret_cast<unsigned char*>(row.data()), &held) == 1; }
};
#else
struct RunningDigest::Context {
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> held{EVP_MD_CTX_new(), EVP_MD_CTX_free};
  bool begun = false;

  bool made() const { return held != nullptr; }
  bool begin() { return EVP_DigestInit_ex(held.get(), EVP_sha256(), nullptr) == 1; }
  bool add(const void* data, std::size_t bytes) { return EVP_DigestUpdate(held.get(), data, bytes) == 1; }
  bool end(RowDigest& row) {
    unsigned int size = 0;
    std::array<unsigned char, EVP_MAX_MD_SIZE> hash{};
    if (EVP_DigestFinal_ex(held.get(), hash.data(), &size) != 1 || size != sizeof row) return false;
    std::memcpy(row.data(), hash.data(), sizeof row);
    return true;
  }
};
#endif
void RunningDigest::Free::operator()(Context* context) const { delete context; }

namespace {

void expect_done(bool done) {
  if (!done) throw Error("the cryptographic library does not provide SHA-256; it may be a restricted build of OpenSSL");
}

}  // namespace

RunningDigest::RunningDigest() : context_(new Context) { expect_done(context_->made()); }

void RunningDigest::add(const void* data, std::size_t bytes) {
  if (!context_->begun) expect_done(context_->begin());
  context_->begun = true;
  expect_done(context_->add(data, bytes));
}

RowDigest RunningDigest::row() {
  if (!context_->begun) add(nullptr, 0);
  RowDigest row{};
  expect_done(context_->end(row));
  context_->begun = false;
  return row;
}

std::string RunningDigest::hex() {
  const RowDigest hash = row();
  std::string text;
  for (const std::byte one : std::as_bytes(std::span(hash))) text += fmt::format("{:02x}", std::to_integer<int>(one));
  return text;
}

std::string sha256(std::string_view bytes) {
  RunningDigest hash;
  hash.add(bytes);
  return hash.hex();
}

std::vector<Index> id_order(const std::vector<std::int64_t>& ids) {
  std::vector<Index> order(ids.size());
  std::iota(order.begin(), order.end(), Index{0});
  if (std::is_sorted(ids.begin(), ids.end())) return order;
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return ids[static_cast<std::size_t>(a)] < ids[static_cast<std::size_t>(b)]; });
  return order;
}

std::string digest(std::int64_t step, double time, std::span<const std::int64_t> ids, std::span<const double> positions,
                   std::span<const double> velocities, std::span<const double> masses,
                   std::span<const std::int32_t> images, const MovingColumns& moving) {
  const std::string_view head = moving.empty() ? "noether-state-1\n" : "noether-state-2\n";
  RunningDigest hash;
  hash.add(head);
  hash.add(step);
  hash.add(static_cast<std::int64_t>(ids.size()));
  hash.add(time);
  hash.add(ids);
  hash.add(positions);
  hash.add(velocities);
  hash.add(masses);
  hash.add(images);
  for (const auto& [name, values] : moving) {
    hash.add(std::string_view(name));
    hash.add(std::span(values));
  }
  return "sha256:" + hash.hex();
}

std::string system_digest(std::int64_t step, double time, std::span<const double> variables) {
  static constexpr std::string_view head = "noether-system-1\n";
  RunningDigest hash;
  hash.add(head);
  hash.add(step);
  hash.add(static_cast<std::int64_t>(variables.size()));
  hash.add(time);
  hash.add(variables);
  return "sha256:" + hash.hex();
}

MovingColumns moving_columns(const ParticleSystem<double>& s, const std::vector<Index>& order) {
  MovingColumns all;
  for (const auto& column : s.columns()) {
    if (!column.info.moves()) continue;
    std::vector<double>& numbers = all[column.info.name];
    numbers.reserve(order.size() * static_cast<std::size_t>(column.info.width));
    column.visit([&](const auto& values) {
      for (const Index i : order) {
        for (int k = 0; k < values.width; ++k) numbers.push_back(static_cast<double>(values.component(k)[i]));
      }
    });
  }
  return all;
}

std::string digest(const ParticleSystem<double>& settled) {
  const auto& clock = settled.clock();
  const double time = clock.mode() == ClockMode::fixed ? clock.time_at(clock.step()) : clock.high();
  if (!settled.variables().empty()) return system_digest(clock.step(), time, settled.variables());
  std::vector<std::int64_t> ids;
  std::vector<double> x, v, m;
  std::vector<std::int32_t> images;
  const std::vector<Index> order = id_order(settled.ids());
  for (const Index i : order) {
    ids.push_back(settled.ids()[static_cast<std::size_t>(i)]);
    const Vec3<double> position = settled.positions()[i], velocity = settled.velocities()[i];
    x.insert(x.end(), position.begin(), position.end());
    v.insert(v.end(), velocity.begin(), velocity.end());
    m.push_back(settled.masses()[i]);
    for (int k = 0; k < 3 && settled.box().is_periodic(); ++k) images.push_back(settled.images().component(k)[i]);
  }
  return digest(clock.step(), time, ids, x, v, m, images, moving_columns(settled, order));
}

}  // namespace noether::io
