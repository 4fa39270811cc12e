// Bytes as cases, the way libFuzzer and AFL++ make them: any bytes are a query of the domain, and every case that words
// (RapidCheck) or a seed (campaigns) make is also one of bytes.
#include <gtest/gtest.h>

#include "tests/fuzz/drawn_query.h"
#include "tests/property.h"

namespace selvage::fuzz {
namespace {

using testing::check_property;

constexpr std::uint64_t kByteSeed = 20020721;

/// Every bit of it, as text.
std::string text_of(const MotionQuery& query) { return format_case({query, "drawn", false}); }

/// Every class and kind, those that campaigns dilute included: making a query is cheap.
template <class Visit>
void for_each_class(const Visit& visit) {
  for (const QueryClass& query_class : query_classes()) {
    for (const PairKind kind : kPairKinds) {
      if (query_class.band(kind)) visit(query_class, kind);
    }
  }
}

/// Any bytes, or one byte all the time, which is what a loop that waits for another answer would never leave.
rc::Gen<std::vector<std::uint8_t>> any_bytes() {
  constexpr int kMaxBytes = 600;  // more than any query takes
  const auto byte = rc::gen::arbitrary<std::uint8_t>();
  const auto repeated = rc::gen::map(rc::gen::pair(byte, rc::gen::inRange<std::size_t>(0, kMaxBytes)),
                                     [](auto drawn) { return std::vector<std::uint8_t>(drawn.second, drawn.first); });
  return rc::gen::oneOf(rc::gen::resize(kMaxBytes, rc::gen::container<std::vector<std::uint8_t>>(byte)), repeated);
}

TEST(ByteDecoder, prop_any_bytes_are_a_query) {
  check_property(100, kByteSeed, [] {
    const std::vector<std::uint8_t> bytes = *any_bytes();
    for_each_class([&bytes](const QueryClass& query_class, PairKind kind) {
      ChoiceSource source = ChoiceSource::from_bytes(bytes);
      const MotionQuery query = make_query(query_class, kind, source);
      for (const auto* x : {&query.x_t0, &query.x_t1}) {
        for (const Vec3& point : *x) RC_ASSERT(point.allFinite());
      }
      RC_ASSERT(max_coordinate(query) <= kMaxCoordinate);
      RC_ASSERT(query.options.tolerance >= 0);
      RC_ASSERT(std::isfinite(query.options.tolerance));
      RC_ASSERT(query.options.max_intervals >= 1);
      ChoiceSource again = ChoiceSource::from_bytes(bytes);
      RC_ASSERT(text_of(make_query(query_class, kind, again)) == text_of(query));
    });
  });
}

/// What `source` makes, and the same from the bytes that it recorded; also the next answer, behind the query.
template <class Make>
bool survives_as_bytes(ChoiceSource source, const Make& make) {
  std::vector<std::uint8_t> bytes;
  source.record_to(bytes);
  const std::string query = text_of(make(source));
  const std::uint32_t next = source.n(1'000'000);
  ChoiceSource from_bytes = ChoiceSource::from_bytes(bytes);
  return text_of(make(from_bytes)) == query && from_bytes.n(1'000'000) == next;
}

TEST(ByteDecoder, prop_words_are_bytes) {
  check_property(1000, kByteSeed + 1, [] {
    const DrawnQuery drawn = *any_query();
    const auto make = [&drawn](ChoiceSource& source) { return drawn.query(source); };
    RC_ASSERT(survives_as_bytes(ChoiceSource::from_words(drawn.words), make));
  });
}

TEST(ByteDecoder, SeedsAreBytes) {
  for_each_class([](const QueryClass& query_class, PairKind kind) {
    const auto make = [&](ChoiceSource& source) { return make_query(query_class, kind, source); };
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      EXPECT_TRUE(survives_as_bytes(ChoiceSource::from_seed(seed), make)) << query_class.name << " " << name_of(kind);
    }
  });
}

}  // namespace
}  // namespace selvage::fuzz
