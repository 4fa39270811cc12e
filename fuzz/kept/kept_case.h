// A failure as a file that holds all that is needed to see it again (F3), at every level but the query's
// (case_file.h, overlap_case.h):
//   selvage-case 1 step                 format version, kind
//   seed step:soup:1:123                where it came from: property, stream, seed, number
//   failure touches                     the promise that was broken, in a word
//   ...                                 the case itself, as its kind writes it
// Kinds are those that mesh_kind() and byte_kind() of kept_case.cpp list (mesh_case.h, byte_case.h), and drawn
// (drawn_case.h).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/base/case_text.h"

namespace selvage::fuzz {

/// What became of a case when it was run again.
struct Retrial {
  std::string failure;             ///< the broken promise in a word, or empty
  std::vector<std::string> facts;  ///< what happened, a line each
  std::string unfit;               ///< why nothing is promised about this case, or empty; then it was not run
};

class KeptCase {
 public:
  virtual ~KeptCase() = default;

  [[nodiscard]] virtual std::string kind() const = 0;
  [[nodiscard]] virtual std::string promise() const = 0;
  /// The lines of the case itself.
  [[nodiscard]] virtual std::string body() const = 0;
  /// Runs the code under test; what it throws is a failure.
  [[nodiscard]] virtual Retrial retry() const = 0;
};

/// `origin`: PROPERTY:STREAM:SEED:NUMBER, one word. `failure`: the word of the broken promise.
[[nodiscard]] std::string kept_text(const KeptCase& kept, const std::string& origin, const std::string& failure);

/// The origin of a case, in parts.
struct CaseOrigin {
  std::string property, stream;
  std::uint64_t seed = 0;
  std::int64_t number = 0;
};
/// A case that its seed has made again.
struct Redrawn {
  std::string promise;
  std::function<Retrial()> retry;
};
/// Makes a case again, with what no room below the campaigns knows; nothing where no property, or no stream of it, is
/// so called.
using Redraw = std::function<std::optional<Redrawn>(const CaseOrigin&)>;

struct ParsedCase {
  std::string origin, failure;  ///< as the file says
  std::unique_ptr<KeptCase> kept;
};
/// `redraw` makes the cases that are known by their seed alone (fuzz/run/redraw.h). Throws io::Error naming `name` and
/// the line.
[[nodiscard]] ParsedCase parse_kept_case(std::string_view text, const std::string& name, const Redraw& redraw);
/// The kind that the text names, whether or not there is one so called. Throws io::Error where it is no case at all.
[[nodiscard]] std::string kind_of_case(std::string_view text, const std::string& name);

}  // namespace selvage::fuzz
