// Pairs of faces that may touch because the user says so ("sewn together"), and what that means for edges and vertices.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace selvage::verify {

/// Faces [begin, end).
struct FaceRange {
  std::int32_t begin = 0, end = 0;
  friend bool operator==(const FaceRange&, const FaceRange&) = default;
};
using FaceSet = std::vector<FaceRange>;

/// Pairs of faces, one in `a` and the other in `b`, are not checked. `a` and `b` may be the same or overlap.
struct Exemption {
  FaceSet a, b;
  friend bool operator==(const Exemption&, const Exemption&) = default;
};

/// What an element is held by, as far as exemptions can tell: a small number.
using Label = std::int32_t;
inline constexpr Label kNoLabel = 0;  ///< held by no face

/// A pair of elements is exempt only if every pair of faces that hold them is exempt or, where bodies are not checked,
/// of two bodies. So whatever two faces are still owed a check, all their vertices and edges are; and where none are,
/// no pair of elements is.
class ExemptionTable {
 public:
  ExemptionTable() = default;
  /// REQUIRES ranges within [0, face_count], and `is_body` empty (no face is) or one flag a face.
  ExemptionTable(std::span<const Exemption> exemptions, std::span<const std::uint8_t> is_body, std::size_t face_count);

  [[nodiscard]] bool empty() const { return rule_count_ == 0; }
  /// The label of each face.
  [[nodiscard]] const std::vector<Label>& face_labels() const { return face_labels_; }
  /// The label of what is held by all that `x` and `y` stand for. Throws std::invalid_argument above kMaxLabels.
  [[nodiscard]] Label unite(Label x, Label y);
  /// To be called once after the last unite() and before exemption().
  void close();

  /// The first exemption that a pair of elements falls under, -1 where it falls under none: then it is to be checked,
  /// unless only bodies hold both and bodies are not.
  [[nodiscard]] std::int32_t exemption(Label x, Label y, bool check_bodies) const {
    return tables_[check_bodies ? 1 : 0][static_cast<std::size_t>(x) * members_.size() + static_cast<std::size_t>(y)];
  }

  /// A label is a row of two square tables: 16 MiB of each. Groups would have to meet in thousands of ways to reach
  /// this.
  static constexpr std::size_t kMaxLabels = 2048;

 private:
  Label label_of(std::vector<std::int32_t> classes);
  [[nodiscard]] std::vector<std::int32_t> table(bool check_bodies) const;

  std::size_t rule_count_ = 0;
  std::vector<std::vector<std::uint8_t>> in_a_, in_b_;  // by class of faces, then by exemption
  std::vector<std::uint8_t> is_body_;                   // by class of faces
  std::vector<Label> face_labels_;
  std::vector<std::vector<std::int32_t>> members_;  // of each label: classes of faces, ascending
  std::map<std::vector<std::int32_t>, Label> labels_;
  std::map<std::pair<Label, Label>, Label> unions_;
  std::array<std::vector<std::int32_t>, 2> tables_;  // without bodies, and with them
};

}  // namespace selvage::verify
