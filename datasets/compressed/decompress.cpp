#include "datasets/compressed/decompress.hpp"

#include <algorithm>

#include "datasets/core/error.hpp"

#ifdef LOOPBENCH_HAS_ZLIB
#include <zlib.h>
#endif
#ifdef LOOPBENCH_HAS_BZIP2
#include <bzlib.h>
#endif
#ifdef LOOPBENCH_HAS_ZSTD
#include <zstd.h>
#endif
#ifdef LOOPBENCH_HAS_LZ4
#include <lz4frame.h>
#endif

namespace loopbench {
namespace {

constexpr std::size_t kStep = std::size_t{256} << 10;  // [bytes] per call of a library

[[noreturn]] [[maybe_unused]] void lack(const char* codec, const char* package) {
  throw MissingPart(std::string("this build cannot read ") + codec + " data: install the package " +
                    package + " and build again");
}

/// Output that grows in steps up to a limit.
class Grown {
 public:
  explicit Grown(std::size_t limit) : limit_(limit) {}

  /// Space for the next call of a library.
  char* space() {
    check();
    text_.resize(std::min(limit_ + 1, used_ + kStep));  // one more byte shows that there is more
    return text_.data() + used_;
  }
  std::size_t room() const { return text_.size() - used_; }
  void use(std::size_t count) { used_ += count; }
  std::string take() {
    check();
    text_.resize(used_);
    return std::move(text_);
  }

 private:
  void check() const {
    if (used_ <= limit_) return;
    throw DamagedStream("expands to more than " + std::to_string(limit_) + " bytes");
  }

