/// Compression of output that is not in memory at once.
#pragma once

#include <functional>
#include <memory>
#include <string_view>

namespace loopbench {

/// One zstd frame.
class ZstdWriter {
 public:
  /// `sink` receives the compressed bytes. Throws MissingPart if the build lacks the library.
  explicit ZstdWriter(std::function<void(std::string_view bytes)> sink);
  ~ZstdWriter();
  ZstdWriter(const ZstdWriter&) = delete;
  ZstdWriter& operator=(const ZstdWriter&) = delete;

  void write(std::string_view bytes);
  void finish();  ///< ends the frame; call once

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
};

}  // namespace loopbench
