#include "harness/execution/sandbox/seccomp.hpp"

#include <linux/audit.h>
#include <linux/capability.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "harness/execution/sandbox/filter_program.hpp"

namespace loopbench::harness {
namespace {

#if defined(__x86_64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kArchitecture = 0;
#endif

constexpr std::array kDenied{
    // other processes
    SYS_ptrace,
    SYS_process_vm_readv,
    SYS_process_vm_writev,
    SYS_pidfd_getfd,
    SYS_kcmp,
    // a way around this filter
    SYS_io_uring_setup,
    SYS_io_uring_enter,
    SYS_io_uring_register,
    // the machine
    SYS_bpf,
    SYS_perf_event_open,
    SYS_mount,
    SYS_umount2,
    SYS_pivot_root,
    SYS_chroot,
    SYS_unshare,
    SYS_setns,
    SYS_keyctl,
    SYS_add_key,
    SYS_request_key,
    SYS_reboot,
    SYS_kexec_load,
    SYS_init_module,
    SYS_finit_module,
    SYS_delete_module,
    SYS_swapon,
    SYS_swapoff,
    SYS_settimeofday,
    SYS_clock_settime,
    SYS_sethostname,
    SYS_setdomainname,
    SYS_open_by_handle_at,
    // memory and messages that outlive a cell and that no memory limit counts
    SYS_shmget,
    SYS_shmat,
    SYS_shmctl,
    SYS_msgget,
    SYS_msgsnd,
    SYS_msgrcv,
    SYS_msgctl,
    SYS_semget,
    SYS_semop,
    SYS_semtimedop,
    SYS_semctl,
    SYS_mq_open,
    SYS_mq_unlink,
};

/// Owners, modes, times and attributes of files, which Landlock does not cover. Older headers have
/// no names for the last three: fchmodat2, setxattrat, removexattrat.
constexpr std::array kFileAttributes{
    SYS_fchmod,
    SYS_fchmodat,
    SYS_fchown,
    SYS_fchownat,
    SYS_utimensat,
    SYS_setxattr,
    SYS_lsetxattr,
    SYS_fsetxattr,
    SYS_removexattr,
    SYS_lremovexattr,
    SYS_fremovexattr,
    452,
    463,
    466,
};

#if defined(__x86_64__)
constexpr std::array kOlderFileAttributes{
    SYS_chmod, SYS_chown, SYS_lchown, SYS_utime, SYS_utimes, SYS_futimesat};
constexpr std::uint32_t kX32 = 0x40000000;  ///< a second table of calls, not in the lists
#else
constexpr std::array<int, 0> kOlderFileAttributes{};
constexpr std::uint32_t kX32 = 0;
#endif

/// Flags of clone() for new namespaces, which would restore capabilities: mount, cgroup, UTS, IPC,
/// user, PID, network.
constexpr std::uint32_t kNewNamespaces = 0x7e020000;

/// System calls whose first argument is a process, or a group as a negative number: signals, and
/// what would slow the processes of later cells down.
constexpr std::array kOfProcesses{
    SYS_kill,
    SYS_tkill,
    SYS_tgkill,
    SYS_rt_sigqueueinfo,
    SYS_rt_tgsigqueueinfo,
    SYS_pidfd_open,
    SYS_sched_setaffinity,
    SYS_sched_setattr,
    SYS_sched_setparam,
    SYS_sched_setscheduler,
    SYS_migrate_pages,
    SYS_move_pages,
};

constexpr std::uint32_t kAllow = SECCOMP_RET_ALLOW;
constexpr std::uint32_t kRefuse = SECCOMP_RET_ERRNO | EPERM;
constexpr std::uint32_t kUnknown = SECCOMP_RET_ERRNO | ENOSYS;
constexpr std::uint32_t kPriorityOfProcess = 1;  ///< IOPRIO_WHO_PROCESS

/// Instructions of a rule.
class RuleCode {
 public:
  /// Loads the low half of an argument (little endian).
  RuleCode& load(std::size_t argument) {
    return add(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args) + 8 * argument);
  }
  /// Ends with `action` if the loaded value is `value`.
  RuleCode& if_equal(std::uint32_t value, std::uint32_t action) {
    code_.push_back({BPF_JMP | BPF_JEQ | BPF_K, 0, 1, value});
    return end(action);
  }
  RuleCode& if_not_equal(std::uint32_t value, std::uint32_t action) {
    code_.push_back({BPF_JMP | BPF_JEQ | BPF_K, 1, 0, value});
    return end(action);
  }
  /// Ends with `action` if the loaded value has any of the bits.
  RuleCode& if_any(std::uint32_t bits, std::uint32_t action) {
    code_.push_back({BPF_JMP | BPF_JSET | BPF_K, 0, 1, bits});
    return end(action);
  }
  /// Refuses the call if the loaded value is one of the processes.
  RuleCode& refuse(std::span<const pid_t> guarded) {
    for (const pid_t process : guarded) if_equal(static_cast<std::uint32_t>(process), kRefuse);
    return *this;
  }
  RuleCode& end(std::uint32_t action) { return add(BPF_RET | BPF_K, action); }