  std::size_t limit_;
  std::size_t used_ = 0;
  std::string text_;
};

/// Calls step(in, size, out, room), which returns the bytes read and written and whether a frame
/// has ended, until all input is used. `damage`: if given, set to the reason why the input cannot
/// be used to its end, otherwise this is an exception.
template <class Step>
std::string expand(std::string_view bytes, std::size_t limit, std::string* damage, Step step) {
  Grown out(limit);
  bool ended = false;
  bool full = false;
  try {
    while (!bytes.empty() || full) {
      char* const space = out.space();
      const auto [read, written, frame_ended] = step(bytes, space, out.room());
      if (read == 0 && written == 0 && !frame_ended) break;
      full = written == out.room();
      ended = frame_ended;
      if (ended) full = false;
      bytes.remove_prefix(read);
      out.use(written);
    }
    if (!ended) throw DamagedStream("ends early");
  } catch (const DamagedStream& reason) {
    if (damage == nullptr) throw;
    *damage = reason.what();
  }
  return out.take();
}

struct Progress {
  std::size_t read = 0;
  std::size_t written = 0;
  bool frame_ended = false;
};

#ifdef LOOPBENCH_HAS_ZLIB
std::string expand_gzip(std::string_view bytes, std::size_t limit, std::string* damage) {
  struct Stream {
    z_stream state{};
    Stream() {
      constexpr int kWindowBits = 15 + 16;  // gzip header
      if (inflateInit2(&state, kWindowBits) != Z_OK) throw std::bad_alloc();
    }
    ~Stream() { inflateEnd(&state); }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;
  } stream;
  return expand(bytes, limit, damage, [&](std::string_view in, char* out, std::size_t room) {
    const std::size_t given = std::min<std::size_t>(in.size(), std::size_t{1} << 30);
    z_stream& s = stream.state;
    s.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(in.data()));
    s.avail_in = static_cast<uInt>(given);
    s.next_out = reinterpret_cast<Bytef*>(out);
    s.avail_out = static_cast<uInt>(room);
    const int code = inflate(&s, Z_NO_FLUSH);
    if (code != Z_OK && code != Z_STREAM_END && code != Z_BUF_ERROR) {
      throw DamagedStream(s.msg != nullptr ? s.msg : "is damaged");
    }
    const Progress done{given - s.avail_in, room - s.avail_out, code == Z_STREAM_END};
    if (done.frame_ended) inflateReset(&s);
    return done;
  });
}
#else
std::string expand_gzip(std::string_view, std::size_t, std::string*) { lack("gzip", "zlib1g-dev"); }
#endif

#ifdef LOOPBENCH_HAS_BZIP2
std::string expand_bzip2(std::string_view bytes, std::size_t limit, std::string* damage) {
  struct Stream {
    bz_stream state{};
    Stream() { start(); }
    ~Stream() { BZ2_bzDecompressEnd(&state); }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;
    void start() {
      state = {};
      if (BZ2_bzDecompressInit(&state, 0, 0) != BZ_OK) throw std::bad_alloc();
    }
  } stream;
  return expand(bytes, limit, damage, [&](std::string_view in, char* out, std::size_t room) {
    const std::size_t given = std::min<std::size_t>(in.size(), std::size_t{1} << 30);
    bz_stream& s = stream.state;
    s.next_in = const_cast<char*>(in.data());
    s.avail_in = static_cast<unsigned>(given);
    s.next_out = out;
    s.avail_out = static_cast<unsigned>(room);
    const int code = BZ2_bzDecompress(&s);
    if (code != BZ_OK && code != BZ_STREAM_END) throw DamagedStream("is damaged");
    const Progress done{given - s.avail_in, room - s.avail_out, code == BZ_STREAM_END};
    if (done.frame_ended) {
      BZ2_bzDecompressEnd(&s);
      stream.start();
    }
    return done;
  });
}
#else
std::string expand_bzip2(std::string_view, std::size_t, std::string*) {
  lack("bzip2", "libbz2-dev");
}
#endif

#ifdef LOOPBENCH_HAS_ZSTD
std::string expand_zstd(std::string_view bytes, std::size_t limit, std::string* damage) {
  struct Stream {
    ZSTD_DStream* state = ZSTD_createDStream();
    Stream() {
      if (state == nullptr) throw std::bad_alloc();
    }
    ~Stream() { ZSTD_freeDStream(state); }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;
  } stream;
  return expand(bytes, limit, damage, [&](std::string_view in, char* out, std::size_t room) {
    ZSTD_inBuffer input{in.data(), in.size(), 0};
    ZSTD_outBuffer output{out, room, 0};
    const std::size_t code = ZSTD_decompressStream(stream.state, &output, &input);
    if (ZSTD_isError(code) != 0) throw DamagedStream(ZSTD_getErrorName(code));
    return Progress{input.pos, output.pos, code == 0};
  });
}
#else
std::string expand_zstd(std::string_view, std::size_t, std::string*) {
  lack("zstd", "libzstd-dev");
}
#endif

#ifdef LOOPBENCH_HAS_LZ4
std::string expand_lz4(std::string_view bytes, std::size_t limit, std::string* damage) {
  struct Stream {
    LZ4F_dctx* state = nullptr;
    Stream() {
      if (LZ4F_isError(LZ4F_createDecompressionContext(&state, LZ4F_VERSION)) != 0) {
        throw std::bad_alloc();
      }
    }
    ~Stream() { LZ4F_freeDecompressionContext(state); }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;
  } stream;
  return expand(bytes, limit, damage, [&](std::string_view in, char* out, std::size_t room) {
    std::size_t read = in.size();
    std::size_t written = room;
    const std::size_t code =
        LZ4F_decompress(stream.state, out, &written, in.data(), &read, nullptr);
    if (LZ4F_isError(code) != 0) throw DamagedStream(LZ4F_getErrorName(code));
    return Progress{read, written, code == 0};
  });
}
#else
std::string expand_lz4(std::string_view, std::size_t, std::string*) { lack("lz4", "liblz4-dev"); }
#endif

}  // namespace

std::optional<Codec> codec_of(std::string_view bytes) {
  if (bytes.starts_with("\x1f\x8b")) return Codec::gzip;
  if (bytes.starts_with("BZh")) return Codec::bzip2;
  if (bytes.starts_with("\x28\xb5\x2f\xfd")) return Codec::zstd;
  if (bytes.starts_with("\x04\x22\x4d\x18")) return Codec::lz4;
  return std::nullopt;
}

namespace {

std::string expand(Codec codec, std::string_view bytes, std::size_t limit, std::string* damage) {
  switch (codec) {
    case Codec::gzip:
      return expand_gzip(bytes, limit, damage);
    case Codec::bzip2:
      return expand_bzip2(bytes, limit, damage);
    case Codec::zstd:
      return expand_zstd(bytes, limit, damage);
    case Codec::lz4:
      return expand_lz4(bytes, limit, damage);
  }
  throw std::logic_error("unknown codec");
}

}  // namespace

std::string decompress(Codec codec, std::string_view bytes, std::size_t limit) {
  return expand(codec, bytes, limit, nullptr);
}

std::string decompress_intact(Codec codec, std::string_view bytes, std::size_t limit) {
  std::string damage;
  return expand(codec, bytes, limit, &damage);
}

}  // namespace loopbench
