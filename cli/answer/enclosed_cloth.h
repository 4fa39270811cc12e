// Cloth that is wholly inside a body: it meets nothing, so nothing else says so.
#pragma once

#include <string>
#include <vector>

#include "io/mesh_data.h"
#include "io/sequence.h"
#include "kernel/mesh.h"

namespace selvage::cli {

struct EnclosedCloth {
  std::string cloth, body;  ///< names, quoted; of a cloth of many connected parts with how many are inside
  friend bool operator==(const EnclosedCloth&, const EnclosedCloth&) = default;
};

/// For each cloth and each closed body with a connected part of the cloth inside a connected part of the body; decided
/// exactly. A part of a body is closed where an even number of its faces hold each edge. O(#F), and the faces of a
/// body's part once for each part of cloth whose box is in its: 11 ms beside the 615 ms of a start of 180,000 faces
/// inside a body of 330,000, 0.1 beside 10 ms where no box is in another. REQUIRES that no cloth meets a body.
[[nodiscard]] std::vector<EnclosedCloth> find_enclosed(const Mesh& mesh, const std::vector<io::Group>& groups,
                                                       const io::Points& points);

/// A sentence for each that is inside in frame `first`, and for each that is in one of `first` and `last` alone. Reads
/// both frames. REQUIRES frames without violations.
[[nodiscard]] std::vector<std::string> notes_on_enclosed(const io::SequenceReader& sequence, std::size_t first,
                                                         std::size_t last);

}  // namespace selvage::cli
