#include "harness/catalogue/libraries.hpp"

#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <set>
#include <string>

namespace loopbench::harness {
namespace {

using Objects = std::set<const link_map*>;

/// Parses the dynamic section of an object.
struct Names {
  std::string own;
  std::vector<std::string> needed;
};

Names names_of(const link_map& object) {
  const char* texts = nullptr;
  for (const ElfW(Dyn)* entry = object.l_ld; entry->d_tag != DT_NULL; ++entry) {
    if (entry->d_tag != DT_STRTAB) continue;
    ElfW(Addr) at = entry->d_un.d_ptr;
    if (at < object.l_addr) at += object.l_addr;  // some loaders do not relocate it
    texts = reinterpret_cast<const char*>(at);
  }
  Names out{std::filesystem::path(object.l_name).filename().string(), {}};
  if (texts == nullptr) return out;
  for (const ElfW(Dyn)* entry = object.l_ld; entry->d_tag != DT_NULL; ++entry) {
    if (entry->d_tag == DT_SONAME) out.own = texts + entry->d_un.d_val;
    if (entry->d_tag == DT_NEEDED) out.needed.emplace_back(texts + entry->d_un.d_val);
  }
  return out;
}

/// The loaded objects, the program first.
const link_map* first_object() {
  link_map* first = nullptr;
  if (dlinfo(dlopen(nullptr, RTLD_NOW), RTLD_DI_LINKMAP, &first) != 0) return nullptr;
  while (first->l_prev != nullptr) first = first->l_prev;
  return first;
}

void add_with_needed(const link_map& object, Objects& out) {
  if (!out.insert(&object).second) return;
  for (const std::string& name : names_of(object).needed) {
    for (const link_map* other = first_object(); other != nullptr; other = other->l_next) {
      if (names_of(*other).own == name) add_with_needed(*other, out);
    }
  }
}

std::vector<std::filesystem::path> files_of(const Objects& objects, const Objects& without) {
  std::vector<std::filesystem::path> out;
  for (const link_map* object : objects) {
    std::error_code none;
    const std::filesystem::path file = std::filesystem::canonical(object->l_name, none);
    if (!without.contains(object) && !none) out.push_back(file);
  }
  std::ranges::sort(out);
  return out;
}

Objects of_program() {
  Objects out;
  if (const link_map* program = first_object()) add_with_needed(*program, out);
  return out;
}

}  // namespace

std::vector<std::filesystem::path> program_libraries() {
  const Objects objects = of_program();
  return files_of(objects, {first_object()});
}

std::vector<std::filesystem::path> plugin_libraries(const std::filesystem::path& plugin) {
  const std::string path = std::filesystem::absolute(plugin).string();
  void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_NOLOAD);
  link_map* object = nullptr;
  if (handle == nullptr || dlinfo(handle, RTLD_DI_LINKMAP, &object) != 0) return {};
  Objects all;
  add_with_needed(*object, all);
  Objects without = of_program();
  without.insert(object);
  return files_of(all, without);
}

}  // namespace loopbench::harness
