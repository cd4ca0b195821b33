#include <gnu/libc-version.h>
#include <link.h>

#include "harness/provenance/build.hpp"
#include "harness/provenance/hash.hpp"

namespace loopbench {
namespace {

std::string_view bytes_of(const dl_phdr_info& object, const ElfW(Phdr) & segment) {
  const auto address = static_cast<std::uintptr_t>(object.dlpi_addr + segment.p_vaddr);
  return {reinterpret_cast<const char*>(address), segment.p_memsz};  // NOLINT
}

/// What was mapped read-only from the program's file, without its notes: the linker's build id is
/// one, and depends on everything, the commit too.
int add_read_only(dl_phdr_info* object, std::size_t, void* out) {
  auto& fields = *static_cast<Fields*>(out);
  std::string_view note;
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const auto& segment = object->dlpi_phdr[i];
    if (segment.p_type == PT_NOTE) {
      const std::string_view one = bytes_of(*object, segment);
      if (note.empty() || one.data() + one.size() > note.data() + note.size()) note = one;
    }
  }
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const auto& segment = object->dlpi_phdr[i];
    if (segment.p_type != PT_LOAD || (segment.p_flags & PF_W) != 0) continue;
    std::string_view bytes = bytes_of(*object, segment);
    const bool holds_note =
        note.data() >= bytes.data() && note.data() < bytes.data() + bytes.size();
    // Before the notes there are only the headers of the file.
    if (holds_note)
      bytes.remove_prefix(static_cast<std::size_t>(note.data() + note.size() - bytes.data()));
    fields.add(bytes);
  }
  return 1;  // the program comes first; its libraries are not walked
}

std::string computed() {
  Fields fields;
  dl_iterate_phdr(add_read_only, &fields);
  for (const auto& [name, value] : build_facts()) fields.add(name).add(value);
  return fields.add(gnu_get_libc_version()).hashed().substr(0, 16);
}

}  // namespace

const std::string& build_id() {
  static const std::string id = computed();
  return id;
}

}  // namespace loopbench
