#include "fuzz/campaign/query_campaign.h"

#include <algorithm>
#include <cmath>

namespace selvage::fuzz {

Tally& Tally::operator+=(const Tally& other) {
  cases += other.cases;
  touches += other.touches;
  hits += other.hits;
  alarms += other.alarms;
  unresolved += other.unresolved;
  undecided += other.undecided;
  failures += other.failures;
  return *this;
}

std::uint64_t case_seed(std::uint64_t seed, const Chunk& chunk, std::int64_t number) {
  // The class enters by name, so that adding a class leaves the cases of the others alone.
  std::uint64_t key = mix(seed, static_cast<std::uint64_t>(chunk.kind));
  for (const char letter : chunk.query_class->name) key = mix(key, static_cast<std::uint64_t>(letter));
  return mix(key, static_cast<std::uint64_t>(number));
}

Tally run_chunk(const QueryProperty& property, CcdKernel kernel, std::uint64_t seed, const Chunk& chunk,
                const std::function<void(const Failure&)>& on_failure) {
  Tally tally;
  for (std::int64_t number = chunk.first; number < chunk.first + chunk.count; ++number) {
    const std::uint64_t own_seed = case_seed(seed, chunk, number);
    ChoiceSource source = ChoiceSource::from_seed(own_seed);
    const MotionQuery query = make_query(*chunk.query_class, chunk.kind, source);
    const Observation seen = property.check(query, kernel, source);
    tally += {1, seen.touches, seen.hit, seen.alarm, seen.unresolved, seen.undecided, !seen.failure.empty()};
    if (seen.failure.empty()) continue;
    const std::string origin = std::string(property.name) + ":" + chunk.query_class->name + ":" + std::to_string(seed) +
                               ":" + std::to_string(number);
    const bool touches = exact_motion(query, verify::Detail::kDecision).touches;
    on_failure({std::string(property.name),
                chunk.query_class->name,
                std::string(seen.failure),
                number,
                {query, origin, touches}});
  }
  return tally;
}

std::vector<Chunk> make_chunks(std::int64_t first, std::int64_t count) {
  std::vector<Chunk> chunks;
  for (const QueryClass& query_class : query_classes()) {
    for (const PairKind kind : kPairKinds) {
      if (!query_class.band(kind)) continue;
      const std::int64_t begin = (first + query_class.dilution - 1) / query_class.dilution;
      const std::int64_t end = (first + count + query_class.dilution - 1) / query_class.dilution;
      if (end > begin) chunks.push_back({&query_class, kind, begin, end - begin});
    }
  }
  return chunks;
}

namespace {

/// Five standard deviations of a count.
double noise(double cases, double share) { return 5 * std::sqrt(cases * share * (1 - share)); }

}  // namespace

bool is_out_of_band(const QueryClass& query_class, PairKind kind, const Tally& tally) {
  const HitBand& band = *query_class.band(kind);
  const auto cases = static_cast<double>(tally.cases);
  const auto hits = static_cast<double>(query_class.aims_at_end ? tally.hits : tally.touches);
  return hits < cases * band.low - noise(cases, band.low) || hits > cases * band.high + noise(cases, band.high);
}

bool is_unresolved_too_often(PairKind kind, const Tally& tally) {
  // Measured: at most 1 % of any class for vf and ee; for self, which has no cubic to guide the search, 20 % of the
  // touches in which a vertex slides along its edge for a while (triple-root).
  const double share = kind == PairKind::kSelf ? 0.25 : 0.02;
  const auto cases = static_cast<double>(tally.cases);
  return static_cast<double>(tally.unresolved) > cases * share + noise(cases, share);
}

}  // namespace selvage::fuzz
