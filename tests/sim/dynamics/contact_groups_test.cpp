#include "sim/dynamics/contact_groups.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <mutex>
#include <numeric>
#include <random>
#include <span>
#include <utility>

#include "tests/kernel/with_threads.h"
#include "tests/property.h"
#include "tests/sim/mechanics.h"

namespace selvage::sim::testbed {
namespace {

constexpr VertexId kVertexCount = 3000;

/// Vertices in a cube, and contacts of neighbours among them; a tenth of the vertices do not move.
struct Heap {
  std::vector<ContactGroups::Member> members;

  Heap(std::uint64_t seed, std::size_t count) {
    std::mt19937_64 engine(seed);
    std::uniform_int_distribution<VertexId> vertex(0, kVertexCount - 1);
    std::uniform_int_distribution<std::size_t> neighbour(0, 3);
    std::uniform_int_distribution<int> tenth(0, 9);
    for (std::size_t i = 0; i < count; ++i) {
      const VertexId first = vertex(engine);
      ContactGroups::Member member{{}, Vec3(first % 15, first / 15 % 15, first / 225)};
      for (VertexId& v : member.vertices) {
        v = tenth(engine) == 0 ? -1 : (first + std::array{0, 1, 15, 225}[neighbour(engine)]) % kVertexCount;
      }
      members.push_back(member);
    }
  }
};

/// Numbers at the vertices to which each contact does what depends on what was done before.
struct Numbers {
  std::vector<std::uint64_t> at = std::vector<std::uint64_t>(kVertexCount, 1);

