#include "io/file/json_values.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "io/fail.h"

namespace selvage::io {
namespace {

using AnyJson = nlohmann::json;

std::size_t lines_before(std::string_view text, std::size_t position) {
  const std::string_view before = text.substr(0, position);
  return static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
}

/// What the parser calls for every value. Nothing opens that has no place, so `open_` is no deeper than the places.
class Handler final : public nlohmann::json_sax<AnyJson> {
 public:
  Handler(std::string_view text, const JsonReading& reading) : text_(text), reading_(reading) {}

  JsonValues take() { return std::move(values_); }

  bool null() override { return refuse(); }
  bool boolean(bool) override { return refuse(); }
  bool binary(binary_t&) override { return refuse(); }
  bool number_integer(number_integer_t value) override { return keep(JsonType::kNumber, static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return keep(JsonType::kNumber, std::uint64_t{value}); }
  bool number_float(number_float_t value, const string_t&) override { return keep(JsonType::kNumber, value); }
  bool string(string_t& value) override { return keep(JsonType::kText, std::move(value)); }

  bool start_object(std::size_t) override { return keep(JsonType::kObject, std::monostate{}); }
  bool start_array(std::size_t) override { return keep(JsonType::kList, std::monostate{}); }
  bool end_array() override {
    open_.pop_back();
    return true;
  }

  bool key(string_t& name) override {
    key_ = open_.back().path.empty() ? name : open_.back().path + "." + name;
    const bool looks_like_a_path = name.find_first_of(".[") != name.npos;
    if (looks_like_a_path || place(key_) == nullptr) reading_.fail("unknown key " + in_quotes(name) + "; remove it");
    if (values_.contains(key_)) reading_.fail("the key " + in_quotes(name) + " is there twice; remove one");
    return true;
  }

  bool end_object() override {
    const std::string path = std::move(open_.back().path);
    open_.pop_back();
    if (!path.ends_with("[]")) return true;
    reading_.at_item(values_);
    std::erase_if(values_, [&](const auto& value) { return value.first.starts_with(path); });
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    if (dynamic_cast<const AnyJson::out_of_range*>(&error) != nullptr)
      reading_.fail("a number is outside the range of double; correct it");
    reading_.fail_at(lines_before(text_, position), "not valid JSON; correct it");
    return false;
  }

 private:
  struct Open {
    std::string path;
    const JsonPlace* place;
    std::size_t items = 0;  ///< of a list
  };

  [[nodiscard]] const JsonPlace* place(std::string_view path) const {
    const auto found = std::ranges::find(reading_.places, path, &JsonPlace::path);
    return found == reading_.places.end() ? nullptr : &*found;
  }

  /// The path of the value that comes now.
  std::string next_path() {
    if (open_.empty()) return "";
    Open& in = open_.back();
    if (in.place->type == JsonType::kObject) return key_;
    std::string any = in.path + "[]";
    if (place(any) != nullptr) return any;
    std::string item = in.path + "[" + std::to_string(in.items++) + "]";
    if (place(item) == nullptr) reading_.fail(in.place->fault);
    return item;
  }

  template <typename Value>
  bool keep(JsonType type, Value value) {
    std::string path = next_path();
    const JsonPlace& found = *place(path);
    if (found.type != type) fail(found);
    if (type == JsonType::kObject || type == JsonType::kList) open_.push_back({path, &found});
    values_.insert_or_assign(std::move(path), std::move(value));
    return true;
  }

  bool refuse() {
    fail(*place(next_path()));
    return false;
  }

  void fail(const JsonPlace& place) const {
    if (place.type != JsonType::kText) reading_.fail(place.fault);
    reading_.fail(in_quotes(last_key(place.path)) + " is not a text; correct it");
  }

  std::string_view text_;
  const JsonReading& reading_;
  std::vector<Open> open_;
  std::string key_;  ///< path of the last key
  JsonValues values_;
};

}  // namespace

std::string zero_byte_fault(std::string_view json) {
  const std::size_t at = find_zero_byte(json);
  return at == json.npos ? std::string() : "a zero byte at byte " + std::to_string(at + 1) + "; is it whole?";
}

std::string_view last_key(std::string_view path) { return path.substr(path.rfind('.') + 1); }

JsonValues read_json(std::string_view text, const JsonReading& reading) {
  if (const std::size_t at = find_zero_byte(text); at != text.npos) {
    reading.fail_at(lines_before(text, at), "a zero byte, as damage leaves it; restore the file");
  }
  Handler handler(text, reading);
  AnyJson::sax_parse(text, &handler);
  return handler.take();
}

}  // namespace selvage::io
