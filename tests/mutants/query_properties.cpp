// Queries against exact arithmetic (K1 to K5), class after class; kept failures.
#include "fuzz/campaign/query_campaign.h"
#include "fuzz/kept/case_file.h"
#include "tests/fuzz/query_cases.h"
#include "tests/mutants/properties.h"

namespace selvage::mutants {
namespace {

/// One case of every class and kind, then the next one of each.
template <std::size_t property>
std::optional<Kill> falsify_query(std::uint64_t seed, long limit) {
  const auto campaign = fuzz::make_query_campaign(fuzz::query_properties()[property]);
  Kill kill;
  fuzz::for_cases_in_turn(campaign->streams(), [&](const fuzz::Stream& stream, std::int64_t number) {
    if (kill.cases == limit) return false;
    ++kill.cases;
    kill.what = campaign->run(stream, fuzz::source_of_case(seed, stream, number)).failure;
    if (!kill.what.empty()) kill.what += ", " + fuzz::query_stream(stream).query_class->name;
    return kill.what.empty();
  });
  return kill.what.empty() ? std::nullopt : std::optional(kill);
}

/// A case is a kept case; only what a property chooses besides it depends on the seed.
std::optional<Kill> falsify_kept(std::uint64_t seed, long limit) {
  long cases = 0;
  for (const auto& file : fuzz::case_files(SELVAGE_SOURCE_DIR "/tests/fuzz/cases")) {
    if (cases++ == limit) break;
    for (const fuzz::QueryProperty& property : fuzz::query_properties()) {
      fuzz::ChoiceSource source = fuzz::ChoiceSource::from_seed(seed);
      const auto failure = property.check(fuzz::read_case(file).query, fuzz::selvage_kernel, source).failure;
      if (!failure.empty()) return Kill{cases, std::string(failure) + ", " + file.stem().string()};
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<Property> query_properties() {
  const auto& queries = fuzz::query_properties();
  return {{queries[0].name, queries[0].promise, falsify_query<0>},
          {queries[1].name, queries[1].promise, falsify_query<1>},
          {queries[2].name, queries[2].promise, falsify_query<2>},
          {queries[3].name, queries[3].promise, falsify_query<3>},
          {"kept-cases", "every case that once failed is answered right (F3)", falsify_kept}};
}

}  // namespace selvage::mutants
