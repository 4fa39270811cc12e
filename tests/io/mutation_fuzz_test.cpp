// Sound files, mutated at random but deterministically: every parser refuses with io::Error or accepts something sound,
// and never allocates more than a small multiple of the file. SELVAGE_IO_FUZZ_CASES sets the number of inputs a parser
// (default 5000).
#include <cstdlib>
#include <exception>
#include <random>

#include <gtest/gtest.h>

#include "io/error.h"
#include "tests/io/allocations.h"
#include "tests/io/parsers.h"

namespace selvage::io {
namespace {

using testing::Parser;
using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t bound) { return bound == 0 ? 0 : random() % bound; }

/// Texts and numbers at the edges of what parsers expect.
std::string interesting(Random& random) {
  static const std::vector<std::string> kTexts = {"-1",
                                                  "0",
                                                  "1",
                                                  "2",
                                                  "3",
                                                  "4",
                                                  "255",
                                                  "256",
                                                  "2147483647",
                                                  "2147483648",
                                                  "4294967295",
                                                  "4294967296",
                                                  "99999999999999999999",
                                                  "-99999999999999999999",
                                                  "1e999",
                                                  "1e-999",
                                                  "nan",
                                                  "-inf",
                                                  "0x1p3",
                                                  "+",
                                                  "-",
                                                  "/",
                                                  "//",
                                                  "\n",
                                                  "\r\n",
                                                  "\\\n",
                                                  " ",
                                                  "\t",
                                                  ",",
                                                  "..",
                                                  "../x",
                                                  "\"",
                                                  "{",
                                                  "}",
                                                  "[",
                                                  "[[[[[[[[",
                                                  "null",
                                                  "true",
                                                  "1e308",
                                                  std::string(1, '\0'),
                                                  "\xff",
                                                  "\xc3\x28",
                                                  "PK\x01\x02",
                                                  "PK\x05\x06",
                                                  "end_header\n",
                                                  "element face 4000000000\n",
                                                  "property list char int vertex_indices\n",
                                                  "(1, 3)",
                                                  "(0,)",
                                                  "True ",
                                                  ">f8",
                                                  "<i8",
                                                  "v",
                                                  "f",
                                                  "g\n"};
  if (random() % 2 == 0) return kTexts[below(random, kTexts.size())];
  static const std::uint64_t kNumbers[] = {0,
                                           1,
                                           0x7f,
                                           0x80,
                                           0xff,
                                           0x7fff,
                                           0xffff,
                                           0x7fffffff,
                                           0x80000000,
                                           0xffffffff,
                                           0x7f800000,
                                           ~std::uint64_t{0},
                                           0x7ff0000000000000};
  const std::uint64_t number = kNumbers[below(random, std::size(kNumbers))];
  const std::size_t size = std::size_t{1} << below(random, 4);
  std::string bytes;
  for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(number >> 8 * i & 0xff);
  return bytes;
}

void mutate(std::string& bytes, const Parser& parser, Random& random) {
  const std::size_t at = below(random, bytes.size() + 1);
  const std::size_t length = std::min(bytes.size() - at, std::size_t{1} << below(random, 6));
  switch (random() % 9) {
    case 0:
      if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
      return;
    case 1:
      if (at < bytes.size()) bytes[at] = static_cast<char>(random());
      return;
    case 2:
      bytes.erase(at, length);
      return;
    case 3:
      bytes.insert(below(random, bytes.size() + 1), bytes.substr(at, length));
      return;
    case 4:
      bytes.resize(at);
      return;
    case 5:
      bytes.insert(at, interesting(random));
      return;
    case 6: {
      const std::string text = interesting(random);
      bytes.replace(at, std::min(text.size(), bytes.size() - at), text);
      return;
    }
    case 7: {  // a decimal number becomes another
      const std::size_t begin = bytes.find_first_of("0123456789", at);
      if (begin == bytes.npos) return;
      const std::size_t end = std::min(bytes.find_first_not_of("0123456789", begin), bytes.size());
      bytes.replace(begin, end - begin, interesting(random));
      return;
    }
    default: {
      const std::string& other = parser.sound_files[below(random, parser.sound_files.size())];
      bytes = bytes.substr(0, at) + other.substr(below(random, other.size()));
      return;
    }
  }
}

class MutationFuzz : public ::testing::TestWithParam<std::string> {};

TEST_P(MutationFuzz, RefusesOrAcceptsWhatIsSound) {
  const Parser& parser = testing::parser_named(GetParam());
  const char* named = std::getenv("SELVAGE_IO_FUZZ_CASES");
  const long cases = named != nullptr ? std::strtol(named, nullptr, 10) : 5'000;
  for (const std::string& file : parser.sound_files) ASSERT_NO_THROW(parser.parse(file));
  Random random(20020721);
  long accepted = 0;
  for (long i = 0; i < cases; ++i) {
    std::string bytes = parser.sound_files[below(random, parser.sound_files.size())];
    const std::size_t mutations = 1 + below(random, 4);
    for (std::size_t k = 0; k < mutations; ++k) mutate(bytes, parser, random);
    std::exception_ptr failure;
    const std::size_t used = testing::peak_during([&] {
      try {
        parser.parse(bytes);
      } catch (...) {
        failure = std::current_exception();
      }
    });
    ASSERT_LE(used, testing::kMaxMemory * bytes.size() + testing::kMemoryConstant) << "case " << i;
    try {
      if (failure) std::rethrow_exception(failure);
      ++accepted;
    } catch (const Error& error) {
      ASSERT_EQ(error.kind(), ErrorKind::kBadInput) << error.what();
      ASSERT_EQ(std::string_view(error.what()).substr(0, 2), "in") << error.what();
      ASSERT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
    } catch (const std::exception& error) {
      FAIL() << "case " << i << ": " << error.what() << "\ninput: " << ::testing::PrintToString(bytes);
    }
  }
  RecordProperty("accepted", std::to_string(accepted));
  EXPECT_GT(accepted, cases / 100) << "the mutants hardly get past the first check";
  EXPECT_LT(accepted, cases * 9 / 10) << "the mutants are hardly wrong";
}

std::vector<std::string> parser_names() {
  std::vector<std::string> names;
  for (const Parser& parser : testing::all_parsers()) names.emplace_back(parser.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, MutationFuzz, ::testing::ValuesIn(parser_names()),
                         [](const auto& of) { return of.param; });

}  // namespace
}  // namespace selvage::io
