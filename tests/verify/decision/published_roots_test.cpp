// The exact times of impact that were published for one set of queries: each is the k-th real root of a cubic, in
// Mathematica's WXF, packed as tar.gz. (WXF: reference.wolfram.com, "WXF Format Description".)
#include <algorithm>
#include <charconv>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmpxx.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "io/query_csv.h"
#include "tests/public_data.h"
#include "verify/decision/exact_motion.h"

namespace selvage::verify {
namespace {

using Polynomial = std::vector<mpq_class>;  ///< coefficients, of the constant first; the last is not zero

/// The real root of the polynomial with this number, counted from 1 in ascending order.
struct PublishedRoot {
  Polynomial polynomial;
  std::size_t number = 0;
};

/// The members of a packed archive, by name.
std::map<std::string, std::string> read_tar_gz(const std::string& file) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> in(gzopen(file.c_str(), "rb"), gzclose);
  if (!in) throw std::runtime_error(file + ": cannot open");
  constexpr unsigned kBlock = 512, kSizeAt = 124, kSizeLength = 11;
  std::map<std::string, std::string> members;
  std::array<char, kBlock> header{};
  while (gzread(in.get(), header.data(), kBlock) == static_cast<int>(kBlock) && header[0] != 0) {
    std::size_t size = 0;
    std::from_chars(&header[kSizeAt], &header[kSizeAt + kSizeLength], size, 8);
    std::string content((size + kBlock - 1) / kBlock * kBlock, '\0');
    if (gzread(in.get(), content.data(), static_cast<unsigned>(content.size())) != static_cast<int>(content.size())) {
      throw std::runtime_error(file + ": cut short");
    }
    content.resize(size);
    members[header.data()] = std::move(content);
  }
  return members;
}

/// All integers of an expression in the order of the bytes, each with the symbol or string that was last before it.
std::vector<std::pair<std::string, mpz_class>> integers_of(const std::string& wxf) {
  if (!wxf.starts_with("8:")) throw std::runtime_error("not WXF");
  std::vector<std::pair<std::string, mpz_class>> integers;
  std::string last;
  std::size_t at = 2;
  const auto byte = [&] { return static_cast<unsigned char>(wxf.at(at++)); };
  const auto length = [&] {
    std::size_t value = 0;
    for (unsigned shift = 0;; shift += 7) {
      const unsigned char b = byte();
      value |= static_cast<std::size_t>(b & 0x7fU) << shift;
      if (b < 0x80) return value;
    }
  };
  const auto text = [&](std::size_t count) {
    at += count;
    return wxf.substr(at - count, count);
  };
  while (at < wxf.size()) {
    switch (byte()) {
      case 'f':
        (void)length();
        break;  // an expression with so many arguments: its head comes next
      case 's':
      case 'S':
        last = text(length());
        break;
      case 'I':
        integers.emplace_back(last, mpz_class(text(length())));
        break;
      case 'C':
        integers.emplace_back(last, static_cast<signed char>(byte()));
        break;
      default:
        throw std::runtime_error("WXF: a kind of token that these files do not hold");
    }
  }
  return integers;
}

/// Every  t -> Root[Function[Plus[c0, Times[c1, Slot[1]], ...]], number, 0]  of the file.
std::vector<PublishedRoot> roots_of(const std::string& wxf) {
  const auto integers = integers_of(wxf);
  std::vector<PublishedRoot> roots;
  for (std::size_t i = 0; i + 11 <= integers.size(); ++i) {
    // c0; c1, slot; c2, slot, 2; c3, slot, 3, number, 0
    if (integers[i].first != "Plus" || integers[i + 1].first != "Times" || integers[i + 2].first != "Slot" ||
        integers[i + 2].second != 1 || integers[i + 5].second != 2 || integers[i + 8].second != 3) {
      continue;
    }
    const auto c = [&](std::size_t offset) { return mpq_class(integers[i + offset].second); };
    roots.push_back({{c(0), c(1), c(3), c(6)}, integers[i + 9].second.get_ui()});
  }
  return roots;
}

mpq_class value(const Polynomial& p, const mpq_class& x) {
  mpq_class sum = 0;
  for (auto c = p.rbegin(); c != p.rend(); ++c) sum = sum * x + *c;
  return sum;
}

/// Sturm's chain; REQUIRES a polynomial that is not constant.
std::vector<Polynomial> sturm_chain(const Polynomial& p) {
  Polynomial derivative;
  for (std::size_t i = 1; i < p.size(); ++i) derivative.push_back(static_cast<unsigned long>(i) * p[i]);
  std::vector<Polynomial> chain = {p, derivative};
  while (true) {
    Polynomial rest = chain[chain.size() - 2];
    const Polynomial& divisor = chain.back();
    while (rest.size() >= divisor.size()) {
      const mpq_class factor = rest.back() / divisor.back();
      const std::size_t shift = rest.size() - divisor.size();
      for (std::size_t i = 0; i < divisor.size(); ++i) rest[shift + i] -= factor * divisor[i];
      while (!rest.empty() && rest.back() == 0) rest.pop_back();
    }
    if (rest.empty()) return chain;
    for (mpq_class& c : rest) c = -c;
    chain.push_back(std::move(rest));
  }
}

/// How many different real roots are at most x.
std::size_t roots_up_to(const Polynomial& p, const mpq_class& x) {
  const auto changes = [](const std::vector<int>& signs) {
    std::size_t count = 0;
    int last = 0;
    for (const int sign : signs) {
      if (sign * last < 0) ++count;
      if (sign != 0) last = sign;
    }
    return count;
  };
  std::vector<int> far, here;
  for (const Polynomial& member : sturm_chain(p)) {
    far.push_back(sgn(member.back()) * (member.size() % 2 == 0 ? -1 : 1));
    here.push_back(sgn(value(member, x)));
  }
  return changes(far) - changes(here);
}

}  // namespace

