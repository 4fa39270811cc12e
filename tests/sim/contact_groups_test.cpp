#include "sim/contact_groups.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <numeric>
#include <random>
#include <span>

#include "tests/kernel/with_threads.h"
#include "tests/property.h"
#include "tests/sim/mechanics.h"

namespace selvage::sim::testing {
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

TEST(ContactGroups, PropActAsOneAfterTheOtherInTheirOrder) {
  selvage::testing::check_property(30, 83, [] {
    const Heap heap(*rc::gen::arbitrary<std::uint64_t>(), static_cast<std::size_t>(integer_in(0, 6000)));
    const bool backwards = integer_in(0, 2) == 1;
    const VertexId needed = integer_in(0, kVertexCount);  // forwards, by a tenth of the contacts
    ContactGroups groups(heap.members, kVertexCount);
    std::vector<std::size_t> order = groups.order();
    std::vector<std::uint8_t> left(order.size(), 0);
    Numbers together, apart;
    selvage::testing::with_threads(4, [&] {
      groups.each(backwards, [&](std::size_t place, const ContactGroups::Reach& reach) {
        const ContactGroups::Member& member = heap.members[order[place]];
        const auto is_in_reach = [&](VertexId v) { return v < 0 || reach.has(v); };  // RC_ASSERT's || asks both sides
        RC_ASSERT(std::ranges::all_of(member.vertices, is_in_reach));
        if (!backwards && order[place] % 10 == 0 && !reach.has(needed)) {
          left[place] = 1;
          return false;
        }
        together.act(member, order[place]);
        return true;
      });
    });
    for (const bool last : {false, true}) {  // those that left their group act after all others
      for (std::size_t k = 0; k < order.size(); ++k) {
        const std::size_t place = backwards ? order.size() - 1 - k : k;
        if ((left[place] != 0) == last) apart.act(heap.members[order[place]], order[place]);
      }
    }
    RC_ASSERT(together.at == apart.at);
    std::ranges::sort(order);
    for (std::size_t i = 0; i < order.size(); ++i) RC_ASSERT(order[i] == i);  // each of them, once
    RC_ASSERT(order.size() == heap.members.size());
  });
}

TEST(ContactGroups, MostOfALargeHeapActsAtTheSameTime) {
  const Heap heap(7, 6000);
  ContactGroups groups(heap.members, kVertexCount);
  std::atomic<int> alone = 0;
  groups.each(false, [&](std::size_t, const ContactGroups::Reach& reach) {
    bool has_all = true;
    for (VertexId v = 0; has_all && v < kVertexCount; ++v) has_all = reach.has(v);
    alone += has_all ? 1 : 0;
    return true;
  });
  EXPECT_LT(alone, 600);
}

TEST(ContactGroups, FewActInTheOrderInWhichTheyAreGiven) {
  const Heap heap(8, 500);
  const std::vector<std::size_t> order = ContactGroups(heap.members, kVertexCount).order();
  EXPECT_TRUE(std::ranges::is_sorted(order));
}

TEST(ContactGroups, OfOneVertexActAlone) {
  std::vector<ContactGroups::Member> fan(2000, {{5, -1, -1, -1}, Vec3::Zero()});
  for (std::size_t i = 0; i < fan.size(); ++i) fan[i].at = Vec3(static_cast<double>(i), 0, 0);
  ContactGroups groups(fan, 10);
  int calls = 0;  // not atomic: they are on one thread
  groups.each(false, [&](std::size_t, const ContactGroups::Reach& reach) {
    EXPECT_TRUE(reach.has(9));
    ++calls;
    return true;
  });
  EXPECT_EQ(calls, 2000);
}

TEST(ContactGroups, WhatNeedsMoreThanItsReachActsAfterAllOthersAndThenAlone) {
  const Heap heap(9, 5000);
  ContactGroups groups(heap.members, kVertexCount);
  const auto needs_far_vertex = [&](std::size_t place) { return groups.order()[place] % 7 == 0; };
  std::mutex mutex;
  for (int pass = 0; pass < 3; ++pass) {
    std::vector<int> refused(heap.members.size(), 0), acted(heap.members.size(), 0);
    std::vector<std::size_t> last;
    const auto act = [&](std::size_t place, const ContactGroups::Reach& reach) {
      const std::scoped_lock lock(mutex);
      const bool has_far = reach.has((heap.members[groups.order()[place]].vertices[0] + 1500) % kVertexCount);
      if (needs_far_vertex(place) && !has_far) {
        ++refused[place];
        return false;
      }
      ++acted[place];
      last.push_back(place);
      return true;
    };
    selvage::testing::with_threads(4, [&] { groups.each(pass == 1, act); });
    EXPECT_EQ(std::ranges::count(acted, 1), std::ssize(acted)) << pass;
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

TEST(ContactGroups, TakeAnyPlaces) {
  // At the ends of the range, and all at one: then the order is the one given.
  std::vector<ContactGroups::Member> members;
  for (VertexId v = 0; v < 1000; ++v) {
    members.push_back({{v, -1, -1, -1}, Vec3::Constant(v % 2 == 0 ? kMaxCoordinate : -kMaxCoordinate)});
  }
  std::vector<std::size_t> order = ContactGroups(members, 1000).order();
  std::ranges::sort(order);
  EXPECT_EQ(std::ranges::adjacent_find(order), order.end());
  for (ContactGroups::Member& member : members) member.at = Vec3::Constant(-7);
  order = ContactGroups(members, 1000).order();
  EXPECT_TRUE(std::ranges::is_sorted(order));
  EXPECT_EQ(order.size(), 1000);
}

}  // namespace
}  // namespace selvage::sim::testing
