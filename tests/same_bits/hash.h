// One number for many answers: any bit that differs changes it.
#pragma once

#include <bit>

#include "kernel/kernel.h"

namespace selvage::testing {

/// FNV-1a over the bits of the values.
class Hash {
 public:
  void add(std::uint64_t bits) {
    for (int byte = 0; byte < 8; ++byte) value_ = (value_ ^ ((bits >> (8 * byte)) & 0xff)) * 0x100000001b3U;
  }
  void add(std::int64_t number) { add(static_cast<std::uint64_t>(number)); }
  void add(std::int32_t number) { add(std::int64_t{number}); }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  template <std::size_t N>
  void add(const std::array<double, N>& values) {
    for (const double value : values) add(value);
  }
  void add(const Vec3& v) { add(std::array{v[0], v[1], v[2]}); }
  void add(const CcdResult& result) {
    add(static_cast<std::int64_t>(result.verdict));
    add(static_cast<std::int64_t>(result.cause));
    add(result.intervals);
    add(result.toi_lower);
    add(result.gap_bound);
    add(result.weights);
    add(result.normal);
  }
  void add(const Proximity& proximity) {
    add(proximity.distance);
    add(proximity.distance_lower);
    add(proximity.distance_upper);
    add(proximity.point_error_bound);
    add(proximity.weights);
    add(proximity.normal);
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

/// Every entry of the kernel on fixed input of all kinds, made from integers and powers of two alone.
void add_query_answers(Hash& hash);
void add_mesh_answers(Hash& hash);

}  // namespace selvage::testing
