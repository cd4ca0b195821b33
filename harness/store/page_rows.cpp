#include "harness/store/page_rows.hpp"

#include <algorithm>
#include <bit>
#include <optional>

#include "harness/store/big_endian.hpp"

namespace loopbench::harness {
namespace {

constexpr unsigned char kTableLeaf = 0x0d;
constexpr unsigned char kIndexLeaf = 0x0a;
constexpr unsigned char kIndexInterior = 0x02;  // tables without rowid keep rows here, too

/// Reads bytes in order; every read past the end fails.
class Cursor {
 public:
  explicit Cursor(std::string_view data) : data_(data) {}

  std::optional<std::uint64_t> varint() {
    std::uint64_t out = 0;
    for (int i = 0; i < 9; ++i) {
      if (data_.empty()) return std::nullopt;
      const auto byte = static_cast<unsigned char>(data_.front());
      data_.remove_prefix(1);
      if (i == 8) return out << 8 | byte;
      out = out << 7 | (byte & 0x7fu);
      if ((byte & 0x80u) == 0) return out;
    }
    return out;
  }
  std::optional<std::string_view> take(std::uint64_t size) {
    if (size > data_.size()) return std::nullopt;
    const std::string_view out = data_.substr(0, size);
    data_.remove_prefix(size);
    return out;
  }
  std::size_t left() const { return data_.size(); }

 private:
  std::string_view data_;
};

std::optional<PageValue> value_of(std::uint64_t type, Cursor& body) {
  using Type = PageValue::Type;
  constexpr std::uint64_t kIntegerBytes[] = {0, 1, 2, 3, 4, 6, 8};
  if (type == 0) return PageValue{};
  if (type == 8 || type == 9) return PageValue{Type::integer, type == 9, 0.0, {}};
  if (type == 10 || type == 11) return std::nullopt;
  const std::uint64_t size = type >= 12 ? (type - 12) / 2 : type == 7 ? 8 : kIntegerBytes[type];
  const auto bytes = body.take(size);
  if (!bytes) return std::nullopt;
  if (type >= 12) return PageValue{type % 2 == 1 ? Type::text : Type::blob, 0, 0.0, *bytes};
  const std::uint64_t raw = big_endian(bytes->data(), size);
  if (type == 7) return PageValue{Type::real, 0, std::bit_cast<double>(raw), {}};
  const unsigned unused = 64 - 8 * static_cast<unsigned>(size);
  return PageValue{Type::integer, static_cast<std::int64_t>(raw << unused) >> unused, 0.0, {}};
}

bool decode(std::string_view payload, std::vector<PageValue>& values) {
  values.clear();
  Cursor all(payload);
  const auto header_size = all.varint();
  const std::size_t size_bytes = payload.size() - all.left();
  if (!header_size || *header_size < size_bytes || *header_size > payload.size()) return false;
  Cursor header(payload.substr(size_bytes, *header_size - size_bytes));
  Cursor body(payload.substr(*header_size));
  while (header.left() > 0) {
    const auto type = header.varint();
    const auto value = type ? value_of(*type, body) : std::nullopt;
    if (!value) return false;
    values.push_back(*value);
  }
  return body.left() == 0;
}

class RowVisitor {
 public:
  RowVisitor(const PageFile& file,
             const PageView& view,
             const std::function<void(const PageRow& row)>& visit)
      : file_(file), view_(view), visit_(visit), overflow_left_(2 * file.bytes()) {}

  void visit_all() {
    for (std::uint32_t number = 1; number <= view_.pages.size(); ++number) {
      if (file_.read(view_, number, page_)) visit_page(number);
    }
  }

 private:
  void visit_page(std::uint32_t number) {
    const std::size_t begin = number == 1 ? 100 : 0;  // after the header of the file
    const auto type = static_cast<unsigned char>(page_[begin]);
    if (type != kTableLeaf && type != kIndexLeaf && type != kIndexInterior) return;
    const std::size_t pointers = begin + (type == kIndexInterior ? 12 : 8);
    const std::size_t count = big_endian_16(page_.data() + begin + 3);
    row_.has_rowid = type == kTableLeaf;
    row_.page = number;
    for (std::size_t i = 0; i < count && pointers + 2 * i + 2 <= page_.size(); ++i) {
      std::size_t cell = big_endian_16(page_.data() + pointers + 2 * i);
      if (type == kIndexInterior) cell += 4;  // number of the child page
      if (cell < page_.size()) visit_cell(cell);
    }
  }

  void visit_cell(std::size_t begin) {
    Cursor cell(std::string_view(page_).substr(begin));
    const auto size = cell.varint();
    const auto rowid = row_.has_rowid ? cell.varint() : 0;
    if (!size || !rowid || *size > file_.bytes()) return;
    row_.rowid = static_cast<std::int64_t>(*rowid);
    const std::uint64_t local = local_bytes(*size);
    const auto payload = cell.take(local);
    if (!payload) return;
    if (local == *size) {
      if (decode(*payload, row_.values)) visit_(row_);
      return;
    }
    const auto next = cell.take(4);
    payload_.assign(*payload);
    if (!next || !read_overflow(big_endian_32(next->data()), *size)) return;
    if (decode(payload_, row_.values)) visit_(row_);
  }

  /// Bytes of a payload of `size` that are on the page itself.
  std::uint64_t local_bytes(std::uint64_t size) const {
    const std::uint64_t usable = view_.page_size;
    const std::uint64_t most = row_.has_rowid ? usable - 35 : (usable - 12) * 64 / 255 - 23;
    if (size <= most) return size;
    const std::uint64_t least = (usable - 12) * 32 / 255 - 23;
    const std::uint64_t fitted = least + (size - least) % (usable - 4);
    return fitted <= most ? fitted : least;
  }

  bool read_overflow(std::uint32_t number, std::uint64_t size) {
    while (payload_.size() < size) {
      // Damaged chains can be circular or shared by many rows.
      if (overflow_left_ < view_.page_size || !file_.read(view_, number, overflow_)) return false;
      overflow_left_ -= view_.page_size;
      number = big_endian_32(overflow_.data());
      const std::uint64_t part =
          std::min<std::uint64_t>(overflow_.size() - 4, size - payload_.size());
      payload_.append(overflow_, 4, part);
    }
    return true;
  }

  const PageFile& file_;
  const PageView& view_;
  const std::function<void(const PageRow& row)>& visit_;
  std::uint64_t overflow_left_;  ///< bytes that may still be read from overflow pages
  std::string page_;
  std::string overflow_;
  std::string payload_;
  PageRow row_;
};

}  // namespace

void for_each_row(const PageFile& file,
                  const PageView& view,
                  const std::function<void(const PageRow& row)>& visit) {
  RowVisitor(file, view, visit).visit_all();
}

}  // namespace loopbench::harness
