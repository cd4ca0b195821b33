#include "harness/catalogue/scratch.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

namespace loopbench::harness {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExchange = "loopbench-exchange-";

fs::path new_folder(const std::string& prefix) {
  std::string name = (fs::temp_directory_path() / (prefix + "XXXXXX")).string();
  if (mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error(name + ": cannot be created: " + std::strerror(errno));
  }
  return name;
}

}  // namespace

ScratchFolder::ScratchFolder()
    : before_(fs::temp_directory_path()), folder_(new_folder("loopbench-")) {
  setenv("TMPDIR", folder_.c_str(), 1);
}

ScratchFolder::~ScratchFolder() {
  setenv("TMPDIR", before_.c_str(), 1);
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void ScratchFolder::remove_exchanges() const {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, ignored)) {
    if (entry.path().filename().string().starts_with(kExchange)) {
      fs::remove_all(entry.path(), ignored);
    }
  }
}

void ScratchFolder::remove_with_parent() const {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
  fs::remove(folder_.parent_path(), ignored);  // fails unless it is empty
}

ExchangeFolder::ExchangeFolder() : folder_(new_folder(kExchange)) {}

ExchangeFolder::~ExchangeFolder() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

}  // namespace loopbench::harness
