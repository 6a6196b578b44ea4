/// Columns: their layout in memory, and that changing their length keeps what they hold.

#include "engine/column.hpp"

#include "numbers/pack.hpp"
#include "numbers/simd.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

namespace noether {
namespace {

template <class Real> Vec3<Real> row(int i) { return Vec3<Real>(Real(i), Real(100 + i), Real(200 + i)); }

template <class Real> VectorColumn<Real> counted(Index n) {
  VectorColumn<Real> column(n);
  for (Index i = 0; i < n; ++i) column.set(i, row<Real>(static_cast<int>(i)));
  return column;
}

template <class T> bool is_aligned(const T* p) { return reinterpret_cast<std::uintptr_t>(p) % 64 == 0; }

}  // namespace

TEMPLATE_TEST_CASE("each component of a vector column begins on a 64-byte boundary", "[column]", double, Quad) {
  for (const Index n : {1, 7, 8, 9, 255}) {
    const VectorColumn<TestType> column(n);
    CAPTURE(n);
    for (int k = 0; k < 3; ++k) CHECK(is_aligned(column.component(k)));
    CHECK(column.size() == n);
    CHECK(column.stride() % 8 == 0);
    CHECK(column.stride() >= n);
    CHECK(column.stride() < n + 8);
  }
}

TEMPLATE_TEST_CASE("a column begins as zeros, its padding too", "[column]", double, Quad) {
  const VectorColumn<TestType> column(5);
  for (Index i = 0; i < 3 * column.stride(); ++i) CHECK(column.component(0)[i] == TestType(0));
}

TEMPLATE_TEST_CASE("rows are read, set and added to; the whole column is the same memory", "[column]", double, Quad) {
  auto column = counted<TestType>(9);
  column[3] = Vec3<TestType>(TestType(1), TestType(2), TestType(3));
  column.add(3, row<TestType>(3));
  const auto& read = column;
  CHECK((read[3] == Vec3<TestType>(TestType(4), TestType(105), TestType(206))));
  CHECK((read[8] == row<TestType>(8)));
  CHECK(column.all().rows() == 9);
  CHECK(column.all().cols() == 3);
  CHECK(column.all()(3, 2) == TestType(206));
  column.all()(4, 1) = TestType(-1);
  CHECK(read[4][1] == TestType(-1));
  CHECK(&column.component(1)[4] == &column.component(0)[4 + column.stride()]);
}

TEST_CASE("appending and erasing keeps the other rows in order, across a change of padding", "[column]") {
  auto column = counted<double>(8);
  column.append(row<double>(8));
  CHECK(column.size() == 9);
  CHECK(column.stride() == 16);
  column.erase(0);
  column.erase(3);
  REQUIRE(column.size() == 7);
  const int left[] = {1, 2, 3, 5, 6, 7, 8};
  for (Index i = 0; i < 7; ++i) CHECK(std::as_const(column)[i] == row<double>(left[i]));
  CHECK(column.stride() == 16);
  column.trim();
  CHECK(column.stride() == 8);
  for (Index i = 0; i < 7; ++i) CHECK(std::as_const(column)[i] == row<double>(left[i]));
  CHECK(is_aligned(column.component(2)));
}

TEST_CASE("a column is set to zero, padding included, packs of eight numbers too", "[column]") {
  auto column = counted<double>(3);
  column.set_zero();
  for (Index i = 0; i < 3; ++i) CHECK(std::as_const(column)[i] == Vec3<double>::Zero());
  const SimdLevel before = simd_level();
  for (const SimdLevel level : {SimdLevel::base, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!has_simd_level(level)) continue;
    set_simd_level(level);
    CAPTURE(name(level));
    std::vector<double> numbers(7 * Pack::lanes + 1), copy(numbers.size(), -1);
    for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = static_cast<double>(k + 1);
    copy_packs(numbers.data(), copy.data(), 7);
    CHECK(copy.back() == -1);
    copy.back() = numbers.back();
    CHECK(copy == numbers);
    VectorColumn<Pack> packs(5);
    for (int k = 0; k < 3; ++k) copy_packs(numbers.data(), packs.component(k)->lane.data(), 5);
    CHECK(packs.component(2)[4].lane[7] == 40);
    packs.set_zero();
    double sum = 0;
    for (Index i = 0; i < 3 * packs.stride(); ++i) {
      for (const double x : packs.component(0)[i].lane) sum += std::abs(x);
    }
    CHECK(sum == 0);
  }
  set_simd_level(before);
}

TEST_CASE("a scalar column holds one number a particle", "[column]") {
  ScalarColumn<std::int64_t> column(2);
  column[0] = 5;
  column[1] = 6;
  column.append(7);
  column.erase(1);
  REQUIRE(column.size() == 2);
  CHECK(column[0] == 5);
  CHECK(column[1] == 7);
  CHECK(is_aligned(column.data()));
  CHECK(column.all().size() == 2);
}

}  // namespace noether
