// plant_mutants LISTS SOURCE OUTPUT FILE...: writes OUTPUT/FILE, the planted copy of SOURCE/FILE, for each file.
#include <cstdio>
#include <exception>
#include <fstream>
#include <span>

#include "tests/mutants/planting.h"

namespace {

void write_copies(const std::filesystem::path& lists, const std::filesystem::path& source,
                  const std::filesystem::path& output, std::span<char*> files) {
  const auto mutants = selvage::mutants::read_lists(lists);
  for (const std::string file : files) {
    const std::string planted = selvage::mutants::plant(selvage::mutants::read_text(source / file), file, mutants);
    std::filesystem::create_directories((output / file).parent_path());
    std::ofstream out(output / file, std::ios::binary);
    out << planted;
    out.close();
    if (!out) throw std::runtime_error((output / file).string() + ": cannot be written");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fputs("usage: plant_mutants LISTS SOURCE OUTPUT FILE...\n", stderr);
    return 2;
  }
  try {
    write_copies(argv[1], argv[2], argv[3], std::span(argv + 4, argv + argc));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "plant_mutants: %s\n", error.what());
    return 1;
  }
  return 0;
}
