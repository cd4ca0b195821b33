// Fuzzing without libFuzzer, in any build: fuzz_random TARGET SECONDS SEED FOLDER...
// Changes the files of the folders at random and calls the target; far less thorough than the
// preset `fuzz`, but every build can run it. Stops at the first finding and keeps it as
// finding-TARGET.
#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <random>
#include <vector>

#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace {

using namespace loopbench;

std::string changed(const std::vector<std::string>& inputs, std::mt19937_64& random) {
  std::string out = inputs[random() % inputs.size()];
  const auto place = [&] { return out.empty() ? 0 : random() % out.size(); };
  for (std::uint64_t left = 1 + random() % 6; left > 0; --left) {
    switch (random() % 7) {
      case 0:
        out.resize(place());
        break;
      case 1:
        out.erase(place(), random() % 16);
        break;
      case 2:
        out.insert(place(), 1 + random() % 8, static_cast<char>(random()));
        break;
      case 3: {
        const std::string& other = inputs[random() % inputs.size()];
        const std::size_t from = other.empty() ? 0 : random() % other.size();
        out.insert(place(), other, from, random() % 64);
        break;
      }
      case 4: {
        const char* const words[] = {
            "nan", "-1", "1e308", "0", "99999999999999999999", "\n", "\"", "["};
        out.insert(place(), words[random() % std::size(words)]);
        break;
      }
      default:
        if (!out.empty()) out[place()] = static_cast<char>(random());
    }
  }
  return out;
}

}  // namespace

int main(int count, char** words) {
  if (count < 5 || !fuzz_targets().contains(words[1])) {
    fmt::print(stderr, "fuzz_random TARGET SECONDS SEED FOLDER...\n");
    return 2;
  }
  const auto target = fuzz_targets().at(words[1]);
  std::vector<std::string> inputs{""};
  for (int i = 4; i < count; ++i) {
    for (const auto& file : std::filesystem::recursive_directory_iterator(words[i])) {
      if (file.is_regular_file() && file.file_size() < (1u << 20u)) {
        inputs.push_back(fuzz_bytes(file.path()));
      }
    }
  }
  std::mt19937_64 random(std::stoull(words[3]));
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(std::stol(words[2]));
  const std::filesystem::path finding = std::string("finding-") + words[1];
  std::uint64_t executions = 0;
  while (std::chrono::steady_clock::now() < end) {
    std::ofstream(finding, std::ios::binary) << changed(inputs, random);
    ++executions;
    try {
      target(finding);
    } catch (const std::exception& error) {
      fmt::print("{}: {} executions, then: {}\n", words[1], executions, error.what());
      return 1;
    }
  }
  std::filesystem::remove(finding);
  fmt::print("{}: {} executions, no finding\n", words[1], executions);
}
