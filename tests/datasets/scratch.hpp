/// Helpers of the tests on files and datasets: samples, pipes, error messages.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "datasets/dataset.hpp"
#include "tests/support/refusal_of.hpp"
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

/// Loads a sequence as a config does.
inline Sequence load_dataset(const std::string& name,
                             const Params& given,
                             const DataRoot& root = {}) {
  for (const DatasetEntry& entry : datasets()) {
    if (entry.name == name) return entry.load(given, root);
  }
  throw std::logic_error("no dataset " + name);
}

inline bool same_bits(const Trajectory& a, const Trajectory& b) {
  return std::ranges::equal(a, b, [](const StampedPose& x, const StampedPose& y) {
    return x.stamp == y.stamp && x.world_from_body.translation == y.world_from_body.translation &&
           x.world_from_body.rotation.coeffs() == y.world_from_body.rotation.coeffs();
  });
}

/// Returns the message of the InputError thrown by `act`. The test fails without an InputError.
template <class Act>
std::string refusal(Act act) {
  return required_refusal_of<InputError>(act);
}

}  // namespace loopbench
