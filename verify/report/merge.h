// One report from those of all parts of a sequence.
#pragma once

#include <stdexcept>
#include <vector>

#include "verify/report/report.h"

namespace selvage::verify {

struct Part {
  std::string name;  ///< for errors: the file
  ParsedReport parsed;
};

/// The parts do not make up one check of one sequence.
class MergeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What one run over the whole sequence would have reported; seconds add up. Throws MergeError where frames are missing
/// or covered twice, where program, options or sequence differ, or where a frame changed between two parts.
[[nodiscard]] ParsedReport merge(std::vector<Part> parts);

}  // namespace selvage::verify
