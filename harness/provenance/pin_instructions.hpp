/// Fixed code paths of libraries that choose them by processor.
#pragma once

namespace loopbench::harness {

/// Restarts the program with settings that make the C library and OpenCV use the code paths of the
/// oldest supported processors (without AVX, AVX2, FMA and AVX-512), unless it was started so.
/// Eigen's paths are fixed when the program is built. Throws InputError if the restart fails.
void pin_instructions();

}  // namespace loopbench::harness
