#include "fuzz/shrink/shrink_bytes.h"

#include <algorithm>
#include <cctype>
#include <vector>

namespace selvage::fuzz {
namespace {

/// Lines with their ends.
std::vector<std::string> lines_of(const std::string& bytes) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', begin), bytes.size() - 1) + 1;
    lines.push_back(bytes.substr(begin, end - begin));
    begin = end;
  }
  return lines;
}

std::vector<std::string> characters_of(const std::string& bytes) {
  std::vector<std::string> all;
  for (const char c : bytes) all.emplace_back(1, c);
  return all;
}

class ByteShrinker {
 public:
  ByteShrinker(const ByteCase& kept, const std::string& failure, std::int64_t max_trials)
      : best_(kept), failure_(failure), left_(max_trials) {}

  ByteCase run() {
    bool progress = true;
    while (progress && left_ > 0) {
      const std::size_t before = best_.bytes.size();
      leave_out(lines_of(best_.bytes));
      numbers();
      leave_out(characters_of(best_.bytes));
      progress = best_.bytes.size() < before;
    }
    return best_;
  }

 private:
  bool offer(const std::string& bytes) {
    if (bytes.size() >= best_.bytes.size() || left_ <= 0) return false;
    --left_;
    ByteCase simpler = best_;
    simpler.bytes = bytes;
    const Retrial retrial = retry(simpler);
    if (!retrial.unfit.empty() || retrial.failure != failure_) return false;
    best_ = std::move(simpler);
    return true;
  }

  void leave_out(std::vector<std::string> pieces) {
    for (std::size_t length = pieces.size(); length > 0; length /= 2) {
      for (std::size_t end = pieces.size(); end >= length; --end) {
        if (end > pieces.size()) continue;
        std::vector<std::string> fewer = pieces;
        const auto last = fewer.begin() + static_cast<std::ptrdiff_t>(end);
        fewer.erase(last - static_cast<std::ptrdiff_t>(length), last);
        std::string bytes;
        for (const std::string& piece : fewer) bytes += piece;
        if (offer(bytes)) pieces = std::move(fewer);
      }
    }
  }

  /// Digits are cut off behind the point, and before it.
  void numbers() {
    const auto is_digit = [this](std::size_t i) {
      return i < best_.bytes.size() && std::isdigit(static_cast<unsigned char>(best_.bytes[i])) != 0;
    };
    for (std::size_t begin = 0; begin < best_.bytes.size(); ++begin) {
      if (!is_digit(begin)) continue;
      std::size_t end = begin;
      while (is_digit(end)) ++end;
      for (std::size_t length = 1; begin + length < end; ++length) {
        if (offer(best_.bytes.substr(0, begin + length) + best_.bytes.substr(end))) break;
      }
      while (is_digit(begin + 1)) ++begin;
    }
  }

  ByteCase best_;
  const std::string& failure_;
  std::int64_t left_;
};

}  // namespace

ByteCase shrink(const ByteCase& kept, const std::string& failure, std::int64_t max_trials) {
  return ByteShrinker(kept, failure, max_trials).run();
}

}  // namespace selvage::fuzz
