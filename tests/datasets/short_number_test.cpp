/// short_number reads what it accepts as std::from_chars does, bit by bit.
#include "datasets/columns/short_number.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <random>
#include <sstream>
#include <string>

namespace loopbench::short_number_test {
namespace {

/// Whether it accepts the text; fails if it reads another value, or to another end, than the
/// standard library.
bool accepts(const std::string& text) {
  double found = 0.0, expected = 0.0;
  const char* const end = text.data() + text.size();
  const char* const stop = short_number(text.data(), end, found);
  if (stop == nullptr) return false;
  const auto [rest, error] = std::from_chars(text.data(), end, expected);
  EXPECT_TRUE(error == std::errc{} && rest == stop) << text;
  EXPECT_EQ(std::bit_cast<std::uint64_t>(found), std::bit_cast<std::uint64_t>(expected)) << text;
  return true;
}

// 9007199254740993 and ...5 are halfway between two doubles, 9999999999999999999 needs 64 bits.
TEST(ShortNumber, ReadsCommonForms) {
  std::istringstream forms(
      "0|-0|1|-1.5|0.1|.5|5.|-.25|007|1305031102.175304|9007199254740992|0.000000000000001|12.5 7|"
      "3,4|1.2.3|0x1p3|123456789012345.6|9007199254740993|9007199254740995|0.12345678901234567|"
      "-1305031102.175304001|9223372036854775807|9999999999999999999|0.1234567890123456789|"
      "000000000000000000000.000000000000000000000|0.00021487524287554123|-00012.00034|1e5|1.5E-3|"
      "-9.999978000000000e-01|1.234567890123456789e+00|5.0e-324|1e308");
  for (std::string text; std::getline(forms, text, '|');) EXPECT_TRUE(accepts(text)) << text;
}

TEST(ShortNumber, LeavesTheRestToTheStandardLibrary) {
  std::istringstream forms(
      "|-|.|-.|+1|nan|inf|1e|1e+|1e-x|1e0005|1e999|e5|--1|0.12345678901234567890|"
      "1.0000000000000000000|12345678901234567890123| 1");
  for (std::string text; std::getline(forms, text, '|');) EXPECT_FALSE(accepts(text)) << text;
}

TEST(ShortNumber, HasTheBitsOfTheStandardLibrary) {
  std::mt19937_64 bits(3);
  int accepted = 0;
  for (int i = 0; i < 400000; ++i) {
    const auto whole = static_cast<std::int64_t>(bits() >> (bits() % 60 + 4));
    const double number = (bits() % 2 == 0 ? -1.0 : 1.0) * static_cast<double>(whole) * 0x1p-30;
    const std::string text =
        bits() % 4 == 0 ? fmt::format("{}", number) : fmt::format("{:.{}f}", number, bits() % 17);
    accepted += accepts(text) ? 1 : 0;
  }
  EXPECT_GT(accepted, 100000);
}

TEST(ShortNumber, HasTheBitsOfTheStandardLibraryForEveryCountOfDigits) {
  std::mt19937_64 bits(5);
  for (int i = 0; i < 100000; ++i) {
    const double number = std::bit_cast<double>(bits() >> 2 | std::uint64_t{1} << 61) * 0x1p-2;
    const double usual = static_cast<double>(bits() >> 11) * 0x1p-43;
    accepts(fmt::format("{}", usual));                        // shortest
    accepts(fmt::format("{:.{}f}", usual, 5 + bits() % 14));  // as C++ streams
    accepts(fmt::format("{:.{}e}", usual, 5 + bits() % 14));  // as numpy.savetxt
    accepts(fmt::format("{}", usual * 0x1p-24));
    accepts(fmt::format("{:.{}e}", number, 5 + bits() % 14));  // any size
    const std::uint64_t odd = (bits() >> 10 | 1) + (std::uint64_t{1} << 53);
    accepts(fmt::format("{}", odd));                               // often halfway
    accepts(fmt::format("{}.{}", odd / 2, odd % 2 == 0 ? 0 : 5));  // the same
  }
}

TEST(ShortNumber, ReadsNothingBeyondTheEnd) {
  const std::string text = "12.375";
  for (std::size_t size = 1; size <= text.size(); ++size) {
    double found = 0.0;
    const char* const stop = short_number(text.data(), text.data() + size, found);
    EXPECT_EQ(stop, text.data() + size);
    EXPECT_EQ(found, std::stod(text.substr(0, size)));
  }
}

}  // namespace
}  // namespace loopbench::short_number_test
