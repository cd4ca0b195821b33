#include <cstdio>

int main() {
  std::puts("loopbench");
  return 0;
}
