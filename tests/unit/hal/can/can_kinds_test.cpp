#include "hal/can/can_kinds.hpp"

#include <gtest/gtest.h>

namespace gannet::hal {
namespace {

TEST(CanKinds, MakesEachKind) {
  for (const char* kind : {"local", "memory"}) {
    const auto bus = make_can_bus({.kind = kind, .path = "@gannet_no_such_bus"}, {}, 32, {});
    EXPECT_TRUE(bus) << kind;
  }
}

TEST(CanKinds, AnUnknownKindIsRefusedWithTheKnownOnes) {
  const auto bus = make_can_bus({.kind = "carrier_pigeon", .path = ""}, {}, 32, {});
  ASSERT_FALSE(bus);
  EXPECT_NE(bus.error().text.find("local, memory"), std::string::npos) << bus.error().text;
}

TEST(CanKinds, ALocalBusWithoutAPathIsRefused) {
  EXPECT_FALSE(make_can_bus({.kind = "local", .path = ""}, {}, 32, {}));
}

TEST(CanKinds, ASocketCanInterfaceIsOpenedByItsName) {
  const auto bus = make_can_bus({.kind = "socketcan", .interface = "gannet_none"}, {}, 32, {});
  ASSERT_FALSE(bus);
  EXPECT_NE(bus.error().text.find("gannet_none"), std::string::npos) << bus.error().text;
}

}  // namespace
}  // namespace gannet::hal
