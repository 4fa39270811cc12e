// The order of elements along a curve through space, which puts near ones side by side.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace selvage::verify {

/// How far along Hilbert's curve a point of the lattice lies, all coordinates rounded to 16 bits; which curve it is
/// affects speed alone. With this one a block meets a quarter fewer others than in Morton's order (measured).
[[nodiscard]] std::uint64_t hilbert_code(const std::array<std::int32_t, 3>& point);

/// The elements' numbers in ascending order of their codes; where few differ in the last bits alone, in ascending order
/// instead. code(i), below 2^48, is called for every i < count, in parallel; deterministic. O(n) where elements are
/// spread out, O(n log n) at worst. REQUIRES count <= 2^31.
[[nodiscard]] std::vector<std::int32_t> order_by_code(std::size_t count,
                                                      const std::function<std::uint64_t(std::size_t)>& code);

}  // namespace selvage::verify
