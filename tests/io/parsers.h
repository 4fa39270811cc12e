// Every parser of the room behind one face, with sound files to start from and the invariants of what it accepts.
#pragma once

#include <string>
#include <vector>

namespace selvage::testing {

struct Parser {
  const char* name;
  /// Parses bytes from memory; errors name the file "in". What is accepted is checked: indices in range, corners
  /// distinct, coordinates finite, groups within the faces. A broken invariant throws std::logic_error.
  void (*parse)(const std::string& bytes);
  std::vector<std::string> sound_files;
};

[[nodiscard]] const std::vector<Parser>& all_parsers();
/// The one of this name; throws std::logic_error.
[[nodiscard]] const Parser& parser_named(const std::string& name);

}  // namespace selvage::testing
