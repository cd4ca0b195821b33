#include "harness/execution/isolate/subreaper.hpp"

#include <sys/prctl.h>

#include "harness/execution/isolate/process_tree.hpp"

namespace loopbench::harness {

Subreaper::Subreaper() : others_(own_children()) {
  prctl(PR_GET_CHILD_SUBREAPER, &before_);
  prctl(PR_SET_CHILD_SUBREAPER, 1);
}

Subreaper::~Subreaper() {
  end_strays(others_);
  prctl(PR_SET_CHILD_SUBREAPER, before_);
}

void Subreaper::end_strays_except(std::vector<pid_t> workers) const {
  workers.insert(workers.end(), others_.begin(), others_.end());
  end_strays(workers);
}

}  // namespace loopbench::harness
