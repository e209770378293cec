// The reference says every method and error code that there is.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "src/daemon/control_commands.hpp"

namespace gannet::daemon {
namespace {

std::string reference() {
  // The test runs from the top of the tree (make), like every other that reads its files.
  std::stringstream text;
  text << std::ifstream("docs/reference/control.md").rdbuf();
  return text.str();
}

TEST(ControlReference, names_every_method_and_error_code) {
  const std::string text = reference();
  ASSERT_FALSE(text.empty());
  for (const std::string& method : ControlCommands::methods()) {
    EXPECT_NE(text.find("`" + method + "`"), std::string::npos) << method;
  }
  for (int code = 0; code <= static_cast<int>(control::ErrorCode::kBusy); ++code) {
    const std::string name = to_string(static_cast<control::ErrorCode>(code));
    EXPECT_NE(text.find("| `" + name + "` |"), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace gannet::daemon
