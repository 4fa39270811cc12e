#include "fuzz/shrink/shrink_choices.h"

#include <exception>
#include <utility>

namespace selvage::fuzz {
namespace {

class ChoiceShrinker {
 public:
  ChoiceShrinker(Choices choices, const std::string& failure,
                 const std::function<std::string(ChoiceSource)>& failure_of, std::int64_t max_trials)
      : best_(std::move(choices)), failure_(failure), failure_of_(failure_of), left_(max_trials) {}

  Choices run() {
    trim(best_);
    bool progress = true;
    while (progress && left_ > 0) {
      const Choices before = best_;
      cut_off();
      for (const std::size_t length : {32U, 16U, 8U, 4U, 2U, 1U}) cut_out(length);
      for (const std::size_t length : {8U, 1U}) zero(length);
      lower();
      progress = best_ != before;
    }
    return best_;
  }

 private:
  /// An exhausted source answers 0: zeros at the end say nothing.
  static void trim(Choices& choices) {
    while (!choices.empty() && choices.back() == 0) choices.pop_back();
  }

  /// Fewer answers are simpler, and of as many the smaller ones, the first counting most.
  bool offer(Choices simpler) {
    trim(simpler);
    const bool is_simpler = simpler.size() < best_.size() || (simpler.size() == best_.size() && simpler < best_);
    if (!is_simpler || left_ <= 0) return false;
    --left_;
    if (!fails(simpler)) return false;
    best_ = std::move(simpler);
    return true;
  }

  [[nodiscard]] bool fails(const Choices& choices) const {
    try {
      return failure_of_(ChoiceSource::from_words(choices)) == failure_;
    } catch (const std::exception&) {  // a failure, but another one
      return false;
    }
  }

  void cut_off() {
    for (std::size_t cut = best_.size(); cut > 0; cut /= 2) {
      while (best_.size() >= cut && offer(Choices(best_.begin(), best_.end() - static_cast<std::ptrdiff_t>(cut)))) {
      }
    }
  }

  void cut_out(std::size_t length) {
    for (std::size_t end = best_.size(); end >= length; --end) {
      if (end > best_.size()) continue;
      Choices simpler = best_;
      const auto last = simpler.begin() + static_cast<std::ptrdiff_t>(end);
      simpler.erase(last - static_cast<std::ptrdiff_t>(length), last);
      (void)offer(std::move(simpler));
    }
  }

  void zero(std::size_t length) {
    for (std::size_t begin = 0; begin + length <= best_.size(); begin += length) {
      Choices simpler = best_;
      for (std::size_t i = begin; i < begin + length; ++i) simpler[i] = 0;
      (void)offer(std::move(simpler));
    }
  }

  /// By bisection, as if there were one least answer that fails.
  void lower() {
    for (std::size_t i = 0; i < best_.size(); ++i) {
      std::uint32_t too_low = 0;
      while (i < best_.size() && best_[i] > too_low + 1) {
        Choices simpler = best_;
        simpler[i] = too_low + (best_[i] - too_low) / 2;
        const std::uint32_t tried = simpler[i];
        if (!offer(std::move(simpler))) too_low = tried;
      }
    }
  }

  Choices best_;
  const std::string& failure_;
  const std::function<std::string(ChoiceSource)>& failure_of_;
  std::int64_t left_;
};

}  // namespace

Choices shrink_choices(const ChoiceSource& source, const std::string& failure,
                       const std::function<std::string(ChoiceSource)>& failure_of, std::int64_t max_trials) {
  Choices choices;
  ChoiceSource recorded = source;
  recorded.record_to(choices);
  if (failure_of(recorded) != failure) return choices;
  return ChoiceShrinker(std::move(choices), failure, failure_of, max_trials).run();
}

}  // namespace selvage::fuzz
