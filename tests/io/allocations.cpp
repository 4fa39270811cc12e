#include "tests/io/allocations.h"

#include <cstdlib>
#include <new>

#include <malloc.h>

namespace {

std::size_t allocated = 0, peak = 0;

void* counted_allocation(std::size_t size) {
  void* const block = std::malloc(size == 0 ? 1 : size);
  if (block == nullptr) throw std::bad_alloc();
  allocated += ::malloc_usable_size(block);
  if (allocated > peak) peak = allocated;
  return block;
}

void counted_release(void* block) noexcept {
  allocated -= ::malloc_usable_size(block);
  std::free(block);
}

}  // namespace

void* operator new(std::size_t size) { return counted_allocation(size); }
void operator delete(void* block) noexcept { counted_release(block); }
void operator delete(void* block, std::size_t) noexcept { counted_release(block); }

namespace selvage::testing {

std::size_t peak_during(const std::function<void()>& body) {
  const std::size_t before = allocated;
  peak = allocated;
  body();
  return peak - before;
}

}  // namespace selvage::testing
