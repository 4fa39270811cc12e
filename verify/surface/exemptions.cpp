#include "verify/surface/exemptions.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace selvage::verify {
namespace {

void add_ends(const FaceSet& set, std::vector<std::int32_t>& ends) {
  for (const FaceRange& range : set) ends.insert(ends.end(), {range.begin, range.end});
}

bool holds(const FaceSet& set, std::int32_t face) {
  return std::any_of(set.begin(), set.end(),
                     [face](const FaceRange& range) { return range.begin <= face && face < range.end; });
}

}  // namespace

ExemptionTable::ExemptionTable(std::span<const Exemption> exemptions, std::size_t face_count)
    : rule_count_(exemptions.size()), face_labels_(face_count, kNoLabel), members_(1) {
  if (empty()) return;
  // Between two neighbouring ends of ranges all faces are alike: a class of faces.
  std::vector<std::int32_t> ends = {0, static_cast<std::int32_t>(face_count)};
  for (const Exemption& exemption : exemptions) {
    add_ends(exemption.a, ends);
    add_ends(exemption.b, ends);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::map<std::pair<std::vector<std::uint8_t>, std::vector<std::uint8_t>>, std::int32_t> classes;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    std::vector<std::uint8_t> in_a, in_b;
    for (const Exemption& exemption : exemptions) {
      in_a.push_back(holds(exemption.a, ends[i]) ? 1 : 0);
      in_b.push_back(holds(exemption.b, ends[i]) ? 1 : 0);
    }
    const auto [found, is_new] = classes.try_emplace({in_a, in_b}, static_cast<std::int32_t>(in_a_.size()));
    if (is_new) {
      in_a_.push_back(std::move(in_a));
      in_b_.push_back(std::move(in_b));
    }
    std::fill(face_labels_.begin() + ends[i], face_labels_.begin() + ends[i + 1], label_of({found->second}));
  }
}

Label ExemptionTable::label_of(std::vector<std::int32_t> classes) {
  const auto [found, is_new] = labels_.try_emplace(std::move(classes), static_cast<Label>(members_.size()));
  if (is_new) {
    if (members_.size() == kMostLabels) {
      throw std::invalid_argument("the exempted groups meet in more than 2,047 different ways; exempt fewer at a time");
    }
    members_.push_back(found->first);
  }
  return found->second;
}

Label ExemptionTable::unite(Label x, Label y) {
  if (x == y || y == kNoLabel) return x;
  if (x == kNoLabel) return y;
  const auto [found, is_new] = unions_.try_emplace(std::minmax(x, y), kNoLabel);
  if (is_new) {
    std::vector<std::int32_t> both;
    const auto &a = members_[static_cast<std::size_t>(x)], &b = members_[static_cast<std::size_t>(y)];
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
    found->second = label_of(std::move(both));
  }
  return found->second;
}

void ExemptionTable::close() {
  const std::size_t count = members_.size();
  table_.assign(count * count, -1);
  const auto rule_of_classes = [&](std::int32_t p, std::int32_t q) {
    const auto i = static_cast<std::size_t>(p), j = static_cast<std::size_t>(q);
    for (std::size_t rule = 0; rule < rule_count_; ++rule) {
      const bool covered = (in_a_[i][rule] != 0 && in_b_[j][rule] != 0) || (in_b_[i][rule] != 0 && in_a_[j][rule] != 0);
      if (covered) return static_cast<std::int32_t>(rule);
    }
    return std::int32_t{-1};
  };
  for (std::size_t x = 1; x < count; ++x) {
    for (std::size_t y = 1; y < count; ++y) {
      auto first = static_cast<std::int32_t>(rule_count_);
      for (const std::int32_t p : members_[x]) {
        for (const std::int32_t q : members_[y]) first = std::min(first, rule_of_classes(p, q));
      }
      table_[x * count + y] = first;  // one pair of classes that is not exempt makes it -1
    }
  }
}

}  // namespace selvage::verify
