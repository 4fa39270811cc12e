#include "bench/pair_labels.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "io/fail.h"
#include "io/file/atomic_file.h"
#include "io/file/json_values.h"

namespace selvage::bench {
namespace {

template <typename List>
List read_list(const std::filesystem::path& file, const char* what) {
  const std::string text = io::read_file(file);
  try {
    if (io::find_zero_byte(text) == text.npos) return nlohmann::json::parse(text).get<List>();
  } catch (const nlohmann::json::exception&) {  // said below
  }
  io::bad_input(file.string(), std::string("not a JSON list of ") + what + "; correct it");
}

LabelledPair pair_of(std::int64_t id, std::int64_t other, const Mesh& mesh, const std::string& name) {
  const std::int64_t first_edge = mesh.vertex_count;
  const std::int64_t first_face = first_edge + static_cast<std::int64_t>(mesh.edges.size());
  const std::int64_t end = first_face + static_cast<std::int64_t>(mesh.faces.size());
  const auto [low, high] = std::minmax(id, other);
  const auto number = [](std::int64_t i) { return static_cast<std::int32_t>(i); };
  if (low >= 0 && low < first_edge && high >= first_face && high < end) {
    return {PairKind::kVf, number(low), number(high - first_face), false};
  }
  if (low >= first_edge && low < high && high < first_face) {
    return {PairKind::kEe, number(low - first_edge), number(high - first_edge), false};
  }
  io::bad_input(name, "ids " + std::to_string(id) + ", " + std::to_string(other) +
                          " are no vertex and face nor two edges of this mesh; use the lists of these frames");
}

}  // namespace

std::vector<LabelledPair> read_pair_labels(const std::filesystem::path& boxes, const std::filesystem::path& verdicts,
                                           const Mesh& mesh) {
  const auto pairs = read_list<std::vector<std::array<std::int64_t, 2>>>(boxes, "pairs of ids");
  const auto touches = read_list<std::vector<bool>>(verdicts, "verdicts (true or false)");
  if (pairs.size() != touches.size()) {
    io::bad_input(verdicts.string(), std::to_string(touches.size()) + " verdicts for " + std::to_string(pairs.size()) +
                                         " pairs; use the file that belongs to " + boxes.string());
  }
  std::vector<LabelledPair> labels;
  labels.reserve(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    labels.push_back(pair_of(pairs[i][0], pairs[i][1], mesh, boxes.string()));
    labels.back().touches = touches[i];
  }
  return labels;
}

}  // namespace selvage::bench
