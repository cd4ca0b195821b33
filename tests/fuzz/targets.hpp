/// Fuzz targets: for any bytes, a reader returns a result that satisfies its postconditions or
/// throws InputError. Each target is fuzzed separately and replayed on earlier findings.
#pragma once

#include <filesystem>
#include <map>
#include <string>

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
void fuzz_matrices(const std::filesystem::path& file);  ///< json, npy, log
void fuzz_config(const std::filesystem::path& file);
void fuzz_store(const std::filesystem::path& file);
void fuzz_report(const std::filesystem::path& file);      ///< of a store
void fuzz_gate(const std::filesystem::path& file);        ///< baselines and limits
void fuzz_where(const std::filesystem::path& file);       ///< one rule per line
void fuzz_eval(const std::filesystem::path& file);        ///< one argument per line
void fuzz_eval_files(const std::filesystem::path& file);  ///< reference and estimate
void fuzz_messages(const std::filesystem::path& file);    ///< of workers
void fuzz_camera(const std::filesystem::path& file);
void fuzz_image_list(const std::filesystem::path& file);
void fuzz_layout(const std::filesystem::path& file);  ///< every text file of a recording
void fuzz_image(const std::filesystem::path& file);   ///< PNG and JPEG

/// All of these by name, without `fuzz_`.
const std::map<std::string, void (*)(const std::filesystem::path& file)>& fuzz_targets();

}  // namespace loopbench
