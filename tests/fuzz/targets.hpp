/// Fuzz targets: for any bytes, a reader returns a result that satisfies its postconditions or
/// throws InputError. Each target is fuzzed separately and replayed on earlier findings.
#pragma once

#include <filesystem>

namespace loopbench {

/// Each reads the file. Throws std::logic_error if the result violates a postcondition, and passes
/// on all exceptions of the reader except InputError.
void fuzz_tum(const std::filesystem::path& file);
void fuzz_kitti(const std::filesystem::path& file);
void fuzz_euroc(const std::filesystem::path& file);
void fuzz_any(const std::filesystem::path& file);  ///< format detected by content
void fuzz_g2o(const std::filesystem::path& file);
void fuzz_times(const std::filesystem::path& file);
void fuzz_closures(const std::filesystem::path& file);
void fuzz_bag(const std::filesystem::path& file);
void fuzz_csv(const std::filesystem::path& file);
void fuzz_config(const std::filesystem::path& file);

}  // namespace loopbench