  operator std::vector<sock_filter>() const { return code_; }

 private:
  RuleCode& add(int code, std::size_t value) {
    code_.push_back({static_cast<std::uint16_t>(code), 0, 0, static_cast<std::uint32_t>(value)});
    return *this;
  }

  std::vector<sock_filter> code_;
};

/// The same code for several system calls.
template <class Numbers>
void add_rules(std::vector<CallRule>& rules, const Numbers& numbers, const RuleCode& code) {
  for (const long number : numbers) rules.push_back({static_cast<std::uint32_t>(number), code});
}

}  // namespace

bool has_seccomp() { return kArchitecture != 0 && prctl(PR_GET_SECCOMP, 0, 0, 0, 0) >= 0; }

std::vector<sock_filter> system_call_filter(std::span<const pid_t> guarded, Privileges privileges) {
  const RuleCode refused = RuleCode().end(kRefuse);
  const RuleCode unknown = RuleCode().end(kUnknown);
  std::vector<CallRule> rules;
  add_rules(rules, kDenied, refused);
  RuleCode socket = refused;
  if (privileges == Privileges::of_methods) {
    add_rules(rules, kFileAttributes, refused);
    add_rules(rules, kOlderFileAttributes, refused);
  } else {
    socket = RuleCode().load(0).if_equal(AF_UNIX, kAllow).end(kRefuse);
  }
  // Flags in memory, out of reach of a filter; the C library then uses clone(). Descriptors of
  // processes can be folders of /proc.
  add_rules(rules, std::array{SYS_clone3, SYS_pidfd_send_signal}, unknown);
  const auto add = [&](long number, const RuleCode& code) {
    add_rules(rules, std::array{number}, code);
  };
  add(SYS_clone, RuleCode().load(0).if_any(kNewNamespaces, kRefuse).end(kAllow));
  add(SYS_socket, socket);
  add(SYS_prlimit64, RuleCode().load(0).if_equal(0, kAllow).end(kRefuse));  // 0: its own limits
  add_rules(rules, kOfProcesses, RuleCode().load(0).refuse(guarded).end(kAllow));
  // Not of groups and users, which contain other processes.
  const auto priority = [&](std::uint32_t which) {
    return RuleCode().load(0).if_not_equal(which, kRefuse).load(1).refuse(guarded).end(kAllow);
  };
  add(SYS_setpriority, priority(PRIO_PROCESS));
  add(SYS_ioprio_set, priority(kPriorityOfProcess));
  return filter_program({kArchitecture, kX32}, kRefuse, std::move(rules));
}

bool restrict_system_calls(std::span<const sock_filter> filter) {
  if (!has_seccomp()) return false;
  const sock_fprog program{static_cast<unsigned short>(filter.size()),
                           const_cast<sock_filter*>(filter.data())};  // the kernel copies it
  // Without the flag, some systems would switch off speculation and slow the method down.
  return syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_SPEC_ALLOW, &program) ==
         0;
}

void drop_capabilities() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  const __user_cap_data_struct none[_LINUX_CAPABILITY_U32S_3] = {};
  syscall(SYS_capset, &header, none);
}

}  // namespace loopbench::harness
