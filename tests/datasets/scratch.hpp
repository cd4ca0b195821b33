/// Helpers of the tests on files: samples, pipes and error messages.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

#include "datasets/core/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench {

inline std::filesystem::path sample(const std::string& name) {
  return std::filesystem::path(LOOPBENCH_TEST_DATA) / name;
}

/// Pipe without a name that another thread fills, as `<(COMMAND)` of a shell gives it.
class Pipe {
 public:
  explicit Pipe(std::string content) {
    EXPECT_EQ(pipe2(ends_.data(), O_CLOEXEC), 0);
    writer_ = std::thread([end = ends_[1], text = std::move(content)] {
      EXPECT_TRUE(std::ofstream("/dev/fd/" + std::to_string(end)) << text);
      close(end);
    });
  }
  ~Pipe() {
    writer_.join();
    close(ends_[0]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  std::filesystem::path path() const { return "/dev/fd/" + std::to_string(ends_[0]); }

 private:
  std::array<int, 2> ends_{};
  std::thread writer_;
};

inline std::string content(const std::filesystem::path& file) {
  std::ostringstream out;
  out << std::ifstream(file, std::ios::binary).rdbuf();
  return out.str();
}

/// Returns the message of the InputError thrown by `act`. The test fails without an InputError.
template <class Act>
std::string refusal(Act act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return {};
}

}  // namespace loopbench
