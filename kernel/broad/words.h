// A list of 64-bit words for the broad phase's inner loops: it keeps its memory and does not write before it is told
// to.
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>

namespace selvage {

class Words {
 public:
  Words() = default;
  Words(std::initializer_list<std::uint64_t> words);
  Words(Words&&) noexcept = default;
  Words& operator=(Words&&) noexcept = default;

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::uint64_t* begin() { return data_.get(); }
  [[nodiscard]] std::uint64_t* end() { return data_.get() + size_; }
  [[nodiscard]] const std::uint64_t* begin() const { return data_.get(); }
  [[nodiscard]] const std::uint64_t* end() const { return data_.get() + size_; }

  void clear() { size_ = 0; }
  void assign(std::span<const std::uint64_t> words);
  void push_back(std::uint64_t word);
  /// Where `count` more words can be written; `keep` says how many of them were.
  std::uint64_t* room(std::size_t count);
  void keep(std::size_t count) { size_ += count; }
  template <typename Predicate>
  void erase_if(const Predicate& is_unwanted) {
    size_ = static_cast<std::size_t>(std::remove_if(begin(), end(), is_unwanted) - begin());
  }
  /// Sorts by the high half of the words, which must be distinct. `spare` is overwritten.
  void sort_by_high_half(Words& spare);

 private:
  std::unique_ptr<std::uint64_t[]> data_;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace selvage
