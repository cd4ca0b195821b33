#include "harness/store/row_bytes.hpp"

#include <sqlite3.h>

#include <cstring>

namespace loopbench::harness {
namespace {

template <class T>
T read_as(std::string_view bytes) {
  T out{};
  std::memcpy(&out, bytes.data(), sizeof out);
  return out;
}

}  // namespace

RowBytes::Value RowBytes::next() {
  if (bytes_.empty()) return {SQLITE_NULL, {}};
  Value out{bytes_.front(), {}};
  bytes_.remove_prefix(1);
  std::size_t size = out.type == SQLITE_NULL ? 0 : sizeof(std::int64_t);
  if (out.type == SQLITE_TEXT || out.type == SQLITE_BLOB) {
    size = static_cast<std::size_t>(read_as<std::int64_t>(bytes_));
    bytes_.remove_prefix(sizeof(std::int64_t));
  }
  out.bytes = bytes_.substr(0, size);
  bytes_.remove_prefix(size);
  return out;
}

std::int64_t RowBytes::integer() {
  const Value value = next();
  return value.type == SQLITE_INTEGER ? read_as<std::int64_t>(value.bytes) : 0;
}

double RowBytes::real() {
  const Value value = next();
  if (value.type == SQLITE_INTEGER) return static_cast<double>(read_as<std::int64_t>(value.bytes));
  return value.type == SQLITE_FLOAT ? read_as<double>(value.bytes) : 0.0;
}

std::string_view RowBytes::view() {
  const Value value = next();
  return value.type == SQLITE_TEXT || value.type == SQLITE_BLOB ? value.bytes : std::string_view{};
}

bool RowBytes::is_null() const { return bytes_.empty() || bytes_.front() == SQLITE_NULL; }

}  // namespace loopbench::harness
