#include "verify/surface/group_rules.h"

#include <algorithm>
#include <map>

namespace selvage::verify {
namespace {

using Groups = std::map<std::string, FaceSet>;

/// Disjoint and ascending: a face that two ranges of one name hold is held once.
FaceSet merged(FaceSet set) {
  std::sort(set.begin(), set.end(), [](const FaceRange& x, const FaceRange& y) { return x.begin < y.begin; });
  FaceSet result;
  for (const FaceRange& range : set) {
    if (range.begin == range.end) continue;
    if (!result.empty() && range.begin <= result.back().end) {
      result.back().end = std::max(result.back().end, range.end);
    } else {
      result.push_back(range);
    }
  }
  return result;
}

std::int64_t face_count_of(const FaceSet& set) {
  std::int64_t count = 0;
  for (const FaceRange& range : set) count += range.end - range.begin;
  return count;
}

std::string known(const Groups& groups) {
  if (groups.empty()) return "the mesh has no groups (--group NAME=BEGIN:END makes one)";
  constexpr std::size_t kMaxNamed = 20;
  std::string text = "the groups are";
  std::size_t named = 0;
  for (const auto& [name, faces] : groups) {
    if (named++ == kMaxNamed) return text + " and " + std::to_string(groups.size() - kMaxNamed) + " more";
    text += (named > 1 ? ", \"" : " \"") + name + "\" (" + std::to_string(face_count_of(faces)) + " faces)";
  }
  return text;
}

Groups by_name(const GroupRules& rules, std::span<const io::Group> groups, std::size_t face_count) {
  Groups result;
  for (const io::Group& group : groups) result[group.name].push_back({group.face_begin, group.face_end});
  for (const io::Group& group : rules.groups) {
    if (group.face_begin < 0 || group.face_begin >= group.face_end ||
        static_cast<std::size_t>(group.face_end) > face_count) {
      throw GroupRuleError("group \"" + group.name + "\": faces " + std::to_string(group.face_begin) + ":" +
                           std::to_string(group.face_end) + " are no range of the mesh's " +
                           std::to_string(face_count) + " faces; give BEGIN:END within them");
    }
    result[group.name].push_back({group.face_begin, group.face_end});
  }
  for (auto& [name, faces] : result) faces = merged(std::move(faces));
  return result;
}

const FaceSet& faces_of(const Groups& groups, const std::string& name, const char* what) {
  const auto found = groups.find(name);
  if (found == groups.end()) throw GroupRuleError(std::string(what) + ": no group \"" + name + "\"; " + known(groups));
  if (found->second.empty()) {
    throw GroupRuleError(std::string(what) + ": group \"" + name + "\" has no face; " + known(groups));
  }
  return found->second;
}

}  // namespace

ResolvedRules resolve(const GroupRules& rules, std::span<const io::Group> groups, std::size_t face_count) {
  const Groups named = by_name(rules, groups, face_count);
  ResolvedRules resolved;
  for (const auto& [a, b] : rules.exempt) {
    const FaceSet &faces_a = faces_of(named, a, "exempt"), &faces_b = faces_of(named, b, "exempt");
    if (faces_a == faces_b && face_count_of(faces_a) == 1) {
      throw GroupRuleError("exempt: \"" + a + "\" and \"" + b + "\" hold one face and so no pair; " + known(named));
    }
    resolved.exemptions.push_back({faces_a, faces_b});
  }
  for (const std::string& name : rules.ignore) {
    const FaceSet& faces = faces_of(named, name, "ignore");
    resolved.is_ignored.resize(face_count);
    for (const FaceRange& range : faces) {
      std::fill(resolved.is_ignored.begin() + range.begin, resolved.is_ignored.begin() + range.end, std::uint8_t{1});
    }
    resolved.ignored_faces.push_back(face_count_of(faces));
  }
  return resolved;
}

}  // namespace selvage::verify
