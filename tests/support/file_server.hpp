/// A small HTTP server for one file, with ranges, on a free local port.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace loopbench {

class FileServer {
 public:
  explicit FileServer(std::string content) : content_(std::move(content)) {
    listener_ = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("bind");
    }
    listen(listener_, 8);
    socklen_t size = sizeof address;
    getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~FileServer() {
    shutdown(listener_, SHUT_RDWR);
    thread_.join();
    close(listener_);
  }
  FileServer(const FileServer&) = delete;
  FileServer& operator=(const FileServer&) = delete;

  std::string url() const { return "http://127.0.0.1:" + std::to_string(port_) + "/file"; }
  void set_content(const std::string& content) {
    const std::scoped_lock lock(mutex_);
    content_ = content;
  }
  /// Ends every answer after this many bytes of the content; 0: complete answers.
  std::atomic<std::size_t> cut_after = 0;
  std::atomic<bool> knows_ranges = true;
  /// First bytes of the requested ranges, in order.
  std::vector<std::size_t> starts() const {
    const std::scoped_lock lock(mutex_);
    return starts_;
  }

 private:
  void serve() {
    for (;;) {
      const int connection = accept(listener_, nullptr, nullptr);
      if (connection < 0) return;
      std::string request;
      std::array<char, 4096> buffer;
      while (request.find("\r\n\r\n") == std::string::npos) {
        const ssize_t got = recv(connection, buffer.data(), buffer.size(), 0);
        if (got <= 0) break;
        request.append(buffer.data(), static_cast<std::size_t>(got));
      }
      const std::string reply = answer(request);
      send(connection, reply.data(), reply.size(), MSG_NOSIGNAL);
      close(connection);
    }
  }

  std::string answer(const std::string& request) {
    const std::scoped_lock lock(mutex_);
    const std::size_t range = request.find("Range: bytes=");
    const bool is_range = range != std::string::npos && knows_ranges;
    const std::size_t begin = is_range ? std::stoul(request.substr(range + 13)) : 0;
    starts_.push_back(begin);
    if (is_range && begin >= content_.size()) {
      return "HTTP/1.1 416 Range Not Satisfiable\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
    }
    const std::string rest = content_.substr(begin);
    std::string out = is_range
                          ? "HTTP/1.1 206 Partial Content\r\nContent-Range: bytes " +
                                std::to_string(begin) + "-" + std::to_string(content_.size() - 1) +
                                "/" + std::to_string(content_.size()) + "\r\n"
                          : "HTTP/1.1 200 OK\r\n";
    out += "Content-Length: " + std::to_string(rest.size()) + "\r\nConnection: close\r\n\r\n";
    return out + (cut_after > 0 ? rest.substr(0, cut_after) : rest);
  }

  mutable std::mutex mutex_;
  std::string content_;
  std::vector<std::size_t> starts_;
  int listener_ = -1;
  int port_ = 0;
  std::thread thread_;
};

}  // namespace loopbench
