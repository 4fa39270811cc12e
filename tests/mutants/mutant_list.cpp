#include "tests/mutants/mutant_list.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

namespace selvage::mutants {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Cuts the first word off.
std::string_view take_word(std::string_view& text) {
  const std::string_view word = text.substr(0, text.find(' '));
  text = trimmed(text.substr(word.size()));
  return word;
}

class Parser {
 public:
  Parser(const std::string& name, std::vector<Mutant>& mutants) : name_(name), mutants_(mutants) {
    for (const Mutant& mutant : mutants) names_.insert(mutant.name);
  }

  void take(std::string_view line) {
    ++line_;
    line = trimmed(line);
    if (line.empty() || line.front() == '#') return;
    const std::string_view key = take_word(line);
    if (key == "mutant") return begin(line);
    if (!has_one_) fail("expected 'mutant'");
    Mutant& mutant = mutants_.back();
    if (key == "breaks") {
      mutant.promise = line;
    } else if (key == "killer") {
      set_killer(mutant, line);
    } else if (key == "equivalent") {
      mutant.equivalent += (mutant.equivalent.empty() ? "" : " ") + std::string(line);
    } else if (key == "in") {
      file_ = line;
    } else if (key == "find") {
      if (file_.empty()) fail("'find' without 'in'");
      if (expects_with_) fail("'find' without 'with' before it");
      if (line.empty()) fail("'find' what?");
      mutant.edits.push_back({file_, std::string(line), ""});
      expects_with_ = true;
    } else if (key == "with") {
      if (!expects_with_) fail("'with' without 'find'");
      mutant.edits.back().with = line;
      expects_with_ = false;
    } else {
      fail("unknown word '" + std::string(key) + "'");
    }
  }

  /// At the end of a mutant.
  void finish() {
    if (!has_one_) return;
    const Mutant& mutant = mutants_.back();
    if (mutant.promise.empty()) fail(mutant.name + " breaks no promise");
    if (mutant.killer.empty()) fail(mutant.name + " has no killer");
    if (mutant.edits.empty() || expects_with_) fail(mutant.name + " is not finished");
  }

 private:
  void begin(std::string_view line) {
    finish();
    has_one_ = true;
    file_.clear();
    Mutant mutant;
    mutant.number = static_cast<int>(mutants_.size()) + 1;
    mutant.name = take_word(line);
    mutant.defect = line;
    if (mutant.name.empty() || mutant.defect.empty()) fail("a mutant needs a name and a defect");
    if (!names_.insert(mutant.name).second) fail("there are two mutants " + mutant.name);
    mutants_.push_back(std::move(mutant));
  }

  void set_killer(Mutant& mutant, std::string_view line) {
    mutant.killer = take_word(line);
    const bool has_within = take_word(line) == "within";
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), mutant.within);
    if (!has_within || error != std::errc() || end != line.data() + line.size() || mutant.within < 1) {
      fail("expected 'killer PROPERTY within CASES'");
    }
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(name_ + ":" + std::to_string(line_) + ": " + what);
  }

  const std::string& name_;
  std::vector<Mutant>& mutants_;
  std::set<std::string> names_;
  int line_ = 0;
  bool has_one_ = false, expects_with_ = false;
  std::string file_;
};

}  // namespace

void append_list(std::string_view text, const std::string& name, std::vector<Mutant>& mutants) {
  Parser parser(name, mutants);
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    parser.take(line);
    text.remove_prefix(std::min(text.size(), line.size() + 1));
  }
  parser.finish();
}

std::vector<Mutant> read_lists(const std::filesystem::path& folder) {
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".mutants") files.insert(entry.path());
  }
  if (files.empty()) throw std::runtime_error(folder.string() + ": no *.mutants");
  std::vector<Mutant> mutants;
  for (const auto& file : files) append_list(read_text(file), file.filename().string(), mutants);
  return mutants;
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in || text.str().empty()) throw std::runtime_error(file.string() + ": cannot be read, or is empty");
  return text.str();
}

}  // namespace selvage::mutants