TEST(PublishedRoots, TheFirstTouchIsTheEarliestPublishedRoot) {
  const auto data = testing::public_data();
  if (!data) GTEST_SKIP() << "public data not found: set SELVAGE_DATA";
  const auto folder = *data / "ccd/scalable-ccd/rod-twist";
  if (!std::filesystem::is_directory(folder / "roots")) GTEST_SKIP() << "no roots in " << folder;
  const auto queries = io::read_query_csv(folder / "queries/3036vf.csv");
  const auto members = read_tar_gz(folder / "roots/3036vf_roots.tar.gz");
  std::ptrdiff_t touching = 0;
  for (std::size_t id = 0; id < queries.size(); ++id) {
    std::array<Point, 4> x_t0{}, x_t1{};
    std::copy_n(queries[id].points.begin(), 4, x_t0.begin());
    std::copy_n(queries[id].points.begin() + 4, 4, x_t1.begin());
    const MotionAnswer answer = exact_vf_motion(x_t0, x_t1, Detail::kFirstTime);
    const auto member = members.find("3036vf_q" + std::to_string(id) + "_roots.wxf");
    ASSERT_EQ(answer.touches, member != members.end()) << "query " << id;
    if (!answer.touches) continue;
    ++touching;
    const mpq_class lower(answer.first.lower), upper(answer.first.upper);
    const auto roots = roots_of(member->second);
    ASSERT_FALSE(roots.empty()) << "query " << id;
    bool is_published = false;
    for (const PublishedRoot& root : roots) {
      // The first touch is in the open interval, or is both its ends.
      const bool is_lower_a_root = value(root.polynomial, lower) == 0;
      const std::size_t before = roots_up_to(root.polynomial, lower) - (is_lower_a_root ? 1 : 0);
      EXPECT_LT(before, root.number) << "query " << id << ": a published touch is earlier";
      is_published = is_published || (before < root.number && roots_up_to(root.polynomial, upper) >= root.number);
    }
    EXPECT_TRUE(is_published) << "query " << id << ": no published root from " << answer.first.lower << " to "
                              << answer.first.upper;
  }
  EXPECT_EQ(touching, std::ranges::count_if(members, [](const auto& m) { return m.first.ends_with(".wxf"); }));
  EXPECT_EQ(touching, 765);
}

}  // namespace selvage::verify
