/// SHA-256 for the Content-Security-Policy of a page.
///
/// Source: base64 of RFC 4648.
#pragma once

#include <string>
#include <string_view>

namespace loopbench::harness {

/// SHA-256 of the bytes in base64, as in the source 'sha256-...' of a policy. O(n).
std::string base64_sha256(std::string_view bytes);

}  // namespace loopbench::harness
