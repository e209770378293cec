#include "platform/base/log.hpp"

#include <gtest/gtest.h>

namespace gannet {
namespace {

TEST(Log, prefixes_every_line_for_the_journal) {
  EXPECT_EQ(log_lines(Severity::kError, "camera gone\ntry again", true),
            "<3>camera gone\n<3>try again\n");
}

TEST(Log, says_the_word_elsewhere) {
  EXPECT_EQ(log_lines(Severity::kWarning, "slow", false), "warning: slow\n");
  EXPECT_EQ(log_lines(Severity::kInfo, "", false), "");
}

}  // namespace
}  // namespace gannet
