#include "tests/store/fault_vfs.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <new>

namespace loopbench {
namespace {

constexpr std::size_t kSector = 512;

struct ShimFile {
  sqlite3_file base;
  FaultVfs* vfs;
  std::string* name;  ///< null: a temporary file
  sqlite3_file* real() { return reinterpret_cast<sqlite3_file*>(this + 1); }
};

ShimFile* shim(sqlite3_file* file) { return reinterpret_cast<ShimFile*>(file); }
FaultVfs& vfs_of(sqlite3_file* file) { return *shim(file)->vfs; }
const sqlite3_io_methods& real_methods(sqlite3_file* file) { return *shim(file)->real()->pMethods; }

int close_file(sqlite3_file* file) {
  const int code = real_methods(file).xClose(shim(file)->real());
  delete shim(file)->name;
  return code;
}
int read_file(sqlite3_file* file, void* out, int size, sqlite3_int64 offset) {
  const int code = vfs_of(file).next_call(SQLITE_IOERR_READ);
  return code != SQLITE_OK ? code : real_methods(file).xRead(shim(file)->real(), out, size, offset);
}
int write_file(sqlite3_file* file, const void* data, int size, sqlite3_int64 offset) {
  // A disk that gets full writes the first part.
  const int code = vfs_of(file).next_call(SQLITE_FULL);
  const int count = code == SQLITE_OK ? size : size / 2;
  if (shim(file)->name != nullptr && count > 0) {
    vfs_of(file).change(*shim(file)->name,
                        {false,
                         static_cast<std::uint64_t>(offset),
                         {static_cast<const char*>(data), static_cast<std::size_t>(count)}});
  }
  const int real = real_methods(file).xWrite(shim(file)->real(), data, count, offset);
  return code != SQLITE_OK ? code : real;
}
int truncate_file(sqlite3_file* file, sqlite3_int64 size) {
  const int code = vfs_of(file).next_call(SQLITE_IOERR_TRUNCATE);
  if (code != SQLITE_OK) return code;
  if (shim(file)->name != nullptr) {
    vfs_of(file).change(*shim(file)->name, {true, static_cast<std::uint64_t>(size), ""});
  }
  return real_methods(file).xTruncate(shim(file)->real(), size);
}
int sync_file(sqlite3_file* file, int) {
  const int code = vfs_of(file).next_call(SQLITE_IOERR_FSYNC);
  if (code == SQLITE_OK && shim(file)->name != nullptr) vfs_of(file).sync(*shim(file)->name);
  return code;
}
int size_of_file(sqlite3_file* file, sqlite3_int64* size) {
  return real_methods(file).xFileSize(shim(file)->real(), size);
}
int lock_file(sqlite3_file* file, int level) {
  const int code = vfs_of(file).next_call(SQLITE_IOERR_LOCK);
  return code != SQLITE_OK ? code : real_methods(file).xLock(shim(file)->real(), level);
}
int unlock_file(sqlite3_file* file, int level) {
  return real_methods(file).xUnlock(shim(file)->real(), level);
}
int check_lock(sqlite3_file* file, int* out) {
  return real_methods(file).xCheckReservedLock(shim(file)->real(), out);
}
int control_file(sqlite3_file* file, int operation, void* argument) {
  return real_methods(file).xFileControl(shim(file)->real(), operation, argument);
}
int sector_size(sqlite3_file* file) { return real_methods(file).xSectorSize(shim(file)->real()); }
int characteristics(sqlite3_file* file) {
  return real_methods(file).xDeviceCharacteristics(shim(file)->real());
}
int map_shm(sqlite3_file* file, int page, int size, int extend, void volatile** out) {
  const int code = vfs_of(file).next_call(SQLITE_IOERR_SHMMAP);
  if (code != SQLITE_OK) return code;
  return real_methods(file).xShmMap(shim(file)->real(), page, size, extend, out);
}
int lock_shm(sqlite3_file* file, int offset, int count, int flags) {
  return real_methods(file).xShmLock(shim(file)->real(), offset, count, flags);
}
void shm_barrier(sqlite3_file* file) { real_methods(file).xShmBarrier(shim(file)->real()); }
int unmap_shm(sqlite3_file* file, int remove) {
  return real_methods(file).xShmUnmap(shim(file)->real(), remove);
}

const sqlite3_io_methods kMethods{2,
                                  close_file,
                                  read_file,
                                  write_file,
                                  truncate_file,
                                  sync_file,
                                  size_of_file,
                                  lock_file,
                                  unlock_file,
                                  check_lock,
                                  control_file,
                                  sector_size,
                                  characteristics,
                                  map_shm,
                                  lock_shm,
                                  shm_barrier,
                                  unmap_shm,
                                  nullptr,
                                  nullptr};

int open_file(sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags, int* out_flags) {
  auto& self = *static_cast<FaultVfs*>(vfs->pAppData);
  file->pMethods = nullptr;
  if (const int code = self.next_call(SQLITE_CANTOPEN); code != SQLITE_OK) return code;
  const bool is_new = name != nullptr && !std::filesystem::exists(name);
  const int code = self.real()->xOpen(self.real(), name, shim(file)->real(), flags, out_flags);
  if (code != SQLITE_OK) return code;
  shim(file)->vfs = &self;
  shim(file)->name = name == nullptr ? nullptr : new std::string(name);
  file->pMethods = &kMethods;
  if (name != nullptr) self.open(name, is_new);
  return SQLITE_OK;
}

int delete_file(sqlite3_vfs* vfs, const char* name, int sync_folder) {
  auto& self = *static_cast<FaultVfs*>(vfs->pAppData);
  if (const int code = self.next_call(SQLITE_IOERR_DELETE); code != SQLITE_OK) return code;
  const int code = self.real()->xDelete(self.real(), name, 0);
  if (code == SQLITE_OK) self.remove(name, sync_folder != 0);
  return code;
}

void apply(std::string& content, const FaultVfs::Change& change) {
  if (change.truncates) return content.resize(change.offset);
  const std::size_t end = change.offset + change.bytes.size();
  if (content.size() < end) content.resize(end);
  content.replace(change.offset, change.bytes.size(), change.bytes);
}

}  // namespace

FaultVfs::FaultVfs() : real_(sqlite3_vfs_find(nullptr)), shim_(*real_) {
  shim_.szOsFile = static_cast<int>(sizeof(ShimFile)) + real_->szOsFile;
  shim_.zName = "fault";
  shim_.pAppData = this;
  shim_.pNext = nullptr;
  shim_.xOpen = open_file;
  shim_.xDelete = delete_file;
  sqlite3_vfs_register(&shim_, 1);
}

FaultVfs::~FaultVfs() {
  sqlite3_vfs_unregister(&shim_);
  sqlite3_vfs_register(real_, 1);
}

void FaultVfs::fail(long number, bool lasting) {
  left_ = number;
  lasting_ = lasting;
  failed_ = false;
}

bool FaultVfs::stop() {
  left_ = 0;
  failing_ = 0;
  return failed_;
}

int FaultVfs::next_call(int error) {
  if (failing_ != 0 && error == failing_) return error;
  if (left_ == 0) return SQLITE_OK;
  if (left_ > 1) {
    --left_;
    return SQLITE_OK;
  }
  if (!lasting_) left_ = 0;
  failed_ = true;
  return error;
}

void FaultVfs::changing() const {
  if (each_) each_();
}

void FaultVfs::change(const std::string& file, Change change) {
  changing();
  disk_[file].pending.push_back(std::move(change));
}

void FaultVfs::sync(const std::string& file) {
  changing();
  Disk& disk = disk_[file];
  for (const Change& change : disk.pending) apply(disk.synced, change);
  disk.pending.clear();
  // The first sync of a file syncs its folder, too.
  if (disk.created) forget_removed();
  disk.created = false;
}

void FaultVfs::forget_removed() {
  std::erase_if(disk_, [](const auto& entry) { return entry.second.removed; });
}

void FaultVfs::open(const std::string& file, bool is_new) {
  if (is_new) {
    disk_[file] = {};
    disk_[file].created = true;
  } else if (!disk_.contains(file)) {
    std::ifstream in(file, std::ios::binary);
    disk_[file].synced.assign(std::istreambuf_iterator<char>(in), {});
  }
}

void FaultVfs::remove(const std::string& file, bool synced) {
  changing();
  disk_[file].removed = true;
  if (synced) forget_removed();
}

void FaultVfs::cut_power(const std::filesystem::path& from,
                         const std::filesystem::path& to,
                         std::mt19937_64& random) const {
  std::filesystem::remove_all(to);
  std::filesystem::create_directories(to);
  const unsigned kept = static_cast<unsigned>(random() % 9);  // of 8 sectors
  for (const auto& [name, disk] : disk_) {
    const std::filesystem::path file(name);
    if (file.parent_path() != from || (disk.removed && random() % 2 == 0)) continue;
    if (disk.created && random() % 4 == 0) continue;
    std::vector<Change> sectors;
    for (const Change& change : disk.pending) {
      if (change.truncates) {
        sectors.push_back(change);
        continue;
      }
      for (std::size_t at = 0; at < change.bytes.size();) {
        const std::size_t size =
            std::min(kSector - (change.offset + at) % kSector, change.bytes.size() - at);
        sectors.push_back({false, change.offset + at, change.bytes.substr(at, size)});
        at += size;
      }
    }
    if (random() % 2 == 0) std::ranges::shuffle(sectors, random);
    std::string content = disk.synced;
    for (const Change& change : sectors) {
      if (random() % 8 < kept) apply(content, change);
    }
    std::ofstream(to / file.filename(), std::ios::binary) << content;
  }
}

}  // namespace loopbench
