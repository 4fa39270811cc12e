#include "cli/bench/hard_queries.h"

#include <algorithm>
#include <array>

#include "fuzz/draw/generators.h"

namespace selvage::cli {
namespace {

constexpr std::array<PairKind, 2> kKinds{PairKind::kVf, PairKind::kEe};

}  // namespace

std::vector<bench::QuerySet> hard_query_sets(int count) {
  const std::vector<fuzz::QueryClass>& classes = fuzz::query_classes();
  std::vector<bench::QuerySet> sets;
  for (const fuzz::QueryGroup& group : fuzz::query_groups()) {
    bench::QuerySet set{std::string(1, group.letter), std::string(group.name), {}, nullptr, {}, {}};
    const auto is_of_group = [&](const fuzz::QueryClass& of) { return of.group == group.letter; };
    const auto class_count = std::count_if(classes.begin(), classes.end(), is_of_group);
    const std::int64_t share = std::max<std::int64_t>(1, count / (2 * class_count));
    for (std::size_t c = 0; c < classes.size(); ++c) {
      if (!is_of_group(classes[c])) continue;
      for (const PairKind kind : kKinds) {
        const std::int64_t cases = classes[c].band(kind) ? std::max<std::int64_t>(1, share / classes[c].dilution) : 0;
        for (std::int64_t i = 0; i < cases; ++i) {
          auto source = fuzz::ChoiceSource::from_seed(fuzz::mix(c, static_cast<std::uint64_t>(i)));
          const fuzz::MotionQuery query = fuzz::make_query(classes[c], kind, source);
          set.queries.push_back(bench::method_query(kind, query.x_t0, query.x_t1));
        }
      }
    }
    sets.push_back(std::move(set));
  }
  return sets;
}

}  // namespace selvage::cli
