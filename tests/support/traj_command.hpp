/// `loopbench traj` within the process of a test.
#pragma once

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "harness/commands/commands.hpp"

namespace loopbench::test {

struct Printed {
  std::string output;
  std::string errors;
};

/// What `loopbench traj ARGS` prints. Exceptions of the verb pass.
inline Printed traj(std::vector<std::string> arguments) {
  CLI::App app;
  int exit_code = -1;
  harness::add_traj(app, exit_code);
  arguments.insert(arguments.begin(), "traj");
  std::ranges::reverse(arguments);  // order required by CLI11
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  try {
    app.parse(arguments);
  } catch (...) {
    testing::internal::GetCapturedStdout();
    testing::internal::GetCapturedStderr();
    throw;
  }
  EXPECT_EQ(exit_code, harness::kExitOk);
  std::string errors = testing::internal::GetCapturedStderr();
  return {testing::internal::GetCapturedStdout(), std::move(errors)};
}

/// The message of `loopbench traj ARGS`, which must be rejected.
inline std::string traj_refusal(const std::vector<std::string>& arguments) {
  try {
    traj(arguments);
  } catch (const std::exception& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing thrown";
  return "";
}

}  // namespace loopbench::test
