/// A file that lives as long as its test.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace loopbench {

class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& content) : path_(folder() / name) {
    std::filesystem::create_directories(path_.parent_path());
    std::ofstream(path_) << content;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  /// One per test, for tests run side by side.
  static std::filesystem::path folder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    return std::filesystem::path(testing::TempDir()) /
           (std::string("loopbench_") + test->test_suite_name() + "_" + test->name());
  }

  std::filesystem::path path_;
};

/// The message of the InputError or OptionError that `action` throws; "" when it throws none.
template <class Action>
std::string refusal_of(Action action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace loopbench
