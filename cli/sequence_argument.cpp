#include "cli/sequence_argument.h"

#include "cli/exit_code.h"
#include "io/point_cache.h"

namespace selvage::cli {

void add_sequence_argument(CLI::App& command, SequenceArgument& argument) {
  command
      .add_option("SEQUENCE", argument.sources,
                  "A sequence folder, an .npz file, a .pc2 or .mdd cache, or mesh files in order")
      ->required();
  command
      .add_option("--base", argument.base,
                  "The mesh that a .pc2 or .mdd moves (default: the .obj or .ply of the same name beside it)")
      ->type_name("MESH");
}

std::unique_ptr<io::SequenceReader> open_sequence(const SequenceArgument& argument) {
  if (!argument.base.empty() && !io::is_point_cache(argument.sources.front())) {
    throw UsageError("--base is for a .pc2 or .mdd; " + argument.sources.front().string() + " has faces of its own");
  }
  return io::open_sequence(argument.sources, argument.base);
}

}  // namespace selvage::cli
