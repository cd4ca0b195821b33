/// The group of the poses as a type.
#pragma once

#include "methods/solvers/groups/level.hpp"
#include "methods/solvers/groups/se2.hpp"
#include "methods/solvers/groups/se3.hpp"
#include "methods/solvers/groups/sim3.hpp"
#include "methods/solvers/pose_graph_solver.hpp"

namespace loopbench::methods {

/// Returns visit(G{}) for the type G of the group.
template <class Visit>
auto visit_group(Group group, Visit visit) {
  switch (group) {
    case Group::se2:
      return visit(Se2{});
    case Group::se3:
      return visit(Se3{});
    case Group::level:
      return visit(Level{});
    case Group::sim3:
      break;
  }
  return visit(Sim3{});
}

}  // namespace loopbench::methods
