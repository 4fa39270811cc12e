// Who holds a record of sharpness.
#include "fuzz/run/records.h"

#include <gtest/gtest.h>

namespace selvage::fuzz {
namespace {

Counts counted(std::int64_t cases, std::int64_t touches, std::int64_t exact, std::int64_t nearest_bits) {
  Counts counts{cases, 0, {}, nearest_bits};
  counts.of = {touches, 0, 0, 0, 0, exact};
  return counts;
}

PropertyLedger ledger_of(std::vector<std::string> streams, std::vector<Counts> rows) {
  return {"ccd",           {}, std::move(streams), {"touches", "hits", "alarms", "unresolved", "undecided", "exact"},
          std::move(rows), {}};
}

const SharpnessRecord* find(const std::vector<SharpnessRecord>& records, std::string_view measure,
                            std::string_view kind) {
  for (const SharpnessRecord& record : records) {
    if (record.measure == measure && record.kind == kind) return &record;
  }
  return nullptr;
}

}  // namespace

TEST(SharpnessRecords, NameWhoReachesTheBestValueOfAKind) {
  const auto records = sharpness_records(
      ledger_of({"a vf", "b vf", "c vf", "a ee"}, {counted(1000, 200, 300, 51), counted(1000, 200, 600, 52),
                                                   counted(1000, 200, 200, 52), counted(1000, 200, 240, 0)}));
  ASSERT_EQ(records.size(), 3U);
  EXPECT_EQ(find(records, "nearest", "vf")->classes, (std::vector<std::string>{"b", "c"}));
  EXPECT_EQ(find(records, "nearest", "vf")->value, 52);
  EXPECT_EQ(find(records, "unfiltered", "vf")->classes, std::vector<std::string>{"b"});
  EXPECT_EQ(find(records, "unfiltered", "vf")->value, 0.5);
  EXPECT_EQ(find(records, "unfiltered", "ee")->classes, std::vector<std::string>{"a"});
  EXPECT_EQ(find(records, "nearest", "ee"), nullptr);
}

TEST(SharpnessRecords, AreNotHeldByAFewCasesNorWithoutExactDecisions) {
  EXPECT_TRUE(sharpness_records(ledger_of({"a vf"}, {counted(1000, 901, 1000, 0)})).empty());
  EXPECT_EQ(sharpness_records(ledger_of({"a vf"}, {counted(1000, 900, 1000, 0)})).size(), 1U);
  PropertyLedger without = ledger_of({"a vf"}, {counted(1000, 0, 900, 52)});
  without.counters = {"pairs"};
  EXPECT_TRUE(sharpness_records(without).empty());
}

}  // namespace selvage::fuzz
