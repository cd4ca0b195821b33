#include "harness/config/data_root.hpp"

namespace loopbench::harness {

DataRoot data_root(const Sweep& sweep, const std::string& data) {
  DataRoot root;
  const std::filesystem::path beside = sweep.config.parent_path();
  root.folders.push_back(beside.empty() ? "." : beside);
  if (data.empty()) return root;
  if (!std::filesystem::is_directory(data)) {
    throw InputError(data +
                     ": is not a folder; set --data or $LOOPBENCH_DATA to a folder with data");
  }
  root.folders.emplace_back(data);
  return root;
}

}  // namespace loopbench::harness
