/// Runs `loopbench eval` and `loopbench traj` in the test process.
#pragma once

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/commands/commands.hpp"

namespace loopbench::test {

using namespace metrics;
using namespace harness;

using Json = nlohmann::json;

inline std::string golden(const std::string& name) {
  return std::string(LOOPBENCH_TEST_DATA) + "/golden/" + name;
}

inline std::vector<std::string> with(std::vector<std::string> arguments,
                                     const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// The golden reference, an estimate of it and options.
inline std::vector<std::string> drift(const std::vector<std::string>& options = {}) {
  return with({golden("gt.txt"), golden("est_drift.txt")}, options);
}

/// Output of `loopbench VERB ARGS`, eval or traj, which must have the expected exit code.
/// Exceptions of the verb pass.
inline std::string in_process(const std::string& verb,
                              std::vector<std::string> arguments,
                              int expected_exit = kExitOk) {
  CLI::App app;
  int exit_code = -1;
  add_eval(app, exit_code);
  add_traj(app, exit_code);
  arguments.insert(arguments.begin(), verb);
  std::ranges::reverse(arguments);  // order required by CLI11
  testing::internal::CaptureStdout();
  try {
    app.parse(arguments);
  } catch (...) {
    testing::internal::GetCapturedStdout();
    throw;
  }
  EXPECT_EQ(exit_code, expected_exit);
  return testing::internal::GetCapturedStdout();
}

inline std::string eval(const std::vector<std::string>& arguments, int expected_exit = kExitOk) {
  return in_process("eval", arguments, expected_exit);
}

/// The list of evaluations, or the only one.
inline Json eval_json(std::vector<std::string> arguments, int expected_exit = kExitOk) {
  arguments.push_back("--json");
  const Json all = Json::parse(eval(arguments, expected_exit));
  EXPECT_TRUE(all.is_array()) << all;
  return all.size() == 1 ? all[0] : all;
}

inline Json find(const Json& results,
                 const std::string& metric,
                 const std::string& relation,
                 const std::string& axis = "3d") {
  for (const Json& row : results["metrics"]) {
    if (row["metric"] == metric && row["relation"] == relation && row["axis"] == axis) return row;
  }
  ADD_FAILURE() << "no " << metric << " " << relation;
  return {};
}

}  // namespace loopbench::test
