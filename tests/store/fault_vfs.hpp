/// A SQLite VFS for tests, on top of the default one, that fails calls and simulates power cuts.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace loopbench {

/// Is the default VFS of this process while it exists; used by one thread. Never waits for the
/// disk.
class FaultVfs {
 public:
  FaultVfs();
  ~FaultVfs();
  FaultVfs(const FaultVfs&) = delete;
  FaultVfs& operator=(const FaultVfs&) = delete;

  /// Lets call `number`, counted from 1 and from now on, fail; with `lasting` all later ones, too.
  void fail(long number, bool lasting);
  /// Lets every call fail that fails with SQLite's error code `error`, for example every sync.
  void fail_all(int error) { failing_ = error; }
  /// Ends failing; whether a call failed since fail().
  bool stop();

  /// Writes the files in `from` to `to`, which it replaces, as a power cut at this moment can
  /// leave them: any of the sectors [512 bytes] written since the last sync of the file, in any
  /// order.
  void cut_power(const std::filesystem::path& from,
                 const std::filesystem::path& to,
                 std::mt19937_64& random) const;

  /// Calls `each` before every write, truncation, sync and deletion.
  void before_each_change(std::function<void()> each) { each_ = std::move(each); }

  struct Change {
    bool truncates = false;
    std::uint64_t offset = 0;  ///< or the new size
    std::string bytes;
  };
  struct Disk {
    std::string synced;  ///< content at the last sync
    std::vector<Change> pending;
    bool created = false;  ///< since the last sync: a power cut can remove the file
    bool removed = false;  ///< without sync of the folder: a power cut can bring it back
  };

  int next_call(int error);  ///< SQLITE_OK, or `error` for a call that fails
  void change(const std::string& file, Change change);
  void sync(const std::string& file);
  void open(const std::string& file, bool is_new);
  void remove(const std::string& file, bool synced);
  sqlite3_vfs* real() const { return real_; }

 private:
  void changing() const;
  void forget_removed();

  sqlite3_vfs* real_;
  sqlite3_vfs shim_{};
  long left_ = 0;  ///< calls until one fails; 0: none
  bool lasting_ = false;
  int failing_ = 0;  ///< of fail_all(); 0: none
  bool failed_ = false;
  std::map<std::string, Disk> disk_;
  std::function<void()> each_;
};

}  // namespace loopbench
