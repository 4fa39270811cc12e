// A case that is a mesh at a few instants and some numbers, which is all that the code under test takes: mesh_kind() of
// kept_case.cpp lists the kinds. What a kind adds is a table and a judge; text and shrinking are written once.
//   set thickness_m 0x1p-3              each of the kind's settings, in its order
//   vertices 6
//   v 0 0 0  0 0 1  0x1p+0 -1           a vertex: its place at each of the kind's instants, then its marks
//   ...
//   faces 2
//   f 0 1 2
//   ...
#pragma once

#include <array>
#include <cstdint>

#include "fuzz/kept/kept_case.h"
#include "kernel/types.h"

namespace selvage::fuzz {

/// A number that belongs to a case or to each of its vertices.
struct MeshNumber {
  std::string_view name;
  double simplest = 0;  ///< what shrinking tries first
  double lowest = 0, highest = 0;
  bool is_integer = false;
};

struct MeshCase;

struct MeshKind {
  std::string_view name, promise;
  std::vector<std::string_view> instants;
  int last_finite = 0;  ///< instants behind this one may hold what is no number
  std::vector<MeshNumber> settings, marks;
  /// REQUIRES that it is of this kind.
  Retrial (*retry)(const MeshCase&) = nullptr;
};

struct MeshCase {
  const MeshKind* kind = nullptr;
  std::vector<double> settings;            ///< as kind->settings
  std::vector<Positions> x;                ///< of each instant, #V by 3
  std::vector<std::vector<double>> marks;  ///< of each of kind->marks, #V
  std::vector<std::array<std::int32_t, 3>> faces;

  [[nodiscard]] std::size_t vertex_count() const { return static_cast<std::size_t>(x.front().rows()); }
  /// REQUIRES that the kind has it.
  [[nodiscard]] double setting(std::string_view name) const;
};

/// kind->retry(), where what is thrown is the failure kThrew.
[[nodiscard]] Retrial retry(const MeshCase& kept);

class KeptMesh final : public KeptCase {
 public:
  explicit KeptMesh(MeshCase mesh) : mesh_(std::move(mesh)) {}
  [[nodiscard]] std::string kind() const override { return std::string(mesh_.kind->name); }
  [[nodiscard]] std::string promise() const override { return std::string(mesh_.kind->promise); }
  [[nodiscard]] std::string body() const override;
  [[nodiscard]] Retrial retry() const override;
  [[nodiscard]] const MeshCase& mesh() const { return mesh_; }

 private:
  MeshCase mesh_;
};

/// The lines of a case of this kind, up to the end of the text. Throws io::Error.
[[nodiscard]] MeshCase parse_mesh_case(const MeshKind& kind, CaseLines& lines);

}  // namespace selvage::fuzz
