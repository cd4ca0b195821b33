#include "datasets/rgbd/stage_cache.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "datasets/core/error.hpp"
#include "datasets/core/hash.hpp"
#include "datasets/core/pack.hpp"
#include "datasets/formats/regular_file.hpp"
#include "datasets/formats/replace_file.hpp"

namespace loopbench::rgbd {
namespace {

// Seed of the seal; change it with the file layout.
constexpr std::uint64_t kSealSeed = 0x6c6f6f7062656e64u;
constexpr std::size_t kSealBytes = sizeof(std::uint64_t);
constexpr std::size_t kLargestEntry = std::size_t{4} << 30;  // [bytes]

std::string seal(const CacheEntry& entry, std::string_view bytes) {
  const std::uint64_t sum =
      hash_combine(hash_combine(hash_combine(kSealSeed, entry.build), entry.name), bytes);
  std::string out(kSealBytes, '\0');
  std::memcpy(out.data(), &sum, kSealBytes);
  return out;
}

/// "STAGE-KEY", with KEY in hexadecimal.
std::string cache_name(const std::string& stage, std::uint64_t key) {
  return fmt::format("{}-{:016x}", stage, key);
}

}  // namespace

std::optional<std::string> load_cached(const CacheEntry& entry) {
  try {
    std::string all = read_regular_file(entry.file(), kLargestEntry, "file");
    if (all.size() < kSealBytes) return std::nullopt;
    const std::string_view bytes = std::string_view(all).substr(kSealBytes);
    if (all.compare(0, kSealBytes, seal(entry, bytes)) != 0) return std::nullopt;
    return all.substr(kSealBytes);
  } catch (const InputError&) {  // missing or unreadable: recompute
    return std::nullopt;
  }
}

void store_cached(const CacheEntry& entry, const std::string& bytes) {
  std::error_code ignored;
  std::filesystem::create_directories(entry.file().parent_path(), ignored);
  try {
    replace_file(entry.file(), seal(entry, bytes) + bytes, Target::own);
  } catch (const InputError&) {  // a result that is not cached is computed again
  }
}

CacheLock::CacheLock(const CacheEntry& entry) {
  std::error_code ignored;
  std::filesystem::create_directories(entry.file().parent_path(), ignored);
  const std::string file = entry.file().string() + ".lock";
  handle_ = open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
  if (handle_ >= 0) flock(handle_, LOCK_EX);
}

CacheLock::~CacheLock() {
  if (handle_ >= 0) close(handle_);
}

StageCache::StageCache(const FrontendHooks& hooks,
                       const RgbdSource& source,
                       const FrontendOptions& options)
    : folder_(hooks.cache), build_(hooks.build) {
  if (folder_.empty()) return;
  const std::uint64_t features = hash_combine(source.content(), to_text(echo(options.features)));
  const std::uint64_t track = hash_combine(features, to_text(echo(options.track)));
  frames_ = cache_name("features", features);
  tracked_ = cache_name("track", track);
  const std::uint64_t loops = hash_combine(track, to_text(echo(options.loops)));
  loops_ = cache_name("loops", loops);
  refined_ = cache_name("refined", loops);
}

CacheEntry StageCache::frame(std::size_t index) const {
  return entry(fmt::format("{}/{:06}", frames_, index));
}

}  // namespace loopbench::rgbd

// Members of the types, each list used for both writing and reading. In the namespace of the
// serialiser, which finds them there.
namespace loopbench {

template <class Archive, Either<Pose> T>
void walk(Archive& a, T& pose) {
  for (int i = 0; i < 4; ++i) a(pose.rotation.coeffs()[i]);
  for (int i = 0; i < 3; ++i) a(pose.translation[i]);
}

template <class Archive, Either<Edge> T>
void walk(Archive& a, T& edge) {
  a(edge.from)(edge.to)(edge.from_from_to)(edge.scale);
  for (int i = 0; i < 36; ++i) a(edge.information.data()[i]);
}

template <class Archive, Either<StampedPose> T>
void walk(Archive& a, T& p) {
  a(p.stamp)(p.world_from_body);
}

template <class Archive, Either<rgbd::Features> T>
void walk(Archive& a, T& f) {
  a(f.points)(f.descriptors)(f.bytes)(f.binary);
}

template <class Archive, Either<rgbd::FrameFeatures> T>
void walk(Archive& a, T& frame) {
  a(frame.why)(frame.features);
}

template <class Archive, Either<rgbd::Keyframe> T>
void walk(Archive& a, T& k) {
  a(k.frame)(k.stamp)(k.world_from_camera)(k.features);
}

template <class Archive, Either<rgbd::TrackingResult> T>
void walk(Archive& a, T& t) {
  a(t.keyframes)(t.odometry)(t.shared_landmarks)(t.frames)(t.lost)(t.skipped)(t.notes);
}

template <class Archive, Either<LoopCandidate> T>
void walk(Archive& a, T& c) {
  a(c.from)(c.to)(c.score)(c.accepted);
}

template <class Archive, Either<rgbd::DetectedLoops> T>
void walk(Archive& a, T& loops) {
  a(loops.closures)(loops.candidates);
}

template <class Archive, Either<rgbd::RefinedEdges> T>
void walk(Archive& a, T& e) {
  a(e.odometry)(e.closures)(e.odometry_refined)(e.closures_refined);
}

}  // namespace loopbench

namespace loopbench::rgbd {

template <class T>
std::string serialised(const T& value) {
  return Packer{}(value).bytes();
}

template <class T>
T deserialised(const std::string& bytes) {
  T out;
  Unpacker{bytes}(out);
  return out;
}

template std::string serialised(const FrameFeatures&);
template std::string serialised(const TrackingResult&);
template std::string serialised(const DetectedLoops&);
template std::string serialised(const RefinedEdges&);
template FrameFeatures deserialised<FrameFeatures>(const std::string&);
template TrackingResult deserialised<TrackingResult>(const std::string&);
template DetectedLoops deserialised<DetectedLoops>(const std::string&);
template RefinedEdges deserialised<RefinedEdges>(const std::string&);

}  // namespace loopbench::rgbd
