/// Filter of system calls (seccomp) and capabilities.
#pragma once

#include <linux/filter.h>
#include <sys/types.h>

#include <span>
#include <vector>

namespace loopbench::harness {

/// Whether the system and this processor's filter are available.
bool has_seccomp();

/// What programs may do and methods of this process may not: change modes, owners, times and
/// extended attributes of files, as tar, cp and compilers do with those that they have written, and
/// create local sockets.
enum class Privileges { of_methods, of_programs };

/// Filter for restrict_system_calls(). `guarded`: processes, and groups as negative numbers, that
/// may be neither signalled nor slowed down.
std::vector<sock_filter> system_call_filter(std::span<const pid_t> guarded, Privileges privileges);

/// Restricts the calling thread; needs no_new_privs. False on failure.
bool restrict_system_calls(std::span<const sock_filter> filter);

/// Gives up all capabilities, also of programs started later if no_new_privs is set.
void drop_capabilities();

}  // namespace loopbench::harness
