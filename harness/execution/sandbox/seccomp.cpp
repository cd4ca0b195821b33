#include "harness/execution/sandbox/seccomp.hpp"

#include <linux/audit.h>
#include <linux/capability.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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

/// System calls whose first argument is a process.
constexpr std::array kSignals{
    SYS_kill, SYS_tkill, SYS_tgkill, SYS_rt_sigqueueinfo, SYS_rt_tgsigqueueinfo, SYS_pidfd_open};

constexpr std::uint32_t kAllow = SECCOMP_RET_ALLOW;
constexpr std::uint32_t kRefuse = SECCOMP_RET_ERRNO | EPERM;
constexpr std::uint32_t kUnknown = SECCOMP_RET_ERRNO | ENOSYS;

class Filter {
 public:
  void load(std::size_t offset) {
    add(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset));
  }
  /// Ends with `action` if the loaded value is equal (or not equal) to `value`.
  void if_equal(std::uint32_t value, std::uint32_t action) {
    jump(value, 0, 1);
    add(BPF_RET | BPF_K, action);
  }
  void if_not_equal(std::uint32_t value, std::uint32_t action) {
    jump(value, 1, 0);
    add(BPF_RET | BPF_K, action);
  }
  /// Ends with `action` if the loaded value has any of the bits.
  void if_any(std::uint32_t bits, std::uint32_t action) {
    code_.push_back({BPF_JMP | BPF_JSET | BPF_K, 0, 1, bits});
    add(BPF_RET | BPF_K, action);
  }
  /// Skips `count` instructions unless the loaded value is equal to `value`.
  void skip_unless(std::uint32_t value, std::size_t count) {
    jump(value, 0, static_cast<std::uint8_t>(count));
  }
  void end(std::uint32_t action) { add(BPF_RET | BPF_K, action); }

  sock_fprog program() { return {static_cast<unsigned short>(code_.size()), code_.data()}; }

 private:
  void add(int code, std::uint32_t value) {
    code_.push_back({static_cast<std::uint16_t>(code), 0, 0, value});
  }
  void jump(std::uint32_t value, std::uint8_t if_true, std::uint8_t if_false) {
    code_.push_back({BPF_JMP | BPF_JEQ | BPF_K, if_true, if_false, value});
  }

  std::vector<sock_filter> code_;
};

constexpr std::size_t kNumber = offsetof(seccomp_data, nr);
constexpr std::size_t kFirstArgument = offsetof(seccomp_data, args);  // low half, little endian

std::uint32_t to_value(long number) { return static_cast<std::uint32_t>(number); }

Filter filter_for(std::span<const pid_t> guarded, FileAttributes attributes) {
  Filter filter;
  filter.load(offsetof(seccomp_data, arch));
  filter.if_not_equal(kArchitecture, kRefuse);
  filter.load(kNumber);
  filter.if_any(kX32, kRefuse);
  for (const long number : kDenied) filter.if_equal(to_value(number), kRefuse);
  if (attributes == FileAttributes::fixed) {
    for (const long number : kFileAttributes) filter.if_equal(to_value(number), kRefuse);
    for (const long number : kOlderFileAttributes) filter.if_equal(to_value(number), kRefuse);
  }
  // Its flags are in memory, out of reach of a filter; the C library then uses clone().
  filter.if_equal(SYS_clone3, kUnknown);
  filter.skip_unless(SYS_clone, 4);
  filter.load(kFirstArgument);
  filter.if_any(kNewNamespaces, kRefuse);
  filter.end(kAllow);
  filter.skip_unless(SYS_socket, 4);
  filter.load(kFirstArgument);
  filter.if_equal(AF_UNIX, kAllow);
  filter.end(kRefuse);
  filter.skip_unless(SYS_prlimit64, 4);
  filter.load(kFirstArgument);
  filter.if_equal(0, kAllow);  // its own limits
  filter.end(kRefuse);
  for (const long number : kSignals) {
    if (guarded.empty()) break;
    filter.skip_unless(to_value(number), 2 + 2 * guarded.size());
    filter.load(kFirstArgument);
    for (const pid_t process : guarded) {
      filter.if_equal(static_cast<std::uint32_t>(process), kRefuse);
    }
    filter.end(kAllow);
  }
  filter.end(kAllow);
  return filter;
}

}  // namespace

bool has_seccomp() { return kArchitecture != 0 && prctl(PR_GET_SECCOMP, 0, 0, 0, 0) >= 0; }

bool restrict_system_calls(const std::vector<pid_t>& guarded, FileAttributes attributes) {
  if (!has_seccomp()) return false;
  Filter filter = filter_for(guarded, attributes);
  const sock_fprog program = filter.program();
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
