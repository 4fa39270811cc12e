#include "sim/dynamics/contact_groups.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include "sim/base/parallel.h"

namespace selvage::sim {
namespace {

/// Contacts of a group. Fewer leave more contacts between groups, more leave cores without work; 512 and 1,024 take as
/// long (docs/measurements/simulator-speed.md).
constexpr std::size_t kGroupSize = 256;

/// Fewer contacts are on one thread, and act in the order in which they are given.
constexpr std::size_t kLeastParallel = 2 * kGroupSize;

/// A round is not made where more than this many contacts wait for one that acts in it: as in a fan most share
/// vertices, and act alone. Where layers are pressed about one waits for each (docs/measurements/simulator-speed.md).
constexpr std::size_t kMaxWaiting = 4;

constexpr LaneMask kAllLanes = 0xff;
static_assert(kLanes == 8);

/// Packs that are looked at for a contact that may act nearly in its order. Of 13,600 contacts of edges in a heap (the
/// end of sim/scenes/curtain.toml at full quality) packs are 72 % full, 39 in order, 46 with 8, 73 with all. Eight
/// sheets that lie on one another sink by 0.31 mm a second (tests/sim/rest_test.cpp), 0.28 in order, 0.33 and 0.45.
constexpr std::size_t kLookBack = 16;

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

ContactGroups::ContactGroups(std::span<const Member> members, Eigen::Index vertex_count, Order order) {
  std::vector<std::size_t> left =
      members.size() < kLeastParallel ? order_as_given(members.size()) : order_by_place(members);
  std::vector<std::uint64_t> packs_of(static_cast<std::size_t>(vertex_count), 0);  // as add_group() leaves it
  // Runs of the curve are groups. A contact that shares a vertex with a group before its own waits for another round.
  // In a group contacts keep the order in which they are given (docs/measurements/simulator-speed.md says what another
  // order costs); what is left over acts run by run.
  while (left.size() >= kLeastParallel) {
    Round round{{}, std::vector<std::int32_t>(static_cast<std::size_t>(vertex_count), -1)};
    std::vector<std::vector<std::size_t>> groups;
    std::vector<std::size_t> waiting;
    for (std::size_t begin = 0; begin < left.size(); begin += kGroupSize) {
      const auto id = static_cast<std::int32_t>(groups.size());
      const auto owner = [&](VertexId v) -> std::int32_t& { return round.owner[static_cast<std::size_t>(v)]; };
      const auto is_free = [&](VertexId v) { return v < 0 || owner(v) < 0 || owner(v) == id; };
      std::vector<std::size_t>& kept = groups.emplace_back();
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
    }
    if (waiting.size() > kMaxWaiting * (left.size() - waiting.size())) break;
    for (const auto& group : groups) round.groups.push_back(add_group(members, group, order, packs_of));
    rounds_.push_back(std::move(round));
    left = std::move(waiting);
  }
  alone_ = add_group(members, left, order, packs_of);
}

/// In order, each member stands in the first pack with a free lane after all those in which members before it share a
/// vertex with it: what does not share one acts as in the order given, whichever acts first. Nearly in order, in the
/// first of the last few with a free lane in which nobody does.
ContactGroups::Group ContactGroups::add_group(std::span<const Member> members, std::span<const std::size_t> group,
                                              Order order, std::vector<std::uint64_t>& packs_of) {
  constexpr std::size_t kWindow = 64;
  const std::size_t begin = together_.size();
  std::size_t window = begin;  // where the packs start that are looked at now
  std::uint64_t full = 0;      // bit k: pack window + k has no free lane
  std::vector<VertexId> in_window;
  for (const std::size_t contact : group) {
    std::uint64_t taken = full;
    for (const VertexId v : members[contact].vertices) {
      if (v < 0) continue;
      const std::uint64_t packs = packs_of[static_cast<std::size_t>(v)];
      const bool any = order == Order::kNearly || packs == 0;
      taken |= any ? packs : ~std::uint64_t{0} >> std::countl_zero(packs);
    }
    const std::size_t count = together_.size() - window;
    if (order == Order::kNearly && count > kLookBack) taken |= (std::uint64_t{1} << (count - kLookBack)) - 1;
    auto at = static_cast<std::size_t>(std::countr_one(taken));
    if (at == kWindow) {
      for (const VertexId v : in_window) packs_of[static_cast<std::size_t>(v)] = 0;
      in_window.clear();
      window = together_.size();
      full = 0;
      at = 0;
    }
    const std::size_t pack = window + at;
    if (pack == together_.size()) {
      together_.push_back(0);
      order_.resize(order_.size() + kLanes, kNobody);
    }
    const auto lane = static_cast<std::size_t>(std::popcount(together_[pack]));
    order_[pack * kLanes + lane] = contact;
    together_[pack] |= only_lane(lane);
    if (together_[pack] == kAllLanes) full |= std::uint64_t{1} << at;
    for (const VertexId v : members[contact].vertices) {
      if (v < 0) continue;
      packs_of[static_cast<std::size_t>(v)] |= std::uint64_t{1} << at;
      in_window.push_back(v);
    }
  }
  for (const VertexId v : in_window) packs_of[static_cast<std::size_t>(v)] = 0;
  return {begin, together_.size(), {}, {}};
}

}  // namespace selvage::sim
