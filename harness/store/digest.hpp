/// What a changed byte is found by: SQLite keeps no checksums of its own.
#pragma once

#include <string>
#include <string_view>

#include "harness/store/sqlite.hpp"
#include "harness/text/hash.hpp"

namespace loopbench {

/// Of rows in their order. Chained MurmurHash3 x64 128.
class RowsDigest {
 public:
  /// The columns in [from, to).
  void add(Statement& row, int from, int to);

  /// 32 hexadecimal digits, or nothing when there was no row.
  std::string text() const { return any_ ? hex(state_) : ""; }

 private:
  Hash state_;
  bool any_ = false;
};

/// Of the columns in [from, to) of one row, the same as that of a list of it alone.
std::string digest_of_columns(Statement& row, int from, int to);

/// Of rows in any order, kept up to date row by row: the sum of their digests, 64 bits at a time
/// (AdHash; Bellare and Micciancio 1997).
class SumOfDigests {
 public:
  /// `digest`: a text() of this or of RowsDigest; anything else counts as zero.
  void add(std::string_view digest);
  void remove(std::string_view digest);
  std::string text() const { return hex(sum_); }

 private:
  Hash sum_;
};

}  // namespace loopbench
