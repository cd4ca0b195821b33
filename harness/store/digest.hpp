/// Digests for the detection of changed bytes; SQLite has no checksums.
#pragma once

#include <string>
#include <string_view>

#include "harness/store/sqlite.hpp"
#include "harness/text/hash.hpp"

namespace loopbench::harness {

/// Digest of rows in order. Chained MurmurHash3 x64 128.
class RowsDigest {
 public:
  /// Adds the columns in [from, to).
  void add(Statement& row, int from, int to) { add(row.bytes_of_columns(from, to)); }

  /// Adds a row as serialised by Statement::bytes_of_columns().
  void add(std::string_view row);

  /// 32 hexadecimal digits; empty without rows.
  std::string text() const { return any_ ? hex(state_) : ""; }

  /// The number behind text(); zero without rows.
  const Hash& value() const { return state_; }

 private:
  Hash state_;
  bool any_ = false;
};

/// Digest of the columns in [from, to) of one row, equal to that of a list of this row.
std::string digest_of_columns(Statement& row, int from, int to);
Hash digest_of_row(Statement& row, int from, int to);  ///< as a number

/// The number of 32 lower-case hexadecimal digits; zero for any other text.
Hash parsed_digest(std::string_view digest);

/// Digest of rows in any order, updated row by row: the sum of their digests, 64 bits at a time
/// (AdHash; Bellare and Micciancio 1997).
class SumOfDigests {
 public:
  /// `digest`: a text() of this class or of RowsDigest, or its number; any other text counts as
  /// zero.
  void add(std::string_view digest) { add(parsed_digest(digest)); }
  void add(const Hash& digest);
  void add(const SumOfDigests& others) { add(others.sum_); }
  void remove(std::string_view digest);
  std::string text() const { return hex(sum_); }

 private:
  Hash sum_;
};

}  // namespace loopbench::harness
