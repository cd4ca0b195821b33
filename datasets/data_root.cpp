#include "datasets/dataset.hpp"

namespace loopbench {

std::filesystem::path DataRoot::find(const std::string& path) const {
  std::filesystem::path file(path);
  if (path.empty()) throw InputError("found an empty file name, expected the path of a file");
  if (file.is_absolute()) {
    if (std::filesystem::exists(file)) return file;
    throw DataMissing(path + ": no such file");
  }
  std::string tried;
  for (const std::filesystem::path& folder : folders) {
    if (std::filesystem::exists(folder / file)) return folder / file;
    tried += (tried.empty() ? "" : ", ") + folder.string();
  }
  throw DataMissing(path + ": no such file (looked in " + (tried.empty() ? "." : tried) +
                    "; set the data folder with --data DIR or $LOOPBENCH_DATA)");
}

}  // namespace loopbench
