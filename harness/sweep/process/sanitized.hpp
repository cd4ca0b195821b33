/// LOOPBENCH_SANITIZED is defined in builds whose sanitizer brings its own malloc and ends
/// processes itself. GCC and clang announce sanitizers differently.
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LOOPBENCH_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || \
    __has_feature(memory_sanitizer)
#define LOOPBENCH_SANITIZED
#endif
#endif
