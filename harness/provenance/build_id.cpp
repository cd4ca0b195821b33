#include <gnu/libc-version.h>

#include "harness/catalogue/libraries.hpp"
#include "harness/provenance/build.hpp"
#include "harness/text/hash.hpp"

namespace loopbench::harness {

std::string build_id(const std::string& code) {
  Fields fields;
  fields.add(code);
  for (const auto& [name, value] : build_metadata()) fields.add(name).add(value);
  for (const std::filesystem::path& library : program_libraries()) {
    fields.add(library.filename().string());
  }
  return fields.add(gnu_get_libc_version()).hashed().substr(0, 16);
}

}  // namespace loopbench::harness
