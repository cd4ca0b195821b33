#include "datasets/dataset.hpp"

namespace loopbench {

std::filesystem::path DataRoot::find(const std::string& path) const {
  const std::filesystem::path wanted(path);
  if (path.empty()) throw InputError("a file name is empty");
  if (wanted.is_absolute()) {
    if (std::filesystem::exists(wanted)) return wanted;
    throw DataMissing(path + ": no such file");
  }
  std::string tried;
  for (const std::filesystem::path& folder : folders) {
    if (std::filesystem::exists(folder / wanted)) return folder / wanted;
    tried += (tried.empty() ? "" : ", ") + folder.string();
  }
  throw DataMissing(path + ": no such file (looked in " + (tried.empty() ? "." : tried) +
                    "; --data DIR or $LOOPBENCH_DATA says where data lies)");
}

}  // namespace loopbench
