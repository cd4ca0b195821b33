// A serving program without dependencies: answers with the keyframes, or misbehaves at its second
// request in the way that its argument names.
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace {

struct Header {
  char magic[8];
  std::uint64_t number;
  std::uint64_t text;
  std::uint64_t data;
};

/// States on standard error which files it can open.
void look_around() {
  if (std::fopen("reference.txt", "r") != nullptr) std::fputs("has read the reference\n", stderr);
  if (std::fopen("outside", "w") != nullptr) std::fputs("has written beside the config\n", stderr);
}

void put(const void* bytes, std::size_t size) { std::fwrite(bytes, 1, size, stdout); }

}  // namespace

int main(int argc, char** argv) {
  const std::string mode = argc > 1 ? argv[1] : "ok";
  Header header;
  if (mode == "late") usleep(400'000);
  for (int turn = 1; std::fread(&header, sizeof header, 1, stdin) == 1; ++turn) {
    std::string text(header.text, ' ');
    std::string data(header.data, ' ');
    if (std::fread(text.data(), 1, text.size(), stdin) != text.size()) return 1;
    if (!data.empty() && std::fread(data.data(), 1, data.size(), stdin) != data.size()) return 1;
    const char* shape = std::strstr(text.c_str(), "[\"keyframes\",");
    if (shape == nullptr) return 1;
    std::uint64_t rows = std::strtoull(shape + 13, nullptr, 10);
    const bool misbehaves = turn == 2;
    if (misbehaves && mode == "crash") std::abort();
    if (misbehaves && mode == "exit") return 3;
    if (misbehaves && mode == "hang") pause();
    if (misbehaves && mode == "flood") {
      std::fputs(std::string(1000000, 'x').c_str(), stderr);
      return 4;
    }
    if (misbehaves && mode == "grow") {
      for (std::vector<std::string> all;; usleep(1000)) all.emplace_back(20 << 20, 'x');
    }
    if (misbehaves && mode == "forks") {
      if (fork() == 0) {
        setsid();
        execlp("sleep", "sleep", "8761", nullptr);
      }
      return 3;
    }
    if (mode == "curious") look_around();
    if (misbehaves && mode == "print") std::printf("hello, I am not an answer; more words follow");
    if (misbehaves && mode == "number") ++header.number;
    if (misbehaves && mode == "counts") --rows;
    if (misbehaves && mode == "stamps") data[7] ^= 0x40;  // of the first keyframe
    if (misbehaves && mode == "nan") {
      const double nan = std::numeric_limits<double>::quiet_NaN();
      std::memcpy(data.data() + sizeof nan, &nan, sizeof nan);
    }
    std::string answer = "{\"seconds\": 0.0, \"poses\": " + std::to_string(rows) + "}";
    if (mode == "turns") {
      answer = "{\"counts\": {\"turn\": " + std::to_string(turn) +
               "}, \"poses\": " + std::to_string(rows) + "}";
    }
    if (misbehaves && mode == "declined") answer = R"({"status": "declined", "why": "no mood"})";
    if (misbehaves && mode == "json") answer = "{]";
    if (answer.find("poses") == std::string::npos) rows = 0;
    header.text = answer.size();
    header.data = rows * 64;
    if (misbehaves && mode == "half") header.data *= 2;
    put(&header, sizeof header);
    put(answer.data(), answer.size());
    put(data.data(), rows * 64);
    std::fflush(stdout);
    if (misbehaves && mode == "half") return 0;
  }
}
