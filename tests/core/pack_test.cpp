/// Binary serialisation: what is written is read back, and damaged bytes are rejected.
#include "datasets/core/pack.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace loopbench::pack_test {

struct Walker {
  int steps = 0;
  bool rests = false;
};
template <class Archive, Either<Walker> T>
void walk(Archive& a, T& walker) {
  a(walker.steps)(walker.rests);
}

namespace {

TEST(Pack, ReadsBackWhatWasWritten) {
  const std::vector<Walker> walkers{{3, true}, {4, false}};
  const std::optional<double> some = 0.5;
  const std::optional<std::string> none;
  const std::string bytes = Packer{}(walkers)(some)(none)(std::string("end"))(true).bytes();
  std::vector<Walker> read;
  std::optional<double> number;
  std::optional<std::string> text = "before";
  std::string end;
  bool is_read = false;
  Unpacker{bytes}(read)(number)(text)(end)(is_read);
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].steps, 3);
  EXPECT_TRUE(read[0].rests);
  EXPECT_FALSE(read[1].rests);
  EXPECT_EQ(number, 0.5);
  EXPECT_FALSE(text);
  EXPECT_EQ(end, "end");
  EXPECT_TRUE(is_read);
}

TEST(Unpack, RejectsABooleanOfAnotherValue) {  // found by fuzzing
  const std::string bytes(1, '\x10');
  bool value = false;
  EXPECT_THROW(Unpacker{bytes}(value), std::runtime_error);
  std::optional<int> number;
  EXPECT_THROW(Unpacker{bytes}(number), std::runtime_error);
  Walker walker;
  EXPECT_THROW(Unpacker{Packer{}(7)('\x10').bytes()}(walker), std::runtime_error);
}

TEST(Unpack, RejectsTruncatedData) {
  std::string bytes = Packer{}(std::string("text")).bytes();
  bytes.pop_back();
  std::string text;
  EXPECT_THROW(Unpacker{bytes}(text), std::runtime_error);
  std::vector<double> numbers;
  const std::string huge = Packer{}(std::numeric_limits<std::size_t>::max()).bytes();
  EXPECT_THROW(Unpacker{huge}(numbers), std::runtime_error);
}

}  // namespace
}  // namespace loopbench::pack_test
