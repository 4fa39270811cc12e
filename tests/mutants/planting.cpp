#include "tests/mutants/planting.h"

#include <map>
#include <stdexcept>

namespace selvage::mutants {
namespace {

/// A place in the text, and what each mutant puts there.
struct Site {
  std::string find;
  std::string mutant;  ///< the first that names it
  std::vector<std::pair<int, std::string>> bad;
};

std::size_t only_place(std::string_view text, const std::string& file, const Mutant& mutant, const std::string& find) {
  const std::size_t place = text.find(find);
  if (place == std::string_view::npos) {
    throw std::runtime_error(mutant.name + ": '" + find + "' does not stand in " + file);
  }
  if (text.find(find, place + 1) != std::string_view::npos) {
    throw std::runtime_error(mutant.name + ": '" + find + "' stands in " + file + " more than once");
  }
  return place;
}

std::string choice(const Site& site) {
  const bool is_statement = site.find.back() == ';';
  std::string text = is_statement ? "" : "(";
  for (const auto& [number, bad] : site.bad) {
    const std::string is_on = "selvage::mutants::planted == " + std::to_string(number);
    text += is_statement ? "if (" + is_on + ") { " + bad + " } else " : "(" + is_on + ") ? (" + bad + ") : ";
  }
  return text + (is_statement ? "{ " + site.find + " }" : "(" + site.find + "))");
}

}  // namespace

std::string plant(std::string_view text, const std::string& file, const std::vector<Mutant>& mutants) {
  std::map<std::size_t, Site> sites;
  for (const Mutant& mutant : mutants) {
    for (const Edit& edit : mutant.edits) {
      if (edit.file != file) continue;
      Site& site = sites[only_place(text, file, mutant, edit.find)];
      if (site.find.empty()) site.find = edit.find, site.mutant = mutant.name;
      if (site.find != edit.find) {
        throw std::runtime_error(site.mutant + " and " + mutant.name + ": different finds start at one place of " +
                                 file);
      }
      site.bad.emplace_back(mutant.number, edit.with);
    }
  }
  std::string planted = "#include \"tests/mutants/planted.h\"\n#line 1 \"" + file + "\"\n";
  std::size_t done = 0;
  const Site* before = nullptr;
  for (const auto& [place, site] : sites) {
    if (place < done) {
      throw std::runtime_error(before->mutant + " and " + site.mutant + ": their finds in " + file + " overlap");
    }
    planted += text.substr(done, place - done);
    planted += choice(site);
    done = place + site.find.size();
    before = &site;
  }
  planted += text.substr(done);
  return planted;
}

}  // namespace selvage::mutants
