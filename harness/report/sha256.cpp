#include "harness/report/sha256.hpp"

#include "harness/base/sha256.hpp"
#include "harness/report/packed.hpp"

namespace loopbench::harness {

std::string base64_sha256(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes);
  return base64(hash.digest());
}

}  // namespace loopbench::harness
