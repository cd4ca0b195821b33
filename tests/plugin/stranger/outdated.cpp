// As a plugin of an older interface exports it: only the first member is known to mean the same.
extern "C" const int* loopbench_plugin() {
  static const int interface = 1;
  return &interface;
}
