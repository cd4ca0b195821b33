/// A page in headless Chromium.
#pragma once

#include <gtest/gtest.h>

#include "tests/support/command.hpp"

namespace loopbench::test {

inline bool has_chromium() { return std::system("command -v chromium >/dev/null 2>&1") == 0; }

/// Opens `page` of `folder` with `options`; standard output, such as the document after its
/// scripts. The test fails if the browser fails or its console has a message.
inline std::string in_browser(const TemporaryFolder& folder,
                              const std::string& page,
                              const std::string& options) {
  const std::string line =
      "cd '" + folder.path().string() +
      "' && HOME=\"$PWD\" timeout 150 chromium --headless --no-sandbox --disable-gpu "
      "--no-first-run --hide-scrollbars --disable-background-networking "
      "--disable-component-update --disable-sync --enable-logging=stderr "
      "--user-data-dir=\"$PWD/profile\" " +
      options + " \"file://$PWD/" + page + "\" >dom 2>log";
  EXPECT_EQ(std::system(line.c_str()), 0);
  const std::string log = read_all(folder.path() / "log");
  EXPECT_EQ(log.find("CONSOLE"), std::string::npos) << log;
  return read_all(folder.path() / "dom");
}

/// The title of a document.
inline std::string title_of(const std::string& document) {
  const std::size_t begin = document.find("<title>");
  if (begin == std::string::npos) return "";
  return document.substr(begin + 7, document.find("</title>", begin) - begin - 7);
}

/// `page` with a script of tests/data/probes at its end, in an element with the nonce of the
/// page's policy.
inline std::string with_probe(std::string page, const std::string& name) {
  const std::string script = read_all(LOOPBENCH_TEST_DATA "/probes/" + name);
  const std::size_t nonce = page.find("<script nonce=");
  const std::string element = page.substr(nonce, page.find('>', nonce) + 1 - nonce);
  page.insert(page.rfind("</body>"), element + script + "</script>");
  return page;
}

}  // namespace loopbench::test
