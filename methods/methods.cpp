#include "methods/correctors/raw.hpp"
#include "methods/method.hpp"

namespace loopbench {

std::vector<MethodEntry> methods() {
  return {
      method<Raw>("raw", "keyframes as the tracker left them"),
  };
}

}  // namespace loopbench
