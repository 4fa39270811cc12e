#include "verify/tally.h"

namespace selvage::verify {

void Tally::add(const Hit& hit) {
  switch (hit.event) {
    case EventKind::kVf:
      ++violations_.vf;
      break;
    case EventKind::kEe:
      ++violations_.ee;
      break;
    case EventKind::kOverlap:
      ++violations_.overlap;
      break;
    case EventKind::kSelf:
      ++violations_.self;
      break;
  }
  keep(hit);
  if (together_ != nullptr) together_->throw_if_reached(part_, static_cast<std::size_t>(violations_.total()));
}

void Tally::keep(const Hit& hit) {
  if (limit_ == 0) return;
  hits_.push_back(hit);
  // Twice the limit and some are kept before the larger half goes: linear time on the whole.
  if (hits_.size() < 2 * limit_ + 64) return;
  std::nth_element(hits_.begin(), hits_.begin() + static_cast<std::ptrdiff_t>(limit_) - 1, hits_.end());
  hits_.resize(limit_);
}

void Tally::add(const Tally& other) {
  pairs += other.pairs;
  block_pairs += other.block_pairs;
  if (other.together_ != nullptr) {  // its hits are all there, in the order in which they were found
    for (auto hit = other.hits_.begin(); hit != other.hits_.end() && !has_enough(); ++hit) add(*hit);
  } else {
    violations_ += other.violations_;
    for (const Hit& hit : other.hits_) keep(hit);
  }
  for (const Hit& hit : other.disagreements_) {
    if (disagreements_.size() < limit_) disagreements_.push_back(hit);
  }
  for (std::size_t rule = 0; rule < other.exempted_.size(); ++rule) count_exempted(rule, other.exempted_[rule]);
}

void Tally::count_exempted(std::size_t rule, std::int64_t count) {
  if (exempted_.size() <= rule) exempted_.resize(rule + 1);
  exempted_[rule] += count;
}

std::vector<Hit> Tally::first_hits() const {
  std::vector<Hit> first = hits_;
  std::sort(first.begin(), first.end());
  first.resize(std::min(first.size(), limit_));
  return first;
}

}  // namespace selvage::verify