  void act(const ContactGroups::Member& member, std::size_t contact) {
    std::uint64_t sum = contact;
    for (const VertexId v : member.vertices) sum += v < 0 ? 0 : at[static_cast<std::size_t>(v)];
    for (const VertexId v : member.vertices) {
      if (v >= 0) at[static_cast<std::size_t>(v)] = 6364136223846793005u * (sum + 1) + 1442695040888963407u;
    }
  }
};

using Order = ContactGroups::Order;
using Refused = ContactGroups::Refused;

std::vector<std::size_t> lanes_of(LaneMask lanes) {
  std::vector<std::size_t> result;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (has_lane(lanes, lane)) result.push_back(lane);
  }
  return result;
}

/// The members that are called, by place.
template <class Visit>
void visit(std::size_t pack, LaneMask lanes, Visit visit_place) {
  for (const std::size_t lane : lanes_of(lanes)) visit_place(pack * kLanes + lane, only_lane(lane));
}

/// Those in order(), in it.
std::vector<std::size_t> somebody(const ContactGroups& groups) {
  std::vector<std::size_t> result = groups.order();
  std::erase(result, ContactGroups::kNobody);
  return result;
}

TEST(ContactGroups, PropActAsOneAfterTheOtherInTheirOrder) {
  selvage::testing::check_property(30, 83, [] {
    const Heap heap(*rc::gen::arbitrary<std::uint64_t>(), static_cast<std::size_t>(integer_in(0, 6000)));
    const bool backwards = integer_in(0, 2) == 1;
    const Order in = integer_in(0, 2) == 1 ? Order::kNearly : Order::kAsGiven;
    const VertexId needed = integer_in(0, kVertexCount);  // forwards, by a tenth of the contacts
    ContactGroups groups(heap.members, kVertexCount, in);
    const std::vector<std::size_t> order = groups.order();
    std::vector<std::uint8_t> left(order.size(), 0);
    Numbers together, apart;
    selvage::testing::with_threads(4, [&] {
      groups.each(backwards, [&](std::size_t pack, LaneMask lanes, const ContactGroups::Reach& reach) {
        Refused refused;
        visit(pack, lanes, [&](std::size_t place, LaneMask lane) {
          const ContactGroups::Member& member = heap.members[order[place]];
          const auto is_in_reach = [&](VertexId v) { return v < 0 || reach.has(v); };  // RC_ASSERT's || asks both sides
          RC_ASSERT(std::ranges::all_of(member.vertices, is_in_reach));
          if (!backwards && order[place] % 10 == 0 && !reach.has(needed)) {
            left[place] = 1;
            refused.out_of_reach |= lane;
            return;
          }
          together.act(member, order[place]);
        });
        return refused;
      });
    });
    for (const bool last : {false, true}) {  // those that left their group act after all others
      for (std::size_t k = 0; k < order.size(); ++k) {
        const std::size_t place = backwards ? order.size() - 1 - k : k;
        if (order[place] != ContactGroups::kNobody && (left[place] != 0) == last) {
          apart.act(heap.members[order[place]], order[place]);
        }
      }
    }
    RC_ASSERT(together.at == apart.at);
    std::vector<std::size_t> all = somebody(groups);
    std::ranges::sort(all);
    for (std::size_t i = 0; i < all.size(); ++i) RC_ASSERT(all[i] == i);  // each of them, once
    RC_ASSERT(all.size() == heap.members.size());
  });
}

TEST(ContactGroups, PropThoseOfAPackShareNoVertex) {
  selvage::testing::check_property(30, 89, [] {
    const Heap heap(*rc::gen::arbitrary<std::uint64_t>(), static_cast<std::size_t>(integer_in(1, 6000)));
    const ContactGroups groups(heap.members, kVertexCount, integer_in(0, 2) == 1 ? Order::kNearly : Order::kAsGiven);
    std::vector<std::size_t> last_pack(kVertexCount, ContactGroups::kNobody);
    for (std::size_t place = 0; place < groups.order().size(); ++place) {
      const std::size_t pack = place / kLanes, member = groups.order()[place];
      RC_ASSERT(has_lane(groups.together(pack), place % kLanes) == (member != ContactGroups::kNobody));
      if (member == ContactGroups::kNobody) continue;
      std::array<VertexId, 4> vertices = heap.members[member].vertices;
      std::ranges::sort(vertices);
      const auto end = std::unique(vertices.begin(), vertices.end());
      for (const VertexId v : std::span(vertices.begin(), end)) {
        if (v < 0) continue;
        RC_ASSERT(std::exchange(last_pack[static_cast<std::size_t>(v)], pack) != pack);
      }
    }
  });
}

TEST(ContactGroups, MostOfALargeHeapActsAtTheSameTime) {
  const Heap heap(7, 6000);
  ContactGroups groups(heap.members, kVertexCount, Order::kAsGiven);
  std::atomic<int> alone = 0;
  groups.each(false, [&](std::size_t, LaneMask lanes, const ContactGroups::Reach& reach) {
    bool has_all = true;
    for (VertexId v = 0; has_all && v < kVertexCount; ++v) has_all = reach.has(v);
    alone += has_all ? std::popcount(lanes) : 0;
    return Refused{};
  });
  EXPECT_LT(alone, 600);
}

TEST(ContactGroups, NearlyInOrderFillsPacks) {
  const Heap heap(7, 6000);
  const auto packs = [&](Order order) {
    return ContactGroups(heap.members, kVertexCount, order).order().size() / kLanes;
  };
  EXPECT_LT(packs(Order::kNearly), 1000);  // 750 would be full
  EXPECT_LT(packs(Order::kNearly), packs(Order::kAsGiven));
}

TEST(ContactGroups, PropFewActAsInTheOrderInWhichTheyAreGiven) {
  selvage::testing::check_property(100, 97, [] {
    const Heap heap(*rc::gen::arbitrary<std::uint64_t>(), static_cast<std::size_t>(integer_in(0, 512)));
    Numbers as_given, in_packs;
    for (std::size_t i = 0; i < heap.members.size(); ++i) as_given.act(heap.members[i], i);
    for (const std::size_t i : somebody(ContactGroups(heap.members, kVertexCount, Order::kAsGiven))) {
      in_packs.act(heap.members[i], i);
    }
    RC_ASSERT(as_given.at == in_packs.at);
  });
}

TEST(ContactGroups, OfOneVertexActAlone) {
  std::vector<ContactGroups::Member> fan(2000, {{5, -1, -1, -1}, Vec3::Zero()});
  for (std::size_t i = 0; i < fan.size(); ++i) fan[i].at = Vec3(static_cast<double>(i), 0, 0);
  for (const Order order : {Order::kAsGiven, Order::kNearly}) {
    ContactGroups groups(fan, 10, order);
    int calls = 0;  // not atomic: they are on one thread
    groups.each(false, [&](std::size_t, LaneMask lanes, const ContactGroups::Reach& reach) {
      EXPECT_TRUE(reach.has(9));
      EXPECT_EQ(std::popcount(lanes), 1);
      ++calls;
      return Refused{};
    });
    EXPECT_EQ(calls, 2000);
  }
}

TEST(ContactGroups, WhatNeedsMoreThanItsReachActsAfterAllOthersAndThenAlone) {
  const Heap heap(9, 5000);
  ContactGroups groups(heap.members, kVertexCount, Order::kAsGiven);
  const auto needs_far_vertex = [&](std::size_t place) { return groups.order()[place] % 7 == 0; };
  std::mutex mutex;
  for (int pass = 0; pass < 3; ++pass) {
    std::vector<int> refused(groups.order().size(), 0), acted(groups.order().size(), 0);
    std::vector<std::size_t> last;
    const auto act = [&](std::size_t pack, LaneMask lanes, const ContactGroups::Reach& reach) {
      const std::scoped_lock lock(mutex);
      Refused result;
      visit(pack, lanes, [&](std::size_t place, LaneMask lane) {
        const bool has_far = reach.has((heap.members[groups.order()[place]].vertices[0] + 1500) % kVertexCount);
        if (needs_far_vertex(place) && !has_far) {
          ++refused[place];
          result.out_of_reach |= lane;
        } else {
          ++acted[place];
          last.push_back(place);
        }
      });
      return result;
    };
    selvage::testing::with_threads(4, [&] { groups.each(pass == 1, act); });
    EXPECT_EQ(std::ranges::count(acted, 1), std::ssize(heap.members)) << pass;
    EXPECT_EQ(std::ranges::count(acted, 0), std::ranges::count(groups.order(), ContactGroups::kNobody)) << pass;
    if (pass > 0) {
      EXPECT_EQ(std::ranges::count(refused, 0), std::ssize(refused)) << pass;
      continue;
    }
    const auto count = std::accumulate(refused.begin(), refused.end(), 0);
    EXPECT_GT(count, 500);
    for (const std::size_t place : std::span(last).last(static_cast<std::size_t>(count))) {
      EXPECT_EQ(refused[place], 1);
    }
  }
}

TEST(ContactGroups, WhatCannotActAtOnceActsAfterThePacksOfItsGroupAndThenOneByOne) {
  const Heap heap(10, 500);
  ContactGroups groups(heap.members, kVertexCount, Order::kNearly);
  const auto refuses = [&](std::size_t place) { return groups.order()[place] % 5 == 0; };
  for (int pass = 0; pass < 3; ++pass) {
    std::vector<std::size_t> acted;
    groups.each(pass == 1, [&](std::size_t pack, LaneMask lanes, const ContactGroups::Reach&) {
      Refused result;
      const bool is_single = std::popcount(lanes) == 1;
      visit(pack, lanes, [&](std::size_t place, LaneMask lane) {
        if (refuses(place) && !is_single) {
          EXPECT_EQ(pass, 0);
          result.at_once |= lane;
        } else {
          acted.push_back(groups.order()[place]);
        }
      });
      return result;
    });
    EXPECT_TRUE(std::ranges::all_of(std::span(acted).last(50), [](std::size_t i) { return i % 5 == 0; })) << pass;
    std::ranges::sort(acted);
    EXPECT_EQ(acted.size(), 500) << pass;
    EXPECT_EQ(std::ranges::adjacent_find(acted), acted.end()) << pass;
  }
}

TEST(ContactGroups, TakeAnyPlaces) {
  // At the ends of the range, and all at one: then the order is the one given.
  std::vector<ContactGroups::Member> members;
  for (VertexId v = 0; v < 1000; ++v) {
    members.push_back({{v, -1, -1, -1}, Vec3::Constant(v % 2 == 0 ? kMaxCoordinate : -kMaxCoordinate)});
  }
  std::vector<std::size_t> order = somebody(ContactGroups(members, 1000, Order::kAsGiven));
  std::ranges::sort(order);
  EXPECT_EQ(std::ranges::adjacent_find(order), order.end());
  for (ContactGroups::Member& member : members) member.at = Vec3::Constant(-7);
  order = somebody(ContactGroups(members, 1000, Order::kAsGiven));
  EXPECT_TRUE(std::ranges::is_sorted(order));
  EXPECT_EQ(order.size(), 1000);
}

}  // namespace
}  // namespace selvage::sim::testbed
