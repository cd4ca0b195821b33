#include "datasets/compressed/decompress.hpp"

#include <algorithm>
#include <memory>

#include "datasets/core/error.hpp"

#ifdef LOOPBENCH_HAS_COMPRESSION
#include <bzlib.h>
#include <lz4frame.h>
#include <lzma.h>
#include <zlib.h>
#include <zstd.h>
#endif

namespace loopbench {

using Sink = std::function<void(std::string_view)>;

#ifdef LOOPBENCH_HAS_COMPRESSION
namespace {

constexpr std::size_t kStep = std::size_t{256} << 10;     // output per call of a library [bytes]
constexpr std::size_t kMostInput = std::size_t{1} << 30;  // per call of zlib or bzip2 [bytes]

/// Calls step(in, size, out, room), which returns the bytes read and written and whether a frame
/// has ended, until all input is used.
template <class Step>
void expand(std::string_view bytes, std::size_t limit, const Sink& sink, Step step) {
  std::string buffer(kStep, '\0');
  std::size_t total = 0;
  bool ended = false;
  bool full = false;
  while (!bytes.empty() || full) {
    const auto [read, written, frame_ended] = step(bytes, buffer.data(), buffer.size());
    if (read == 0 && written == 0 && !frame_ended) break;
    total += written;
    if (total > limit) {
      throw ExpandsTooFar("expands to more than " + std::to_string(limit) + " bytes");
    }
    sink({buffer.data(), written});
    ended = frame_ended;
    full = !ended && written == buffer.size();
    bytes.remove_prefix(read);
  }
  if (!ended) throw DamagedStream("ends early");
}

struct Progress {
  std::size_t read = 0;
  std::size_t written = 0;
  bool frame_ended = false;
};

constexpr int kGzipHeader = 15 + 16, kNoHeader = -15;  // window bits of zlib

void expand_zlib(std::string_view bytes, std::size_t limit, const Sink& sink, int window) {
  z_stream s{};
  if (inflateInit2(&s, window) != Z_OK) throw std::bad_alloc();
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&s, inflateEnd);
  expand(bytes, limit, sink, [&](std::string_view in, char* out, std::size_t room) {
    const std::size_t given = std::min(in.size(), kMostInput);
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

void expand_xz(std::string_view bytes, std::size_t limit, const Sink& sink) {
  lzma_stream s = LZMA_STREAM_INIT;
  constexpr std::uint64_t kMostMemory = std::uint64_t{1} << 30;  // [bytes]
  if (lzma_stream_decoder(&s, kMostMemory, LZMA_CONCATENATED) != LZMA_OK) throw std::bad_alloc();
  const std::unique_ptr<lzma_stream, void (*)(lzma_stream*)> end(&s, lzma_end);
  expand(bytes, limit, sink, [&](std::string_view in, char* out, std::size_t room) {
    s.next_in = reinterpret_cast<const std::uint8_t*>(in.data());
    s.avail_in = in.size();
    s.next_out = reinterpret_cast<std::uint8_t*>(out);
    s.avail_out = room;
    const lzma_ret code = lzma_code(&s, LZMA_FINISH);
    if (code != LZMA_OK && code != LZMA_STREAM_END && code != LZMA_BUF_ERROR) {
      throw DamagedStream("is damaged");
    }
    return Progress{in.size() - s.avail_in, room - s.avail_out, code == LZMA_STREAM_END};
  });
}

void expand_bzip2(std::string_view bytes, std::size_t limit, const Sink& sink) {
  bz_stream s{};
  const auto start = [&] {
    s = {};
    if (BZ2_bzDecompressInit(&s, 0, 0) != BZ_OK) throw std::bad_alloc();
  };
  start();
  const std::unique_ptr<bz_stream, int (*)(bz_stream*)> end(&s, BZ2_bzDecompressEnd);
  expand(bytes, limit, sink, [&](std::string_view in, char* out, std::size_t room) {
    const std::size_t given = std::min(in.size(), kMostInput);
    s.next_in = const_cast<char*>(in.data());
    s.avail_in = static_cast<unsigned>(given);
    s.next_out = out;
    s.avail_out = static_cast<unsigned>(room);
    const int code = BZ2_bzDecompress(&s);
    if (code != BZ_OK && code != BZ_STREAM_END) throw DamagedStream("is damaged");
    const Progress done{given - s.avail_in, room - s.avail_out, code == BZ_STREAM_END};
    if (done.frame_ended) {
      BZ2_bzDecompressEnd(&s);
      start();
    }
    return done;
  });
}

void expand_zstd(std::string_view bytes, std::size_t limit, const Sink& sink) {
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> state(ZSTD_createDStream(),
                                                                         ZSTD_freeDStream);
  if (!state) throw std::bad_alloc();
  expand(bytes, limit, sink, [&](std::string_view in, char* out, std::size_t room) {
    ZSTD_inBuffer input{in.data(), in.size(), 0};
    ZSTD_outBuffer output{out, room, 0};
    const std::size_t code = ZSTD_decompressStream(state.get(), &output, &input);
    if (ZSTD_isError(code) != 0) throw DamagedStream(ZSTD_getErrorName(code));
    return Progress{input.pos, output.pos, code == 0};
  });
}

void expand_lz4(std::string_view bytes, std::size_t limit, const Sink& sink) {
  LZ4F_dctx* created = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&created, LZ4F_VERSION)) != 0) {
    throw std::bad_alloc();
  }
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> state(
      created, LZ4F_freeDecompressionContext);
  expand(bytes, limit, sink, [&](std::string_view in, char* out, std::size_t room) {
    std::size_t read = in.size();
    std::size_t written = room;
    const std::size_t code = LZ4F_decompress(state.get(), out, &written, in.data(), &read, nullptr);
    if (LZ4F_isError(code) != 0) throw DamagedStream(LZ4F_getErrorName(code));
    return Progress{read, written, code == 0};
  });
}

}  // namespace

void decompress(Codec codec, std::string_view bytes, std::size_t limit, const Sink& sink) {
  switch (codec) {
    case Codec::gzip:
      return expand_zlib(bytes, limit, sink, kGzipHeader);
    case Codec::deflate:
      return expand_zlib(bytes, limit, sink, kNoHeader);
    case Codec::xz:
      return expand_xz(bytes, limit, sink);
    case Codec::bzip2:
      return expand_bzip2(bytes, limit, sink);
    case Codec::zstd:
      return expand_zstd(bytes, limit, sink);
    case Codec::lz4:
      return expand_lz4(bytes, limit, sink);
  }
  throw std::logic_error("unknown codec");
}
#else
void decompress(Codec, std::string_view, std::size_t, const Sink&) {
  throw MissingPart(
      "this build cannot read compressed data: install the packages zlib1g-dev, libbz2-dev, "
      "libzstd-dev, liblz4-dev and liblzma-dev and build again");
}
#endif

std::optional<Codec> codec_of(std::string_view bytes) {
  if (bytes.starts_with("\x1f\x8b")) return Codec::gzip;
  if (bytes.starts_with("BZh")) return Codec::bzip2;
  if (bytes.starts_with("\x28\xb5\x2f\xfd")) return Codec::zstd;
  if (bytes.starts_with("\x04\x22\x4d\x18")) return Codec::lz4;
  if (bytes.starts_with(std::string_view("\xfd"
                                         "7zXZ\0",
                                         6)))
    return Codec::xz;
  return std::nullopt;
}

std::string decompress(Codec codec, std::string_view bytes, std::size_t limit) {
  std::string out;
  decompress(codec, bytes, limit, [&](std::string_view part) { out += part; });
  return out;
}

}  // namespace loopbench
