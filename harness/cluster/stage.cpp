#include "harness/cluster/stage.hpp"

#include <set>

#include "datasets/core/error.hpp"
#include "harness/catalogue/load_sequence.hpp"
#include "harness/text/file_lock.hpp"
#include "harness/text/hash.hpp"
#include "harness/text/print_error.hpp"
#include "harness/text/printable.hpp"

namespace loopbench::harness {
namespace {

namespace fs = std::filesystem;

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::is_regular_file(b, error) && fs::file_size(a) == fs::file_size(b) &&
         fs::last_write_time(a) == fs::last_write_time(b);
}

void copy_one(const fs::path& from, const fs::path& to) {
  if (is_same_file(from, to)) return;
  fs::create_directories(to.parent_path());
  const fs::path partial = to.string() + ".partial";
  try {
    fs::copy_file(from, partial, fs::copy_options::overwrite_existing);
    fs::last_write_time(partial, fs::last_write_time(from));
    fs::rename(partial, to);
  } catch (const fs::filesystem_error&) {
    std::error_code ignored;
    fs::remove(partial, ignored);
    throw;
  }
}

void copy_all(const fs::path& from, const fs::path& to) {
  if (!fs::is_directory(from)) return copy_one(from, to);
  for (const auto& entry : fs::recursive_directory_iterator(from)) {
    if (entry.is_regular_file()) copy_one(entry.path(), to / fs::relative(entry.path(), from));
  }
}

/// Relative paths named by text options, which can be files.
std::set<fs::path> named_paths(const Sweep& sweep,
                               const std::vector<Cell>& cells,
                               const Catalogue& catalogue) {
  std::set<std::size_t> datasets;
  for (const Cell& cell : cells) datasets.insert(cell.dataset);
  std::set<fs::path> out;
  for (const std::size_t dataset : datasets) {
    const DatasetChoice& choice = sweep.datasets[dataset];
    const DatasetEntry& entry = find_dataset(catalogue, choice.dataset.name);
    for (const auto& [name, value] : full_options(choice, entry, 0)) {
      const auto* text = std::get_if<std::string>(&value);
      if (text == nullptr || text->empty()) continue;
      const fs::path path = fs::path(*text).lexically_normal();
      if (path.is_relative() && *path.begin() != ".." && path != ".") out.insert(path);
    }
  }
  return out;
}

}  // namespace

DataRoot stage_inputs(const Sweep& sweep,
                      const std::vector<Cell>& cells,
                      const Catalogue& catalogue,
                      const DataRoot& root,
                      const fs::path& folder) {
  DataRoot out = root;
  out.folders.clear();
  try {
    fs::create_directories(folder);
    const FileLock lock(folder / ".lock");
    const std::set<fs::path> paths = named_paths(sweep, cells, catalogue);
    for (const fs::path& original : root.folders) {
      // Files of the same name from different folders do not replace each other.
      const fs::path copy = folder / hex(hash_of(fs::absolute(original).string())).substr(0, 12);
      for (const fs::path& path : paths) {
        if (fs::exists(original / path)) copy_all(original / path, copy / path);
      }
      out.folders.push_back(copy);
      out.folders.push_back(original);
    }
    return out;
  } catch (const fs::filesystem_error& error) {
    print_error("loopbench: {}: {}; the original files are used\n",
                printable(error.path1().string()),
                error.code().message());
    return root;
  }
}

}  // namespace loopbench::harness
