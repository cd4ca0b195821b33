/// Filter of system calls (seccomp) and capabilities.
#pragma once

#include <sys/types.h>

#include <vector>

namespace loopbench::harness {

/// Whether the system and this processor's filter are available.
bool has_seccomp();

/// Whether modes, owners, times and extended attributes of files can be changed. Programs such as
/// tar, cp and compilers change those of files that they have written.
enum class FileAttributes { fixed, changeable };

/// Restricts the calling thread; needs no_new_privs. `guarded`: processes that it may not signal.
/// False on failure.
bool restrict_system_calls(const std::vector<pid_t>& guarded, FileAttributes attributes);

/// Gives up all capabilities, also of programs started later if no_new_privs is set.
void drop_capabilities();

}  // namespace loopbench::harness
