#include "datasets/compressed/compress.hpp"

#include <new>
#include <stdexcept>
#include <string>

#include "datasets/core/error.hpp"

#ifdef LOOPBENCH_HAS_ZSTD
#include <zstd.h>
#endif

namespace loopbench {

#ifdef LOOPBENCH_HAS_ZSTD

struct ZstdWriter::Stream {
  explicit Stream(std::function<void(std::string_view)> to) : sink(std::move(to)) {
    if (state == nullptr) throw std::bad_alloc();
  }
  ~Stream() { ZSTD_freeCStream(state); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  /// Returns the number of bytes that are left to flush.
  std::size_t step(ZSTD_inBuffer& in, ZSTD_EndDirective directive) {
    ZSTD_outBuffer out{buffer.data(), buffer.size(), 0};
    const std::size_t left = ZSTD_compressStream2(state, &out, &in, directive);
    if (ZSTD_isError(left) != 0) throw std::runtime_error(ZSTD_getErrorName(left));
    if (out.pos > 0) sink({buffer.data(), out.pos});
    return left;
  }

  ZSTD_CStream* state = ZSTD_createCStream();
  std::function<void(std::string_view)> sink;
  std::string buffer = std::string(ZSTD_CStreamOutSize(), '\0');
};

ZstdWriter::ZstdWriter(std::function<void(std::string_view)> sink)
    : stream_(std::make_unique<Stream>(std::move(sink))) {}

void ZstdWriter::write(std::string_view bytes) {
  ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
  while (in.pos < in.size) stream_->step(in, ZSTD_e_continue);
}

void ZstdWriter::finish() {
  ZSTD_inBuffer none{nullptr, 0, 0};
  while (stream_->step(none, ZSTD_e_end) > 0) {
  }
}

#else

struct ZstdWriter::Stream {};

ZstdWriter::ZstdWriter(std::function<void(std::string_view)>) {
  throw MissingPart(
      "this build cannot write zstd data: install the package libzstd-dev and build again");
}

void ZstdWriter::write(std::string_view) {}
void ZstdWriter::finish() {}

#endif

ZstdWriter::~ZstdWriter() = default;

}  // namespace loopbench
