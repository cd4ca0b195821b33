// Exports the interface of an older version, which shares only the first member.
extern "C" const void* loopbench_plugin() {
  static const int interface = 1;
  return &interface;
}
