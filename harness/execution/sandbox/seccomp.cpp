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
};

/// System calls whose first argument is a process.
constexpr std::array kSignals{
    SYS_kill, SYS_tkill, SYS_tgkill, SYS_rt_sigqueueinfo, SYS_rt_tgsigqueueinfo, SYS_pidfd_open};

constexpr std::uint32_t kAllow = SECCOMP_RET_ALLOW;
constexpr std::uint32_t kRefuse = SECCOMP_RET_ERRNO | EPERM;

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

Filter filter_for(std::span<const pid_t> guarded) {
  Filter filter;
  filter.load(offsetof(seccomp_data, arch));
  filter.if_not_equal(kArchitecture, kRefuse);
  filter.load(kNumber);
  for (const long number : kDenied) filter.if_equal(static_cast<std::uint32_t>(number), kRefuse);
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
    filter.skip_unless(static_cast<std::uint32_t>(number), 2 + 2 * guarded.size());
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

bool restrict_system_calls(const std::vector<pid_t>& guarded) {
  if (!has_seccomp()) return false;
  Filter filter = filter_for(guarded);
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
