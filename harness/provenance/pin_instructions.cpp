#include "harness/provenance/pin_instructions.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "datasets/core/error.hpp"
#include "harness/provenance/collect_provenance.hpp"

namespace loopbench::harness {

void pin_instructions() {
  if (std::getenv(kPinnedVariable) != nullptr) return;
  // The libraries read these variables when they are loaded.
  setenv(kPinnedVariable, "1", 1);
  setenv("GLIBC_TUNABLES",
         "glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4,-AVX512F,-AVX512VL,-AVX512BW,-AVX512DQ",
         1);
  setenv("OPENCV_CPU_DISABLE", "SSE4.2,AVX,FP16,AVX2,FMA3,AVX512-SKX,AVX512-ICL", 1);
  setenv("OPENCV_IPP", "disabled", 1);
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  std::vector<char*> arguments;
  for (std::size_t at = 0; at < text.size(); at += std::strlen(text.data() + at) + 1) {
    arguments.push_back(text.data() + at);
  }
  arguments.push_back(nullptr);
  std::fflush(nullptr);
  execv("/proc/self/exe", arguments.data());
  throw InputError(std::string("--pin-instructions: the program cannot be restarted: ") +
                   std::strerror(errno));
}

}  // namespace loopbench::harness
