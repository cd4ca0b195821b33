#include <gnu/libc-version.h>
#include <link.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "datasets/core/error.hpp"
#include "harness/catalogue/libraries.hpp"
#include "harness/provenance/build.hpp"
#include "harness/text/hash.hpp"

namespace loopbench::harness {
namespace {

/// A part of the program's file.
struct Part {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Read-only mappings, without the notes and the headers before them: the linker's build id is a
/// note that depends on everything, including the commit.
int find_read_only(dl_phdr_info* object, std::size_t, void* out) {
  auto& parts = *static_cast<std::vector<Part>*>(out);
  std::size_t notes_end = 0;
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const auto& segment = object->dlpi_phdr[i];
    if (segment.p_type == PT_NOTE) {
      notes_end = std::max<std::size_t>(notes_end, segment.p_offset + segment.p_filesz);
    }
  }
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const auto& segment = object->dlpi_phdr[i];
    if (segment.p_type != PT_LOAD || (segment.p_flags & PF_W) != 0) continue;
    Part part{segment.p_offset, segment.p_offset + segment.p_filesz};
    if (notes_end > part.begin && notes_end <= part.end) part.begin = notes_end;
    parts.push_back(part);
  }
  return 1;  // stop after the program, which comes first
}

std::string computed() {
  std::vector<Part> parts;
  dl_iterate_phdr(find_read_only, &parts);
  // Read from the file, because AddressSanitizer forbids reading between constants in memory.
  std::ifstream in("/proc/self/exe", std::ios::binary);
  Fields fields;
  for (const Part& part : parts) {
    std::string bytes(part.end - part.begin, '\0');
    in.seekg(static_cast<std::streamoff>(part.begin));
    if (!in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
      throw InputError("/proc/self/exe: cannot be read to identify this build");
    }
    fields.add(bytes);
  }
  for (const auto& [name, value] : build_facts()) fields.add(name).add(value);
  for (const std::filesystem::path& library : program_libraries()) {
    fields.add(library.filename().string());
  }
  return fields.add(gnu_get_libc_version()).hashed().substr(0, 16);
}

}  // namespace

const std::string& build_id() {
  static const std::string id = computed();
  return id;
}

}  // namespace loopbench::harness
