// Planted defects as data: lists/*.mutants, one after another
//   mutant MS5 the repulsion pulls          a name, then the defect in words
//   breaks S3                               the promise
//   killer step within 400                  the property that finds it, in so many cases under every seed
//   in sim/response/impulse.cpp                      a source, below the root of the tree
//   find std::max(-displacement, 0.0)       text that stands there exactly once
//   with std::max(displacement, 0.0)        what stands there instead when the mutant is on
// More finds, each with its replacement, and more files may follow. A find that ends in ';' is one or more statements,
// any other an expression. Lines `equivalent` give a proof that no property can find it: then its killer must not.
// '#' starts a comment line.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace selvage::mutants {

/// One place in one source.
struct Edit {
  std::string file, find, with;
};

struct Mutant {
  int number = 0;  ///< what `planted` is set to: 1, 2, ... over all lists
  std::string name, defect, promise;
  std::string killer;      ///< a property
  std::string equivalent;  ///< why no property can find it, if so; then `killer` is one that tries
  long within = 0;         ///< cases
  std::vector<Edit> edits;
};

/// Appends the mutants of one list. Throws std::runtime_error naming `name` and the line.
void append_list(std::string_view text, const std::string& name, std::vector<Mutant>& mutants);
/// All *.mutants files of a folder, in the order of their names. Throws std::runtime_error where one is unreadable or
/// there is none.
[[nodiscard]] std::vector<Mutant> read_lists(const std::filesystem::path& folder);
[[nodiscard]] std::string read_text(const std::filesystem::path& file);

}  // namespace selvage::mutants
