/// What a reader promises of any bytes at all: it keeps its word about what it returns, or throws
/// InputError. Fuzzed one by one, and replayed on what fuzzing once found.
#pragma once

#include <filesystem>

namespace loopbench {

/// Each reads the file. Throws std::logic_error when what came out breaks a promise, and whatever
/// the reader throws but InputError.
void fuzz_tum(const std::filesystem::path& file);
void fuzz_kitti(const std::filesystem::path& file);
void fuzz_euroc(const std::filesystem::path& file);
void fuzz_any(const std::filesystem::path& file);  ///< the format recognised by content
void fuzz_g2o(const std::filesystem::path& file);
void fuzz_times(const std::filesystem::path& file);
void fuzz_closures(const std::filesystem::path& file);
void fuzz_config(const std::filesystem::path& file);

}  // namespace loopbench
