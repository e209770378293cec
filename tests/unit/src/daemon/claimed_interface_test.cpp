#include "src/daemon/claimed_interface.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

namespace gannet::daemon {
namespace {

// Of this test alone: others may run beside it.
std::string interface(const char* name) { return name + std::to_string(getpid()); }

TEST(ClaimedInterface, is_given_to_one) {
  const auto first = claim_interface(interface("can"));
  ASSERT_TRUE(first) << first.error().text;
  const auto second = claim_interface(interface("can"));
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().text.find("another gannetd commands " + interface("can")),
            std::string::npos);
}

TEST(ClaimedInterface, says_nothing_of_others) {
  const auto first = claim_interface(interface("can"));
  EXPECT_TRUE(claim_interface(interface("vcan")));
}

TEST(ClaimedInterface, is_free_again_after_its_holder) {
  { EXPECT_TRUE(claim_interface(interface("can"))); }
  EXPECT_TRUE(claim_interface(interface("can")));
}

}  // namespace
}  // namespace gannet::daemon
