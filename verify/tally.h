// Counting in parallel with the same result for any number of threads: every chunk of work counts for itself, and the
// counts are added in order.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>
#include <vector>

#include "verify/arithmetic/fp_guard.h"
#include "verify/check.h"
#include "verify/search/own_tasks.h"

namespace selvage::verify {

/// A violation before its details are worked out. `kind` is a literal.
struct Hit {
  EventKind event;
  std::array<std::int32_t, 2> features;
  const char* kind;

  friend bool operator<(const Hit& x, const Hit& y) {
    return std::tie(x.event, x.features) < std::tie(y.event, y.features);
  }
};

/// How many hits the parts of some work have found so far, where the first `enough` in its order are all that is asked
/// for: a part ends when it and those before it have as many. What it has not found then is behind these, so they are
/// the same for any number of threads; and with several it takes hardly longer than with one.
class EnoughHits {
 public:
  struct Reached {};

  EnoughHits(std::size_t enough, std::size_t parts) : enough_(enough), found_(parts) {}

  [[nodiscard]] bool is_reached(std::size_t part) const {
    std::size_t sum = 0;
    for (std::size_t i = 0; i <= part && sum < enough_; ++i) sum += found_[i].load(std::memory_order_relaxed);
    return sum >= enough_;
  }
  /// The part has found so many. Looks at the others now and then: there may be a thousand.
  void throw_if_reached(std::size_t part, std::size_t found) {
    constexpr std::size_t kFoundLooked = 64;
    found_[part].store(found, std::memory_order_relaxed);
    if (found >= enough_ || (found % kFoundLooked == 0 && is_reached(part))) throw Reached();
  }

 private:
  std::size_t enough_;
  std::vector<std::atomic<std::size_t>> found_;
};

/// Whether a second decider is asked about a pair that the first one has decided.
inline bool asks_again(SecondOpinionScope scope, bool filtered, bool touches) {
  if (scope == SecondOpinionScope::kNone) return false;
  return scope == SecondOpinionScope::kAll || !filtered || touches;
}

/// Counts, and the `limit` first hits in (event, features) order. Memory does not grow with the number of hits.
class Tally {
 public:
  /// `stop` outlives it.
  explicit Tally(std::size_t limit, const Stop& stop) : limit_(limit), stop_(&stop) {}
  /// Of the first `enough` hits in the order of the work; what follows is not looked at. REQUIRES enough > 0.
  static Tally of_first(std::size_t enough, const Stop& stop) {
    Tally tally(enough, stop);
    tally.enough_ = enough;
    return tally;
  }
  /// For a part of the work of `whole`.
  [[nodiscard]] static Tally part_of(const Tally& whole, std::size_t limit) { return Tally(limit, *whole.stop_); }

  PairCounts pairs;
  std::int64_t block_pairs = 0;  ///< CheckResult::block_pairs

  void throw_if_stopped() const {
    if (*stop_ && (*stop_)()) throw Stopped();
  }

  /// To be called for every few pairs: asks whether to stop now and then, so that one block of work may meet all
  /// others.
  void count_visit() {
    constexpr std::uint32_t kVisitsAsked = 1024;  // each up to some 10 us, where exact arithmetic decides
    if (++visits_ % kVisitsAsked == 0) throw_if_stopped();
  }

  /// Whether there are as many hits as are looked for.
  [[nodiscard]] bool has_enough() const { return count_missing() == 0; }

  void add(const Hit& hit);
  void add(const Tally& other);
  /// Counts a pair of elements with these labels if an exemption covers it: then it is not to be checked.
  bool is_exempt(const Topology& topology, bool check_bodies, const std::vector<Label>& labels_i, std::int32_t i,
                 const std::vector<Label>& labels_j, std::int32_t j) {
    if (topology.exemptions.empty()) return false;
    const std::int32_t rule = topology.exemptions.exemption(labels_i[static_cast<std::size_t>(i)],
                                                            labels_j[static_cast<std::size_t>(j)], check_bodies);
    if (rule >= 0) count_exempted(static_cast<std::size_t>(rule));
    return rule >= 0;
  }
  /// Counts the answer of a second decider on a pair of which the first says that it touches, or not.
  void add_second_opinion(EventKind event, std::array<std::int32_t, 2> features, bool touches, bool second) {
    ++pairs.asked_again;
    if (touches == second) return;
    ++pairs.disagreed;
    if (disagreements_.size() < limit_) disagreements_.push_back({event, features, touches ? "touches" : "apart"});
  }
  /// At most `limit`, in the order of the work.
  [[nodiscard]] const std::vector<Hit>& disagreements() const { return disagreements_; }
  /// By exemption; those at the end may be missing, and are then zero.
  [[nodiscard]] const std::vector<std::int64_t>& exempted() const { return exempted_; }
  [[nodiscard]] const ViolationCounts& violations() const { return violations_; }
  /// Sorted; at most `limit`.
  [[nodiscard]] std::vector<Hit> first_hits() const;

 private:
  template <class Work>
  friend void tally_in_parallel(std::size_t count, std::size_t limit, Tally& tally, const Work& work);

  void keep(const Hit& hit);
  void count_exempted(std::size_t rule, std::int64_t count = 1);
  [[nodiscard]] std::size_t count_missing() const {
    return enough_ - std::min(enough_, static_cast<std::size_t>(violations_.total()));
  }

  std::size_t limit_;
  const Stop* stop_;
  std::size_t enough_ = std::numeric_limits<std::size_t>::max();
  EnoughHits* together_ = nullptr;  ///< with the other parts of the work, where some hits are enough
  std::size_t part_ = 0;
  std::uint32_t visits_ = 0;
  ViolationCounts violations_;
  std::vector<Hit> hits_;
  std::vector<Hit> disagreements_;
  std::vector<std::int64_t> exempted_;
};

/// Adds to `tally` what work(i, its own tally) counts for all i < count, or for as many as have enough hits.
template <class Work>
void tally_in_parallel(std::size_t count, std::size_t limit, Tally& tally, const Work& work) {
  if (tally.has_enough()) return;
  // Chunks are fixed by the count, so that what a chunk counts does not depend on the scheduler; and so many at most
  // that their memory is no matter.
  constexpr std::size_t kLeast = 16, kMaxChunks = 1024;
  const std::size_t size = std::max(kLeast, (count + kMaxChunks - 1) / kMaxChunks);
  std::vector<Tally> chunks((count + size - 1) / size, Tally::part_of(tally, limit));
  std::optional<EnoughHits> together;
  if (tally.enough_ != std::numeric_limits<std::size_t>::max()) together.emplace(tally.count_missing(), chunks.size());
  own_parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
    const FpGuard guard;
    if (together) {
      if (together->is_reached(c)) return;
      chunks[c].together_ = &*together;
      chunks[c].part_ = c;
    }
    try {
      for (std::size_t i = c * size; i < std::min((c + 1) * size, count); ++i) {
        chunks[c].throw_if_stopped();
        work(i, chunks[c]);
      }
    } catch (const EnoughHits::Reached&) {  // the rest of this chunk is behind them
    }
  });
  for (const Tally& chunk : chunks) tally.add(chunk);
}

}  // namespace selvage::verify
