// A case that is a text or a few bytes: a damaged file, or a scene that is simulated.
//   format obj                          the kind's key, and its value
//   | v 0 0 0\n                         the bytes, in pieces; \n, \\ and \xHH are as in C
//   | f 1 2 3\n
#pragma once

#include "fuzz/kept/kept_case.h"

namespace selvage::fuzz {

struct ByteCase;

struct ByteKind {
  std::string_view name, promise;
  std::string_view key;  ///< what is to be known besides the bytes
  bool (*is_value)(const std::string&) = nullptr;
  Retrial (*retry)(const ByteCase&) = nullptr;
};

struct ByteCase {
  const ByteKind* kind = nullptr;
  std::string value, bytes;
};

/// kind->retry(), where what is thrown is the failure kThrew.
[[nodiscard]] Retrial retry(const ByteCase& kept);

class KeptBytes final : public KeptCase {
 public:
  explicit KeptBytes(ByteCase kept) : kept_(std::move(kept)) {}
  [[nodiscard]] std::string kind() const override { return std::string(kept_.kind->name); }
  [[nodiscard]] std::string promise() const override { return std::string(kept_.kind->promise); }
  [[nodiscard]] std::string body() const override;
  [[nodiscard]] Retrial retry() const override { return fuzz::retry(kept_); }
  [[nodiscard]] const ByteCase& bytes() const { return kept_; }

 private:
  ByteCase kept_;
};

/// The lines of a case of this kind, up to the end of the text. Throws io::Error.
[[nodiscard]] ByteCase parse_byte_case(const ByteKind& kind, CaseLines& lines);

}  // namespace selvage::fuzz
