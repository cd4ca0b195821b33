/// Adoption of the descendants of worker processes.
#pragma once

#include <sys/types.h>

#include <vector>

namespace loopbench::harness {

/// While it exists, this process adopts descendants whose parents have ended. At the end it ends
/// all that remain.
class Subreaper {
 public:
  Subreaper();
  ~Subreaper();
  Subreaper(const Subreaper&) = delete;
  Subreaper& operator=(const Subreaper&) = delete;

  /// Ends all children but `workers` and those that were there before.
  void end_strays_except(std::vector<pid_t> workers) const;

 private:
  std::vector<pid_t> others_;  ///< children that were there before
  int before_ = 0;             ///< whether it was a subreaper
};

}  // namespace loopbench::harness
