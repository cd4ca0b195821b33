#include "harness/commands/interruption.hpp"

#include <csignal>

namespace loopbench::harness {
namespace {

std::atomic<bool> interruption = false;

void note_interruption(int) { interruption = true; }

}  // namespace

const std::atomic<bool>& install_interrupt_handler() {
  std::signal(SIGINT, note_interruption);
  std::signal(SIGTERM, note_interruption);
  std::signal(SIGHUP, note_interruption);
  return interruption;
}

}  // namespace loopbench::harness
