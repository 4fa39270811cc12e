#include "page/packed.h"

#include <cstdint>
#include <new>

#include <zlib.h>

namespace selvage::page {

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

std::string packed(std::string_view bytes) {
  uLongf size = ::compressBound(bytes.size());
  std::string stream(size, '\0');
  const int status = ::compress2(reinterpret_cast<Bytef*>(stream.data()), &size,
                                 reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_DEFAULT_COMPRESSION);
  if (status != Z_OK) throw std::bad_alloc();  // the only failure when the buffer is compressBound long
  stream.resize(size);
  return base64(stream);
}

std::string packed_integers(std::span<const std::int32_t> values, std::size_t stride) {
  const std::size_t count = values.size();
  std::string planes(4 * count, '\0');
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = static_cast<std::uint32_t>(values[i]);
    const std::uint32_t difference = i < stride ? value : value - static_cast<std::uint32_t>(values[i - stride]);
    const std::uint32_t folded = difference << 1 ^ (difference >> 31 != 0 ? ~0u : 0u);
    for (std::size_t plane = 0; plane < 4; ++plane) {
      planes[plane * count + i] = static_cast<char>(folded >> (8 * plane) & 255);
    }
  }
  return packed(planes);
}

}  // namespace selvage::page
