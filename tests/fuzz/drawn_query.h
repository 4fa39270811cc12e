// RapidCheck draws words; the decoder makes a query of them. Shrinking the words shrinks the query.
#pragma once

#include <cstdint>
#include <ostream>
#include <vector>

#include <rapidcheck.h>

#include "fuzz/draw/generators.h"
#include "fuzz/kept/case_file.h"

namespace selvage::fuzz {

struct DrawnQuery {
  std::size_t class_index = 0;
  PairKind kind = PairKind::kVf;
  std::vector<std::uint32_t> words;

  [[nodiscard]] const QueryClass& query_class() const { return query_classes()[class_index]; }
  /// `source` is left where the query's own choices end.
  [[nodiscard]] MotionQuery query(ChoiceSource& source) const { return make_query(query_class(), kind, source); }
};

inline void showValue(const DrawnQuery& drawn, std::ostream& os) {
  ChoiceSource source = ChoiceSource::from_words(drawn.words);
  const MotionQuery query = drawn.query(source);
  const bool touches = exact_motion(query, verify::Detail::kDecision).touches;
  os << "class " << drawn.query_class().name << "\n" << format_case({query, "rapidcheck", touches});
}

/// Any class that is not diluted, any kind it is made for. No class takes more words than this; at RapidCheck's full
/// size from the first case on, because a ramp from small words would make half of a short run the same few queries.
inline rc::Gen<DrawnQuery> any_query() {
  constexpr std::size_t kWords = 128;
  constexpr int kFullSize = 100;
  std::vector<std::pair<std::size_t, PairKind>> choices;
  for (std::size_t i = 0; i < query_classes().size(); ++i) {
    for (const PairKind kind : kPairKinds) {
      const bool quick = query_classes()[i].dilution == 1;
      if (quick && query_classes()[i].band(kind)) choices.emplace_back(i, kind);
    }
  }
  const auto words = rc::gen::container<std::vector<std::uint32_t>>(kWords, rc::gen::arbitrary<std::uint32_t>());
  return rc::gen::resize(
      kFullSize, rc::gen::apply(
                     [](const std::pair<std::size_t, PairKind>& choice, const std::vector<std::uint32_t>& drawn) {
                       return DrawnQuery{choice.first, choice.second, drawn};
                     },
                     rc::gen::elementOf(choices), words));
}

}  // namespace selvage::fuzz
