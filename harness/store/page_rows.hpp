/// Rows of a SQLite database, read page by page without its schema and interior pages.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/store/page_file.hpp"

namespace loopbench::harness {

struct PageValue {
  enum class Type { null, integer, real, text, blob };
  Type type = Type::null;
  std::int64_t integer = 0;
  double real = 0.0;
  std::string_view bytes;  ///< of a text or blob; valid during the visit
};

struct PageRow {
  bool has_rowid = false;  ///< false: a row of an index, or of a table without rowid
  std::int64_t rowid = 0;
  std::uint32_t page = 0;  ///< its number
  std::vector<PageValue> values;
};

/// Visits every row that can be decoded, in order of pages; skips unreadable pages. Accepts any
/// bytes. Free pages hold no rows, because stores are written with secure_delete. O(bytes).
void for_each_row(const PageFile& file,
                  const PageView& view,
                  const std::function<void(const PageRow& row)>& visit);

}  // namespace loopbench::harness
