// Published lists of pairs with their exact verdicts (Sample-Scalable-CCD-Data): `boxes` names pairs, `mma_bool` says
// which of them touch.
#pragma once

#include <filesystem>
#include <vector>

#include "kernel/candidates.h"

namespace selvage::bench {

struct LabelledPair {
  PairKind kind = PairKind::kVf;
  std::int32_t first = 0, second = 0;  ///< vertex, face | edge, edge with first < second
  bool touches = false;
};

/// Ids are vertex v -> v, edge e -> #V + e, face f -> #V + #E + f, with the mesh's own numbering of edges. Throws
/// io::Error: unreadable, no such lists, lists of different lengths, ids outside the mesh or no vf or ee pair.
[[nodiscard]] std::vector<LabelledPair> read_pair_labels(const std::filesystem::path& boxes,
                                                         const std::filesystem::path& verdicts, const Mesh& mesh);

}  // namespace selvage::bench
