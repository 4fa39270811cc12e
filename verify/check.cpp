#include "verify/check.h"

namespace selvage::verify {

PairCounts& PairCounts::operator+=(const PairCounts& other) {
  vf += other.vf;
  ee += other.ee;
  overlap += other.overlap;
  self += other.self;
  exact += other.exact;
  asked_again += other.asked_again;
  disagreed += other.disagreed;
  return *this;
}

ViolationCounts& ViolationCounts::operator+=(const ViolationCounts& other) {
  vf += other.vf;
  ee += other.ee;
  overlap += other.overlap;
  self += other.self;
  return *this;
}

}  // namespace selvage::verify
