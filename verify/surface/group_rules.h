// What the user says about groups of faces by name, worked out for the faces of one frame.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/mesh_data.h"
#include "verify/surface/exemptions.h"

namespace selvage::verify {

struct GroupRules {
  std::vector<io::Group> groups;                   ///< in addition to those of the sequence; equal names are one group
  std::vector<std::array<std::string, 2>> exempt;  ///< pairs of groups that may touch; a name twice: within the group
  std::vector<std::string> ignore;                 ///< groups that are no part of the check
};

/// A rule that cannot be what the user meant: an unknown or empty group, or an exemption that covers no pair of faces.
class GroupRuleError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

struct ResolvedRules {
  std::vector<Exemption> exemptions;        ///< as GroupRules::exempt
  std::vector<std::uint8_t> is_ignored;     ///< one a face; empty: none is
  std::vector<std::int64_t> ignored_faces;  ///< as GroupRules::ignore; a face of two groups counts in both

  friend bool operator==(const ResolvedRules&, const ResolvedRules&) = default;
};

/// Throws GroupRuleError, naming the groups there are.
[[nodiscard]] ResolvedRules resolve(const GroupRules& rules, std::span<const io::Group> groups, std::size_t face_count);

}  // namespace selvage::verify
