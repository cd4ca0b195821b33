/// Huge pages for large blocks from malloc. Linked into the program only, so that a library does
/// not replace the malloc of whoever embeds it.
#pragma once

namespace loopbench::harness {

/// From now on, asks for transparent huge pages for blocks from malloc of 4 MiB and more: for
/// commands that read large files, where the first touch of every page takes a tenth of the time.
/// Not for sweeps, whose cells have limits of memory. Does nothing under sanitizers and outside
/// glibc, where malloc is not replaced.
void use_huge_pages();

}  // namespace loopbench::harness
