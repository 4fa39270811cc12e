#include "verify/surface/exemptions.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <tuple>

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

ExemptionTable::ExemptionTable(std::span<const Exemption> exemptions, std::span<const std::uint8_t> is_body,
                               std::size_t face_count)
    : rule_count_(exemptions.size()), face_labels_(face_count, kNoLabel), members_(1) {
  if (empty()) return;
  // Between two neighbouring ends of ranges all faces of cloth are alike, and all of bodies: two classes of faces.
  std::vector<std::int32_t> ends = {0, static_cast<std::int32_t>(face_count)};
  for (const Exemption& exemption : exemptions) {
    add_ends(exemption.a, ends);
    add_ends(exemption.b, ends);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::map<std::tuple<std::vector<std::uint8_t>, std::vector<std::uint8_t>, std::uint8_t>, std::int32_t> classes;
  const auto class_of = [&](const auto& in_a, const auto& in_b, std::uint8_t body) {
    const auto [found, is_new] = classes.try_emplace({in_a, in_b, body}, static_cast<std::int32_t>(in_a_.size()));
    if (is_new) {
      in_a_.push_back(in_a);
      in_b_.push_back(in_b);
      is_body_.push_back(body);
    }
    return found->second;
  };
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    std::vector<std::uint8_t> in_a, in_b;
    for (const Exemption& exemption : exemptions) {
      in_a.push_back(holds(exemption.a, ends[i]) ? 1 : 0);
      in_b.push_back(holds(exemption.b, ends[i]) ? 1 : 0);
    }
    std::array<Label, 2> labels = {kNoLabel, kNoLabel};
    for (auto f = static_cast<std::size_t>(ends[i]); f < static_cast<std::size_t>(ends[i + 1]); ++f) {
      const std::uint8_t body = !is_body.empty() && is_body[f] != 0 ? 1 : 0;
      if (labels[body] == kNoLabel) labels[body] = label_of({class_of(in_a, in_b, body)});
      face_labels_[f] = labels[body];
    }
  }
}

Label ExemptionTable::label_of(std::vector<std::int32_t> classes) {
  const auto [found, is_new] = labels_.try_emplace(std::move(classes), static_cast<Label>(members_.size()));
  if (is_new) {
    if (members_.size() == kMaxLabels) {
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

void ExemptionTable::close() { tables_ = {table(false), table(true)}; }

std::vector<std::int32_t> ExemptionTable::table(bool check_bodies) const {
  const auto none = static_cast<std::int32_t>(rule_count_);
  const std::size_t count = members_.size();
  std::vector<std::int32_t> result(count * count, -1);
  const auto rule_of_classes = [&](std::int32_t p, std::int32_t q) {
    const auto i = static_cast<std::size_t>(p), j = static_cast<std::size_t>(q);
    for (std::size_t rule = 0; rule < rule_count_; ++rule) {
      const bool covered = (in_a_[i][rule] != 0 && in_b_[j][rule] != 0) || (in_b_[i][rule] != 0 && in_a_[j][rule] != 0);
      if (covered) return static_cast<std::int32_t>(rule);
    }
    const bool bodies_alone = is_body_[i] != 0 && is_body_[j] != 0;
    return bodies_alone && !check_bodies ? none : std::int32_t{-1};
  };
  for (std::size_t x = 1; x < count; ++x) {
    for (std::size_t y = 1; y < count; ++y) {
      std::int32_t first = none;
      for (const std::int32_t p : members_[x]) {
        for (const std::int32_t q : members_[y]) first = std::min(first, rule_of_classes(p, q));
      }
      // One pair of classes that is owed a check makes it -1.
      result[x * count + y] = first == none ? -1 : first;
    }
  }
  return result;
}

}  // namespace selvage::verify
