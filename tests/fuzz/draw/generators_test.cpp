// Generator health (F1): every class makes what its name says, and none has gone dead.
#include "fuzz/draw/generators.h"

#include <set>

#include <gtest/gtest.h>

#include "fuzz/campaign/query_campaign.h"

namespace selvage::fuzz {
namespace {

constexpr std::int64_t kDraws = 300;

TEST(Generators, NamesAreUnique) {
  std::set<std::string> names;
  for (const QueryClass& query_class : query_classes()) EXPECT_TRUE(names.insert(query_class.name).second);
  EXPECT_GE(names.size(), 35U);
}

/// Exact touches and ends within the tolerance, without asking any kernel.
Tally tally_of(const Chunk& chunk) {
  Tally tally;
  for (std::int64_t number = chunk.first; number < chunk.first + chunk.count; ++number) {
    ChoiceSource source = ChoiceSource::from_seed(case_seed(1, chunk, number));
    const MotionQuery query = make_query(*chunk.query_class, chunk.kind, source);
    const bool touches = exact_motion(query, verify::Detail::kDecision).touches;
    ++tally.cases;
    tally.touches += touches;
    tally.hits += touches || within_at(query, 1, query.options.tolerance);
  }
  return tally;
}

TEST(Generators, ShareOfExactHitsIsInItsBand) {
  std::int64_t hits = 0;
  for (const Chunk& chunk : make_chunks(0, kDraws)) {
    const Tally tally = tally_of(chunk);
    hits += tally.hits;
    EXPECT_FALSE(is_out_of_band(*chunk.query_class, chunk.kind, tally))
        << chunk.query_class->name << " " << name_of(chunk.kind) << ": " << tally.touches << " touches, " << tally.hits
        << " hits in " << tally.cases << " cases";
  }
  EXPECT_GT(hits, 10000);
}

// The gate itself: a class whose queries never touch, and one that always does, are outside every other band.
TEST(Generators, ADeadClassIsOutOfBand) {
  for (const QueryClass& query_class : query_classes()) {
    for (const PairKind kind : kPairKinds) {
      if (!query_class.band(kind)) continue;
      Tally dead;
      dead.cases = 20000;
      EXPECT_TRUE(is_out_of_band(query_class, kind, dead)) << query_class.name << " " << name_of(kind);
      if (query_class.band(kind)->high == 1) continue;
      Tally saturated{20000, 20000, 20000, 0, 0, 0, 0};
      EXPECT_TRUE(is_out_of_band(query_class, kind, saturated)) << query_class.name << " " << name_of(kind);
    }
  }
}

TEST(Generators, CasesDiffer) {
  for (const Chunk& chunk : make_chunks(0, 64)) {
    std::set<std::string> seen;
    for (std::int64_t number = 0; number < chunk.count; ++number) {
      ChoiceSource source = ChoiceSource::from_seed(case_seed(1, chunk, number));
      seen.insert(format_case({make_query(*chunk.query_class, chunk.kind, source), "x", false}));
    }
    EXPECT_GT(seen.size(), static_cast<std::size_t>(chunk.count * 9 / 10)) << chunk.query_class->name;
  }
}

TEST(Generators, TheSimplestQueryOfEveryClassIsInTheDomain) {
  for (const QueryClass& query_class : query_classes()) {
    for (const PairKind kind : kPairKinds) {
      if (!query_class.band(kind)) continue;
      ChoiceSource source = ChoiceSource::from_words({});
      const MotionQuery query = make_query(query_class, kind, source);
      EXPECT_LE(max_coordinate(query), kMaxCoordinate);
      EXPECT_TRUE(std::isfinite(query.options.tolerance));
    }
  }
}

TEST(Generators, EveryQueryIsInTheDomain) {
  for (const Chunk& chunk : make_chunks(0, 1000)) {
    for (std::int64_t number = 0; number < chunk.count; ++number) {
      ChoiceSource source = ChoiceSource::from_seed(case_seed(2, chunk, number));
      const MotionQuery query = make_query(*chunk.query_class, chunk.kind, source);
      ASSERT_LE(max_coordinate(query), kMaxCoordinate) << chunk.query_class->name << " " << number;
      ASSERT_TRUE(std::isfinite(query.options.tolerance) && query.options.tolerance >= 0);
    }
  }
}

}  // namespace
}  // namespace selvage::fuzz
