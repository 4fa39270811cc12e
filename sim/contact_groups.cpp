#include "sim/contact_groups.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include "sim/parallel.h"

namespace selvage::sim {
namespace {

/// Contacts of a group: some tens of microseconds of work. Fewer leave more contacts between groups, more leave cores
/// without work (docs/simulator-speed.md).
constexpr std::size_t kGroupSize = 256;

/// Fewer contacts are on one thread, and act in the order in which they are given.
constexpr std::size_t kLeastParallel = 2 * kGroupSize;

/// A round is not made where more than this many contacts wait for one that acts in it: as in a fan most share
/// vertices, and act alone. Where layers are pressed about one waits for each (docs/simulator-speed.md).
constexpr std::size_t kMostWaiting = 4;

/// The ten bits of a number, each with two empty ones above it.
std::uint64_t spread(std::uint64_t number) {
  number = (number | number << 16) & 0x030000ff;
  number = (number | number << 8) & 0x0300f00f;
  number = (number | number << 4) & 0x030c30c3;
  return (number | number << 2) & 0x09249249;
}

/// All members along Morton's curve: those near each other on it are near each other in space. In a cell of it, a
/// 1024th of the longest side, in their order.
std::vector<std::size_t> order_by_place(std::span<const ContactGroups::Member> members) {
  constexpr double kCells = 1 << 10;
  Eigen::AlignedBox<double, 3> box;
  for (const ContactGroups::Member& member : members) box.extend(member.at);
  const double side = box.sizes().maxCoeff() * (1 + 1e-9);  // so that no share of it is 1
  std::vector<std::uint64_t> words(members.size());         // the code, then which member it is of
  parallel_each(std::ssize(members), [&](Eigen::Index i) {
    const Vec3& at = members[static_cast<std::size_t>(i)].at;
    std::uint64_t code = 0;
    for (int axis = 0; side > 0 && axis < 3; ++axis) {
      code |= spread(static_cast<std::uint64_t>((at[axis] - box.min()[axis]) / side * kCells)) << axis;
    }
    words[static_cast<std::size_t>(i)] = code << 32 | static_cast<std::uint64_t>(i);
  });
  std::ranges::sort(words);
  std::vector<std::size_t> order(members.size());
  std::ranges::transform(words, order.begin(), [](std::uint64_t word) { return word & 0xffffffff; });
  return order;
}

std::vector<std::size_t> order_as_given(std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  return order;
}

}  // namespace

ContactGroups::ContactGroups(std::span<const Member> members, Eigen::Index vertex_count) : has_left_(members.size()) {
  order_.reserve(members.size());
  std::vector<std::size_t> left =
      members.size() < kLeastParallel ? order_as_given(members.size()) : order_by_place(members);
  // Runs of the curve are groups. A contact that shares a vertex with a group before its own waits for another round.
  // In a group contacts keep the order in which they are given (docs/simulator-speed.md says what another order costs).
  while (left.size() >= kLeastParallel) {
    Round round{{}, std::vector<std::int32_t>(static_cast<std::size_t>(vertex_count), -1)};
    std::vector<std::size_t> kept, waiting;
    for (std::size_t begin = 0; begin < left.size(); begin += kGroupSize) {
      const auto id = static_cast<std::int32_t>(round.groups.size());
      const auto owner = [&](VertexId v) -> std::int32_t& { return round.owner[static_cast<std::size_t>(v)]; };
      const auto is_free = [&](VertexId v) { return v < 0 || owner(v) < 0 || owner(v) == id; };
      const std::size_t first = kept.size();
      const auto run = std::span(left).subspan(begin, std::min(kGroupSize, left.size() - begin));
      std::ranges::sort(run);
      for (const std::size_t contact : run) {
        const auto& vertices = members[contact].vertices;
        if (!std::ranges::all_of(vertices, is_free)) {
          waiting.push_back(contact);
          continue;
        }
        kept.push_back(contact);
        for (const VertexId v : vertices) {
          if (v >= 0) owner(v) = id;
        }
      }
      round.groups.push_back({order_.size() + first, order_.size() + kept.size(), {}});
    }
    if (waiting.size() > kMostWaiting * kept.size()) break;
    order_.insert(order_.end(), kept.begin(), kept.end());
    rounds_.push_back(std::move(round));
    left = std::move(waiting);
  }
  alone_.resize(left.size());
  std::iota(alone_.begin(), alone_.end(), order_.size());
  order_.insert(order_.end(), left.begin(), left.end());
}

}  // namespace selvage::sim
