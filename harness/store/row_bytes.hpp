/// A row of a store as bytes, to be hashed and read without asking SQLite for each value twice.
#pragma once

#include <cstdint>
#include <string_view>

namespace loopbench::harness {

/// Reads the values of Statement::bytes_of_columns() in order. A value of another type than
/// requested, which only a damaged row has, is zero or empty. Views are valid as long as the bytes.
class RowBytes {
 public:
  explicit RowBytes(std::string_view bytes) : bytes_(bytes) {}

  std::int64_t integer();
  double real();
  std::string_view view();  ///< text or blob
  bool is_null() const;     ///< of the next value, without consuming it
  void skip() { next(); }
  std::string_view rest() const { return bytes_; }  ///< the values that follow

 private:
  struct Value {
    int type = 0;
    std::string_view bytes;
  };

  Value next();

  std::string_view bytes_;
};

}  // namespace loopbench::harness
