#include "harness/sweep/model/packed_columns.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "datasets/core/error.hpp"

namespace loopbench::harness {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr unsigned kMostOnes = 20, kPlainBits = 24;

/// k of the next number; learns from each number.
class RiceParameter {
 public:
  unsigned k() const {
    unsigned out = 0;
    while (count_ << (out + 1) <= sum_) ++out;
    return out;
  }
  void add(std::uint32_t number) {
    sum_ += number;
    if (++count_ < 8) return;
    sum_ /= 2;
    count_ /= 2;
  }

 private:
  std::uint64_t sum_ = 1, count_ = 1;
};

using Words = std::vector<std::int32_t>;

/// The word of row `i` that the words before predict; `first`: all words of the first column, empty
/// if it is the first.
std::int32_t predicted(
    int order, const Words& first, const Words& words, std::size_t i, unsigned steps) {
  const std::int64_t last = i > 0 ? words[i - 1] : 0;
  if (order == 1) return static_cast<std::int32_t>(last);
  const std::int64_t slope = last - (i > 1 ? words[i - 2] : 0);
  const bool is_over_first = i > 1 && !first.empty() && first[i - 1] != first[i - 2];
  const std::int64_t share = is_over_first ? first[i] - first[i - 1] : 1;
  const std::int64_t whole = is_over_first ? first[i - 1] - first[i - 2] : 1;
  const std::int64_t most = steps + 1;
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(last + slope * share / whole, 0, most));
}

class BitWriter {
 public:
  void add(std::uint32_t value, unsigned bits) {
    while (bits > 0) {
      --bits;
      if (used_ == 0) bytes_ += '\0';
      const auto bit = static_cast<unsigned char>((value >> bits & 1U) << (7U - used_));
      bytes_.back() = static_cast<char>(static_cast<unsigned char>(bytes_.back()) | bit);
      used_ = (used_ + 1) % 8;
    }
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  unsigned used_ = 0;  ///< bits of the last byte
};

class BitReader {
 public:
  explicit BitReader(std::string_view bytes) : bytes_(bytes) {}
  std::uint32_t read(unsigned bits) {
    std::uint32_t out = 0;
    for (; bits > 0; --bits, ++at_) {
      if (at_ / 8 >= bytes_.size()) throw InputError("a trace in the store is truncated");
      out = out << 1U | (static_cast<unsigned char>(bytes_[at_ / 8]) >> (7U - at_ % 8) & 1U);
    }
    return out;
  }
  std::size_t bytes_read() const { return (at_ + 7) / 8; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;  ///< bits
};

std::string rice_coded(int order, const Words& first, const Words& words, unsigned steps) {
  BitWriter out;
  RiceParameter parameter;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::int32_t difference = words[i] - predicted(order, first, words, i, steps);
    const auto number =
        static_cast<std::uint32_t>(difference < 0 ? -2 * difference - 1 : 2 * difference);
    const unsigned k = parameter.k();
    if (const std::uint32_t ones = number >> k; ones < kMostOnes) {
      out.add((1U << (ones + 1)) - 2U, ones + 1);
      out.add(number & ((1U << k) - 1U), k);
    } else {
      out.add((1U << kMostOnes) - 1U, kMostOnes);
      out.add(number, kPlainBits);
    }
    parameter.add(number);
  }
  return out.bytes();
}

std::uint32_t next_number(BitReader& in, unsigned k) {
  unsigned ones = 0;
  while (ones < kMostOnes && in.read(1) == 1) ++ones;
  if (ones == kMostOnes) return in.read(kPlainBits);
  return ones << k | in.read(k);
}

struct Range {
  float low = 0, high = 0;
};

template <class Value>
void append(std::string& bytes, const Value& value) {
  char raw[sizeof(Value)];
  std::memcpy(raw, &value, sizeof raw);
  bytes.append(raw, sizeof raw);
}

template <class Value>
Value take(std::string_view& bytes) {
  Value out;
  if (bytes.size() < sizeof out) throw InputError("a trace in the store is truncated");
  std::memcpy(&out, bytes.data(), sizeof out);
  bytes.remove_prefix(sizeof out);
  return out;
}

}  // namespace

std::string packed_columns(std::span<const float> rows, std::size_t columns, unsigned steps) {
  const std::size_t count = rows.size() / columns;
  std::string out;
  append(out, static_cast<std::uint32_t>(count));
  Words first, words(count);
  for (std::size_t c = 0; c < columns; ++c) {
    constexpr float kMost = std::numeric_limits<float>::infinity();
    Range range{kMost, -kMost};
    for (std::size_t i = 0; i < count; ++i) {
      const float value = rows[i * columns + c];
      if (!std::isfinite(value)) continue;
      range = {std::min(range.low, value), std::max(range.high, value)};
    }
    if (range.low > range.high) range = {};
    const double low = range.low, size = range.high - low;
    for (std::size_t i = 0; i < count; ++i) {
      const float value = rows[i * columns + c];
      const double share = size > 0.0 ? (value - low) / size : 0.0;
      words[i] =
          std::isfinite(value) ? 1 + static_cast<std::int32_t>(std::lround(share * steps)) : 0;
    }
    append(out, range);
    const std::string constant = rice_coded(1, first, words, steps);
    const std::string line = rice_coded(2, first, words, steps);
    const bool is_line = line.size() < constant.size();
    out += is_line ? '\2' : '\1';
    out += is_line ? line : constant;
    if (c == 0) first = words;
  }
  return out;
}

std::vector<float> unpacked_columns(std::string_view bytes, std::size_t columns, unsigned steps) {
  const std::size_t count = take<std::uint32_t>(bytes);
  if (count > 8 * bytes.size()) throw InputError("a trace in the store is truncated");
  std::vector<float> out(count * columns);
  Words first, words;
  for (std::size_t c = 0; c < columns; ++c) {
    const auto range = take<Range>(bytes);
    const double low = range.low, high = range.high;
    const int order = take<char>(bytes);
    words.clear();
    RiceParameter parameter;
    BitReader in(bytes);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t number = next_number(in, parameter.k());
      parameter.add(number);
      const auto half = static_cast<std::int32_t>(number / 2);
      const std::int32_t word =
          predicted(order, first, words, i, steps) + (number % 2 == 1 ? -half - 1 : half);
      if (word < 0 || static_cast<std::uint32_t>(word) > steps + 1) {
        throw InputError("a trace in the store is damaged");
      }
      words.push_back(word);
      const double share = static_cast<double>(word - 1) / steps;  // exact at both ends
      out[i * columns + c] = word == 0 ? std::numeric_limits<float>::quiet_NaN()
                                       : static_cast<float>(low * (1.0 - share) + high * share);
    }
    bytes.remove_prefix(in.bytes_read());
    if (c == 0) first = words;
  }
  return out;
}

}  // namespace loopbench::harness
