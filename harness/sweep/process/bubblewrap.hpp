/// The program that gives others a world of their own.
#pragma once

#include <string>
#include <vector>

namespace loopbench::harness {

/// Words of a call, before what is shown or hidden: all files read-only, with own devices (and
/// those that compute), processes, keys and network.
std::vector<std::string> bubblewrap_arguments(bool network);

/// Whether it works here, and can also hide the network. Started once.
bool has_bubblewrap();
bool can_hide_network();

}  // namespace loopbench::harness
